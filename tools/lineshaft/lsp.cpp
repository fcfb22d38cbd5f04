#include <unistd.h>

#include "runtime/messages/messages.hpp"
#include "runtime/st/code/native/native.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/lsp/server.hpp"

namespace lineshaft {

namespace {

Exit serve_editor() {
    st::switch_native_off();  // nothing runs here
    Messages messages(STDIN_FILENO, STDOUT_FILENO);
    lsp::Server server([&](const Json& message) { messages.send(message); });
    const auto is_ended = [&] { return server.ended().has_value() || is_unread(); };
    while (!is_ended()) {
        if (!messages.waits() && server.work()) continue;
        const auto message = messages.next();
        if (!message) break;
        server.receive(*message);
    }
    while (!interrupt_requested && !is_ended() && server.work()) continue;
    if (interrupt_requested) return Exit::interrupted;
    return server.ended() == 0 ? Exit::fine : Exit::failed;
}

}  // namespace

void add_lsp(CLI::App& app, Exit& result) {
    CLI::App* sub = app.add_subcommand(
        "lsp", "Serve an editor: the Language Server Protocol on the standard streams");
    sub->add_flag_callback(
        "--stdio", [] {}, "As it is anyway: some editors say so");
    add_dialect(*sub);
    sub->callback([&result] { result = serve_editor(); });
}

}  // namespace lineshaft
