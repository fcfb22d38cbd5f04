#include "runtime/machine/machine.hpp"

namespace lineshaft {

namespace {

template <Transfer transfer>
void deliver(const Row& row) {
    auto [wire, source_step, target_step, count, _] = row;
    // A scan of a hundred small blocks takes 225 ns so, 248 without.
#pragma GCC unroll 4
    for (; count > 0; --count, wire.source += source_step, wire.target += target_step)
        deliver<transfer>(wire);
}

void deliver(const Row& row) {
    if (row.transfer == Transfer::boolean) return deliver<Transfer::boolean>(row);
    if (row.transfer == Transfer::word) return deliver<Transfer::word>(row);
    deliver<Transfer::widened>(row);
}

double scaled(const ScaledCopy& wire) {
    return as_real(load(wire.source_type, wire.source)) * wire.factor / wire.divisor;
}

void feed_copies(const Call& call) {
    const Copy* copy = call.first_copy;
    for (std::uint32_t n = call.booleans; n > 0; --n) deliver<Transfer::boolean>(*copy++);
    for (std::uint32_t n = call.words; n > 0; --n) deliver<Transfer::word>(*copy++);
    for (std::uint32_t n = call.widened; n > 0; --n) deliver<Transfer::widened>(*copy++);
}

void feed_many(const Call& call) {
    feed_copies(call);
    const Row* row = call.first_row;
    for (std::uint32_t n = call.rows; n > 0; --n) deliver(*row++);
    const ScaledCopy* wire = call.first_scaled;
    for (std::uint32_t n = call.scaled; n > 0; --n, ++wire) {
        const double value = scaled(*wire);
        std::memcpy(wire->target, &value, sizeof value);
    }
}

}  // namespace

void feed(const Call& call) {
    const auto& [first, second] = call.copies;
    if (call.feed <= Feed::two_some_negated) {
        if (call.feed == Feed::no_wire) return;
        deliver<Transfer::boolean>(first);
        if (call.feed >= Feed::two_booleans) deliver<Transfer::boolean>(second);
    } else if (call.feed <= Feed::two_words) {
        deliver<Transfer::word>(first);
        if (call.feed == Feed::two_words) deliver<Transfer::word>(second);
    } else if (call.feed == Feed::widened) {
        deliver<Transfer::widened>(first);
    } else {
        feed_many(call);
    }
}

// In one go: a call of its own for the wires costs a nanosecond.
[[gnu::flatten]] bool feed_and_scan(const FedBlock& block, const Scan& now) {
    const Call& call = static_cast<const Call&>(block);
    feed(call);
    return call.scan(call.first, call.count, now, call.context);
}

namespace {

bool scan_unfed(const FedBlock& block, const Scan& now) {
    const Call& call = static_cast<const Call&>(block);
    return call.scan(call.first, call.count, now, call.context);
}

[[gnu::flatten]] bool feed_copies_and_scan(const FedBlock& block, const Scan& now) {
    const Call& call = static_cast<const Call&>(block);
    feed_copies(call);
    return call.scan(call.first, call.count, now, call.context);
}

}  // namespace

FeedAndScan shortest_way(const Call& call) {
    if (call.feed == Feed::no_wire) return scan_unfed;
    const bool only_copies = call.feed == Feed::many && call.rows == 0 && call.scaled == 0;
    return only_copies ? feed_copies_and_scan : feed_and_scan;
}

}  // namespace lineshaft
