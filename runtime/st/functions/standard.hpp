#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "runtime/st/functions/emission.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

/// How the types of a call's arguments and of its result are found: a function of
/// check/standard_types.cpp for each.
enum class Typing : std::uint8_t {
    real,         ///< of one number: REAL or LREAL as it is, or as the result's row says
    reals,        ///< of several numbers: REAL or LREAL as what they have in common
    scaled,       ///< SCALE_X: a number as it is wanted, or as its first argument is
    own,          ///< of one argument: its type
    common,       ///< what all arguments have in common, or what is wanted
    chosen,       ///< what all arguments but the first have in common, or what is wanted
    places,       ///< bits and a number of places: the type of the bits
    bits,         ///< of a bit string
    bit_number,   ///< of a number: the bit string that is wanted, or a DWORD
    texts,        ///< of texts and whole numbers, as the parameters say
    capacity,     ///< of a text: a constant, or of one that is given what it holds
    lower_bound,  ///< of an array and a dimension: a constant
    upper_bound,
    element_count,  ///< of an array: a constant
    scan_time,
    operation,  ///< those of the operator that the call is
    wanted,     ///< of one argument: a conversion to what is wanted
    memory,     ///< of pointers and whole numbers
    statement,  ///< no value: a statement of its own, check/rewrites.cpp
};

/// When ENO of a call in SCL is FALSE, as TIA Portal's help says; it is found before the call is
/// executed (check/enable_outputs.cpp).
enum class Eno : std::uint8_t {
    always,      ///< never: it is EN
    arithmetic,  ///< the result is outside the type, or no valid number; division by 0 leaves it
                 ///< TRUE
    valid,       ///< a result that is real is no valid number
    converted,   ///< the value is outside the integer that is asked for, or no valid REAL
    limit,       ///< MN is above MX
    scaled,      ///< MIN is not below MAX, the result is outside the type, or no valid number
    chosen,      ///< K is none of the inputs, or outputs, also where there is INELSE or OUTELSE
    elements,    ///< there are fewer elements than that: nothing is moved
    bits,        ///< there are fewer elements than that, of which as many are done as there are, or
                 ///< the BOOLs do not begin where a bit string may: nothing is done
};

/// What check/rewrites.cpp puts for a statement that calls the function.
enum class Rewriting : std::uint8_t {
    stays,
    demux,
    scatter,
    gather,
    scatter_block,
    gather_block,
    move_block,
    fill_block,
    reset_timer,
    preset_timer,
};

/// What an argument may be and what a result is: as signatures write it, and what it stands for.
// clang-format off
#define LINESHAFT_ST_GENERIC_TYPES(TYPE)                                                           \
    TYPE(nothing, "", "")                                                                          \
    TYPE(any, "ANY", "any type")                                                                   \
    TYPE(any_elementary, "ANY_ELEMENTARY", "a number, a bit string, a time, a date or a text")     \
    TYPE(any_ordered, "ANY_ORDERED", "a number, a bit string, a time or a date")                   \
    TYPE(any_magnitude, "ANY_MAGNITUDE", "a number, a time or a date")                             \
    TYPE(any_num, "ANY_NUM", "an integer, a REAL or an LREAL")                                     \
    TYPE(any_real, "ANY_REAL", "a REAL or an LREAL, which an integer becomes")                     \
    TYPE(any_int, "ANY_INT", "SINT to LINT, USINT to ULINT")                                       \
    TYPE(any_bit, "ANY_BIT", "BYTE, WORD, DWORD or LWORD; of AND, OR and XOR also BOOL")           \
    TYPE(any_whole, "ANY_WHOLE", "an integer or a bit string")                                     \
    TYPE(array, "ARRAY", "an array of any type")                                                   \
    TYPE(pointer, "POINTER", "a POINTER TO, or ADR of a variable")                                 \
    TYPE(timer, "TIMER", "an instance of TON, TOF, TP or TONR")                                    \
    TYPE(boolean, "BOOL", "") TYPE(integer, "INT", "") TYPE(double_integer, "DINT", "")            \
    TYPE(long_integer, "LINT", "")                                                                 \
    TYPE(text, "STRING", "") TYPE(time, "TIME", "") TYPE(long_time, "LTIME", "")                   \
    TYPE(date, "DATE", "") TYPE(long_date, "LDATE", "") TYPE(clock, "TOD", "")                     \
    TYPE(long_clock, "LTOD", "") TYPE(moment, "DT", "") TYPE(long_moment, "LDT", "")
// clang-format on

enum class Generic : std::uint8_t {
#define TYPE(name, written, doc) name,
    LINESHAFT_ST_GENERIC_TYPES(TYPE)
#undef TYPE
};

