#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "runtime/st/library/test_sources.hpp"
#include "runtime/st/library/test_suite.hpp"
#include "runtime/study/junit.hpp"

namespace lineshaft {

/// What `lineshaft test` runs: a program, a study, a fit, tests in Structured Text, or a program of
/// another tool that runs suites of TcUnit, or its project.
struct TestFile {
    std::string path;
    std::shared_ptr<const st::SourcePool> sources;  ///< among which its TESTs find what they test
    bool is_named = false;                          ///< by the command, not found in a folder
};

struct TestOptions {
    std::vector<std::string> include_dirs;
    std::optional<std::regex> filter;  ///< searched in `path` or `path: name of a TEST`; a suite's
                                       ///< path is that of the project or of the suite's file
    bool strict = false;
    bool slow = false;          ///< files marked `slow: true`, too
    unsigned jobs = 1;          ///< of a study's or fit's runs
    std::string traces_folder;  ///< where failed programs are traced; empty: nowhere
    std::function<void(const std::string& suite)> at_work = {};  ///< told of suites of TcUnit
};

/// The file itself, or all that can be tested below a folder, sorted; with what its TESTs see: of a
/// folder all below it, of a file its folder, and the one around that if it is `tests`; of what a
/// package of SIMATIC AX has, all of the package.
std::vector<TestFile> find_tests(const std::string& path, const std::vector<std::string>& sources);

/// Whether programs, studies or fits stand below a folder.
bool has_forms(const std::string& folder);

/// The file itself, or what its fixtures are: files of TESTs.
std::vector<std::shared_ptr<const SourceFile>> texts_of_tests(
    const std::shared_ptr<const SourceFile>& file);

/// Whether a file has TESTs, or fixtures of SIMATIC AX.
bool has_tests(const std::shared_ptr<const SourceFile>& file);

/// Whether it is a file or a project whose tests are suites of TcUnit.
bool runs_suites(const TestFile& tests);

/// The TESTs of a file, which was read, and its fixtures, each for itself; without those that have
/// something wrong, which is told.
std::vector<st::TestSuite> compile_tests(const TestFile& tests,
                                         const std::shared_ptr<const SourceFile>& file,
                                         Diagnostics& out);

/// The names of what a file has under the filter: its path, or `path: name` of its TESTs.
std::vector<std::string> test_names(const TestFile& file, const TestOptions& options);

/// Runs it. Empty: the filter leaves nothing of it.
std::vector<SuiteEntry> run_tests(const TestFile& file, const TestOptions& options);

}  // namespace lineshaft
