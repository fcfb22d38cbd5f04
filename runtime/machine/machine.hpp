#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/machine/block_memory.hpp"
#include "runtime/machine/replay.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/value.hpp"
#include "runtime/model/wire.hpp"
#include "runtime/names/signal.hpp"
#include "runtime/names/task_settings.hpp"
#include "runtime/st/types/types.hpp"

namespace lineshaft {

/// Copies at equal distances: the same input of one block after the other.
struct Row {
    Copy first;
    std::ptrdiff_t source_step = 0, target_step = 0;  ///< [bytes]
    std::uint32_t count = 0;
    Transfer transfer = Transfer::word;
};

/// A real from another unit of the input's dimension, or from an unsigned integer: times factor,
/// over divisor.
struct ScaledCopy {
    const std::byte* source = nullptr;
    std::byte* target = nullptr;
    double factor = 1;
    double divisor = 1;
    Type source_type = Type::real;
};

/// What feeds the inputs of a task's blocks, one call after the other.
struct Wires {
    std::vector<Copy> copies;  ///< those in no row: of each call in the order of Transfer
    std::vector<Row> rows;
    std::vector<ScaledCopy> scaled;
};

/// Feeds and scans a call of any kind of block.
bool feed_and_scan(const FedBlock& call, const Scan& now);

/// One entry of a task's list: blocks of one kind, of which none waits for another, one behind the
/// other in memory. What `run` needs of a single block is one line of the cache.
struct alignas(64) Call : FedBlock {
    FeedAndScan run = feed_and_scan;  ///< for a single block maybe what its kind brings along
    ScanBlocks scan = nullptr;
    std::size_t count = 0, size = 0;  ///< of blocks; [bytes] of each
    Context context = {};
    Feed feed = Feed::no_wire;
    /// With Feed::many: so many of the task's wires from these on.
    std::uint32_t booleans = 0, words = 0, widened = 0, rows = 0, scaled = 0;
    const Copy* first_copy = nullptr;
    const Row* first_row = nullptr;
    const ScaledCopy* first_scaled = nullptr;

    std::byte* block(std::size_t i) const { return first + i * size; }
};

/// Copies to the inputs of the call's blocks what they are wired to.
void feed(const Call& call);

/// How a call with these wires is fed and scanned: feed_and_scan, or what does no more than it
/// needs.
FeedAndScan shortest_way(const Call& call);

/// A block's `error` output, looked at after each scan of its task.
struct ErrorFlag {
    const bool* error = nullptr;
    const std::int64_t* error_id = nullptr;  ///< may be null
    ValueNames names;                        ///< of error_id
    std::string block;                       ///< `'drive' (servo_drive)`
    const BlockType* type = nullptr;         ///< may be null
    const std::byte* memory = nullptr;       ///< of the block
};

/// What a device puts up with and goes on from: its outputs `warnings`, a count, and `warning_id`,
/// the reason of the last. Both null in a device without.
struct WarningCount {
    const std::int64_t* count = nullptr;
    const std::int64_t* id = nullptr;
    ValueNames names = {};   ///< of id
    std::string block = {};  ///< `'x' (pto)`
};

/// A block that lives between scans, see runtime/model/device.hpp. Its memory is not published with
/// its task: what others see of it is always the live block.
struct DeviceCall {
    DeviceCalls calls;
    std::byte* block = nullptr;
    std::string name;  ///< of the block in the program
    int task = 0;
    PulseSink* sink = nullptr;  ///< set before a run to record its pulses
    WarningCount warnings = {};
};

/// A rising edge of a published boolean releases an event task.
struct Trigger {
    const bool* signal = nullptr;
    int task = 0;
};

/// A value written from outside, before the tasks due then run.
struct Stimulus {
    std::int64_t at = 0;  ///< [ns]; of a task's own: the index of the scan that it precedes
    std::byte* target = nullptr;
    Type type = Type::real;
    Value value;
    std::string text = {};  ///< `inputs.start = true`, for the event list
};

/// What messages say of a block in a task.
struct BlockInfo {
    std::string block;      ///< `'drive' (servo_drive)`
    std::int64_t cost = 0;  ///< the block's own share of its task's cost [ns]
};

/// A task ready to run: one flat list.
struct Task : TaskSettings {
    std::vector<Call> calls;
    std::vector<BlockInfo> infos;  ///< in the order of the file
    Wires wires;
    std::vector<ErrorFlag> errors;
    std::vector<const std::int64_t*> times_taken;  ///< by its blocks in a scan [ns]
    std::vector<Stimulus> stimuli;                 ///< by scan, sorted
    std::byte* live = nullptr;                     ///< the task's blocks
    std::byte* published = nullptr;  ///< what others see of them: the same place without cost
    std::size_t size = 0;            ///< bytes of either
};

/// The parameter `seed` of a block: where it is 0, the block's own number is drawn from the run's
/// seed and the block's name.
struct BlockSeed {
    std::byte* place = nullptr;  ///< std::int64_t
    std::string block;           ///< its name in the program
};

/// A signal that keeps a value from outside for [from, until), whatever the program writes.
struct Force {
    std::int64_t from = 0, until = never;  ///< [ns]
    std::byte* live = nullptr;
    std::byte* published = nullptr;    ///< null where it is the live one
    const std::byte* block = nullptr;  ///< that it belongs to; null for an input of the program
    bool is_output = false;            ///< else its block reads it
    bool stays =
        false;      ///< a variable of a program: its block reads it, and it stays behind the force
    int task = -1;  ///< of the block
    Type type = Type::real;
    Value value;
    std::string name, value_text = {};  ///< `slave.ratio`, `2`

