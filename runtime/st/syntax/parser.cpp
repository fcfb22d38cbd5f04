#include "runtime/st/syntax/parser.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

constexpr int deepest = 200;
constexpr int longest_chain = 2000;

struct Unsupported {
    Word word;
    std::string_view what, instead;
};

constexpr Unsupported unsupported[] = {
    {Word::abstract_, "abstract blocks are", "leave it out, and write the whole block"},
    {Word::class_, "classes are", "write a FUNCTION_BLOCK with METHODs"},
    {Word::interface_, "interfaces are", "write a FUNCTION_BLOCK with METHODs"},
    {Word::namespace_, "namespaces are", "put the namespace before its blocks' names: Lib_Block"},
    {Word::using_, "namespaces are", "leave it out, all sources see each other"},
    {Word::extends_, "inheritance is", "declare an instance of the other block and call it"},
    {Word::implements_, "interfaces are", "leave it out, and call the block by its own type"},
    {Word::property_, "properties are", "write a METHOD, or a VAR_OUTPUT"},
    {Word::action_, "actions are", "write a METHOD"},
    {Word::super_, "inheritance is", "declare an instance of the other block and call it"},
    {Word::goto_, "GOTO is", "write IF, CASE, EXIT or RETURN"},
    {Word::ref_to_, "references are", "pass the variable as VAR_IN_OUT"},
    {Word::pointer_, "pointers are", "pass the variable as VAR_IN_OUT, or use an index"},
    {Word::reference_assign, "references are", "pass the variable as VAR_IN_OUT"},
    {Word::caret, "pointers are", "pass the variable as VAR_IN_OUT, and leave '^' out"},
    {Word::var_access_, "access paths are", "declare the variable in VAR_GLOBAL"},
    {Word::direct, "direct addresses are", "declare a VAR_INPUT or VAR_OUTPUT and wire it"},
    {Word::override_, "inheritance is", "leave it out"},
    {Word::final_, "inheritance is", "leave it out"},
    {Word::test_, "TESTs in a program are", "put them into a file for 'lineshaft test'"},
    {Word::setup_, "TESTs in a program are", "put them into a file for 'lineshaft test'"},
    {Word::teardown_, "TESTs in a program are", "put them into a file for 'lineshaft test'"},
};

/// Words that are names wherever a name may stand.
constexpr Word soft_words[] = {
    Word::abstract_, Word::version_,    Word::test_,      Word::setup_,
    Word::teardown_, Word::action_,     Word::class_,     Word::final_,
    Word::at_,       Word::internal_,   Word::using_,     Word::property_,
    Word::network_,  Word::method_,     Word::override_,  Word::interface_,
    Word::type_,     Word::namespace_,  Word::begin_,     Word::pointer_,
    Word::private_,  Word::public_,     Word::protected_, Word::configuration_,
    Word::super_,    Word::implements_, Word::union_};

struct PouWords {
    Word begin, end;
    PouKind kind;
};

constexpr PouWords pou_words[] = {
    {Word::program_, Word::end_program_, PouKind::program},
    {Word::organization_block_, Word::end_organization_block_, PouKind::program},
    {Word::function_block_, Word::end_function_block_, PouKind::function_block},
    {Word::function_, Word::end_function_, PouKind::function},
    {Word::data_block_, Word::end_data_block_, PouKind::data_block},
    {Word::method_, Word::end_method_, PouKind::method}};

struct SectionWord {
    Word word;
    Section section;
};

constexpr SectionWord section_words[] = {
    {Word::var_, Section::local},         {Word::var_stat_, Section::local},
    {Word::var_input_, Section::input},   {Word::var_output_, Section::output},
    {Word::var_in_out_, Section::in_out}, {Word::var_temp_, Section::temp},
    {Word::var_global_, Section::global}, {Word::var_external_, Section::external}};

// That may be spelt wrong where they begin or end something.
constexpr Word declaration_words[] = {Word::program_,        Word::organization_block_,
                                      Word::function_block_, Word::function_,
                                      Word::data_block_,     Word::type_};
constexpr Word variable_words[] = {Word::var_,        Word::var_stat_, Word::var_input_,
                                   Word::var_output_, Word::var_temp_, Word::var_in_out_};
constexpr Word end_words[] = {Word::end_var_, Word::end_struct_, Word::end_type_};
constexpr Word statement_words[] = {Word::if_,
                                    Word::case_,
                                    Word::for_,
                                    Word::while_,
                                    Word::repeat_,
                                    Word::exit_,
                                    Word::continue_,
                                    Word::return_,
                                    Word::else_,
                                    Word::elsif_,
                                    Word::until_,
                                    Word::end_if_,
                                    Word::end_case_,
                                    Word::end_for_,
                                    Word::end_while_,
                                    Word::end_repeat_,
                                    Word::end_function_,
                                    Word::end_function_block_,
                                    Word::end_program_,
                                    Word::end_method_,
                                    Word::end_organization_block_,
                                    Word::end_data_block_};

struct Binary {
    Word word;
    int binding;
};

// IEC 61131-3:2013, table 71.
constexpr Binary binaries[] = {{Word::power, 8},     {Word::times, 7},
                               {Word::divided, 7},   {Word::mod_, 7},
                               {Word::plus, 6},      {Word::minus, 6},
                               {Word::less, 5},      {Word::less_or_equal, 5},
                               {Word::greater, 5},   {Word::greater_or_equal, 5},
                               {Word::equal, 4},     {Word::unequal, 4},
                               {Word::and_, 3},      {Word::ampersand, 3},
                               {Word::and_then_, 3}, {Word::xor_, 2},
                               {Word::or_, 1},       {Word::or_else_, 1}};
constexpr int power_binding = binaries[0].binding;

bool is_end(Word word) {
    return word >= Word::end_action_ && word <= Word::end_while_;
}

const PouWords* find_pou(Word word) {
    const auto* it = std::ranges::find(pou_words, word, &PouWords::begin);
    return it == std::end(pou_words) ? nullptr : it;
}

/// One class, though large: each rule of the grammar is a function, and they share the place in the
/// tokens and whether a mistake is still being recovered from.
class Parser {
  public:
    Parser(Tokens tokens, Tree& tree, Diagnostics& out)
        : is_tests_(tokens.source->kind == SourceKind::tests),
          tokens_(std::move(tokens.tokens)),
          pragmas_(std::move(tokens.pragmas)),
          comments_(std::move(tokens.comments)),
          mistakes_(std::move(tokens.mistakes)),
          tree_(tree),
          out_(out) {}

    void read() {
        do read_or_lose();
        while (!is(Word::end_of_file));
        if (fixture_) tree_.units.push_back(fixture_);
    }

  private:
    const Token& here() const { return tokens_[at_]; }
    const Token& next(std::size_t ahead = 1) const {
        return tokens_[std::min(at_ + ahead, tokens_.size() - 1)];
    }
    const Token& last() const { return tokens_[at_ == 0 ? 0 : at_ - 1]; }
    bool is(Word word) const { return here().word == word; }
    bool is_name() const { return is_name(here()); }
    static bool is_name(const Token& token) {
        return token.word == Word::name ||
               std::ranges::find(soft_words, token.word) != std::end(soft_words);
    }
    /// `METHOD` may be the name of a variable.
    bool at_pou() const {
        return is(Word::method_) ? is_name(next()) : find_pou(here().word) != nullptr;
    }
    const Token& take() { return is(Word::end_of_file) ? here() : tokens_[at_++]; }

    bool accept(Word word) {
        if (panic_ || !is(word)) return false;
        take();
        return true;
    }

    bool expect(Word word, std::string_view where = {}) {
        if (accept(word)) return true;
        if (respell({&word, 1})) return take(), true;
        expected(shown(word), where);
        return false;
    }

