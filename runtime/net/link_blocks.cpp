#include <algorithm>

#include <fmt/format.h>

#include "runtime/model/literal.hpp"
#include "runtime/net/linker.hpp"

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

}  // namespace

/// First of all, because units at both ends of a wire may depend on it.
void Linker::set_choices(Instance& block) {
    if (!block.known()) return;
    for (const auto& [key, value] : block.plan->ports) {
        const Field* field = block.type->find_settable(key.text);
        if (field && is_choice(*field) && value.is_scalar() && !parse_wire(value))
            set_constant(block, *field, value);
    }
}

void Linker::set_block(Instance& block) {
    if (!block.known()) return;
    for (const auto& [key, value] : block.plan->ports) set_port(block, key, value);
    check_required(block);
}

void Linker::set_port(Instance& block, const Node& key, const Node& value) {
    if (const TableField* table = block.type->find_table(key.text))
        return set_table(block, *table, value);
    const Field* field = block.type->find_settable(key.text);
    if (!field && block.type->find_readable(key.text))
        return read_.fail("L0405", key,
                          fmt::format("'{}' is an output of '{}' ({}) and cannot be set", key.text,
                                      block.plan->name.text, block.type->name),
                          fmt::format("'lineshaft blocks {}' lists its inputs", block.type->name));
    if (!field) {
        std::vector<std::string> settable{"type", "task"};
        for (const Field& f : block.type->fields)
            if (f.direction != Direction::output) settable.emplace_back(f.name);
        for (const TableField& t : block.type->tables) settable.emplace_back(t.name);
        return read_.fail("L0203", key,
                          fmt::format("'{}' ({}) has no parameter or input '{}'",
                                      block.plan->name.text, block.type->name, key.text),
                          suggest(misspelt(key.text), settable));
    }
    if (!read_.expect_scalar(value, fmt::format("'{}'", key.text))) return;
    const auto wire_text = parse_wire(value);
    if (!wire_text) {
        if (!is_choice(*field)) set_constant(block, *field, value);
        return;
    }
    if (field->direction == Direction::parameter)
        return read_.fail("L0406", value,
                          fmt::format("'{}' is a parameter of '{}' ({}) and takes no wire",
                                      key.text, block.plan->name.text, block.type->name),
                          "a parameter is constant while the program runs");
    wire(block.position, *field, value, *wire_text);
}

void Linker::set_table(Instance& block, const TableField& table, const Node& value) {
    if (!read_.expect_sequence(value, fmt::format("'{}'", table.name))) return;
    if (value.items.empty())
        return read_.fail("L0305", value, fmt::format("'{}' has no rows", table.name),
                          fmt::format("it has from 1 to {} rows", table.capacity));
    if (value.items.size() > table.capacity)
        return read_.fail("L0305", value,
                          fmt::format("'{}' has {} rows, more than its {}", table.name,
                                      value.items.size(), table.capacity));
    std::byte* slot = block.live + table.rows_offset;
    for (const Node& row : value.items) {
        if (!read_.expect_sequence(row, fmt::format("a row of '{}'", table.name))) continue;
        if (row.items.size() != table.columns.size()) {
            std::vector<std::string_view> names;
            for (const Field& column : table.columns) names.push_back(column.name);
            read_.fail("L0214", row,
                       fmt::format("a row of '{}' has {} numbers, not {}", table.name,
                                   table.columns.size(), row.items.size()),
                       fmt::format("write [{}]", fmt::join(names, ", ")));
            continue;
        }
        for (std::size_t i = 0; i < row.items.size(); ++i, slot += sizeof(std::int64_t)) {
            const Field& column = table.columns[i];
            if (!read_.expect_scalar(row.items[i], fmt::format("'{}'", column.name))) continue;
            const auto number =
                read_literal(read_, row.items[i], column, parsed(std::string(column.unit)));
            if (number) store(Type::integer, slot, *number);
        }
    }
    store(Type::integer, block.live + table.size_offset,
          static_cast<std::int64_t>(value.items.size()));
}

