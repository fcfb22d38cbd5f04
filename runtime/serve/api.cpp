#include "runtime/serve/api.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/model/scan.hpp"
#include "runtime/names/signal_list.hpp"
#include "runtime/run/signal_json.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/units.hpp"
#include "runtime/trace/csv_sidecar.hpp"
#include "runtime/version.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

ApiReply too_much() {
    return failure(503, "the machine has too much to do", "try again");
}

ApiReply mistake(const Diagnostics& out) {
    const Diagnostic& first = out.list().front();
    return failure(400, first.message, first.help, first.code);
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json() : Json(text);
}

Json state_json(const LiveState& state, const Loaded& loaded) {
    Json forced = Json::object();
    for (const auto& [name, value] : state.forced) forced[name] = value;
    return {
        {"program", loaded.program.title},
        {"time_s", seconds(state.time)},
        {"time_ns", state.time},
        {"speed", state.speed == Pacer::unpaced ? Json("max") : Json(state.speed)},
        {"paused", state.paused},
        {"forced", forced},
        {"recording",
         {{"file", text_or_null(state.recording)}, {"error", text_or_null(state.recording_error)}}},
        {"pace", to_json(state.pace)}};
}

/// What an object of signals and values wants; nothing for anything else.
std::vector<Wanted> wanted_of(const Json& values) {
    std::vector<Wanted> wanted;
    if (!values.is_object()) return wanted;
    for (const auto& [name, value] : values.items()) {
        if (value.is_structured()) return {};
        wanted.push_back(
            {name, value.is_string() ? value.get<std::string>() : value.dump(), value.is_number()});
    }
    return wanted;
}

bool is_traced(const Linked& linked, const Signal& signal) {
    return std::ranges::any_of(linked.traces, [&](const TraceSetup& trace) {
        return std::ranges::count(trace.signals, signal.name, &Signal::name) > 0;
    });
}

std::optional<std::int64_t> time_of(const std::string& text, Diagnostics& out) {
    return Reader(out).time(node_of(text));
}

/// What a client has calculated in seconds is seldom a whole number of nanoseconds: the nearest.
std::optional<std::int64_t> time_of(const Json& time, Diagnostics& out) {
    if (!time.is_number()) return time_of(time.get<std::string>(), out);
    return time_of(fmt::format("{:.9f} s", time.get<double>()), out);
}

// What a request and its reply are, for the table

Json described(Json schema, const char* doc) {
    schema["description"] = doc;
    return schema;
}
Json of_type(const char* type, const char* doc = "") {
    return described({{"type", type}}, doc);
}
Json list_of(Json items) {
    return {{"type", "array"}, {"items", std::move(items)}};
}
Json object(Json properties, Json required = Json::array()) {
    Json schema{{"type", "object"}, {"properties", std::move(properties)}};
    if (!required.empty()) schema["required"] = std::move(required);
    return schema;
}

const Json any_value{
    {"description", "true, an enumeration's name, a number; NaN, INF or -INF as a text"}};

Json values_schema(const char* doc) {
    return {{"type", "object"}, {"description", doc}, {"additionalProperties", any_value}};
}

Json state_schema() {
    return object(
        {{"program", of_type("string")},
         {"time_s", of_type("number", "virtual time that has been reached")},
         {"time_ns", of_type("integer", "the same, exact")},
         {"speed", described(Json::object(), "a number, or max")},
         {"paused", of_type("boolean")},
         {"forced", values_schema("signals that are forced, and their values")},
         {"recording", object({{"file", described({{"type", "string"}, {"nullable", true}},
                                                  "where what comes is recorded; null: nowhere")},
                               {"error", described({{"type", "string"}, {"nullable", true}},
                                                   "why not all is in it now; null: all is")}})},
         {"pace", of_type("object", "tasks, their scans, overruns and lateness")}});
}

const Json stamp_schema =
    object({{"time_s", of_type("number", "the value counts before every scan of this time")},
            {"time_ns", of_type("integer", "the same, exact")}});

const char* const wanted_doc =
    "signals and values: a number in the signal's unit, or text as in a program, such as '2 cm'";

