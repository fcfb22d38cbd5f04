#include "runtime/program/link.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "runtime/program/literal.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t alignment = alignof(std::max_align_t);

std::size_t aligned(std::size_t size) {
    return (size + alignment - 1) / alignment * alignment;
}

/// A block while it is being linked.
struct Instance {
    const BlockPlan* plan = nullptr;
    const BlockType* type = nullptr;  ///< null: unknown, already reported
    int task = -1;                    ///< -1: unknown, already reported
    int position = 0;                 ///< in the file, and so in the scan order of its task
    std::size_t offset = 0;           ///< in its task's memory
    std::byte* live = nullptr;
    std::byte* published = nullptr;

    bool known() const { return type && task >= 0; }
};

/// `NOT previous(a.b)` taken apart.
struct WireText {
    std::string signal;
    bool negated = false;
    bool previous = false;
};

std::optional<WireText> parse_wire(const Node& node) {
    if (!node.is_scalar() || node.quoted) return {};
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
    if (!is_signal_name(text) && !wire.negated && !wire.previous) return {};
    return wire;
}

/// `real`, or an enumeration's names.
std::string kind(Type type, std::span<const std::string_view> names) {
    return type == Type::enumeration ? fmt::format("one of {}", fmt::join(names, ", "))
                                     : std::string(name_of(type));
}

/// A parameter whose value other fields' units may depend on.
bool is_choice(const Field& field) {
    return field.direction == Direction::parameter && field.type == Type::enumeration;
}

/// What is neither a wire nor a constant, but was meant as a wire.
bool resembles_wire(const Node& node) {
    return !node.quoted && !node.text.empty() && is_identifier(node.text.substr(0, 1)) &&
           node.text.find_first_of(".(") != std::string::npos;
}

class Linker {
  public:
    Linker(const Program& program, const Catalog& catalog, Diagnostics& out)
        : program_(program), catalog_(catalog), read_(out) {}

    Linked link();

  private:
    void place_tasks();
    void find_blocks();
    void lay_out();
    void set_inputs();
    void set_choices(Instance& block);
    void set_block(Instance& block);
    void set_port(Instance& block, const Node& key, const Node& value);
    void set_table(Instance& block, const TableField& table, const Node& value);
    void set_constant(Instance& block, const Field& field, const Node& value);
    std::optional<Value> interval_of(const Node& value, const Unit& unit);
    void wire(int index, const Field& field, const Node& value, const WireText& wire);
    bool check_order(int index, const Node& value, const WireText& wire, int source);
    std::string loop(int from, int to) const;
    void check_required(const Instance& block);
    void collect_signals();
    void collect_errors();
    void collect_devices();
    void connect_events();

    std::optional<Signal> signal(const Node& node, const std::string& name);
    std::optional<Signal> signal(const Node& node) { return signal(node, node.text); }
    Signal field_signal(const Instance& block, const Field& field) const;
    void unknown_port(const Node& node, const Instance& block, std::string_view port);
    void connect_run();
    void connect_stimuli();
    void connect_stimulus(std::int64_t at, const Node& key, const Node& value);
    void connect_trace();
    void connect_expectations();
    std::optional<double> bound(const Signal& signal, const Node& node);
    std::optional<double> tolerance(const Signal& signal, const Node& node, double around);

    Unit unit_of(const Instance& block, const Field& field);
    const Unit& parsed(const std::string& text);

    const Program& program_;
    const Catalog& catalog_;
    Reader read_;
    Linked out_;
    std::vector<Instance> blocks_;
    std::unordered_map<std::string, int> by_name_;
    std::unordered_map<std::string, Signal> inputs_;
    std::vector<std::string> task_names_, block_names_, input_names_;
    std::unordered_map<std::string, Unit> units_;
    std::vector<std::vector<std::pair<int, Copy>>> copies_;  ///< per block
    std::unordered_set<std::string> wired_;                  ///< `block.port` of every wire
};

