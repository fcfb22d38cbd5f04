/// Any bytes as a program, a study, a fit or a controller: loaded or refused with messages that
/// have places.

#include <cstdio>
#include <cstdlib>

#include "blocks/catalog.hpp"
#include "runtime/fit/fit.hpp"
#include "runtime/run/link.hpp"
#include "runtime/study/study_reader.hpp"

using namespace lineshaft;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Catalog catalog = standard_blocks();
    const std::string text(reinterpret_cast<const char*>(data), size);
    const auto file = std::make_shared<const SourceFile>(SourceFile{"programs/fuzz.yaml", text});
    Diagnostics out;
    if (is_study(*file))
        read_study(file, {}, catalog, out);
    else if (is_fit(*file))
        read_fit(file, {}, catalog, out);
    else
        link(read_program(file, {}, out), catalog, out);
    const std::string messages = out.render();
    for (const Diagnostic& d : out.list()) {
        if (d.mark.file && d.mark.line > 0 && d.mark.column > 0 && !d.message.empty()) continue;
        std::fprintf(stderr, "no place:\n%s", messages.c_str());
        std::abort();
    }
    return 0;
}
