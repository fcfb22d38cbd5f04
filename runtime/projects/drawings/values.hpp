#pragma once

#include <initializer_list>
#include <string>

#include "runtime/projects/excerpts.hpp"

namespace lineshaft::projects {

/// An expression that a line of a network carries.
struct Value {
    /// What stands outermost in it, so that no more parentheses are written than are needed.
    enum class Form : std::uint8_t { atom, not_, and_, or_, other };

    Excerpts text;
    Form form = Form::atom;
    std::string type = {};   ///< empty: not known
    bool is_always = false;  ///< TRUE, as from a power rail

    bool is_empty() const { return text.is_empty(); }
};

/// `a` as an operand.
Excerpts enclosed(const Value& a, const Mark& place);
/// Either may be empty; what is always TRUE does nothing to an AND.
Value both(Value a, Value b, const Mark& place);
Value either(Value a, Value b, const Mark& place);
Value negated(const Value& a, const Mark& place);

Value words(std::string_view text, const Mark& place, std::string type = {});
/// TRUE, as from a power rail.
Value always(const Mark& place);

/// `IF condition THEN` and its end; nothing where that is empty or always TRUE.
void write_if(Excerpts& to, const Value& condition, const Mark& place);
void write_end_if(Excerpts& to, const Value& condition, const Mark& place);
/// `variable := value;`, and the variable.
Value kept_in(Excerpts& to, const std::string& variable, const Value& value, const Mark& place);

/// The function that a box does: `SUB` where a sign, `-`, is its name; else that name.
std::string function_of(std::string_view box);

/// An operator that stands between its operands; empty: a function.
std::string_view infix_of(std::string_view function);
bool compares(std::string_view function);

/// Whether it is one of these, whatever its capitals.
bool is_any(std::string_view name, std::initializer_list<std::string_view> of);

/// The shape of an expression that is written at an element.
Value::Form shape_of(std::string_view expression);

}  // namespace lineshaft::projects