    /// Where a name cannot stand: it is told as one of the words that is spelt wrong, and taken as
    /// that.
    bool respell(std::span<const Word> words) {
        if (panic_ || !is(Word::name) || here().quoted) return false;
        std::vector<std::string> names;
        for (const Word word : words) names.emplace_back(shown(word));
        const auto found = nearest(here().text, names);
        if (found.empty()) return false;
        tell("L0902", here().place, fmt::format("'{}' is not a word of the language", here().text),
             fmt::format("write {}", found.front()));
        tokens_[at_].word = words[static_cast<std::size_t>(std::ranges::find(names, found.front()) -
                                                           names.begin())];
        return true;
    }

    /// What follows can follow neither a variable nor a call.
    bool at_doomed_name() const {
        if (!is(Word::name)) return false;
        const Token& behind = next();
        if (behind.word == Word::semicolon || behind.first_in_line) return true;
        if (behind.word != Word::open)
            return is_name(behind) || behind.word == Word::integer || behind.word == Word::not_ ||
                   is_end(behind.word);
        int open = 0;
        for (std::size_t i = 1; at_ + i < tokens_.size(); ++i) {
            const Word word = next(i).word;
            open += (word == Word::open) - (word == Word::close);
            if (word == Word::semicolon) return false;
            if (open > 0 || next(i + 1).first_in_line) continue;
            const Word then = next(i + 1).word;
            return then == Word::then_ || then == Word::do_ || then == Word::of_;
        }
        return false;
    }

    void expected(std::string_view what, std::string_view where = {}) {
        if (panic_ || refuse_unsupported()) return;
        is_wrong_ = true;
        panic_ = unclosed_at_ == at_ || follows_mistake();
        const char first = what.front();
        const bool is_word = (first >= 'A' && first <= 'Z') || (first >= 'a' && first <= 'z');
        fail("L0902", here().place,
             fmt::format("expected {0}{1}{0}{2}{3}, found {4}", is_word ? "" : "'", what,
                         where.empty() ? "" : " ", where, found()),
             habit());
    }

    /// The lexer left something out just before.
    bool follows_mistake() const {
        const std::string_view before = here().place.source->text().substr(0, last().place.begin);
        const std::size_t line = before.rfind('\n') + 1;
        return std::ranges::any_of(
            mistakes_, [&](std::uint32_t at) { return at >= line && at <= here().place.begin; });
    }

    /// What is written here in other languages.
    std::string habit() const {
        const bool touches = last().place.end == here().place.begin;
        const auto is_pair = [&](Word word) { return is(word) && last().word == word && touches; };
        if (is_pair(Word::equal)) return "write '=' to compare";
        if (is_pair(Word::ampersand)) return "write AND";
        if (is_pair(Word::less)) return "write SHL(value, bits)";
        if (is_pair(Word::greater)) return "write SHR(value, bits)";
        const bool before_pair =
            next().word == here().word && here().place.end == next().place.begin;
        if (before_pair && is(Word::plus)) return "write 'name += 1;'";
        if (before_pair && is(Word::minus)) return "write 'name -= 1;'";
        const bool touches_next = here().place.end == next().place.begin;
        if (is(Word::comma) && last().word == Word::integer && next().word == Word::integer &&
            touches_next)
            return "write a decimal point: 1.5";
        if (same_name(here().text, "step")) return "write BY";
        const bool is_joined = last().word == Word::and_ || last().word == Word::or_;
        if (is_joined && here().word >= Word::less && here().word <= Word::unequal)
            return "repeat what is compared: a > 1 AND a < 5";
        if (is(Word::dot) && next().word == Word::integer && touches_next)
            return fmt::format("write 0.{}", next().text);
        if (is(Word::name) && last().word == Word::integer && touches) {
            const std::string_view number = last().text, behind = here().text;
            if (number == "0" && (behind.starts_with('x') || behind.starts_with('X')))
                return fmt::format("write 16#{}", behind.substr(1));
            if (read_duration(fmt::format("{}{}", number, behind)))
                return fmt::format("write T#{}{}", number, behind);
        }
        if (is_in_body_ && is_name() && find_elementary(lower(last().text)))
            return "variables are declared in VAR ... END_VAR";
        if (is(Word::assign) && !is_in_body_)
            return "statements stand in a PROGRAM, FUNCTION_BLOCK or FUNCTION";
        const bool is_reserved = !is_name() && here().word < Word::end_of_file;
        return is_reserved && (is_declared() || next().word == Word::assign) ? another_name() : "";
    }

    std::string another_name() const {
        return fmt::format("take another name, or write it in quotes: \"{}\"", here().text);
    }

    std::string found() const {
        const std::string_view text = here().place.text();
        return is(Word::end_of_file) ? std::string(shown(Word::end_of_file))
                                     : fmt::format("'{}'", text.substr(0, text.find('\n')));
    }

    bool refuse_unsupported() {
        const auto* it = std::ranges::find(unsupported, here().word, &Unsupported::word);
        if (it == std::end(unsupported)) return false;
        if (is(Word::caret) && (next().word == Word::integer || next().word == Word::real))
            return fail("L0902", here().place, "'^' is not a power", "write '**'"), true;
        fail("L0903", here().place, fmt::format("{} not supported", it->what),
             std::string(it->instead));
        return true;
    }

    /// Nothing more is told until the parser has found its feet again.
    void fail(const char* code, Place place, std::string message, std::string help = {}) {
        if (!panic_) tell(code, place, std::move(message), std::move(help));
        panic_ = true;
    }

    void tell(const char* code, Place place, std::string message, std::string help = {}) {
        is_wrong_ = true;
        out_.add(code, place.mark(), std::move(message), std::move(help));
    }

    static bool closes_statement(Word word) {
        return word == Word::end_if_ || word == Word::end_case_ || word == Word::end_for_ ||
               word == Word::end_while_ || word == Word::end_repeat_;
    }

    /// A comment without an end took the rest of the file.
    bool is_swallowed() const { return !mistakes_.empty() && mistakes_.back() >= last().place.end; }

    /// The end of a block. One that is missing is told once, for the innermost.
    bool close(Word end, const Token& opener) {
        if (accept(end)) return true;
        if (panic_ || unclosed_at_ == at_) return false;
        const bool left = is(Word::end_of_file) || is_end(here().word) || is(Word::else_) ||
                          is(Word::elsif_) || is(Word::until_) || find_pou(here().word) ||
                          at_test() || at_label_of_case() || (is(Word::type_) && is_name(next()));
        if (!left) {
            expected(shown(end));
            return false;
        }
        unclosed_at_ = at_;
        if (is(Word::end_of_file) && is_swallowed()) return false;
        if (!else_ifs_.empty() && end == Word::end_if_) {
            tell("L0902", else_ifs_.back(), "'ELSE IF' begins a second IF without an END_IF",
                 "write ELSIF");
            return false;
        }
        if (closes_statement(here().word) && find_pou(opener.word)) {
            tell("L0902", here().place, fmt::format("{} ends nothing", found()),
                 "remove it, or look for another one above that is too many");
            return false;
        }
        tell("L0902", here().place, fmt::format("expected {} before {}", shown(end), found()),
             fmt::format("the {} in line {} does not end", shown(opener.word),
                         opener.place.mark().line));
        return false;
    }

    /// Counts levels while it lives.
    struct Level {
        explicit Level(Parser& of) : parser(of) {
            if (++parser.depth_ > deepest) parser.too_deep(parser.here().place);
        }
        ~Level() { --parser.depth_; }
        Parser& parser;
    };

    void too_deep(Place place) {
        fail("L0912", place, fmt::format("this is nested deeper than {} levels", deepest),
             "take it apart, into variables or functions");
        at_ = unclosed_at_ = tokens_.size() - 1;
    }

    void skip_to_declaration() {
        panic_ = false;
        while (!is(Word::end_of_file) && !at_pou() && !is(Word::var_global_) && !at_test() &&
               !(is(Word::type_) && here().first_in_line))
            take();
    }

