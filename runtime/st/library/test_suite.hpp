#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/st/library/library.hpp"

namespace lineshaft::st {

struct Test {
    std::string name;
    Mark mark;
};

/// How a test ended. It ends with the first assertion that does not hold.
struct TestResult {
    std::string failure = {};  ///< `expected 5, found 7`; empty: passed
    Mark mark = {};            ///< of the assertion, or of the statement with the fault
    bool is_fault = false;     ///< a fault while running: bounds, division, a loop without end
    std::vector<std::string> calls = {};  ///< that ran at the fault, the innermost first
    std::optional<Mark> cut = {};         ///< where a text was first cut short
};

/// A file with `TEST 'text' VAR ... END_VAR statements END_TEST`, its SETUP and TEARDOWN, and the
/// blocks that they test.
class TestSuite {
  public:
    struct Made;

    std::span<const Test> tests() const;

    /// SETUP, the test and TEARDOWN on fresh memory, from time 0 on: so a result does not depend on
    /// what ran before. TEARDOWN runs however the test ends, and what it finds counts only if
    /// nothing was found before. Until ADVANCE_TIME has said what lies between two calls a block
    /// is told 1 ms.
    TestResult run(std::size_t test) const;

    /// For a machine that is looked at from inside: the kind of block `TEST` that runs this test in
    /// its first scan as run() does, and those of the data blocks beside it. It names the blocks
    /// of the program that `objects` tells, each with its kind.
    std::vector<BlockType> kinds(std::size_t test) const;
    std::vector<std::pair<std::string, std::string>> objects() const;

  private:
    friend std::optional<TestSuite> compile_tests(
        const std::shared_ptr<const SourceFile>& file,
        const std::vector<std::shared_ptr<const SourceFile>>& sources, const Catalog& standard,
        Diagnostics& out, const Options& options);

    std::shared_ptr<Made> made_;
};

/// Compiles the tests of `file` together with `sources`. In tests, other than in blocks, outputs
/// and locals of instances are assigned and set in calls, PRIVATE methods called, and numbers of
/// any two types compared. Empty, with all that is wrong in `out`, if anything is:
///   L0914  an assertion outside of a test
std::optional<TestSuite> compile_tests(
    const std::shared_ptr<const SourceFile>& file,
    const std::vector<std::shared_ptr<const SourceFile>>& sources, const Catalog& standard,
    Diagnostics& out, const Options& options = {});

}  // namespace lineshaft::st
