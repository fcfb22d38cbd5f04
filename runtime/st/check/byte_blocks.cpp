#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/references.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/variants.hpp"
#include "runtime/st/types/packed.hpp"

namespace lineshaft::st {

namespace {

/// What a function of the prelude takes as bytes, where its caller gives a variable of any type.
struct ByteBlocks {
    std::string_view function, read, written;
    std::string_view of_variant = {};  ///< what takes a VARIANT instead

    std::string_view variable() const { return read.empty() ? written : read; }
};
constexpr ByteBlocks functions_of_bytes[] = {
    {"Serialize", "SRC_VARIABLE", "", "serialize_variant"},
    {"Deserialize", "", "DEST_VARIABLE", "deserialize_variant"},
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

/// A structure of it alone, which has two bytes, as an array of one byte has them.
const Type& in_a_word(Checking& c, const Type& byte) {
    Type& made = c.make_type(Kind::structure, {});
    made.members.push_back(&c.make_variable({}, "there", &byte));
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
    const bool is_byte = bits <= 8;
    Variable &kept = hidden(c, "whole", is_byte ? in_a_word(c, *type) : *type),
             &made = hidden(c, "bytes", bytes);
    const auto whole = [&] {
        Expression* value = make_use(c, *given, kept);
        return is_byte ? make_member(c, value, "there") : value;
    };
    const auto view = [&] {
        const Type& pointer = pointer_to(c, bytes);
        return make_target(c, *given, make_reference_to(c, make_use(c, *given, kept), pointer),
                           &bytes);
    };
    const auto assign = [&](Block& to, Expression* target, Expression* value) {
        to.push_back(make_assignment(c, given->place, target, value));
    };
    Seen seen;
    assign(seen.before, whole(), given);
    assign(seen.before, make_use(c, *given, made), view());
    seen.bytes = make_use(c, *given, made);
    if (!is_written) return seen;
    assign(seen.behind, view(), make_use(c, *given, made));
    assign(seen.behind, given, whole());
    return seen;
}

/// Else it is told what it has not.
bool has_all(const Routine& called, const std::vector<Argument>& arguments) {
    return std::ranges::all_of(arguments, [&](const Argument& one) {
        return !one.is_named() || find_in(called.names, one.name.text);
    });
}

bool can_be_bytes(const Type& type) {
    return !type.is_open && type.kind != Kind::text && packed_bits(type, scl) > 0;
}

/// `IF variable.type_number = number THEN result := call; END_IF`, of what the variable is to.
Statement* bytes_of_variant(Checking& c, const Expression& like, const ByteBlocks& blocks,
                            const Type& type, std::int64_t number) {
    Routine& routine = *like.routine;
    Expression *whole = nullptr, *is_it = nullptr;
    std::vector<Argument> arguments = like.arguments;
    for (Argument& argument : arguments) {
        argument.value = make_use(c, like, *find_in(routine.names, argument.name.text));
        if (!same_name(argument.name.text, blocks.variable())) continue;
        Expression* place = make_member(c, argument.value, "place");
        check(c, place);
        whole = make_target(c, like, make_converted(c, place, pointer_to(c, type)), &type);
        is_it =
            make_binary(c, like.place, like.place, Word::equal,
                        make_member(c, argument.value, "type_number"), make_dint(c, like, number));
        argument.value = whole;
    }
    Expression* call = make_call(c, like, make_function_name(c, *like.operands[0], blocks.function),
                                 std::move(arguments));
    Expression* result = make_use(c, like, *routine.result);
    return make_if(c, like.place, is_it, {make_assignment(c, like.place, result, call)}, {});
}

}  // namespace

bool take_as_variant(Checking& c, Expression*& e, const Routine& called) {
    const ByteBlocks* const blocks = find_blocks(called);
    const bool has_instructions = e->place.dialect().has_s7_instructions;
    if (!blocks || blocks->of_variant.empty() || e->place.source->is_prelude() || !has_instructions)
        return false;
    if (!has_all(called, e->arguments)) return false;
    Argument* given = find_called(e->arguments, blocks->variable(), &Argument::name);
    if (!given || is_hidden(*given->value)) return false;
    const Type* type = check(c, given->value);
    if (!type || !(is_variant(*type) || can_be_bytes(*type))) return false;
    e = make_call(c, *e, make_function_name(c, *e->operands[0], blocks->of_variant), e->arguments);
    c.serializations.push_back(e);
    return true;
}

void write_serializations(Checking& c) {
    for (const ByteBlocks& blocks : functions_of_bytes) {
        const auto is_of = [&](const Expression* call) {
            return call->routine && same_name(call->routine->name, blocks.of_variant);
        };
        const auto call = std::ranges::find_if(c.serializations, is_of);
        if (call == c.serializations.end()) continue;
        const Expression& like = **call;
        c.routine = like.routine;
        for (std::size_t i = 0; i < c.types_of_variants.size(); ++i) {
            const Type& type = *c.types_of_variants[i];
            if (!can_be_bytes(type)) continue;
            const auto number = static_cast<std::int64_t>(i) + 1;
            c.routine->body.push_back(bytes_of_variant(c, like, blocks, type, number));
            check(c, c.routine->body.back());
        }
    }
    c.routine = nullptr;
}

bool is_given_bytes(Checking& c, const Expression& call, const Routine& called) {
    const ByteBlocks* const blocks = find_blocks(called);
    const bool has_instructions = call.place.dialect().has_s7_instructions;
    if (!blocks || call.place.source->is_prelude()) return true;
    if (has_instructions && !has_all(called, call.arguments)) return true;
    for (const std::string_view name : {blocks->read, blocks->written}) {
        const Argument* given = find_called(call.arguments, name, &Argument::name);
        if (name.empty() || (given && is_hidden(*given->value))) continue;
        if (!given && !has_instructions) {
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
        if (const Type* type = check(c, argument.value); type && is_variant(*type)) return false;
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