struct GenericType {
    std::string_view name, doc;  ///< the latter empty for a type of the language
};

inline constexpr GenericType generic_types[] = {
#define TYPE(name, written, doc) {written, doc},
    LINESHAFT_ST_GENERIC_TYPES(TYPE)
#undef TYPE
};

constexpr std::string_view name_of(Generic type) {
    return generic_types[static_cast<std::size_t>(type)].name;
}

struct Parameter {
    std::string_view name = {};
    Generic type = Generic::nothing;
};

/// A function of IEC 61131-3:2013, tables 25 to 38, or of Siemens' SCL: all that is said of it.
struct StandardFunction {
    /// A signature is `LIMIT(MN, IN, MX: ANY_NUM): ANY_NUM`, with `...` for as many more of
    /// the last parameter as a call gives.
    consteval StandardFunction(std::string_view written, std::string_view about, Typing types,
                               Emit emitted, Op instruction = Op::move, Eno told = Eno::always);
    /// An operator that is written as a function.
    consteval StandardFunction(std::string_view written, std::string_view about, Word meant,
                               Eno told = Eno::always)
        : StandardFunction(written, about, Typing::operation, nullptr, Op::move, told) {
        word = meant;
    }
    /// A statement of its own.
    consteval StandardFunction(std::string_view written, std::string_view about, Rewriting becomes,
                               Eno told = Eno::always, Emit emitted = nullptr)
        : StandardFunction(written, about, Typing::statement, emitted, Op::move, told) {
        rewriting = becomes;
    }

    /// Those behind the last in the row are as that.
    const Parameter& parameter(std::size_t argument) const {
        return parameters[std::min(argument, static_cast<std::size_t>(least) - 1)];
    }

    std::string_view signature, doc;  ///< the latter one sentence, with units
    std::string_view name;
    std::array<Parameter, 4> parameters = {};
    int least = 0, most = 0;  ///< arguments
    Generic result = Generic::nothing;
    Typing typing;
    Emit emit;                      ///< null where the checker puts something else for the call
    Op op;                          ///< for `emit`: of shifts that of 8 bits
    Word word = Word::end_of_file;  ///< of `operation`
    Rewriting rewriting = Rewriting::stays;  ///< of `statement`
    Eno eno;
    bool is_pure;  ///< the same of the same arguments, and nothing is written
};

inline constexpr int most_arguments = 64;

struct Subject {
    std::string_view name;
    std::span<const StandardFunction> functions;
};

/// A file each. Messages offer names that are equally near in this order.
extern const Subject number_functions, bit_functions, timer_functions, operator_functions,
    measured_functions, time_functions, array_functions, text_functions, memory_functions;
inline constexpr const Subject* function_subjects[] = {
    &number_functions, &bit_functions,   &timer_functions, &operator_functions, &measured_functions,
    &time_functions,   &array_functions, &text_functions,  &memory_functions};
std::span<const StandardFunction* const> standard_functions();

/// Null for another name.
const StandardFunction* find_standard_function(std::string_view name);

/// `IN1`, `MN`: the standard's name of an argument.
std::string argument_name(const StandardFunction& function, int argument);

/// Takes the text up to `end` and that off `rest`; all of it where there is no `end`.
constexpr std::string_view take_until(std::string_view& rest, std::string_view end) {
    const std::string_view taken = rest.substr(0, rest.find(end));
    rest.remove_prefix(taken.size() == rest.size() ? rest.size() : taken.size() + end.size());
    return taken;
}

/// No constant, and so no row, for another name.
constexpr Generic find_generic(std::string_view name) {
    std::size_t at = 0;
    while (generic_types[at].name != name) ++at;
    return static_cast<Generic>(at);
}

consteval StandardFunction::StandardFunction(std::string_view written, std::string_view about,
                                             Typing types, Emit emitted, Op instruction, Eno told)
    : signature(written),
      doc(about),
      typing(types),
      emit(emitted),
      op(instruction),
      eno(told),
      is_pure(types != Typing::scan_time && types != Typing::statement && types != Typing::memory) {
    std::string_view rest = written;
    name = take_until(rest, "(");
    std::string_view list = take_until(rest, ")");
    if (!rest.empty()) result = find_generic(rest.substr(2));
    while (!list.empty()) {
        std::string_view group = take_until(list, "; ");
        std::string_view names = take_until(group, ": ");
        while (!names.empty()) {
            const std::string_view parameter = take_until(names, ", ");
            if (parameter == "...")
                most = most_arguments;
            else
                parameters[static_cast<std::size_t>(least++)] = {parameter, find_generic(group)};
        }
    }
    if (most == 0) most = least;
}

}  // namespace lineshaft::st
