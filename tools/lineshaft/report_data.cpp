#include "tools/lineshaft/report_data.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include "runtime/csv/csv_cells.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/json_text.hpp"
#include "runtime/source/units.hpp"
#include "runtime/source/yaml.hpp"
#include "runtime/trace/event_writer.hpp"
#include "tools/lineshaft/packing.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

Mark header_of(const CsvTable& table) {
    return {table.header, 1, 1, 1};
}

bool is_expectation(const Json& object) {
    const auto is = [&](const char* key, auto check) {
        return object.contains(key) && (object[key].*check)();
    };
    const auto number_or_none = [&](const char* key) {
        return !object.contains(key) || object[key].is_number();
    };
    return object.is_object() && is("text", &Json::is_string) && is("signal", &Json::is_string) &&
           is("ok", &Json::is_boolean) && is("always", &Json::is_boolean) && number_or_none("at") &&
           number_or_none("low") && number_or_none("high");
}

/// What the run's sidecar says beside what it says of the columns; read_csv has complained about a
/// bad one.
void read_sidecar(const std::string& csv_path, ReportRun& run, Diagnostics& out) {
    if (!std::filesystem::exists(sidecar_path(csv_path))) return;
    const auto file = read_source(sidecar_path(csv_path), out);
    if (!file) return;
    const Json sidecar = parse_json(file->text);
    if (!sidecar.is_object()) return;
    const auto list = [&](const char* key, auto is_good, Json& to) {
        if (const auto it = sidecar.find(key); it != sidecar.end())
            for (const Json& item : *it)
                if (is_good(item)) to.push_back(item);
    };
    list("lineshaft:expectations", is_expectation, run.expectations);
    list(
        "lineshaft:notes", [](const Json& note) { return note.is_string(); }, run.notes);
    if (const auto it = sidecar.find("lineshaft:report"); it != sidecar.end() && it->is_object())
        run.arrangement = *it;
}

/// What the run's list of events has, if there is one beside the trace.
Json read_events(const std::string& csv_path) {
    constexpr std::size_t most = 1000;
    Json list = Json::array();
    std::error_code unknown;  // then there is none
    if (!std::filesystem::is_regular_file(events_path(csv_path), unknown)) return list;
    std::ifstream file(events_path(csv_path));
    std::string line;
    std::getline(file, line);
    while (list.size() < most && std::getline(file, line)) {
        const std::vector<std::string> cells = csv_cells(line);
        if (cells.size() != 5) continue;
        const Json time = Json::parse(cells[0], nullptr, false);
        if (!time.is_number()) continue;
        list.push_back({{"time", time},
                        {"scan", cells[1]},
                        {"task", cells[2]},
                        {"kind", cells[3]},
                        {"text", cells[4]}});
    }
    return list;
}

bool check_sidecar(const CsvTable& table, Diagnostics& out) {
    if (!table.metadata) return true;
    for (const CsvColumn& column : table.columns)
        if (!table.metadata->find(column.title)) {
            out.add(code::sidecar_of_another_trace, header_of(table),
                    fmt::format("the sidecar of this file knows no column '{}'", column.title),
                    "it belongs to another trace");
            return false;
        }
    return true;
}

bool check_time(const CsvTable& table, const CsvColumn& time, Diagnostics& out) {
    if (table.rows == 0) {
        out.add(code::no_rows, header_of(table), "the trace has no rows",
                "there is nothing to draw");
        return false;
    }
    for (std::size_t row = 0; row < table.rows; ++row) {
        if (!time.is_missing(row) && (row == 0 || time.values[row] >= time.values[row - 1]))
            continue;
        out.add(code::time_does_not_rise, header_of(table),
                fmt::format("the time {} in row {}", time.is_missing(row) ? "is missing" : "falls",
                            row + 1),
                "rows stand in the order of time");
        return false;
    }
    return true;
}

/// Mean time between two rows [s]; 0 when the rows are not evenly spaced.
double interval(const ReportRun& run) {
    const auto& times = run.time->values;
    if (times.size() < 2) return 0;
    const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    for (std::size_t i = 1; i < times.size(); ++i)
        if (std::abs(times[i] - times[i - 1] - mean) > 0.1 * mean) return 0;
    return mean;
}

std::vector<std::string> names(const ReportRun& run) {
    std::vector<std::string> list;
    for (const CsvColumn* signal : run.signals) list.push_back(signal->name);
    return list;
}

bool is_length(const CsvColumn& column) {
    const auto unit = Unit::parse(column.unit);
    return column.type == Type::real && unit && unit->same_dimension(*Unit::parse("mm"));
}

/// `x_drive.position` -> `y_drive.position`, where x stands for itself; empty where none does.
std::string with_y(std::string name) {
    bool any = false;
    const auto letter = [&](std::size_t i) {
        return i < name.size() && std::isalnum(static_cast<unsigned char>(name[i])) != 0;
    };
    for (std::size_t i = 0; i < name.size(); ++i) {
        if (name[i] != 'x' || (i > 0 && letter(i - 1)) || letter(i + 1)) continue;
        name[i] = 'y';
        any = true;
    }
    return any ? name : std::string();
}

