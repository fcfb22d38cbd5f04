#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace lineshaft {

/// The time of an event that does not come.
inline constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

/// Takes the rising edges of one pulse channel, in order.
class PulseSink {
  public:
    virtual ~PulseSink() = default;

    /// Times [ns]; `reverse` is the direction output during all of them.
    virtual void edges(std::span<const std::int64_t> times, bool reverse) = 0;
};

/// A block that lives between scans: hardware, such as a pulse output, which goes on by itself and
/// whose events have their own times.
///
/// `scan` only takes the commands; `publish(time)` puts them into effect when the outputs of the
/// task reach the hardware, which is after the task's cost. `next_event_time()` announces a time
/// [ns] that is not later than the next event (never: nothing will happen by itself). The executive
/// makes that time an instant. At the beginning of every instant, and after each publish, it calls
/// `advance(time, sink)`, never beyond an announced time: the block's outputs are then those of the
/// hardware at that time, seen at once by all tasks, and its rising edges up to that time go to the
/// sink, if there is one. After an advance the announced time is later than it.
///
/// Outputs `warnings`, a count, and `warning_id`, an enumeration, say what the device clamps or
/// refuses and goes on from: each time the count has grown is an event of the run, and its sum a
/// warning at the end.
template <class Block>
concept Device = requires(Block block, const Block& constant, std::int64_t time, PulseSink* sink) {
    { constant.next_event_time() } -> std::same_as<std::int64_t>;
    block.advance(time, sink);
    block.publish(time);
};

/// What the runtime calls of a device; null in other blocks.
struct DeviceCalls {
    std::int64_t (*next_event_time)(const std::byte* block) = nullptr;
    void (*advance)(std::byte* block, std::int64_t time, PulseSink* sink) = nullptr;
    void (*publish)(std::byte* block, std::int64_t time) = nullptr;
};

}  // namespace lineshaft
