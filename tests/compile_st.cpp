#include <cstdio>

#include "blocks/catalog.hpp"
#include "runtime/source/yaml.hpp"
#include "runtime/st/library/library.hpp"

/// Compiles Structured Text and prints what is wrong. Exit code 2 for an error.
int main(int count, char** arguments) {
    using namespace lineshaft;
    Diagnostics out;
    std::vector<std::shared_ptr<const SourceFile>> sources;
    for (int i = 1; i < count; ++i)
        if (auto source = read_source(arguments[i], out)) sources.push_back(std::move(source));
    if (out.empty()) st::compile(sources, standard_blocks(), out);
    std::fputs(out.render().c_str(), stderr);
    return out.empty() ? 0 : 2;
}
