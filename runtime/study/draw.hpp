#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/source/diagnostic.hpp"
#include "runtime/source/units.hpp"

namespace lineshaft {

enum class Distribution { uniform, log_uniform, normal, integer, choice };

/// A parameter whose value is drawn for each case.
struct RandomParameter {
    std::string name;
    Distribution distribution = Distribution::uniform;
    /// uniform, log_uniform, integer: limits, both included. normal: mean and standard deviation.
    double a = 0, b = 1;
    Unit unit;                         ///< of a and b, as written
    std::vector<std::string> choices;  ///< each equally likely
    Mark mark;                         ///< of the distribution in the study
};

/// Draw `index` of `parameter`, as it would stand in a program: `7.31283 mm/s`, nine digits. It
/// depends on the seed, the parameter's name and the index only: parameters beside it, and draws
/// before it, change nothing.
std::string draw(const RandomParameter& parameter, std::uint64_t seed, std::int64_t index);

/// Values at which a mistake would show: the limits, the mean, each choice.
std::vector<std::string> probes(const RandomParameter& parameter);

}  // namespace lineshaft
