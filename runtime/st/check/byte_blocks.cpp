#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

namespace {

/// What a function of the prelude takes as bytes, where its caller gives a variable of any type.
struct ByteBlocks {
    std::string_view function, read, written;
};
constexpr ByteBlocks functions_of_bytes[] = {{"Serialize", "SRC_VARIABLE", ""},
                                             {"Deserialize", "", "DEST_VARIABLE"},
                                             {"BLKMOV", "SRCBLK", "DSTBLK"},
                                             {"UBLKMOV", "SRCBLK", "DSTBLK"},
                                             {"FILL", "BVAL", "BLK"}};

/// Null: it takes its arguments as all others.
const ByteBlocks* find_blocks(const Routine& called) {
    if (!is_prelude(called.pou->name)) return nullptr;
    return find_called(functions_of_bytes, called.pou->name.text, &ByteBlocks::function);
}

/// A variable that nobody can name.
Variable& hidden(Checking& c, std::string_view role, const Type& type) {
    Routine& routine = *c.routine;
    const std::string name = fmt::format("%{}{}", role, routine.variables.size());
    Variable& made =
        c.make_variable(routine, routine.pou->name, c.checked.names.emplace_back(name), &type);
    made.section = Section::temp;
    return made;
}

bool is_hidden(const Expression& e) {
    return e.kind == E::name && e.variable && e.variable->text.starts_with('%');
}

const Type& bytes_type(Checking& c, std::uint64_t count) {
    Type& made = c.make_type(Kind::array, {});
    made.element = &bits_type(8);
    made.upper = static_cast<std::int64_t>(count) - 1;
    return made;
}

struct Seen {
    Block before, behind;  ///< the call
    Expression* bytes = nullptr;
};

/// A copy of `given` and its bytes, as an S7 has them; they go back to it where they are written.
/// Null, and told, where it has none.
std::optional<Seen> see_bytes(Checking& c, Expression* given, bool is_written) {
    const Type* type = check(c, given);
    if (!type) return {};
    const std::uint64_t bits = type->is_open ? 0 : packed_bits(*type, given->place.dialect());
    if (bits == 0) {
        c.fail(code::type_does_not_fit, given->place,
               fmt::format("{} is not seen as bytes", describe(*type)),
               "numbers, times, texts, and structures and arrays of such are");
        return {};
    }
    const Type& bytes = bytes_type(c, (bits + 7) / 8);
    Variable &whole = hidden(c, "whole", *type), &made = hidden(c, "bytes", bytes);
    const auto view = [&] {
        const Type& pointer = pointer_to(c, bytes);
        return make_target(c, *given, make_reference_to(c, make_use(c, *given, whole), pointer),
                           &bytes);
    };
    const auto assign = [&](Block& to, Expression* target, Expression* value) {
        to.push_back(make_assignment(c, given->place, target, value));
    };
    Seen seen;
    assign(seen.before, make_use(c, *given, whole), given);
    assign(seen.before, make_use(c, *given, made), view());
    seen.bytes = make_use(c, *given, made);
    if (!is_written) return seen;
    assign(seen.behind, view(), make_use(c, *given, made));
    assign(seen.behind, given, make_use(c, *given, whole));
    return seen;
}

}  // namespace

bool is_given_bytes(Checking& c, const Expression& call, const Routine& called) {
    const ByteBlocks* const blocks = find_blocks(called);
    if (!blocks || call.place.source->is_prelude()) return true;
    for (const std::string_view name : {blocks->read, blocks->written}) {
        const Argument* given = find_called(call.arguments, name, &Argument::name);
        if (name.empty() || (given && is_hidden(*given->value))) continue;
        if (!given && call.place.dialect().vendor != Vendor::siemens) {
            c.fail(code::not_declared, call.operands[0]->place,
                   fmt::format("'{}' is not declared", call.operands[0]->token.text),
                   fmt::format("add the source that declares it; SCL's is {}(..., {} := ...)",
                               blocks->function, name));
            return false;
        }
        c.fail(code::not_supported, call.operands[0]->place,
               fmt::format("{} stands in a statement of its own, or is assigned", blocks->function),
               fmt::format("name its arguments: {}(..., {} := ...)", blocks->function, name));
        return false;
    }
    return true;
}

bool rewrite_bytes(Checking& c, Statement*& s, const Routine& called) {
    const ByteBlocks* const blocks = find_blocks(called);
    if (!blocks) return false;
    Block before, behind;
    std::vector<Argument> arguments = s->value->arguments;
    for (Argument& argument : arguments) {
        const bool is_read = same_name(argument.name.text, blocks->read),
                   is_written = same_name(argument.name.text, blocks->written);
        if (!argument.is_named() || (!is_read && !is_written) || is_hidden(*argument.value))
            continue;
        const auto seen = see_bytes(c, argument.value, is_written);
        if (!seen) return true;
        argument.value = seen->bytes;
        before.insert(before.end(), seen->before.begin(), seen->before.end());
        behind.insert(behind.end(), seen->behind.begin(), seen->behind.end());
    }
    if (before.empty()) return false;
    before.push_back(make_with(c, *s, make_with(c, *s->value, std::move(arguments))));
    before.insert(before.end(), behind.begin(), behind.end());
    s = make_sequence(c, s->place, std::move(before));
    check(c, s);
    return true;
}

}  // namespace lineshaft::st
