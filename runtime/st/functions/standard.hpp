#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/st/code/opcodes.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

/// What a standard function takes and gives.
enum class Rule : std::uint8_t {
    real,       ///< REAL or LREAL, as its argument is
    real_two,   ///< the same of two
    whole,      ///< of a real the integer that is wanted, else a DINT
    absolute,   ///< any number
    extremum,   ///< the least or greatest of several numbers, times
    limit,      ///< LIMIT(mn, in, mx)
    select,     ///< SEL(g, in0, in1)
    multiplex,  ///< MUX(k, in0, ...), MUX(K := k, IN0 := a, INELSE := b)
    shift,      ///< SHL(bits, n)
    move,       ///< its argument
    operation,  ///< ADD(a, b, ...): an operator
    square,     ///< SQR
    fraction,   ///< FRAC
    normalise,  ///< NORM_X(min, value, max)
    scale,      ///< SCALE_X(min, value, max)
    length,     ///< LEN(text)
    find,       ///< FIND(text, text)
    text,       ///< CONCAT, LEFT, ...: texts, then numbers; gives a text
    finite,     ///< IS_VALID, of a real
    valid_bcd,  ///< IS_VALID_BCD
    time,       ///< TIME(), of the scan
    swap,       ///< SWAP: the bytes the other way round
    decode,     ///< DECO(n): the bit of that number
    encode,     ///< ENCO(bits): the number of the lowest bit
    capacity,   ///< MAX_LEN(text)
    bound,      ///< LOWER_BOUND(array, dimension), UPPER_BOUND, CountOfElements: a constant
    statement,  ///< no value: a statement of its own, check/rewrites.cpp
};

/// A function of IEC 61131-3:2013, tables 25 to 38, or of Siemens' SCL.
struct StandardFunction {
    std::string_view name;
    Rule rule = Rule::real;
    int least = 1, most = 1;        ///< arguments
    Op op = Op::move;               ///< of `real`, `whole`; of `shift` that of 8 bits
    Word word = Word::end_of_file;  ///< of `operation`
    int texts = 1;                  ///< of `text`: arguments that are texts
};

std::span<const StandardFunction> standard_functions();

/// Null for another name.
const StandardFunction* find_standard_function(std::string_view name);

/// `IN1`, `MN`: the standard's name of an argument.
std::string argument_name(const StandardFunction& function, int argument);

}  // namespace lineshaft::st
