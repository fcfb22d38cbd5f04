#include <cstdio>

#include <unistd.h>

#include "runtime/st/code/native/native.hpp"
#include "tools/lineshaft/command.hpp"
#include "tools/lineshaft/lsp/server.hpp"

namespace lineshaft {

namespace {

Exit serve_editor() {
    st::switch_native_off();  // nothing runs here
    lsp::Server server([](const lsp::Json& message) {
        const std::string text = lsp::framed(message);
        std::fwrite(text.data(), 1, text.size(), stdout);
        std::fflush(stdout);
    });
    lsp::serve(
        STDIN_FILENO, [&](const std::string& message) { server.receive(message); },
        [&] { return server.work(); }, [&] { return server.ended().has_value() || is_unread(); });
    if (interrupt_requested) return Exit::interrupted;
    return server.ended() == 0 ? Exit::fine : Exit::failed;
}

}  // namespace

void add_lsp(CLI::App& app, Exit& result) {
    CLI::App* sub = app.add_subcommand(
        "lsp", "Serve an editor: the Language Server Protocol on the standard streams");
    sub->add_flag_callback(
        "--stdio", [] {}, "As it is anyway: some editors say so");
    sub->callback([&result] { result = serve_editor(); });
}

}  // namespace lineshaft
