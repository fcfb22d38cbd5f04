#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/csv/csv_reader.hpp"
#include "runtime/csv/csv_time.hpp"
#include "runtime/model/literal.hpp"
#include "runtime/names/resolve.hpp"
#include "runtime/source/codes.hpp"

namespace lineshaft {

namespace {

/// A parameter whose value other fields' units may depend on.
bool is_choice(const Field& field) {
    return field.direction == Direction::parameter && field.type == Type::enumeration;
}

/// What is neither a wire nor a constant, but was meant as a wire.
bool resembles_wire(const Node& node) {
    return !node.quoted && !node.text.empty() && is_identifier(node.text.substr(0, 1)) &&
           node.text.find_first_of(".(") != std::string::npos;
}

/// `every(servo)`: the interval of a task, for blocks that reckon with a clock; `every()` that of
/// the block's own. Times that are integers are in ns.
std::optional<Value> interval_of(const Resolving& to, const Assignment& assignment,
                                 const Unit& unit) {
    const Field& field = *assignment.field;
    const Node& value = *assignment.value;
    static const Unit second = *Unit::parse("s");
    if (!value.text.starts_with("every(") || !value.text.ends_with(')') ||
        !unit.same_dimension(second))
        return {};
    const std::string name = value.text.substr(6, value.text.size() - 7);
    const int number = name.empty() ? to.net.instance(assignment.instance).task
                                    : to.net.find_task(to.read, value, name);
    if (number < 0) return 0.0;
    const TaskSettings& task = to.net.tasks[static_cast<std::size_t>(number)];
    if (task.on_event) {
        to.read.fail(code::entries_do_not_go_together, value,
                     fmt::format("'{}' is an event task: it has no interval", task.name));
        return 0.0;
    }
    if (is_integer(field.type)) return whole_value(task.every, field.type);
    return convert(seconds(task.every), second, unit);
}

/// Where `word` is a name of the program and no value: how what it names is written.
std::string meant_by(const Resolving& to, const std::string& word) {
    const Net& net = to.net;
    if (word == "true" || word == "false") return {};
    if (std::ranges::any_of(to.program.parameters,
                            [&](const auto& parameter) { return parameter.first == word; }))
        return fmt::format("did you mean the parameter '${}'?", word);
    if (std::ranges::find(net.inputs, word, &InputNode::name) != net.inputs.end())
        return fmt::format("did you mean the input 'inputs.{}'?", word);
    const auto it = net.instance_numbers.find(word);
    if (it == net.instance_numbers.end()) return {};
    std::vector<std::string> outputs;
    const Instance& block = net.instance(it->second);
    for (const Field& field : block.known() ? block.type->fields : std::span<const Field>())
        if (field.direction == Direction::output)
            outputs.push_back(fmt::format("{}.{}", word, field.name));
    return fmt::format("'{}' is a block; a wire names its output: {}", word,
                       fmt::join(outputs, ", "));
}

void set_constant(Resolving& to, const Assignment& assignment) {
    const auto& [number, field, value, wire] = assignment;
    const Unit& unit = to.net.unit_of(to.net.port(number, *field));
    std::optional<Value> constant = interval_of(to, assignment, unit);
    if (!constant && field->direction == Direction::input && resembles_wire(*value))
        return to.read.fail(code::unknown_signal, *value,
                            fmt::format("'{}' is neither a constant nor a wire", value->text),
                            "a wire is written block.port, NOT block.port or previous(block.port)");
    if (const std::string meant = meant_by(to, value->text);
        !constant && !value->quoted && !meant.empty() &&
        std::ranges::find(field->names, value->text) == field->names.end())
        return to.read.fail(code::unknown_signal, *value,
                            fmt::format("'{}' is neither a constant nor a wire", value->text),
                            meant);
    if (!constant) constant = read_literal(to.read, *value, *field, unit);
    if (constant)
        store(field->type, to.instance(assignment).image.data() + field->offset, *constant);
}

std::string columns_of(const TableField& table) {
    std::vector<std::string_view> names;
    for (const Field& column : table.columns) names.push_back(column.name);
    return fmt::format("write [{}]", fmt::join(names, ", "));
}

/// An empty value of a column that need not be given leaves it as it is.
void set_row(Resolving& to, const Instance& block, const TableField& table, const Node& row,
             std::byte* slot) {
    if (!to.read.expect_sequence(row, fmt::format("a row of '{}'", table.name), columns_of(table)))
        return;
    const std::size_t most = table.columns.size(), least = table.needed > 0 ? table.needed : most;
    if (row.items.size() < least || row.items.size() > most)
        return to.read.fail(
            code::row_of_wrong_length, row,
            fmt::format("a row of '{}' has {} {}, not {}", table.name,
                        least < most ? fmt::format("{} to {}", least, most) : std::to_string(most),
                        table.has_names() ? "values" : "numbers", row.items.size()),
            columns_of(table));
    for (std::size_t i = 0; i < row.items.size(); ++i, slot += sizeof(std::int64_t)) {
        const Field& column = table.columns[i];
        if (i >= least && row.items[i].is_empty()) continue;
        if (!to.read.expect_scalar(row.items[i], fmt::format("'{}'", column.name))) continue;
        const auto number =
            read_literal(to.read, row.items[i], column, to.net.unit_of(block, column.unit));
        if (number) store(column.type, slot, *number);
    }
}

bool has_room(const Resolving& to, const TableField& table, const Node& value, std::size_t rows) {
    if (rows > 0 && rows <= table.capacity) return true;
    to.read.fail(
        code::number_out_of_range, value,
        rows == 0
            ? fmt::format("'{}' has no rows", table.name)
            : fmt::format("'{}' has {} rows, more than its {}", table.name, rows, table.capacity),
        rows == 0
            ? fmt::format("it has from 1 to {} rows", table.capacity)
            : std::string("put the rest into another block of its kind, which is run behind it"));
    return false;
}

void set_size(Instance& block, const TableField& table, std::size_t rows) {
    store(Type::integer, block.image.data() + table.size_offset, static_cast<std::int64_t>(rows));
}

void complete(const Resolving& to, Instance& block, const TableField& table, const Node& value) {
    if (!table.complete) return;
    const auto fault = table.complete(block.image.data());
    if (!fault) return;
    const bool in_file = value.items.empty();
    to.read.fail(
        code::rows_do_not_go_together, in_file ? value : value.items[fault->row],
        in_file
            ? fmt::format("line {} of '{}': {}", line_of(fault->row), value.text, fault->message)
            : fmt::format("row {} of '{}': {}", fault->row + 1, table.name, fault->message),
        std::string(fault->help));
}

/// A cell as the value of a column; an empty one leaves it as it is.
bool set_cell(const Resolving& to, const Instance& block, const Field& column,
              const CsvColumn& from, const Node& file, std::size_t row, std::byte* slot) {
    if (from.is_missing(row)) return true;
    const Unit& due = to.net.unit_of(block, column.unit);
    const auto unit = from.unit.empty() ? std::optional(due) : Unit::parse(from.unit);
    const double value = unit ? convert(from.values[row], *unit, due) : from.values[row];
    const bool real = column.type == Type::real && std::isfinite(value);
    const bool whole = value == std::trunc(value) && std::abs(value) < 9e15;
    const Value cell = real ? Value(value) : Value(whole ? static_cast<std::int64_t>(value) : -1);
    if (!unit || !unit->same_dimension(due) || !(real || whole) || !column.admits(cell)) {
        to.read.fail(
            code::cell_is_no_number, file,
            fmt::format("'{}' in line {} of '{}' is not a value of '{}'",
                        format_number(from.values[row]), line_of(row), file.text, column.name),
            !unit || !unit->same_dimension(due)
                ? fmt::format("the column is in {}, not in {}", from.unit, due.text)
                : "");
        return false;
    }
    store(column.type, slot, cell);
    return true;
}

void set_table_from_file(const Resolving& to, Instance& block, const TableField& table,
                         const Node& value) {
    const auto path =
        resolve_path(value.text, to.program.file->path, {}, value.mark, to.read.diagnostics());
    std::error_code unknown;
    if (path && !std::filesystem::is_regular_file(*path, unknown))
        return to.read.fail(code::file_cannot_be_read, value,
                            fmt::format("there is no file '{}'", *path));
    CsvOptions options;
    for (const Field& column : table.columns)
        if (column.type == Type::enumeration)
            options.names[std::string(column.name)] = {column.names.begin(), column.names.end()};
    const auto csv = path ? read_csv(*path, to.read.diagnostics(), options) : std::nullopt;
    if (!csv || !has_room(to, table, value, csv->rows)) return;
    const std::size_t needed = table.needed > 0 ? table.needed : table.columns.size();
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const Field& column = table.columns[i];
        const CsvColumn* from = csv->find(column.name);
        if (!from && i < needed) from = csv->require(column.name, to.read.diagnostics());
        if (!from && i < needed) return;
        std::byte* slot = block.image.data() + table.rows_offset + i * sizeof(std::int64_t);
        for (std::size_t row = 0; from && row < csv->rows; ++row, slot += table.row_size())
            if (!set_cell(to, block, column, *from, value, row, slot)) return;
    }
    set_size(block, table, csv->rows);
    complete(to, block, table, value);
}

void set_table(Resolving& to, Instance& block, const TableField& table, const Node& value) {
    if (value.is_scalar() && !value.text.empty())
        return set_table_from_file(to, block, table, value);
    if (!to.read.expect_sequence(value, fmt::format("'{}'", table.name))) return;
    if (!has_room(to, table, value, value.items.size())) return;
    std::byte* row = block.image.data() + table.rows_offset;
    const std::size_t mistakes = to.read.diagnostics().count();
    for (const Node& items : value.items) {
        set_row(to, block, table, items, row);
        row += table.row_size();
    }
    set_size(block, table, value.items.size());
    if (to.read.diagnostics().count() == mistakes) complete(to, block, table, value);
}

void set_tables(Resolving& to) {
    for (std::size_t i = 0; i < to.program.blocks.size(); ++i) {
        Instance& block = to.net.instances[i];
        if (!block.known()) continue;
        for (const auto& [key, value] : to.program.blocks[i].ports)
            if (const TableField* table = block.type->find_table(key.text))
                set_table(to, block, *table, value);
    }
}

/// `initial:` of a block.
void set_initial(Resolving& to, int number, const Node& output, const Node& value) {
    Instance& block = to.net.instances[static_cast<std::size_t>(number)];
    const Field* field = block.type->find_readable(output.text);
    if (!field || field->direction != Direction::output) {
        std::vector<std::string> outputs;
        for (const Field& f : block.type->fields)
            if (f.direction == Direction::output) outputs.emplace_back(f.name);
        return to.read.fail(code::unknown_port, output,
                            fmt::format("{} has no output '{}'", block.described(), output.text),
                            suggest(output.text, outputs));
    }
    const Unit& unit = to.net.unit_of(to.net.port(number, *field));
    if (const auto initial = read_literal(to.read, value, *field, unit))
        store(field->type, block.image.data() + field->offset, *initial);
}

}  // namespace

/// Choices first, because other units may depend on them.
void resolve_constants(Resolving& to) {
    for (const bool choices : {true, false})
        for (const Assignment& assignment : to.assignments)
            if (!assignment.wire && is_choice(*assignment.field) == choices)
                set_constant(to, assignment);
    set_tables(to);
    for (std::size_t i = 0; i < to.program.blocks.size(); ++i)
        for (const auto& [output, value] : to.program.blocks[i].initial)
            if (to.net.instances[i].known()) set_initial(to, static_cast<int>(i), output, value);
}

}  // namespace lineshaft
