#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/csv/csv_reader.hpp"
#include "runtime/csv/csv_time.hpp"
#include "runtime/model/literal.hpp"
#include "runtime/outside/outside.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t most_memory = std::size_t{256} << 20;  // bytes, of all replays

/// Whether the values of a column may be those of an input; an untyped one is looked at cell by
/// cell.
bool fits(const CsvColumn& column, bool is_typed, const Field& input) {
    if (!is_typed) return true;
    const bool fits = column.type == input.type ||
                      (column.type == Type::integer &&
                       (input.type == Type::real || input.type == Type::unsigned_integer));
    return fits && std::ranges::equal(column.names, input.names) &&
           column.numbers == input.names.odd_numbers();
}

std::optional<Value> as_whole(double value, Type type) {
    if (value != std::trunc(value) || std::abs(value) >= 9e15) return {};
    return whole_value(static_cast<std::int64_t>(value), type);
}

/// A cell as the value of an input; empty where it is none of its type.
std::optional<Value> cell(const CsvColumn& column, std::size_t row, const Field& input,
                          const Unit& from, const Unit& to) {
    const bool same_unit = from.text == to.text;
    if (is_integer(input.type) && column.type == Type::integer && same_unit)
        return whole_value(column.integer(row), input.type);
    if (input.type == Type::enumeration && column.type != Type::real) {
        const auto stored = input.names.stored(column.integer(row));
        return stored && input.names.takes(*stored) ? std::optional<Value>(*stored) : std::nullopt;
    }
    const double value = column.values[row];
    const auto among = [&](std::size_t count) {
        return value >= 0 && value < static_cast<double>(count);
    };
    switch (input.type) {
        case Type::boolean:
            return among(2) && as_whole(value, input.type) ? std::optional<Value>(value == 1)
                                                           : std::nullopt;
        case Type::enumeration: {
            const auto number = as_whole(value, input.type);
            return number && input.admits(*number) ? number : std::nullopt;
        }
        case Type::integer:
        case Type::unsigned_integer:
            return as_whole(same_unit ? value : convert(value, from, to), input.type);
        case Type::real:
            break;
    }
    const double converted = same_unit ? value : convert(value, from, to);
    const bool is_beyond = std::isfinite(value) && !std::isfinite(converted);
    return is_beyond ? std::nullopt : std::optional<Value>(converted);
}

/// What the file says, else `wanted`; both measure the same, or it is L0303.
std::optional<Unit> column_unit(Connecting& to, const CsvColumn& column, const std::string& wanted,
                                const Node& place) {
    const Unit& due = to.net.unit(wanted);
    const auto found = column.unit.empty() ? std::optional(due) : Unit::parse(column.unit);
    if (found && found->same_dimension(due)) return found;
    to.read.fail(code::unit_measures_something_else, place,
                 fmt::format("column '{}' is in {}, not in {}", column.name, column.unit,
                             wanted.empty() ? "plain numbers" : wanted));
    return {};
}

std::optional<Target> replayed(Connecting& to, const ReplayPlan& plan, const Node& key) {
    auto input = find_settable(to, key);
    if (!input || !plan.interpolated || input->field.type == Type::real) return input;
    to.read.fail(code::entries_do_not_go_together, key,
                 fmt::format("'{}' is {}: there is nothing between two values", key.text,
                             kind(input->field.type, input->field.names)),
                 "only reals are interpolated: between: held");
    return {};
}

/// In ns of the run, a row each.
std::optional<std::vector<std::int64_t>> replay_times(Connecting& to, const ReplayPlan& plan,
                                                      const CsvTable& table) {
    const CsvColumn& time = *table.find("time");
    const auto fail = [&](const char* code, const std::string& message, const char* help) {
        to.read.fail(code, plan.file, message, help);
        return std::nullopt;
    };
    if (table.rows == 0)
        return fail(code::no_rows, fmt::format("'{}' has no rows", plan.file.text),
                    "there is nothing to replay");
    const auto unit = column_unit(to, time, "s", plan.file);
    if (!unit) return {};
    std::vector<std::int64_t> times;
    times.reserve(table.rows);
    for (std::size_t row = 0; row < table.rows; ++row) {
        const bool missing = time.is_missing(row);
        if (missing || (row > 0 && time.values[row] < time.values[row - 1]))
            return fail(code::time_does_not_rise,
                        fmt::format("the time in line {} of '{}' {}", line_of(row), plan.file.text,
                                    missing ? "is missing" : "is before that of the line above"),
                        "rows stand in the order of time");
        const auto at = time_of(time, row, *unit, plan.at, to.read, plan.file);
        if (!at) return {};
        times.push_back(*at);
    }
    return times;
}

