#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "runtime/trace/output_file.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/gnuplot.hpp"
#include "tools/lineshaft/report_data.hpp"

namespace lineshaft {

namespace {

struct PlotCommand {
    std::vector<std::string> inputs, signals, path;
    std::string output, title;
    int width = 1000, height = 0;
    bool quiet = false;
};

/// Curves that share an axis.
struct PlotGroup {
    std::string unit;
    Type type = Type::real;
    std::vector<std::string> names;  ///< of an enumeration
    std::vector<Wide> numbers;       ///< of the names; empty: 0, 1, 2, ...
    std::vector<std::string> signals;
};

/// One for each unit, one for each enumeration, the booleans last.
std::vector<PlotGroup> group_signals(const ReportRun& run) {
    std::vector<PlotGroup> groups;
    for (const CsvColumn* signal : run.signals) {
        const bool boolean = signal->type == Type::boolean;
        const auto fits = [&](const PlotGroup& group) {
            return group.type != Type::enumeration && signal->type != Type::enumeration &&
                   (group.type == Type::boolean) == boolean && group.unit == signal->unit;
        };
        auto group = std::ranges::find_if(groups, fits);
        if (group == groups.end())
            group = groups.insert(group,
                                  {signal->unit, signal->type, signal->names, signal->numbers, {}});
        group->signals.push_back(signal->name);
    }
    std::stable_partition(groups.begin(), groups.end(),
                          [](const PlotGroup& group) { return group.type != Type::boolean; });
    return groups;
}

void append_point(std::string& text, double x, double y) {
    if (std::isfinite(x) && std::isfinite(y))
        text += fmt::format("{:.9g} {:.9g}\n", x, y);
    else
        text += '\n';
}

/// The least and the greatest sample of each of at most 2000 stretches, in their order: no peak is
/// lost, and the picture stays small.
std::string curve(const CsvColumn& time, const CsvColumn& signal, double scale, double base) {
    constexpr std::size_t stretches = 2000;
    const auto& values = signal.values;
    const std::size_t many = std::min(stretches, values.size());
    std::string text;
    for (std::size_t k = 0; k < many; ++k) {
        const std::size_t first = k * values.size() / many, end = (k + 1) * values.size() / many;
        std::size_t least = first, greatest = first;
        for (std::size_t i = first; i < end; ++i) {
            if (!(values[i] >= values[least]) && std::isfinite(values[i])) least = i;
            if (!(values[i] <= values[greatest]) && std::isfinite(values[i])) greatest = i;
        }
        for (const std::size_t i : {std::min(least, greatest), std::max(least, greatest)}) {
            append_point(text, time.values[i], base + scale * values[i]);
            if (least == greatest) break;
        }
    }
    return text;
}

std::string path(const CsvColumn& x, const CsvColumn& y) {
    constexpr std::size_t points = 20000;
    const std::size_t every = std::max<std::size_t>(1, x.values.size() / points);
    std::string text;
    for (std::size_t i = 0; i < x.values.size(); i += every)
        append_point(text, x.values[i], y.values[i]);
    return text;
}

/// A gnuplot script, written from its beginning to its end.
class Script {
  public:
    Script(const PlotCommand& command, const std::vector<ReportRun>& runs)
        : command_(command), runs_(runs) {}

    std::string over_time();
    std::string in_the_plane();

  private:
    template <class... Arguments>
    void line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        text_ += fmt::format(format, std::forward<Arguments>(arguments)...) + "\n";
    }
    void begin(int height);
    /// `$dN`, a data block of gnuplot.
    std::string data(const std::string& points);
    void plot(const PlotGroup& group);
    void axis(const PlotGroup& group);
    std::optional<double> constant_of(const PlotGroup& group) const;
    std::string title_of(const std::string& signal, std::size_t run) const;
    std::pair<std::size_t, std::size_t> margins(const std::vector<PlotGroup>& groups) const;

