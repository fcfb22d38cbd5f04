#pragma once

#include <string>
#include <vector>

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// The input that has a bound of an ARRAY[*]; dimensions count from 0.
std::string bound_name(const Variable& array, bool is_lower, std::size_t dimension);
/// That bound, which the routine was given, or which stands beside a REF_TO ARRAY[*].
Expression* bound_of(Checking& c, const Expression& array, bool is_lower, std::size_t dimension);

/// Where the element `a[i, k]` is, `e`: the array's own place, moved on by each index. The bounds
/// of its dimension, then of those behind it, are the arguments of such a sum, the size of an
/// element its constant.
Expression* moved_in_open_array(Checking& c, const Expression& e);

/// `r := REF(a);`, `r := other;`, `r := NULL;`: where its first element is, and its bounds.
void assign_open_array(Checking& c, Statement*& s);

/// What a call gives an ARRAY[*], or REF(it) to a REF_TO ARRAY[*]: where the first element is, and
/// the bounds, in the inputs' order. What is no such array is told.
void give_open_array(Checking& c, const Argument& argument, Variable& array,
                     const std::vector<Variable*>& bounds, std::vector<Argument>& to);

}  // namespace lineshaft::st