void Linker::set_constant(Instance& block, const Field& field, const Node& value) {
    const Unit unit = unit_of(block, field);
    std::optional<Value> constant = interval_of(value, field, unit);
    if (!constant && field.direction == Direction::input && resembles_wire(value))
        return read_.fail("L0208", value,
                          fmt::format("'{}' is neither a constant nor a wire", value.text),
                          "a wire is written block.port, NOT block.port or previous(block.port)");
    if (const std::string meant = meant_by(value.text);
        !constant && !value.quoted && !meant.empty() &&
        std::ranges::find(field.names, value.text) == field.names.end())
        return read_.fail("L0208", value,
                          fmt::format("'{}' is neither a constant nor a wire", value.text), meant);
    if (!constant) constant = read_literal(read_, value, field, unit);
    if (constant) store(field.type, block.live + field.offset, *constant);
}

/// Where `word` is a name of the program and no value: how what it names is written.
std::string Linker::meant_by(const std::string& word) const {
    if (word == "true" || word == "false") return {};
    if (std::ranges::any_of(program_.parameters, [&](const auto& p) { return p.first == word; }))
        return fmt::format("did you mean the parameter '${}'?", word);
    if (inputs_.contains(word)) return fmt::format("did you mean the input 'inputs.{}'?", word);
    const auto it = by_name_.find(word);
    if (it == by_name_.end()) return {};
    std::string outputs;
    const Instance& block = blocks_[static_cast<std::size_t>(it->second)];
    for (const Field& field : block.known() ? block.type->fields : std::span<const Field>())
        if (field.direction == Direction::output)
            outputs += fmt::format("{}{}.{}", outputs.empty() ? "" : ", ", word, field.name);
    return fmt::format("'{}' is a block; a wire names its output: {}", word, outputs);
}

/// `every(servo)`: the interval of a task, for blocks that reckon with a clock. Times that are
/// integers are in ns.
std::optional<Value> Linker::interval_of(const Node& value, const Field& field, const Unit& unit) {
    static const Unit second = *Unit::parse("s");
    if (!value.text.starts_with("every(") || !value.text.ends_with(')') ||
        !unit.same_dimension(second))
        return {};
    const std::string name = value.text.substr(6, value.text.size() - 7);
    const auto& tasks = out_.machine.tasks;
    const auto it = std::ranges::find(tasks, name, &Task::name);
    if (it != tasks.end() && it->on_event) {
        read_.fail("L0213", value, fmt::format("'{}' is an event task: it has no interval", name));
        return 0.0;
    }
    if (it != tasks.end() && field.type == Type::integer) return it->every;
    if (it != tasks.end()) return convert(seconds(it->every), second, unit);
    if (!program_.tasks_known) return 0.0;
    read_.fail("L0206", value, fmt::format("unknown task '{}'", name), suggest(name, task_names_));
    return 0.0;
}

void Linker::check_misfit(const Instance& block) {
    if (!block.known() || !block.type->misfit) return;
    const std::string& name = block.plan->name.text;
    const auto misfit = block.type->misfit(block.live, [&](std::string_view field) {
        const std::string port = fmt::format("{}.{}", name, field);
        return !wired_.contains(port) && !set_.contains(port);
    });
    if (!misfit) return;
    const auto& ports = block.plan->ports;
    const auto at =
        std::ranges::find(ports, misfit->field, [](const auto& port) { return port.first.text; });
    const Node& place = at != ports.end() ? at->second : block.plan->name;
    if (place.is_scalar())
        read_.fail("L0305", place,
                   fmt::format("'{}' is out of range for '{}'", place.text, misfit->field),
                   misfit->why);
    else
        read_.fail("L0305", place, fmt::format("'{}' is not used", misfit->field), misfit->why);
}

void Linker::check_required(const Instance& block) {
    for (const Field& field : block.type->fields) {
        const auto& ports = block.plan->ports;
        const auto is_field = [&](const auto& port) { return port.first.text == field.name; };
        if (!field.required || std::ranges::any_of(ports, is_field)) continue;
        read_.fail("L0403", block.plan->name,
                   fmt::format("'{}' ({}) needs its {} '{}': {}", block.plan->name.text,
                               block.type->name, name_of(field.direction), field.name, field.doc));
    }
}

}  // namespace lineshaft
