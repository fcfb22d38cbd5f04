#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "blocks/contour/baseline.hpp"
#include "blocks/contour/command_path.hpp"
#include "blocks/contour/magnitude_statistics.hpp"
#include "runtime/csv/csv_reader.hpp"
#include "runtime/run/signal_json.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/units.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

constexpr const char* contour_help =
    "Each row is one command point with the actual point fed back in the same scan, as a trace\n"
    "of every scan has them. Contour errors, as magnitudes:\n"
    "  real-time  nearest command point so far, tangent from its neighbours (block contour_error)\n"
    "  linear     distance to the polyline of all command points, beside the nearest\n"
    "  spline     distance to the natural cubic spline through all, beside the nearest\n"
    "and their differences. The nearest is that of the real-time search; where it is the newest\n"
    "it is looked for on the commands that came later, as the actual point may be ahead of the\n"
    "command. Units come from the trace's sidecar or from titles such as 'x [um]'; without a unit\n"
    "a column is in mm. Left out and counted: rows that lack a value or are beyond 1000 km, and\n"
    "rows whose nearest point has left the 512 points of the real-time memory.\n"
    "Time per point is that of this computer: the real-time one includes the search for the\n"
    "nearest point, the others are told it, and the making of the spline is not counted.";

constexpr std::array<const char*, 3> method_names{"real-time", "linear", "spline"};
constexpr std::array<const char*, 6> row_names{
    "real-time", "linear", "spline", "real-time - linear", "real-time - spline", "linear - spline"};
constexpr double farthest = 1e9;       // [mm] what is beyond is no position
constexpr std::size_t stretch = 4096;  // samples between two looks at the clock

struct ContourCommand {
    std::string trace;
    std::vector<std::string> command, actual;
    bool json = false, quiet = false;
};

/// What the rows of a trace say, in mm; commands that stand share a point.
struct Recording {
    struct Sample {
        Point command, actual;
        std::size_t point = 0;  ///< of `path`: the newest command point
    };
    std::vector<Sample> samples;
    std::vector<Point> path;
    std::size_t left_out = 0;
    double interval = 0, speed = 0;  ///< mean [s], [mm/s]; 0: no column `time`
};

struct Result {
    std::array<MagnitudeStatistics, row_names.size()> rows;  ///< [mm]
    std::array<double, method_names.size()> seconds{};       ///< for all samples
    MagnitudeStatistics points_back, following;
    std::size_t out_of_reach = 0;
};

/// What one unit of the column is in `unit`, 1 for a column without one; L0303 when it measures
/// something else.
double factor_to(std::string_view unit, const CsvColumn& column, const CsvTable& table,
                 Diagnostics& out) {
    const Unit wanted = *Unit::parse(unit);
    if (column.unit.empty()) return 1;
    const std::optional<Unit> given = Unit::parse(column.unit);
    if (given && given->same_dimension(wanted)) return convert(1, *given, wanted);
    out.add(code::unit_measures_something_else, {table.header, 1, 1, 1},
            fmt::format("column '{}' is in {}, not in {}", column.name, column.unit, unit),
            "choose columns of positions");
    return 1;
}

void set_interval_and_speed(const CsvTable& table, Recording& recording, Diagnostics& out) {
    const CsvColumn* time = table.find("time");
    if (!time || table.rows < 2) return;
    const double duration =
        factor_to("s", *time, table, out) * (time->values.back() - time->values.front());
    double way = 0;
    for (std::size_t i = 1; i < recording.path.size(); ++i)
        way += std::hypot(recording.path[i].x - recording.path[i - 1].x,
                          recording.path[i].y - recording.path[i - 1].y);
    if (!(duration > 0)) return;
    recording.interval = duration / static_cast<double>(table.rows - 1);
    recording.speed = way / duration;
}