    /// Behind the next `;`, or before what begins or ends a block.
    void skip_to_statement() {
        panic_ = false;
        while (!is(Word::end_of_file) && !is_end(here().word) && !accept(Word::semicolon)) {
            const bool begins = is(Word::if_) || is(Word::for_) || is(Word::while_) ||
                                is(Word::case_) || is(Word::repeat_) || is(Word::else_) ||
                                is(Word::elsif_) || is(Word::until_);
            if (here().first_in_line && (begins || at_pou() || at_test())) return;
            take();
        }
    }

    // Declarations.

    /// What has a mistake is lost, and its names are noted.
    void read_or_lose() {
        const std::size_t first = at_;
        const std::uint32_t begin = first == 0 ? 0 : here().place.begin;
        const std::size_t types = tree_.types.size(), units = tree_.units.size(),
                          globals = tree_.globals.size();
        const std::size_t blocks = fixture_ ? fixture_->blocks.size() : 0,
                          methods = fixture_ ? fixture_->methods.size() : 0;
        is_wrong_ = false;
        if (!is(Word::end_of_file)) read_declaration();
        if (panic_) skip_to_declaration();
        const std::uint32_t end = here().place.begin;
        const auto is_within = [&](std::uint32_t at) { return at >= begin && at < end; };
        if (!is_wrong_ && std::ranges::none_of(mistakes_, is_within)) return;
        for (std::size_t i = types; i < tree_.types.size(); ++i) tree_.types[i].is_lost = true;
        for (std::size_t i = units; i < tree_.units.size(); ++i) tree_.units[i]->is_lost = true;
        for (std::size_t i = globals; i < tree_.globals.size(); ++i)
            tree_.globals[i].is_lost = true;
        if (fixture_) fixture_->blocks.resize(blocks), fixture_->methods.resize(methods);
        for (std::size_t i = first; i < at_; ++i) tree_.lost.try_emplace(tokens_[i].text);
        lose(here().place.source->text().substr(begin, end - begin));
    }

    void lose(std::string_view text) {
        const auto is_part = [](char c) { return is_letter(c) || is_digit(c); };
        for (auto it = text.begin(); it != text.end();) {
            const auto name = std::find_if(it, text.end(), is_part);
            it = std::find_if_not(name, text.end(), is_part);
            tree_.lost.try_emplace(std::string_view(name, it));
        }
    }

    void read_declaration() {
        if (const PouWords* words = find_pou(here().word); words && !is(Word::method_))
            return read_pou(*words);
        if (is(Word::type_)) return read_types();
        if (is(Word::var_global_)) return tree_.globals.push_back(read_section(Section::global));
        if (is(Word::configuration_)) return read_configuration();
        if (refuse_whole()) return;
        if (is_name(next()) && respell(declaration_words)) return read_declaration();
        if (at_test() || (is_tests_ && is(Word::test_))) return read_test();
        if (is_end(here().word) && unclosed_at_ < at_) {
            take();
            accept(Word::semicolon);
            return;
        }
        expected("a FUNCTION_BLOCK, FUNCTION, PROGRAM, DATA_BLOCK or TYPE");
        take();
    }

    /// Its variables are globals. Its tasks are not taken.
    void read_configuration() {
        const Token opener = take();
        out_.warn("L0903", opener.place.mark(), "the tasks of a CONFIGURATION are not taken",
                  "write tasks into the program's YAML file");
        const auto at_end = [&] { return same_name(here().text, "end_configuration"); };
        while (!is(Word::end_of_file) && !at_end())
            if (is(Word::var_global_))
                tree_.globals.push_back(read_section(Section::global));
            else
                take();
        if (is(Word::end_of_file))
            tell("L0902", opener.place, "the CONFIGURATION does not end",
                 "it ends with END_CONFIGURATION");
        take();
        accept(Word::semicolon);
    }

    /// What is not supported, up to its END_... or the ';' behind it.
    bool refuse_whole() {
        static constexpr Word words[] = {Word::class_,    Word::interface_, Word::namespace_,
                                         Word::property_, Word::action_,    Word::using_};
        if (std::ranges::find(words, here().word) == std::end(words)) return false;
        const std::string end = fmt::format("end_{}", here().text);
        const bool is_using = is(Word::using_);
        const bool is_part = is(Word::property_) || is(Word::action_);
        refuse_unsupported();
        panic_ = false;
        const std::size_t first = at_;
        const auto at_last = [&] {
            return is(Word::end_of_file) || (is_using && is(Word::semicolon)) ||
                   same_name(here().text, end);
        };
        while (!at_last() && !(is_part && at_ != first && at_next_part())) take();
        if (at_last()) take();
        accept(Word::semicolon);
        return true;
    }

    /// Of a block, where the end of the part before was left out.
    bool at_next_part() const {
        const bool begins = is(Word::method_) || is(Word::property_) || is(Word::action_);
        return ends_pou(here().word) ||
               (here().first_in_line && (at_pou() || (begins && is_name(next()))));
    }

    static bool ends_pou(Word word) {
        return std::ranges::find(pou_words, word, &PouWords::end) != std::end(pou_words);
    }

    /// `INITIAL_STEP s:`, `STEP s:`, `TRANSITION FROM s TO t`: up to the end of the block.
    bool at_chart() const {
        if (!is(Word::name) || !here().first_in_line || !is_name(next())) return false;
        const std::string_view text = here().text;
        if (same_name(text, "transition")) return true;
        return (same_name(text, "step") || same_name(text, "initial_step")) &&
               next(2).word == Word::colon;
    }

    void refuse_chart() {
        tell("L0903", here().place, "sequential function charts are not supported",
             "write a CASE over the steps");
        while (!is(Word::end_of_file) && !ends_pou(here().word)) take();
    }

    Token read_name(std::string_view what) {
        if (!panic_ && is_name()) return take();
        expected(what);
        return here();
    }

    void read_pou(const PouWords& words) {
        if (Pou* pou = read_pou_of(words)) tree_.units.push_back(pou);
    }

    /// A word stands where the name of a variable does.
    bool is_declared() const { return next().word == Word::colon || next().word == Word::comma; }

    bool accept_access() {
        return !is_declared() && (accept(Word::private_) || accept(Word::public_) ||
                                  accept(Word::protected_) || accept(Word::internal_));
    }

    /// `FUNCTION_BLOCK ABSTRACT x`; what is behind the word is read all the same.
    bool refuse_modifier() {
        if (!is_name(next()) || next().first_in_line ||
            !(is(Word::override_) || is(Word::final_) || is(Word::abstract_)))
            return false;
        if (!is(Word::abstract_) || !is_wrong_) refuse_unsupported();  // told of its block
        panic_ = false;
        take();
        return true;
    }

    Pou* read_pou_of(const PouWords& words) {
        const std::string_view doc = comment_before(at_, true);
        const Token opener = take();
        Pou& pou = tree_.pous.emplace_back();
        pou.kind = words.kind;
        pou.doc = doc;
        pou.is_private = is(Word::private_);
        while (accept_access() || refuse_modifier()) continue;
        pou.name = read_name(fmt::format("the name of the {}", shown(opener.word)));
        pou.place = opener.place.to(pou.name.place);
        if (accept(Word::colon)) pou.result = read_type();
        if (panic_) skip_line();
        read_header(pou);
        if (pou.doc.empty()) pou.doc = comment_before(at_, true);
        read_sections(pou, words.end);
        if (std::exchange(is_spoiled_, false)) return skip_past(words.end), &pou;
        accept(Word::begin_);
        is_in_body_ = true;
        read_body(pou, words.end);
        for (const Token& region : std::exchange(regions_, {}))
            tell("L0902", region.place, "the REGION does not end", "it ends with END_REGION");
        close(words.end, opener);
        is_in_body_ = false;
        accept(Word::semicolon);
        if (panic_) skip_past(words.end);
        return &pou;
    }

