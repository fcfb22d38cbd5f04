#include "runtime/debug/adapter.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "runtime/debug/protocol.hpp"
#include "runtime/source/units.hpp"
#include "runtime/trace/output_file.hpp"

namespace lineshaft::debug {

namespace {

/// Frames of tasks are numbered from here on, behind those of routines.
constexpr std::int64_t first_task_frame = 1'000'000;

class Adapter final : Front {
  public:
    Adapter(Messages& messages, Launcher launcher)
        : messages_(messages), launcher_(std::move(launcher)) {}

    /// Returns when the client has gone. The exit code of what it ran.
    int serve() {
        while (!is_gone_ && handle_next())
            if (is_configured_ && !has_run_) run();
        return exit_code_;
    }

  private:
    using Handler = Json (Adapter::*)(const Json& arguments);

    /// False: the client has gone.
    bool handle_next() {
        const auto message = messages_.next();
        if (message) handle(Json::parse(*message, nullptr, false));
        return message.has_value();
    }

    void run() {
        const RunReport report = session_->run(launched_->how);
        has_run_ = true;
        exit_code_ = launched_->tell(report);
        for (std::size_t i = 0; i < report.verdicts.size(); ++i) {
            const Verdict& verdict = report.verdicts[i];
            tell("console", fmt::format("{}  {}{}\n", verdict.word(),
                                        launched_->loaded.linked.expectations[i].text,
                                        verdict.ok ? "" : ": " + verdict.deviation));
        }
        if (const std::string text = session_->recording();
            !text.empty() && !launched_->record.empty()) {
            OutputFile file(launched_->record);
            file.write(text);
            if (!file.commit()) tell("stderr", file.error() + "\n");
        }
        if (!report.refused.empty()) tell("stderr", report.refused.render());
        if (!report.result.message.empty()) tell("stderr", report.result.message + "\n");
        send_event("exited", {{"exitCode", exit_code_}});
        send_event("terminated", Json::object());
    }

    static const std::map<std::string, Handler>& handlers() {
        static const std::map<std::string, Handler> all{
            {"initialize", &Adapter::initialize},
            {"launch", &Adapter::launch},
            {"setBreakpoints", &Adapter::set_breakpoints},
            {"setExceptionBreakpoints", &Adapter::set_exceptions},
            {"configurationDone", &Adapter::configuration_done},
            {"threads", &Adapter::threads},
            {"stackTrace", &Adapter::stack_trace},
            {"scopes", &Adapter::scopes},
            {"variables", &Adapter::variables},
            {"evaluate", &Adapter::evaluate},
            {"setVariable", &Adapter::set_variable},
            {"setFunctionBreakpoints", &Adapter::set_function_breakpoints},
            {"dataBreakpointInfo", &Adapter::data_breakpoint_info},
            {"setDataBreakpoints", &Adapter::set_data_breakpoints},
            {"lineshaft/state", &Adapter::state},
            {"lineshaft/lastWriter", &Adapter::last_writer},
            {"lineshaft/goTo", &Adapter::go_to},
            {"pause", &Adapter::pause},
            {"disconnect", &Adapter::disconnect},
            {"terminate", &Adapter::terminate}};
        return all;
    }

    static const std::map<std::string, Way>& ways() {
        static const std::map<std::string, Way> all{{"continue", Way::go},
                                                    {"next", Way::next},
                                                    {"stepIn", Way::into},
                                                    {"stepOut", Way::out},
                                                    {"stepBack", Way::back},
                                                    {"reverseContinue", Way::back_go},
                                                    {"lineshaft/nextScan", Way::next_scan}};
        return all;
    }

    void handle(const Json& message) {
        const std::string command = text_in(message, "command");
        if (text_in(message, "type") != "request") return;
        const auto it = message.find("arguments");
        const Json arguments = it != message.end() && it->is_object() ? *it : Json::object();
        try {
            if (const auto way = ways().find(command); way != ways().end())
                return answer(message, go_on(arguments, way->second));
            const auto handler = handlers().find(command);
            if (handler == handlers().end())
                throw Refused(fmt::format("there is no request '{}' here", command));
            answer(message, (this->*handler->second)(arguments));
            if (command == "launch") send_event("initialized", Json::object());
        } catch (const Refused& why) {
            const std::string text = why.what();
            answer(message, {{"error", {{"id", 1}, {"format", text}, {"showUser", true}}}}, text);
        }
    }

    /// `why` it is refused; empty: it is not.
    void answer(const Json& request, const Json& body, const std::string& why = {}) {
        Json response{{"seq", ++sequence_},
                      {"type", "response"},
                      {"request_seq", number_in(request, "seq")},
                      {"success", why.empty()},
                      {"command", text_in(request, "command")}};
        if (!why.empty()) response["message"] = why;
        if (!body.empty()) response["body"] = body;
        messages_.send(response);
    }