Recording record(const CsvTable& table, const ContourCommand& command, Diagnostics& out) {
    const std::array names{command.command[0], command.command[1], command.actual[0],
                           command.actual[1]};
    std::array<const CsvColumn*, names.size()> columns{};
    std::array<double, names.size()> factors{};
    for (std::size_t i = 0; i < names.size(); ++i) {
        columns[i] = table.require(names[i], out);
        if (columns[i]) factors[i] = factor_to("mm", *columns[i], table, out);
    }
    Recording recording;
    if (!out.empty()) return recording;
    CommandPath path;
    for (std::size_t row = 0; row < table.rows; ++row) {
        std::array<double, names.size()> v{};
        bool usable = true;
        for (std::size_t i = 0; i < v.size(); ++i) {
            v[i] = columns[i]->values[row] * factors[i];
            usable = usable && std::abs(v[i]) <= farthest;
        }
        recording.left_out += usable ? 0 : 1;
        if (!usable) continue;
        if (path.add({v[0], v[1]})) recording.path.push_back({v[0], v[1]});
        recording.samples.push_back({{v[0], v[1]}, {v[2], v[3]}, recording.path.size() - 1});
    }
    if (recording.samples.empty())
        out.add(code::no_rows, {table.header, 1, 1, 1}, "no row has all four positions",
                "there is nothing to compare");
    set_interval_and_speed(table, recording, out);
    return recording;
}

/// The three methods over a recording, a stretch after the other.
class Comparer {
  public:
    explicit Comparer(const Recording& recording) : recording_(recording) {
        spans_.resize(recording.path.size() - 1);
        natural_spline(recording.path, spans_);
    }
    /// Samples from .. to - 1, at most `stretch`.
    void compare(std::size_t from, std::size_t to);
    const Result& result() const { return result_; }

  private:
    /// Its place in `path`, also among the commands behind the newest, where the actual point is
    /// ahead of it.
    std::size_t nearest_of_all(const Recording::Sample& sample,
                               const ContourEstimate& estimate) const;
    template <class Measure>
    void time(std::size_t method, std::size_t from, std::size_t to, const Measure& measure);
    void count(const Recording::Sample& sample, const ContourEstimate& estimate, double linear,
               double spline);

    const Recording& recording_;
    std::vector<SplineSpan> spans_;
    CommandPath path_;
    Result result_;
};

/// Runs `measure(sample, i)` with i = 0 .. to - from - 1.
template <class Measure>
void Comparer::time(std::size_t method, std::size_t from, std::size_t to, const Measure& measure) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = from; i < to; ++i) measure(recording_.samples[i], i - from);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    result_.seconds[method] += took.count();
}

std::size_t Comparer::nearest_of_all(const Recording::Sample& sample,
                                     const ContourEstimate& estimate) const {
    std::size_t at = sample.point - static_cast<std::size_t>(estimate.points_back);
    if (!estimate.at_newest) return at;
    const auto distance = [&](std::size_t i) {
        return std::hypot(sample.actual.x - recording_.path[i].x,
                          sample.actual.y - recording_.path[i].y);
    };
    while (at + 1 < recording_.path.size() && distance(at + 1) <= distance(at)) ++at;
    return at;
}

void Comparer::compare(std::size_t from, std::size_t to) {
    using Sample = Recording::Sample;
    std::array<ContourEstimate, stretch> estimates;
    std::array<double, stretch> linear{}, spline{};
    time(0, from, to, [&](const Sample& sample, std::size_t i) {
        path_.add(sample.command);
        estimates[i] = path_.estimate(sample.actual);
    });
    std::array<std::size_t, stretch> nearest{};
    for (std::size_t i = from; i < to; ++i)
        nearest[i - from] = nearest_of_all(recording_.samples[i], estimates[i - from]);
    time(1, from, to, [&](const Sample& sample, std::size_t i) {
        linear[i] = polyline_distance(recording_.path, nearest[i], sample.actual);
    });
    time(2, from, to, [&](const Sample& sample, std::size_t i) {
        spline[i] = spans_.empty() ? linear[i] : spline_distance(spans_, nearest[i], sample.actual);
    });
    for (std::size_t i = from; i < to; ++i)
        count(recording_.samples[i], estimates[i - from], linear[i - from], spline[i - from]);
}

void Comparer::count(const Recording::Sample& sample, const ContourEstimate& estimate,
                     double linear, double spline) {
    result_.out_of_reach += estimate.out_of_reach ? 1 : 0;
    if (estimate.out_of_reach) return;
    const double real_time = std::abs(estimate.signed_error);
    const std::array values{real_time,          linear,         spline, real_time - linear,
                            real_time - spline, linear - spline};
    for (std::size_t i = 0; i < values.size(); ++i) result_.rows[i].add(values[i]);
    result_.points_back.add(static_cast<double>(estimate.points_back));
    result_.following.add(
        std::hypot(sample.command.x - sample.actual.x, sample.command.y - sample.actual.y));
}

