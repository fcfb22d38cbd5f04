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
    std::string block = {};            ///< whose body it is, of the program; or empty
    const Context* context = nullptr;  ///< of that
};

/// Those that run, the innermost first.
std::vector<Frame> frames_of(const st::Halt& halt, const st::Library::Made& made,
                             const Machine& machine);

/// The innermost alone, without its name and place: for conditions, which are asked often.
Frame innermost(const st::Halt& halt, const st::Library::Made& made);

/// Where an address leads, in a scan of the instance at `root`.
inline std::byte* place_of(std::uint64_t address, std::byte* root, const Context& context) {
    const std::uint64_t space = address >> 32;
    return (space == 0 ? root : context.instances[space - 1]) + 8 * (address & 0xFFFF'FFFF);
}

}  // namespace lineshaft::debug
