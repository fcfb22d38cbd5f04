/// The first byte tells to whom an editor talks, the debugger or the language server, and whether
/// the others are what it sends or decide what that is. Each request has one answer, in their
/// order; what is sent is whole messages.

#include <cstdio>
#include <cstdlib>

#include <sys/mman.h>
#include <unistd.h>

#include "blocks/catalog.hpp"
#include "runtime/debug/adapter.hpp"
#include "tests/fuzz/choices.hpp"
#include "tests/source_folder.hpp"
#include "tools/lineshaft/lsp/server.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// How many were sent in all, which LINESHAFT_FIGURES=1 tells at the end.
struct Sent {
    long messages = 0;
    ~Sent() {
        if (std::getenv("LINESHAFT_FIGURES")) std::fprintf(stderr, "%ld messages\n", messages);
    }
} sent_in_all;

void hold(bool holds, const std::string& what) {
    if (holds) return;
    std::fprintf(stderr, "%s\n", what.c_str());
    std::abort();
}

constexpr std::string_view commands[] = {"continue",
                                         "next",
                                         "stepIn",
                                         "stepOut",
                                         "stepBack",
                                         "reverseContinue",
                                         "lineshaft/nextScan",
                                         "lineshaft/goTo",
                                         "lineshaft/lastWriter",
                                         "lineshaft/state",
                                         "stackTrace",
                                         "scopes",
                                         "variables",
                                         "evaluate",
                                         "setVariable",
                                         "setBreakpoints",
                                         "setFunctionBreakpoints",
                                         "setExceptionBreakpoints",
                                         "threads",
                                         "pause",
                                         "initialize",
                                         "launch",
                                         "configurationDone",
                                         "terminate",
                                         "disconnect",
                                         "nothing"};
constexpr std::string_view methods[] = {"textDocument/didOpen",
                                        "textDocument/didChange",
                                        "textDocument/hover",
                                        "textDocument/definition",
                                        "textDocument/references",
                                        "textDocument/prepareRename",
                                        "textDocument/rename",
                                        "textDocument/completion",
                                        "textDocument/signatureHelp",
                                        "textDocument/documentSymbol",
                                        "textDocument/foldingRange",
                                        "textDocument/formatting",
                                        "textDocument/codeLens",
                                        "textDocument/codeAction",
                                        "textDocument/didClose",
                                        "textDocument/didSave",
                                        "workspace/didChangeWatchedFiles",
                                        "initialize",
                                        "shutdown",
                                        "nothing"};
constexpr std::string_view texts[] = {
    "count",
    "motor.count",
    "ramp.steps + table[2] * 3",
    "count > 7",
    "% 3",
    "now {count}",
    "table[301]",
    "mode = Mode#running",
    "time >= 200 ms",
    "inputs.start",
    "1",
    "true",
    "Outputs",
    "(",
    "block_error",
    "\xff",
    "zz",
    "FUNCTION_BLOCK a VAR x : INT; END_VAR x := x + y; END_FUNCTION_BLOCK",
    "TYPE T : STRUCT a : REAL; END_STRUCT; END_TYPE FUNCTION f : T f.a := 1.0; f(",
    "lineshaft: 1\ntasks: {main: {every: 1 ms}}\nblocks:\n  a: {type: t"};

/// What may stand at a key: mostly what belongs there.
Json value_of(Choices& choices, std::string_view key, int depth) {
    if (choices.once_in(24)) {
        const Json odd[] = {nullptr, -1, 1e300, "x", Json::array({1}), Json::object(), true};
        return choices.one_of(odd);
    }
    const auto list = [&](std::initializer_list<std::string_view> keys, const auto& again) {
        Json all = Json::array();
        for (std::size_t i = choices.below(3); i > 0; --i) {
            Json one = Json::object();
            for (const std::string_view each : keys) one[std::string(each)] = again(each);
            all.push_back(std::move(one));
        }
        return all;
    };
    const auto again = [&](std::string_view inner) { return value_of(choices, inner, depth + 1); };
    if (key == "breakpoints")
        return list({"line", "condition", "hitCondition", "logMessage", "name"}, again);
    if (key == "contentChanges") return list({"range", "text"}, again);
    if (key == "diagnostics") return list({"range", "data"}, again);
    if (key == "context")
        return {{"includeDeclaration", true}, {"diagnostics", again("diagnostics")}};
    if (key == "range") return {{"start", again("position")}, {"end", again("position")}};
    if (key == "position") return {{"line", choices.below(4)}, {"character", choices.below(90)}};
    if (key == "source") return {{"path", in_source("tests/debug/motor.st")}};
    if (key == "textDocument")
        return {{"uri", choices.below(2) ? "file:///nowhere/a.st" : "file:///nowhere/b.yaml"},
                {"text", again("text")},
                {"version", 1},
                {"languageId", "st"}};
    if (key == "filters") return Json::array({again("text")});
    if (key == "time") return choices.below(250) * 5'000'000;
    if (key == "line") return choices.below(80);
    constexpr std::string_view numbers[] = {
        "threadId", "frameId", "variablesReference", "scan", "statement", "start", "count"};
    if (std::ranges::count(numbers, key) > 0) return choices.below(12);
    return choices.one_of(texts);
}

