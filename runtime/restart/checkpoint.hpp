#pragma once

#include <optional>
#include <string>

#include "runtime/machine/machine.hpp"
#include "runtime/program/program.hpp"

namespace lineshaft {

/// Tells whether two machines are of one program: its meaning, its parameters in force, tasks,
/// memory layout, stimuli, replays and forces, and this version of lineshaft. 16 hexadecimal
/// digits.
std::string fingerprint(const Program& program, const Machine& machine);

/// What a machine is of: a program, by its fingerprint, and the command that runs it.
struct RunBy {
    std::string program;
    std::string_view command;  ///< `run` or `serve`
};

/// A state as a file has it: one line of JSON (version, program, command, virtual time, hash of the
/// state), then its bytes.
std::string checkpoint_of(const RunBy& by, std::int64_t time, const std::string& state);

/// Writes a checkpoint, whole or not at all. Empty when all is well, else what went wrong.
std::string write_checkpoint(const std::string& path, const std::string& checkpoint);

/// The state of a checkpoint of the same. L0001 when it cannot be read, L0506 when it is no
/// checkpoint, is not whole, or belongs to another program, command or version.
std::optional<std::string> read_checkpoint(const std::string& path, const RunBy& by,
                                           Diagnostics& out);

}  // namespace lineshaft
