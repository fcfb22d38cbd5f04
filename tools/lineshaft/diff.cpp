#include <fmt/format.h>

#include "runtime/run/signal_json.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/units.hpp"
#include "runtime/trace/compare.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

struct DiffCommand {
    std::string a, b, page;
    std::vector<std::string> tolerances;
    std::size_t window = 3;
    bool any_program = false, common = false, json = false, quiet = false;
};

/// What `text` is in the unit of `column`; a bare number is in that unit.
std::optional<double> read_tolerance(const std::string& text, const CsvColumn* column,
                                     Diagnostics& out) {
    const auto parsed = parse_quantity(text);
    const auto* quantity = std::get_if<Quantity>(&parsed);
    if (!quantity || quantity->number < 0) {
        out.add(code::not_a_number, {}, fmt::format("'{}' is not a tolerance", text),
                "write --tolerance 1e-9 or --tolerance a.x=1um");
        return {};
    }
    if (!quantity->has_unit) return quantity->number;
    const auto unit = column ? Unit::parse(column->unit) : std::nullopt;
    if (unit && unit->same_dimension(quantity->unit))
        return convert(quantity->number, quantity->unit, *unit);
    out.add(code::unit_measures_something_else, {},
            column ? fmt::format("'{}' does not measure '{}'", text, column->name)
                   : fmt::format("'{}' has a unit, but is for columns of all units", text),
            "write --tolerance COLUMN=VALUE");
    return {};
}

Tolerances read_tolerances(const std::vector<std::string>& texts, const CsvTable& table,
                           Diagnostics& out) {
    Tolerances tolerances;
    for (const std::string& text : texts) {
        const auto equals = text.find('=');
        if (equals == std::string::npos) {
            tolerances.all = read_tolerance(text, nullptr, out).value_or(0);
        } else if (const auto* column = table.require(text.substr(0, equals), out)) {
            const auto value = read_tolerance(text.substr(equals + 1), column, out);
            tolerances.columns[column->name] = value.value_or(0);
        }
    }
    return tolerances;
}

std::string cell(const CsvColumn& column, std::size_t row) {
    if (column.is_missing(row)) return "";
    if (column.type != Type::real) return fmt::format("{}", column.integer(row));
    return format_number(column.values[row]);
}

std::string distance(const CsvColumn& a, const CsvColumn& b, std::size_t row) {
    if (a.is_missing(row) || b.is_missing(row)) return "a value is missing";
    if (a.type != Type::real || !a.is_finite(row) || !b.is_finite(row)) return "";
    const double x = a.values[row], y = b.values[row];
    return fmt::format("{} apart, {} ulp", format_number(std::abs(x - y)), ulp_distance(x, y));
}

void print_window(const DiffCommand& command, const CsvTable& a, const CsvTable& b,
                  const TraceComparison& found) {
    const auto [row, index] = *found.first;
    const CsvColumn &x = a.columns[index], &y = b.columns[index];
    const CsvColumn *time = a.find("time"), *scan = a.find("scan");
    fmt::print("   {:>12} {:>10}  {:>24} {:>24}\n", "time", "scan", "A", "B");
    const std::size_t first = row - std::min(row, command.window);
    const std::size_t last = std::min(found.compared - 1, row + command.window);
    for (std::size_t i = first; i <= last; ++i)
        fmt::print("{} {:>12} {:>10}  {:>24} {:>24}{}\n", i == row ? " >" : "  ",
                   time ? cell(*time, i) : "", scan ? cell(*scan, i) : "", cell(x, i), cell(y, i),
                   cell(x, i) == cell(y, i) ? "" : "  " + distance(x, y, i));
}

std::vector<RunDifference> differences(const CsvTable& a, const CsvTable& b) {
    if (!a.metadata || !b.metadata) return {};
    return run_differences(*a.metadata, *b.metadata);
}

/// Sums up the columns with any distance, also where it is tolerated.
void print_summary(const CsvTable& a, const TraceComparison& found) {
    if (found.apart.empty()) return;
    fmt::print("\n{:32} {:>14} {:>14}  {}\n", "apart", "greatest", "rms", "where");
    const CsvColumn* time = a.find("time");
    for (const ColumnDistance& each : found.apart) {
        const CsvColumn& column = a.columns[each.column];
        fmt::print(
            "{:32} {:>14.6g} {:>14.6g}  row {}{}\n",
            column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit),
            each.greatest, each.rms, each.row + 1,
            time ? ", at " + cell(*time, each.row) + " s" : "");
    }
}

void print_text(const DiffCommand& command, const CsvTable& a, const CsvTable& b,
                const TraceComparison& found) {
    if (!command.quiet)
        for (const auto& [what, x, y] : differences(a, b))
            fmt::print("{}: {}, {}\n", what, x.empty() ? "none" : x, y.empty() ? "none" : y);
    if (found.same(a, b)) {
        if (command.quiet) return;
        fmt::print("{}: {} rows of {} columns\n", found.apart.empty() ? "same" : "within tolerance",
                   a.rows, a.columns.size());
        return print_summary(a, found);
    }
    if (a.rows != b.rows) fmt::print("{} and {} rows\n", a.rows, b.rows);
    if (!found.first) return;
    const auto [row, index] = *found.first;
    const CsvColumn& x = a.columns[index];
    const CsvColumn *time = a.find("time"), *scan = a.find("scan");
    fmt::print("first deviation: row {}{}{}, {}{}\n", row + 1,
               scan ? ", scan " + cell(*scan, row) : "",
               time ? ", at " + cell(*time, row) + " s" : "", x.name,
               x.unit.empty() ? "" : " [" + x.unit + "]");
    print_window(command, a, b, found);
    fmt::print("{} of {} rows deviate, in {} cells\n", found.rows, found.compared, found.cells);
    if (!found.greatest) return;
    const auto [at, column] = *found.greatest;
    fmt::print("greatest: row {}, {}: {}\n", at + 1, a.columns[column].name,
               distance(a.columns[column], b.columns[column], at));
    print_summary(a, found);
}

