#pragma once

#include <array>
#include <cstdint>

#include "blocks/axis/axis.hpp"
#include "runtime/model/kept_state.hpp"

namespace lineshaft {

/// The last scans of an axis that a block has seen, and straight lines between them. Places are
/// positions [u] that no MC_SetPosition has moved, and of a modulo axis go on from turn to turn.
struct SeenMotion {
    struct Sample {
        std::int64_t time = 0;  ///< of the axis' scan [ns]
        double place = 0, velocity = 0;
    };
    static constexpr std::int64_t most = 16;

    std::array<Sample, most> samples;
    std::int64_t count = 0;   ///< of samples that are there
    std::int64_t newest = 0;  ///< of them
    double further = 0;       ///< positions are places + further, but for whole turns
    double period = 0;        ///< of a modulo axis, else 0

    /// Takes the axis' last scan if it has not been seen yet, and is a number: its set-point, or
    /// what its drive measures. Whether it has taken one.
    bool look(const Axis& seen, MasterValueSource source);

    bool is_empty() const { return count == 0; }
    /// `back` scans before the last, less than `count`.
    const Sample& sample(std::int64_t back = 0) const {
        return samples[static_cast<std::size_t>((newest + most - back) % most)];
    }
    std::int64_t begin() const { return sample(count - 1).time; }
    std::int64_t end() const { return sample().time; }

    /// The position at a time from begin() to end(), as the axis has it now.
    double position_at(std::int64_t time) const;

    void shift(std::int64_t by);
    bool is_possible(const KeptState& machine) const;
};

}  // namespace lineshaft
