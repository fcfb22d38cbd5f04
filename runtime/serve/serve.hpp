#pragma once

#include "runtime/serve/http.hpp"
#include "runtime/serve/live.hpp"

namespace lineshaft {

struct ServeOptions {
    LiveOptions live;
    int realtime = 0;    ///< SCHED_FIFO priority; 0: none
    std::string record;  ///< the recording's file; empty: none
    RecordSync sync = {};
    std::string audit = {};  ///< the file that tells who wanted to change what; empty: none
    HttpOptions http;        ///< an address of port 0: none
    Address modbus;          ///< likewise
};

struct ServeReport {
    RunReport run;
    Pace pace;
    std::string recording_error;  ///< why the recording is not whole
    std::string audit_error;      ///< why the audit is not
};

/// Runs a program by the clock until its end or an interrupt, as clients want it: see README.md.
/// Its expectations are not judged, for its inputs are others'. `how` is what a run takes. What
/// cannot begin is refused: L0510, L0511, L0512. `ready` is called when clients can come, with the
/// file that is recorded.
ServeReport serve(Loaded& loaded, RunOptions how, const ServeOptions& options,
                  const std::function<void(const std::string& record)>& ready);

}  // namespace lineshaft
