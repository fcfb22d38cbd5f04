#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "blocks/contour/baseline.hpp"
#include "blocks/contour/command_path.hpp"
#include "blocks/contour/deviation.hpp"
#include "runtime/model/units.hpp"
#include "runtime/trace/csv_reader.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

constexpr const char* help =
    "Each row is one command point with the actual point fed back in the same scan, as a trace\n"
    "of every scan has them. Contour errors, as magnitudes:\n"
    "  real-time  nearest command point so far, tangent from its neighbours (block contour_error)\n"
    "  linear     distance to the polyline of all command points\n"
    "  spline     distance to the natural cubic spline through all command points\n"
    "Rows whose nearest point has left the 512 points of the real-time memory, or that lack a\n"
    "cell, are left out and counted. Time per point: of this computer, and of the spline without\n"
    "that of making it. Units come from the trace's sidecar, else columns are in mm.";

constexpr std::array<const char*, 3> method_names{"real-time", "linear", "spline"};
constexpr std::array<const char*, 5> rows{"real-time", "linear", "spline", "real-time - linear",
                                          "real-time - spline"};

struct ContourCommand {
    std::string trace;
    std::vector<std::string> command, actual;
    bool json = false;
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
    std::array<Deviation, 5> deviations;  ///< [mm], as `rows`
    std::array<double, 3> nanoseconds{};  ///< per point
    Deviation points_back, following;
    std::size_t out_of_reach = 0;
};

/// What one `unit` of the column is in mm; L0303 when it is no length.
double factor_to_mm(const CsvColumn& column, const CsvTable& table, Diagnostics& out) {
    const Unit mm = *Unit::parse("mm");
    if (column.unit.empty()) return 1;
    const std::optional<Unit> unit = Unit::parse(column.unit);
    if (unit && unit->same_dimension(mm)) return convert(1, *unit, mm);
    out.add("L0303", {table.header, 1, 1, 1},
            fmt::format("column '{}' is in {}", column.name, column.unit),
            "a contour error is of lengths");
    return 1;
}

std::optional<Recording> record(const CsvTable& table, const ContourCommand& command,
                                Diagnostics& out) {
    std::array<const CsvColumn*, 4> columns{};
    std::array<double, 4> factors{};
    const std::array names{command.command[0], command.command[1], command.actual[0],
                           command.actual[1]};
    for (std::size_t i = 0; i < names.size(); ++i) {
        columns[i] = table.require(names[i], out);
        if (columns[i]) factors[i] = factor_to_mm(*columns[i], table, out);
    }
    if (!out.empty()) return {};
    Recording recording;
    CommandPath path;
    double way = 0;
    for (std::size_t row = 0; row < table.rows; ++row) {
        std::array<double, 4> v{};
        bool whole = true;
        for (std::size_t i = 0; i < v.size(); ++i) {
            v[i] = columns[i]->values[row] * factors[i];
            whole = whole && std::isfinite(v[i]);
        }
        recording.left_out += whole ? 0 : 1;
        if (!whole) continue;
        const Point point{v[0], v[1]};
        if (path.add(point)) {
            if (!recording.path.empty())
                way += std::hypot(point.x - recording.path.back().x,
                                  point.y - recording.path.back().y);
            recording.path.push_back(point);
        }
        recording.samples.push_back({point, {v[2], v[3]}, recording.path.size() - 1});
    }
    const CsvColumn* time = table.find("time");
    if (time && table.rows > 1) {
        const double duration = time->values[table.rows - 1] - time->values[0];
        recording.interval = duration / static_cast<double>(table.rows - 1);
        if (duration > 0) recording.speed = way / duration;
    }
    return recording;
}

/// Nanoseconds a point of `measure(i)` for all `count` points.
template <class Measure>
double timed(std::size_t count, const Measure& measure) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) measure(i);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    return took.count() / static_cast<double>(count);
}