    const PlotCommand& command_;
    const std::vector<ReportRun>& runs_;
    std::string text_;
    int blocks_ = 0;
};

void Script::begin(int height) {
    const bool png = command_.output.ends_with(".png");
    line("set terminal {} size {},{} font 'DejaVu Sans,{}' noenhanced background '#ffffff'",
         png ? "pngcairo" : "svg", command_.width, command_.height > 0 ? command_.height : height,
         png ? 10 : 12);
    constexpr std::array colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                 "#a67c00", "#3d3dc4", "#1391b5", "#6b6b6b"};
    for (std::size_t i = 0; i < colours.size(); ++i)
        line("set linetype {} linecolor rgb '{}' linewidth 1.5", i + 1, colours[i]);
    line("set linetype cycle {}", colours.size());
    line("set grid linecolor rgb '#d8dce0' linewidth 0.5\nset border 3\nset tics nomirror out");
    line("set key outside right top Left reverse");
}

std::string Script::data(const std::string& points) {
    const std::string name = fmt::format("$d{}", blocks_++);
    line("{} << END_OF_DATA\n{}END_OF_DATA", name, points);
    return name;
}

/// What all samples of all of its signals are, for gnuplot makes no range of that without a
/// warning.
std::optional<double> Script::constant_of(const PlotGroup& group) const {
    std::optional<double> constant;
    for (const ReportRun& run : runs_)
        for (const std::string& signal : group.signals)
            for (const double value : run.table.find(signal)->values) {
                if (!std::isfinite(value)) continue;
                if (constant && value != *constant) return {};
                constant = value;
            }
    return constant;
}

void Script::axis(const PlotGroup& group) {
    std::string tics;
    const bool strips = group.type == Type::boolean;
    for (std::size_t i = 0; i < (strips ? group.signals : group.names).size(); ++i)
        tics += fmt::format("{}{} {}", i == 0 ? "" : ", ",
                            gnuplot_text(strips ? group.signals[i] : group.names[i]),
                            strips ? static_cast<double>(group.signals.size() - 1 - i) + 0.5
                            : group.numbers.empty() ? static_cast<double>(i)
                                                    : static_cast<double>(group.numbers[i]));
    line("set ytics {}", tics.empty() ? "autofreq" : "(" + tics + ")");
    line("set ylabel {}", gnuplot_text(group.unit.empty() ? "" : "[" + group.unit + "]"));
    const auto constant = constant_of(group);
    if (strips)
        line("set yrange [0:{}]", group.signals.size());
    else if (constant)
        line("set yrange [{:.9g}:{:.9g}]", *constant - 1, *constant + 1);
    else
        line("set autoscale y");
}

void Script::plot(const PlotGroup& group) {
    std::string curves;
    for (std::size_t run = 0; run < runs_.size(); ++run)
        for (std::size_t i = 0; i < group.signals.size(); ++i) {
            const CsvColumn& signal = *runs_[run].table.find(group.signals[i]);
            const bool strips = group.type == Type::boolean;
            const double base =
                strips ? static_cast<double>(group.signals.size() - 1 - i) + 0.2 : 0;
            const std::string points = curve(*runs_[run].time, signal, strips ? 0.6 : 1, base);
            const std::string title = title_of(signal.name, run);
            curves +=
                fmt::format("{} {} with {} linetype {} dashtype {} {}", curves.empty() ? "" : ",",
                            data(points), group.type == Type::real ? "lines" : "steps", i + 1,
                            run + 1, strips ? "notitle" : "title " + gnuplot_text(title));
        }
    axis(group);
    line("plot {}", curves);
}

std::string Script::title_of(const std::string& signal, std::size_t run) const {
    return runs_.size() == 1 ? signal : signal + " of " + runs_[run].path;
}

/// In characters: on the left what stands beside the axes, on the right the longest title.
std::pair<std::size_t, std::size_t> Script::margins(const std::vector<PlotGroup>& groups) const {
    constexpr std::size_t number = 8, label = 6, sample = 7;
    std::size_t left = number, right = 0;
    for (const PlotGroup& group : groups) {
        const bool strips = group.type == Type::boolean;
        for (const std::string& name : strips ? group.signals : group.names)
            left = std::max(left, name.size());
        for (std::size_t run = 0; run < runs_.size() && !strips; ++run)
            for (const std::string& signal : group.signals)
                right = std::max(right, title_of(signal, run).size());
    }
    return {left + label, right + sample};
}

