#include "runtime/st/syntax/parser.hpp"

#include "runtime/st/syntax/grammar.hpp"

namespace lineshaft::st {

/// Source : Namespace_Element *
void parse(Tokens tokens, Tree& tree, Diagnostics& out) {
    tree.sources.push_back(tokens.source);
    turn_modifiers(tokens, out);
    Parsing p{Cursor{std::move(tokens)}, tree, out};
    do parse_namespace_element(p);
    while (!p.is(Word::end_of_file));
    if (p.fixture) tree.units.push_back(p.fixture);
}

}  // namespace lineshaft::st
