#include "runtime/st/library/test_suite.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include <fmt/format.h>

#include "runtime/st/library/compiled.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st {

struct TestSuite::Made : Compiled {
    Options options;
    const Routine* fixture = nullptr;
    const CodeRoutine *setup = nullptr, *teardown = nullptr;
    std::vector<Test> tests;
    std::vector<const CodeRoutine*> codes;
    std::unordered_map<std::uint64_t, const Assertion*> assertions;  ///< by their instruction

    void add(const Routine& routine, const CodeRoutine& code) {
        if (!routine.is_test()) return;
        fixture = routine.owner;
        const Word word = routine.pou->name.word;
        if (word == Word::setup_) setup = &code;
        if (word == Word::teardown_) teardown = &code;
        if (word == Word::setup_ || word == Word::teardown_) return;
        tests.push_back({printable(name_of(*routine.pou)), routine.pou->place.mark()});
        codes.push_back(&code);
    }

    /// Without its quotes.
    static std::string name_of(const Pou& test) {
        const std::string_view quoted = test.name.place.text();
        const std::string_view text = quoted.substr(1, quoted.size() - 2);
        return test.name.quoted ? std::string(text) : read_text(text).value_or(std::string(text));
    }
};

namespace {

using Image = std::vector<std::uint64_t>;

std::byte* bytes(Image& image) {
    return reinterpret_cast<std::byte*>(image.data());
}

/// What one test runs on.
class Bench {
  public:
    explicit Bench(const TestSuite::Made& made)
        : made_(made), root_(made.generated.images.at(made.fixture->type)) {
        std::vector<std::size_t> begins;
        for (const Global& global : made.checked.globals) {
            const Image& image = made.generated.images.at(global.type);
            root_[globals_slot + begins.size()] = begins.size();
            begins.push_back(8 * root_.size());
            root_.insert(root_.end(), image.begin(), image.end());
        }
        for (const std::size_t begin : begins) places_.push_back(bytes(root_) + begin);
    }

    TestResult run(const CodeRoutine* routine) {
        if (!routine) return {};
        const Code& code = made_.generated.code;
        const Context context{.instances = places_.data(),
                              .seen = places_.data(),
                              .memory = bytes(root_),
                              .task = 0,
                              .published = &never};
        const Fault fault =
            execute(code, *routine, bytes(root_), now_, context, made_.options.fuel, nullptr);
        if (fault == Fault::none) return {};
        if (fault == Fault::assertion) return failed_assertion();
        const FaultPlace place = fault_of(code, bytes(root_));
        return {fmt::format("the fault {}", fault_names[static_cast<std::size_t>(fault)]),
                place.mark, true, place.calls};
    }

    std::optional<Mark> cut() { return cut_of(made_.generated.code, bytes(root_)); }

