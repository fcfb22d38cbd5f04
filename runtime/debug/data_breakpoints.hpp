#pragma once

#include <string>
#include <vector>

#include "runtime/debug/values.hpp"

namespace lineshaft::debug {

/// Variables in a machine's memory, which stop a run when their values change.
class DataBreakpoints {
  public:
    explicit DataBreakpoints(const Machine& machine) : machine_(machine) {}

    /// What a client names the variable by; empty: it stands in no place of its own, but in one
    /// of a call that runs in one of the frames, or in none.
    std::string id_of(const Shown& shown, const std::vector<Frame>& frames) const;

    struct Placed {
        int number = 0;  ///< none that a breakpoint at a line has
        std::string error = {};
    };
    /// In place of those that there were; `ids` as id_of() gave them.
    std::vector<Placed> set(const std::vector<std::string>& ids);

    bool empty() const { return watched_.empty(); }

    /// What is there now is no reason to stop.
    void begin();

    /// The numbers of those that have changed since it was asked last.
    std::vector<int> changed();

  private:
    struct Watched {
        int number = 0;
        std::size_t first = 0, bytes = 0;  ///< in the memory
        std::vector<std::byte> seen = {};
    };

    bool look(Watched& watched) const;

    const Machine& machine_;
    std::vector<Watched> watched_;
    int last_number_ = 1'000'000;
};

}  // namespace lineshaft::debug
