#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/grammar.hpp"
#include "runtime/st/syntax/parser.hpp"
#include "runtime/st/syntax/remarks.hpp"

namespace lineshaft::st {

namespace {

/// What B&R declares of its language's own: AND, ADR, with inputs of ANY.
bool is_of_language(const Parsing& p, const Pou& pou) {
    if (pou.kind != PouKind::function || !p.source->has_no_bodies()) return false;
    const auto is_any = [](const TypeText* type) {
        return type && type->kind == TypeText::Kind::name &&
               lower(type->name.text).starts_with("any");
    };
    return is_any(pou.result) ||
           std::ranges::any_of(pou.blocks, [&](const DeclarationBlock& block) {
               return std::ranges::any_of(block.declarations,
                                          [&](const Declaration* d) { return is_any(d->type); });
           });
}

bool at_attribute(const Cursor& p) {
    static constexpr std::string_view words[] = {
        "title", "author", "family", "name", "know_how_protect", "read_only", "unlinked"};
    if (p.is(Word::version_)) return true;
    const Word behind = p.next().word;
    const bool is_used = behind == Word::assign || behind == Word::dot || behind == Word::open ||
                         behind == Word::open_bracket;
    return p.is(Word::name) && !p.here().quoted && p.here().first_in_line && !is_used &&
           std::ranges::any_of(words, [&](std::string_view word) { return p.says(word); });
}

/// POU_Header : Using_Directive * Generic_Decl ? Pou_Bases Generic_Decl ? Attribute * Retained ?
///              Data_Block_Type ?
/// Data_Block_Type : ( Array_Spec | Struct_Decl | Type_Access ) ';' ?
/// Only a DATA_BLOCK has a type here, unless it stands behind a ':'; a name is always that.
void parse_header(Parsing& p, Pou& pou) {
    const bool has_using = p.is(Word::using_) && p.is_name(1);
    if (has_using) open_scope(p, pou.place.begin, p.scope ? p.scope->path : std::string_view());
    while (p.is(Word::using_) && p.is_name(1)) parse_using(p);
    parse_generic_constants(p, pou);
    parse_bases(p, pou);
    parse_generic_constants(p, pou);
    parse_attributes(p);
    accept_retention(p, pou.retention);
    if (pou.kind != PouKind::data_block) return;
    pou.base = std::exchange(pou.result, nullptr);
    const bool has_type =
        p.is(Word::struct_) || p.is(Word::array_) || (p.is_name() && !p.is(Word::begin_));
    if (pou.base || !has_type) return;
    pou.base = parse_type(p);
    p.accept(Word::semicolon);
}

/// A variable of this name outside of Siemens' languages, where BEGIN ends the declarations.
bool at_variable_begin(const Parsing& p) {
    using enum Word;
    static constexpr Word behind[] = {assign, plus_assign,  minus_assign, set_assign, reset_assign,
                                      open,   open_bracket, dot,          caret};
    return !p.source->dialect.begin_is_no_name &&
           std::ranges::find(behind, p.next().word) != std::end(behind);
}

bool may_have_parts(const Pou& pou) {
    return pou.kind == PouKind::function_block || pou.kind == PouKind::program ||
           pou.kind == PouKind::interface;
}

/// Action_Decl : 'ACTION' Name ':' ? Action_Body 'END_ACTION' ';' ?
/// Action_Body : Stmt_List ( Chart_Element Stmt_List ) *
Pou* parse_action(Parsing& p, PouKind kind) {
    const Token opener = p.take();
    Pou& action = p.tree.pous.emplace_back();
    action.kind = kind;
    action.is_action = true;
    action.name = expect_name(p, "the name of the ACTION");
    action.place = opener.place.to(action.name.place);
    p.accept(Word::colon);
    const bool is_in_body = std::exchange(p.is_in_body, true);
    parse_statements(p, action.body, Word::end_action_);
    while (p.at_chart() && kind == PouKind::method) {
        parse_chart_element(p, action);
        parse_statements(p, action.body, Word::end_action_);
    }
    if (p.at_chart()) refuse_chart(p);
    close(p, Word::end_action_, opener);
    p.is_in_body = is_in_body;
    p.accept(Word::semicolon);
    return &action;
}

/// With what the steps of its chart do themselves.
void add_action(Parsing& p, Pou& to) {
    Pou* action = parse_action(p, PouKind::method);
    to.methods.push_back(action);
    to.methods.insert(to.methods.end(), action->methods.begin(), action->methods.end());
    action->methods.clear();
}

/// A part of Declaration, an Action_Decl: it is of the block before it in its file; without one it
/// sees what all see, as B&R has it.
void parse_action_beside(Parsing& p) {
    const bool has_unit = !p.tree.units.empty() && may_have_parts(*p.tree.units.back()) &&
                          p.tree.units.back()->place.source == p.source.get();
    if (has_unit)
        add_action(p, *p.tree.units.back());
    else
        p.tree.units.push_back(parse_action(p, PouKind::function));
}

/// POU_Body : Stmt_List ( POU_Part Stmt_List ) *
/// POU_Part : POU | Prop_Decl | Action_Decl | Chart_Element | Var_Section
/// It is a METHOD, and only in a FUNCTION_BLOCK, a CLASS, an INTERFACE or a PROGRAM; so are the
/// others. Variables stand behind methods of a CLASS alone, as SIMATIC AX has it.
void parse_body(Parsing& p, Pou& pou, Word end) {
    for (;;) {
        if (pou.is_class && !pou.methods.empty()) parse_sections(p, pou, end);
        parse_statements(p, pou.body, end);
        if (!may_have_parts(pou)) return p.at_chart() ? refuse_chart(p) : void();
        if (p.at_method() && p.is(Word::property_))
            parse_property(p, pou.methods, pou.kind);
        else if (p.at_method())
            pou.methods.push_back(parse_pou(p));
        else if (p.at_chart())
            parse_chart_element(p, pou);
        else if (p.at_action())
            add_action(p, pou);
        else
            return;
    }
}

/// The attribute counts for the whole of a list, whose first section it stands before.
bool goes_on_qualified(const Parsing& p) {
    return p.last().word == Word::end_var_ && !p.tree.globals.empty() &&
           p.tree.globals.back().is_qualified_only;
}

/// A part of Declaration: a Var_Section of globals.
void parse_globals(Parsing& p) {
    const bool is_qualified_only = has_attribute(p, p.at, "qualified_only") || goes_on_qualified(p);
    DeclarationBlock block = parse_section(p, Section::global);
    const bool is_library = p.source->is_library() && p.scope;
    block.list = is_library ? p.scope->path : name_of_list(*p.source);
    block.is_qualified_only = is_qualified_only || is_library;
    p.tree.globals.push_back(std::move(block));
}

bool begins_statement(const Cursor& p) {
    static constexpr Word words[] = {Word::if_, Word::case_, Word::for_, Word::while_,
                                     Word::repeat_};
    static constexpr Word behind[] = {Word::assign, Word::open, Word::open_bracket, Word::dot};
    return std::ranges::find(words, p.here().word) != std::end(words) ||
           (p.is_name() && std::ranges::find(behind, p.next().word) != std::end(behind));
}

}  // namespace

std::string_view name_of_list(const Source& source) {
    if (!source.file->part.empty()) return source.file->part;
    std::string_view name = source.file->path;
    name.remove_prefix(name.find_last_of("/\\") + 1);
    return name.substr(0, name.rfind('.'));
}

/// Declaration : POU | Bare_Program | Action_Decl | Data_Type_Decl | Var_Section | Config_Decl
///             | Var_Config | Test
/// A METHOD stands within another unit, or behind it; variables beside units are VAR_GLOBAL or VAR,
/// which is the same there; a Test stands in a file of tests.
void parse_declaration(Parsing& p) {
    if (p.is(Word::end_of_file) || refuse_simotion(p)) return;
    if (p.at_method()) return parse_late_method(p);
    if (p.at_pou() && !p.is(Word::method_)) {
        Pou* pou = parse_pou(p);
        return is_of_language(p, *pou) ? void() : p.tree.units.push_back(pou);
    }
    if (p.is(Word::type_)) return parse_type_declarations(p);
    if (at_bare_program(p)) return parse_bare_program(p);
    if (p.is(Word::var_global_) || p.is(Word::var_)) return parse_globals(p);
    if (p.is(Word::configuration_)) return parse_configuration(p);
    if (p.at_action()) return parse_action_beside(p);
    if (at_var_config(p)) return parse_var_config(p);
    if (p.is_name(1) && respell(p, declaration_words)) return parse_declaration(p);
    const bool is_tests = p.source->kind == SourceKind::tests;
    if (p.at_test() || (is_tests && p.is(Word::test_))) return parse_test(p);
    if (is_end(p.here().word) && p.unclosed_at < p.at) {
        p.take();
        p.accept(Word::semicolon);
        return;
    }
    if (begins_statement(p))
        fail(p, code::something_else_expected, p.here().place,
             "a statement stands outside of all blocks",
             is_tests ? "put it between TEST 'name' and END_TEST"
                      : "put PROGRAM Main and its VAR ... END_VAR before it, and END_PROGRAM "
                        "behind it");
    else
        expected(p, "a FUNCTION_BLOCK, FUNCTION, PROGRAM, DATA_BLOCK or TYPE");
    p.take();
}

/// POU : POU_Word Pou_Modifier * Name ( ':' Result ';' ? ) ? POU_Header Var_Sections 'BEGIN' ?
///       POU_Body POU_End ';' ?
/// POU_Word : 'PROGRAM' | 'ORGANIZATION_BLOCK' | 'FUNCTION_BLOCK' | 'FUNCTION' | 'DATA_BLOCK'
///          | 'CLASS' | 'INTERFACE' | 'METHOD'
/// POU_End : 'END_PROGRAM' | 'END_ORGANIZATION_BLOCK' | 'END_FUNCTION_BLOCK' | 'END_FUNCTION'
///         | 'END_DATA_BLOCK' | 'END_CLASS' | 'END_INTERFACE' | 'END_METHOD'
Pou* parse_pou(Parsing& p) {
    const PouWords& words = *find_pou(p.here().word);
    const std::string_view doc = comment_before(p, p.at, true);
    const std::size_t first = p.at;
    const Token opener = p.take();
    Pou& pou = p.tree.pous.emplace_back();
    pou.kind = words.kind;
    pou.doc = doc;
    pou.number = block_number(p, first);
    pou.is_class = opener.word == Word::class_;
    pou.follows_init = opener.word == Word::method_ && has_attribute(p, first, "call_after_init");
    pou.copying = has_attribute(p, first, "no_assign")           ? Copying::refused
                  : has_attribute(p, first, "no_assign_warning") ? Copying::warned
                                                                 : Copying::allowed;
    parse_pou_modifiers(p, pou);
    const bool is_operator =
        p.source->has_no_bodies() && !p.is_name();  // B&R declares AND and its like
    pou.name = is_operator ? p.take()
                           : expect_name(p, fmt::format("the name of the {}", shown(opener.word)));
    pou.place = opener.place.to(pou.name.place);
    if (p.is(Word::less)) refuse_type_parameters(p);
    if (p.accept(Word::colon)) parse_result(p, pou);
    if (p.panic) skip_line(p);
    if (pou.result) p.accept(Word::semicolon);
    parse_header(p, pou);
    if (p.source->dialect.is_loose) p.accept(Word::semicolon);
    if (pou.doc.empty()) pou.doc = comment_before(p, p.at, true);
    parse_sections(p, pou, words.end);
    if (std::exchange(p.is_spoiled, false)) return skip_past(p, words.end), &pou;
    if (!at_variable_begin(p)) p.accept(Word::begin_);
    p.is_in_body = true;
    parse_body(p, pou, words.end);
    for (const Token& region : std::exchange(p.regions, {}))
        tell(p, code::something_else_expected, region.place, "the REGION does not end",
             "it ends with END_REGION");
    close(p, words.end, opener);
    p.is_in_body = false;
    p.accept(Word::semicolon);
    if (p.panic) skip_past(p, words.end);
    if (pou.is_generic) keep_generic(p, pou, first);
    return &pou;
}

/// Result : Data_Type ( ':=' Init ) ?
/// What it begins with is assigned before the rest of the body, which an interface has none of.
void parse_result(Parsing& p, Pou& pou) {
    pou.result = parse_type(p);
    if (p.panic || !p.is(Word::assign)) return;
    Statement* first = p.make(Statement::Kind::assign, p.take());
    first->target = p.make(Expression::Kind::name, pou.name);
    first->value = parse_initial(p);
    first->place = first->value->place;
    pou.body.push_back(first);
}

/// Access_Spec : 'PRIVATE' | 'PUBLIC' | 'PROTECTED' | 'INTERNAL'
bool accept_access(Parsing& p, Access* said) {
    static constexpr std::pair<Word, Access> words[] = {{Word::private_, Access::private_},
                                                        {Word::public_, Access::public_},
                                                        {Word::protected_, Access::protected_},
                                                        {Word::internal_, Access::internal_}};
    if (p.is_declared()) return false;
    for (const auto& [word, access] : words) {
        if (!p.accept(word)) continue;
        if (said) *said = access;
        return true;
    }
    return false;
}

/// Attribute : 'VERSION' ':' Real
///           | ( 'VERSION' | 'TITLE' | 'AUTHOR' | 'FAMILY' | 'NAME' | 'KNOW_HOW_PROTECT'
///             | 'READ_ONLY' | 'UNLINKED' ) Any_Token *
/// All but VERSION are names elsewhere, and begin their line here, to whose end it goes.
void parse_attributes(Parsing& p) {
    while (at_attribute(p)) {
        const bool is_number = p.next().word == Word::colon && p.next(2).word == Word::real;
        if (p.is(Word::version_) && is_number && p.next(3).word != Word::dot)
            p.at += 3;
        else
            skip_line(p);
    }
}

}  // namespace lineshaft::st