Linked Linker::link() {
    place_tasks();
    find_blocks();
    lay_out();
    set_inputs();
    copies_.resize(blocks_.size());
    for (Instance& block : blocks_) set_choices(block);
    for (Instance& block : blocks_) set_block(block);
    for (const Instance& block : blocks_) {
        if (!block.known()) continue;
        Task& task = out_.machine.tasks[static_cast<std::size_t>(block.task)];
        const auto& copies = copies_[static_cast<std::size_t>(block.position)];
        task.calls.push_back({.scan = block.type->scan,
                              .block = block.live,
                              .first_copy = static_cast<std::uint32_t>(task.copies.size()),
                              .copies = static_cast<std::uint32_t>(copies.size())});
        for (const auto& [source, copy] : copies) task.copies.push_back(copy);
    }
    for (Task& task : out_.machine.tasks)
        if (task.published != task.live) std::memcpy(task.published, task.live, task.size);
    collect_errors();
    collect_devices();
    collect_signals();
    connect_events();
    connect_run();
    connect_stimuli();
    connect_trace();
    connect_expectations();
    return std::move(out_);
}

void Linker::place_tasks() {
    for (const TaskPlan& plan : program_.tasks) {
        Task task;
        task.name = plan.name;
        task.on_event = plan.every == 0;
        task.every = plan.every;
        task.offset = plan.offset;
        task.priority = plan.priority;
        task.jitter = plan.jitter;
        task.cost = plan.cost;
        task.cost_jitter = plan.cost_jitter;
        out_.machine.tasks.push_back(std::move(task));
    }
    std::ranges::stable_sort(out_.machine.tasks, std::ranges::greater{}, &Task::priority);
}

void Linker::find_blocks() {
    for (const Task& task : out_.machine.tasks) task_names_.push_back(task.name);
    for (const BlockPlan& plan : program_.blocks) {
        Instance block{.plan = &plan, .position = static_cast<int>(blocks_.size())};
        if (!plan.type.text.empty()) {
            block.type = catalog_.find(plan.type.text);
            if (!block.type)
                read_.fail("L0205", plan.type,
                           fmt::format("unknown block type '{}'", plan.type.text),
                           suggest(plan.type.text, catalog_.names()));
        }
        if (!plan.task.text.empty()) {
            const auto it = std::ranges::find(task_names_, plan.task.text);
            if (it != task_names_.end())
                block.task = static_cast<int>(it - task_names_.begin());
            else if (program_.tasks_known)
                read_.fail("L0206", plan.task, fmt::format("unknown task '{}'", plan.task.text),
                           suggest(plan.task.text, task_names_));
        }
        by_name_.emplace(plan.name.text, block.position);
        block_names_.push_back(plan.name.text);
        blocks_.push_back(std::move(block));
    }
}

void Linker::lay_out() {
    auto& tasks = out_.machine.tasks;
    for (Instance& block : blocks_) {
        if (!block.known()) continue;
        Task& task = tasks[static_cast<std::size_t>(block.task)];
        block.offset = task.size;
        task.size += aligned(block.type->size);
    }
    const std::size_t input_bytes = aligned(8 * program_.inputs.size());
    std::size_t total = input_bytes;
    for (const Task& task : tasks) total += task.size * (task.cost > 0 ? 2 : 1);
    auto& memory = out_.machine.memory;
    memory.resize(total);
    std::byte* place = memory.data() + input_bytes;
    for (Task& task : tasks) {
        task.live = task.published = place;
        place += task.size;
        if (task.cost == 0) continue;
        task.published = place;
        place += task.size;
    }
    for (Instance& block : blocks_) {
        if (!block.known()) continue;
        const Task& task = tasks[static_cast<std::size_t>(block.task)];
        block.live = task.live + block.offset;
        block.published = block.type->is_device() ? block.live : task.published + block.offset;
        block.type->construct(block.live);
    }
}

void Linker::set_inputs() {
    std::byte* slot = out_.machine.memory.data();
    for (const auto& [name, value] : program_.inputs) {
        input_names_.push_back(name.text);
        Signal signal{.name = "inputs." + name.text, .unit = {}, .names = {}, .slot = slot};
        Value initial;
        if (!value.quoted && (value.text == "true" || value.text == "false")) {
            signal.type = Type::boolean;
            initial = value.text == "true";
        } else {
            if (!value.quoted && is_identifier(value.text))
                read_.fail("L0307", value, fmt::format("'{}' is no value of an input", value.text),
                           "write true, false or a number");
            const auto quantity = is_identifier(value.text) ? std::nullopt : read_.quantity(value);
            if (!quantity) continue;
            if (quantity->is_integer && !quantity->has_unit) {
                signal.type = Type::integer;
                initial = quantity->integer;
            } else {
                signal.type = Type::real;
                signal.unit = quantity->unit.text;
                initial = quantity->number;
            }
        }
        store(signal.type, slot, initial);
        inputs_.emplace(name.text, signal);
        out_.machine.signals.push_back(signal);
        slot += 8;
    }
}

