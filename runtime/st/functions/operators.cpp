#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

// clang-format off
constexpr StandardFunction operators[] = {
    {"MOVE(IN: ANY): ANY", "IN", Typing::common, [](Emission& e) { return e.value_or_address(0); }},
    {"ADD(IN1, IN2, ...: ANY_MAGNITUDE): ANY_MAGNITUDE", "IN1 + IN2", Word::plus, Eno::arithmetic},
    {"SUB(IN1, IN2: ANY_MAGNITUDE): ANY_MAGNITUDE", "IN1 - IN2", Word::minus, Eno::arithmetic},
    {"MUL(IN1, IN2, ...: ANY_NUM): ANY_NUM", "IN1 * IN2; also of a TIME and a number", Word::times, Eno::arithmetic},
    {"DIV(IN1, IN2: ANY_NUM): ANY_NUM", "IN1 / IN2, of integers towards 0 and by 0 a fault, in SCL 0; also of a TIME and a number", Word::divided, Eno::arithmetic},
    {"MOD(IN1, IN2: ANY_INT): ANY_INT", "what IN1 / IN2 leaves, with the sign of IN1; by 0 a fault", Word::mod_},
    {"AND(IN1, IN2, ...: ANY_BIT): ANY_BIT", "the bits that all have", Word::and_},
    {"OR(IN1, IN2, ...: ANY_BIT): ANY_BIT", "the bits that one or more have", Word::or_},
    {"XOR(IN1, IN2, ...: ANY_BIT): ANY_BIT", "the bits that an odd number of them has", Word::xor_},
    {"GT(IN1, IN2, ...: ANY_ELEMENTARY): BOOL", "each is above the next", Word::greater},
    {"GE(IN1, IN2, ...: ANY_ELEMENTARY): BOOL", "each is at least the next", Word::greater_or_equal},
    {"EQ(IN1, IN2, ...: ANY_ELEMENTARY): BOOL", "all are equal", Word::equal},
    {"LE(IN1, IN2, ...: ANY_ELEMENTARY): BOOL", "each is at most the next", Word::less_or_equal},
    {"LT(IN1, IN2, ...: ANY_ELEMENTARY): BOOL", "each is below the next", Word::less},
    {"NE(IN1, IN2: ANY_ELEMENTARY): BOOL", "both differ", Word::unequal},
};
// clang-format on

}  // namespace

constinit const Subject operator_functions{"operators", operators};

}  // namespace lineshaft::st