    std::string text() const { return "force " + name + " = " + value_text; }
};

/// A value that outlives the run: see runtime/restart/retain.hpp.
struct Retained {
    Signal signal;
    std::byte* live = nullptr;
    std::byte* published = nullptr;  ///< may be the live one
};

/// Where an instance stands.
struct BlockPlace {
    std::string name;
    const BlockType* type = nullptr;
    std::byte* live = nullptr;
    std::byte* published = nullptr;  ///< may be the live one
};

/// A block that outlives the run with all that it remembers; parameters, inputs and references stay
/// as the program has them.
struct RetainedBlock {
    std::size_t instance = 0;
    BlockPlace place;
    std::string settings;  ///< Hash of what its memory rests on: version, kind, parameters
    bool is_part = false;  ///< of that instance, whose source gives it its inputs
};

/// A variable of Structured Text that outlives the run.
struct RetainedVariable {
    std::string name;
    const st::Type* type = nullptr;
    std::byte* live = nullptr;
    std::byte* published = nullptr;  ///< may be the live one
    std::size_t size = 0;            ///< [bytes]
};

/// A file that a program replays.
struct ReplayedFile {
    std::string name;   ///< as the program has it
    std::string crc32;  ///< Checksum of its bytes
};

/// A checked and wired program in memory. Owns the blocks; movable, not copyable.
struct Machine {
    BlockMemory memory;       ///< all blocks and inputs; zeroed, then constructed
    std::vector<Task> tasks;  ///< in scan order of equal instants: priority, then place in the file
    std::vector<BlockPlace> blocks;             ///< in the order of the file
    std::vector<std::byte*> instances;          ///< their live memory, for references
    std::vector<const BlockType*> types;        ///< theirs
    std::vector<std::vector<std::byte*>> seen;  ///< by task: of other tasks what they published
    std::vector<Signal> signals;
    std::vector<Stimulus> stimuli;  ///< sorted by time
    std::vector<Replay> replays;    ///< in the order of the file: of one input the last wins
    std::vector<ReplayedFile> replayed;
    std::vector<Force> forces;
    std::vector<Retained> retained;
    std::vector<RetainedVariable> retained_variables;
    std::vector<RetainedBlock> retained_blocks;
    std::vector<DeviceCall> devices;
    std::vector<Trigger> triggers;
    std::vector<BlockSeed> block_seeds;
    std::vector<std::int64_t> looks;  ///< sorted; instants because somebody looks at a device then
    std::optional<Signal> until;
    int main_task = -1;         ///< the cyclic task of lowest priority: its start begins a cycle
    std::int64_t duration = 0;  ///< [ns]; with `until` the limit
    std::int64_t end = never;   ///< where the run stops before that without a fault [ns]
    std::uint64_t seed = 1;
    bool continue_on_error = false;

    bool retains_nothing() const {
        return retained.empty() && retained_variables.empty() && retained_blocks.empty();
    }
    const Signal* find(std::string_view name) const;

    /// From its time on in place of every other force of its signal.
    void impose(Force force);
    /// Ends at `at` what keeps the signal at `live` then.
    void lift_force(const std::byte* live, std::int64_t at);

    /// Where the value stands: for its own task, and for all others.
    std::byte* live(Port port);
    std::byte* published(Port port);

    /// The signal with its place, as all others see it.
    Signal placed(Signal signal);

    /// What blocks of that kind in that task are given.
    Context context_of(const BlockType& type, int task);
};

}  // namespace lineshaft
