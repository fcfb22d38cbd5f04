#include "tools/lineshaft/lsp/server.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/version.hpp"
#include "tools/lineshaft/lsp/requests.hpp"

namespace lineshaft::lsp {

namespace {

constexpr int parse_error = -32700, invalid_request = -32600, method_not_found = -32601,
              invalid_params = -32602, server_not_initialized = -32002;

struct Request {
    std::string_view method;
    Json (*answer)(Session&, const Json&);
};
constexpr Request requests[] = {{"textDocument/documentSymbol", document_symbols},
                                {"textDocument/foldingRange", folding_ranges},
                                {"textDocument/hover", hover},
                                {"textDocument/definition", definition},
                                {"textDocument/references", references},
                                {"textDocument/prepareRename", prepare_rename},
                                {"textDocument/rename", rename},
                                {"textDocument/completion", completion},
                                {"textDocument/signatureHelp", signature_help},
                                {"textDocument/codeAction", code_actions},
                                {"textDocument/formatting", formatting},
                                {"textDocument/codeLens", code_lenses}};

struct Refusal {
    int code;
    std::string message;
};

Json capabilities(Encoding encoding) {
    constexpr int incremental = 2;
    return {{"positionEncoding", encoding == Encoding::utf8 ? "utf-8" : "utf-16"},
            {"textDocumentSync",
             {{"openClose", true}, {"change", incremental}, {"save", {{"includeText", false}}}}},
            {"documentSymbolProvider", true},
            {"documentFormattingProvider", true},
            {"foldingRangeProvider", true},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"referencesProvider", true},
            {"renameProvider", {{"prepareProvider", true}}},
            {"completionProvider", {{"triggerCharacters", {".", "#", ":", " "}}}},
            {"signatureHelpProvider", {{"triggerCharacters", {"(", ","}}}},
            {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
            {"codeLensProvider", {{"resolveProvider", false}}}};
}

bool is_id(const Json& id) {
    return id.is_string() || id.is_number_integer();
}

std::vector<std::string> folders_in(const Json& params) {
    std::vector<std::string> folders;
    if (params.contains("workspaceFolders") && params["workspaceFolders"].is_array())
        for (const Json& folder : params["workspaceFolders"])
            folders.push_back(path_of(folder.at("uri").get<std::string>()));
    else if (params.contains("rootUri") && params["rootUri"].is_string())
        folders.push_back(path_of(params["rootUri"].get<std::string>()));
    std::erase(folders, "");
    return folders;
}

}  // namespace

Server::Server(std::function<void(const Json&)> send) : session_{std::move(send)} {}

void Server::fail(const Json& id, int code, const std::string& message) {
    session_.send(
        {{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", message}}}});
}

void Server::receive(const std::string& text) {
    const Json message = Json::parse(text, nullptr, false);
    if (message.is_discarded()) return fail(nullptr, parse_error, "the message is no JSON");
    const bool has_id = message.is_object() && message.contains("id");
    const Json id = has_id && is_id(message["id"]) ? message["id"] : Json();
    if (message.is_object() && !message.contains("method") &&
        (message.contains("result") || message.contains("error")))
        return;  // an answer
    if (!message.is_object() || !message.contains("method") || !message["method"].is_string() ||
        (has_id && id.is_null()))
        return fail(id, invalid_request, "the message is no request");
    const std::string method = message["method"];
    const Json params = message.value("params", Json::object());
    try {
        if (!has_id) return notify(method, params);
        const Json result = answer(method, params);
        session_.send({{"jsonrpc", "2.0"}, {"id", id}, {"result", result}});
    } catch (const Refusal& refusal) {
        if (has_id) fail(id, refusal.code, refusal.message);
    } catch (const RefusedName& refused) {
        fail(id, invalid_params, refused.why);
    } catch (const Json::exception& error) {
        if (has_id) fail(id, invalid_params, error.what());
    }
}

Json Server::initialize(const Json& params) {
    if (phase_ != Phase::fresh) throw Refusal{invalid_request, "the server is initialized"};
    const Json client = params.value("capabilities", Json::object());
    const Json offered = client.value(Json::json_pointer("/general/positionEncodings"), Json());
    if (offered.is_array() && std::ranges::find(offered, Json("utf-8")) != offered.end())
        session_.encoding = Encoding::utf8;
    session_.takes_related_information = client.value(
        Json::json_pointer("/textDocument/publishDiagnostics/relatedInformation"), false);
    session_.project.set_folders(folders_in(params));
    phase_ = Phase::initialized;
    return {{"capabilities", capabilities(session_.encoding)},
            {"serverInfo", {{"name", "lineshaft"}, {"version", version()}}}};
}

Json Server::answer(const std::string& method, const Json& params) {
    if (method == "initialize") return initialize(params);
    if (phase_ == Phase::fresh)
        throw Refusal{server_not_initialized, "the first request is 'initialize'"};
    if (phase_ == Phase::shut_down)
        throw Refusal{invalid_request, "behind 'shutdown' comes 'exit' alone"};
    if (method == "shutdown") {
        phase_ = Phase::shut_down;
        return nullptr;
    }
    for (const Request& request : requests)
        if (request.method == method) return request.answer(session_, params);
    throw Refusal{method_not_found, fmt::format("there is no method '{}'", method)};
}

void Server::notify(const std::string& method, const Json& params) {
    if (method == "exit") ended_ = phase_ == Phase::shut_down ? 0 : 1;
    if (phase_ != Phase::initialized) return;
    if (method == "textDocument/didOpen") {
        const Document* opened = session_.documents.open(params.at("textDocument"));
        if (opened) diagnosis_.change(opened->path);
    } else if (method == "textDocument/didChange") {
        const Json& of = params.at("textDocument");
        const Document* changed =
            session_.documents.change(of.at("uri").get<std::string>(), of.value("version", Json()),
                                      params.at("contentChanges"), session_.encoding);
        if (changed) diagnosis_.change(changed->path);
    } else if (method == "textDocument/didClose") {
        const std::string path = path_of(params.at("textDocument").at("uri").get<std::string>());
        session_.documents.close(path);
        if (!path.empty()) diagnosis_.close(path);
    } else if (method == "textDocument/didSave" || method == "workspace/didChangeWatchedFiles") {
        session_.project.forget();
        for (const auto& [path, document] : session_.documents.all()) diagnosis_.change(path);
    }
}

}  // namespace lineshaft::lsp
