#include "runtime/st/syntax/parsing.hpp"

#include <fmt/format.h>

#include "runtime/st/syntax/recovery.hpp"

namespace lineshaft::st {

namespace {

constexpr int most_levels = 200;
constexpr int longest_chain = 2000;

}  // namespace

Expression* Parsing::make(Expression::Kind kind, const Token& token) {
    Expression& made = tree.expressions.emplace_back();
    made.kind = kind;
    made.token = token;
    made.place = token.place;
    return &made;
}

Statement* Parsing::make(Statement::Kind kind, const Token& token) {
    Statement& made = tree.statements.emplace_back();
    made.kind = kind;
    made.place = token.place;
    return &made;
}

Statement* Parsing::make(Statement::Kind kind, Expression* value) {
    Statement& made = tree.statements.emplace_back();
    made.kind = kind;
    made.place = value->place;
    made.value = value;
    return &made;
}

void Parsing::add_operand(Expression& to, int index, Expression* operand) {
    to.operands[index] = operand;
    to.place = index == 0 ? operand->place.to(to.place) : to.place.to(operand->place);
    if (to.place.begin > to.place.end) std::swap(to.place.begin, to.place.end);
    grow(to, *operand);
}

void Parsing::grow(Expression& to, const Expression& part) {
    to.depth = std::max<std::uint16_t>(to.depth, static_cast<std::uint16_t>(part.depth + 1));
    if (to.depth > longest_chain) refuse_depth(to.token.place);
}

void Parsing::refuse_depth(Place place) {
    fail(*this, code::too_deep_or_large, place,
         fmt::format("this is nested deeper than {} levels", most_levels),
         "take it apart, into variables or functions");
    at = unclosed_at = tokens.size() - 1;
}

Level::Level(Parsing& p) : p_(p) {
    if (++p_.levels > most_levels) p_.refuse_depth(p_.here().place);
}

}  // namespace lineshaft::st
