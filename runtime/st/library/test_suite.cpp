#include "runtime/st/library/test_suite.hpp"

#include "runtime/st/library/bench.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st {

struct TestSuite::Made : Compiled {
    Options options;
    const Routine* fixture = nullptr;
    const CodeRoutine *setup = nullptr, *teardown = nullptr;
    std::vector<Test> tests;
    std::vector<const CodeRoutine*> codes;

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
    TestSuite suite;
    suite.made_ = made;
    return suite;
}

std::span<const Test> TestSuite::tests() const {
    return made_->tests;
}

TestResult TestSuite::run(std::size_t test) const {
    Bench bench(*made_, made_->options, *made_->fixture->type,
                [](const TestResult&) { return true; });
    const auto run = [&](const CodeRoutine* routine) {
        return routine ? bench.run(*routine, bench.unit()) : TestResult{};
    };
    TestResult result = run(made_->setup);
    if (result.failure.empty()) result = run(made_->codes[test]);
    TestResult last = run(made_->teardown);
    if (result.failure.empty()) result = last;
    result.cut = bench.cut();
    return result;
}

}  // namespace lineshaft::st
