#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace lineshaft::debug {

/// States of a machine from which a run can be repeated, at distances that grow with their age: so
/// much of the past costs so little memory, and what has just been is near.
class History {
  public:
    struct Checkpoint {
        std::string state;                      ///< see Executive::save()
        std::size_t changes = 0;                ///< made by hand that it has, or has in its mail
        std::map<int, std::int64_t> hits = {};  ///< of breakpoints, by their numbers
    };

    static constexpr std::size_t most_bytes = std::size_t{128} << 20, most = 4096;

    /// All up to `time` [ns] has run. What is there already stays.
    void keep(std::int64_t time, Checkpoint checkpoint);

    /// The last one in which nothing of `time` [ns] has run. There is one, if there is any.
    std::pair<std::int64_t, const Checkpoint*> before(std::int64_t time) const;

    /// What comes after `time` [ns] will not come like that any more.
    void forget_after(std::int64_t time);

    std::size_t bytes() const { return bytes_; }
    std::size_t size() const { return checkpoints_.size(); }

  private:
    void thin();

    std::map<std::int64_t, Checkpoint> checkpoints_;  ///< by time; the first is the beginning
    std::size_t bytes_ = 0;
};

}  // namespace lineshaft::debug