const Unit& Linker::parsed(const std::string& text) {
    const auto it = units_.find(text);
    if (it != units_.end()) return it->second;
    return units_.emplace(text, Unit::parse(text).value()).first->second;
}

/// `{unit}/s` with the block's own parameter `unit` put in.
Unit Linker::unit_of(const Instance& block, const Field& field) {
    std::string text(field.unit);
    for (auto open = text.find('{'); open != std::string::npos; open = text.find('{')) {
        const auto close = text.find('}', open);
        const Field& chosen = *block.type->find_settable(text.substr(open + 1, close - open - 1));
        const Value value = load(chosen.type, block.live + chosen.offset);
        text.replace(open, close - open + 1,
                     describe(value, chosen.type, chosen.names, chosen.unit));
    }
    return parsed(text);
}

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
                          suggest(key.text, settable));
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
    std::optional<Value> constant = interval_of(value, unit);
    if (!constant && field.direction == Direction::input && resembles_wire(value))
        return read_.fail("L0208", value,
                          fmt::format("'{}' is neither a constant nor a wire", value.text),
                          "a wire is written block.port, NOT block.port or previous(block.port)");
    if (!constant) constant = read_literal(read_, value, field, unit);
    if (constant) store(field.type, block.live + field.offset, *constant);
}

/// `every(servo)`: the interval of a task, for blocks that reckon with a clock.
std::optional<Value> Linker::interval_of(const Node& value, const Unit& unit) {
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
    if (it != tasks.end()) return convert(seconds(it->every), second, unit);
    if (!program_.tasks_known) return 0.0;
    read_.fail("L0206", value, fmt::format("unknown task '{}'", name), suggest(name, task_names_));
    return 0.0;
}

void Linker::wire(int index, const Field& field, const Node& value, const WireText& text) {
    const auto source = signal(value, text.signal);
    if (!source) return;
    Instance& block = blocks_[static_cast<std::size_t>(index)];
    wired_.insert(fmt::format("{}.{}", block.plan->name.text, field.name));
    int source_index = -1;
    if (source->task >= 0) {
        const auto dot = text.signal.find('.');
        source_index = by_name_.at(text.signal.substr(0, dot));
        const Instance& from = blocks_[static_cast<std::size_t>(source_index)];
        const Field& port = *from.type->find_readable(text.signal.substr(dot + 1));
        if (port.direction != Direction::output)
            return read_.fail("L0203", value,
                              fmt::format("'{}' is {} {}, not an output", text.signal,
                                          port.direction == Direction::input ? "an" : "a",
                                          name_of(port.direction)),
                              "a wire comes from an output");
    }
    if (!check_order(index, value, text, source_index)) return;

    Copy copy{.source = source->slot, .target = block.live + field.offset};
    const bool same_task = source_index >= 0 && source->task == block.task;
    if (same_task) {
        const Instance& from = blocks_[static_cast<std::size_t>(source_index)];
        copy.source = from.live + (source->slot - from.published);
    }
    if (text.negated && source->type != Type::boolean)
        return read_.fail(
            "L0408", value,
            fmt::format("NOT is for booleans, '{}' is {}", text.signal, name_of(source->type)));
    const bool widens = source->type == Type::integer && field.type == Type::real;
    if ((source->type != field.type && !widens) || !std::ranges::equal(source->names, field.names))
        return read_.fail(
            "L0401", value,
            fmt::format("'{}' is {}, '{}' takes {}", text.signal, kind(source->type, source->names),
                        field.name, kind(field.type, field.names)));
    const Unit wanted = unit_of(block, field);
    const Unit& given = parsed(source->unit);
    const bool whole = field.type == Type::integer && given.text != wanted.text;
    if (!given.same_dimension(wanted) || whole)
        return read_.fail("L0402", value,
                          fmt::format("'{}' is in {}, '{}' takes {}", text.signal,
                                      given.text.empty() ? "plain numbers" : given.text, field.name,
                                      wanted.text.empty() ? "plain numbers" : wanted.text));
    if (text.negated)
        copy.kind = Copy::Kind::negated;
    else if (field.type == Type::boolean)
        copy.kind = Copy::Kind::boolean;
    else if (widens)
        copy.kind = Copy::Kind::integer_to_real;
    else if (field.type == Type::real && given.text != wanted.text)
        copy.kind = Copy::Kind::scaled;
    if (given.text != wanted.text) {
        copy.factor = given.numerator * wanted.denominator;
        copy.divisor = given.denominator * wanted.numerator;
    }
    copies_[static_cast<std::size_t>(index)].emplace_back(source_index, copy);
}