void wrong_cell(Connecting& to, const Target& input, const Node& name, const CsvColumn& column,
                std::size_t row, bool is_out_of_range) {
    const std::string what =
        fmt::format("'{}' in line {} of column '{}'", format_number(column.values[row]),
                    line_of(row), name.text);
    if (is_out_of_range)
        to.read.fail(code::number_out_of_range, name,
                     fmt::format("{} is out of range for '{}'", what, input.signal.name),
                     "it must be " + describe_limits(input.field, input.signal.unit));
    else
        to.read.fail(code::cell_is_no_number, name,
                     fmt::format("{} is not a value of '{}'", what, input.signal.name),
                     "it takes " + kind(input.field.type, input.field.names));
}

/// Those of the rows that have a value; none when anything is wrong.
std::vector<Replay::Point> replay_points(Connecting& to, const Target& input, const Node& name,
                                         const CsvTable& table,
                                         const std::vector<std::int64_t>& times) {
    const CsvColumn& column = *table.find(name.text);
    const bool is_typed = table.metadata && table.metadata->find(column.title);
    const std::vector<std::string_view> names(column.names.begin(), column.names.end());
    if (!fits(column, is_typed, input.field)) {
        to.read.fail(code::wire_between_types, name,
                     fmt::format("column '{}' is {}, '{}' takes {}", name.text,
                                 kind(column.type, std::span(names)), input.signal.name,
                                 kind(input.field.type, input.field.names)));
        return {};
    }
    const auto unit = column_unit(to, column, input.signal.unit, name);
    if (!unit) return {};
    std::vector<Replay::Point> points;
    points.reserve(table.rows);
    for (std::size_t row = 0; row < table.rows; ++row) {
        if (column.is_missing(row)) continue;
        const auto value = cell(column, row, input.field, *unit, to.net.unit(input.signal.unit));
        if (!value || !input.field.admits(*value)) {
            wrong_cell(to, input, name, column, row, value.has_value());
            return {};
        }
        points.push_back({.time = times[row]});
        store(input.field.type, points.back().value.data(), *value);
    }
    if (points.empty())
        to.read.fail(code::no_rows, name, fmt::format("column '{}' has no values", name.text),
                     "there is nothing to replay");
    return points;
}

/// `room` is for so many points more.
void add_replay(Connecting& to, const ReplayPlan& plan, std::size_t& room) {
    std::vector<std::optional<Target>> targets;
    for (const auto& [key, column] : plan.set) targets.push_back(replayed(to, plan, key));
    if (plan.path.empty() || plan.set.empty()) return;
    CsvOptions csv{.columns = {"time"}, .most_rows = room / plan.set.size()};
    for (const auto& [key, column] : plan.set) csv.columns.push_back(column.text);
    const auto table = read_csv(plan.path, to.read.diagnostics(), csv);
    if (!table) return;
    to.machine.replayed.push_back({plan.file.text, table->crc32});
    room -= table->rows * plan.set.size();
    const auto times = replay_times(to, plan, *table);
    if (!times) return;
    using enum Replay::Between;
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (!targets[i]) continue;
        auto points = replay_points(to, *targets[i], plan.set[i].second, *table, *times);
        if (!points.empty())
            to.machine.replays.emplace_back(targets[i]->live, targets[i]->field.type,
                                            plan.interpolated ? interpolated : held,
                                            std::move(points));
    }
}

}  // namespace

void connect_replays(Connecting& to) {
    std::size_t room = most_memory / sizeof(Replay::Point);
    for (const ReplayPlan& plan : to.program.replays) add_replay(to, plan, room);
}

}  // namespace lineshaft
