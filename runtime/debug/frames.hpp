#pragma once

#include <string>
#include <vector>

#include "runtime/machine/machine.hpp"
#include "runtime/st/library/kind.hpp"

namespace lineshaft::debug {

/// A routine that runs, in a scan that is looked at.
struct Frame {
    const st::Routine* routine = nullptr;
    std::string name;                  ///< `Clamp`; of a block's body `Motor (motor1)`
    Mark mark;                         ///< the statement that comes next, or the call that goes on
    std::byte* base = nullptr;         ///< its first slot
    std::byte* root = nullptr;         ///< of the instance that is scanned
    const Context* context = nullptr;  ///< of that
    const Scan* now = nullptr;         ///< likewise
    const st::Library::Made* made = nullptr;
    const Machine* machine = nullptr;
    const Frame* outer = nullptr;  ///< that called it; null: none, or not looked for
    const st::CodeRoutine* of = nullptr;
    /// What a later call on its instance has put aside of its variables; null: nothing.
    std::byte* aside = nullptr;

    /// Where what it has at that place stands while later calls run.
    std::byte* seen(std::byte* at) const;

    /// What an expression begins with is a variable of the routine or of its block, or an address.
    bool sees(std::string_view expression) const;
};

/// A scan that a fault has ended, as if it stood where that happened.
class FailedScan {
  public:
    FailedScan(Machine& machine, const st::Library::Made& made, const BlockPlace& block, int task);
    FailedScan(const FailedScan&) = delete;
    FailedScan& operator=(const FailedScan&) = delete;

    const st::Halt& halt() const { return halt_; }

  private:
    Scan now_;
    Context context_;
    st::Halt halt_;
};

/// Those that run, the innermost first.
std::vector<Frame> frames_of(const st::Halt& halt, const st::Library::Made& made,
                             const Machine& machine);

/// The innermost alone, without its name and place: for conditions, which are asked often.
Frame innermost(const st::Halt& halt, const st::Library::Made& made, const Machine& machine);

}  // namespace lineshaft::debug
