#pragma once

#include <cstdint>
#include <vector>

#include "runtime/machine/machine.hpp"
#include "runtime/model/state.hpp"
#include "runtime/scan/event.hpp"

namespace lineshaft {

/// Keeps forced signals at their values. What is written to them meanwhile (their own value) is
/// kept beside: a block of the catalogue has its own outputs in place while it runs, so that it
/// does not see the force in its memory, and all are back when the force has ended. Variables of a
/// program in Structured Text are forced as controllers do: the program reads the force, at the end
/// of each scan the variable has its value again, and behind the force it stays until the program
/// writes it.
class Forces {
  public:
    /// `forces` may grow, and times of its members change, if look_ahead() or forget_ended() is
    /// called then.
    explicit Forces(std::vector<Force>& forces);

    /// Next begin or end [ns].
    std::int64_t next_time() const { return next_; }

    /// Ends and begins what is due at `now`.
    void update(std::int64_t now, EventSink* events);

    bool active() const { return active_; }

    /// Around the copies into the inputs of `block`.
    void lift_inputs(const std::byte* block) { exchange(block, false, Way::lift); }
    void impose_inputs(const std::byte* block) { exchange(block, false, Way::impose); }
    /// Around whatever a block's own code does.
    void lift_outputs(const std::byte* block) { exchange(block, true, Way::lift); }
    void impose_outputs(const std::byte* block) { exchange(block, true, Way::impose); }

    /// After the outputs of `task` were copied to where others see them.
    void published(int task);

    /// Where a stimulus for `target` goes: to its own value while it is forced.
    std::byte* own(std::byte* target);

    void save(StateWriter& out) const { out.put(own_); }
    void restore(StateReader& in);

    /// Finds the next begin or end after `now`; after restore(), and when the forces have changed.
    void look_ahead(std::int64_t now);

    /// Likewise, without those that will not come any more: their number does not grow with time.
    void forget_ended(std::int64_t now);

  private:
    enum class Way { lift, impose };
    struct Own {
        std::byte live[8] = {};
        std::byte published[8] = {};
        bool active = false;
    };

    void exchange(const std::byte* block, bool outputs, Way way);
    void begin(std::size_t index);
    void end(std::size_t index);

    std::vector<Force>& forces_;
    std::vector<Own> own_;
    std::int64_t next_ = 0;
    bool active_ = false;
};

}  // namespace lineshaft
