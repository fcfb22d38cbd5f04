#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lineshaft::test {

/// A program that has been run for a while, and what it kept then: for runs that begin with
/// something else in its place.
class KeptRun {
  public:
    /// `program` in the source folder, stopped at `time` [ns]; files go to `folder`. With
    /// `retains`, all of its blocks that may be are retained.
    KeptRun(const std::string& program, std::int64_t time, std::string folder, bool retains);

    /// Its state, without the head; empty where it has not come so far.
    const std::string& checkpoint() const { return state_; }
    const std::string& retained() const { return retained_; }

    /// Runs on for some scans with another state, whose hash is made right. False: refused.
    bool resume(const std::string& state) const;

    /// Runs some scans with another file of retained values, whose check is made right if
    /// `mends`. False: refused.
    bool begin(const std::string& retained, bool mends) const;

  private:
    std::string program_, folder_, text_;
    std::int64_t time_;
    std::string state_, retained_;
};

/// Those that the fuzz targets and tests of kept state begin with: axes with commands of all kinds,
/// cams, pulses, Structured Text with blocks in it, tasks that interrupt each other, forces.
std::vector<std::unique_ptr<KeptRun>> kept_runs(const std::string& folder, bool retains);

/// The programs of tests/cases in the source folder, sorted, and how long one takes [ns].
std::vector<std::string> all_cases();
std::int64_t duration_of(const std::string& program);

/// A file of retained values with its check made right.
std::string with_check(std::string retained);

/// Bits flipped, bytes, words and numbers of the edge put in, pieces copied, cut and inserted, as
/// `choices` say.
std::string damaged(std::string bytes, std::span<const std::uint8_t> choices);

}  // namespace lineshaft::test
