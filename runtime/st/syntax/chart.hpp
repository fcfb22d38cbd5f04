#pragma once

#include <vector>

#include "runtime/st/syntax/token.hpp"

/// A sequential function chart as it is written: IEC 61131-3:2013, 6.7.
namespace lineshaft::st {

struct Expression;

/// `pump(L, T#5s);` of a step.
struct ChartAssociation {
    Token action = {};           ///< an ACTION, or a BOOL
    Token qualifier = {};        ///< `end_of_file`: none, which is N
    Expression* time = nullptr;  ///< of L, D, SD, DS and SL
};

struct ChartStep {
    Token name = {};
    bool is_initial = false;
    std::vector<ChartAssociation> associations = {};
};

/// The steps of `from` are left, and those of `to` entered, once all of `from` are active and the
/// condition holds. Of several out of one step the first that may go does.
struct ChartTransition {
    Place place = {};
    std::vector<Token> from = {}, to = {};
    Expression* condition = nullptr;
    Token priority = {};  ///< `end_of_file`: none, behind those that have one
};

struct Chart {
    std::vector<ChartStep> steps = {};
    std::vector<ChartTransition> transitions = {};
};

}  // namespace lineshaft::st
