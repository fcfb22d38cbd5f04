#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "runtime/st/code/code.hpp"
#include "runtime/st/code/native/stencil.hpp"

namespace lineshaft::st {

/// A slot's value in a register.
struct KeptSlot {
    std::uint32_t slot = 0;
    std::uint8_t in = no_register;
};

/// What is copied of an instruction: its stencil, and what that may leave out or has besides, as
/// registers have what stands in slots. Each slot is written all the same.
struct StencilCopy {
    Instruction in;
    std::uint32_t number = 0;         ///< of the instruction
    bool leaves_out_load = false;     ///< of its stencil's beginning
    std::uint8_t into = no_register;  ///< what gets its result besides
    std::array<std::uint8_t, 4> sources{no_register, no_register, no_register,
                                        no_register};  ///< of its operands
    /// Loaded before it by who does not come from the end of the loop that it begins.
    std::vector<KeptSlot> loads = {};
    std::uint32_t skipped = 0;  ///< bytes of these loads where it repeats a loop

    const Stencil& stencil() const { return stencils[static_cast<std::size_t>(in.op)]; }
    std::span<const Filling> fillings() const {
        return {stencil_fillings + stencil().fillings, stencil().count};
    }
    /// An operand by its hole.
    std::uint32_t slot(Hole hole) const {
        const std::uint32_t slots[] = {in.a, in.b, static_cast<std::uint32_t>(in.c), in.d};
        return slots[static_cast<std::size_t>(hole)];
    }
    bool has_result() const { return stencil().result != no_register; }
    std::uint32_t result_slot() const { return slot(stencil().written); }
};

/// Bytes of the instructions that load a slot into a register, and move between two.
constexpr std::uint32_t load_size(std::uint8_t to) {
    return to < first_real ? 7 : 9;
}
constexpr std::uint32_t move_size(std::uint8_t to) {
    return to < first_real ? 3 : 5;
}

/// The parts of all instructions. A result that is read at once is not loaded; a short loop without
/// calls has what it writes and reads again in registers.
class StencilCopies {
  public:
    explicit StencilCopies(const Code& code);

    /// In their order.
    void each(const std::function<void(const StencilCopy&)>& with) const;

  private:
    const Code& code_;
    std::vector<bool> labels_;                                 ///< by instruction, as in a Flow
    std::map<std::uint32_t, std::vector<StencilCopy>> loops_;  ///< by their first instruction
};

}  // namespace lineshaft::st