    /// A TEST has a text behind it; SETUP and TEARDOWN are names, too.
    bool at_test() const {
        if (!is_tests_ || !here().first_in_line) return false;
        const Word behind = next().word;
        if (is(Word::test_)) return behind == Word::text || next().quoted;
        return (is(Word::setup_) || is(Word::teardown_)) && behind != Word::assign &&
               behind != Word::dot && behind != Word::open && behind != Word::open_bracket;
    }

    /// What SETUP and TEARDOWN declare all tests see.
    void read_test() {
        const Token opener = take();
        const bool is_test = opener.word == Word::test_;
        if (!fixture_) {
            fixture_ = &tree_.pous.emplace_back();
            fixture_->kind = PouKind::function_block;
            fixture_->is_tests = true;
            fixture_->place = opener.place;
            fixture_->name = opener;
            fixture_->name.text = "the tests";
        }
        Pou& test = tree_.pous.emplace_back();
        test.kind = PouKind::method;
        test.name = opener;
        if (is_test && (is(Word::text) || here().quoted))
            test.name = take();
        else if (is_test)
            expected("a text in quotes", "after TEST");
        if (panic_) skip_to_statement();
        test.place = opener.place.to(test.name.place);
        if (is_test) test.name.text = test.place.text();
        const Word end = is_test                       ? Word::end_test_
                         : opener.word == Word::setup_ ? Word::end_setup_
                                                       : Word::end_teardown_;
        read_sections(test, end);
        if (!is_test)
            for (DeclarationBlock& block : std::exchange(test.blocks, {}))
                fixture_->blocks.push_back(std::move(block));
        is_in_body_ = is_in_test_ = true;
        read_statements(test.body, end);
        close(end, opener);
        is_in_body_ = is_in_test_ = false;
        accept(Word::semicolon);
        if (panic_) skip_past(end);
        fixture_->methods.push_back(&test);
    }

    void skip_past(Word end) {
        panic_ = false;
        while (!is(Word::end_of_file) && !is(end) && !at_pou() && !at_test()) take();
        accept(end);
    }

    /// `VERSION : 0.1`, `TITLE = ...`, `AUTHOR : ...`
    void skip_header() {
        static constexpr std::string_view words[] = {
            "title", "author", "family", "name", "know_how_protect", "read_only", "unlinked"};
        for (;;) {
            const bool header =
                is(Word::version_) || (is(Word::name) && !here().quoted && here().first_in_line &&
                                       std::ranges::any_of(words, [&](std::string_view word) {
                                           return same_name(word, here().text);
                                       }));
            if (!header) return;
            const bool is_number = next().word == Word::colon && next(2).word == Word::real;
            if (is(Word::version_) && is_number && next(3).word != Word::dot)
                at_ += 3;
            else
                skip_line();
        }
    }

    /// What stands before the variables; of a data block its type too.
    void read_header(Pou& pou) {
        if (is(Word::extends_) || is(Word::implements_)) refuse_unsupported();
        if (panic_) skip_line();
        skip_header();
        accept(Word::non_retain_) || accept(Word::retain_);
        if (pou.kind != PouKind::data_block) return;
        pou.base = std::exchange(pou.result, nullptr);
        if (is(Word::struct_) || is(Word::array_)) {
            pou.base = read_type();
            accept(Word::semicolon);
        } else if (is_name() && !is(Word::begin_)) {
            pou.base = read_type();
            accept(Word::semicolon);
        }
    }

    void skip_line() {
        panic_ = false;
        take();
        while (!is(Word::end_of_file) && !here().first_in_line) take();
    }

    /// Whether its variables keep their values.
    static bool stays(PouKind kind) {
        return kind == PouKind::program || kind == PouKind::function_block;
    }

    void read_sections(Pou& pou, Word end) {
        while (!is(end) && !is(Word::end_of_file)) {
            const bool is_inst =
                is(Word::name) && here().first_in_line && same_name(here().text, "var_inst");
            if (refuse_section()) continue;
            const bool is_list = next(2).word == Word::colon || next(2).word == Word::comma;
            if (!is_inst && is_name(next()) && is_list) respell(variable_words);
            const auto* it = std::ranges::find(section_words, here().word, &SectionWord::word);
            if (it == std::end(section_words) && !is_inst) return;
            if (is_inst || (is(Word::var_stat_) && !stays(pou.kind)))
                fail("L0903", here().place,
                     fmt::format("{} is not supported here", here().place.text()),
                     pou.kind == PouKind::function ? "what is to stay makes a FUNCTION_BLOCK"
                                                   : "declare it in the VAR of the block");
            const DeclarationBlock block = read_section(is_inst ? Section::local : it->section);
            if (block.section != Section::external) pou.blocks.push_back(block);
        }
    }

    /// VAR_ACCESS; `CONST n := 5; END_CONST` and LABEL of Siemens' older SCL.
    bool refuse_section() {
        if (is(Word::var_access_)) {
            refuse_unsupported();
            skip_past(Word::end_var_);
            accept(Word::semicolon);
            return true;
        }
        const bool is_const = same_name(here().text, "const");
        if (!is(Word::name) || !here().first_in_line || !is_name(next()) ||
            !(is_const || same_name(here().text, "label")))
            return false;
        const std::string end = fmt::format("end_{}", here().text);
        tell("L0903", here().place, fmt::format("{} is not supported", here().place.text()),
             is_const ? "write VAR CONSTANT n : INT := 5; END_VAR, with the type of each"
                      : "write IF, CASE, EXIT or RETURN");
        while (!is(Word::end_of_file) && !is_end(here().word) && !same_name(here().text, end))
            take();
        if (is(Word::name)) take();
        accept(Word::semicolon);
        return true;
    }

    DeclarationBlock read_section(Section section) {
        const Token opener = take();
        DeclarationBlock block;
        block.section = section;
        while (!is_declared()) {
            if (accept(Word::constant_))
                block.constant = true;
            else if (accept(Word::retain_))
                block.retain = true;
            else if (is(Word::name) && same_name(here().text, "db_specific"))
                take();
            else if (is(Word::name) && same_name(here().text, "persistent"))
                block.retain = take().word == Word::name;
            else if (!accept(Word::non_retain_) && !accept_access())
                break;
        }
        section_left_ = false;
        while (!section_left_ && !is_end(here().word) && !is(Word::end_of_file) && !at_pou() &&
               std::ranges::find(section_words, here().word, &SectionWord::word) ==
                   std::end(section_words))
            read_variables(block.declarations);
        if (section_left_) panic_ = false;
        if (!section_left_) close(Word::end_var_, opener);
        accept(Word::semicolon);
        return block;
    }

    /// `a, b : INT := 5;`
    void read_variables(std::vector<Declaration*>& to) {
        const std::size_t first = at_;
        const Word behind = next().word;
        const bool declares = behind == Word::colon || behind == Word::comma;
        if (!declares && at_doomed_name() && respell(end_words)) return;
        const bool begins = is(Word::begin_) && !declares;
        if (begins ||
            (is_name() && (behind == Word::assign || behind == Word::open || behind == Word::dot)))
            return missing_end_var();
        if (!is_name() && here().word < Word::end_of_file && behind == Word::colon)
            return reserved_name();
        std::vector<Token> names{read_name("the name of a variable")};
        while (accept(Word::comma)) names.push_back(read_name("the name of a variable"));
        if (accept(Word::at_)) refuse_place();
        expect(Word::colon, "after the name");
        TypeText* type = read_type();
        const bool is_edge = same_name(here().text, "r_edge") || same_name(here().text, "f_edge");
        const Token edge = is_edge ? take() : Token{};
        Expression* initial = accept(Word::assign) ? read_initials() : nullptr;
        if (!panic_) end_of_statement();
        if (panic_) return skip_declaration();
        const auto [unit, place] = unit_of(first);
        const std::string_view doc = comment_before(at_, false);
        for (const Token& name : names)
            to.push_back(&tree_.declarations.emplace_back(
                Declaration{name, type, initial, edge, unit, place, doc}));
    }

