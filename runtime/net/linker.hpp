#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "runtime/csv/csv_reader.hpp"
#include "runtime/net/link.hpp"
#include "runtime/source/reader.hpp"

namespace lineshaft {

/// A block while it is being linked.
struct Instance {
    const BlockPlan* plan = nullptr;
    const BlockType* type = nullptr;  ///< null: unknown, already reported
    int task = -1;                    ///< -1: unknown, already reported
    int position = 0;                 ///< in the file, and so in the scan order of its task
    std::size_t offset = 0;           ///< in its task's memory
    std::byte* live = nullptr;
    std::byte* published = nullptr;
    std::vector<int> sources = {};  ///< blocks of its task that it takes this scan's outputs of
    std::vector<int> late_readers = {};  ///< blocks of its task that take its last scan's outputs
    int level = 0;                       ///< of its call, see link_calls.cpp

    bool known() const { return type && task >= 0; }
    auto call() const { return std::tuple(task, level, type); }
};

/// What feeds a block's inputs, by what happens on the way: see Call.
struct BlockWires {
    std::vector<Copy> words, booleans, negated, widened;
    std::vector<ScaledCopy> scaled;
};

/// `NOT previous(a.b)` taken apart.
struct WireText {
    std::string signal;
    bool negated = false;
    bool previous = false;
};

std::optional<WireText> parse_wire(const Node& node);

/// `real`, or an enumeration's names.
std::string kind(Type type, std::span<const std::string_view> names);

/// What a value from outside is written to.
struct Target {
    Signal signal;
    const Instance* block = nullptr;  ///< null: an input of the program
    Field field = {};                 ///< with the name that the program gives
    std::byte* live = nullptr;
    std::byte* published = nullptr;  ///< may be the live one
};

/// Turns a program's names into memory, see link(). Its functions stand in link.cpp (the order of
/// work, tasks, memory), link_names.cpp (signals and units), link_blocks.cpp (parameters and
/// constants), link_wires.cpp, link_calls.cpp (the order of scanning), link_outside.cpp (what is
/// set from outside), link_replay.cpp (likewise from a file), link_run.cpp (what happens to the
/// machine and what is expected) and link_trace.cpp.
class Linker {
  public:
    Linker(const Program& program, const Catalog& catalog, Diagnostics& out)
        : program_(program), catalog_(catalog), read_(out) {}

    Linked link();

  private:
    void place_tasks();
    void choose_main_task();
    void find_blocks();
    int find_task(const Node& name);
    void add_cost(const BlockPlan& plan, int task);
    bool takes_time(int task) const;
    BlockInfo info(const Instance& block) const;
    void order_blocks();
    void set_level(Instance& block) const;
    void lay_out();
    void place_blocks();
    void set_inputs();
    void set_choices(Instance& block);
    void set_block(Instance& block);
    void set_port(Instance& block, const Node& key, const Node& value);
    void set_table(Instance& block, const TableField& table, const Node& value);
    void set_constant(Instance& block, const Field& field, const Node& value);
    std::optional<Value> interval_of(const Node& value, const Field& field, const Unit& unit);
    void wire(int index, const Field& field, const Node& value, const WireText& wire);
    bool check_order(int index, const Node& value, const WireText& wire, int source);
    std::string loop(int from, int to) const;
    void check_required(const Instance& block);
    void make_calls();
    void append_call(std::span<const Instance* const> blocks);
    void collect_signals();
    void collect_errors();
    void collect_devices();
    WarningCount warnings_of(const Instance& block) const;
    void connect_events();

    std::optional<Signal> signal(const Node& node, const std::string& name);
    std::optional<Signal> signal(const Node& node) { return signal(node, node.text); }
    Signal field_signal(const Instance& block, const Field& field) const;
    void unknown_port(const Node& node, const Instance& block, std::string_view port);
    void connect_run();
    void connect_outputs();
    void connect_overruns();
    void connect_stimuli();
    void connect_stimulus(const StimulusPlan& plan, int task, const Node& key, const Node& value);
    void connect_replays();
    void connect_replay(const ReplayPlan& plan, std::size_t& room);
    std::optional<Target> replayed(const ReplayPlan& plan, const Node& key);
    std::optional<std::vector<std::int64_t>> replay_times(const ReplayPlan& plan,
                                                          const CsvTable& table);
    std::vector<Replay::Point> replay_points(const Target& input, const Node& name,
                                             const CsvTable& table,
                                             const std::vector<std::int64_t>& times);
    void wrong_cell(const Target& input, const Node& name, const CsvColumn& column, std::size_t row,
                    bool is_out_of_range);
    std::optional<Unit> column_unit(const CsvColumn& column, const std::string& wanted,
                                    const Node& place);
    void connect_forces();
    void connect_force(const ForcePlan& plan);
    void connect_retained();
    std::optional<Target> target(const Node& node);
    std::optional<Target> settable(const Node& node);
    std::optional<Value> literal(const Target& target, const Node& value);
    void connect_traces();
    TraceSetup connect_trace(const TracePlan& plan);
    TraceTrigger connect_trigger(const TriggerPlan& plan);
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
    std::vector<Instance*> order_;  ///< of the known ones in memory: call by call
    std::unordered_map<std::string, int> by_name_;
    std::unordered_map<std::string, Signal> inputs_;
    std::unordered_map<std::string, std::string> outputs_;  ///< the signals that they show
    std::vector<std::string> task_names_, block_names_, input_names_, output_names_;
    std::unordered_map<std::string, Unit> units_;
    std::vector<BlockWires> wires_;          ///< per block
    std::unordered_set<std::string> wired_;  ///< `block.port` of every wire
};

}  // namespace lineshaft
