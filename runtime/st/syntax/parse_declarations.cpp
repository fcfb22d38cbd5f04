#include "runtime/st/syntax/grammar.hpp"
#include "runtime/st/syntax/remarks.hpp"

namespace lineshaft::st {

namespace {

/// Its variables keep their values.
bool stays(PouKind kind) {
    return kind == PouKind::program || kind == PouKind::function_block;
}

/// Var_Modifier : 'CONSTANT' | Retained | 'DB_SPECIFIC' | Access_Spec
bool accept_modifier(Parsing& p, DeclarationBlock& block) {
    if (p.is_declared()) return false;
    if (p.accept(Word::constant_)) return block.constant = true;
    if (p.is(Word::name) && p.says("db_specific")) {
        p.take();
        return true;
    }
    return accept_retention(p, block.retention) || accept_access(p, &block.access);
}

/// It begins its line, as `CONST` and `LABEL` are names elsewhere.
bool at_older_section(const Cursor& p, std::string_view word) {
    return p.is(Word::name) && p.here().first_in_line && p.says(word) && p.is_name(1);
}

/// Const_Section : 'CONST' ( Name ':=' Expression ';' ) * 'END_CONST' ';' ?
/// Siemens' older SCL has it: each constant is as its value is, without a type of its own.
DeclarationBlock parse_constants(Parsing& p) {
    const Token opener = p.take();
    DeclarationBlock block;
    block.constant = true;
    while (!p.panic && p.is_name() && !p.says("end_const")) {
        const Token name = p.take();
        if (!p.accept(Word::assign)) expected(p, ":=", "after the name");
        Expression* value = parse_expression(p);
        if (!p.panic) end_statement(p);
        if (p.panic) skip_declaration(p);
        block.declarations.push_back(
            &p.tree.declarations.emplace_back(Declaration{.name = name, .initial = value}));
    }
    if (p.says("end_const"))
        p.take();
    else
        tell(p, code::something_else_expected, opener.place, "the CONST does not end",
             "it ends with END_CONST");
    p.accept(Word::semicolon);
    return block;
}

/// Label_Section : 'LABEL' Name ( ',' Name ) * ';' 'END_LABEL' ';' ?
/// A label is known by where it stands, too.
void parse_labels(Parsing& p) {
    while (!p.is(Word::end_of_file) && !is_end(p.here().word) && !p.says("end_label")) p.take();
    if (p.says("end_label")) p.take();
    p.accept(Word::semicolon);
}

/// Located_At : 'AT' ( Direct | Name )
/// Only one variable is there, but for an address that is left open. Of another variable's bytes it
/// is a second view.
Token parse_location(Parsing& p, const std::vector<Token>& names) {
    if (!p.accept(Word::at_)) return {};
    if (names.size() > 1 && !p.here().text.ends_with('*')) refuse_shared_place(p);
    if (p.is(Word::direct) || p.is_name()) return p.take();
    expected(p, "an address", "after AT");
    return {};
}

/// Path_Decl : Name ( '.' Name ) + ':' Data_Type ';'
/// CODESYS writes into its list of persistent variables the paths of those that blocks declare to
/// be such. False, and nothing is taken: there is none.
bool skip_path(Parsing& p) {
    std::size_t names = 1;
    while (p.is_name(2 * names - 2) && p.next(2 * names - 1).word == Word::dot) ++names;
    if (names == 1 || !p.is_name(2 * names - 2) || p.next(2 * names - 1).word != Word::colon)
        return false;
    for (std::size_t i = 0; i < 2 * names; ++i) p.take();
    parse_type(p);
    end_statement(p);
    return true;
}

/// It stands for a file's path or a line's number, which nobody need give.
Expression* value_of_caller(Parsing& p, const TypeText& type) {
    const bool is_text = type.kind == TypeText::Kind::text || same_name(type.name.text, "string");
    Token token = type.name;
    token.word = is_text ? Word::text : Word::integer;
    token.text = is_text ? "" : "0";
    return p.make(Expression::Kind::constant, token);
}

}  // namespace

/// Retained : 'NON_RETAIN' | 'RETAIN' | 'PERSISTENT'
bool accept_retention(Parsing& p, Retention& retention) {
    const bool is_persistent = p.is(Word::name) && p.says("persistent");
    if (!is_persistent && !p.is(Word::retain_) && !p.is(Word::non_retain_)) return false;
    retention = p.is(Word::non_retain_) ? Retention::non_retain : Retention::retain;
    p.take();
    return true;
}

/// Var_Sections : ( Var_Section | Const_Section | Label_Section ) *
void parse_sections(Parsing& p, Pou& pou, Word end) {
    while (!p.is(end) && !p.is(Word::end_of_file)) {
        if (at_older_section(p, "const")) {
            pou.blocks.push_back(parse_constants(p));
            continue;
        }
        if (at_older_section(p, "label")) {
            parse_labels(p);
            continue;
        }
        const bool is_inst = p.is(Word::name) && p.here().first_in_line && p.says("var_inst");
        if (skip_section(p)) continue;
        const bool is_list = p.next(2).word == Word::colon || p.next(2).word == Word::comma;
        if (!is_inst && p.is_name(1) && is_list) respell(p, variable_words);
        const SectionWord* word = find_section(p.here().word);
        if (!word && !is_inst) return;
        const bool is_kept = is_inst && pou.kind == PouKind::method;
        if (is_inst && !is_kept && !stays(pou.kind)) refuse_static(p, pou.kind);
        DeclarationBlock block = parse_section(p, is_kept   ? Section::kept
                                                  : is_inst ? Section::local
                                                            : word->section);
        const bool is_external = block.section == Section::external;
        (is_external ? p.tree.globals : pou.blocks).push_back(std::move(block));
    }
}

/// Var_Section : Section_Word Var_Modifier * Var_Decl * 'END_VAR' ';' ?
///             | 'VAR_GLOBAL' 'RETAIN' ( Var_Decl | Path_Decl ) * 'END_VAR' ';' ?
/// Section_Word : 'VAR' | 'VAR_STAT' | 'VAR_INPUT' | 'VAR_OUTPUT' | 'VAR_IN_OUT' | 'VAR_TEMP'
///              | 'VAR_GLOBAL' | 'VAR_EXTERNAL'
DeclarationBlock parse_section(Parsing& p, Section section) {
    const Token opener = p.take();
    DeclarationBlock block;
    block.section = section;
    while (accept_modifier(p, block)) continue;
    p.section_left = false;
    const bool has_paths = section == Section::global && block.retention == Retention::retain;
    while (!p.section_left && !is_end(p.here().word) && !p.is(Word::end_of_file) && !p.at_pou() &&
           !find_section(p.here().word))
        if ((!has_paths || !skip_path(p)) &&
            (!p.source->dialect.is_loose || !p.accept(Word::semicolon)))
            parse_variables(p, block.declarations);
    for (Declaration* declared : block.declarations)
        if (block.retention != Retention::unsaid) declared->retention = block.retention;
    if (p.section_left) p.panic = false;
    if (!p.section_left) close(p, Word::end_var_, opener);
    p.accept(Word::semicolon);
    return block;
}

/// Var_Decl : ( Variable_List | Name Located_At | 'AT' Direct ) ':' Data_Type
///            ( 'R_EDGE' | 'F_EDGE' ) ? ( ':=' Var_Init ) ? ';'
///          | Name ':' Data_Type 'AT' Direct ( ':=' Var_Init ) ? ';'
/// Variable_List : Name ( ',' Name ) *
/// Without a name an address is its name. OpenPLC writes it behind the type. In CODESYS `REF=` may
/// stand for ':=' of a REFERENCE TO.
void parse_variables(Parsing& p, std::vector<Declaration*>& to) {
    const std::size_t first = p.at;
    const Word behind = p.next().word;
    if (!p.is_declared() && at_doomed_name(p) && respell(p, end_words)) return;
    if ((p.is(Word::begin_) && !p.is_declared()) ||
        (p.is_name() && (behind == Word::assign || behind == Word::open || behind == Word::dot)))
        return refuse_statement(p);
    const bool is_reserved =
        !p.is_name() && p.here().word < Word::end_of_file && behind == Word::colon;
    if (is_reserved && !p.source->has_no_bodies()) return refuse_reserved_name(p);
    std::vector<Token> names;
    if (p.is(Word::at_) && p.next().word == Word::direct) {
        names.push_back(p.next());  // it is named by its address
    } else {
        do names.push_back(is_reserved ? p.take() : expect_name(p, "the name of a variable"));
        while (p.accept(Word::comma));
    }
    Token at = parse_location(p, names);
    expect(p, Word::colon, "after the name");
    TypeText* type = parse_type(p);
    if (p.is(Word::at_) && p.next().word == Word::direct) at = parse_location(p, names);
    const bool is_edge = p.says("r_edge") || p.says("f_edge");
    const Token edge = is_edge ? p.take() : Token{};
    const bool refers = p.source->dialect.is_loose && p.accept(Word::reference_assign);
    Expression* initial = refers                   ? parse_expression(p)
                          : p.accept(Word::assign) ? parse_initials(p)
                          : is_of_caller(p, first) ? value_of_caller(p, *type)
                                                   : nullptr;
    if (!p.panic) end_statement(p);
    if (p.panic) return skip_declaration(p);
    const auto [unit, place] = unit_between(p, first, p.at);
    const std::string_view doc = comment_before(p, p.at, false);
    const bool is_path = has_attribute(p, first, "instance-path");
    const bool is_retained = has_attribute(p, first, "tcretain");
    for (const Token& name : names)
        to.push_back(&p.tree.declarations.emplace_back(
            Declaration{name, type, initial, at, edge, unit, place, doc, is_path,
                        is_retained ? Retention::retain : Retention::unsaid}));
}

}  // namespace lineshaft::st