/// The samples but for their bytes, which go behind `bytes`.
Json packed_json(std::span<const double> samples, std::string& bytes) {
    const PackedSamples packed = pack(samples);
    bytes += packed.bytes;
    return {{"count", packed.count}, {"scale", packed.scale},       {"order", packed.order},
            {"width", packed.width}, {"outliers", packed.outliers}, {"missing", packed.missing}};
}

/// What the page draws as missing, and shows as what it is: first, count and text of each stretch.
Json stretches_not_finite(const CsvColumn& column) {
    Json list = Json::array();
    for (std::size_t row = 0; row < column.values.size(); ++row) {
        if (column.is_finite(row) || column.is_missing(row)) continue;
        const std::string text = format_number(column.values[row]);
        const bool goes_on =
            !list.empty() && list.back()[2] == text &&
            list.back()[0].get<std::size_t>() + list.back()[1].get<std::size_t>() == row;
        if (goes_on)
            list.back()[1] = list.back()[1].get<std::size_t>() + 1;
        else
            list.push_back({row, 1, text});
    }
    return list;
}

Json packed_signal(const CsvColumn& column, std::string& bytes) {
    Json packed = packed_json(column.values, bytes);
    packed["extremes"] = packed_json(chunk_extremes(column.values), bytes);
    if (Json odd = stretches_not_finite(column); !odd.empty())
        packed["not_finite"] = std::move(odd);
    return packed;
}

/// Times of a trace are whole nanoseconds; as such they pack to nothing and come back exactly.
Json packed_times(const CsvColumn& time, std::string& bytes) {
    std::vector<double> nanoseconds(time.values.size());
    std::ranges::transform(time.values, nanoseconds.begin(),
                           [](double t) { return std::round(t * 1e9); });
    return packed_json(nanoseconds, bytes);
}

}  // namespace

std::optional<ReportRun> read_run(const std::string& path, const std::vector<std::string>& wanted,
                                  Diagnostics& out) {
    CsvOptions options{.columns = wanted};
    if (!wanted.empty()) options.columns.emplace_back("time");
    auto table = read_csv(path, out, options);
    if (!table || !check_sidecar(*table, out)) return {};
    ReportRun run{.table = std::move(*table), .path = path, .signals = {}};
    run.time = run.table.require("time", out);
    if (!run.time || !check_time(run.table, *run.time, out)) return {};
    for (const CsvColumn& column : run.table.columns)
        if (&column != run.time && column.name != "scan") run.signals.push_back(&column);
    read_sidecar(path, run, out);
    run.events = read_events(path);
    return run;
}

void check_overlay(const ReportRun& first, const ReportRun& second, Diagnostics& out) {
    const auto ours = names(first), theirs = names(second);
    const auto lacks = [&](const ReportRun& run, const std::vector<std::string>& its,
                           const ReportRun& other, const std::vector<std::string>& others) {
        const auto missing = std::ranges::find_if(others, [&](const std::string& name) {
            return std::ranges::find(its, name) == its.end();
        });
        if (missing == others.end()) return false;
        out.add(code::traces_of_other_signals, header_of(run.table),
                fmt::format("the trace has no column '{}', which {} has", *missing, other.path),
                "only runs of the same signals can be laid over each other; --signals picks some");
        return true;
    };
    if (lacks(second, theirs, first, ours) || lacks(first, ours, second, theirs)) return;
    const double a = interval(first), b = interval(second);
    if (a == 0 || b == 0 || std::abs(a - b) <= 0.05 * std::min(a, b)) return;
    out.add(code::traces_of_other_intervals, header_of(second.table),
            fmt::format("the trace has a row each {:.6g} ms, but each {:.6g} ms in {}", b * 1e3,
                        a * 1e3, first.path),
            "record both at the same interval");
}

std::vector<PathPair> find_paths(const ReportRun& run) {
    std::vector<PathPair> pairs;
    for (const CsvColumn* x : run.signals) {
        if (!is_length(*x)) continue;
        const std::string y = with_y(x->name);
        for (const CsvColumn* signal : run.signals)
            if (signal->name == y && signal->unit == x->unit && is_length(*signal))
                pairs.push_back({x->name, y});
    }
    return pairs;
}

nlohmann::ordered_json to_json(const ReportRun& run) {
    std::string bytes;
    const Json times = packed_times(*run.time, bytes);
    Json signals = Json::array();
    for (const CsvColumn* column : run.signals) {
        Json signal{{"name", column->name},
                    {"unit", column->unit},
                    {"type", name_of(column->type)},
                    {"data", packed_signal(*column, bytes)}};
        if (!column->names.empty()) signal["names"] = column->names;
        for (const Wide number : column->numbers)
            signal["numbers"].push_back(static_cast<double>(number));
        signals.push_back(std::move(signal));
    }
    const auto& metadata = run.table.metadata;
    return {
        {"label", run.label},
        {"title", metadata ? metadata->title : ""},
        {"version", metadata ? metadata->version : ""},
        {"program", metadata ? metadata->program : ""},
        {"made_by", metadata ? Json(std::map(metadata->made_by.begin(), metadata->made_by.end()))
                             : Json::object()},
        {"rows", run.table.rows},
        {"time", times},
        {"signals", signals},
        {"bytes", base64(deflated(bytes))},
        {"notes", run.notes},
        {"expectations", run.expectations},
        {"events", run.events}};
}

}  // namespace lineshaft
