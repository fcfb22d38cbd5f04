#include <algorithm>

#include "runtime/st/syntax/grammar.hpp"
#include "runtime/st/syntax/remarks.hpp"

namespace lineshaft::st {

namespace {

/// Name_List : Qualified_Name Generic_Values ? ( ',' Qualified_Name Generic_Values ? ) *
void parse_name_list(Parsing& p, std::vector<Token>& to) {
    do {
        to.push_back(parse_qualified_name(p, "the name of a block or an interface"));
        parse_generic_values(p, to.back());
    } while (p.accept(Word::comma));
}

/// What is set is an input of the property's name.
Pou& add_accessor(Parsing& p, const Pou& property, Accessor accessor) {
    Pou& pou = p.tree.pous.emplace_back(property);
    pou.accessor = accessor;
    if (accessor == Accessor::set) pou.body.clear();
    if (accessor == Accessor::set && pou.result) {
        Declaration& value = p.tree.declarations.emplace_back();
        value.name = pou.name;
        value.type = std::exchange(pou.result, nullptr);
        pou.blocks.push_back({.section = Section::input, .declarations = {&value}});
    }
    return pou;
}

/// A property, too, may be called so: `Set := x;`, `Get.member := x;`.
bool begins_accessor(const Parsing& p) {
    using enum Word;
    constexpr Word behind_variable[] = {
        assign,       plus_assign, minus_assign,     times_assign,   divided_assign, set_assign,
        reset_assign, dot,         reference_assign, attempt_assign, caret,          open_bracket};
    return (p.says("get") || p.says("set")) &&
           std::ranges::find(behind_variable, p.next().word) == std::end(behind_variable);
}

/// Accessor : ( 'GET' | 'SET' ) Access_Spec * ';' ? Var_Sections Stmt_List
///            ( 'END_GET' | 'END_SET' ) ';' ?
/// Both are names elsewhere; a GET ends with END_GET.
Pou* parse_accessor(Parsing& p, const Pou& property) {
    const Token opener = p.take();
    const bool gets = same_name(opener.text, "get");
    const Word end = gets ? Word::end_get_ : Word::end_set_;
    Pou& pou = add_accessor(p, property, gets ? Accessor::get : Accessor::set);
    while (accept_access(p, &pou.access)) continue;
    p.accept(Word::semicolon);
    parse_sections(p, pou, end);
    const bool is_empty = p.is(Word::end_property_) || begins_accessor(p);
    p.is_in_body = true;
    if (!is_empty) parse_statements(p, pou.body, end);
    p.is_in_body = false;
    if (!is_empty) close(p, end, opener);
    p.accept(Word::semicolon);
    return &pou;
}

}  // namespace

/// Pou_Modifier : Access_Spec | 'ABSTRACT' | 'FINAL' | 'OVERRIDE'
/// A name in the same line follows; else it is the name.
void parse_pou_modifiers(Parsing& p, Pou& pou) {
    while (p.is_name(1) && !p.next().first_in_line) {
        if (accept_access(p, &pou.access)) continue;
        if (p.accept(Word::abstract_))
            pou.is_abstract = true;
        else if (p.accept(Word::final_))
            pou.is_final = true;
        else if (p.accept(Word::override_))
            pou.is_override = true;
        else
            return;
    }
}

/// Pou_Bases : ( 'EXTENDS' Name_List ) ? ( 'IMPLEMENTS' Name_List ) ?
/// A FUNCTION_BLOCK, a CLASS and an INTERFACE have it; the last alone has several behind EXTENDS.
void parse_bases(Parsing& p, Pou& pou) {
    const Token first = p.here();
    if (p.accept(Word::extends_)) parse_name_list(p, pou.bases);
    if (p.accept(Word::implements_)) parse_name_list(p, pou.implemented);
    if (p.panic) skip_line(p);
    const bool is_interface = pou.kind == PouKind::interface;
    if (pou.bases.empty() && pou.implemented.empty()) return;
    if (pou.kind != PouKind::function_block && !is_interface)
        tell(p, code::wrong_place, first.place,
             "only a FUNCTION_BLOCK, a CLASS and an INTERFACE have a base",
             "make it a FUNCTION_BLOCK");
    else if (is_interface && !pou.implemented.empty())
        tell(p, code::wrong_place, pou.implemented.front().place, "an INTERFACE implements nothing",
             "write EXTENDS");
    else if (!is_interface && pou.bases.size() > 1)
        tell(p, code::wrong_place, pou.bases[1].place, "a block has one base",
             "let the other be an INTERFACE that it IMPLEMENTS, or a variable of it");
}

/// Prop_Decl : 'PROPERTY' Pou_Modifier * Name ':' Result ';' ? Accessor * 'END_PROPERTY' ';' ?
/// In an INTERFACE one without accessors has both.
void parse_property(Parsing& p, std::vector<Pou*>& to, PouKind of) {
    Pou property;
    property.kind = PouKind::method;
    property.doc = comment_before(p, p.at, true);
    property.is_monitored = has_attribute(p, p.at, "monitoring");
    const Token opener = p.take();
    parse_pou_modifiers(p, property);
    property.name = expect_name(p, "the name of the PROPERTY");
    property.place = opener.place.to(property.name.place);
    if (expect(p, Word::colon, "before the property's type")) parse_result(p, property);
    if (p.panic) skip_line(p);
    p.accept(Word::semicolon);
    if (of == PouKind::interface && p.is(Word::end_property_))
        for (const Accessor accessor : {Accessor::get, Accessor::set})
            to.push_back(&add_accessor(p, property, accessor));
    while (!p.panic && p.is(Word::name) && begins_accessor(p))
        to.push_back(parse_accessor(p, property));
    close(p, Word::end_property_, opener);
    p.accept(Word::semicolon);
    if (p.panic) skip_past(p, Word::end_property_);
}

/// A part of Declaration: a METHOD that stands behind the block it is of.
void parse_late_method(Parsing& p) {
    Pou* block = p.tree.units.empty() ? nullptr : p.tree.units.back();
    const bool has_methods = block && block->place.source == p.source.get() &&
                             (block->kind == PouKind::function_block ||
                              block->kind == PouKind::program || block->kind == PouKind::interface);
    std::vector<Pou*> alone;
    if (!has_methods)
        tell(p, code::wrong_place, p.here().place, "a method stands in a block, or behind one",
             "write it before END_FUNCTION_BLOCK");
    std::vector<Pou*>& to = has_methods ? block->methods : alone;
    if (p.is(Word::property_))
        parse_property(p, to, has_methods ? block->kind : PouKind::function);
    else
        to.push_back(parse_pou(p));
}

}  // namespace lineshaft::st