/// Empty when interrupted.
std::optional<Result> compare(const Recording& recording, bool quiet) {
    ProgressLine line(quiet);
    Comparer comparer(recording);
    const std::size_t all = recording.samples.size();
    for (std::size_t from = 0; from < all; from += stretch) {
        if (interrupt_requested) return {};
        comparer.compare(from, std::min(all, from + stretch));
        line.show([&](double) { return fmt::format("{} of {} samples", from, all); });
    }
    return comparer.result();
}

double ns_per_point(const Recording& recording, const Result& result, std::size_t method) {
    return result.seconds[method] * 1e9 / static_cast<double>(recording.samples.size());
}

std::string in_nm(double mm) {
    const double nm = mm * 1e6;
    return nm < 1e4 ? fmt::format("{:.4g}", nm) : fmt::format("{:.0f}", nm);
}

void print(const Recording& recording, const Result& result) {
    fmt::print("{} samples, {} command points", result.points_back.count, recording.path.size());
    if (recording.interval > 0)
        fmt::print(", one every {:.4g} ms, {:.4g} mm/s on average", recording.interval * 1e3,
                   recording.speed);
    fmt::print(
        "\nfollowing error {:.4g} mm on average, {:.4g} mm at most; nearest point {:.1f} "
        "before the newest on average, {:.0f} at most\n",
        result.following.mean, result.following.greatest, result.points_back.mean,
        result.points_back.greatest);
    if (recording.left_out + result.out_of_reach > 0)
        fmt::print("left out: {} rows without four positions, {} out of reach\n",
                   recording.left_out, result.out_of_reach);
    fmt::print("\n{:<20}{:>14}{:>14}{:>14}{:>16}\n", "contour error", "mean [nm]", "rms [nm]",
               "greatest [nm]", "time/point [us]");
    for (std::size_t i = 0; i < row_names.size(); ++i) {
        const MagnitudeStatistics& d = result.rows[i];
        fmt::print("{:<20}{:>14}{:>14}{:>14}", row_names[i], in_nm(d.mean), in_nm(d.rms),
                   in_nm(d.greatest));
        if (i < method_names.size())
            fmt::print("{:>16.3f}", ns_per_point(recording, result, i) / 1e3);
        fmt::print("\n");
    }
}

void print_json(const Recording& recording, const Result& result) {
    nlohmann::ordered_json out{{"samples", result.points_back.count},
                               {"command_points", recording.path.size()},
                               {"left_out", recording.left_out},
                               {"out_of_reach", result.out_of_reach},
                               {"interval_s", json_number(recording.interval)},
                               {"speed_mm_s", json_number(recording.speed)},
                               {"mean_following_error_mm", json_number(result.following.mean)},
                               {"mean_points_back", json_number(result.points_back.mean)}};
    for (std::size_t i = 0; i < row_names.size(); ++i) {
        const MagnitudeStatistics& d = result.rows[i];
        out["contour_error_mm"][row_names[i]] = {{"mean", json_number(d.mean)},
                                                 {"rms", json_number(d.rms)},
                                                 {"greatest", json_number(d.greatest)}};
    }
    for (std::size_t i = 0; i < method_names.size(); ++i)
        out["ns_per_point"][method_names[i]] = json_number(ns_per_point(recording, result, i));
    fmt::print("{}\n", out.dump(2));
}

Exit execute(const ContourCommand& command) {
    Diagnostics mistakes;
    const std::optional<CsvTable> table = read_csv(command.trace, mistakes);
    if (!table) return report(mistakes, command.json);
    const Recording recording = record(*table, command, mistakes);
    if (!mistakes.empty()) return report(mistakes, command.json);
    const std::optional<Result> result = compare(recording, command.quiet || command.json);
    if (!result) return Exit::interrupted;
    if (command.json)
        print_json(recording, *result);
    else
        print(recording, *result);
    return Exit::fine;
}

}  // namespace

void add_contour(CLI::App& app, Exit& result) {
    auto command = std::make_shared<ContourCommand>();
    CLI::App* sub = app.add_subcommand(
        "contour", "Compare the real-time contour error of a trace with polyline and spline");
    sub->add_option("trace", command->trace, "The CSV file")->required();
    add_signals(*sub, "--command", command->command, "Columns of the commanded x and y", 2)
        ->type_name("X,Y")
        ->required();
    add_signals(*sub, "--actual", command->actual, "Columns of the actual x and y", 2)
        ->type_name("X,Y")
        ->required();
    sub->add_flag("--json", command->json, "Print one JSON object for machines");
    sub->add_flag("--quiet", command->quiet, "No progress line");
    sub->footer(contour_help);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
