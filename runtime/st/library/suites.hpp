#pragma once

#include <atomic>
#include <functional>

#include "runtime/st/library/test_suite.hpp"

namespace lineshaft::st {

/// True if a PROGRAM stands in it that calls RUN or RUN_IN_SEQUENCE of TcUnit.
bool calls_suites(const std::shared_ptr<const SourceFile>& file);

struct SuiteTest {
    Test test;  ///< `MAIN.fbMath: adds two numbers`
    TestResult result;
    bool skipped = false;  ///< it is disabled
};

/// Who watches a run of suites.
struct SuitesWatch {
    const std::atomic<bool>* interrupt = nullptr;                ///< true: it ends behind a suite
    std::function<void(const std::string& suite)> at_work = {};  ///< told before each is scanned
};

/// Scans the PROGRAM of `file` every `cycle` [ns], behind it those of `beside`, which tasks run,
/// and then the suites of TcUnit that they, what they call and the lists of globals have, in
/// virtual time from 0 on, until each test is finished; axes and other blocks of the lists are
/// scanned every millisecond, as is one for each AXIS_REF that the program, its blocks or a list
/// keep. A failed assertion does not end its test; the first one is told. A test that is not
/// finished after ten minutes has failed, as has one in which a fault happens, and then the others
/// of its suite that are not finished. Empty, with all that is wrong in `out`, if anything is.
std::optional<std::vector<SuiteTest>> run_suites(
    const std::shared_ptr<const SourceFile>& file,
    const std::vector<std::shared_ptr<const SourceFile>>& sources, const Catalog& standard,
    std::int64_t cycle, Diagnostics& out, const SuitesWatch& watch = {},
    const Options& options = {}, std::span<const std::string> beside = {});

}  // namespace lineshaft::st
