#include "runtime/st/syntax/cursor.hpp"

namespace lineshaft::st {

bool Cursor::at_test() const {
    if (source->kind != SourceKind::tests || !here().first_in_line) return false;
    const Word behind = next().word;
    if (is(Word::test_)) return behind == Word::text || next().quoted;
    return (is(Word::setup_) || is(Word::teardown_)) && behind != Word::assign &&
           behind != Word::dot && behind != Word::open && behind != Word::open_bracket;
}

bool Cursor::at_test_statement() const {
    if (!is_name(1) && next().word != Word::prefix) return false;
    return says("mock") || says("mock_function") || says("advance_time");
}

bool Cursor::at_label() const {
    if (is(Word::integer) && here().first_in_line) return true;
    for (std::size_t i = at; i < tokens.size(); ++i) {
        switch (tokens[i].word) {
            case Word::colon:
                return i > at;
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
                if (!st::is_name(tokens[i].word)) return false;
        }
    }
    return false;
}

bool Cursor::at_qualified_prefix() const {
    std::size_t i = 0;
    while (st::is_name(next(i).word) && next(i + 1).word == Word::dot) i += 2;
    return i > 0 && next(i).word == Word::prefix;
}

bool Cursor::at_structure() const {
    if (!is(Word::open)) return false;
    if (next().word == Word::close || at_argument_name(1)) return true;
    for (std::size_t i = 0, open = 0;; ++i) {
        const Word word = next(i).word;
        open += word == Word::open || word == Word::open_bracket;
        open -= word == Word::close || word == Word::close_bracket;
        if (open == 1 && word == Word::comma) return true;
        if (open == 0 || word == Word::semicolon || word == Word::end_of_file) return false;
    }
}

bool Cursor::at_argument_name(std::size_t ahead) const {
    const Word name = next(ahead).word, behind = next(ahead + 1).word;
    return name <= Word::name && name != Word::end_of_file &&
           (behind == Word::assign || behind == Word::output);
}

bool Cursor::at_negated_output() const {
    return is(Word::not_) && is_name(1) && next(2).word == Word::output;
}

bool Cursor::at_end_of_step() const {
    if (!is(Word::name) || !here().first_in_line || !says("end_step")) return false;
    const Token& behind = next();
    return behind.word == Word::semicolon || behind.word == Word::end_of_file ||
           behind.first_in_line;
}

bool Cursor::at_chart() const {
    if (!is(Word::name) || !here().first_in_line) return false;
    const bool has_priority = next().word == Word::open && same_name(next(2).text, "priority");
    if (says("transition")) return has_priority || is_name(1);
    return (says("step") || says("initial_step")) && is_name(1) && next(2).word == Word::colon;
}

}  // namespace lineshaft::st