/// In one task a wire carries this scan's value from an earlier block, and only with `previous()`
/// the last scan's from a later one or the block itself.
bool Linker::check_order(int index, const Node& value, const WireText& text, int source) {
    const Instance& block = blocks_[static_cast<std::size_t>(index)];
    const bool same_task =
        source >= 0 && blocks_[static_cast<std::size_t>(source)].task == block.task;
    const bool later = same_task && source >= index;
    if (later == text.previous) return true;
    if (text.previous) {
        read_.fail("L0407", value,
                   fmt::format("'{}' needs no previous(): {}", text.signal,
                               same_task ? "its block is scanned earlier in this task"
                                         : "it comes from outside of this task"),
                   fmt::format("did you mean '{}'?", text.signal));
        return false;
    }
    const std::string path = loop(index, source);
    if (!path.empty())
        read_.fail(
            "L0404", value, fmt::format("feedback without previous(): {}", path),
            fmt::format("write previous({}) where the loop may be a scan late", text.signal));
    else
        read_.fail("L0404", value,
                   fmt::format("'{}' is scanned after '{}': its value of this scan is not ready",
                               blocks_[static_cast<std::size_t>(source)].plan->name.text,
                               block.plan->name.text),
                   fmt::format("move it before '{}', or write previous({})", block.plan->name.text,
                               text.signal));
    return false;
}