    /// Behind AT: `%IX0.0`, or another variable.
    void refuse_place() {
        if (is_name())
            return fail("L0903", here().place, "overlays (AT) are not supported",
                        fmt::format("leave AT out, and write {0}.%X3 or {0}.%B1, or SCATTER and "
                                    "GATHER",
                                    here().text));
        fail("L0903", here().place, "direct addresses are not supported",
             "leave AT out, and wire the variable in the program");
    }

    /// A statement stands where a declaration is due.
    void missing_end_var() {
        fail("L0902", here().place, fmt::format("expected END_VAR before {}", found()),
             "declarations look like 'name : INT := 1;', and statements follow END_VAR");
        unclosed_at_ = at_;
        section_left_ = true;
    }

    /// Whatever uses it would be wrong too.
    void reserved_name() {
        tell("L0902", here().place,
             fmt::format("'{}' is a word of the language, not a name", here().text),
             another_name());
        is_spoiled_ = section_left_ = true;
        unclosed_at_ = at_;
    }

    void skip_declaration() {
        panic_ = false;
        while (!is(Word::end_of_file) && !is_end(here().word) && !at_pou())
            if (take().word == Word::semicolon) return;
    }

    /// Of a pragma between the tokens of a declaration, or behind it in its line.
    std::pair<std::string_view, Place> unit_of(std::size_t first) const {
        for (auto it = std::ranges::upper_bound(pragmas_, first, {}, &Pragma::before);
             it != pragmas_.end() && it->before <= at_; ++it) {
            if (it->before == at_ && it->first_in_line) continue;
            std::string_view text = it->place.text();
            text.remove_prefix(std::min(text.find_first_not_of("{ \t"), text.size()));
            if (!same_name(text.substr(0, 4), "unit")) continue;
            const std::size_t begin = text.find_first_of("'\""), end = text.find_last_of("'\"");
            if (begin != end) return {text.substr(begin + 1, end - begin - 1), it->place};
        }
        return {};
    }

    /// The comments before a token that begin their lines, or that do not: those behind the last
    /// empty line.
    std::string_view comment_before(std::size_t token, bool first_in_line) const {
        const auto first = std::ranges::lower_bound(comments_, token, {}, &Pragma::before);
        const auto behind = std::ranges::upper_bound(comments_, token, {}, &Pragma::before);
        const auto fits = [&](const Pragma& c) { return c.first_in_line == first_in_line; };
        auto begin = std::find_if(first, behind, fits);
        const auto end = std::find_if_not(begin, behind, fits);
        const auto is_apart = [](const Pragma& a, const Pragma& b) {
            Place between = a.place;
            between.begin = a.place.end;
            between.end = b.place.begin;
            return std::ranges::count(between.text(), '\n') > 1;
        };
        for (auto next = begin; next != end && next + 1 != end; ++next)
            if (is_apart(*next, next[1])) begin = next + 1;
        return begin == end ? std::string_view() : begin->place.to((end - 1)->place).text();
    }

    /// `TYPE t EXTENDS base : STRUCT`; the members that are written are read all the same.
    void refuse_base() {
        fail("L0903", here().place, "inheritance is not supported",
             "declare a member of the other type");
        panic_ = false;
        while (!is(Word::end_of_file) && !is(Word::colon) && !is(Word::struct_)) take();
    }

    void read_types() {
        const Token opener = take();
        while (!is_end(here().word) && !is(Word::end_of_file) && !at_pou()) {
            TypeDeclaration declared;
            declared.name = read_name("the name of a type");
            if (is(Word::extends_)) refuse_base();
            skip_header();
            if (!is(Word::struct_)) expect(Word::colon, "after the name");
            declared.type = read_type();
            if (accept(Word::assign)) declared.initial = read_initial();
            if (!accept(Word::semicolon) && !panic_ && !is(Word::end_type_)) end_of_statement();
            if (panic_) skip_declaration();
            tree_.types.push_back(declared);
        }
        close(Word::end_type_, opener);
        accept(Word::semicolon);
    }

    // Types.

    TypeText* read_type() {
        const Level level(*this);
        TypeText& type = tree_.type_texts.emplace_back();
        const Token first = here();
        if (accept(Word::array_))
            read_array(type);
        else if (accept(Word::struct_))
            read_struct(type, first, Word::end_struct_);
        else if (is(Word::union_) && is_name(next()))
            read_union(type, first);
        else if (is(Word::open))
            read_enumeration(type);
        else
            read_named(type);
        type.place = first.place.to(last().place);
        return &type;
    }

    void read_array(TypeText& type) {
        type.kind = TypeText::Kind::array;
        expect(Word::open_bracket, "after ARRAY");
        do {
            if (is(Word::times))
                return fail("L0903", here().place, "arrays of any length are not supported",
                            "write its bounds: ARRAY[0..9] OF ...");
            Expression* from = read_expression();
            if (!panic_ && !is(Word::range)) expected("..", "between the bounds");
            accept(Word::range);
            type.ranges.emplace_back(from, read_expression());
        } while (accept(Word::comma));
        expect(Word::close_bracket, "after the bounds");
        expect(Word::of_, "before the type of the elements");
        type.element = read_type();
    }

    void read_struct(TypeText& type, const Token& opener, Word end) {
        type.kind = TypeText::Kind::structure;
        while (!panic_ && !is_spoiled_ && !is_end(here().word) && !is(Word::end_of_file) &&
               !at_pou())
            read_variables(type.members);
        close(end, opener);
    }

    void read_union(TypeText& type, const Token& opener) {
        tell("L0903", opener.place, "unions are not supported",
             "declare a STRUCT, and convert: DWORD_TO_REAL and its like keep the bits");
        take();
        read_struct(type, opener, Word::end_union_);
    }

    /// `(red, green := 5)`, and behind it the type of the numbers, as CODESYS has it
    void read_enumeration(TypeText& type) {
        type.kind = TypeText::Kind::enumeration;
        expect(Word::open);
        do {
            Argument& value = type.values.emplace_back();
            value.name = read_name("the name of a value");
            if (accept(Word::assign)) value.value = read_expression();
        } while (accept(Word::comma));
        expect(Word::close, "after the values");
        if (is(Word::name) && type.name.word == Word::end_of_file) type.name = take();
    }

    /// `lib.T`: what is behind the points is taken.
    void refuse_namespace(Token& name) {
        const Place first = name.place;
        while (is(Word::dot) && is_name(next())) take(), name = take();
        tell("L0903", first.to(name.place), "namespaces are not supported",
             fmt::format("write {}", name.text));
    }

    void read_named(TypeText& type) {
        if (is(Word::pointer_) && next().word == Word::to_) refuse_unsupported();
        type.name = read_name("a type");
        if (type.name.text == "_" && accept(Word::dot)) type.name = read_name("a type");
        if (panic_) return;
        if (is(Word::dot) && is_name(next())) refuse_namespace(type.name);
        if (same_name(type.name.text, "string") && (is(Word::open_bracket) || is(Word::open))) {
            type.kind = TypeText::Kind::text;
            const Word end = take().word == Word::open_bracket ? Word::close_bracket : Word::close;
            type.length = read_expression();
            expect(end, "after the length");
        } else if (same_name(type.name.text, "wstring") &&
                   (is(Word::open_bracket) || is(Word::open))) {
            const Word end = take().word == Word::open_bracket ? Word::close_bracket : Word::close;
            read_expression();
            expect(end, "after the length");
        } else if (same_name(type.name.text, "reference") && is(Word::to_)) {
            fail("L0903", type.name.place, "references are not supported",
                 "pass the variable as VAR_IN_OUT");
        } else if (is(Word::open)) {
            if (is_name(next()) && (next(2).word == Word::comma || next(2).word == Word::assign ||
                                    next(2).word == Word::close))
                return read_enumeration(type);
            take();
            type.kind = TypeText::Kind::subrange;
            Expression* from = read_expression();
            if (!accept(Word::range)) expected("..", "between the bounds");
            type.ranges.emplace_back(from, read_expression());
            expect(Word::close, "after the bounds");
        }
    }