    void send_event(const char* name, Json body) {
        messages_.send(
            {{"seq", ++sequence_}, {"type", "event"}, {"event", name}, {"body", std::move(body)}});
    }

    void tell(const char* category, const std::string& text) {
        send_event("output", {{"category", category}, {"output", text}});
    }

    void happened(const RunEvent& event) override {
        const auto& tasks = launched_->loaded.linked.machine.tasks;
        const std::string task =
            event.task < 0 ? "" : " " + tasks[static_cast<std::size_t>(event.task)].name + ":";
        tell("console", fmt::format("{} {}:{} {}\n", format_time(event.time), name_of(event.kind),
                                    task, event.text));
    }

    void stopped(const Stop& stop) override {
        stands_ = true;
        goes_on_ = false;
        Json body{
            {"reason", stop.reason}, {"threadId", stop.task + 1}, {"allThreadsStopped", true}};
        if (!stop.text.empty()) body["description"] = body["text"] = stop.text;
        if (!stop.breakpoints.empty()) body["hitBreakpointIds"] = stop.breakpoints;
        send_event("stopped", std::move(body));
        while (!goes_on_)
            if (!handle_next()) return leave();
        stands_ = false;
        frames_.clear();
        kept_.clear();
        coming_.clear();
    }

    void look() override {
        while (messages_.waits() && !is_gone_)
            if (!handle_next()) return leave();
    }

    void leave() {
        is_gone_ = goes_on_ = true;
        session_->end();
    }

    Session& session() {
        if (!session_) throw Refused("nothing is launched");
        return *session_;
    }

    Session& standing() {
        if (!stands_)
            throw Refused(has_run_ ? "the run has ended" : "the machine runs; pause it first");
        return session();
    }

    Json initialize(const Json& arguments) {
        first_line_is_0_ = !flag_in(arguments, "linesStartAt1", true);
        return capabilities();
    }

    Json launch(const Json& arguments) {
        if (session_) throw Refused("a program is launched already");
        std::vector<std::string> args;
        for (const Json& arg : list_in(arguments, "args"))
            if (arg.is_string()) args.push_back(arg.get<std::string>());
        if (const std::string test = text_in(arguments, "test"); !test.empty())
            args.insert(args.end(), {"--test", test});
        if (const std::string folder = text_in(arguments, "cwd"); !folder.empty()) {
            std::error_code error;
            std::filesystem::current_path(folder, error);
            if (error) throw Refused(fmt::format("there is no folder '{}'", folder));
        }
        std::string error;
        launched_ = launcher_(text_in(arguments, "program"), args, error);
        if (!launched_) throw Refused(error);
        Front& front = *this;
        session_ = std::make_unique<Session>(launched_->loaded, front);
        session_->stop_on_entry = flag_in(arguments, "stopOnEntry");
        session_->stop_at_end = flag_in(arguments, "stopAtEnd");
        return Json::object();
    }

    Json set_breakpoints(const Json& arguments) {
        const int first = first_line_is_0_ ? 1 : 0;
        const std::string path = text_in(arguments.value("source", Json::object()), "path");
        Json all = Json::array();
        for (const Breakpoint& each : session().set_breakpoints(path, wanted_in(arguments, first)))
            all.push_back(breakpoint_as_json(each, path, first));
        return {{"breakpoints", all}};
    }

    Json set_exceptions(const Json& arguments) {
        const Json filters = arguments.value("filters", Json::array());
        session().stop_on_error = std::ranges::count(filters, "block_error") > 0;
        return Json::object();
    }

    Json set_function_breakpoints(const Json& arguments) {
        return debug::set_function_breakpoints(arguments, session().signals());
    }

    Json data_breakpoint_info(const Json& arguments) {
        const bool is_shown = number_in(arguments, "variablesReference") > 0;
        const Shown shown =
            is_shown ? variable_in(arguments) : watched(arguments, text_in(arguments, "name"));
        return data_as_json(shown.name, name_for_watch(shown),
                            session_->data().id_of(shown, frames()));
    }

    Json set_data_breakpoints(const Json& arguments) {
        return debug::set_data_breakpoints(arguments, session().data());
    }

    Json evaluate(const Json& arguments) {
        Json body = to_json(watched(arguments, text_in(arguments, "expression")));
        body["result"] = body["value"];
        return body;
    }

