#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/grammar.hpp"
#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

namespace {

bool begins_statement(const Token& token, const Token& behind) {
    using enum Word;
    static constexpr Word words[] = {if_, case_, for_, while_, repeat_, return_, region_};
    static constexpr Word behind_names[] = {assign,       open,        dot,
                                            open_bracket, caret,       set_assign,
                                            reset_assign, plus_assign, minus_assign};
    if (std::ranges::find(words, token.word) != std::end(words)) return true;
    return (is_name(token.word) || token.word == direct) &&
           std::ranges::find(behind_names, behind.word) != std::end(behind_names);
}

bool begins_section(Word word) {
    return find_section(word) && word != Word::var_global_;
}

/// A letter or '_' first, then those and digits.
std::string name_of_program(const Source& source) {
    std::string name(name_of_list(source));
    for (char& c : name)
        if (!is_letter(c) && !is_digit(c)) c = '_';
    return name.empty() || is_digit(name.front()) ? "_" + name : name;
}

}  // namespace

bool at_bare_program(Parsing& p) {
    const bool follows_unit =
        !p.tree.units.empty() && p.tree.units.back()->place.source == p.source.get();
    const bool may_be = p.source->kind == SourceKind::program && !p.was_wrong && !follows_unit;
    if (!may_be || p.at < p.sections_until) return false;
    std::size_t ahead = 0;
    while (begins_section(p.next(ahead).word)) {
        while (!is_end(p.next(ahead).word) && p.next(ahead).word != Word::end_of_file) ++ahead;
        ++ahead;
        if (p.next(ahead).word == Word::semicolon) ++ahead;
    }
    p.sections_until = p.at + ahead;
    return begins_statement(p.next(ahead), p.next(ahead + 1));
}

/// Bare_Program : Var_Sections Stmt_List 'END_PROGRAM' ? ';' ?
/// What an editor shows of a program, without its first line; its name is the file's.
void parse_bare_program(Parsing& p) {
    const Token first = p.here();
    Pou& pou = p.tree.pous.emplace_back();
    pou.kind = PouKind::program;
    pou.name = first;
    pou.name.word = Word::name;
    pou.name.text = p.tree.names.emplace_back(name_of_program(*p.source));
    pou.place = first.place;
    p.out.warn(code::something_else_expected, first.place.mark(),
               "these statements stand in no PROGRAM",
               fmt::format("they are PROGRAM {}, by the file's name", pou.name.text));
    parse_sections(p, pou, Word::end_program_);
    p.is_in_body = true;
    parse_statements(p, pou.body, Word::end_program_);
    p.is_in_body = false;
    p.accept(Word::end_program_);
    p.accept(Word::semicolon);
    p.tree.units.push_back(&pou);
}

}  // namespace lineshaft::st
