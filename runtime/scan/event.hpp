#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lineshaft {

enum class EventKind : std::uint8_t {
    restart,
    stimulus,
    force,          ///< begins or ends
    block_error,    ///< a block's `error` becomes true
    block_warning,  ///< a device's `warnings` grow
    overrun,        ///< a time error: a scan took too long, or was due again too early
    trigger,        ///< of a trace
    stop,           ///< the run ends for another reason than its time or `until`
};

constexpr std::string_view name_of(EventKind kind) {
    constexpr std::string_view names[] = {"restart",       "stimulus", "force",   "block_error",
                                          "block_warning", "overrun",  "trigger", "stop"};
    return names[static_cast<std::size_t>(kind)];
}

/// Something out of the ordinary course of scans: a line of the diagnostic buffer.
struct RunEvent {
    std::int64_t time = 0;   ///< virtual [ns]
    std::int64_t scan = -1;  ///< index; -1: between scans
    int task = -1;           ///< index; -1: of none
    EventKind kind = EventKind::stop;
    std::string text;  ///< one line
};

/// Takes the events of a run in the order in which they happen.
class EventSink {
  public:
    virtual ~EventSink() = default;
    virtual void happened(const RunEvent& event) = 0;
};

}  // namespace lineshaft