  private:
    std::string_view text_at(std::uint64_t address) {
        const std::uint64_t space = address >> 32;
        const std::byte* first =
            (space == 0 ? bytes(root_) : places_[space - 1]) + 8 * (address & 0xFFFF'FFFF);
        std::uint64_t length = 0;
        std::memcpy(&length, first, sizeof length);
        return {reinterpret_cast<const char*>(first + 8), static_cast<std::size_t>(length)};
    }

    std::string value(const Type& type, std::uint32_t slot) {
        if (type.kind == Type::Kind::text) return text_literal(text_at(root_[slot]));
        return value_text(type, root_[slot]);
    }

    TestResult failed_assertion() {
        const std::uint64_t at = root_[place_slot];
        const Assertion& failed = *made_.assertions.at(at);
        const Instruction* stop = &made_.generated.code.instructions[at];
        TestResult result;
        result.mark = failed.place.mark();
        result.failure = fmt::format("{}: {}", written(failed), what(failed, *stop));
        if (failed.has_message) result.failure += "; " + printable(text_at(root_[stop[1].a]));
        return result;
    }

    /// The statement in one line.
    static std::string written(const Assertion& failed) {
        constexpr std::size_t longest = 100;
        std::string text;
        for (const char c : failed.place.text()) {
            const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
            if (!blank)
                text += c;
            else if (!text.empty() && text.back() != ' ')
                text += ' ';
        }
        if (text.size() > longest) text = std::string(info(failed.call).name);
        return failed.part.empty() ? text : fmt::format("{} at {}", text, failed.part);
    }

    std::string what(const Assertion& failed, const Instruction& stop) {
        const auto found = [&] { return value(*failed.found, stop.a); };
        const auto wanted = [&] { return value(*failed.wanted, stop.b); };
        switch (failed.call) {
            case TestCall::assert_true:
                return fmt::format("expected TRUE, found {}", found());
            case TestCall::assert_false:
                return fmt::format("expected FALSE, found {}", found());
            case TestCall::assert_neq:
                return fmt::format("expected another value than {}", found());
            case TestCall::assert_gt:
                return fmt::format("expected more than {}, found {}", wanted(), found());
            case TestCall::assert_lt:
                return fmt::format("expected less than {}, found {}", wanted(), found());
            case TestCall::assert_ge:
                return fmt::format("expected at least {}, found {}", wanted(), found());
            case TestCall::assert_le:
                return fmt::format("expected at most {}, found {}", wanted(), found());
            case TestCall::assert_near:
                return distance(failed, stop);
            case TestCall::mock_verify_called:
                return "expected a call, found none";
            case TestCall::mock_verify_call_count:
                return fmt::format("expected {} call{}, found {}", root_[stop.b],
                                   root_[stop.b] == 1 ? "" : "s", root_[stop.a]);
            default:
                break;
        }
        const auto exact = [&](std::uint32_t slot) { return std::bit_cast<double>(root_[slot]); };
        const bool hides_digits =
            wanted() == found() && failed.found->is_real() && std::isfinite(exact(stop.a));
        if (!hides_digits) return fmt::format("expected {}, found {}", wanted(), found());
        return fmt::format("expected {}, found {}", exact(stop.b), exact(stop.a));
    }

    std::string distance(const Assertion& failed, const Instruction& stop) {
        const Type& type = *failed.found;
        const auto shown = [&](std::uint64_t slot) {
            const double real = std::bit_cast<double>(root_[slot]);
            if (type.is_real()) return value_text(type, root_[slot]);
            if (type.kind == Type::Kind::time) return time_literal(static_cast<std::int64_t>(real));
            return fmt::format("{}", real);
        };
        return fmt::format("expected {} within {}, found {}", shown(stop.b), shown(stop.c),
                           shown(stop.a));
    }

    const TestSuite::Made& made_;
    Image root_;  ///< of the fixture, then the data blocks and the tests' own objects
    std::vector<std::byte*> places_;
    Scan now_{0, 1'000'000, 0};
};

}  // namespace

std::optional<TestSuite> compile_tests(
    const std::shared_ptr<const SourceFile>& file,
    const std::vector<std::shared_ptr<const SourceFile>>& sources, const Catalog& standard,
    Diagnostics& out, const Options& options) {
    const auto made = std::make_shared<TestSuite::Made>();
    made->options = options;
    made->sources = sources;
    made->sources.push_back(file);
    if (!compile(*made, standard, out, {}, file.get())) return {};
    make_native(made->generated.code, options);
    const CodeRoutine* code = made->generated.code.routines.data();
    for (const Routine* routine : made->checked.order) made->add(*routine, *code++);
    for (const Assertion& assertion : made->generated.assertions)
        made->assertions.emplace(assertion.instruction, &assertion);
    TestSuite suite;
    suite.made_ = made;
    return suite;
}

std::span<const Test> TestSuite::tests() const {
    return made_->tests;
}

TestResult TestSuite::run(std::size_t test) const {
    Bench bench(*made_);
    TestResult result = bench.run(made_->setup);
    if (result.failure.empty()) result = bench.run(made_->codes[test]);
    TestResult last = bench.run(made_->teardown);
    if (result.failure.empty()) result = last;
    result.cut = bench.cut();
    return result;
}

}  // namespace lineshaft::st