Result compare(const Recording& recording) {
    const auto& [samples, points, left_out, interval, speed] = recording;
    Result result;
    std::vector<ContourEstimate> estimates(samples.size());
    std::vector<double> linear(samples.size()), spline(samples.size());
    CommandPath path;
    result.nanoseconds[0] = timed(samples.size(), [&](std::size_t i) {
        path.add(samples[i].command);
        estimates[i] = path.estimate(samples[i].actual);
    });
    const auto nearest = [&](std::size_t i) {
        return samples[i].point - static_cast<std::size_t>(estimates[i].points_back);
    };
    result.nanoseconds[1] = timed(samples.size(), [&](std::size_t i) {
        linear[i] = polyline_distance(points, nearest(i), samples[i].actual);
    });
    std::vector<SplineSpan> spans(points.size() - 1);
    natural_spline(points, spans);
    result.nanoseconds[2] = timed(samples.size(), [&](std::size_t i) {
        spline[i] =
            spans.empty() ? linear[i] : spline_distance(spans, nearest(i), samples[i].actual);
    });
    for (std::size_t i = 0; i < samples.size(); ++i) {
        result.out_of_reach += estimates[i].out_of_reach ? 1 : 0;
        if (estimates[i].out_of_reach) continue;
        const double real_time = std::abs(estimates[i].signed_error);
        const std::array values{real_time, linear[i], spline[i], real_time - linear[i],
                                real_time - spline[i]};
        for (std::size_t k = 0; k < values.size(); ++k) result.deviations[k].add(values[k]);
        result.points_back.add(static_cast<double>(estimates[i].points_back));
        result.following.add(std::hypot(samples[i].command.x - samples[i].actual.x,
                                        samples[i].command.y - samples[i].actual.y));
    }
    return result;
}

void print(const Recording& recording, const Result& result) {
    constexpr double nm = 1e6;
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
        fmt::print("left out: {} incomplete rows, {} out of reach\n", recording.left_out,
                   result.out_of_reach);
    fmt::print("\n{:<20}{:>14}{:>14}{:>14}{:>16}\n", "contour error", "mean [nm]", "rms [nm]",
               "greatest [nm]", "time/point [us]");
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Deviation& d = result.deviations[i];
        fmt::print("{:<20}{:>14.4g}{:>14.4g}{:>14.4g}", rows[i], d.mean * nm, d.rms * nm,
                   d.greatest * nm);
        if (i < method_names.size()) fmt::print("{:>16.3f}", result.nanoseconds[i] / 1e3);
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
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const Deviation& d = result.deviations[i];
        out["contour_error_mm"][rows[i]] = {{"mean", json_number(d.mean)},
                                            {"rms", json_number(d.rms)},
                                            {"greatest", json_number(d.greatest)}};
    }
    for (std::size_t i = 0; i < method_names.size(); ++i)
        out["ns_per_point"][method_names[i]] = json_number(result.nanoseconds[i]);
    fmt::print("{}\n", out.dump(2));
}

Exit execute(const ContourCommand& command) {
    Diagnostics mistakes;
    const std::optional<CsvTable> table = read_csv(command.trace, mistakes);
    if (!table) return report(mistakes, command.json);
    const std::optional<Recording> recording = record(*table, command, mistakes);
    if (recording && recording->samples.empty())
        mistakes.add("L0705", {table->header, 1, 1, 1}, "no row has all four values",
                     "the file has a header and nothing to compare");
    if (!recording || !mistakes.empty()) return report(mistakes, command.json);
    const Result result = compare(*recording);
    if (command.json)
        print_json(*recording, result);
    else
        print(*recording, result);
    return Exit::fine;
}

}  // namespace

void add_contour(CLI::App& app, Exit& result) {
    auto command = std::make_shared<ContourCommand>();
    CLI::App* sub = app.add_subcommand(
        "contour", "Compare the real-time contour error of a trace with polyline and spline");
    sub->add_option("trace", command->trace, "The CSV file")->required();
    sub->add_option("--command", command->command, "Columns of the commanded x and y")
        ->type_name("X,Y")
        ->delimiter(',')
        ->expected(2)
        ->required();
    sub->add_option("--actual", command->actual, "Columns of the actual x and y")
        ->type_name("X,Y")
        ->delimiter(',')
        ->expected(2)
        ->required();
    sub->add_flag("--json", command->json, "Print one JSON object for machines");
    sub->footer(help);
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
