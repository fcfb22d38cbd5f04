#include <fmt/format.h>

#include "runtime/st/syntax/grammar.hpp"

namespace lineshaft::st {

namespace {

/// Namespace_Decl : 'NAMESPACE' 'INTERNAL' ? Qualified_Name Namespace_Element * 'END_NAMESPACE'
///                  ';' ?
void parse_namespace(Parsing& p) {
    const Level level(p);
    const Token opener = p.take();
    if (p.is_name(1)) p.accept(Word::internal_);
    const Token name = parse_qualified_name(p, "the name of the namespace");
    std::string path(p.scope ? p.scope->path : std::string_view());
    if (!path.empty() && !p.panic) path += '.';
    if (!p.panic) path += name.text;
    p.panic = false;
    open_scope(p, opener.place.begin, p.tree.names.emplace_back(std::move(path)));
    while (!p.is(Word::end_namespace_) && !p.is(Word::end_of_file)) parse_namespace_element(p);
    close(p, Word::end_namespace_, opener);
    p.accept(Word::semicolon);
}

}  // namespace

/// Namespace_Element : Using_Directive | Namespace_Decl | Declaration
void parse_namespace_element(Parsing& p) {
    if (p.is(Word::using_)) {
        if (!p.scope) open_scope(p, p.here().place.begin, {});
        return parse_using(p);
    }
    Scope* const outer = p.scope;
    if (p.is(Word::namespace_))
        parse_namespace(p);
    else
        lose_if_wrong(p, parse_declaration);
    if (p.scope != outer) p.scope->end = p.last().place.end;
    p.scope = outer;
}

/// Using_Directive : 'USING' Qualified_Name ( ',' Qualified_Name ) * ';'
void parse_using(Parsing& p) {
    p.take();
    do p.scope->usings.push_back(parse_qualified_name(p, "a namespace"));
    while (p.accept(Word::comma));
    end_statement(p);
    if (p.panic) skip_line(p);
}

void open_scope(Parsing& p, std::uint32_t begin, std::string_view path) {
    const auto end = static_cast<std::uint32_t>(p.source->text().size() + 1);
    auto& scopes = p.tree.scopes[p.source.get()];
    p.scope = &scopes.emplace_back(Scope{p.scope, begin, end, path, {}});
}

/// Qualified_Name : Name ( '.' Name ) *
Token parse_qualified_name(Parsing& p, std::string_view what) {
    Token name = expect_name(p, what);
    std::string text(name.text);
    while (!p.panic && p.is(Word::dot) && p.is_name(1)) {
        p.take();
        text += fmt::format(".{}", p.here().text);
        name.place = name.place.to(p.take().place);
        name.text = {};
    }
    if (name.text.empty()) name.text = p.tree.names.emplace_back(std::move(text));
    return name;
}

}  // namespace lineshaft::st