// clang-format off
std::vector<Route> make_routes() {
    const Json names{{"signals", "names, with commas between; all unless given"}};
    return {
        {"GET", "/api/state", "How the machine goes: time, tasks, lateness, forces",
         false, {}, {}, state_schema(), &Api::state},
        {"GET", "/api/signals", "All signals: name, type, unit, what they can be", false, {}, {},
         list_of(object({{"name", of_type("string")},
                         {"type", of_type("string", "boolean, integer, real or enumeration")},
                         {"unit", of_type("string")},
                         {"names", list_of(of_type("string", "of an enumeration"))},
                         {"numbers", list_of(of_type("integer", "of the names, where they are not 0, 1, 2, ..."))},
                         {"settable", of_type("boolean", "an input that no wire feeds")},
                         {"traced", of_type("boolean", "the program records it")}})),
         &Api::signals},
        {"GET", "/api/values", "Values of signals, all of one moment", false, names, {},
         object({{"time_s", of_type("number")}, {"time_ns", of_type("integer")},
                 {"values", values_schema("by name")}}),
         &Api::values},
        {"GET", "/api/stream",
         "Samples of signals as server-sent events, each with rows since the last one: 'time' in "
         "seconds, 'values' a list a signal, 'lost' the rows that came too fast so far; and the "
         "events 'signals', first, and 'state'",
         false,
         Json{{"signals", "names, with commas between"},
              {"every", "virtual time between two rows, such as 10 ms; each step unless given"}},
         {}, nullptr, &Api::stream, "text/event-stream"},
        {"POST", "/api/set", "Sets inputs, all at once",
         true, {}, values_schema(wanted_doc), stamp_schema, &Api::set},
        {"POST", "/api/force", "Keeps signals at values, whatever the program writes",
         true, {}, values_schema(wanted_doc), stamp_schema, &Api::force},
        {"POST", "/api/release", "Forces signals no more",
         true, {}, object({{"signals", list_of(of_type("string"))}}, {"signals"}), stamp_schema,
         &Api::lift_force},
        {"POST", "/api/pause", "Stands still between two scans",
         true, {}, {}, state_schema(), &Api::pause},
        {"POST", "/api/resume", "Goes on", true, {}, {}, state_schema(), &Api::resume},
        {"POST", "/api/step",
         "Runs scans as fast as it can, for some seconds at most, then pauses and answers",
         true, {},
         object({{"scans", of_type("integer", "1 unless given")},
                 {"task", of_type("string", "whose scans; all tasks' unless given")}}),
         state_schema(), &Api::step},
        {"POST", "/api/run_until", "Goes on until a time, then pauses", true, {},
         object({{"time", described({{"oneOf", {of_type("string"), of_type("number")}}},
                                    "from the start: 2 s, or a number of seconds as 'time_s' is one")}},
                {"time"}),
         state_schema(), &Api::run_until},
        {"POST", "/api/speed", "Changes how many virtual seconds a second has", true, {},
         object({{"speed", described(Json::object(), "a number from 1e-6 to 1e6, or max")}}, {"speed"}),
         state_schema(), &Api::speed},
        {"POST", "/api/checkpoint",
         "All that the machine is, as a file: 'serve --resume --checkpoint FILE' goes on from it",
         true, {}, {}, nullptr, &Api::checkpoint, "application/octet-stream"},
        {"GET", "/api/openapi.json", "This document",
         false, {}, {}, of_type("object"), &Api::document},
    };
}
// clang-format on

Json operation(const Route& route) {
    Json out{{"summary", route.doc},
             {"operationId", std::string(route.path.substr(route.path.rfind('/') + 1))}};
    for (const auto& [name, doc] : route.parameters.items())
        out["parameters"].push_back({{"name", name},
                                     {"in", "query"},
                                     {"description", doc},
                                     {"schema", {{"type", "string"}}}});
    if (!route.body.is_null())
        out["requestBody"]["content"]["application/json"]["schema"] = route.body;
    out["responses"]["200"]["description"] = "done";
    Json& reply = out["responses"]["200"]["content"][std::string(route.type)] = Json::object();
    if (!route.reply.is_null()) reply["schema"] = route.reply;
    const auto may_be = [&out](const char* status, const char* doc) {
        out["responses"][status] = {{"description", doc}};
    };
    may_be("400", "the request is wrong: 'error' says how");
    may_be("403", route.writes ? "not allowed: writing without --allow-write or the token, another "
                                 "origin, a wrong token"
                               : "not allowed: another origin, a wrong token");
    if (!route.parameters.is_null()) may_be("414", "the address is too long");
    if (route.method == "POST") may_be("413", "the body has more than 64 KiB");
    may_be("429", "too many requests a second of this machine");
    if (!route.body.is_null() && route.reply == stamp_schema)
        may_be("507",
               "not recorded, for instance as the disk is full: 'error' says whether it "
               "counts");
    may_be("503", "too many clients or requests");
    return out;
}

}  // namespace

