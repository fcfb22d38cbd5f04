#pragma once

#include "runtime/program/form.hpp"

/// The parts of the program's form, each in the file of its subject: what may stand there, and what
/// reads it into a Program.

namespace lineshaft {

struct Program;

inline constexpr const char* block_help =
    "add blocks such as shaft: {type: axis, task: servo, ...}";

const Form& task_form();  ///< task_form.cpp
void read_tasks(const Reader& read, const Node& node, Program& program);
void read_controller_tasks(const Reader& read, const Node& node, Program& program);
const Form& instruction_time_form();
void read_instruction_time(const Reader& read, const Node& node, Program& program);

const Form& template_form();  ///< block_form.cpp
void read_blocks(const Reader& read, const Node& node, Program& program);

const Form& stimulus_form();  ///< outside_form.cpp
const Form& replay_form();
const Form& force_form();
void read_stimuli(const Reader& read, const Node& node, Program& program);
void read_forces(const Reader& read, const Node& node, Program& program);

const Form& trace_form();  ///< trace_form.cpp
void read_trace(const Reader& read, const Node& node, Program& program);
void read_traces(const Reader& read, const Node& node, Program& program);

const Form& report_form();  ///< report_form.cpp
void read_report(const Reader& read, const Node& node, Program& program);

const Form& modbus_form();  ///< modbus_form.cpp
void read_modbus(const Reader& read, const Node& node, Program& program);

const Form& expectation_form();  ///< expectation_form.cpp

}  // namespace lineshaft