/// The way back from block `to` to block `from` by the wires of their task: `a -> b -> a`; empty if
/// there is none.
std::string Linker::loop(int from, int to) const {
    const int task = blocks_[static_cast<std::size_t>(from)].task;
    std::vector<int> next(blocks_.size(), -1), queue{to};
    std::vector<bool> seen(blocks_.size());
    seen[static_cast<std::size_t>(to)] = true;
    for (std::size_t head = 0; head < queue.size() && queue[head] != from; ++head) {
        for (const auto& [key, value] :
             blocks_[static_cast<std::size_t>(queue[head])].plan->ports) {
            const auto text = parse_wire(value);
            if (!text || text->previous) continue;
            const auto it = by_name_.find(text->signal.substr(0, text->signal.find('.')));
            if (it == by_name_.end() || seen[static_cast<std::size_t>(it->second)]) continue;
            if (blocks_[static_cast<std::size_t>(it->second)].task != task) continue;
            seen[static_cast<std::size_t>(it->second)] = true;
            next[static_cast<std::size_t>(it->second)] = queue[head];
            queue.push_back(it->second);
        }
    }
    if (!seen[static_cast<std::size_t>(from)]) return {};
    const auto name = [this](int i) {
        return blocks_[static_cast<std::size_t>(i)].plan->name.text;
    };
    std::string path = name(from);
    for (int at = from; at != to;) {
        at = next[static_cast<std::size_t>(at)];
        path += " -> " + name(at);
    }
    return path + " -> " + name(from);
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

void Linker::collect_errors() {
    for (const Instance& block : blocks_) {
        if (!block.known()) continue;
        const Field* error = block.type->find_readable("error");
        if (!error || error->type != Type::boolean || error->direction != Direction::output)
            continue;
        const Field* id = block.type->find_readable("error_id");
        ErrorFlag flag;
        flag.error = reinterpret_cast<const bool*>(block.live + error->offset);
        if (id) {
            flag.error_id = reinterpret_cast<const std::int64_t*>(block.live + id->offset);
            flag.names = id->names;
        }
        flag.block = fmt::format("'{}' ({})", block.plan->name.text, block.type->name);
        out_.machine.tasks[static_cast<std::size_t>(block.task)].errors.push_back(std::move(flag));
    }
}

void Linker::collect_devices() {
    for (const Instance& block : blocks_)
        if (block.known() && block.type->is_device())
            out_.machine.devices.push_back({.calls = block.type->device,
                                            .block = block.live,
                                            .name = block.plan->name.text,
                                            .task = block.task});
    if (out_.machine.devices.empty()) return;
    for (const ExpectPlan& plan : program_.expectations)
        if (plan.at) out_.machine.looks.push_back(*plan.at);
    std::ranges::sort(out_.machine.looks);
}

void Linker::connect_events() {
    for (const TaskPlan& plan : program_.tasks) {
        const auto it = std::ranges::find(task_names_, plan.name);
        for (const Node& node : plan.on) {
            const auto event = signal(node);
            if (!event) continue;
            if (event->type == Type::boolean)
                out_.machine.triggers.push_back(
                    {.signal = reinterpret_cast<const bool*>(event->slot),
                     .task = static_cast<int>(it - task_names_.begin())});
            else
                read_.fail("L0401", node,
                           fmt::format("'on' takes a boolean, '{}' is {}", event->name,
                                       name_of(event->type)));
        }
    }
}

Signal Linker::field_signal(const Instance& block, const Field& field) const {
    return {.name = fmt::format("{}.{}", block.plan->name.text, field.name),
            .type = field.type,
            .unit = {},
            .names = field.names,
            .slot = block.published + field.offset,
            .task = block.task};
}

void Linker::collect_signals() {
    for (const Instance& block : blocks_) {
        if (!block.known()) continue;
        for (const Field& field : block.type->fields) {
            if (block.type->find_readable(field.name) != &field) continue;
            Signal signal = field_signal(block, field);
            signal.unit = unit_of(block, field).text;
            out_.machine.signals.push_back(std::move(signal));
        }
    }
}

void Linker::unknown_port(const Node& node, const Instance& block, std::string_view port) {
    std::vector<std::string> names;
    for (const Field& f : block.type->fields)
        names.push_back(fmt::format("{}.{}", block.plan->name.text, f.name));
    read_.fail("L0203", node,
               fmt::format("unknown port '{}' on '{}' ({})", port, block.plan->name.text,
                           block.type->name),
               suggest(fmt::format("{}.{}", block.plan->name.text, port), names));
}

std::optional<Signal> Linker::signal(const Node& node, const std::string& name) {
    if (!is_signal_name(name)) {
        read_.fail("L0208", node, fmt::format("'{}' is no signal", name),
                   "a signal is written block.port or inputs.name");
        return {};
    }
    const auto dot = name.find('.');
    const std::string owner = name.substr(0, dot);
    const std::string port = name.substr(dot + 1);
    if (owner == "inputs") {
        if (const auto it = inputs_.find(port); it != inputs_.end()) return it->second;
        if (std::ranges::find(input_names_, port) != input_names_.end()) return {};
        read_.fail("L0208", node, fmt::format("the program has no input '{}'", port),
                   input_names_.empty() ? "it has no 'inputs:'" : suggest(port, input_names_));
        return {};
    }
    const auto it = by_name_.find(owner);
    if (it == by_name_.end()) {
        read_.fail("L0204", node, fmt::format("unknown block '{}'", owner),
                   suggest(owner, block_names_));
        return {};
    }
    const Instance& block = blocks_[static_cast<std::size_t>(it->second)];
    if (!block.known()) return {};
    const Field* field = block.type->find_readable(port);
    if (!field) {
        unknown_port(node, block, port);
        return {};
    }
    Signal signal = field_signal(block, *field);
    signal.unit = unit_of(block, *field).text;
    return signal;
}

void Linker::connect_run() {
    Machine& machine = out_.machine;
    machine.duration = program_.run.duration;
    machine.seed = program_.run.seed;
    machine.continue_on_error = program_.run.continue_on_error;
    if (!program_.run.until) return;
    machine.until = signal(*program_.run.until);
    if (machine.until && machine.until->type != Type::boolean)
        read_.fail("L0401", *program_.run.until,
                   fmt::format("'until' takes a boolean, '{}' is {}", machine.until->name,
                               name_of(machine.until->type)));
}

void Linker::connect_stimuli() {
    for (const StimulusPlan& plan : program_.stimuli)
        for (const auto& [key, value] : plan.set) connect_stimulus(plan.at, key, value);
}

void Linker::connect_stimulus(std::int64_t at, const Node& key, const Node& value) {
    const auto target = signal(key);
    if (!target) return;
    if (wired_.contains(target->name))
        return read_.fail("L0409", key,
                          fmt::format("'{}' is wired and cannot be set", target->name),
                          "wire an input of the program (inputs.name) and set that");
    Field field;
    field.name = target->name;
    field.type = target->type;
    std::byte* slot = const_cast<std::byte*>(target->slot);
    Unit unit = parsed(target->unit);
    if (target->task >= 0) {
        const auto dot = target->name.find('.');
        const Instance& block =
            blocks_[static_cast<std::size_t>(by_name_.at(target->name.substr(0, dot)))];
        const Field* settable = block.type->find_settable(target->name.substr(dot + 1));
        if (!settable || settable->direction == Direction::parameter)
            return read_.fail("L0405", key,
                              fmt::format("'{}' is {} and cannot be set", target->name,
                                          settable ? "a parameter" : "an output"),
                              "a stimulus sets inputs");
        field = *settable;
        unit = unit_of(block, field);
        slot = block.live + field.offset;
    }
    if (const auto v = read_literal(read_, value, field, unit))
        out_.machine.stimuli.push_back({at, slot, field.type, *v});
}

void Linker::connect_trace() {
    if (!program_.trace) return;
    const TracePlan& plan = *program_.trace;
    TraceSetup setup;
    setup.every = plan.every;
    const auto it = std::ranges::find(task_names_, plan.task.text);
    if (it != task_names_.end())
        setup.task = static_cast<int>(it - task_names_.begin());
    else if (!plan.task.text.empty() && program_.tasks_known)
        read_.fail("L0206", plan.task, fmt::format("unknown task '{}'", plan.task.text),
                   suggest(plan.task.text, task_names_));
    for (const Node& node : plan.signals)
        if (auto s = signal(node)) setup.signals.push_back(std::move(*s));
    out_.trace = std::move(setup);
}

std::optional<double> Linker::bound(const Signal& signal, const Node& node) {
    Field field;
    field.name = signal.name;
    field.type = signal.type;
    field.names = signal.names;
    const auto value = read_literal(read_, node, field, parsed(signal.unit));
    return value ? std::optional(as_real(*value)) : std::nullopt;
}

std::optional<double> Linker::tolerance(const Signal& signal, const Node& node, double around) {
    static const Unit one;
    if (signal.type == Type::boolean || signal.type == Type::enumeration) {
        read_.fail("L0213", node,
                   fmt::format("'within' is for numbers, '{}' is {}", signal.name,
                               kind(signal.type, signal.names)));
        return {};
    }
    const bool share = node.is_scalar() && node.text.ends_with('%');
    const auto value = read_.real(node, share ? one : parsed(signal.unit));
    if (!value) return {};
    if (*value >= 0) return share ? *value * std::abs(around) : *value;
    read_.fail("L0305", node, fmt::format("'{}' is below 0", node.text));
    return {};
}

void Linker::connect_expectations() {
    for (const ExpectPlan& plan : program_.expectations) {
        const auto target = signal(plan.signal);
        if (!target) continue;
        Expectation e{
            .text = {}, .signal = *target, .always = plan.always, .at = plan.at, .wanted = {}};
        e.low = -std::numeric_limits<double>::infinity();
        e.high = -e.low;
        if (plan.equals) {
            const double value = bound(*target, *plan.equals).value_or(0);
            const double slack =
                plan.within ? tolerance(*target, *plan.within, value).value_or(0) : 0;
            e.low = value - slack;
            e.high = value + slack;
            e.wanted = plan.equals->text;
            if (plan.within) e.wanted += " within " + plan.within->text;
        }
        const auto side = [&](const std::optional<Node>& node, const char* word, double& limit) {
            if (!node) return;
            limit = bound(*target, *node).value_or(0);
            e.wanted += fmt::format("{}{} {}", e.wanted.empty() ? "" : ", ", word, node->text);
        };
        side(plan.at_least, "at least", e.low);
        side(plan.at_most, "at most", e.high);
        if (plan.at_least && plan.at_most && e.low > e.high)
            read_.fail("L0213", *plan.at_least, "'at_least' is above 'at_most': this never holds");
        const std::string when = plan.always ? "always"
                                 : plan.at   ? "at " + format_time(*plan.at)
                                             : "at the end";
        e.text = fmt::format("{}: {} {}{}", when, target->name, plan.equals ? "= " : "", e.wanted);
        out_.expectations.push_back(std::move(e));
    }
}

}  // namespace

Linked link(const Program& program, const Catalog& catalog, Diagnostics& out) {
    return Linker(program, catalog, out).link();
}

}  // namespace lineshaft
