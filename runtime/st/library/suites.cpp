#include "runtime/st/library/suites.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/library/bench.hpp"
#include "runtime/st/library/kind.hpp"
#include "runtime/st/library/suites_state.hpp"
#include "runtime/st/syntax/cursor.hpp"
#include "runtime/st/syntax/parser.hpp"

namespace lineshaft::st {

namespace {

constexpr std::int64_t longest = 600'000'000'000;  // [ns] of virtual time

const Routine* base_suite(const Routine* block) {
    for (; block; block = block->base)
        if (block->pou->place.source->is_library() && block->name == "TcUnit.FB_TestSuite")
            return block;
    return nullptr;
}

/// A suite, and where it is in the instance or the list that has it.
struct Suite {
    std::string name;
    const Routine* block = nullptr;
    int global = -1;  ///< the list; -1: the program
    std::size_t slot = 0;
    bool is_done = false;
};

/// An AXIS_REF of a call, which has no axis: nobody could give it one.
const Variable* reference_of_call(const Routine& routine) {
    for (const Variable& variable : routine.variables) {
        const bool is_given =
            variable.section == Section::input || variable.section == Section::in_out;
        const bool is_kept = routine.has_instances() && variable.section != Section::temp;
        if (variable.type && variable.type->is_handle() && !is_given && !is_kept) return &variable;
    }
    return nullptr;
}

/// Empty where the suite and its methods have none.
std::string reference_without_block(const Routine& suite) {
    for (const Routine* block = &suite; block; block = block->base) {
        std::vector<const Routine*> routines{block};
        routines.insert(routines.end(), block->own_methods.begin(), block->own_methods.end());
        for (const Routine* routine : routines)
            if (const Variable* found = reference_of_call(*routine))
                return fmt::format(
                    "; '{}' in line {} has no axis, as it is of a call: declare it in VAR of '{}'",
                    found->text, found->name.place.mark().line, block->name);
    }
    return {};
}

/// What nobody gives is as TwinCAT has it: an axis has no power until MC_Power gives it.
void take_power(const BlockType& type, std::byte* block) {
    if (const Field* field = type.find_settable("needs_power"))
        store(field->type, block + field->offset, true);
}

/// A run of all suites.
class Suites {
  public:
    Suites(const Compiled& made, const Options& options, const Routine& program,
           std::span<const KeptReference> kept, const SuitesWatch& watch)
        : made_(made),
          program_(program),
          watch_(watch),
          bench_(
              made, options, *program.type,
              [this](TestResult result) { return tell(std::move(result)); }, kept) {
        add_suites(program.name, *program.type, -1, 0);
        for (std::size_t i = 0; i < kept.size(); ++i)
            take_power(*kept[i].to, bench_.global(made.checked.globals.size() + i));
        for (std::size_t i = 0; i < made.checked.globals.size(); ++i)
            add_global(made.checked.globals[i], static_cast<int>(i));
    }

    /// Each is scanned behind the program.
    void add_programs(std::span<const std::string> names) {
        for (const std::string& name : names) {
            const auto is_it = [&](const Global& global) {
                return is_program(global) && same_name(global.name, name);
            };
            const auto found = std::ranges::find_if(made_.checked.globals, is_it);
            if (found != made_.checked.globals.end())
                beside_.emplace_back(found->type->routine, found - made_.checked.globals.begin());
        }
    }

    std::vector<SuiteTest> run(std::int64_t cycle) {
        bench_.set_cycle(cycle);
        state_.set("is_watched", 1);
        for (std::int64_t number = 0; bench_.time() < longest && !is_interrupted(); ++number) {
            state_.set("cycle", number);
            state_.set("suite", 0);
            fault_ = scan_programs();
            if (!fault_.failure.empty()) break;
            if (state_.get("run_mode") > 0) call_suites();
            if (std::ranges::all_of(suites_, &Suite::is_done)) break;
            bench_.advance();
        }
        return results();
    }

  private:
    TestResult scan_programs() {
        TestResult result = bench_.run(code_of(program_), bench_.unit());
        for (const auto& [program, global] : beside_)
            if (result.failure.empty())
                result =
                    bench_.run(code_of(*program), bench_.global(static_cast<std::size_t>(global)));
        return result;
    }

    bool is_interrupted() const { return watch_.interrupt && *watch_.interrupt; }

