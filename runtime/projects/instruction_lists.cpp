#include "runtime/projects/instruction_lists.hpp"

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include "runtime/projects/drawings/bodies.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/lexer.hpp"

namespace lineshaft::projects {

namespace {

using st::Token;
using st::Word;

constexpr Word unit_words[] = {Word::program_, Word::function_, Word::function_block_};
constexpr Word unit_ends[] = {Word::end_program_, Word::end_function_, Word::end_function_block_};
constexpr Word part_ends[] = {Word::end_action_, Word::end_method_};

bool is_one_of(Word word, const auto& words) {
    return std::ranges::find(words, word) != std::end(words);
}

bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

/// Whether some line begins as a list does, so that the text is worth to be taken apart.
bool may_have_lists(std::string_view text) {
    constexpr std::string_view operators[] = {"LD", "LDN", "CAL", "JMP"};
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
        const std::size_t word = std::min(line.find_first_of(" \t"), line.size());
        const std::string first = upper(line.substr(0, word));
        if (word < line.size() && std::ranges::find(operators, first) != std::end(operators))
            return true;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return false;
}

/// `LD a`, behind `label:` too.
bool begins_list(const std::vector<Token>& tokens, std::size_t at) {
    const auto word = [&](std::size_t i) { return i < tokens.size() ? tokens[i].word : Word{}; };
    if (!tokens[at].first_in_line) return false;
    if (word(at + 1) == Word::colon) at += 2;
    if (at + 1 >= tokens.size() || tokens[at + 1].first_in_line) return false;
    const auto says = [&](std::string_view name) { return st::same_name(tokens[at].text, name); };
    const bool is_load = says("LD") || says("LDN");
    const bool goes_away = says("CAL") || says("JMP");
    const Word next = word(at + 1);
    const bool is_statement = next == Word::assign || next == Word::open || next == Word::dot ||
                              next == Word::open_bracket || next == Word::semicolon;
    const bool goes = goes_away && next == Word::name && word(at + 2) != Word::semicolon;
    return (is_load && !is_statement) || goes;
}

/// VAR, VAR_INPUT and their like.
bool begins_section(const Token& token) {
    const std::string word = token.word == Word::name ? "" : upper(token.place.text());
    return word == "VAR" || word.starts_with("VAR_");
}

/// A text whose lists become statements.
class ListsOfText {
  public:
    explicit ListsOfText(std::shared_ptr<const SourceFile> text)
        : file_(text), tokens_(st::read_tokens(std::move(text), unread_)) {}

    std::shared_ptr<const SourceFile> rewritten();

  private:
    struct Unit {
        std::string name;
        std::size_t variables = 0;  ///< where its own go, in bytes; 0: nowhere yet
        std::size_t section = 0;    ///< the token that its declarations begin behind
        bool has_body = false;      ///< which has begun, and is none
        MadeVariables made = {};
    };
    struct List {
        Part part = {};
        Unit* unit = nullptr;
        Excerpts statements = {};
    };

    void find();
    std::size_t take_list(Unit& unit, std::size_t first);
    void note_variables(const Unit& unit, std::size_t end);
    void write(Excerpts& to, std::size_t& at, std::size_t end) const;

