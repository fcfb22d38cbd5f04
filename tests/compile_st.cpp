#include <cstdio>

#include "blocks/catalog.hpp"
#include "runtime/program/program.hpp"
#include "runtime/st/library/library.hpp"

/// Compiles Structured Text and prints what is wrong. Exit code 2 for an error.
int main(int count, char** arguments) {
    using namespace lineshaft;
    Diagnostics out;
    projects::Project all;
    for (int i = 1; i < count; ++i)
        for (auto& source : read_project(arguments[i], {}, out).sources) all.add(source);
    if (out.empty()) st::compile(all.sources, standard_blocks(), out);
    std::fputs(out.render().c_str(), stderr);
    return out.empty() ? 0 : 2;
}