    /// A list of variables, or another program.
    void add_global(const Global& global, int number) {
        if (is_program(global)) {
            if (global.type != program_.type) add_suites(global.name, *global.type, number, 0);
            return;
        }
        for (const Variable* member : global.type->members)
            if (member->type)
                add_suites(std::string(member->text), *member->type, number, member->slot);
    }

    void add_suites(const std::string& name, const Type& type, int global, std::size_t slot) {
        if (type.kind == Type::Kind::array && !type.element->is_scalar())
            for (std::int64_t i = type.lower; i <= type.upper; ++i)
                add_suites(fmt::format("{}[{}]", name, i), *type.element, global,
                           slot + static_cast<std::size_t>(i - type.lower) * element_slots(type));
        if (type.kind == Type::Kind::structure)
            for (const Variable* member : type.members) add_member(name, *member, global, slot);
        if (type.kind != Type::Kind::block) return;
        if (base_suite(type.routine)) suites_.push_back({name, type.routine, global, slot});
        for (const Variable* member : all_variables(*type.routine))
            if (member->space == Space::frame && member->section != Section::temp)
                add_member(name, *member, global, slot);
    }

    void add_member(const std::string& name, const Variable& member, int global, std::size_t slot) {
        if (member.type)
            add_suites(fmt::format("{}.{}", name, member.text), *member.type, global,
                       slot + member.slot);
    }

    const CodeRoutine& code_of(const Routine& routine) const {
        const auto it = std::ranges::find(made_.checked.order, &routine);
        return made_.generated.code
            .routines[static_cast<std::size_t>(it - made_.checked.order.begin())];
    }

    /// In sequence one is called in a cycle, and a cycle goes by between two.
    void call_suites() {
        const bool in_sequence = state_.get("run_mode") == 2;
        if (in_sequence && std::exchange(pauses_, false)) return;
        for (std::size_t i = 0; i < suites_.size() && !is_interrupted(); ++i) {
            Suite& suite = suites_[i];
            if (suite.is_done) continue;
            if (watch_.at_work) watch_.at_work(suite.name);
            state_.set("suite", static_cast<std::int64_t>(i) + 1);
            state_.set("test", 0);
            TestResult result = bench_.run_part(code_of(*suite.block), *suite.block->type,
                                                suite.global, suite.slot);
            if (result.failure.starts_with("the fault no_reference"))
                result.failure += reference_without_block(*suite.block);
            if (!result.failure.empty()) note_fault(i, result);
            suite.is_done = !result.failure.empty() || open_tests(i).empty();
            pauses_ = suite.is_done;
            if (in_sequence) return;
        }
    }

    /// The numbers of its tests that are not finished.
    std::vector<std::int64_t> open_tests(std::size_t suite) {
        std::vector<std::int64_t> open;
        for (std::int64_t i = 1; i <= state_.get("number_of_tests"); ++i) {
            const SuitesState::Test test = state_.test(i);
            const bool is_its = test.suite == static_cast<std::int64_t>(suite) + 1;
            if (is_its && !test.finished && !test.skipped) open.push_back(i);
        }
        return open;
    }

    bool tell(TestResult result) {
        failed_.emplace(state_.get("test"), std::move(result));
        return false;
    }

    /// The tests that ran and are not finished fail with it.
    void note_fault(std::size_t suite, const TestResult& result) {
        const auto open = open_tests(suite);
        for (const std::int64_t test : open) failed_.emplace(test, result);
        if (open.empty()) faults_.push_back({suite, result});
    }

    /// The call that begins it.
    Mark begin_of(const Routine& suite, std::string_view name) const {
        for (const Routine* block = &suite; block; block = block->base)
            for (const Expression& e : made_.tree.expressions) {
                if (e.kind != Expression::Kind::call || e.place.source != block->pou->place.source)
                    continue;
                const std::string_view called = e.operands[0]->token.text;
                const bool begins = same_name(called, "TEST") || same_name(called, "TEST_ORDERED");
                if (!begins || e.place.begin < block->pou->place.begin || e.arguments.empty())
                    continue;
                std::string_view text = e.arguments[0].value->place.text();
                text.remove_suffix(std::min<std::size_t>(1, text.size()));  // the quote
                if (text.ends_with(name)) return e.place.mark();
            }
        return suite.pou->place.mark();
    }