    PlacedFile file_;
    Diagnostics out_;
    Diagnostics unread_;
    st::Tokens tokens_;
    std::deque<Unit> units_;
    std::vector<List> lists_;
    DeclaredTypes types_;
};

/// `a, b : INT;`, in front of that token.
void ListsOfText::note_variables(const Unit& unit, std::size_t end) {
    const std::vector<Token>& all = tokens_.tokens;
    VariableTypes& own = types_.pous[lower(unit.name)];
    std::vector<std::string> names;
    for (std::size_t i = unit.section; i < end; ++i) {
        if (all[i].word == Word::colon && i + 2 < end) {
            const bool is_plain =
                all[i + 2].word == Word::semicolon || all[i + 2].word == Word::assign;
            for (const std::string& name : names)
                if (is_plain) own[name] = upper(all[i + 1].text);
        }
        if (all[i].word == Word::name && all[i + 1].word != Word::colon &&
            all[i + 1].word != Word::comma)
            names.clear();
        else if (all[i].word == Word::name)
            names.push_back(lower(all[i].text));
        else if (all[i].word != Word::comma)
            names.clear();
    }
}

void ListsOfText::find() {
    const std::vector<Token>& all = tokens_.tokens;
    std::vector<Unit*> open;
    Unit* last = nullptr;  // whose actions may stand behind it
    bool is_in_section = false;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const Token &token = all[i], &next = all[i + 1];
        const bool begins_unit = is_one_of(token.word, unit_words) || token.word == Word::method_;
        if (begins_unit && token.first_in_line)
            open.push_back(&units_.emplace_back(Unit{std::string(next.text), 0, i, false, {}}));
        const bool ends_unit = is_one_of(token.word, unit_ends) || token.word == Word::end_method_;
        if (ends_unit && !open.empty()) last = open.back(), open.pop_back();
        const bool begins_action =
            token.word == Word::colon && i >= 2 && all[i - 2].word == Word::action_;
        Unit* const unit = open.empty() && begins_action ? last
                           : open.empty()                ? nullptr
                                                         : open.back();
        if (!unit) continue;
        is_in_section = (is_in_section || begins_section(token)) && token.word != Word::end_var_;
        if (token.word == Word::end_var_) {
            note_variables(*unit, i);
            unit->variables = token.place.end;
        }
        const bool may_begin = begins_action || !(is_in_section || unit->has_body);
        if (may_begin && begins_list(all, i + 1))
            i = take_list(*unit, i + 1) - 1;
        else if (may_begin && next.first_in_line && !begins_section(next))
            unit->has_body |= next.word != Word::method_ && next.word != Word::action_;
    }
}

/// The list that begins with that token; what it ends before.
std::size_t ListsOfText::take_list(Unit& unit, std::size_t first) {
    const std::vector<Token>& all = tokens_.tokens;
    std::size_t end = first;
    while (end + 1 < all.size() && !is_one_of(all[end].word, unit_ends) &&
           !is_one_of(all[end].word, part_ends))
        ++end;
    if (unit.variables == 0) unit.variables = all[first - 1].place.end;
    lists_.push_back({{all[first].place.begin, all[end].place.begin}, &unit, {}});
    return end;
}

/// What stands there, with the variables that lists of units need.
void ListsOfText::write(Excerpts& to, std::size_t& at, std::size_t end) const {
    for (const Unit& unit : units_) {
        if (unit.variables < at || unit.variables > end || unit.made.declarations().empty())
            continue;
        to.copy(file_, {at, unit.variables});
        at = unit.variables;
        to.write("\nVAR\n" + unit.made.declarations() + "END_VAR\n", file_.mark({at, at}));
    }
    to.copy(file_, {at, end});
    at = end;
}

std::shared_ptr<const SourceFile> ListsOfText::rewritten() {
    find();
    if (lists_.empty()) return file_.file();
    for (List& list : lists_) {
        const NetworkTypes types(types_, list.unit->name);
        list.statements = list_text({file_, out_, types, list.unit->made}, {list.part});
    }
    Excerpts made;
    std::size_t at = 0;
    for (const List& list : lists_) {
        write(made, at, list.part.begin);
        made.append(list.statements);
        at = list.part.end;
    }
    write(made, at, file_.text().size());
    SourceFile text = *made.finish(file_.file()->path, {}, out_);
    text.read_as = file_.file()->read_as;
    return std::make_shared<const SourceFile>(std::move(text));
}

}  // namespace

std::shared_ptr<const SourceFile> with_lists_as_statements(std::shared_ptr<const SourceFile> text) {
    if (!text->excerpts.empty() || !may_have_lists(text->text)) return text;
    return ListsOfText(std::move(text)).rewritten();
}

}  // namespace lineshaft::projects