/// Null where the cell is empty.
nlohmann::ordered_json cell_json(const CsvColumn& column, std::size_t row) {
    return column.is_missing(row) ? nlohmann::ordered_json() : real_json(column.values[row]);
}

nlohmann::ordered_json to_json(const CsvTable& a, const CsvTable& b, const Deviation& deviation) {
    const auto [row, index] = deviation;
    const CsvColumn &x = a.columns[index], &y = b.columns[index];
    nlohmann::ordered_json object{{"row", row + 1},
                                  {"column", x.name},
                                  {"unit", x.unit},
                                  {"a", cell_json(x, row)},
                                  {"b", cell_json(y, row)}};
    if (x.type == Type::real && x.is_finite(row) && y.is_finite(row))
        object["ulp"] = ulp_distance(x.values[row], y.values[row]);
    if (const CsvColumn* scan = a.find("scan")) object["scan"] = json_number(scan->values[row]);
    if (const CsvColumn* time = a.find("time")) object["time_s"] = json_number(time->values[row]);
    return object;
}

void print_json(const CsvTable& a, const CsvTable& b, const TraceComparison& found) {
    nlohmann::ordered_json object{{"same", found.same(a, b)},
                                  {"rows_a", a.rows},
                                  {"rows_b", b.rows},
                                  {"rows_deviating", found.rows},
                                  {"cells", found.cells}};
    object["columns"] = nlohmann::ordered_json::array();
    for (const auto& [column, greatest, rms, row] : found.apart)
        object["columns"].push_back({{"column", a.columns[column].name},
                                     {"unit", a.columns[column].unit},
                                     {"greatest", json_number(greatest)},
                                     {"rms", json_number(rms)},
                                     {"row", row + 1}});
    for (const auto& [what, x, y] : differences(a, b))
        object["runs"].push_back({{"what", what}, {"a", x}, {"b", y}});
    if (found.first) object["first"] = to_json(a, b, *found.first);
    if (found.greatest) object["greatest"] = to_json(a, b, *found.greatest);
    fmt::print("{}\n", object.dump(2));
}

/// Leaves what both have; L0708 when that is nothing but the time.
void keep_common(CsvTable& a, CsvTable& b, Diagnostics& out) {
    lineshaft::keep_common(a, b);
    if (std::ranges::any_of(a.columns, [](const CsvColumn& column) {
            return column.name != "time" && column.name != "scan";
        }))
        return;
    out.add(code::traces_cannot_be_compared, {b.header, 0, 0, 1},
            fmt::format("the trace has no column in common with '{}'", a.header->path));
}

Exit draw(const DiffCommand& command, const CsvTable& a) {
    std::vector<std::string> signals;
    for (const CsvColumn& column : a.columns)
        if (column.name != "time" && column.name != "scan") signals.push_back(column.name);
    return write_report({command.a, command.b}, std::move(signals), command.page, command.quiet);
}

Exit execute(const DiffCommand& command) {
    Diagnostics out;
    auto a = read_csv(command.a, out);
    auto b = read_csv(command.b, out);
    Tolerances tolerances;
    check_outputs({command.page}, {command.a, command.b}, out);
    if (a && b && command.common) keep_common(*a, *b, out);
    if (a && b) check_comparable(*a, *b, !command.any_program, out);
    if (a && b) tolerances = read_tolerances(command.tolerances, *a, out);
    if (!out.empty()) return report(out, command.json);
    const TraceComparison found = compare(*a, *b, tolerances);
    if (command.json)
        print_json(*a, *b, found);
    else
        print_text(command, *a, *b, found);
    if (!command.page.empty())
        if (const Exit drawn = draw(command, *a); drawn != Exit::fine) return drawn;
    return found.same(*a, *b) ? Exit::fine : Exit::failed;
}

}  // namespace

void add_diff(CLI::App& app, Exit& result) {
    auto command = std::make_shared<DiffCommand>();
    CLI::App* sub =
        app.add_subcommand("diff", "Compare two traces; exit code 1 where they deviate");
    sub->add_option("A", command->a, "A trace, CSV")->required();
    sub->add_option("B", command->b, "The trace to compare with it")->required();
    sub->add_option("--tolerance", command->tolerances,
                    "How far values may lie apart: 1e-9 (in the unit of each real column), or "
                    "a.x=1um for one column; default: not at all")
        ->type_name("[COLUMN=]VALUE")
        ->take_all()
        ->expected(1, -1)
        ->trigger_on_parse(false);
    sub->add_option("--window", command->window, "Rows shown before and after the first deviation")
        ->check(CLI::Range(0, 1'000'000))
        ->capture_default_str();
    sub->add_flag("--common", command->common, "Compare the columns that both have");
    sub->add_option("--report", command->page, "Draw both into this page, too")
        ->type_name("FILE.html");
    sub->add_flag("--any-program", command->any_program, "The programs may differ");
    sub->add_flag("--json", command->json, "Print one JSON object for machines");
    sub->add_flag("--quiet", command->quiet, "Say nothing when they are the same");
    sub->callback([command, &result] { result = execute(*command); });
}

}  // namespace lineshaft