    /// A signal by its name, or an expression of Structured Text as the frame sees it.
    Shown watched(const Json& arguments, const std::string& text) {
        const Signal* signal = standing().loaded().linked.machine.find(text);
        const auto number = static_cast<std::size_t>(number_in(arguments, "frameId", 1));
        const bool has_frame = !frames().empty() && number > 0 && number <= frames_.size();
        if (signal && !(has_frame && frames_[number - 1].sees(text)))
            return show_signal(launched_->loaded.linked.machine, *signal);
        if (!has_frame)
            throw Refused(fmt::format("there is no signal '{}', and no routine runs here", text));
        const Frame& frame = frames_[number - 1];
        const Evaluated value = Expression(text, *frame.mark.file).value(frame);
        if (value.error.empty()) return value.shown;
        if (!signal) throw Refused(value.error);
        return show_signal(launched_->loaded.linked.machine, *signal);
    }

    Shown variable_in(const Json& arguments) {
        const std::string name = text_in(arguments, "name");
        for (const Shown& shown : inside(arguments))
            if (shown.name == name) return shown;
        throw Refused(fmt::format("there is no variable '{}' any more", name));
    }

    /// As what comes from outside it counts from the next instant on.
    Json set_variable(const Json& arguments) {
        Session& session = standing();
        const Shown shown = variable_in(arguments);
        const std::string value = text_in(arguments, "value");
        const std::string signal = signal_of(session.loaded().linked, shown);
        if (signal.empty()) {
            coming_[name_for_watch(shown)] = write(shown, value);
        } else {
            Diagnostics out;
            const std::string text = session.change(signal, value, out);
            if (!out.empty()) throw Refused(out.list().front().message);
            coming_[signal] = text;
        }
        return {{"value", to_json(variable_in(arguments))["value"]}};
    }

    /// A variable of Structured Text that is no signal. Gives the value as it is shown then.
    std::string write(const Shown& shown, const std::string& value) {
        if (!launched_->record.empty())
            throw Refused(
                fmt::format("'{}' is no signal, so a recording cannot have it: leave "
                            "--record out",
                            shown.name));
        const Written written = write_by_hand(shown, value, frames(), session_->data());
        session_->change(name_for_watch(shown), written.write);
        return written.text;
    }

    int task_in(const Json& arguments) {
        const std::int64_t number = number_in(arguments, "threadId", 1);
        if (number < 1 || number > std::ssize(session().loaded().linked.machine.tasks))
            throw Refused("there is no such task");
        return static_cast<int>(number) - 1;
    }

    Json state(const Json&) {
        const Session& session = standing();
        const Position& here = session.here();
        return {{"time", here.time},
                {"scan", here.scan == Position::behind ? -1 : static_cast<std::int64_t>(here.scan)},
                {"statement", here.statement},
                {"fingerprint", session.fingerprint()},
                {"checkpoints", session.history().size()},
                {"bytes", session.history().bytes()}};
    }

    Json leave_here(const Command& command) {
        standing().command(command);
        goes_on_ = true;
        return Json::object();
    }

    Json go_to(const Json& arguments) {
        const std::int64_t scan = number_in(arguments, "scan", -1);
        const Position to{number_in(arguments, "time"),
                          scan < 0 ? Position::behind : static_cast<std::uint64_t>(scan),
                          static_cast<std::uint64_t>(number_in(arguments, "statement"))};
        return leave_here({.way = Way::to, .to = to});
    }

    Json last_writer(const Json& arguments) {
        const Shown shown = variable_in(arguments);
        if (!shown.at) throw Refused(fmt::format("'{}' is not in the memory", shown.name));
        return leave_here({.way = Way::writer, .at = shown.at, .bytes = shown.bytes});
    }

    Json configuration_done(const Json&) {
        session();
        is_configured_ = true;
        return Json::object();
    }

    Json threads(const Json&) {
        Json threads = Json::array();
        if (launched_)
            for (const Task& task : launched_->loaded.linked.machine.tasks)
                threads.push_back({{"id", threads.size() + 1}, {"name", task.name}});
        return {{"threads", threads}};
    }

    void add_task_frame(Json& frames, int task) {
        const Loaded& loaded = session_->loaded();
        frames.push_back(
            {{"id", first_task_frame + task},
             {"name", fmt::format("task {} at {}",
                                  loaded.linked.machine.tasks[static_cast<std::size_t>(task)].name,
                                  format_time(std::max<std::int64_t>(session_->here().time, 0)))},
             {"source", source_of(loaded.program.file->path)},
             {"line", first_line_is_0_ ? 0 : 1},
             {"column", 1},
             {"presentationHint", "subtle"}});
    }

