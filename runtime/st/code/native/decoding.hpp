#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>

/// What `write_table` sees in the code of a stencil: as much of the processor's instructions (Intel
/// SDM, volume 2) as short stencils consist of.
namespace lineshaft::st {

struct ProcessorInstruction {
    std::size_t at = 0, size = 0;
    std::uint32_t opcode = 0;          ///< with 0F, and before that F2, F3 or 66
    std::uint8_t extension = 0;        ///< the low half of REX
    std::uint8_t modes = 0;            ///< ModRM
    std::size_t place_at = 0;          ///< behind ModRM; 0: it has none
    std::optional<std::size_t> way{};  ///< where it jumps in the same code

    std::uint8_t named_register() const {
        return static_cast<std::uint8_t>((modes >> 3 & 7) | (extension & 4) << 1);
    }
    bool is(std::initializer_list<std::uint32_t> opcodes) const {
        return std::ranges::find(opcodes, opcode) != opcodes.end();
    }
    bool is_wide() const { return (extension & 8) != 0; }
    /// It has memory at a constant distance of 32 bits from what %rdi has.
    bool has_slot() const { return place_at > 0 && (modes & 0xC7) == 0x87 && !(extension & 1); }
    bool loads_word() const { return opcode == 0x8B && is_wide(); }
    bool loads_real() const { return opcode == 0xF20F10; }
    bool stores_word() const { return opcode == 0x89 && is_wide(); }
    bool stores_real() const { return opcode == 0xF20F11; }
    /// It may as well read what it reads from one of the registers of words, or of reals.
    bool reads_word() const {
        const bool compares = is({0x81, 0x83}) && (modes >> 3 & 7) == 7;
        return compares || (opcode & ~15U) == 0x0F40 ||
               is({0x03, 0x0B, 0x23, 0x2B, 0x33, 0x39, 0x3B, 0x63, 0x85, 0x8B, 0x0FAF, 0x0FB6,
                   0x0FB7, 0x0FBE, 0x0FBF, 0xF20F2A});
    }
    bool reads_real() const {
        return is({0xF20F10, 0xF20F2C, 0xF20F2D, 0xF20F51, 0xF20F58, 0xF20F59, 0xF20F5A, 0xF20F5C,
                   0xF20F5D, 0xF20F5E, 0xF20F5F, 0x660F2E, 0x660F2F});
    }
    /// The registers from 8 on that it may write, a bit each.
    std::uint8_t late_registers() const {
        if (extension & 3) return 0xFF;
        return extension & 4 ? static_cast<std::uint8_t>(1 << (modes >> 3 & 7)) : 0;
    }
};

/// Reads an instruction; empty if it is another one.
class Decoding {
  public:
    explicit Decoding(std::span<const unsigned char> code) : code_(code) {}

    std::optional<ProcessorInstruction> at(std::size_t place) {
        ProcessorInstruction made{.at = place};
        next_ = place;
        read_opcode(made);
        const Form* const form = form_of(made.opcode);
        if (!form) return {};
        if (form->has_modes) read_place(made);
        const bool is_long = !form->has_modes && form->immediate == 4 && made.is_wide();
        const std::size_t immediate_at = next_;
        next_ += is_long ? 8 : form->immediate;
        if (next_ > code_.size()) return {};
        made.size = next_ - place;
        if (form->jumps) made.way = next_ + distance(immediate_at, form->immediate);
        return made;
    }

  private:
    struct Form {
        std::uint32_t first, last;  ///< opcodes
        bool has_modes;
        std::uint8_t immediate;  ///< bytes
        bool jumps;
    };

    // Arithmetic, comparisons, moves, extensions of signs, shifts, jumps; behind 0F those of reals.
    static constexpr Form forms[] = {
        {0x01, 0x03, true, 0, false},     {0x09, 0x0B, true, 0, false},
        {0x21, 0x23, true, 0, false},     {0x29, 0x2B, true, 0, false},
        {0x31, 0x33, true, 0, false},     {0x39, 0x3B, true, 0, false},
        {0x63, 0x63, true, 0, false},     {0x69, 0x69, true, 4, false},
        {0x6B, 0x6B, true, 1, false},     {0x70, 0x7F, false, 1, true},
        {0x81, 0x81, true, 4, false},     {0x83, 0x83, true, 1, false},
        {0x84, 0x85, true, 0, false},     {0x88, 0x8B, true, 0, false},
        {0x8D, 0x8D, true, 0, false},     {0x98, 0x99, false, 0, false},
        {0xB8, 0xBF, false, 4, false},    {0xC1, 0xC1, true, 1, false},
        {0xD1, 0xD1, true, 0, false},     {0xD3, 0xD3, true, 0, false},
        {0xE9, 0xE9, false, 4, true},     {0xEB, 0xEB, false, 1, true},
        {0x0F10, 0x0F11, true, 0, false}, {0x0F28, 0x0F2F, true, 0, false},
        {0x0F40, 0x0F4F, true, 0, false}, {0x0F51, 0x0F51, true, 0, false},
        {0x0F54, 0x0F5F, true, 0, false}, {0x0F6E, 0x0F6E, true, 0, false},
        {0x0F7E, 0x0F7E, true, 0, false}, {0x0F80, 0x0F8F, false, 4, true},
        {0x0F90, 0x0F9F, true, 0, false}, {0x0FAF, 0x0FAF, true, 0, false},
        {0x0FB6, 0x0FB7, true, 0, false}, {0x0FBE, 0x0FBF, true, 0, false},
        {0x0FD6, 0x0FD6, true, 0, false}, {0x0FEF, 0x0FEF, true, 0, false}};

    static const Form* form_of(std::uint32_t opcode) {
        const std::uint32_t plain = opcode & 0xFFFF;
        const auto it = std::ranges::find_if(
            forms, [&](const Form& form) { return form.first <= plain && plain <= form.last; });
        return it == std::end(forms) ? nullptr : it;
    }

    std::uint8_t take() { return next_ < code_.size() ? code_[next_++] : std::uint8_t{0}; }

    void read_opcode(ProcessorInstruction& made) {
        std::uint8_t byte = take();
        if (byte == 0x66 || byte == 0xF2 || byte == 0xF3) {
            made.opcode = std::uint32_t{byte} << 16;
            byte = take();
        }
        if (byte >> 4 == 4) {
            made.extension = byte & 15;
            byte = take();
        }
        if (byte == 0x0F) {
            made.opcode |= 0x0F00;
            byte = take();
        }
        made.opcode |= byte;
    }

    void read_place(ProcessorInstruction& made) {
        made.modes = take();
        made.place_at = next_;
        const int mode = made.modes >> 6, base = made.modes & 7;
        if (mode == 3) return;
        const bool has_index = base == 4;
        const int indexed_base = has_index ? take() & 7 : base;
        if (mode == 1) next_ += 1;
        if (mode == 2 || (mode == 0 && indexed_base == 5)) next_ += 4;
    }

    std::size_t distance(std::size_t place, std::size_t bytes) const {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < bytes; ++i) value |= std::uint32_t{code_[place + i]} << (8 * i);
        const auto number = static_cast<std::int32_t>(value << (32 - 8 * bytes));
        return static_cast<std::size_t>(std::int64_t{number >> (32 - 8 * bytes)});
    }

    std::span<const unsigned char> code_;
    std::size_t next_ = 0;
};

}  // namespace lineshaft::st
