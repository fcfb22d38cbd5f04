#include "blocks/logic/boolean.hpp"

namespace lineshaft {

template <BooleanKind kind>
std::span<const Field> Boolean<kind>::fields() {
    using B = Boolean;
    constexpr std::string_view more = "left out it changes nothing";
    static const Field table[] = {
        input("in1", &B::in1, "", "operand").must_be_set(),
        input("in2", &B::in2, "", "operand").must_be_set(),
        input("in3", &B::in3, "", more),
        input("in4", &B::in4, "", more),
        input("in5", &B::in5, "", more),
        input("in6", &B::in6, "", more),
        input("in7", &B::in7, "", more),
        input("in8", &B::in8, "", more),
        output("out", &B::out, "", doc),
    };
    return table;
}

template <>
void And::scan(const Scan&) {
    out = in1 && in2 && in3 && in4 && in5 && in6 && in7 && in8;
}

template <>
void Or::scan(const Scan&) {
    out = in1 || in2 || in3 || in4 || in5 || in6 || in7 || in8;
}

template <>
void Xor::scan(const Scan&) {
    out = in1 ^ in2 ^ in3 ^ in4 ^ in5 ^ in6 ^ in7 ^ in8;
}

template struct Boolean<BooleanKind::and_>;
template struct Boolean<BooleanKind::or_>;
template struct Boolean<BooleanKind::xor_>;

std::span<const Field> Not::fields() {
    static const Field table[] = {
        input("in", &Not::in, "", "operand").must_be_set(),
        output("out", &Not::out, "", doc),
    };
    return table;
}

void Not::scan(const Scan&) {
    out = !in;
}

}  // namespace lineshaft
