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

/// Speaks the Debug Adapter Protocol with one client, for one session.
class Adapter final : Front {
  public:
    Adapter(Messages& messages, Launcher launcher);

    /// Returns when the client has gone. The exit code of what it ran.
    int serve();

  private:
    using Handler = Json (Adapter::*)(const Json& arguments);

    bool handle_next();
    void handle(const Json& message);
    void answer(const Json& request, const Json& body, const std::string& why = {});
    void send_event(const char* name, Json body);
    void tell(const char* category, const std::string& text);
    void run();
    void leave();

    // Front
    void stopped(const Stop& stop) override;
    void look() override;
    void happened(const RunEvent& event) override;
    void log(const std::string& text) override { tell("console", text); }

    Json initialize(const Json& arguments);
    Json launch(const Json& arguments);
    Json set_breakpoints(const Json& arguments);
    Json set_exceptions(const Json& arguments);
    Json configuration_done(const Json& arguments);
    Json threads(const Json& arguments);
    Json stack_trace(const Json& arguments);
    Json scopes(const Json& arguments);
    Json variables(const Json& arguments);
    Json evaluate(const Json& arguments);
    Json set_variable(const Json& arguments);
    Json set_function_breakpoints(const Json& arguments);
    Json state(const Json& arguments);
    Json last_writer(const Json& arguments);
    Json go_to(const Json& arguments);
    Json pause(const Json& arguments);
    Json go_on(const Json& arguments, Way kind);
    Json terminate(const Json& arguments);
    Json disconnect(const Json& arguments);
    static const std::map<std::string, Handler>& handlers();
    static const std::map<std::string, Way>& ways();

    Session& session();
    Session& standing();
    int task_in(const Json& arguments);
    Shown variable_in(const Json& arguments);
    const std::vector<Frame>& frames();
    void forget();
    Json to_json(const Shown& shown);
    std::int64_t keep(const Shown& shown);
    void add_task_frame(Json& frames, int task);

    Messages& messages_;
    Launcher launcher_;
    std::unique_ptr<Launched> launched_;
    std::unique_ptr<Session> session_;
    std::int64_t sequence_ = 0;
    bool is_configured_ = false, is_gone_ = false, goes_on_ = false, stands_ = false,
         first_line_is_0_ = false, has_run_ = false;
    int exit_code_ = 0;
    std::vector<Frame> frames_;  ///< that run; their numbers are those of the protocol, less 1
    std::vector<Shown> kept_;    ///< by reference, less 1
};

}  // namespace lineshaft::debug