    std::vector<SuiteTest> results() {
        std::vector<SuiteTest> tests;
        for (std::int64_t i = 1; i <= state_.get("number_of_tests"); ++i) {
            const SuitesState::Test test = state_.test(i);
            const Suite& suite = suites_[static_cast<std::size_t>(test.suite) - 1];
            SuiteTest& made = tests.emplace_back();
            made.test = {fmt::format("{}: {}", suite.name, test.name),
                         begin_of(*suite.block, test.name)};
            made.skipped = test.skipped;
            if (const auto it = failed_.find(i); it != failed_.end())
                made.result = it->second;
            else if (!test.finished && !test.skipped)
                made.result = {"it is not finished after ten minutes: TEST_FINISHED is missing" +
                                   reference_without_block(*suite.block),
                               made.test.mark};
        }
        for (const auto& [suite, result] : faults_)
            tests.push_back(
                {{suites_[suite].name, suites_[suite].block->pou->place.mark()}, result});
        if (!fault_.failure.empty())
            tests.push_back({{program_.name, program_.pou->place.mark()}, fault_});
        return tests;
    }

    const Compiled& made_;
    const Routine& program_;
    const SuitesWatch& watch_;
    Bench bench_;
    SuitesState state_{made_, bench_.global(0)};
    std::vector<std::pair<const Routine*, std::ptrdiff_t>>
        beside_;  ///< programs, and their globals
    std::vector<Suite> suites_;
    bool pauses_ = false;                                     ///< the one before is done
    std::map<std::int64_t, TestResult> failed_;               ///< the first of each test
    std::vector<std::pair<std::size_t, TestResult>> faults_;  ///< of suites without a test that ran
    TestResult fault_;                                        ///< of the program
};

/// Names the programs, so that they are instances.
std::shared_ptr<const SourceFile> naming(const SourceFile& like,
                                         std::span<const std::string> programs) {
    std::string calls;
    for (const std::string& program : programs) calls += program + "();\n";
    return std::make_shared<const SourceFile>(
        SourceFile{.path = like.path,
                   .text = "PROGRAM __programs_of_tasks\n" + calls + "END_PROGRAM\n",
                   .part = "programs of tasks"});
}

bool is_call_of_run(const Cursor& cursor) {
    return (cursor.says("run") || cursor.says("run_in_sequence")) &&
           cursor.next().word == Word::open;
}

}  // namespace

bool calls_suites(const std::shared_ptr<const SourceFile>& file) {
    const bool is_told = file->text.find("RUN") != std::string::npos ||
                         lower(file->text).find("tcunit.run") != std::string::npos;
    if (!is_told) return false;
    Diagnostics unread;
    Cursor cursor{read_tokens(file, unread)};
    bool is_in_program = false;
    for (; !cursor.is(Word::end_of_file); cursor.take()) {
        if (cursor.is(Word::program_)) is_in_program = true;
        if (is_in_program && cursor.is(Word::name) && is_call_of_run(cursor)) return true;
    }
    return false;
}

std::optional<std::vector<SuiteTest>> run_suites(
    const std::shared_ptr<const SourceFile>& file,
    const std::vector<std::shared_ptr<const SourceFile>>& sources, const Catalog& standard,
    std::int64_t cycle, Diagnostics& out, const SuitesWatch& watch, const Options& options,
    std::span<const std::string> beside) {
    constexpr std::int64_t more_fuel = 100;  // a test may do in a scan what a machine does in many
    Options own = options;
    own.fuel *= more_fuel;
    Library::Made made;
    made.sources = sources;
    made.sources.push_back(file);
    if (!beside.empty()) made.sources.push_back(naming(*file, beside));
    if (!compile(made, standard, out)) return {};
    make_native(made.generated.code, own);
    const Routine* program = nullptr;
    bool has_suites = false;
    for (const Routine& routine : made.checked.routines) {
        has_suites |= base_suite(&routine) != nullptr;
        if (routine.pou->kind == PouKind::program && !routine.owner &&
            routine.pou->place.source->file == file)
            program = &routine;
    }
    if (!program || !has_suites) {
        out.add(code::not_declared, {file, 0, 0, 1}, "this program runs no suite of TcUnit",
                "declare an instance of a block that extends TcUnit.FB_TestSuite");
        return {};
    }
    const auto kept = kept_references(made, *program, standard);
    Suites suites(made, own, *program, kept, watch);
    suites.add_programs(beside);
    return suites.run(cycle);
}

}  // namespace lineshaft::st
