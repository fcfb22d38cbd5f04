#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "runtime/names/left_out.hpp"
#include "runtime/names/resolve.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/library/library.hpp"

namespace lineshaft {

namespace {

void add_cost(Resolving& to, const BlockPlan& plan, Instance& block) {
    if (!plan.cost || block.task < 0 || !to.read.expect_scalar(*plan.cost, "'cost'")) return;
    TaskSettings& task = to.net.tasks[static_cast<std::size_t>(block.task)];
    block.cost = to.read.time(*plan.cost).value_or(0);
    task.cost += block.cost;
    if (!task.on_event && task.cost - task.cost_jitter > task.every)
        to.read.fail(code::number_out_of_range, *plan.cost,
                     fmt::format("the costs of task '{}' and its blocks are above its interval: it "
                                 "never ends in time",
                                 task.name));
}

void construct(Instance& block) {
    block.image.resize(block.type->size);
    block.wired.resize(block.type->fields.size());
    block.type->construct(block.image.data());
}

/// A type of the sources, else of the catalogue; beside a program `Axis` its `axis` is that one.
const BlockType* type_called(const Resolving& to, std::string_view name) {
    const BlockType* own = to.net.kinds ? to.net.kinds->find(name) : nullptr;
    const BlockType* known = to.catalog.find(name);
    const bool is_written = known && known->name == name;
    return own && (own->name == name || !is_written) ? own : known;
}

void find_type(Resolving& to, const Node& name, Instance& block) {
    if (name.text.empty()) return;
    block.type = type_called(to, name.text);
    if (block.type) return construct(block);
    if (!to.net.kinds) return;
    auto names = to.catalog.names();
    std::ranges::copy(to.net.kinds->names(), std::back_inserter(names));
    const std::string_view instead = to.catalog.instead_of(name.text);
    to.read.fail(code::unknown_block_type, name,
                 fmt::format("there is no block type '{}'", name.text),
                 instead.empty() ? suggest(name.text, names) : std::string(instead));
}

/// Data blocks have no entry in the program: they belong to the main task.
void add_single_blocks(Resolving& to) {
    if (!to.net.kinds || to.net.main_task < 0) return;
    for (const BlockType& type : to.net.kinds->types()) {
        if (!type.single) continue;
        const auto number = static_cast<int>(to.net.instances.size());
        const auto [it, added] = to.net.instance_numbers.emplace(type.name, number);
        if (!added) {
            const Instance& other = to.net.instance(it->second);
            if (other.type != &type)
                to.read.fail(code::named_twice,
                             to.program.blocks[static_cast<std::size_t>(it->second)].name,
                             fmt::format("'{}' is the name of a data block, too", type.name));
            continue;
        }
        Instance block{.name = std::string(type.name), .type = &type, .task = to.net.main_task};
        construct(block);
        to.net.instances.push_back(std::move(block));
    }
}

/// The program's block of that name; capital letters make no difference where there is no other.
int find_global(const Resolving& to, std::string_view name) {
    const auto it = to.net.instance_numbers.find(std::string(name));
    if (it != to.net.instance_numbers.end()) return it->second;
    const auto other = std::ranges::find_if(
        to.net.instances, [&](const Instance& block) { return same_letters(block.name, name); });
    return other == to.net.instances.end() ? -1
                                           : static_cast<int>(other - to.net.instances.begin());
}

constexpr int none = -1, several = -2;

/// A PROGRAM that the sources name as such is the only block of its type, whatever that is called.
int find_only_program(const Resolving& to, const Field& field) {
    if (!same_letters(field.global, field.refers)) return none;
    const auto is_it = [&](const Instance& block) {
        return block.type && block.type->name == field.refers;
    };
    const auto first = std::ranges::find_if(to.net.instances, is_it);
    if (first == to.net.instances.end()) return none;
    return std::any_of(first + 1, to.net.instances.end(), is_it)
               ? several
               : static_cast<int>(first - to.net.instances.begin());
}

void refuse_global(Resolving& to, const Instance& block, const Node& place, const Field& field,
                   int found) {
    if (found >= 0)
        return to.read.fail(
            code::wire_between_types, place,
            fmt::format("the sources of {} name {}, a block of type {}, which {} is not",
                        block.described(), field.name, field.refers,
                        to.net.instance(found).described()));
    std::vector<std::string> fitting;
    for (const Instance& other : to.net.instances)
        if (other.type && other.type->name == field.refers) fitting.push_back(other.name);
    if (found == several)
        return to.read.fail(
            code::unknown_block, place,
            fmt::format("the sources of {} name the program {}, and there are {}",
                        block.described(), field.global, fitting.size()),
            fmt::format("call one of them {}: {}", field.global, fmt::join(fitting, ", ")));
    const std::string known = suggest(std::string(field.global), fitting);
    to.read.fail(code::unknown_block, place,
                 fmt::format("the sources of {} name {}, and the program has no {} '{}'",
                             block.described(), field.name, field.refers, field.global),
                 fmt::format("declare it, {}: {{type: {}, task: ...}}, or the source takes it as "
                             "VAR_IN_OUT{}{}",
                             field.global, field.refers, known.empty() ? "" : "; ", known));
}

void refer_to_global(Resolving& to, int number, const Field& field) {
    Instance& block = to.net.instances[static_cast<std::size_t>(number)];
    int other = find_global(to, field.global);
    if (other < 0) other = find_only_program(to, field);
    if (other >= 0 && !to.net.instance(other).known()) return;
    if (other >= 0 && to.net.instance(other).type->name == field.refers) {
        to.net.references.push_back({to.net.port(number, field), other});
        return store(field.type, block.image.data() + field.offset, std::int64_t{other});
    }
    const BlockType* kind = to.net.kinds ? to.net.kinds->find(field.refers) : nullptr;
    if (kind && kind->single) return;  // another block has its name, which has been told
    if (kind && other == none && to.net.main_task >= 0) {
        const auto added = static_cast<int>(to.net.instances.size());
        Instance made{.name = std::string(field.global), .type = kind, .task = to.net.main_task};
        construct(made);
        made.is_only_named = true;
        to.net.instance_numbers.emplace(made.name, added);
        to.net.instances.push_back(std::move(made));
        return refer_to_global(to, number, field);
    }
    const auto plan = static_cast<std::size_t>(number);
    if (plan < to.program.blocks.size())
        refuse_global(to, block, to.program.blocks[plan].name, field, other);
}

/// References that a program does not write down.
void refer_to_globals(Resolving& to) {
    for (int number = 0; number < static_cast<int>(to.net.instances.size()); ++number)
        if (const Instance& block = to.net.instance(number); block.known())
            for (const Field& field : block.type->fields)
                if (!field.global.empty()) refer_to_global(to, number, field);
}

}  // namespace

std::optional<WireText> parse_wire(const Node& node) {
    const bool is_indexed = node.text.find('[') != std::string::npos;
    if (!node.is_scalar() || (node.quoted && !is_indexed)) return {};
    std::string_view text = node.text;
    WireText wire;
    if (text.starts_with("NOT ")) {
        wire.negated = true;
        text.remove_prefix(4);
    }
    if (text.starts_with("previous(") && text.ends_with(')')) {
        wire.previous = true;
        text = text.substr(9, text.size() - 10);
    }
    wire.signal = text;
    if (!split_signal(text) && !wire.negated && !wire.previous) return {};
    return wire;
}

namespace {

void refuse_port(Resolving& to, const Instance& block, const Node& key) {
    if (const Field* field = block.type->find_readable(key.text))
        return to.read.fail(
            code::port_cannot_be_set, key,
            fmt::format("'{}' is {} {} of {} and cannot be set", key.text,
                        field->direction == Direction::output ? "an" : "a",
                        name_of(field->direction), block.described()),
            fmt::format("'lineshaft blocks {}' lists its inputs", block.type->name));
    if (const auto text = st::find_text(*block.type, key.text); !text.empty())
        return to.read.fail(
            code::port_cannot_be_set, key,
            fmt::format("'{}' is a STRING of {}, which no program's file gives", text,
                        block.described()),
            fmt::format("call {} in a PROGRAM of the sources, which gives it: {} := 'text'",
                        block.type->name, text));
    const std::string message =
        fmt::format("{} has no parameter or input '{}'", block.described(), key.text);
    if (key.text == "on_error")
        return to.read.fail(code::unknown_port, key, message,
                            "it is said of the whole run: run: {for: 2 s, on_error: continue}");
    if (refuse_left_out(to.read, key, block, key.text)) return;
    std::vector<std::string> settable{"type", "task"};
    for (const Field& f : block.type->fields)
        if (block.type->find_settable(f.name) == &f && f.global.empty())
            settable.emplace_back(f.name);
    for (const TableField& t : block.type->tables) settable.emplace_back(t.name);
    to.read.fail(code::unknown_port, key, message, suggest(to.net.misspelt(key.text), settable));
}

void check_required(const Resolving& to, const BlockPlan& plan, const Instance& block) {
    for (const Field& field : block.type->fields) {
        const auto is_field = [&](const auto& port) {
            return same_letters(field.name, port.first.text);
        };
        if (!field.required || std::ranges::any_of(plan.ports, is_field)) continue;
        to.read.fail(code::port_is_not_set, plan.name,
                     fmt::format("{} needs its {} '{}': {}", block.described(),
                                 name_of(field.direction), field.name, field.doc));
    }
}

void refer(Resolving& to, int number, const Field& field, const Node& value) {
    Instance& block = to.net.instances[static_cast<std::size_t>(number)];
    const auto it = to.net.instance_numbers.find(value.text);
    if (it == to.net.instance_numbers.end()) {
        std::vector<std::string> fitting;
        for (const Instance& other : to.net.instances)
            if (other.type && other.type->name == field.refers) fitting.push_back(other.name);
        return to.read.fail(code::unknown_block, value,
                            fmt::format("the program has no block '{}'", value.text),
                            suggest(value.text, fitting));
    }
    const Instance& other = to.net.instance(it->second);
    if (!other.known()) return;
    if (other.type->name != field.refers)
        return to.read.fail(
            code::wire_between_types, value,
            fmt::format("'{}' of {} refers to a block of type {}, which {} is not", field.name,
                        block.described(), field.refers, other.described()));
    to.net.references.push_back({to.net.port(number, field), it->second});
    store(field.type, block.image.data() + field.offset, std::int64_t{it->second});
}

void assign(Resolving& to, int number, const Node& key, const Node& value) {
    const Instance& block = to.net.instance(number);
    if (block.type->find_table(key.text)) return;
    const Field* field = block.type->find_settable(key.text);
    if (!field) return refuse_port(to, block, key);
    if (!to.read.expect_scalar(value, fmt::format("'{}'", key.text))) return;
    if (field->direction == Direction::in_out) return refer(to, number, *field, value);
    Assignment assignment{number, field, &value, parse_wire(value)};
    if (assignment.wire && field->direction == Direction::parameter)
        return to.read.fail(
            code::wire_into_parameter, value,
            fmt::format("'{}' is a parameter of {} and takes no wire", key.text, block.described()),
            "a parameter is constant while the program runs");
    to.assignments.push_back(std::move(assignment));
}

/// Nothing else would ever execute it.
void check_called(const Resolving& to) {
    for (std::size_t i = 0; i < to.program.blocks.size(); ++i) {
        const auto number = static_cast<int>(i);
        const Instance& block = to.net.instance(number);
        const auto names_it = [&](const Reference& reference) {
            return reference.to == number && !to.net.field(reference.from).global.empty() &&
                   reference.from.instance != number;
        };
        if (!block.is_only_named || !block.known()) continue;
        if (std::ranges::none_of(to.net.references, names_it))
            to.read.fail(
                code::entries_do_not_go_together, to.program.blocks[i].name,
                fmt::format("{} is 'called', and no block's sources name it", block.described()),
                "leave 'called' out, and its task scans it");
    }
}

}  // namespace

void resolve_instances(Resolving& to) {
    for (const BlockPlan& plan : to.program.blocks) {
        Instance block{.name = plan.name.text};
        find_type(to, plan.type, block);
        block.task = to.net.find_task(to.read, plan.task, plan.task.text);
        add_cost(to, plan, block);
        block.is_only_named = plan.called;
        to.net.instance_numbers.emplace(block.name, static_cast<int>(to.net.instances.size()));
        to.net.instances.push_back(std::move(block));
    }
    add_single_blocks(to);
    refer_to_globals(to);
    check_called(to);
}

void resolve_assignments(Resolving& to) {
    int number = 0;
    for (const BlockPlan& plan : to.program.blocks) {
        const Instance& block = to.net.instance(number);
        if (block.known()) {
            for (const auto& [key, value] : plan.ports) assign(to, number, key, value);
            check_required(to, plan, block);
        }
        ++number;
    }
}

}  // namespace lineshaft
