#include <set>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/grammar.hpp"
#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

namespace {

/// What a generic constant of the block that is read stands for; else the value itself.
Expression* replaced(const Parsing& p, Expression* value) {
    if (value->kind != Expression::Kind::name) return value;
    for (const Declaration* constant : p.generics)
        if (same_name(constant->name.text, value->token.text) && constant->initial)
            return constant->initial;
    return value;
}

/// As a part of a name, where a point would end that of a namespace.
std::string text_of(const Expression& value) {
    std::string text;
    for (const char letter : value.place.text())
        if (letter != ' ' && letter != '\t') text += letter == '.' ? ':' : letter;
    return text;
}

/// Without values for all its constants it is no block of its own.
bool is_open(const Pou& block) {
    return block.is_generic && std::ranges::any_of(block.blocks.front().declarations,
                                                   [](auto* d) { return d->initial == nullptr; });
}

}  // namespace

/// Generic_Decl : 'VAR_GENERIC' 'CONSTANT' Var_Decl * 'END_VAR' ';' ?
/// Constants of a FUNCTION_BLOCK, which a type with Generic_Values gives other values.
void parse_generic_constants(Parsing& p, Pou& pou) {
    if (!p.is(Word::name) || !p.says("var_generic")) return;
    pou.is_generic = true;
    DeclarationBlock block = parse_section(p, Section::local);
    block.constant = true;
    for (std::size_t i = 0; i < block.declarations.size() && i < p.given.size(); ++i)
        block.declarations[i]->initial = p.given[i];
    p.generics = block.declarations;
    pou.blocks.push_back(std::move(block));
}

/// Generic_Values : '<' Variable_Access ( ',' Variable_Access ) * '>'
/// With them the name is that of a block of its own.
void parse_generic_values(Parsing& p, Token& name) {
    if (p.panic || !p.source->dialect.is_loose || !p.accept(Word::less)) return;
    GenericUse use{.block = name.text.substr(name.text.rfind('.') + 1), .written = "<"};
    do {
        use.values.push_back(replaced(p, parse_access(p)));
        if (use.written.size() > 1) use.written += ',';
        use.written += text_of(*use.values.back());
    } while (p.accept(Word::comma));
    expect(p, Word::greater, "after the values");
    use.written += '>';
    name.text = p.tree.names.emplace_back(std::string(name.text) + use.written);
    name.place = name.place.to(p.last().place);
    p.tree.generic_uses.push_back(std::move(use));
}

void keep_generic(Parsing& p, const Pou& pou, std::size_t first) {
    p.generics.clear();
    if (!p.given.empty()) return;
    Tokens own{p.source, {}, p.pragmas, p.comments, {}};
    const auto begin = p.tokens.begin() + static_cast<std::ptrdiff_t>(first);
    own.tokens.assign(begin, p.tokens.begin() + static_cast<std::ptrdiff_t>(p.at));
    own.tokens.push_back(p.tokens.back());
    p.tree.generics.push_back({&pou, std::move(own), p.scope});
}

void expand_generics(Tree& tree) {
    constexpr std::size_t most_uses = 10'000;
    Diagnostics told;  // of the block itself
    std::set<std::pair<const Pou*, std::string>> made;
    for (std::size_t i = 0; i < std::min(tree.generic_uses.size(), most_uses); ++i) {
        const GenericUse use = tree.generic_uses[i];  // the list grows
        for (const GenericBlock& block : tree.generics) {
            const Pou& pou = *block.pou;
            const bool is_meant = same_name(pou.name.text, use.block) && !pou.is_lost;
            if (!is_meant || !made.emplace(&pou, lower(use.written)).second) continue;
            Parsing p{Cursor{block.tokens}, tree, told};
            p.scope = block.scope;
            p.given = use.values;
            Pou& own = *parse_pou(p);
            own.name.text = tree.names.emplace_back(std::string(own.name.text) + use.written);
            tree.units.push_back(&own);
        }
    }
    std::erase_if(tree.units, [](const Pou* pou) { return is_open(*pou); });
}

}  // namespace lineshaft::st
