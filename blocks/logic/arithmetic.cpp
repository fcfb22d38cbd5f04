#include "blocks/logic/arithmetic.hpp"

#include <cmath>
#include <functional>
#include <tuple>

namespace lineshaft {

namespace {

struct Remainder {
    double operator()(double a, double b) const { return std::fmod(a, b); }
};

using Operations =
    std::tuple<std::plus<>, std::minus<>, std::multiplies<>, std::divides<>, Remainder>;

constexpr double beyond_lint = 0x1p63;

}  // namespace

template <Operation operation>
std::span<const Field> Arithmetic<operation>::fields() {
    using A = Arithmetic;
    static const Field table[] = {
        parameter("unit", &A::unit, "", number_unit_doc).one_of(number_unit_names),
        input("in1", &A::in1, "{unit}", "left operand").must_be_set(),
        input("in2", &A::in2, plain_in2 ? "" : "{unit}", "right operand").must_be_set(),
        output("out", &A::out, "{unit}", doc),
        output("error", &A::error, "", number_error_doc),
        output("error_id", &A::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

template <Operation operation>
void Arithmetic<operation>::scan(const Scan&) {
    using Compute = std::tuple_element_t<static_cast<std::size_t>(operation), Operations>;
    NumberError wrong = finite_error(in1, in2);
    if (wrong == NumberError::none && divides && in2 == 0) wrong = NumberError::division_by_zero;
    settle(*this, wrong == NumberError::none ? Compute{}(in1, in2) : 0, wrong);
}

template struct Arithmetic<Operation::add>;
template struct Arithmetic<Operation::sub>;
template struct Arithmetic<Operation::mul>;
template struct Arithmetic<Operation::div>;
template struct Arithmetic<Operation::mod>;

std::span<const Field> Abs::fields() {
    static const Field table[] = {
        parameter("unit", &Abs::unit, "", number_unit_doc).one_of(number_unit_names),
        input("in", &Abs::in, "{unit}", "the number").must_be_set(),
        output("out", &Abs::out, "{unit}", doc),
        output("error", &Abs::error, "", number_error_doc),
        output("error_id", &Abs::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

void Abs::scan(const Scan&) {
    settle(*this, std::abs(in), finite_error(in));
}

template <Conversion conversion>
std::span<const Field> Convert<conversion>::fields() {
    using C = Convert;
    static const Field table[] = {
        input("in", &C::in, to_time ? "s" : "", "the number").must_be_set(),
        output("out", &C::out, to_time ? "ns" : "", "the nearest whole number"),
        output("error", &C::error, "", number_error_doc),
        output("error_id", &C::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

template <Conversion conversion>
void Convert<conversion>::scan(const Scan&) {
    const double whole = std::nearbyint(to_time ? in * 1e9 : in);
    NumberError wrong = finite_error(in);
    if (wrong == NumberError::none && !(whole >= -beyond_lint && whole < beyond_lint))
        wrong = NumberError::overflow;
    if (report(*this, wrong)) out = static_cast<std::int64_t>(whole);
}

template struct Convert<Conversion::lreal_to_lint>;
template struct Convert<Conversion::lreal_to_time>;

}  // namespace lineshaft
