#include "runtime/st/compiled.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "runtime/st/coverage.hpp"
#include "runtime/st/parser.hpp"
#include "runtime/st/standard_source.hpp"

namespace lineshaft::st {

Compiled::~Compiled() {
    if (generated.code.hits) record(generated.code);
}

namespace {

/// What the sources do not declare themselves.
void add_standard(const std::shared_ptr<const SourceFile>& source, Tree& tree, Diagnostics& out) {
    NameSet own;
    for (const Pou* unit : tree.units) own.insert(unit->name.text);
    for (const TypeDeclaration& type : tree.types) own.insert(type.name.text);
    const auto units = static_cast<std::ptrdiff_t>(tree.units.size());
    const auto types = static_cast<std::ptrdiff_t>(tree.types.size());
    parse(read_tokens(source, out), tree, out);
    const auto is_own_unit = [&](const Pou* unit) { return own.contains(unit->name.text); };
    const auto is_own_type = [&](const TypeDeclaration& t) { return own.contains(t.name.text); };
    tree.units.erase(std::remove_if(tree.units.begin() + units, tree.units.end(), is_own_unit),
                     tree.units.end());
    tree.types.erase(std::remove_if(tree.types.begin() + types, tree.types.end(), is_own_type),
                     tree.types.end());
}

}  // namespace

bool compile(Compiled& to, const Catalog& standard, Diagnostics& out, CodeOptions options,
             const SourceFile* tests) {
    bool uses_standard = false;
    std::set<const BlockType*> used;
    for (const auto& source : to.sources) {
        Tokens tokens = read_tokens(source, out);
        uses_standard = uses_standard || uses_standard_source(tokens);
        for (const BlockType& type : standard.types())
            if (uses_source_of(type, tokens)) used.insert(&type);
        parse(std::move(tokens), to.tree, out, source.get() == tests);
    }
    if (!out.empty()) return false;
    if (uses_standard) add_standard(standard_source(), to.tree, out);
    for (const BlockType& type : standard.types())
        if (used.contains(&type))
            add_standard(to.of_standard.emplace_back(source_of(type)), to.tree, out);
    to.checked = check(to.tree, standard, out);
    if (!out.empty()) return false;
    options.covered = is_covered();
    to.generated = generate(to.checked, out, options);
    if (!out.empty()) return false;
    const std::string wrong = verify(to.generated.code);
    if (!wrong.empty()) throw std::logic_error("Structured Text was compiled wrong: " + wrong);
    Code& code = to.generated.code;
    if (is_covered())
        code.hits = std::make_unique<std::atomic<std::uint64_t>[]>(code.points.size());
    return true;
}

FaultPlace fault_of(const Code& code, const std::byte* instance) {
    const auto slot = [&](std::uint32_t number) {
        std::uint64_t value = 0;
        std::memcpy(&value, instance + 8 * std::size_t{number}, sizeof value);
        return value;
    };
    const auto place = [&](std::uint64_t instruction) { return code.places[instruction].mark(); };
    const auto routine = [&](std::uint64_t instruction) -> const std::string& {
        std::size_t i = 0;
        while (code.routines[i].end <= instruction) ++i;
        return code.routines[i].name;
    };
    FaultPlace found;
    found.fault = static_cast<Fault>(slot(error_id_slot));
    if (found.fault == Fault::none) return found;
    std::uint64_t at = slot(place_slot);
    found.mark = place(at);
    const std::uint32_t stack = globals_slot + code.globals;
    for (std::uint64_t level = slot(depth_slot);; --level) {
        found.calls.push_back(fmt::format("{} (line {})", routine(at), place(at).line));
        if (level == 0) return found;
        at = slot(stack + 2 * static_cast<std::uint32_t>(level - 1)) - 1;
    }
}

}  // namespace lineshaft::st
