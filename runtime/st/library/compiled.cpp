#include "runtime/st/library/compiled.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "runtime/st/code/native/native.hpp"
#include "runtime/st/library/binary_libraries.hpp"
#include "runtime/st/library/coverage.hpp"
#include "runtime/st/library/library_names.hpp"
#include "runtime/st/prelude/standard_source.hpp"
#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

Compiled::~Compiled() {
    if (generated.code.hits) record(generated.code);
}

namespace {

/// What the sources say, with those of the standard that they name.
void parse_all(Compiled& to, const Catalog& standard, Diagnostics& out, const SourceFile* tests) {
    bool uses_standard = false;
    std::set<const BlockType*> used;
    LibraryNames libraries(standard, to.libraries, !to.missing_libraries.empty());
    for (const auto& source : to.sources) {
        Diagnostics own, follows;
        for (const Diagnostic& mistake : source->mistakes) {
            own.add(mistake);
            out.add(mistake);
        }
        Diagnostics& told = own.empty() ? out : follows;  // what could not be read is left out
        const bool is_tests = source.get() == tests;
        Tokens tokens =
            read_tokens(source, told, is_tests ? SourceKind::tests : SourceKind::program);
        uses_standard = uses_standard || uses_standard_source(tokens);
        libraries.note_libraries(tokens);
        for (const BlockType& type : standard.types())
            if (uses_source_of(type, tokens)) used.insert(&type);
        parse(std::move(tokens), to.tree, told);
    }
    to.tree.leave_lost_out();
    join_declared_apart(to.tree);
    give_actions_to_blocks(to.tree);
    tell_types_by_capitals(to.tree);
    expand_generics(to.tree);
    leave_out_declared(to.tree, standard);
    warn_of_declared(to.tree, out);
    libraries.add_files(to.tree, out);
    if (uses_standard || libraries.use_standard_source())
        parse(read_tokens(standard_source(), out, SourceKind::prelude), to.tree, out);
    for (const BlockType& type : standard.types())
        if (used.contains(&type))
            parse(read_tokens(source_of(type), out, SourceKind::prelude), to.tree, out);
}

}  // namespace

std::vector<NameUse> understand(Compiled& to, const Catalog& standard, const SourceFile* tests) {
    Diagnostics untold;
    std::vector<NameUse> uses;
    parse_all(to, standard, untold, tests);
    to.checked = check(to.tree, standard, evaluate, untold, to.missing_libraries, &uses);
    return uses;
}

bool compile(Compiled& to, const Catalog& standard, Diagnostics& out, CodeOptions options,
             const SourceFile* tests) {
    parse_all(to, standard, out, tests);
    to.checked = check(to.tree, standard, evaluate, out, to.missing_libraries);
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

void make_native(Code& code, const Options& options) {
    code.times = options.times;
    if (options.native && !code.times) code.native = native_code(code);
}

Place place_of_user(const Code& code, const std::byte* root, const EndOfScan& end, Place at) {
    const std::byte* calls = root + 8 * std::size_t{code.calls_slot()};
    for (std::uint32_t depth = end.depth; !at.source->is_users() && depth > 0;)
        at = code.places[read<std::uint64_t>(calls + 16 * std::size_t{--depth}) - 1];
    return at;
}

FaultPlace fault_of(const Code& code, const std::byte* instance) {
    const auto slot = [&](std::uint32_t number) {
        return read<std::uint64_t>(instance + 8 * std::size_t{number});
    };
    const auto place = [&](std::uint64_t instruction) { return code.places[instruction].mark(); };
    const auto routine = [&](std::uint64_t instruction) -> const std::string& {
        return std::ranges::upper_bound(code.routines, instruction, {}, &CodeRoutine::end)->name;
    };
    FaultPlace found;
    found.fault = static_cast<Fault>(slot(error_id_slot));
    if (found.fault == Fault::none) return found;
    if (code.has_references && slot(code.left_slot()) > 0)
        found.left = code.pieces[slot(code.left_slot()) - 1].name;
    const EndOfScan end = EndOfScan::of(slot(place_slot), slot(depth_slot));
    std::uint64_t at = end.instruction;
    found.mark = place_of_user(code, instance, end, code.places[at]).mark();
    const std::uint32_t stack = code.calls_slot();
    const std::uint64_t depth = end.depth;
    constexpr std::uint64_t most_told = 20;  // the first ones and the last one
    for (std::uint64_t level = depth;; --level) {
        found.calls.push_back(fmt::format("{} (line {})", routine(at), place(at).line));
        if (level == 0) return found;
        if (depth - level + 2 == most_told && level > 2) {
            found.calls.push_back(fmt::format("{} more", level - 1));
            level = 1;
        }
        at = slot(stack + 2 * static_cast<std::uint32_t>(level - 1)) - 1;
    }
}

std::optional<Mark> cut_of(const Code& code, const std::byte* instance) {
    const auto behind = read<std::uint64_t>(instance + 8 * std::size_t{cut_slot});
    return behind == 0 ? std::nullopt : std::optional(code.places[behind - 1].mark());
}

}  // namespace lineshaft::st
