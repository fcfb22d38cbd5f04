#include "runtime/st/syntax/mistakes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/st/syntax/grammar.hpp"
#include "runtime/st/syntax/literals.hpp"

namespace lineshaft::st {

namespace {

std::string another_name(const Cursor& p) {
    if (p.here().place.source && p.here().place.dialect().is_loose) return "take another name";
    return fmt::format("take another name, or write it in quotes: \"{}\"", p.here().text);
}

/// Signs and words that touch each other, or have a value before them.
std::string habit_of_signs(const Cursor& p) {
    const bool touches = p.last().place.end == p.here().place.begin;
    const bool touches_next = p.here().place.end == p.next().place.begin;
    const auto is_pair = [&](Word word) { return p.is(word) && p.last().word == word && touches; };
    if (is_pair(Word::equal)) return "write '=' to compare";
    if (is_pair(Word::ampersand)) return "write AND";
    if (is_pair(Word::less)) return "write SHL(value, bits)";
    if (is_pair(Word::greater)) return "write SHR(value, bits)";
    const bool before_pair = p.next().word == p.here().word && touches_next;
    if (before_pair && p.is(Word::plus)) return "write 'name += 1;'";
    if (before_pair && p.is(Word::minus)) return "write 'name -= 1;'";
    const bool before_number = p.next().word == Word::integer && touches_next;
    if (p.is(Word::comma) && p.last().word == Word::integer && before_number)
        return "write a decimal point: 1.5";
    if (p.says("step")) return "write BY";
    if (p.says("downto"))
        return p.next(2).word == Word::do_ ? fmt::format("write 'TO {} BY -1'", p.next().text)
                                           : "write TO, and 'BY -1' before DO";
    const bool is_joined = p.last().word == Word::and_ || p.last().word == Word::or_;
    if (is_joined && p.here().word >= Word::less && p.here().word <= Word::unequal)
        return "repeat what is compared: a > 1 AND a < 5";
    if (p.is(Word::dot) && before_number) return fmt::format("write 0.{}", p.next().text);
    if (!p.is(Word::name) || p.last().word != Word::integer || !touches) return {};
    const std::string_view number = p.last().text, behind = p.here().text;
    if (number == "0" && (behind.starts_with('x') || behind.starts_with('X')))
        return fmt::format("write 16#{}", behind.substr(1));
    if (read_duration(fmt::format("{}{}", number, behind)))
        return fmt::format("write T#{}{}", number, behind);
    return {};
}

/// What stands in Structured Text of Rockwell and of Schneider's Control Expert alone.
std::string_view habit_of_vendor(const Cursor& p) {
    const Word before = p.last().word, behind = p.next().word;
    const bool touches =
        p.last().place.end == p.here().place.begin && p.here().place.end == p.next().place.begin;
    if (!touches) return {};
    if (p.is(Word::assign) && before == Word::open_bracket && behind == Word::close_bracket)
        return "this is Rockwell's: write ':='";
    if (p.is(Word::open_bracket) && before == Word::dot)
        return "this is Rockwell's: of word.[n] write (SHR(word, n) AND 1) = 1";
    if (!p.is(Word::colon)) return {};
    if (before == Word::direct && behind == Word::integer)
        return "this is Control Expert's: declare an array there, x AT %MW10 : ARRAY[0..4] OF INT";
    if (before == Word::name && (behind == Word::integer || behind == Word::name))
        return "this is a module of Rockwell's: declare a variable for it, and name that";
    return {};
}

}  // namespace

std::string habit(const Parsing& p) {
    if (const std::string_view of_vendor = habit_of_vendor(p); !of_vendor.empty())
        return std::string(of_vendor);
    if (std::string of_signs = habit_of_signs(p); !of_signs.empty()) return of_signs;
    if (p.is_in_body && p.is_name() && find_called(elementary_names, p.last().text))
        return "variables are declared in VAR ... END_VAR";
    if (p.says("var_constant")) return "write VAR CONSTANT";
    if (p.is(Word::assign) && !p.is_in_body)
        return "statements stand in a PROGRAM, FUNCTION_BLOCK or FUNCTION";
    const bool is_reserved = !p.is_name() && p.here().word < Word::end_of_file;
    return is_reserved && (p.is_declared() || p.next().word == Word::assign) ? another_name(p) : "";
}

bool at_power(const Parsing& p) {
    return p.is(Word::caret) && (p.next().word == Word::integer || p.next().word == Word::real);
}

bool refuse_unsupported(Parsing& p) {
    if (at_power(p)) {
        fail(p, code::something_else_expected, p.here().place, "'^' is not a power", "write '**'");
        return true;
    }
    if (!p.is(Word::test_) && !p.is(Word::setup_) && !p.is(Word::teardown_)) return false;
    fail(p, code::not_supported, p.here().place, "TESTs in a program are not supported",
         "put them into a file for 'lineshaft test'");
    return true;
}

void refuse_chart(Parsing& p) {
    tell(p, code::wrong_place, p.here().place, "a FUNCTION or METHOD has no steps",
         "a chart keeps its steps from scan to scan: write it in a FUNCTION_BLOCK or PROGRAM");
    while (!p.is(Word::end_of_file) && !ends_pou(p.here().word)) p.take();
}

bool skip_section(Parsing& p) {
    if (!p.is(Word::var_access_)) return false;
    p.out.warn(code::not_supported, p.here().place.mark(), "access paths are not taken",
               "others name a variable by its block: block.variable");
    skip_past(p, Word::end_var_);
    p.accept(Word::semicolon);
    return true;
}

void refuse_static(Parsing& p, PouKind kind) {
    fail(p, code::not_supported, p.here().place,
         fmt::format("{} is not supported here", p.here().place.text()),
         kind == PouKind::function ? "what is to stay makes a FUNCTION_BLOCK"
                                   : "declare it in the VAR of the block");
}

void refuse_shared_place(Parsing& p) {
    fail(p, code::something_else_expected, p.here().place, "several variables at one address",
         "declare each by itself, with an address of its own");
}

void refuse_statement(Parsing& p) {
    fail(p, code::something_else_expected, p.here().place,
         fmt::format("expected END_VAR before {}", found(p)),
         "declarations look like 'name : INT := 1;', and statements follow END_VAR");
    p.unclosed_at = p.at;
    p.section_left = true;
}

void refuse_reserved_name(Parsing& p) {
    tell(p, code::something_else_expected, p.here().place,
         fmt::format("'{}' is a word of the language, not a name", p.here().text), another_name(p));
    p.is_spoiled = p.section_left = true;
    p.unclosed_at = p.at;
}

void refuse_length(Parsing& p, const Token& type) {
    const bool is_known = find_called(elementary_names, type.text);
    fail(p, code::something_else_expected, type.place,
         fmt::format("'{}' is not a type {}", type.text, is_known ? "with a length" : "of texts"),
         fmt::format("{}an array ARRAY[0..9] OF {}",
                     is_known ? "write " : "write STRING[20] or WSTRING[20], ", type.text));
}

bool refuse_simotion(Parsing& p) {
    const bool is_unit =
        p.is(Word::name) && p.says("unit") && p.is_name(1) && p.next(2).word == Word::semicolon;
    if (!is_unit && !(p.is(Word::interface_) && !p.is_name(1) && p.next().first_in_line))
        return false;
    fail(p, code::not_supported, p.here().place,
         "this is a unit of SIMOTION, whose INTERFACE and IMPLEMENTATION are not read",
         "leave UNIT, INTERFACE, IMPLEMENTATION and the names in INTERFACE out, and keep what they "
         "enclose");
    while (!p.is(Word::end_of_file)) p.take();
    return true;
}

void refuse_type_parameters(Parsing& p) {
    tell(p, code::not_supported, p.here().place, "a unit with types as parameters is not supported",
         "write one for each type that it is called with, or FUNCTIONs of one name with inputs of "
         "different types");
    while (!p.is(Word::greater) && !p.is(Word::end_of_file) && !p.next().first_in_line) p.take();
    p.take();
}

void turn_modifiers(Tokens& tokens, Diagnostics& out) {
    constexpr Word modifiers[] = {Word::private_,  Word::public_, Word::protected_, Word::internal_,
                                  Word::abstract_, Word::final_,  Word::override_};
    const auto is_modifier = [&](const Token& token) {
        return std::ranges::find(modifiers, token.word) != std::end(modifiers);
    };
    auto& all = tokens.tokens;
    for (auto first = all.begin(); first != all.end(); ++first) {
        if (!first->first_in_line || !is_modifier(*first)) continue;
        const auto word = std::find_if_not(first, all.end(), is_modifier);
        const bool begins = find_pou(word->word) || word->word == Word::property_;
        if (!begins || word->first_in_line || !is_name((word + 1)->word)) continue;
        out.warn(code::something_else_expected, first->place.mark(),
                 fmt::format("'{}' stands before {}", first->place.text(), shown(word->word)),
                 fmt::format("write {} {}", shown(word->word), first->place.text()));
        std::rotate(first, word, word + 1);
        std::swap(first->first_in_line, (first + 1)->first_in_line);
        first = word;
    }
}

void refuse_comparison(Parsing& p) {
    tell(p, code::something_else_expected, p.here().place, "'=' compares and does not assign",
         "write ':='");
    p.take();
    parse_expression(p);
    end_statement(p);
}

void refuse_returned(Parsing& p) {
    const Place word = p.last().place, first = p.here().place;
    parse_expression(p);
    if (p.panic) return;
    const Pou* pou = p.is_in_test || p.tree.pous.empty() ? nullptr : &p.tree.pous.back();
    const std::string_view text = first.to(p.last().place).text();
    const bool is_long = text.size() > 40 || text.find('\n') != text.npos;
    tell(p, code::something_else_expected, word, "RETURN has no value",
         pou && pou->result
             ? fmt::format("write '{} := {}; RETURN;'", pou->name.text, is_long ? "..." : text)
             : "assign it to a VAR_OUTPUT, and write 'RETURN;'");
    end_statement(p);
}

void refuse_assignment(Parsing& p) {
    if (p.source->dialect.is_loose)
        tell(p, code::not_supported, p.here().place,
             "an assignment is no value where it is not done in each case, once and first",
             "assign it in a statement of its own");
    else
        tell(p, code::something_else_expected, p.here().place, "':=' assigns and does not compare",
             "write '='");
    p.take();
    parse_expression(p);
}

namespace {

/// `LD a`, `CAL timer(IN := a)`
bool at_instruction(const Parsing& p) {
    const bool is_first = p.says("ld") || p.says("ldn") || p.says("cal");
    const Word next = p.next().word;
    const bool is_operand = p.is_name(1) || next == Word::direct || next == Word::integer;
    return is_first && p.here().first_in_line && is_operand && !p.next().first_in_line;
}

/// `_LD_BODY`, as CoDeSys 2.3 exports a body that is drawn: `LD`. Empty: it is none.
std::string_view drawn_in(const Parsing& p) {
    constexpr std::string_view words[] = {"_ld_body", "_fbd_body", "_cfc_body"};
    constexpr std::string_view languages[] = {"LD", "FBD", "CFC"};
    const auto* it = std::ranges::find_if(words, [&](auto word) { return p.says(word); });
    return it == std::end(words) ? std::string_view() : languages[it - std::begin(words)];
}

void skip_body(Parsing& p) {
    while (!p.is(Word::end_network_) && !is_end(p.here().word) && !p.is(Word::end_of_file))
        p.take();
    p.panic = false;
}

}  // namespace

bool refuse_other_language(Parsing& p) {
    const bool is_rung = p.says("rung") && (p.is_name(1) || p.next().word == Word::prefix);
    const std::string_view language = drawn_in(p);
    if (is_rung)
        fail(p, code::not_supported, p.here().place, "networks in LAD and FBD are not supported",
             "convert the network to SCL");
    else if (!language.empty())
        fail(p, code::not_supported, p.here().place,
             fmt::format("this body is drawn in {}, which is not read from a text", language),
             "export the project as PLCopen XML from CODESYS 3, where it is read, or write the "
             "body in Structured Text");
    else if (at_instruction(p))
        fail(p, code::not_supported, p.here().place,
             "this body is an instruction list, which is not read here",
             "keep it in a file without TESTs, or write the body in Structured Text");
    else
        return false;
    skip_body(p);
    return true;
}

void refuse_value(Parsing& p, const Expression& value) {
    if (p.is(Word::semicolon) || p.here().first_in_line)
        fail(p, code::something_else_expected, value.place, "this does nothing",
             p.cases > 0 ? "a value of CASE has a ':' behind it, a call '()'"
                         : "write 'name := value;', or a call 'name();'");
    else
        expected(p, ":=", "or '('");
}

bool refuse_semicolon(Parsing& p) {
    const Word behind = p.next(2).word;
    const bool is_wrong = p.is(Word::semicolon) && p.is_name(1) && !p.next().first_in_line &&
                          (behind == Word::assign || behind == Word::output);
    if (!is_wrong) return false;
    for (std::size_t i = 3; p.next(i).word != Word::close; ++i)  // else the call was not closed
        if (p.next(i).word == Word::end_of_file || p.next(i).first_in_line) return false;
    tell(p, code::something_else_expected, p.here().place, "expected ')' or ',', found ';'",
         "arguments are joined by ','");
    p.take();
    return true;
}

}  // namespace lineshaft::st
