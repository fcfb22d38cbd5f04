#pragma once

#include <string>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "tests/fuzz/choices.hpp"

namespace lineshaft::test {

/// A signal whose magnitude a program's limits bound. Numbers are in the signal's unit.
struct Bound {
    std::string signal;
    double most = 0;
    bool of_change = false;  ///< per second, from one scan to the next
};

/// A program that must load and run.
struct RandomProgram {
    std::string text;
    std::vector<Bound> bounds;
};

/// One to three tasks, up to 16 blocks of any type, wired to each other and to inputs that change
/// in the run. Blocks with `error` go on after one. The run takes 200 scans of the fastest task.
RandomProgram random_program(Choices& choices, const Catalog& catalog);

}  // namespace lineshaft::test
