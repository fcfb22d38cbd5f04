#include <utility>

#include "runtime/st/syntax/grammar.hpp"
#include "runtime/st/syntax/remarks.hpp"

namespace lineshaft::st {

namespace {

/// Subrange : Expression '..' Expression
void parse_bounds(Parsing& p, TypeText& type) {
    Expression* from = parse_expression(p);
    if (!p.accept(Word::range)) expected(p, "..", "between the bounds");
    type.ranges.emplace_back(from, parse_expression(p));
}

/// Array_Spec : 'ARRAY' '[' ( Subrange ( ',' Subrange ) * | '*' ( ',' '*' ) * ) ']' 'OF' Data_Type
void parse_array(Parsing& p, TypeText& type) {
    type.kind = TypeText::Kind::array;
    expect(p, Word::open_bracket, "after ARRAY");
    const bool is_open = p.is(Word::times);
    do {
        if (!is_open)
            parse_bounds(p, type);
        else if (p.accept(Word::times))
            type.ranges.emplace_back(nullptr, nullptr);
        else
            expected(p, "*", "as in the dimension before");
    } while (p.accept(Word::comma));
    expect(p, Word::close_bracket, "after the bounds");
    expect(p, Word::of_, "before the type of the elements");
    type.element = parse_type(p);
}

/// Struct_Decl : 'STRUCT' 'OVERLAP' ? Var_Decl * 'END_STRUCT'
/// Union_Decl : 'UNION' Var_Decl * 'END_UNION'
void parse_structure(Parsing& p, TypeText& type, TypeText::Kind kind) {
    const Token opener = p.take();
    type.kind = kind;
    type.overlaps = p.says("overlap") && !p.is_declared() && p.next().word != Word::at_;
    if (type.overlaps) p.take();
    const Word end = kind == TypeText::Kind::union_ ? Word::end_union_ : Word::end_struct_;
    while (!p.panic && !p.is_spoiled && !is_end(p.here().word) && !p.is(Word::end_of_file) &&
           (!p.at_pou() || p.is_declared())) {
        if (p.here().word < Word::end_of_file && p.is_declared()) p.tokens[p.at].word = Word::name;
        parse_variables(p, type.members);
    }
    close(p, end, opener);
}

/// Enum_Spec : Enum_Values Name ?
/// Enum_Values : '(' Enum_Value ( ',' Enum_Value ) * ')'
/// Enum_Value : Name ( ':=' Expression ) ?
/// Init_Values : '(' ( Init_Value ( ',' Init_Value ) * ) ? ')'
/// Init_Value : Enum_Value | Expression
/// The name is that of the numbers' type, where none stands before. Behind a block's name these are
/// arguments of its FB_init.
void parse_enumeration(Parsing& p, TypeText& type) {
    type.kind = TypeText::Kind::enumeration;
    expect(p, Word::open);
    if (type.name.word != Word::end_of_file && p.accept(Word::close)) return;
    do {
        Argument& value = type.values.emplace_back();
        const Word behind = p.next().word;
        const bool is_alone =
            behind == Word::assign || behind == Word::comma || behind == Word::close;
        const bool is_named = type.name.word == Word::end_of_file || (p.is_name() && is_alone);
        if (is_named) value.name = expect_name(p, "the name of a value");
        if (!is_named || p.accept(Word::assign)) value.value = parse_expression(p);
    } while (p.accept(Word::comma));
    expect(p, Word::close, "after the values");
    if (p.is(Word::name) && type.name.word == Word::end_of_file) type.name = p.take();
}

/// Text_Length : '[' Expression ']' | '(' Expression ')'
Expression* parse_length(Parsing& p) {
    const Word end = p.take().word == Word::open_bracket ? Word::close_bracket : Word::close;
    Expression* length = parse_expression(p);
    expect(p, end, "after the length");
    return length;
}

/// `..` stands in the brackets.
bool has_range(const Parsing& p) {
    int open = 0;
    for (std::size_t i = 0; p.next(i).word != Word::end_of_file; ++i) {
        const Word word = p.next(i).word;
        if (word == Word::range) return true;
        open += (word == Word::open) - (word == Word::close);
        if (open == 0 || word == Word::semicolon) return false;
    }
    return false;
}

/// Type_Access : ( '_' '.' ) ? Qualified_Name
///             | 'STRING' Text_Length | 'WSTRING' Text_Length
///             | Name Init_Values | Name '[' Init_Values ( ',' Init_Values ) * ']'
///             | Name '(' Subrange ')'
///             | Qualified_Name Generic_Values Init_Values ?
/// CODESYS may write a '.' before it, as before a global variable.
void parse_named_type(Parsing& p, TypeText& type) {
    if (p.here().text == "_" && p.next().word == Word::dot) p.at += 2;
    if (at_name_behind_point(p)) p.take();
    type.name = parse_qualified_name(p, "a type");
    parse_generic_values(p, type.name);
    if (p.panic) return;
    const bool has_length = p.is(Word::open_bracket) || p.is(Word::open);
    const bool is_text =
        same_name(type.name.text, "string") || same_name(type.name.text, "wstring");
    if (is_text && has_length) {
        type.kind = TypeText::Kind::text;
        type.length = parse_length(p);
    } else if (p.is(Word::open_bracket) && p.next().word != Word::open) {
        refuse_length(p, type.name);
    } else if (p.is(Word::open_bracket) && p.next().word == Word::open) {
        type.kind =
            TypeText::Kind::enumeration;  // of an array's element: arguments of each FB_init
        type.values.push_back({.value = parse_initial(p)});
    } else if (p.is(Word::open)) {
        const Word behind = p.next(2).word;
        if ((p.is_name(1) &&
             (behind == Word::comma || behind == Word::assign || behind == Word::close)) ||
            !has_range(p))
            return parse_enumeration(p, type);
        p.take();
        type.kind = TypeText::Kind::subrange;
        parse_bounds(p, type);
        expect(p, Word::close, "after the bounds");
    }
}

/// `REF_TO`, `POINTER TO`, `REFERENCE TO`
bool at_reference(const Parsing& p) {
    const bool may_be = p.is(Word::pointer_) || (p.is(Word::name) && p.says("reference"));
    return p.is(Word::ref_to_) || (may_be && p.next().word == Word::to_);
}

/// Ref_Spec : ( 'REF_TO' | 'POINTER' 'TO' | 'REFERENCE' 'TO' ) Data_Type
void parse_reference(Parsing& p, TypeText& type) {
    type.kind = TypeText::Kind::reference;
    type.name = p.take();
    p.accept(Word::to_);
    type.element = parse_type(p);
}

}  // namespace

/// Data_Type_Decl : 'TYPE' ( Access_Spec | 'ABSTRACT' ) * Type_Decls 'END_TYPE' ';' ?
/// Type_Decls : ( Type_Decl ( ';' Type_Decl ) * ';' ? ) ?
/// Type_Decl : Name ( 'EXTENDS' Qualified_Name ) ? Attribute *
///             ( ':' Data_Type | Struct_Decl | Union_Decl ) ( ':=' Init ) ?
void parse_type_declarations(Parsing& p) {
    bool texts_are_names = has_attribute(p, p.at, "to_string");
    bool is_qualified_only = has_attribute(p, p.at, "qualified_only"),
         is_strict = has_attribute(p, p.at, "strict");
    std::string_view pack_mode = attribute_value(p, p.at, "pack_mode");
    const Token opener = p.take();
    const auto is_abstract = [&] { return p.is_name(1) || p.next().word == Word::end_type_; };
    while (accept_access(p) || (is_abstract() && p.accept(Word::abstract_))) continue;
    while (!is_end(p.here().word) && !p.is(Word::end_of_file) && !p.at_pou()) {
        TypeDeclaration declared;
        declared.texts_are_names = has_attribute(p, p.at, "to_string") || texts_are_names;
        texts_are_names = false;
        is_qualified_only |= has_attribute(p, p.at, "qualified_only");
        is_strict |= has_attribute(p, p.at, "strict");
        if (pack_mode.empty()) pack_mode = attribute_value(p, p.at, "pack_mode");
        declared.name = expect_name(p, "the name of a type");
        Token base;
        if (p.accept(Word::extends_)) base = parse_qualified_name(p, "a structure");
        parse_attributes(p);
        if (!p.is(Word::struct_) && !p.is(Word::union_)) expect(p, Word::colon, "after the name");
        declared.type = parse_type(p);
        declared.type->base = base;
        declared.type->is_qualified_only = std::exchange(is_qualified_only, false);
        declared.type->is_strict = std::exchange(is_strict, false);
        declared.type->pack_mode = std::exchange(pack_mode, {});
        if (p.accept(Word::assign)) declared.initial = parse_initial(p);
        if (!p.accept(Word::semicolon) && !p.is(Word::end_type_)) end_statement(p);
        if (p.panic) skip_declaration(p);
        p.tree.types.push_back(declared);
    }
    close(p, Word::end_type_, opener);
    p.accept(Word::semicolon);
}

/// Data_Type : Array_Spec | Struct_Decl | Union_Decl | Enum_Spec | Ref_Spec | Type_Access
TypeText* parse_type(Parsing& p) {
    const Level level(p);
    TypeText& type = p.tree.type_texts.emplace_back();
    const Token first = p.here();
    if (p.accept(Word::array_))
        parse_array(p, type);
    else if (p.is(Word::struct_))
        parse_structure(p, type, TypeText::Kind::structure);
    else if (p.is(Word::union_) && (p.is_name(1) || p.next().word == Word::end_union_))
        parse_structure(p, type, TypeText::Kind::union_);
    else if (p.is(Word::open))
        parse_enumeration(p, type);
    else if (at_reference(p))
        parse_reference(p, type);
    else
        parse_named_type(p, type);
    type.place = first.place.to(p.last().place);
    return &type;
}

}  // namespace lineshaft::st
