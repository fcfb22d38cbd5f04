#pragma once

#include <array>
#include <optional>
#include <span>

#include "blocks/pulse/pulse_train.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/device.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// The profile table of a pulse output: byte 0 of the real one is `size`.
struct PulseProfile {
    std::int64_t size = 0;
    std::array<PulseSegment, 255> rows{};
};

/// One channel of the S7-200 SMART's pulse train output (PTO), from Siemens' manual.
///
/// A rising edge of `execute`, or a change of `job`, executes the PLS instruction: it takes the
/// inputs and takes effect when the outputs of the task are published. From then on the output
/// goes by itself; its edges do not depend on any scan. Rates are in whole Hz and are clamped:
/// below 1 Hz to 1 Hz, above 65,535 Hz (single segment) or 100,000 Hz (multi-segment) to that; a
/// count of 0 becomes 1, above 2,147,483,647 that. `clamped` says so. What is clamped or refused is
/// counted in `warnings`, the reason of the last beside it: events of the run, and said at its end.
///
/// Single segment: `count` pulses at `start_rate`; `end_rate` is not used. Multi-segment: the
/// segments of `profile`, or the one of `start_rate`, `end_rate` and `count` if `profile` is not
/// given; `segments` of them (byte 0 of the table), all if that is below 0. The next begins when
/// the count of one is reached. See PulseTrain for the edges.
///
/// A train that comes while another is under way waits in the queue, one deep. A third sets
/// `overflow` and is ignored. Refusals are counted in `refused`, with the last reason beside it;
/// none is an error of the program. A segment shorter than 500 us sets `underflow` (SM66.6), and
/// ends the train there if `underflow_ends` is true: the manual leaves it open. Executing with
/// `enable` false, or a rising edge of `stop`, ends the train at once, and drops the one that
/// waits; the pulses not made are in `lost`.
///
/// `done` rises at the end of a train, in between two scans, and stays true until the second scan
/// of the block from there: the first one, and what comes after it in the task, sees it. It falls 1
/// ns before the end of the next train if that comes sooner, so that each end is a rising edge.
///
/// `control` as in SMB67 stands for the named fields if it is 0 or more: bit 7 enable, bit 6 PTO
/// (0, pulse width modulation, is refused), bit 5 multi-segment, bit 2 update count, bit 0 update
/// rate. The last two are for single segments: without them the last train's value stays.
///
/// More than 250 lines with its methods: SMB67's bits and the two modes share every state.
struct Pto {
    enum class Refusal : std::int64_t { none, overflow, no_segments, not_pto };
    /// The refusals, then what is clamped as a segment begins.
    enum class Warning : std::int64_t {
        none,
        overflow,
        no_segments,
        not_pto,
        rate_out_of_range,
        count_out_of_range,
    };

    RateUpdate rate_update = RateUpdate::continuous;
    bool underflow_ends = false;
    PulseProfile profile;

    bool enable = true, multi_segment = false, update_rate = true, update_count = true;
    std::int64_t control = -1;
    std::int64_t start_rate = 1, end_rate = 1, count = 1;
    std::int64_t segments = -1;
    bool reverse = false, interrupt = true;
    bool execute = false, stop = false;
    std::int64_t job = 0;

    bool busy = false, queued = false, done = false;
    std::int64_t active_segment = 0;  // counts from 1, as SMB166; 0: idle
    std::int64_t trains = 0, pulses = 0, position = 0, lost = 0;
    double rate = 0, end_time = 0;
    bool reversed = false;
    bool clamped = false, overflow = false, underflow = false, stopped = false;
    std::int64_t refused = 0;
    Refusal refusal = Refusal::none;
    std::int64_t warnings = 0;
    Warning warning_id = Warning::none;

    /// What an instruction has taken: one segment, or the first `segments` of `profile`.
    struct Train {
        PulseSegment segment;
        std::int64_t segments = 1;
        bool from_profile = false;
        bool multi_segment = false;
        bool reverse = false;
    };
    enum class Command : std::int64_t { none, load, halt };

    Command command = Command::none;
    Refusal command_refused = Refusal::none;
    Train commanded, active, waiting;
    PulseTrain train;
    PulseSegment last_single;
    bool last_execute = false, last_stop = false;
    bool told = false;  ///< a scan has seen `done`
    std::int64_t last_job = 0;
    std::int64_t advanced = 0;  ///< the time of the last advance [ns]

    static constexpr std::string_view type = "pto";
    static constexpr std::string_view doc = "pulse train output of an S7-200 SMART, one channel";
    static std::span<const Field> fields();
    static std::span<const TableField> tables();
    void scan(const Scan& now);
    std::optional<Misfit> misfit(const IsConstant& is_constant) const;

    std::int64_t next_event_time() const;
    void advance(std::int64_t time, PulseSink* sink);
    void publish(std::int64_t time);

  private:
    void take_instruction();
    void load(std::int64_t time);
    void warn(Warning why);
    void halt(PulseTime time);
    void begin_train(const Train& next, PulseTime start);
    void begin_segment(PulseTime start);
    void end_segment();
    void end_train(PulseTime end);
    bool is_too_short() const;
    bool in_last_segment() const;
    bool renews_done() const;
    PulseSegment segment_of(const Train& of, std::int64_t index) const;
    void lose_from(const Train& of, std::int64_t first_segment);
    void emit(std::int64_t time, PulseSink* sink);
    PulseSegment clamp(const PulseSegment& wanted, bool multi);
};

}  // namespace lineshaft
