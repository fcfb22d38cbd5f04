#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

/// A number that no value has, which CODESYS lets a variable have.
bool take_nameless(Checking& c, Expression*& e, const Type& to) {
    const Wide number = e->constant.integer;
    const std::string message = fmt::format("no value of {} is {}", to.name, to_string(number));
    if (number < smallest(to.base->plain()) || number > largest(to.base->plain())) {
        c.fail(code::value_out_of_range, e->place, message,
               fmt::format("its variables are of {}", to.base->name));
        return become(c, e, to, to.initial);
    }
    c.warn(code::value_out_of_range, e->place, message + ", and it is kept all the same",
           "declare a value for it");
    return become(c, e, to, {.integer = number});
}

}  // namespace

std::string first_value(const Checking& c, const Type& type) {
    const std::string& value = type.values.front();
    const bool is_of_pin = c.catalog.find(type.name.substr(0, type.name.find('.'))) != nullptr;
    return is_of_pin ? value : fmt::format("{}#{}", type.name, value);
}

bool has_table_for(const Type& type) {
    constexpr std::int64_t most_numbers = 4096;
    const auto [least, most] = std::ranges::minmax(type.numbers);
    return Wide{most} - least < most_numbers;
}

bool coerce_number(Checking& c, Expression*& e, const Type& to) {
    if (!is_constant(*e)) return convert(c, e, to);
    const Wide number = e->constant.integer;
    const bool exists = number >= 0 && number < static_cast<Wide>(to.of_number.size());
    const std::int64_t value = exists ? to.of_number[static_cast<std::size_t>(number)]
                               : to.all_others_as_last ? to.of_number.back()
                                                       : -1;
    if (value < 0)
        return c.fail(code::value_out_of_range, e->place,
                      fmt::format("{} has nothing for the number {}", to.name, to_string(number)),
                      fmt::format("write one of its values, such as {}", first_value(c, to)));
    return become(c, e, to, {.integer = value});
}

/// 65535 of an enumeration is -1 of an INT in CODESYS, which is told.
static bool has_bits_of(Checking& c, Expression*& e, const Type& to) {
    const bool is_taken = is_constant(*e) && !e->type->is_strict && to.kind == Kind::integer &&
                          to.is_signed && e->place.dialect().is_loose &&
                          e->constant.integer > largest(to) &&
                          e->constant.integer < Wide{1} << to.bits;
    if (!is_taken) return false;
    e = make_constant(c, *e, any_integer_type, e->constant);
    return coerce(c, e, to);
}

bool coerce_enumeration(Checking& c, Expression*& e, const Type& to) {
    const Type& from = *e->type;
    if (from.has_numbers && (to.kind == Kind::integer || to.kind == Kind::bits)) {
        const auto holds = [&](std::int64_t number) {
            return number >= smallest(to) && number <= largest(to);
        };
        const bool fits = is_constant(*e) ? e->constant.integer >= smallest(to) &&
                                                e->constant.integer <= largest(to)
                                          : std::ranges::all_of(from.numbers, holds);
        if (fits) convert(c, e, to);
        return fits || has_bits_of(c, e, to);
    }
    const bool is_other = from.has_numbers && from.name != to.name;
    const bool has_number = is_other || from.kind == Kind::bits;
    const bool are_numbers = e->place.dialect().enumerations_are_numbers && !to.is_strict;
    if (has_number && to.has_numbers && are_numbers) {
        Expression* number = e;
        convert(c, number, lint_type);
        if (!coerce_enumeration(c, number, to)) return false;
        e = number;
        return true;
    }
    const bool counts = e->place.dialect().enumerations_are_numbers && !from.is_strict;
    if (from.has_numbers && to.kind == Kind::real && counts) {
        enumeration_becomes_number(c, e);
        return coerce(c, e, to);
    }
    if (!to.has_numbers || !from.is_integer()) return false;
    if (!is_constant(*e))
        return are_numbers && (to.is_unchecked || has_table_for(to)) && convert(c, e, to);
    if (!to.name_of(e->constant.integer)) return are_numbers && take_nameless(c, e, to);
    return become(c, e, to, {.integer = e->constant.integer});
}

}  // namespace lineshaft::st
