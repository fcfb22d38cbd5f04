#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/model/value.hpp"

namespace lineshaft {

/// A recorded course of values, played into an input. Before the first point the input keeps what
/// it has, after the last it keeps the last.
class Replay {
  public:
    enum class Between : std::uint8_t {
        held,          ///< a value stays until the next point
        interpolated,  ///< on a line between two points; reals only
    };

    struct Point {
        std::int64_t time = 0;                ///< [ns]; may lie before the run
        std::array<std::byte, 8> value = {};  ///< as the input stores it
    };

    /// The times of `points` do not fall, and lie within +-2^62 ns. Of several points of one time
    /// the last counts. `target` outlives this.
    Replay(std::byte* target, Type type, Between between, std::vector<Point> points)
        : target_(target), type_(type), between_(between), points_(std::move(points)) {}

    std::byte* target() const { return target_; }
    Type type() const { return type_; }
    Between between() const { return between_; }
    const std::vector<Point>& points() const { return points_; }

    /// The instant of the next point [ns]; `never` of an interpolated course, which is played in
    /// each instant that there is.
    std::int64_t next_time() const;

    /// What the target is set to at `now` [ns], which is not before the last one; empty where it
    /// keeps what it has.
    std::optional<Value> play(std::int64_t now);

    /// As if all up to `now` had been played; for a run that goes on.
    void skip_to(std::int64_t now);

  private:
    Value value(std::size_t point) const { return load(type_, points_[point].value.data()); }

    std::byte* target_;
    Type type_;
    Between between_;
    std::vector<Point> points_;
    std::size_t next_ = 0;  ///< first point that has not been played
};

}  // namespace lineshaft