ApiReply failure(int status, std::string message, std::string help, std::string code) {
    Json body{{"error", std::move(message)}};
    if (!help.empty()) body["help"] = std::move(help);
    if (!code.empty()) body["code"] = std::move(code);
    return {status, std::move(body)};
}

std::string ApiRequest::parameter(const std::string& name) const {
    const auto it = query.find(name);
    return it == query.end() ? "" : it->second;
}

std::span<const Route> routes() {
    static const std::vector<Route> table = make_routes();
    return table;
}

Json openapi() {
    Json paths;
    for (const Route& route : routes()) {
        std::string method(route.method);
        std::ranges::transform(method, method.begin(), [](char c) { return c | ' '; });
        paths[std::string(route.path)][method] = operation(route);
    }
    return {{"openapi", "3.0.3"},
            {"info", {{"title", "lineshaft serve"}, {"version", version()}}},
            {"paths", paths}};
}

/// `job` in the machine's thread.
template <class Job>
ApiReply Api::ask(Job job) {
    auto reply = live_.mailbox().ask(std::move(job));
    return reply ? *reply : too_much();
}

/// `job` in the machine's thread, and how the machine goes then.
template <class Job>
ApiReply Api::after(Job job) {
    const auto state = live_.mailbox().ask([this, job = std::move(job)] {
        job();
        return live_.state();
    });
    return state ? ApiReply{200, state_json(*state, loaded_)} : too_much();
}

ApiReply Api::state(const ApiRequest&) {
    return after([] {});
}

ApiReply Api::signals(const ApiRequest&) {
    Json list = Json::array();
    for (const Signal& signal : loaded_.linked.machine.signals) {
        list.push_back({{"name", signal.name},
                        {"type", name_of(signal.type)},
                        {"unit", signal.unit},
                        {"settable", desk_.is_settable(signal.name)},
                        {"traced", is_traced(loaded_.linked, signal)}});
        if (!signal.names.empty()) list.back()["names"] = signal.names.list();
        if (Json numbers = numbers_json(signal.names); !numbers.empty())
            list.back()["numbers"] = std::move(numbers);
    }
    return {200, std::move(list)};
}

std::vector<const Signal*> Api::named(const ApiRequest& request, Diagnostics& out) {
    return desk_.signals(signals_in(request.parameter("signals")), out);
}

ApiReply Api::values(const ApiRequest& request) {
    Diagnostics out;
    const auto signals = named(request, out);
    if (!out.empty()) return mistake(out);
    struct Moment {
        std::int64_t time;
        std::vector<Value> values;
    };
    const auto moment = live_.mailbox().ask([this, signals] {
        Moment now{live_.time(), {}};
        for (const Signal* signal : signals) now.values.push_back(signal->value());
        return now;
    });
    if (!moment) return too_much();
    Json values = Json::object();
    for (std::size_t i = 0; i < signals.size(); ++i)
        values[signals[i]->name] = to_json(*signals[i], moment->values[i]);
    return {200,
            {{"time_s", seconds(moment->time)}, {"time_ns", moment->time}, {"values", values}}};
}

ApiReply Api::stream(const ApiRequest& request) {
    constexpr std::size_t most_signals = 1000;
    Diagnostics out;
    const std::string every = request.parameter("every");
    const auto interval = every.empty() ? 1 : time_of(every, out);
    auto signals = named(request, out);
    if (!out.empty()) return mistake(out);
    if (signals.size() > most_signals || request.parameter("signals").empty())
        return failure(400, "a stream has 1 to 1000 signals", "name them: ?signals=a.b,c.d");
    const auto stream =
        std::make_shared<Stream>(std::move(signals), std::max<std::int64_t>(*interval, 1));
    return ask([this, stream] {
        live_.add(stream);
        return ApiReply{.status = 200, .body = {}, .stream = stream};
    });
}

ApiReply Api::change(Change::Kind kind, const std::vector<Wanted>& wanted) {
    constexpr const char* help = "make room on the disk, then try again";
    Diagnostics out;
    auto changes = desk_.changes(kind, wanted, out);
    if (!out.empty()) return mistake(out);
    if (std::string error = live_.recording_error(); !error.empty())
        return failure(507, std::move(error), help, code::recording_cannot_be_written);
    const auto applied = live_.mailbox().ask([&] { return live_.apply(changes); });
    if (!applied) return too_much();
    if (const std::string error = live_.keep(*applied); !error.empty())
        return failure(507, "this counts, but is not in the recording: " + error, help,
                       code::recording_cannot_be_written);
    return {200, {{"time_s", seconds(applied->at)}, {"time_ns", applied->at}}};
}

