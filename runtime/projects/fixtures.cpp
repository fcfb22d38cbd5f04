#include "runtime/projects/fixtures.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "runtime/projects/excerpts.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::projects {

namespace {

/// What a pragma says: its first word, and what stands in parentheses behind that, with them.
struct Remark {
    std::string_view word;
    Part arguments;
};

Remark read_pragma(std::string_view text, Part pragma) {
    constexpr std::string_view blanks = " \t\r\n";
    std::string_view inside = text.substr(pragma.begin, pragma.end - pragma.begin);
    inside.remove_prefix(std::min(inside.find_first_not_of("{ \t\r\n"), inside.size()));
    Remark remark{inside.substr(0, inside.find_first_of("}( \t\r\n")), {}};
    const std::size_t open = text.find_first_not_of(
        blanks, static_cast<std::size_t>(inside.data() - text.data()) + remark.word.size());
    const std::size_t close = text.substr(0, pragma.end).rfind(')');
    if (open < pragma.end && text[open] == '(' && close != text.npos && close > open)
        remark.arguments = {open, close + 1};
    return remark;
}

/// A file, read as far as its tests go.
class Reader {
  public:
    explicit Reader(const std::shared_ptr<const SourceFile>& file) : file_(file) {
        Diagnostics unread;
        st::Tokens tokens = st::read_tokens(file, unread);
        for (const st::Pragma& pragma : tokens.pragmas)
            remarks_.emplace(tokens.tokens[pragma.before].place.begin,
                             read_pragma(file->text, {pragma.place.begin, pragma.place.end}));
        st::parse(std::move(tokens), tree_, unread);
    }

    std::vector<std::shared_ptr<const SourceFile>> tests() {
        std::vector<std::shared_ptr<const SourceFile>> files;
        Excerpts functions;
        for (const st::Pou* unit : tree_.units) {
            if (unit->is_class && !unit->is_abstract && says(*unit, "TestFixture"))
                if (auto made = tests_of(*unit)) files.push_back(std::move(made));
            if (unit->kind == st::PouKind::function)
                write_tests(functions, *unit, unit->name.text, full_name(*unit));
        }
        if (!functions.is_empty()) files.push_back(functions.finish(file_.file()->path, "tests"));
        return files;
    }

  private:
    auto remarks(const st::Pou& pou) const { return remarks_.equal_range(pou.place.begin); }

    bool says(const st::Pou& pou, std::string_view word) const {
        const auto [first, last] = remarks(pou);
        return std::any_of(first, last,
                           [&](const auto& r) { return st::same_name(r.second.word, word); });
    }

    std::string full_name(const st::Pou& unit) const {
        std::string_view path;
        for (const auto& [source, scopes] : tree_.scopes)
            for (const st::Scope& scope : scopes)
                if (scope.begin <= unit.place.begin && unit.place.begin < scope.end)
                    path = scope.path;
        return path.empty() ? std::string(unit.name.text)
                            : fmt::format("{}.{}", path, unit.name.text);
    }

    Mark mark(const st::Pou& pou) const { return file_.mark({pou.place.begin, pou.place.end}); }

    /// A TEST for each `{Test}` before the method or function.
    void write_tests(Excerpts& to, const st::Pou& pou, std::string_view name,
                     std::string_view called) const {
        const auto [first, last] = remarks(pou);
        for (auto it = first; it != last; ++it) {
            const auto& [word, arguments] = it->second;
            if (!st::same_name(word, "Test")) continue;
            std::string title(name);
            for (const char c : file_.text(arguments)) title += c == '\'' ? '"' : c;
            std::ranges::replace(title, '$', '_');
            to.write(fmt::format("TEST '{}'\n{}", title, called), mark(pou));
            if (arguments.begin == arguments.end)
                to.write("()", mark(pou));
            else
                to.copy(file_, arguments);
            to.write(";\nEND_TEST\n", mark(pou));
        }
    }

