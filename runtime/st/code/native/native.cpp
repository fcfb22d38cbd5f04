#include "runtime/st/code/native/native.hpp"

#include <atomic>
#include <cstring>
#include <limits>

#include <sys/mman.h>

#include "runtime/st/code/meaning.hpp"
#include "runtime/st/code/native/compile.hpp"
#include "runtime/st/code/native/stencil.hpp"

namespace lineshaft::st {

namespace {

std::atomic<bool> refused = false, off = false;

}  // namespace

bool is_native_refused() {
    return refused;
}

void switch_native_off() {
    off = true;
}

Native::~Native() {
    if (first) ::munmap(const_cast<std::byte*>(first), size);
}

Fault native_end(std::byte*, meaning::Frames& frames, std::int64_t fuel, std::uint64_t behind,
                 Fault fault) {
    frames.fuel_left = fuel;
    return frames.end(fault, behind - 1);
}

void native_call_block(const Code& code, std::byte* block, std::uint32_t number, const Scan& now,
                       const Context& context) {
    code.call_block(block, number, now, context);
}

#ifdef LINESHAFT_NATIVE

namespace {

/// `jmp *0(%rip)`, and behind it the address of a function that may be far away.
constexpr unsigned char far_jump[] = {0xFF, 0x25, 0, 0, 0, 0};
constexpr std::uint64_t far_jump_size = 16;

/// Copies the stencils of all instructions, and fills their holes.
class Patching {
  public:
    Patching(const Code& code, Native& native) : code_(code), native_(native) {}

    /// Lays out the far jumps, the constants, the instructions, and what is seldom executed.
    std::uint64_t lay_out() {
        constants_ = far_jump_size * stencil_externals_count;
        std::uint64_t size = (constants_ + stencil_constants_size + 15) / 16 * 16;
        native_.places.reserve(code_.instructions.size() + 1);
        const auto grow = [&](std::uint64_t by) {
            native_.places.push_back(static_cast<std::uint32_t>(size));
            size += by;
        };
        for (const Instruction& in : code_.instructions) grow(stencil_of(in).size);
        grow(0);
        cold_ = size;
        for (const Instruction& in : code_.instructions) size += stencil_of(in).cold_size;
        return size;
    }

    /// False for an operand that does not fit its hole.
    bool write(std::byte* first) {
        first_ = first;
        for (std::uint64_t i = 0; i < stencil_externals_count; ++i) {
            std::byte* place = first + far_jump_size * i;
            std::memcpy(place, far_jump, sizeof far_jump);
            std::memcpy(place + sizeof far_jump, &stencil_externals[i], sizeof(void*));
        }
        std::memcpy(first + constants_, stencil_constants, stencil_constants_size);
        bool fits = true;
        for (std::size_t i = 0; i < code_.instructions.size(); ++i) fits = write_one(i) && fits;
        return fits;
    }

  private:
    static const Stencil& stencil_of(const Instruction& in) {
        return stencils[static_cast<std::size_t>(in.op)];
    }

    bool write_one(std::size_t number) {
        const Stencil& stencil = stencil_of(code_.instructions[number]);
        const std::uint64_t hot = native_.places[number];
        const unsigned char* code = stencil_code + stencil.code;
        std::memcpy(first_ + hot, code, stencil.size);
        std::memcpy(first_ + cold_, code + stencil.size, stencil.cold_size);
        bool fits = true;
        for (std::uint32_t i = 0; i < stencil.count; ++i) {
            const Filling& filling = stencil_fillings[stencil.fillings + i];
            const std::uint64_t place =
                filling.at < stencil.size ? hot + filling.at : cold_ + filling.at - stencil.size;
            const std::uint64_t value = value_of(filling, number) +
                                        static_cast<std::uint64_t>(std::int64_t{filling.addend});
            fits = fill(filling.width, place, value) && fits;
        }
        cold_ += stencil.cold_size;
        return fits;
    }

    /// Where a place in the code will be.
    std::uint64_t address(std::uint64_t place) const {
        return reinterpret_cast<std::uint64_t>(first_) + place;
    }
    std::uint64_t address_of_table(std::uint64_t number) const {
        return reinterpret_cast<std::uint64_t>(&code_.tables.data()[number]);
    }

    std::uint64_t value_of(const Filling& filling, std::size_t number) const {
        const Instruction& in = code_.instructions[number];
        const std::uint64_t c = static_cast<std::uint32_t>(in.c);
        switch (filling.hole) {
            case Hole::a_bytes:
                return 8 * std::uint64_t{in.a};
            case Hole::b_bytes:
                return 8 * std::uint64_t{in.b};
            case Hole::c_bytes:
                return 8 * c;
            case Hole::d_bytes:
                return 8 * std::uint64_t{in.d};
            case Hole::a_number:
                return in.a;
            case Hole::b_number:
                return in.b;
            case Hole::c_number:
                return c;
            case Hole::c_upper:
                return in.c >> 32;
            case Hole::d_number:
                return in.d;
            case Hole::c_table:
                return address_of_table(c);
            case Hole::d_table:
                return address_of_table(in.d);
            case Hole::place_behind:
                return number + 1;
            case Hole::next_instruction:
                return address(native_.places[number + 1]);
            case Hole::jump_target:
            case Hole::repeat_target:
                return address(native_.places[code_.place_of(in.c)]);
            case Hole::called_routine:
                return address(native_.places[called(in).entry]);
            case Hole::external:
                return address(far_jump_size * filling.number);
            case Hole::constant:
                return address(constants_ + filling.number);
            case Hole::own_cold:
                return address(cold_ + filling.number);
            case Hole::own:
                return address(native_.places[number] + filling.number);
        }
        return 0;
    }

    const CodeRoutine& called(const Instruction& in) const {
        const std::uint64_t operands[] = {in.a, in.b, in.c, in.d};
        return code_.routines[operands[info(in.op).operands.find('f')]];
    }

    bool fill(Width width, std::uint64_t place, std::uint64_t value) {
        if (width == Width::relative_32) value -= address(place);
        std::memcpy(first_ + place, &value, width == Width::absolute_64 ? 8 : 4);
        if (width == Width::absolute_32) return value <= std::numeric_limits<std::uint32_t>::max();
        const auto number = static_cast<std::int64_t>(value);
        return width == Width::absolute_64 || number == static_cast<std::int32_t>(number);
    }

    const Code& code_;
    Native& native_;
    std::byte* first_ = nullptr;
    std::uint64_t constants_ = 0, cold_ = 0;  ///< where they begin; of the instruction at hand
};

}  // namespace

std::shared_ptr<const Native> native_code(const Code& code) {
    if (off || refused) return {};
    auto native = std::make_shared<Native>();
    Patching patching(code, *native);
    native->size = patching.lay_out();
    if (native->size > std::numeric_limits<std::int32_t>::max()) return {};
    void* const memory =
        ::mmap(nullptr, native->size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        refused = true;
        return {};
    }
    native->first = static_cast<const std::byte*>(memory);
    if (!patching.write(static_cast<std::byte*>(memory))) return {};
    if (::mprotect(memory, native->size, PROT_READ | PROT_EXEC) != 0) {
        refused = true;
        return {};
    }
    compile_code(code, native);
    return native;
}

#else

std::shared_ptr<const Native> native_code(const Code&) {
    return {};
}

#endif

}  // namespace lineshaft::st
