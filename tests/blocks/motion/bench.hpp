#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "blocks/axis/axis.hpp"
#include "runtime/run/link.hpp"
#include "runtime/scan/executive.hpp"

namespace lineshaft::test {

/// A program of the standard blocks that is stepped millisecond by millisecond. Now and then it is
/// asked whether a run could go on with its state, which must always be so.
class MotionBench {
  public:
    /// The text of a program without its `run`; mistakes in it fail the test.
    explicit MotionBench(std::string program);

    /// As it was at the beginning.
    void restart();

    /// All that the run depends on; and a run that goes on from there, at its next millisecond.
    std::string checkpoint() const;
    void resume(const std::string& state, std::int64_t next);

    /// A signal to set and look at many times.
    std::byte* live(std::string_view signal);
    /// The block itself.
    template <class Block>
    const Block& block(std::string_view name) const {
        const auto number =
            static_cast<std::size_t>(linked_.net.instance_numbers.at(std::string(name)));
        return *std::launder(reinterpret_cast<const Block*>(linked_.machine.instances[number]));
    }

    template <class Block>
    Block& block(std::string_view name) {
        return const_cast<Block&>(std::as_const(*this).block<Block>(name));
    }

    /// Signals by name, as `move.Execute`. Between two steps.
    void set(std::string_view signal, const Value& value);
    Value get(std::string_view signal) const;
    double number(std::string_view signal) const { return as_real(get(signal)); }
    bool is(std::string_view signal) const { return std::get<bool>(get(signal)); }
    const Axis& axis(std::string_view name) const { return block<Axis>(name); }

    /// The instants of the next so many milliseconds; the first is that of time 0.
    void step(std::int64_t milliseconds = 1);
    std::int64_t now() const { return next_ - 1; }  ///< [ms], of the last step

    /// Sets and checks, one row an instant:
    ///
    ///     ms  move.Execute | move.Busy  move.Done  x.position  x.state
    ///     1   1            | 1          0          0           standstill
    ///
    /// A dot leaves an input as it is, and an output unseen. Rows may leave milliseconds out.
    void check(std::string_view table);

    /// As a table of check() has it.
    std::string text(std::string_view signal) const;

  private:
    Port port(std::string_view signal) const;

    Linked linked_;
    std::unique_ptr<Executive> executive_;
    std::string beginning_;
    std::int64_t next_ = 0;
};

}  // namespace lineshaft::test