Json parameters(Choices& choices, std::initializer_list<std::string_view> keys) {
    Json made = Json::object();
    for (const std::string_view key : keys) made[std::string(key)] = value_of(choices, key, 0);
    return made;
}

std::string debugger_messages(Choices choices, std::size_t size) {
    std::string all;
    int seq = 0;
    const auto add = [&](std::string_view command, Json arguments) {
        ++sent_in_all.messages;
        all += framed({{"seq", ++seq},
                       {"type", "request"},
                       {"command", command},
                       {"arguments", std::move(arguments)}});
    };
    add("initialize", Json::object());
    add("launch", {{"stopOnEntry", choices.below(2) == 0}, {"stopAtEnd", true}});
    add("setBreakpoints", parameters(choices, {"source", "breakpoints"}));
    add("configurationDone", Json::object());
    for (std::size_t i = 0; i < std::min<std::size_t>(size / 4, 40); ++i)
        add(choices.one_of(commands),
            parameters(choices, {"threadId", "frameId", "variablesReference", "name", "value",
                                 "expression", "source", "breakpoints", "time", "scan", "statement",
                                 "start", "count", "filters"}));
    return all;
}

std::string server_messages(Choices choices, std::size_t size) {
    std::string all = framed({{"id", 0}, {"method", "initialize"}, {"params", Json::object()}});
    for (std::size_t i = 1; i <= std::min<std::size_t>(size / 4, 40); ++i) {
        ++sent_in_all.messages;
        const std::string_view method = choices.one_of(methods);
        Json message{{"jsonrpc", "2.0"}, {"method", method}};
        if (method.find("/did") == method.npos) message["id"] = i;
        message["params"] = parameters(
            choices, {"textDocument", "position", "contentChanges", "newName", "context"});
        all += framed(message);
    }
    return all;
}

/// What was sent, message by message.
std::vector<Json> cut(std::string_view bytes) {
    Frames frames;
    frames.add(bytes);
    std::vector<Json> found;
    while (const auto text = frames.take()) {
        found.push_back(Json::parse(*text, nullptr, false));
        hold(found.back().is_object(), "what is sent is no JSON");
    }
    hold(frames.size() == 0, "what is sent is no whole message");
    return found;
}

/// A file in memory, from its beginning.
int file_with(std::string_view bytes) {
    const int file = ::memfd_create("messages", MFD_CLOEXEC);
    hold(file >= 0 &&
             ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
         "no memory");
    ::lseek(file, 0, SEEK_SET);
    return file;
}

std::unique_ptr<debug::Launched> launch(std::string& error) {
    static const Catalog catalog = standard_blocks();
    Diagnostics out;
    auto loaded = load_program(in_source("tests/debug/motor.yaml"), {}, catalog, out);
    if (!loaded) error = out.render();
    if (!loaded) return {};
    return std::make_unique<debug::Launched>(debug::Launched{
        std::move(*loaded), {}, [](const RunReport& report) { return report.faulted() ? 3 : 0; }});
}

void talk_to_debugger(const std::string& sent) {
    const int in = file_with(sent), out = file_with({});
    {
        Messages messages(in, out);
        debug::serve_debugger(messages, [](const std::string&, const auto&, std::string& error) {
            return launch(error);
        });
    }
    std::string answered(static_cast<std::size_t>(::lseek(out, 0, SEEK_END)), ' ');
    hold(::pread(out, answered.data(), answered.size(), 0) == static_cast<ssize_t>(answered.size()),
         "no answer can be read");
    ::close(in);
    ::close(out);
    std::int64_t last = 0;
    for (const Json& message : cut(answered)) {
        hold(message.at("seq") == ++last, "messages are not counted");
        if (message.at("type") == "response")
            hold(message.at("success").is_boolean() && message.contains("request_seq"),
                 "no response");
    }
}

void talk_to_server(const std::string& sent) {
    std::vector<Json> told;
    lsp::Server server([&](const Json& message) { told.push_back(message); });
    Frames frames;
    frames.add(sent);
    while (const auto text = frames.take()) {
        if (server.ended()) return;
        const Json asked = Json::parse(*text, nullptr, false);
        const bool is_request = asked.is_object() && asked.contains("method") &&
                                asked["method"].is_string() && asked.contains("id") &&
                                (asked["id"].is_string() || asked["id"].is_number_integer());
        told.clear();
        server.receive(*text);
        if (is_request)
            hold(std::ranges::count_if(told,
                                       [&](const Json& m) {
                                           return m.contains("id") && m["id"] == asked["id"];
                                       }) == 1,
                 "a request has not one answer");
        while (server.work()) continue;
        for (const Json& message : told) hold(cut(framed(message)).size() == 1, "no message");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const bool is_raw = (data[0] & 2) != 0;
    const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    const Choices choices({data + 1, size - 1});
    if ((data[0] & 1) != 0)
        talk_to_server(is_raw ? bytes : server_messages(choices, size));
    else
        talk_to_debugger(is_raw ? bytes : debugger_messages(choices, size));
    return 0;
}
