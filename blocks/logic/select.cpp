#include "blocks/logic/select.hpp"

#include <algorithm>

namespace lineshaft {

std::span<const Field> Sel::fields() {
    static const Field table[] = {
        parameter("unit", &Sel::unit, "", number_unit_doc).one_of(number_unit_names),
        input("g", &Sel::g, "", "false: in0, true: in1").must_be_set(),
        input("in0", &Sel::in0, "{unit}", "out while g is false").must_be_set(),
        input("in1", &Sel::in1, "{unit}", "out while g is true").must_be_set(),
        output("out", &Sel::out, "{unit}", "the selected number"),
        output("error", &Sel::error, "", number_error_doc),
        output("error_id", &Sel::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

void Sel::scan(const Scan&) {
    settle(*this, g ? in1 : in0, finite_error(in0, in1));
}

std::span<const Field> Mux::fields() {
    static const Field table[] = {
        parameter("unit", &Mux::unit, "", number_unit_doc).one_of(number_unit_names),
        input("k", &Mux::k, "", "number of the input").at_least(0).at_most(7).must_be_set(),
        input("in0", &Mux::in0, "{unit}", "out with k = 0").must_be_set(),
        input("in1", &Mux::in1, "{unit}", "out with k = 1").must_be_set(),
        input("in2", &Mux::in2, "{unit}", "out with k = 2"),
        input("in3", &Mux::in3, "{unit}", "out with k = 3"),
        input("in4", &Mux::in4, "{unit}", "out with k = 4"),
        input("in5", &Mux::in5, "{unit}", "out with k = 5"),
        input("in6", &Mux::in6, "{unit}", "out with k = 6"),
        input("in7", &Mux::in7, "{unit}", "out with k = 7"),
        output("out", &Mux::out, "{unit}", "the selected number"),
        output("error", &Mux::error, "", number_error_doc),
        output("error_id", &Mux::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

void Mux::scan(const Scan&) {
    const double inputs[] = {in0, in1, in2, in3, in4, in5, in6, in7};
    const bool known = k >= 0 && k < std::ssize(inputs);
    NumberError wrong = finite_error(in0, in1, in2, in3, in4, in5, in6, in7);
    if (wrong == NumberError::none && !known) wrong = NumberError::wrong_index;
    settle(*this, known ? inputs[k] : 0, wrong);
}

std::span<const Field> Limit::fields() {
    static const Field table[] = {
        parameter("unit", &Limit::unit, "", number_unit_doc).one_of(number_unit_names),
        input("mn", &Limit::mn, "{unit}", "least output").must_be_set(),
        input("in", &Limit::in, "{unit}", "the number").must_be_set(),
        input("mx", &Limit::mx, "{unit}", "greatest output; wins over mn").must_be_set(),
        output("out", &Limit::out, "{unit}", "the number within its limits"),
        output("error", &Limit::error, "", number_error_doc),
        output("error_id", &Limit::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

std::optional<Misfit> Limit::misfit(const IsConstant& is_constant) const {
    if (mn <= mx || !is_constant("mn") || !is_constant("mx")) return {};
    return Misfit{"mn", "it must not be above mx"};
}

void Limit::scan(const Scan&) {
    settle(*this, std::min(std::max(in, mn), mx), finite_error(mn, in, mx));
}

template <bool greatest>
std::span<const Field> Extremum<greatest>::fields() {
    using E = Extremum;
    static const Field table[] = {
        parameter("unit", &E::unit, "", number_unit_doc).one_of(number_unit_names),
        input("in1", &E::in1, "{unit}", "a number").must_be_set(),
        input("in2", &E::in2, "{unit}", "a number").must_be_set(),
        output("out", &E::out, "{unit}", doc),
        output("error", &E::error, "", number_error_doc),
        output("error_id", &E::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

template <bool greatest>
void Extremum<greatest>::scan(const Scan&) {
    settle(*this, greatest ? std::max(in1, in2) : std::min(in1, in2), finite_error(in1, in2));
}

template struct Extremum<false>;
template struct Extremum<true>;

std::span<const Field> MoveValue::fields() {
    using M = MoveValue;
    static const Field table[] = {
        parameter("unit", &M::unit, "", number_unit_doc).one_of(number_unit_names),
        input("en", &M::en, "", "false: out is held"),
        input("in", &M::in, "{unit}", "the number").must_be_set(),
        output("out", &M::out, "{unit}", "in, as of the last scan with en"),
        output("error", &M::error, "", number_error_doc),
        output("error_id", &M::error_id, "", "why").one_of(number_error_names),
    };
    return table;
}

void MoveValue::scan(const Scan&) {
    settle(*this, en ? in : out, finite_error(in));
}

}  // namespace lineshaft
