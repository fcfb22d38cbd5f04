#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "runtime/program/program.hpp"

namespace lineshaft {

inline constexpr const char* task_help = "add tasks such as tasks: {servo: {every: 2 ms}}";

/// The parameters' texts in force, where they are declared or where a study sets them; from the
/// command line they have no place, and what cannot be read (it is reported) is no scalar.
using ParameterValues = std::map<std::string, Node>;

/// Makes a Program of a file, see read_program(). Its functions stand in program.cpp (the file,
/// parameters, blocks), program_tasks.cpp, program_outside.cpp (stimuli, replays, forces, retained
/// signals), program_run.cpp (how long, expectations) and program_trace.cpp.
class ProgramReader {
  public:
    ProgramReader(const LoadOptions& options, Diagnostics& out) : options_(options), read_(out) {}

    Program read(std::shared_ptr<const SourceFile> file);

  private:
    std::optional<Node> parse(const std::shared_ptr<const SourceFile>& file) const;
    void parameters(const Node& root);
    void unused_parameters(const Node& root, const std::set<std::string>& used);
    void settings(ParameterValues& values);
    void controller(const Node& node);
    void tasks(const Node& node);
    void task(const Node& name, const Node& body);
    void interval(TaskPlan& plan, const Node& name, const Node& body);
    void events(TaskPlan& plan, const Node& on, const Node& body);
    void check_task(const TaskPlan& plan, const Node& name, const Node& body);
    void check_attached(const Node& task);
    void overruns(TaskPlan& plan, const Node& on, const Node& body);
    void no_interval(const Node& body, std::string_view key);
    void blocks(const Node& node);
    void block(BlockPlan& plan, const Node& body);
    void inputs(const Node& node);
    void outputs(const Node& node);
    void retain(const Node& node);
    void forces(const Node& node);
    void force(const std::string& text);
    void run(const Node& node);
    void stimuli(const Node& node);
    void stimulus(const Node& item);
    void replay(const Node& item);
    bool interpolated(const Node& between) const;
    void traces(const Node& node);
    void trace(const Node& name, const Node& node);
    void traced(const Node& signals, TracePlan& plan);
    void trigger(const Node& node, TriggerPlan& plan);
    void edge(const Node& node, TriggerPlan& plan);
    void check_trace(const Node& node, const TracePlan& plan);
    std::optional<std::int64_t> count(const Node& map, const char* key, std::int64_t least,
                                      const char* help = "");
    void expectations(const Node& node);
    void expectation(const Node& item);
    void bounds(const Node& map, ExpectPlan& plan);
    void at(const Node& node, ExpectPlan& plan);

    const LoadOptions& options_;
    Reader read_;
    Program program_;
    ParameterValues values_;
    bool in_controller_ = false;
};

}  // namespace lineshaft
