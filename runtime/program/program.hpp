#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/projects/project.hpp"
#include "runtime/source/diagnostic.hpp"
#include "runtime/source/reader.hpp"
#include "runtime/source/yaml_files.hpp"
#include "runtime/st/code/op_class.hpp"

namespace lineshaft {

/// A parameter's new value, from `--set name=value` or a study's case.
struct Setting {
    std::string name;
    std::string value;
    Mark mark = {};        ///< of the name in a study file; none for the command line
    Mark value_mark = {};  ///< likewise of the value
};

/// A cyclic activity, or one that an event starts, as written in `tasks:` of a program or of its
/// controller file. Times in ns.
struct TaskPlan {
    std::string name;
    Mark mark;
    std::vector<Node> on;     ///< boolean signals whose rising edges start it; then `every` is 0
    bool once = false;        ///< one scan before all others, as OB100; then `every` is 0
    bool unattached = false;  ///< the controller leaves it to the program to say what starts it
    std::int64_t every = 0;
    std::int64_t offset = 0;
    std::int64_t priority = 1;  ///< a larger number wins, as Siemens counts
    std::int64_t jitter = 0;    ///< each interval is drawn from every +- jitter
    std::int64_t cost = 0;      ///< execution time: outputs are published this long after the start
    std::int64_t cost_jitter = 0;  ///< each execution time is drawn from cost +- cost_jitter
    std::optional<std::int64_t> maximum_cycle_time = {};  ///< of one scan, interruptions included
    bool motion = false;                                  ///< an overrun is STOP
    std::vector<Node> on_overrun = {};  ///< tasks whose time errors start it, as OB80
};

/// What could not be read, and is reported, is empty.
struct BlockPlan {
    Node name;
    Node type;
    Node task;
    std::optional<Node> cost;                         ///< adds to its task's execution time
    bool called = false;                              ///< by sources: its task does not scan it
    std::vector<std::pair<Node, Node>> initial = {};  ///< outputs and values
    std::vector<std::pair<Node, Node>> ports;         ///< key and value, parameters replaced
};

struct RunPlan {
    std::int64_t duration = 0;  ///< [ns] 0: not given
    std::optional<Node> until;  ///< boolean signal that ends the run
    std::uint64_t seed = 1;
    bool continue_on_error = false;
    Mark mark;
};

struct StimulusPlan {
    Mark mark = {};
    std::int64_t at = 0;  ///< [ns]; with `task` the index of its scan
    std::optional<Node> task = {};
    std::vector<std::pair<Node, Node>> set = {};
    std::optional<std::int64_t> cost = {};  ///< [ns] execution time of that scan
};

/// Columns of a CSV file that are played into inputs: an item of `stimulus:` with a file.
struct ReplayPlan {
    Node file;            ///< as written
    std::string path;     ///< of it; empty: reported
    std::int64_t at = 0;  ///< of the file's time 0 [ns]
    bool interpolated = false;
    std::vector<std::pair<Node, Node>> set = {};  ///< inputs and columns
};

/// A value that a signal keeps for [from, until), whatever the program writes. Times in ns.
struct ForcePlan {
    Mark mark = {};
    std::int64_t from = 0;
    std::int64_t until = never;
    Node signal, value;
};

enum class TriggerKind : std::uint8_t {
    immediate,  ///< the start of the run
    rising,     ///< of a boolean
    falling,
    above,   ///< value > low
    below,   ///< value < high
    inside,  ///< low <= value <= high
    equals,  ///< value = low
};

/// The four tables of Modbus.
enum class ModbusTable : std::uint8_t {
    coils,              ///< bits, may be written
    discrete_inputs,    ///< bits
    holding_registers,  ///< words of 16 bits, may be written
    input_registers,    ///< words of 16 bits
};

/// A signal in `modbus:`. What is not written is empty.
struct RegisterPlan {
    ModbusTable table = ModbusTable::coils;
    Node address, signal;
    std::optional<Node> type = {}, scale = {};
    bool little = false;     ///< bytes of a word
    bool low_first = false;  ///< words of a value
    std::optional<Node> write = {};
};

/// An entry of a recording.
struct RecordedPlan {
    Mark mark = {};
    std::int64_t at = 0;  ///< [ns]
    std::vector<std::pair<Node, Node>> set = {}, force = {};
    std::vector<Node> lift_force = {};
    bool end = false;
};

/// What came from outside while a machine was served.
struct RecordingPlan {
    std::string program, meaning;            ///< name of its file; Meaning::in_force
    std::string retained;                    ///< that the machine began with, see retained_line()
    std::shared_ptr<const SourceFile> file;  ///< what stands before the entries
    std::vector<RecordedPlan> entries;       ///< sorted by time

