#pragma once

#include <string>
#include <vector>

namespace lineshaft {

struct SuiteEntry {
    std::string name;  ///< of a file, or of a test in one
    double wall_seconds = 0;
    std::vector<std::string> failures = {};  ///< what does not hold; empty: passed
    bool error = false;                      ///< it could not be judged: a wrong program, a fault
    std::string warnings = {};
    std::string file = {};     ///< of a test in one
    int line = 0;              ///< where it begins
    std::string repeat = {};   ///< the command that shows a failure again
    std::string skipped = {};  ///< why it did not run; empty: it ran
};

/// JUnit XML of a suite, as CI servers read it; each failure is an element of its own.
std::string junit_xml(const std::vector<SuiteEntry>& entries);

}  // namespace lineshaft