    const std::vector<Frame>& frames() {
        if (const st::Halt* halt = session_->halt(); halt && frames_.empty())
            frames_ = frames_of(*halt, *session_->made(), session_->loaded().linked.machine);
        return frames_;
    }

    Json stack_trace(const Json& arguments) {
        const st::Halt* halt = standing().halt();
        const int task = task_in(arguments);
        Json frames = Json::array();
        if (halt && halt->context.task == task)
            for (const Frame& frame : this->frames())
                frames.push_back({{"id", frames.size() + 1},
                                  {"name", frame.name},
                                  {"source", source_of(frame.mark.file->path)},
                                  {"line", frame.mark.line - (first_line_is_0_ ? 1 : 0)},
                                  {"column", frame.mark.column}});
        add_task_frame(frames, task);
        const auto total = frames.size();
        const auto first = static_cast<std::size_t>(number_in(arguments, "startFrame"));
        const auto levels = static_cast<std::size_t>(number_in(arguments, "levels"));
        Json wanted = Json::array();
        for (std::size_t i = first; i < total && (levels == 0 || i < first + levels); ++i)
            wanted.push_back(frames[i]);
        return {{"stackFrames", wanted}, {"totalFrames", total}};
    }

    std::int64_t keep(const Shown& shown) {
        if (!shown.inside) return 0;
        kept_.push_back(shown);
        return std::ssize(kept_);
    }

    Json scopes(const Json& arguments) {
        Session& session = standing();
        const Linked& linked = session.loaded().linked;
        const std::int64_t id = number_in(arguments, "frameId");
        std::vector<Shown> shown;
        if (id >= first_task_frame) {
            shown = {show_blocks(linked, static_cast<int>(id - first_task_frame)),
                     show_inputs(linked), show_forces(linked, session.time())};
        } else if (id > 0 && id <= std::ssize(frames_)) {
            shown = scopes_of(frames_[static_cast<std::size_t>(id - 1)]);
        } else {
            throw Refused("there is no such frame any more");
        }
        Json scopes = Json::array();
        for (const Shown& scope : shown)
            scopes.push_back(
                {{"name", scope.name}, {"variablesReference", keep(scope)}, {"expensive", false}});
        return {{"scopes", scopes}};
    }

    /// As a program names it, or else a watch in its frame.
    std::string name_for_watch(const Shown& shown) {
        const std::string signal = signal_of(session_->loaded().linked, shown);
        return signal.empty() ? shown.expression : signal;
    }

    Json to_json(const Shown& shown) {
        const std::string name = name_for_watch(shown);
        const auto coming = coming_.find(name);
        const bool comes = coming != coming_.end() && coming->second != shown.value;
        Json variable{{"name", shown.name},
                      {"value", shown.value + (comes ? fmt::format(" ({} from the next instant on)",
                                                                   coming->second)
                                                     : "")}};
        if (!shown.type.empty()) variable["type"] = shown.type;
        if (!name.empty()) variable["evaluateName"] = name;
        variable["variablesReference"] = keep(shown);
        if (shown.elements > 0) variable["indexedVariables"] = shown.elements;
        return variable;
    }

    /// What is in the variable or group that a request names.
    std::vector<Shown> inside(const Json& arguments) {
        standing();
        const std::int64_t reference = number_in(arguments, "variablesReference");
        if (reference <= 0 || reference > std::ssize(kept_))
            throw Refused("there is no such variable any more");
        return parts_of(kept_[static_cast<std::size_t>(reference - 1)],
                        static_cast<std::size_t>(number_in(arguments, "start")),
                        static_cast<std::size_t>(number_in(arguments, "count")));
    }

    Json variables(const Json& arguments) {
        Json variables = Json::array();
        for (const Shown& shown : inside(arguments)) variables.push_back(to_json(shown));
        return {{"variables", variables}};
    }

    Json pause(const Json&) {
        if (!stands_) session().pause();
        return Json::object();
    }

    Json go_on(const Json& arguments, Way way) {
        const int task = task_in(arguments);
        leave_here({.way = way, .task = task});
        return way == Way::go ? Json{{"allThreadsContinued", true}} : Json::object();
    }

    Json terminate(const Json&) {
        if (session_) session_->end();
        goes_on_ = true;
        return Json::object();
    }

    Json disconnect(const Json& arguments) {
        is_gone_ = true;
        return terminate(arguments);
    }

    void log(const std::string& text) override { tell("console", text); }

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
    /// What was set by hand and counts from the next instant on, by its signal or its watch.
    std::map<std::string, std::string> coming_;
};

}  // namespace

int serve_debugger(Messages& messages, Launcher launcher) {
    return Adapter(messages, std::move(launcher)).serve();
}

}  // namespace lineshaft::debug