    // Expressions.

    Expression* make(Expression::Kind kind, const Token& token) {
        Expression& made = tree_.expressions.emplace_back();
        made.kind = kind;
        made.token = token;
        made.place = token.place;
        return &made;
    }

    /// Takes up `operand`, and makes the place as large.
    void add_operand(Expression& to, int index, Expression* operand) {
        to.operands[index] = operand;
        to.place = index == 0 ? operand->place.to(to.place) : to.place.to(operand->place);
        if (to.place.begin > to.place.end) std::swap(to.place.begin, to.place.end);
        grow(to, *operand);
    }

    void grow(Expression& to, const Expression& part) {
        to.depth = std::max<std::uint16_t>(to.depth, static_cast<std::uint16_t>(part.depth + 1));
        if (to.depth > longest_chain) too_deep(to.token.place);
    }

    /// `(x := 1)`, `(1, 2)`, `()`, and not `(1 + 2) * 3`.
    bool at_structure() const {
        if (!is(Word::open)) return false;
        if (next().word == Word::close || at_argument_name(1)) return true;
        for (int i = 0, open = 0;; ++i) {
            const Word word = next(static_cast<std::size_t>(i)).word;
            open += (word == Word::open || word == Word::open_bracket) -
                    (word == Word::close || word == Word::close_bracket);
            if (open == 1 && word == Word::comma) return true;
            if (open == 0 || word == Word::semicolon || word == Word::end_of_file) return false;
        }
    }

    /// A word may be one without quotes, as nothing else can be meant.
    bool at_argument_name(std::size_t ahead = 0) const {
        const Word behind = next(ahead + 1).word;
        return next(ahead).word <= Word::name && next(ahead).word != Word::end_of_file &&
               (behind == Word::assign || behind == Word::output);
    }

    /// `[1, 4(0.0)]`, `(x := 1, y := 2)`, `(1, 2)`, or an expression.
    Expression* read_initial() {
        const bool structure = at_structure();
        if (!structure && !is(Word::open_bracket)) return read_repeated();
        const Level level(*this);
        Expression* list = make(Expression::Kind::list, take());
        const Word end = structure ? Word::close : Word::close_bracket;
        read_arguments(*list, end, true);
        return list;
    }

    /// SCL leaves the brackets of an array's values out: `1, 2, 4(0)`.
    Expression* read_initials() {
        Expression* first = read_initial();
        if (!is(Word::comma)) return first;
        Expression* list = make(Expression::Kind::list, last());
        list->arguments.push_back({{}, false, first, nullptr});
        while (accept(Word::comma)) {
            list->arguments.push_back({{}, false, read_initial(), nullptr});
            grow(*list, *list->arguments.back().value);
        }
        list->place = first->place.to(last().place);
        return list;
    }

    Expression* read_repeated() {
        if (!is(Word::integer) || next().word != Word::open) return read_expression();
        const Level level(*this);
        Expression* count = make(Expression::Kind::constant, take());
        Expression* repeated = make(Expression::Kind::repeated, take());
        read_arguments(*repeated, Word::close, true);
        add_operand(*repeated, 0, count);
        return repeated;
    }

    /// Up to and with `end`.
    void read_arguments(Expression& to, Word end, bool initial) {
        const Level level(*this);
        if (!panic_ && !is(end)) do {
                Argument& argument = to.arguments.emplace_back();
                const bool negated =
                    is(Word::not_) && is_name(next()) && next(2).word == Word::output;
                if (negated)
                    return fail("L0903", here().place, "NOT before an output is not supported",
                                "take the output, and write NOT where it is used");
                if (at_argument_name()) {
                    argument.name = take();
                    argument.is_output = take().word == Word::output;
                    if (argument.is_output && (is(Word::comma) || is(end))) {
                        to.arguments.pop_back();
                        continue;
                    }
                }
                argument.value = initial ? read_initial() : read_expression();
                if (panic_) return;
                grow(to, *argument.value);
            } while (accept(Word::comma) || at_wrong_comma());
        to.place = to.place.to(here().place);
        if (!expect(end)) to.place.end = last().place.end;
    }

    /// `t(IN := x; PT := y)`
    bool at_wrong_comma() {
        const Word behind = next(2).word;
        const bool is_wrong = is(Word::semicolon) && is_name(next()) && !next().first_in_line &&
                              (behind == Word::assign || behind == Word::output);
        if (!is_wrong) return false;
        for (std::size_t i = 3; next(i).word != Word::close; ++i)  // else the call was not closed
            if (next(i).word == Word::end_of_file || next(i).first_in_line) return false;
        tell("L0902", here().place, "expected ')' or ',', found ';'",
             "arguments are joined by ','");
        take();
        return true;
    }

    Expression* read_expression(int binding = 1) {
        Expression* left = read_unary();
        for (;;) {
            const auto* it = std::ranges::find(binaries, operator_here(), &Binary::word);
            if (panic_ || it == std::end(binaries) || it->binding < binding) return left;
            Expression* made = make(Expression::Kind::binary, take());
            made->op = it->word == Word::ampersand ? Word::and_ : it->word;
            add_operand(*made, 0, left);
            add_operand(*made, 1, read_expression(it->binding + 1));
            left = made;
        }
    }

    /// SCL's DIV is no word of the standard, where it is a function.
    Word operator_here() const {
        const bool divides = is(Word::name) && same_name(here().place.text(), "div");
        return divides ? Word::divided : here().word;
    }

    Expression* read_unary() {
        if (!is(Word::minus) && !is(Word::plus) && !is(Word::not_)) return read_postfix();
        const Level level(*this);
        Expression* made = make(Expression::Kind::unary, take());
        made->op = made->token.word;
        const bool is_below_power =
            made->op != Word::not_ && !made->place.dialect().sign_precedes_power;
        Expression* operand = is_below_power ? read_expression(power_binding) : read_unary();
        made->operands[0] = operand;
        made->place = made->place.to(operand->place);
        grow(*made, *operand);
        return made;
    }

    Expression* read_postfix() {
        Expression* left = read_primary();
        while (!panic_) {
            if (is(Word::open)) {
                Expression* call = make(Expression::Kind::call, take());
                read_arguments(*call, Word::close, false);
                add_operand(*call, 0, left);
                left = call;
            } else if (is(Word::open_bracket)) {
                Expression* index = make(Expression::Kind::index, take());
                if (is(Word::close_bracket)) expected("an index", "after '['");
                read_arguments(*index, Word::close_bracket, false);
                add_operand(*index, 0, left);
                left = index;
            } else if (accept(Word::dot)) {
                left = read_member(left);
            } else {
                break;
            }
        }
        return left;
    }

    Expression* read_member(Expression* left) {
        const bool bit = is(Word::direct) || is(Word::integer);
        if (!bit && !is(Word::name)) expected("a name", "after '.'");
        Expression* member = make(bit ? Expression::Kind::bit : Expression::Kind::member, take());
        add_operand(*member, 0, left);
        return member;
    }

