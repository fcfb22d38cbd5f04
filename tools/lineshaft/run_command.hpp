#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/run/single_run.hpp"
#include "tools/lineshaft/command.hpp"

namespace lineshaft {

/// What the commands that run one program share.
struct RunCommand {
    CommonOptions common;
    std::string program, trace, pulses, retain, checkpoint, checkpoint_every, recording;
    std::vector<std::string> forces, shown;
    CsvStyle style;
    Restart restart = Restart::warm;
    bool resume = false, strict = false;

    /// The options that all of them have.
    void add_to(CLI::App& sub);
};

/// What the command line says of the run; what is wrong with it goes to `out`.
RunOptions run_options(const RunCommand& command, Diagnostics& out);

/// The program, with its warnings told. Empty when `out` has anything: a mistake in it, a file
/// that would replace what is read (`outputs` are the command's own), or would have nothing in it.
std::optional<Loaded> load(const RunCommand& command, const std::vector<std::string>& outputs,
                           Diagnostics& out);

/// Prints what came of it, `more` in the JSON object, too.
Exit tell(const RunCommand& command, const Loaded& loaded, const RunReport& result,
          const nlohmann::ordered_json& more = {});

}  // namespace lineshaft
