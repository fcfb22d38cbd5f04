#include "blocks/logic/compare.hpp"

#include <functional>
#include <tuple>

namespace lineshaft {

namespace {

using Comparisons = std::tuple<std::greater<>, std::greater_equal<>, std::equal_to<>,
                               std::less_equal<>, std::less<>, std::not_equal_to<>>;

}  // namespace

template <Comparison comparison>
std::span<const Field> Compare<comparison>::fields() {
    using C = Compare;
    static const Field table[] = {
        parameter("unit", &C::unit, "", number_unit_doc).one_of(number_unit_names),
        input("in1", &C::in1, "{unit}", "left side").must_be_set(),
        input("in2", &C::in2, "{unit}", "right side").must_be_set(),
        output("out", &C::out, "", doc),
        output("error", &C::error, "", number_error_doc),
        output("error_id", &C::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

template <Comparison comparison>
void Compare<comparison>::scan(const Scan&) {
    using Holds = std::tuple_element_t<static_cast<std::size_t>(comparison), Comparisons>;
    if (report(*this, finite_error(in1, in2))) out = Holds{}(in1, in2);
}

template struct Compare<Comparison::gt>;
template struct Compare<Comparison::ge>;
template struct Compare<Comparison::eq>;
template struct Compare<Comparison::le>;
template struct Compare<Comparison::lt>;
template struct Compare<Comparison::ne>;

std::span<const Field> Hysteresis::fields() {
    using H = Hysteresis;
    static const Field table[] = {
        parameter("unit", &H::unit, "", number_unit_doc).one_of(number_unit_names),
        input("in", &H::in, "{unit}", "value to watch").must_be_set(),
        input("high", &H::high, "{unit}", "from here on q is true").must_be_set(),
        input("low", &H::low, "{unit}", "from here on q is false").must_be_set(),
        output("q", &H::q, "", "high was reached, and low not since"),
        output("error", &H::error, "", number_error_doc),
        output("error_id", &H::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

void Hysteresis::scan(const Scan&) {
    NumberError wrong = finite_error(in, high, low);
    if (wrong == NumberError::none && !(high > low)) wrong = NumberError::wrong_limits;
    if (report(*this, wrong)) q = in >= high || (q && in > low);
}

}  // namespace lineshaft
