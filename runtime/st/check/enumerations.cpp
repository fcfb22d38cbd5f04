#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

/// Conversions have a table of the numbers between its least and its most.
bool has_table_for(const Type& type, std::int64_t number) {
    constexpr std::int64_t most_numbers = 4096;
    const auto [least, most] = std::ranges::minmax(type.numbers);
    return std::max(most, number) - std::min(least, number) < most_numbers;
}

/// A value more of an enumeration, which is called by its number.
void add_value(Checking& c, const Type& to, std::int64_t number) {
    const auto type = std::ranges::find_if(c.checked.types, [&](Type& t) { return &t == &to; });
    if (type == c.checked.types.end()) return;
    type->counted = false;
    type->values.push_back(to_string(number));
    type->numbers.push_back(number);
}

/// A number that no value has, which CODESYS lets a variable have: one more where something begins
/// with it, and elsewhere a fault where it is reached.
bool convert_to_none(Checking& c, Expression*& e, const Type& to) {
    const std::string number = to_string(e->constant.integer);
    const std::string message = fmt::format("no value of {} is {}", to.name, number);
    const auto value = static_cast<std::int64_t>(e->constant.integer);
    const bool is_beginning = c.beginning.variable || !c.routine;
    if (is_beginning && has_table_for(to, value)) add_value(c, to, value);
    const auto it = std::ranges::find(to.numbers, value);
    if (it != to.numbers.end()) {
        c.warn(code::value_out_of_range, e->place, message + ", and it is kept all the same",
               "declare a value for it");
        return become(c, e, to, {.integer = it - to.numbers.begin()});
    }
    if (is_beginning) {
        c.fail(code::value_out_of_range, e->place, message,
               "declare a value for it, or the variable as an INT");
        return become(c, e, to, {});
    }
    c.warn(code::value_out_of_range, e->place,
           message + ", and a fault comes where that is assigned", "declare a value for it");
    e = make_converted(c, e, to);
    return true;
}

}  // namespace

std::string first_value(const Checking& c, const Type& type) {
    const std::string& value = type.values.front();
    const bool is_of_pin = c.catalog.find(type.name.substr(0, type.name.find('.'))) != nullptr;
    return is_of_pin ? value : fmt::format("{}#{}", type.name, value);
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

bool coerce_enumeration(Checking& c, Expression*& e, const Type& to) {
    const Type& from = *e->type;
    if (from.has_numbers && (to.kind == Kind::integer || to.kind == Kind::bits)) {
        const auto holds = [&](std::int64_t number) {
            return number >= smallest(to) && number <= largest(to);
        };
        const bool fits = is_constant(*e)
                              ? holds(from.numbers[static_cast<std::size_t>(e->constant.integer)])
                              : std::ranges::all_of(from.numbers, holds);
        if (fits) convert(c, e, to);
        return fits;
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
    if (!is_constant(*e)) {
        const bool fits = are_numbers && has_table_for(to, to.numbers.front());
        if (fits) convert(c, e, to);
        return fits;
    }
    const auto it = std::ranges::find(to.numbers, e->constant.integer);
    if (it == to.numbers.end()) return are_numbers && convert_to_none(c, e, to);
    return become(c, e, to, {.integer = it - to.numbers.begin()});
}

}  // namespace lineshaft::st
