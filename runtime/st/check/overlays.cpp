#include "runtime/st/check/image.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

namespace {

/// What `at` names: a variable of the routine, or what that is a view of.
Variable* seen_variable(Checking& c, const Routine& routine, const Variable& overlay,
                        const Token& at) {
    Variable* seen = find_in(routine.names, at.text);
    if (!seen) {
        std::vector<std::string> names;
        for (const auto& [name, variable] : routine.names) names.emplace_back(name);
        return c.fail(code::not_declared, at.place,
                      fmt::format("'{}' is not declared here", at.text), suggest(at.text, names));
    }
    if (seen->space == Space::overlay) seen = seen->seen;
    const bool has_bytes = seen && seen != &overlay &&
                           (seen->space == Space::frame || seen->space == Space::reference);
    if (has_bytes) return seen;
    return c.fail(code::wrong_place, at.place, fmt::format("'{}' has no bytes of its own", at.text),
                  "an overlay is a view of a variable that is declared before it");
}

/// The view ends within what it is a view of.
bool fits(Checking& c, const Variable& overlay, const Variable& seen, const Token& at) {
    const Dialect& dialect = at.place.dialect();
    for (const Variable* variable : {&overlay, &seen}) {
        if (!variable->type) return false;
        if (!variable->type->is_open && packed_bits(*variable->type, dialect) > 0) continue;
        return c.fail(code::type_does_not_fit, at.place,
                      fmt::format("'{}' is {}, which is not seen as bytes", variable->text,
                                  describe(*variable->type)),
                      "numbers, times, texts, and structures and arrays of such are");
    }
    const bool are_flags = overlay.type->kind == Kind::array && !overlay.type->has_inner &&
                           overlay.type->element->kind == Kind::boolean;
    const std::uint64_t bits =
                            are_flags ? overlay.type->count() : packed_bits(*overlay.type, dialect),
                        room = packed_bits(*seen.type, dialect);
    if (bits <= room) return true;
    return c.fail(code::value_out_of_range, at.place,
                  fmt::format("'{}' has {} bytes, and '{}' {}", overlay.text, (bits + 7) / 8,
                              seen.text, (room + 7) / 8),
                  "an overlay is not longer than what it is a view of");
}

bool is_overlay(const Declaration& declared) {
    return declared.at.word != Word::direct && declared.at.word != Word::end_of_file;
}

void declare_overlay(Checking& c, Routine& routine, const Declaration& declared) {
    Variable* declared_as = find_in(routine.names, declared.name.text);
    if (!declared_as) return;
    Variable& overlay = *declared_as;
    overlay.used = true;
    overlay.space = Space::overlay;
    overlay.section = Section::local;  // no call gives it
    Variable* seen = seen_variable(c, routine, overlay, declared.at);
    if (seen && fits(c, overlay, *seen, declared.at)) {
        overlay.seen = seen;
        seen->used = true;
    } else {
        overlay.type = nullptr;
    }
    if (declared.initial)
        c.fail(code::wrong_place, declared.name.place, "an overlay has no initial value",
               fmt::format("give one to '{}'", declared.at.text));
    overlay.initial = nullptr;
}

}  // namespace

void declare_overlays(Checking& c, Routine& routine) {
    for (const DeclarationBlock& block : routine.pou->blocks)
        for (const Declaration* declared : block.declarations)
            if (is_overlay(*declared)) declare_overlay(c, routine, *declared);
}

void refuse_overlay(Checking& c, const Declaration& declared) {
    if (!is_overlay(declared)) return;
    c.fail(code::wrong_place, declared.at.place, "a second view of a variable is not declared here",
           "declare both in a block or a function, or a UNION");
}

const Type* use_overlay(Checking& c, Expression*& e, const Variable& overlay) {
    if (!overlay.type || !overlay.seen) return nullptr;
    Expression* seen = make_copy(c, *e);
    seen->variable = overlay.seen;
    seen->type = overlay.seen->type;
    Expression* view = make_reference_to(c, seen, pointer_to(c, *overlay.type));
    e = make_target(c, *seen, view, overlay.type);
    return e->type;
}

}  // namespace lineshaft::st
