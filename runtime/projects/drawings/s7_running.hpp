#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/projects/drawings/s7_instructions.hpp"

namespace lineshaft::projects::s7 {

/// What stands in the parentheses of a call.
struct Argument {
    std::string pin = {};  ///< empty: by its position
    Value value = {};      ///< empty: it is left out
    bool is_output = false;
};

/// What an instruction runs with.
struct Running {
    S7Instructions& all;
    Diagnostics& out;
    MadeVariables& variables;
    Excerpts& to;
    const S7Instruction& it;
    Value power;
    bool goes_on;  ///< who stands behind it takes power

    /// What is at a pin; where nothing is, that is told.
    Value operand(std::string_view pin) const;
    /// The pin has the other name in another edition, or another notation.
    Value operand(std::string_view pin, std::string_view other) const {
        return operand(it.find(pin) ? pin : other);
    }
    /// As a value of the type that the box calculates in, where that is a number or a
    /// bit string. A literal takes it from what stands beside it.
    Value typed(const Value& value, std::string_view which = "SrcType") const;
    /// Power as it is before the instruction does anything.
    Value enable();
    /// ENO is taken, and says more than EN.
    bool tells() const { return goes_on && it.has_eno; }
    /// `target := callee.NAME(EN := power, given, ENO => _wire1);`, and that wire. Without a target
    /// the call alone.
    Value told(const Value& target, std::string_view function, std::vector<Argument> given);

    void write(std::string_view text) { to.write(text, it.place); }
    void assign(const Value& target, const Value& value);
    /// `IF condition THEN`, and its end.
    void open(const Value& condition) { write_if(to, condition, it.place); }
    void close(const Value& condition) { write_end_if(to, condition, it.place); }

    Value wire() { return words(variables.make("_wire", "BOOL"), it.place, "BOOL"); }
    Value word(std::string_view text) const { return words(text, it.place); }
    Value not_(const Value& value) const;
    Value and_(const Value& a, const Value& b) const { return both(a, b, it.place); }
    Value or_(const Value& a, const Value& b) const { return either(a, b, it.place); }
    Value binary(const Value& a, std::string_view sign, const Value& b) const;

    /// `callee.NAME(pin := value, ...)`
    Value call(std::string_view function, const std::vector<Argument>& given) const;
    /// All pins but one, behind `first`.
    std::vector<Argument> pins(std::string_view but = {}, std::vector<Argument> first = {}) const;
    /// By their names and then their numbers, in whatever order the file has them; those without a
    /// name as they stand.
    std::vector<Argument> inputs() const;
};

/// `SrcType` of `[SrcType := Int, DestType := Real]`; empty: it is not there.
std::string type_of(const S7Instruction& instruction, std::string_view which);

}  // namespace lineshaft::projects::s7