    Expression* read_primary() {
        const Level level(*this);
        if (!panic_) {
            switch (here().word) {
                case Word::integer:
                case Word::real:
                case Word::text:
                    return make(Expression::Kind::constant, take());
                case Word::prefix:
                    return read_typed();
                case Word::open_bracket:
                    return read_initial();  // which is refused here
                case Word::open: {
                    take();
                    Expression* inner = read_expression();
                    if (is(Word::assign)) compared_by_assignment();
                    expect(Word::close);
                    return inner;
                }
                default:
                    skip_this();
                    if (is(Word::super_) && next().word == Word::caret) break;
                    if (is_name() || (is_operator_name() && next().word == Word::open))
                        return make(Expression::Kind::name, take());
            }
        }
        expected("a value");
        return make(Expression::Kind::constant, here());
    }

    /// `THIS.x` is a variable or a method of the own block, also as CODESYS writes it, `THIS^.x`.
    void skip_this() {
        const std::size_t dot = next().word == Word::caret ? 2 : 1;
        const bool has_dot = next(dot).word == Word::dot && is_name(next(dot + 1));
        if (is(Word::name) && same_name(here().text, "this") && has_dot) at_ += dot + 1;
    }

    /// `AND(a, b)`: of the functions that share their names with operators.
    bool is_operator_name() const {
        return is(Word::and_) || is(Word::or_) || is(Word::xor_) || is(Word::mod_);
    }

    Expression* read_typed() {
        const Token prefix = take();
        if (is(Word::duration)) {
            Expression* time = make(Expression::Kind::constant, take());
            time->place = prefix.place.to(time->place);
            return time;
        }
        Expression* typed = make(Expression::Kind::typed, prefix);
        Expression* value = read_unary_literal();
        typed->operands[0] = value;
        typed->place = typed->place.to(value->place);
        return typed;
    }

    Expression* read_unary_literal() {
        if (!is(Word::minus) && !is(Word::plus)) return read_primary();
        Expression* made = make(Expression::Kind::unary, take());
        made->op = made->token.word;
        made->operands[0] = read_primary();
        made->place = made->place.to(made->operands[0]->place);
        return made;
    }

    // Statements.

    void read_body(Pou& pou, Word end) {
        for (;;) {
            read_statements(pou.body, end);
            if (!is(Word::method_)) return;
            const PouWords& words = *find_pou(Word::method_);
            if (pou.kind != PouKind::function_block && pou.kind != PouKind::program) return;
            if (Pou* method = read_pou_of(words)) pou.methods.push_back(method);
        }
    }

    static constexpr bool ends_statements(Word word) {
        return word == Word::end_of_file || word == Word::else_ || word == Word::elsif_ ||
               word == Word::until_ || word == Word::method_;
    }

    bool at_end_of_statements() const {
        if (is(Word::end_region_) || is(Word::end_network_)) return false;
        if (is(Word::method_))
            return is_name(next()) || next().word == Word::private_ || next().word == Word::public_;
        return is_end(here().word) || ends_statements(here().word) || at_pou() || at_test() ||
               (is(Word::type_) && is_name(next()));
    }

    /// Up to `end`, or what ends a block around it.
    void read_statements(Block& to, Word end, bool in_case = false) {
        while (!panic_ && !is(end) && !at_end_of_statements() &&
               !(in_case ? at_label() : at_label_of_case())) {
            if (at_chart()) return refuse_chart();
            if (at_doomed_name() && !at_test_word() && respell(statement_words)) continue;
            const std::size_t before = at_;
            Statement* statement = read_statement();
            if (!panic_) to.insert(to.end(), before_statement_.begin(), before_statement_.end());
            before_statement_.clear();
            if (statement && !panic_) to.push_back(statement);
            if (panic_) skip_to_statement();
            if (at_ == before) take();
        }
    }

    Statement* make(Statement::Kind kind, const Token& token) {
        Statement& made = tree_.statements.emplace_back();
        made.kind = kind;
        made.place = token.place;
        return &made;
    }

    Statement* read_statement() {
        const Level level(*this);
        if (panic_) return nullptr;
        const Token first = here();
        switch (first.word) {
            case Word::semicolon:
                take();
                return nullptr;
            case Word::action_:
            case Word::property_:
                if (!is_name(next())) return read_simple();
                refuse_whole();
                return nullptr;
            case Word::region_:
            case Word::network_:
            case Word::end_region_:
            case Word::end_network_:
                if (first.word == Word::network_ && is_assigned(next())) return read_simple();
                take();
                if (first.word == Word::region_) regions_.push_back(first);
                if (first.word == Word::end_region_ && !regions_.empty()) regions_.pop_back();
                accept(Word::semicolon);
                return nullptr;
            case Word::if_:
                return closed(read_if());
            case Word::case_:
                return closed(read_case());
            case Word::for_:
                return closed(read_for());
            case Word::while_:
                return closed(read_while());
            case Word::repeat_:
                return closed(read_repeat());
            case Word::exit_:
                return ended(make(Statement::Kind::exit, take()));
            case Word::continue_:
                return ended(make(Statement::Kind::continue_, take()));
            case Word::return_:
                return ended(make(Statement::Kind::return_, take()));
            default:
                return read_simple();
        }
    }

    static bool is_assigned(const Token& token) { return token.word == Word::assign; }

    Statement* ended(Statement* statement) {
        end_of_statement();
        return statement;
    }

    Statement* closed(Statement* statement) {
        accept(Word::semicolon);
        return statement;
    }

    /// Where the next thing begins a line or ends a block, only the ';' is missing.
    void end_of_statement() {
        if (panic_ || unclosed_at_ == at_ || accept(Word::semicolon)) return;
        if (!here().first_in_line && !is_end(here().word) && !ends_statements(here().word))
            return expected(";", "after the statement");
        if (follows_mistake()) return;
        Place place = last().place;
        place.begin = place.end - 1;
        tell("L0902", place, "expected ';' after this", "put a ';' at the end of the statement");
    }

    Statement* read_simple() {
        if (same_name(here().text, "rung") && (is_name(next()) || next().word == Word::prefix)) {
            fail("L0903", here().place, "networks in LAD and FBD are not supported",
                 "convert the network to SCL");
            while (!is(Word::end_network_) && !is_end(here().word) && !is(Word::end_of_file))
                take();
            panic_ = false;
            return nullptr;
        }
        if (!is_name()) {
            expected("a statement");
            return nullptr;
        }
        if (is_in_test_ && at_test_word()) return read_test_word();
        Expression* target = read_postfix();
        if (panic_) return nullptr;
        const Word op = here().word;
        if (is_assignment(op)) return read_assignment(target);
        if (op == Word::set_assign || op == Word::reset_assign) return read_latch(target);
        if (op == Word::equal) return assigned_by_comparison(target);
        Statement* statement = make(Statement::Kind::call, target->token);
        statement->place = target->place;
        statement->value = target;
        if (target->kind != Expression::Kind::call) {
            if (is(Word::colon) && target->token.word == Word::name)
                fail("L0903", target->place, "labels are not supported",
                     "write IF, CASE, EXIT or RETURN");
            else if (is(Word::name) && same_name(target->token.text, "jmp"))
                fail("L0903", target->place, "JMP is not supported",
                     "write IF, CASE, EXIT or RETURN");
            else if (is(Word::semicolon) || here().first_in_line)
                fail("L0902", target->place, "this does nothing",
                     cases_ > 0 ? "a value of CASE has a ':' behind it, a call '()'"
                                : "write 'name := value;', or a call 'name();'");
            else
                expected(":=", "or '('");
            return nullptr;
        }
        return ended(statement);
    }

    /// `MOCK a.b;`, `MOCK_FUNCTION f RETURNS 5;`, `ADVANCE_TIME T#1s;`
    bool at_test_word() const {
        if (!is_name(next()) && next().word != Word::prefix) return false;
        return same_name(here().text, "mock") || same_name(here().text, "mock_function") ||
               same_name(here().text, "advance_time");
    }