std::string Script::over_time() {
    const std::vector<PlotGroup> groups = group_signals(runs_.front());
    begin(static_cast<int>(groups.size()) * 220 + 60);
    line("set multiplot layout {},1 title {}", groups.size(), gnuplot_text(command_.title));
    const auto [left, right] = margins(groups);
    line("set lmargin {}\nset rmargin {}", left, right);
    for (const PlotGroup& group : groups) {
        if (&group == &groups.back()) line("set xlabel 'time [s]'");
        plot(group);
    }
    line("unset multiplot");
    return text_;
}

std::string Script::in_the_plane() {
    begin(command_.width * 4 / 5);
    std::string curves;
    for (std::size_t run = 0; run < runs_.size(); ++run) {
        const CsvTable& table = runs_[run].table;
        curves +=
            fmt::format("{} {} with lines linetype {} title {}", curves.empty() ? "" : ",",
                        data(path(*table.find(command_.path[0]), *table.find(command_.path[1]))),
                        run + 1, gnuplot_text(runs_[run].path));
    }
    const auto label = [&](const std::string& name) {
        const std::string& unit = runs_.front().table.find(name)->unit;
        return gnuplot_text(unit.empty() ? name : name + " [" + unit + "]");
    };
    line("set title {}\nset size ratio -1", gnuplot_text(command_.title));
    line("set xlabel {}\nset ylabel {}", label(command_.path[0]), label(command_.path[1]));
    line("plot {}", curves);
    return text_;
}

std::vector<ReportRun> read_runs(const PlotCommand& command, Diagnostics& out) {
    std::vector<ReportRun> runs;
    const auto& wanted = command.path.empty() ? command.signals : command.path;
    for (const std::string& input : command.inputs)
        if (auto run = read_run(input, wanted, out)) runs.push_back(std::move(*run));
    for (std::size_t i = 1; i < runs.size() && out.empty(); ++i)
        check_overlay(runs.front(), runs[i], out);
    return runs;
}

Exit execute(PlotCommand& command) {
    if (!command.output.ends_with(".svg") && !command.output.ends_with(".png")) {
        spdlog::error("'{}' is neither an .svg nor a .png file", command.output);
        return Exit::wrong;
    }
    Diagnostics out;
    check_outputs({command.output}, command.inputs, out);
    const std::vector<ReportRun> runs = read_runs(command, out);
    if (!out.empty()) return report(out, false);
    if (command.title.empty() && runs.front().table.metadata)
        command.title = runs.front().table.metadata->title;
    Script script(command, runs);
    const Picture picture =
        run_gnuplot(command.path.empty() ? script.over_time() : script.in_the_plane());
    if (!picture.error.empty()) {
        spdlog::error("{}", picture.error);
        return Exit::fault;
    }
    OutputFile file(command.output);
    file.write(picture.bytes);
    if (!file.commit()) {
        spdlog::error("{}", file.error());
        return Exit::fault;
    }
    if (!command.quiet && command.output != "-") fmt::print("picture: {}\n", command.output);
    return Exit::fine;
}

}  // namespace

void add_plot(CLI::App& app, Exit& result) {
    auto command = std::make_shared<PlotCommand>();
    CLI::App* sub = app.add_subcommand("plot", "Draw traces as an SVG or PNG picture, by gnuplot");
    sub->add_option("inputs", command->inputs, "Traces (.csv), laid over each other")->required();
    sub->add_option("-o,--output", command->output,
                    "Write the picture here; its kind follows from .svg or .png")
        ->type_name("FILE")
        ->required();
    CLI::Option* signals =
        add_signals(*sub, "--signals", command->signals, "Draw these signals only: a.x,b.y")
            ->type_name("NAMES");
    add_signals(*sub, "--path", command->path,
                "Draw one signal over another, with equal axes: x.position,y.position", 2)
        ->type_name("X,Y")
        ->excludes(signals);
    sub->add_option("--title", command->title, "Headline; else the program's title");
    sub->add_option("--width", command->width, "Of the picture, in pixels")
        ->check(CLI::Range(100, 10000))
        ->capture_default_str();
    sub->add_option("--height", command->height, "Likewise; else as the number of plots asks for")
        ->check(CLI::Range(100, 10000));
    sub->add_flag("--quiet", command->quiet, "Print messages only");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
