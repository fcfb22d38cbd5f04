#pragma once

#include <string>
#include <vector>

namespace lineshaft {

struct SuiteEntry {
    std::string name;
    double wall_seconds = 0;
    std::string failure = {};  ///< first deviation; empty: passed
    bool error = false;        ///< it could not be judged: a wrong program, a fault
    std::string warnings = {};
};

/// JUnit XML of a suite, as CI servers read it.
std::string junit_xml(const std::vector<SuiteEntry>& entries);

}  // namespace lineshaft