    /// As a call.
    Statement* read_test_word() {
        Expression* name = make(Expression::Kind::name, take());
        Expression* call = make(Expression::Kind::call, name->token);
        call->operands[0] = name;
        call->arguments.push_back({{}, false, read_postfix(), nullptr});
        if (same_name(name->token.text, "mock_function")) {
            if (!same_name(here().text, "returns")) expected("RETURNS", "after the function");
            if (panic_) return nullptr;
            take();
            call->arguments.push_back({{}, false, read_expression(), nullptr});
        }
        call->place = call->place.to(last().place);
        Statement* statement = make(Statement::Kind::call, name->token);
        statement->place = call->place;
        statement->value = call;
        return ended(statement);
    }

    /// `a := b := 0;` is `b := 0; a := b;`
    Statement* read_assignment(Expression* target) {
        const Level level(*this);
        Statement* statement = make(Statement::Kind::assign, here());
        statement->op = take().word;
        statement->target = target;
        const std::size_t before = at_;
        statement->value = read_initial();
        statement->place = target->place.to(last().place);
        if (panic_ || !is_assignment(here().word)) return ended(statement);
        Expression* inner = statement->value;
        at_ = before;
        statement->value = read_initial();
        before_statement_.push_back(read_assignment(inner));
        return statement;
    }

    static bool is_assignment(Word op) { return op >= Word::assign && op <= Word::divided_assign; }

    /// `lamp S= start;`: IF start THEN lamp := TRUE; END_IF
    Statement* read_latch(Expression* target) {
        const Token op = take();
        Statement* latched = make(Statement::Kind::assign, op);
        latched->target = target;
        latched->value = make(Expression::Kind::name, op);
        latched->value->token.text = op.word == Word::set_assign ? "true" : "false";
        Statement* statement = make(Statement::Kind::if_, op);
        Branch& branch = statement->branches.emplace_back();
        branch.condition = read_expression();
        branch.body = {latched};
        latched->place = statement->place = target->place.to(last().place);
        return ended(statement);
    }

    Statement* assigned_by_comparison(Expression* target) {
        tell("L0902", here().place, "'=' compares and does not assign", "write ':='");
        take();
        read_expression();
        end_of_statement();
        (void)target;
        return nullptr;
    }

    void compared_by_assignment() {
        tell("L0902", here().place, "':=' assigns and does not compare", "write '='");
        take();
        read_expression();
    }

    Expression* read_condition(Word end, std::string_view where) {
        Expression* condition = read_expression();
        if (!panic_ && is(Word::assign)) compared_by_assignment();
        if (panic_ || expect(end, where)) return condition;
        panic_ = false;
        if (is(Word::then_) || is(Word::do_) || is(Word::of_)) take();
        return condition;
    }

    Statement* read_if() {
        const Token opener = take();
        Statement* statement = make(Statement::Kind::if_, opener);
        const std::size_t else_ifs = else_ifs_.size();
        do {
            Branch branch;
            branch.condition = read_condition(Word::then_, "after the condition");
            if (panic_) skip_to_statement();
            read_statements(branch.body, Word::end_if_);
            statement->branches.push_back(std::move(branch));
        } while (accept(Word::elsif_));
        if (is(Word::else_)) {
            const Token word = take();
            if (is(Word::if_) && !here().first_in_line)
                else_ifs_.push_back(word.place.to(here().place));
            read_statements(statement->body, Word::end_if_);
        }
        close(Word::end_if_, opener);
        else_ifs_.resize(else_ifs);
        return statement;
    }

    /// Names, numbers, ranges and commas, and then a colon; one that begins a line is meant.
    bool at_label() const {
        if (is(Word::integer) && here().first_in_line) return true;
        for (std::size_t i = at_; i < tokens_.size(); ++i) {
            switch (tokens_[i].word) {
                case Word::colon:
                    return i > at_;
                case Word::integer:
                case Word::prefix:
                case Word::duration:
                case Word::minus:
                case Word::plus:
                case Word::comma:
                case Word::range:
                case Word::dot:
                case Word::text:
                    continue;
                default:
                    if (!is_name(tokens_[i])) return false;
            }
        }
        return false;
    }

    /// Within a statement of a CASE, whose end is missing.
    bool at_label_of_case() const {
        return cases_ > 0 && here().first_in_line && at_label() &&
               (is(Word::integer) || next().word == Word::colon);
    }

    Statement* read_case() {
        const Token opener = take();
        Statement* statement = make(Statement::Kind::case_, opener);
        statement->value = read_condition(Word::of_, "after the selector");
        if (panic_) skip_to_statement();
        ++cases_;
        const auto at_first = [&] { return statement->branches.empty() && is(Word::name); };
        while (!panic_ && (at_label() || at_first())) {
            Branch branch;
            do {
                Expression* from = read_expression();
                Expression* to = accept(Word::range) ? read_expression() : nullptr;
                branch.labels.emplace_back(from, to);
            } while (accept(Word::comma));
            expect(Word::colon, "after the values");
            if (panic_) skip_to_statement();
            read_statements(branch.body, Word::end_case_, true);
            statement->branches.push_back(std::move(branch));
        }
        --cases_;
        if (accept(Word::else_)) {
            accept(Word::colon);
            read_statements(statement->body, Word::end_case_);
        }
        close(Word::end_case_, opener);
        return statement;
    }

    Statement* read_for() {
        const Token opener = take();
        Statement* statement = make(Statement::Kind::for_, opener);
        statement->target = read_postfix();
        expect(Word::assign, "after the loop's variable");
        statement->value = read_expression();
        expect(Word::to_, "after the first value");
        statement->limit = read_expression();
        if (accept(Word::by_)) statement->step = read_expression();
        expect(Word::do_, "after the last value");
        if (panic_) skip_to_statement();
        read_statements(statement->body, Word::end_for_);
        close(Word::end_for_, opener);
        return statement;
    }

    Statement* read_while() {
        const Token opener = take();
        Statement* statement = make(Statement::Kind::while_, opener);
        statement->value = read_condition(Word::do_, "after the condition");
        if (panic_) skip_to_statement();
        read_statements(statement->body, Word::end_while_);
        close(Word::end_while_, opener);
        return statement;
    }

    Statement* read_repeat() {
        const Token opener = take();
        Statement* statement = make(Statement::Kind::repeat, opener);
        read_statements(statement->body, Word::until_);
        if (close(Word::until_, opener)) {
            statement->value = read_expression();
            if (!panic_ && is(Word::assign)) compared_by_assignment();
            accept(Word::semicolon);
        }
        if (panic_) skip_to_statement();
        close(Word::end_repeat_, opener);
        return statement->value ? statement : nullptr;
    }

    const bool is_tests_;
    Pou* fixture_ = nullptr;  ///< that the tests are methods of
    std::vector<Token> tokens_;
    const std::vector<Pragma> pragmas_, comments_;
    const std::vector<std::uint32_t> mistakes_;
    Tree& tree_;
    Diagnostics& out_;
    std::size_t at_ = 0;
    std::size_t unclosed_at_ = static_cast<std::size_t>(-1);  ///< where an end was missed last
    Block before_statement_;                                  ///< of a chain of assignments
    std::vector<Token> regions_;                              ///< that are open
    std::vector<Place> else_ifs_;                             ///< within the IFs that are open
    int depth_ = 0;
    int cases_ = 0;  ///< that are open, before their ELSE
    bool panic_ = false;
    bool is_wrong_ = false;      ///< what is being read
    bool section_left_ = false;  ///< a VAR ended without END_VAR
    bool is_spoiled_ = false;    ///< the POU, by a variable that cannot be
    bool is_in_body_ = false;    ///< of a POU
    bool is_in_test_ = false;
};

}  // namespace

void parse(Tokens tokens, Tree& tree, Diagnostics& out) {
    tree.sources.push_back(tokens.source);
    Parser(std::move(tokens), tree, out).read();
}

}  // namespace lineshaft::st
