#include <algorithm>
#include <span>

#include "runtime/machine/lay_out.hpp"

namespace lineshaft {

namespace {

/// The shortest that is worth a row.
constexpr std::uint32_t row_size = 4;

/// Those from the first on that are at equal distances.
Row row_of(std::span<const Copy> copies, Transfer transfer) {
    Row row{.first = copies.front(), .transfer = transfer};
    Copy next = row.first;
    if (copies.size() > 1) {
        row.source_step = copies[1].source - next.source;
        row.target_step = copies[1].target - next.target;
    }
    for (const Copy& copy : copies) {
        if (copy.source != next.source || copy.target != next.target ||
            copy.negates != next.negates)
            break;
        ++row.count;
        next.source += row.source_step;
        next.target += row.target_step;
    }
    return row;
}

/// Returns how many are in no row.
std::uint32_t append(std::span<const Copy> copies, Transfer transfer, Wires& wires) {
    const std::size_t before = wires.copies.size();
    while (!copies.empty()) {
        const Row row = row_of(copies, transfer);
        const bool is_row = row.count >= row_size;
        if (is_row)
            wires.rows.push_back(row);
        else
            wires.copies.push_back(row.first);
        copies = copies.subspan(is_row ? row.count : 1);
    }
    return static_cast<std::uint32_t>(wires.copies.size() - before);
}

/// What feeds the inputs of a call's blocks, by what happens on the way.
struct CallWires {
    std::vector<Copy> booleans, words, widened;
    std::vector<ScaledCopy> scaled;
};

void add(const Wire& wire, Type type, Copy copy, CallWires& to) {
    const Type from = wire.widens.value_or(Type::real);
    if (wire.scaled || from == Type::unsigned_integer)
        to.scaled.push_back({copy.source, copy.target, wire.factor, wire.divisor, from});
    else if (wire.widens)
        to.widened.push_back(copy);
    else
        (type == Type::boolean ? to.booleans : to.words).push_back(copy);
}

void add(const Net& net, const Wire& wire, Machine& machine, CallWires& to) {
    const std::byte* from =
        wire.late == Late::published ? machine.published(wire.from) : machine.live(wire.from);
    add(wire, net.field(wire.to).type, {from, machine.live(wire.to), wire.negated}, to);
}

/// The first call of a task has what comes a scan late, too: nothing has been scanned then.
CallWires wires_of(const Net& net, std::span<const int> blocks, bool first_of_task,
                   Machine& machine) {
    CallWires out;
    const int task = net.instance(blocks.front()).task;
    for (const Wire& wire : first_of_task ? std::span(net.wires) : std::span<const Wire>())
        if (wire.late == Late::delayed && net.instance(wire.to).task == task)
            add(net, wire, machine, out);
    for (const int block : blocks)
        for (const Wire& wire : net.wires_to(block))
            if (wire.late != Late::delayed) add(net, wire, machine, out);
    return out;
}

/// The same input of all blocks in one go.
template <class Transferred>
std::vector<Transferred> by_input(std::vector<Transferred> wires, const Call& call) {
    std::ranges::stable_sort(wires, {}, [&](const Transferred& wire) {
        return static_cast<std::size_t>(wire.target - call.first) % call.size;
    });
    return wires;
}

/// True when the call holds them itself.
bool hold(const CallWires& wires, Call& call) {
    const auto only = [&](const std::vector<Copy>& copies, Feed one, Feed two) {
        if (copies.empty() || copies.size() > std::size(call.copies)) return false;
        call.feed = copies.size() == 1 ? one : two;
        std::ranges::copy(copies, call.copies);
        return true;
    };
    const auto& [booleans, words, widened, scaled] = wires;
    const std::size_t count = booleans.size() + words.size() + widened.size() + scaled.size();
    if (count == 0) return true;
    if (count == booleans.size())
        return std::ranges::any_of(booleans, &Copy::negates)
                   ? only(booleans, Feed::negated, Feed::two_some_negated)
                   : only(booleans, Feed::boolean, Feed::two_booleans);
    if (count == words.size()) return only(words, Feed::word, Feed::two_words);
    return count == 1 && only(widened, Feed::widened, Feed::many);
}

void append_wires(const CallWires& own, Call& call, Wires& wires) {
    if (hold(own, call)) return;
    call.feed = Feed::many;
    const std::size_t rows = wires.rows.size();
    call.booleans = append(by_input(own.booleans, call), Transfer::boolean, wires);
    call.words = append(by_input(own.words, call), Transfer::word, wires);
    call.widened = append(by_input(own.widened, call), Transfer::widened, wires);
    call.rows = static_cast<std::uint32_t>(wires.rows.size() - rows);
    const auto scaled = by_input(own.scaled, call);
    wires.scaled.insert(wires.scaled.end(), scaled.begin(), scaled.end());
    call.scaled = static_cast<std::uint32_t>(scaled.size());
}

/// Has the single block of the call fed and scanned at once, where it is its main input that is
/// fed.
void feed_at_once(const MainInput& input, Call& call) {
    if (call.count != 1 || call.feed == Feed::many) return;
    const auto feeds_it = [&](const Copy& copy) {
        return copy.target == call.first + input.offset;
    };
    if (feeds_it(call.copies[1])) std::swap(call.copies[0], call.copies[1]);
    const FeedAndScan at_once = input.scan[static_cast<std::size_t>(call.feed)];
    if (feeds_it(call.copies[0]) && at_once) call.run = at_once;
}

/// `fed`: their wires come before it.
void append_call(const Net& net, std::span<const int> blocks, ScanBlocks scan, bool fed,
                 Machine& machine) {
    const Instance& first = net.instance(blocks.front());
    Task& task = machine.tasks[static_cast<std::size_t>(first.task)];
    Call& call = task.calls.emplace_back();
    call.scan = scan;
    call.context = machine.context_of(*first.type, first.task);
    call.first = machine.blocks[static_cast<std::size_t>(blocks.front())].live;
    call.count = blocks.size();
    call.size = first.type->size;
    if (fed) append_wires(wires_of(net, blocks, task.calls.size() == 1, machine), call, task.wires);
    call.run = shortest_way(call);
    if (fed) feed_at_once(first.type->main_input, call);
}

/// Once no wire of the task moves any more.
void point_to_wires(Task& task) {
    const Copy* copy = task.wires.copies.data();
    const Row* row = task.wires.rows.data();
    const ScaledCopy* scaled = task.wires.scaled.data();
    for (Call& call : task.calls) {
        call.first_copy = copy;
        call.first_row = row;
        call.first_scaled = scaled;
        copy += call.booleans + call.words + call.widened;
        row += call.rows;
        scaled += call.scaled;
    }
}

}  // namespace

// Blocks of one kind are called together where the orders of the net allow it: they stand one
// behind the other, with one indirect call for all, and their inputs are copied in one go before
// it, the same input of all as one row (a scan of a hundred small blocks takes 300 ns so, with a
// list of blocks and single wires 337).
void lay_out_calls(const Net& net, const std::vector<int>& sequence, const std::vector<int>& levels,
                   Machine& machine) {
    const auto is_other = [&](int a, int b) {
        const Instance &left = net.instance(a), &right = net.instance(b);
        return left.task != right.task || left.type != right.type ||
               levels[static_cast<std::size_t>(a)] != levels[static_cast<std::size_t>(b)];
    };
    const auto calls_of_image = [&](bool before) {
        for (const int& block : sequence)
            if (const BlockType& type = *net.instance(block).type; type.scan_before_all)
                append_call(net, {&block, 1}, before ? type.scan_before_all : type.scan_behind_all,
                            before, machine);
    };
    calls_of_image(true);
    for (auto first = sequence.begin(); first != sequence.end();) {
        const auto end = std::adjacent_find(first, sequence.end(), is_other);
        const auto next = end == sequence.end() ? end : end + 1;
        const BlockType& type = *net.instance(*first).type;
        if (!type.scan_before_all) append_call(net, {first, next}, type.scan_blocks, true, machine);
        first = next;
    }
    calls_of_image(false);
    std::ranges::for_each(machine.tasks, point_to_wires);
}

}  // namespace lineshaft