ApiReply Api::set(const ApiRequest& request) {
    const auto wanted = wanted_of(request.body);
    if (wanted.empty()) return failure(400, "expected inputs and values", "{\"inputs.go\": true}");
    return change(Change::Kind::set, wanted);
}

ApiReply Api::force(const ApiRequest& request) {
    const auto wanted = wanted_of(request.body);
    if (wanted.empty()) return failure(400, "expected signals and values", "{\"slave.ratio\": 2}");
    return change(Change::Kind::force, wanted);
}

ApiReply Api::lift_force(const ApiRequest& request) {
    const Json& body = request.body;
    std::vector<Wanted> wanted;
    if (body.is_object() && body.contains("signals") && body["signals"].is_array())
        for (const Json& name : body["signals"])
            if (name.is_string()) wanted.push_back({name.get<std::string>(), {}});
    if (wanted.empty())
        return failure(400, "expected names of signals", "{\"signals\": [\"slave.ratio\"]}");
    return change(Change::Kind::lift_force, wanted);
}

ApiReply Api::pause(const ApiRequest&) {
    return after([this] { live_.pause(); });
}

ApiReply Api::resume(const ApiRequest&) {
    return after([this] { live_.resume(); });
}

ApiReply Api::step(const ApiRequest& request) {
    constexpr std::int64_t most = 1'000'000;
    constexpr int most_turns = 2500;
    const Json& body = request.body;
    std::int64_t scans = 1;
    int task = -1;
    if (body.is_object() && body.contains("scans"))
        scans = body["scans"].is_number_integer() ? body["scans"].get<std::int64_t>() : 0;
    if (scans < 1 || scans > most)
        return failure(400, "'scans' is a whole number from 1 to 1000000");
    if (body.is_object() && body.contains("task")) {
        const std::string name = body["task"].is_string() ? body["task"].get<std::string>() : "";
        const auto& tasks = loaded_.linked.machine.tasks;
        const auto it = std::ranges::find(tasks, name, &Task::name);
        if (it == tasks.end()) return failure(400, "the program has no such task");
        task = static_cast<int>(it - tasks.begin());
    }
    for (int i = 0; i < most_turns && scans > 0; ++i) {
        const auto left =
            live_.mailbox().ask([this, task, scans] { return live_.step(task, scans); });
        if (!left) return too_much();
        scans = *left;
    }
    return state(request);
}

ApiReply Api::run_until(const ApiRequest& request) {
    const Json& body = request.body;
    const Json wanted = body.is_object() && body.contains("time") ? body["time"] : Json();
    if (!wanted.is_string() && !wanted.is_number())
        return failure(400, "expected a time", "{\"time\": \"2 s\"}");
    Diagnostics out;
    const auto time = time_of(wanted, out);
    if (!time) return mistake(out);
    const auto begun = live_.mailbox().ask(
        [this, goal = *time] { return std::pair(live_.run_until(goal), live_.state()); });
    if (!begun) return too_much();
    const auto& [goes_on, state] = *begun;
    if (!goes_on)
        return failure(400,
                       fmt::format("{} has been: the machine is at {}", format_time(*time),
                                   format_time(state.time)),
                       "name a later time, or serve the program again from its start");
    return {200, state_json(state, loaded_)};
}

ApiReply Api::speed(const ApiRequest& request) {
    const Json& body = request.body;
    const Json wanted = body.is_object() && body.contains("speed") ? body["speed"] : Json();
    const bool is_max = wanted == "max";
    if (!is_max && !(wanted.is_number() && wanted.get<double>() >= Pacer::least &&
                     wanted.get<double>() <= Pacer::most))
        return failure(400, "a speed is a number from 1e-6 to 1e6, or max", "{\"speed\": 1}");
    const double speed = is_max ? Pacer::unpaced : wanted.get<double>();
    return after([this, speed] { live_.set_speed(speed); });
}

ApiReply Api::checkpoint(const ApiRequest&) {
    return ask([this] { return ApiReply{.status = 200, .body = {}, .file = save_()}; });
}

ApiReply Api::document(const ApiRequest&) {
    return {200, openapi()};
}

}  // namespace lineshaft
