#pragma once

#include <map>
#include <memory>

#include "runtime/debug/session.hpp"
#include "runtime/debug/values.hpp"
#include "runtime/messages/messages.hpp"

namespace lineshaft::debug {

/// A program that is ready to be run.
struct Launched {
    Loaded loaded;
    RunOptions how;
    std::function<int(const RunReport&)> tell;  ///< what came of it; gives the exit code
    std::string record = {};                    ///< where changes made by hand go; empty: nowhere
};

/// Loads what a client wants to run: the program's file (empty: it said none) and options as on the
/// command line. Null with `error`, for people, if that cannot be.
using Launcher = std::function<std::unique_ptr<Launched>(
    const std::string& program, const std::vector<std::string>& args, std::string& error)>;

/// Speaks the Debug Adapter Protocol with one client, for one session. Returns when the client has
/// gone: the exit code of what it ran.
int serve_debugger(Messages& messages, Launcher launcher);

}  // namespace lineshaft::debug