    std::int64_t end() const { return entries.empty() ? 0 : entries.back().at; }
};

/// When a trace begins: `signal` and what must hold of it.
struct TriggerPlan {
    TriggerKind kind = TriggerKind::immediate;
    Node signal;
    std::vector<Node> values;  ///< of above, below, equals one, of inside two
};

/// `trace:`, which has no name, or one of `traces:`. Zeros: not given.
struct TracePlan {
    Node name;
    Node task;
    std::int64_t every = 1;  ///< scans
    std::vector<Node> signals;
    TriggerPlan trigger;
    Node ring;                     ///< the value of `pre_trigger`
    std::int64_t pre_trigger = 0;  ///< rows
    std::int64_t samples = 0;      ///< rows
    std::int64_t duration = 0;     ///< [ns]
    std::int64_t repeat = 1;
};

/// One line of `expect:`.
struct ExpectPlan {
    enum class When : std::uint8_t {
        at_end,
        at,        ///< `from`
        always,    ///< in every scan from `from` to `until`
        excluded,  ///< in every scan it is not so
        counted,   ///< rising edges in the whole run
        answered   ///< by `signal` within `until` of each rising edge of `cause`
    };

    Mark mark;
    When when = When::at_end;
    std::int64_t from = 0, until = never;  ///< [ns]
    Node signal, cause;
    std::optional<Node> equals, within, at_least, at_most;
    std::string because;  ///< why it is expected, told with the verdict
};

/// `report:`, each as it is written; what stands beside a mistake is not here.
struct ReportPlan {
    std::optional<Node> plots = {}, own_axis = {}, hide = {}, curves = {}, paths = {}, circle = {},
                        band = {}, condition = {};
};

/// A program file as plain data: its structure is checked, its names are not yet.
struct Program {
    std::shared_ptr<const SourceFile> file;
    Node root;                                                  ///< parameters replaced
    std::optional<Node> controller_name = {}, controller = {};  ///< the file's name, its root
    std::string title;
    std::vector<std::string> notes;
    std::vector<std::pair<std::string, std::string>> parameters;  ///< name, value in force
    std::vector<TaskPlan> tasks;
    std::optional<st::InstructionTimes> instruction_times;  ///< of the controller
    bool tasks_known = true;  ///< false: not all could be read, a name may be one of the missing
    std::vector<BlockPlan> blocks;
    std::vector<Node> sources;                             ///< files and folders of Structured Text
    std::vector<std::shared_ptr<const SourceFile>> texts;  ///< what they are
    bool sources_known = true;                             ///< false: not all could be read
    std::string dialect;  ///< of those in `.st`, by its name; empty: the standard's, or MatIEC's
    bool overflow_faults = false;  ///< of an integer of Structured Text; else it wraps
    std::vector<std::pair<Node, Node>> inputs;
    std::vector<std::pair<Node, Node>> outputs;  ///< name and the signal it shows
    std::vector<std::pair<Node, Node>> io;       ///< addresses, and what they are wired to
    std::vector<Node> retain;                    ///< blocks, signals
    std::vector<StimulusPlan> stimuli;
    std::vector<ReplayPlan> replays;
    std::vector<ForcePlan> forces;
    std::optional<RecordingPlan> recording;  ///< that is played back
    std::vector<TracePlan> traces;
    std::optional<ReportPlan> report;
    std::vector<RegisterPlan> registers;  ///< `modbus:`
    std::vector<ExpectPlan> expectations;
    RunPlan run;
};

/// What a program may read besides itself.
struct LoadOptions {
    std::vector<Setting> settings;
    std::vector<std::string> include_dirs;  ///< allowed besides the project root
    YamlFiles* files = nullptr;  ///< where files are looked up that were read before; may be null
    std::string recording = {};  ///< a file to play back; empty: none
    std::vector<std::string> forces = {};  ///< `signal=value@from..until`, as `--force` has them
};

/// Checks the structure of `file` and replaces parameters. Files that it names (a controller) are
/// read. Whatever is wrong goes to `out`; the result is then as much as could be understood.
Program read_program(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                     Diagnostics& out);

/// L0211 and false unless `root` is a file of `kind`, one of `lineshaft`, `lineshaft_study`,
/// `lineshaft_fit`, `lineshaft_controller`, `lineshaft_recording`, in version 1. What else it holds
/// means nothing then.
bool check_kind(const Reader& read, const Node& root, std::string_view kind);

/// `named` relative to the folder of `from`, if it lies below the project root of `from` (the
/// nearest parent folder that holds `config/`, else its own folder) or below an include directory;
/// else empty, and an L0002 diagnostic at `where`.
std::optional<std::string> resolve_path(const std::string& named, const std::string& from,
                                        const std::vector<std::string>& include_dirs, Mark where,
                                        Diagnostics& out);

/// The sources of a file in any form, or of all below a folder, that the command line names. What a
/// project names lies below its own folder, or below an include directory.
projects::Project read_project(const std::string& path,
                               const std::vector<std::string>& include_dirs, Diagnostics& out);

}  // namespace lineshaft
