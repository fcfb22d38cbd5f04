#include "runtime/st/check/variants.hpp"

#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/names.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/check/types.hpp"

namespace lineshaft::st {

namespace {

constexpr std::string_view type_number = "type_number", element_number = "element_number";

/// 1 of the first type that was asked for. All texts of a kind are of one type.
std::int64_t number_of(Checking& c, const Type& type) {
    const Type& plain = type.plain();
    const Type& one = plain.kind != Kind::text ? plain
                      : plain.is_wide          ? wide_string_type
                                               : string_type;
    auto& known = c.types_of_variants;
    const auto is_it = [&](const Type* other) { return same_type(*other, one); };
    auto found = std::ranges::find_if(known, is_it);
    if (found == known.end()) found = known.insert(known.end(), &one);
    return found - known.begin() + 1;
}

/// What is given, part by part.
struct Given {
    std::int64_t type = 0, element = 0, size = 0;
    Expression *place = nullptr, *count = nullptr;
    bool is_bool = false;
};

Given given_open_array(Checking& c, Expression* value, const Type& type) {
    const auto bounds = bounds_of_array(c, value);
    if (!bounds) {
        c.fail(code::not_supported, value->place,
               "an ARRAY[*] of several dimensions is not given as a VARIANT");
        return {};
    }
    const Type& element = *type.element;
    Expression* first = make(c, E::index, *value);
    first->operands[0] = value;
    first->arguments.push_back({.value = bounds->lower});
    const auto sign = [&](Word op, Expression* a, Expression* b) {
        return make_binary(c, value->place, value->place, op, a, b);
    };
    Expression* one = make_constant(c, *value, lint_type, {.integer = 1});
    Expression* count = sign(Word::plus, sign(Word::minus, bounds->upper, bounds->lower), one);
    check(c, count);
    return {.type = number_of(c, element),
            .element = number_of(c, element),
            .size = static_cast<std::int64_t>(bytes_of(element)),
            .place = make_call(c, "__SYSTEM.ADR", first),
            .count = make_converted(c, count, dint_type),
            .is_bool = element.kind == Kind::boolean};
}

Given given_as_variant(Checking& c, Expression* value) {
    const Type* type = check(c, value);
    if (!type) return {};
    if (type->is_open_array()) return given_open_array(c, value, *type);
    if (type->is_instance()) {
        c.fail(code::type_does_not_fit, value->place, "a VARIANT is to no instance",
               "give a variable of it");
        return {};
    }
    const bool is_array = type->kind == Kind::array;
    const auto bytes = static_cast<std::int64_t>(bytes_of(*type));
    std::int64_t count = 0;
    for (const Type* each = type; each->kind == Kind::array; each = each->element) {
        const auto one = static_cast<std::int64_t>(each->count());
        count = count == 0 ? one : count * one;
        if (!each->has_inner) break;
    }
    return {.type = number_of(c, *type),
            .element = is_array ? number_of(c, type->innermost()) : 0,
            .size = is_array && count > 0 ? bytes / count : bytes,
            .place = make_call(c, "__SYSTEM.ADR", value),
            .count = make_dint(c, *value, count),
            .is_bool = (is_array ? type->innermost() : *type).kind == Kind::boolean};
}

bool is_called(const Expression& e, std::string_view name) {
    return e.kind == E::call && e.operands[0]->kind == E::name &&
           same_name(e.operands[0]->token.text, name);
}

bool asks_type(const Expression& e) {
    return e.place.dialect().has_s7_instructions && e.arguments.size() == 1 &&
           (is_called(e, "TypeOf") || is_called(e, "TypeOfElements"));
}

/// A type's name becomes its number; all else stays.
void take_type_name(Checking& c, Expression*& e) {
    if (!e || e->kind != E::name || e->type) return;
    if (!e->token.quoted && find_variable(c, e->token)) return;
    if (const Type* type = resolve_name(c, e->token)) e = make_dint(c, *e, number_of(c, *type));
}

}  // namespace

bool is_variant(const Type& type) {
    return type.kind == Kind::structure && same_name(type.name, "VARIANT") &&
           std::ranges::any_of(type.members, is_prelude, &Variable::name);
}

void become_variant(Checking& c, Expression*& value, const Type& type) {
    const bool is_null = value->kind == E::name && same_name(value->token.text, "NULL");
    const Type* given = is_null ? nullptr : check(c, value);
    if (given && is_variant(*given)) {
        value = make_copy(c, *value);
        value->type = &type;
        return;
    }
    if (!given && !is_null) return;
    const Given parts = is_null ? Given{.place = value, .count = make_dint(c, *value, 0)}
                                : given_as_variant(c, value);
    if (!parts.place) return;
    Expression* made = make_call(c, *value, make_function_name(c, *value, "variant_of"),
                                 {{.value = make_dint(c, *value, parts.type)},
                                  {.value = make_dint(c, *value, parts.element)},
                                  {.value = parts.place},
                                  {.value = make_dint(c, *value, parts.size)},
                                  {.value = parts.count},
                                  {.value = make_boolean(c, *value, parts.is_bool)}});
    if (!check(c, made)) return;
    value = make_copy(c, *made);
    value->type = &type;
}

std::optional<const Type*> check_variant_call(Checking& c, Expression*& e) {
    if (!e->place.dialect().has_s7_instructions || e->arguments.size() != 1) return {};
    const bool of_elements = is_called(*e, "TypeOfElements");
    const bool is_array = is_called(*e, "IS_ARRAY"), counts = is_called(*e, "CountOfElements");
    if (!asks_type(*e) && !is_array && !counts) return {};
    Expression* of = e->arguments[0].value;
    const Type* type = check(c, of);
    if (!type) return nullptr;
    const auto member = [&](std::string_view name) { return make_member(c, of, name); };
    if (is_variant(*type)) {
        Expression* made = member(of_elements || is_array ? element_number
                                  : counts                ? "count"
                                                          : type_number);
        if (is_array)
            made = make_binary(c, e->place, e->place, Word::unequal, made, make_dint(c, *e, 0));
        if (counts)
            made = make_call(c, *e, make_function_name(c, *e, "count_of_variant"), {{.value = of}});
        e = made;
        return check(c, e);
    }
    if (counts) return {};
    const bool is_one = type->kind == Kind::array || type->is_open_array();
    if (is_array) {
        e = make_boolean(c, *e, is_one);
        return check(c, e);
    }
    const Type& asked = of_elements && type->kind == Kind::array ? type->innermost()
                        : of_elements && is_one                  ? *type->element
                                                                 : *type;
    e = make_dint(c, *e, number_of(c, asked));
    return check(c, e);
}

void take_type_names(Checking& c, Expression& comparison) {
    Expression *&left = comparison.operands[0], *&right = comparison.operands[1];
    if (asks_type(*left)) take_type_name(c, right);
    if (asks_type(*right)) take_type_name(c, left);
}

void take_null_variant(Checking& c, Expression& comparison) {
    Expression *&left = comparison.operands[0], *&right = comparison.operands[1];
    const auto take = [&](Expression*& of, Expression*& null) {
        if (!is_variant(*of->type) || null->type != &null_type) return;
        of = make_member(c, of, type_number);
        check(c, of);
        null = make_dint(c, *null, 0);
    };
    take(left, right);
    take(right, left);
}

void take_type_names(Checking& c, Statement& selection) {
    if (!asks_type(*selection.value)) return;
    for (Branch& branch : selection.branches)
        for (auto& label : branch.labels) take_type_name(c, label.first);
}

}  // namespace lineshaft::st
