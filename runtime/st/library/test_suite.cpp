#include "runtime/st/library/test_suite.hpp"

#include <fmt/format.h>

#include "runtime/st/library/bench.hpp"
#include "runtime/st/library/fields.hpp"
#include "runtime/st/syntax/literals.hpp"
#include "runtime/st/types/value_text.hpp"

namespace lineshaft::st {

struct TestSuite::Made : Library::Made {
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

    /// The failure is the first thing that is found, and where the unit's memory says that it
    /// ended.
    TestResult run(Bench& bench, std::size_t test) const {
        const auto run = [&](const CodeRoutine* routine) {
            return routine ? bench.run(*routine, bench.unit()) : TestResult{};
        };
        TestResult result = run(setup);
        if (result.failure.empty()) result = run(codes[test]);
        if (result.failure.empty()) return run(teardown);
        const std::vector<std::uint64_t> end = bench.end_of_scan();
        run(teardown);
        bench.end_at(end);
        return result;
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
    TestResult result = made_->run(bench, test);
    result.cut = bench.cut();
    return result;
}

std::vector<BlockType> TestSuite::kinds(std::size_t test) const {
    made_->kinds.clear();
    add_data_blocks(*made_, made_->options);
    KindContext& kind = add_kind(*made_, "TEST", *made_->fixture->type, made_->options);
    kind.routine = made_->codes[test];
    kind.run_test = [made = made_.get(), test](std::byte* instance, const Context& context) {
        Bench bench(*made, made->options, instance, context,
                    [](const TestResult&) { return true; });
        const TestResult result = made->run(bench, test);
        if (result.failure.empty()) return std::string();
        return fmt::format("{}:{}: {}", result.mark.file->path, result.mark.line, result.failure);
    };
    write_test_fields(*made_, kind, *made_->fixture);
    std::vector<BlockType> kinds;
    for (KindContext& each : made_->kinds) kinds.push_back(block_type(each, made_));
    return kinds;
}

std::vector<std::pair<std::string, std::string>> TestSuite::objects() const {
    std::vector<std::pair<std::string, std::string>> found;
    for (const Global& global : made_->checked.globals)
        if (global.object) found.emplace_back(global.name, global.type->standard->name);
    return found;
}

}  // namespace lineshaft::st