    void write_calls(Excerpts& to, const st::Pou& fixture, std::string_view word) const {
        for (const st::Pou* method : fixture.methods)
            if (says(*method, word))
                to.write(fmt::format("fixture.{}();\n", method->name.text), mark(*method));
    }

    std::shared_ptr<const SourceFile> tests_of(const st::Pou& fixture) const {
        Excerpts tests;
        for (const st::Pou* method : fixture.methods)
            write_tests(tests, *method, fmt::format("{}.{}", fixture.name.text, method->name.text),
                        fmt::format("fixture.{}", method->name.text));
        if (tests.is_empty()) return nullptr;
        tests.write(fmt::format("SETUP\nVAR\nfixture : {};\nEND_VAR\n", full_name(fixture)),
                    mark(fixture));
        write_calls(tests, fixture, "FixtureSetup");
        write_calls(tests, fixture, "TestSetup");
        tests.write("END_SETUP\nTEARDOWN\n", mark(fixture));
        write_calls(tests, fixture, "TestTearDown");
        write_calls(tests, fixture, "FixtureTearDown");
        tests.write("END_TEARDOWN\n", mark(fixture));
        return tests.finish(file_.file()->path, std::string(fixture.name.text));
    }

    PlacedFile file_;
    st::Tree tree_;
    std::multimap<std::uint32_t, Remark> remarks_;  ///< by the byte that they stand before
};

bool is_test_program(const st::Token& token, std::string_view before) {
    std::string_view text = token.text;
    if (token.quoted || text.size() < before.size()) return false;
    return st::same_name(text.substr(0, before.size()), before) &&
           (st::same_name(text.substr(before.size()), "TEST_PROGRAM") ||
            st::same_name(text.substr(before.size()), "TEST_FUNCTION_BLOCK"));
}

/// With TEST and END_TEST instead; empty without a test.
std::shared_ptr<const SourceFile> tests_of_programs(const std::shared_ptr<const SourceFile>& file) {
    Diagnostics unread;
    const st::Tokens tokens = st::read_tokens(file, unread);
    const PlacedFile placed(file);
    Excerpts tests;
    std::size_t copied = 0;
    for (std::size_t i = 0; i + 1 < tokens.tokens.size(); ++i) {
        const st::Token &token = tokens.tokens[i], &name = tokens.tokens[i + 1];
        const bool begins = is_test_program(token, "") && name.word == st::Word::name;
        if (!begins && !is_test_program(token, "END_")) continue;
        tests.copy(placed, {copied, token.place.begin});
        const st::Place place = begins ? name.place : token.place;
        const std::string word = begins ? fmt::format("TEST '{}'", name.text) : "END_TEST";
        tests.write(word, placed.mark({place.begin, place.end}));
        copied = place.end;
    }
    if (tests.is_empty()) return nullptr;
    tests.copy(placed, {copied, file->text.size()});
    return tests.finish(file->path, "tests");
}

}  // namespace

bool has_fixtures(const SourceFile& file) {
    const std::string_view text = file.text;
    const auto is_letter = [](char a, char b) { return upper(a) == b; };
    for (const std::string_view word : {"END_TEST_PROGRAM", "END_TEST_FUNCTION_BLOCK"})
        if (std::search(text.begin(), text.end(), word.begin(), word.end(), is_letter) !=
            text.end())
            return true;
    for (std::size_t at = text.find('{'); at != text.npos; at = text.find('{', at + 1)) {
        const std::string_view word = read_pragma(text, {at, std::min(at + 80, text.size())}).word;
        if (st::same_name(word, "Test") || st::same_name(word, "TestFixture")) return true;
    }
    return false;
}

std::vector<std::shared_ptr<const SourceFile>> tests_of_fixtures(
    const std::shared_ptr<const SourceFile>& file) {
    if (auto programs = tests_of_programs(file)) return {std::move(programs)};
    return Reader(file).tests();
}

}  // namespace lineshaft::projects
