#include "runtime/st/code/native/native.hpp"

#include <atomic>
#include <cstring>
#include <limits>

#include <sys/mman.h>

#include "runtime/st/code/meaning.hpp"
#include "runtime/st/code/native/compile.hpp"
#include "runtime/st/code/native/kept.hpp"

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
/// The load of a real, which as a move between registers would wait for what the register had.
constexpr unsigned char real_load[] = {0xF2, 0x0F, 0x10};

/// Copies the stencils of all instructions, and fills their holes.
class Patching {
  public:
    Patching(const Code& code, Native& native) : code_(code), native_(native), parts_(code) {}

    /// Lays out the far jumps, the constants, the instructions, and what is seldom executed.
    std::uint64_t lay_out() {
        constants_ = far_jump_size * stencil_externals_count;
        std::uint64_t size = (constants_ + stencil_constants_size + 15) / 16 * 16;
        native_.places.reserve(code_.instructions.size() + 1);
        std::uint64_t cold_size = 0;
        parts_.each([&](const StencilCopy& part) {
            if (part.number == native_.places.size())
                native_.places.push_back(static_cast<std::uint32_t>(size));
            size += size_of(part);
            cold_size += part.stencil().cold_size;
        });
        native_.places.push_back(static_cast<std::uint32_t>(size));
        cold_ = size;
        return size + cold_size;
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
        hot_ = native_.places.front();
        parts_.each([&](const StencilCopy& part) { fits = write_part(part) && fits; });
        return fits;
    }

  private:
    static std::uint32_t left_out(const StencilCopy& part) {
        return part.leaves_out_load ? part.stencil().load : 0;
    }

    static std::uint32_t size_of(const StencilCopy& part) {
        std::uint32_t size = part.stencil().size - left_out(part);
        for (const KeptSlot& one : part.loads) size += load_size(one.in);
        return part.into == no_register ? size : size + move_size(part.into);
    }

    bool write_part(const StencilCopy& part) {
        for (const KeptSlot& one : part.loads) write_load(one);
        const Stencil& stencil = part.stencil();
        const std::uint32_t skipped = left_out(part);
        const unsigned char* code = stencil_code + stencil.code;
        std::memcpy(first_ + hot_, code + skipped, stencil.size - skipped);
        std::memcpy(first_ + cold_, code + stencil.size, stencil.cold_size);
        begin_ = hot_ - skipped;
        hot_ += stencil.size - skipped;
        if (part.into != no_register) write_move(part.into, stencil.result);
        bool fits = true;
        for (const Filling& filling : part.fillings())
            if (filling.at >= skipped) fits = fill(part, filling) && fits;
        cold_ += stencil.cold_size;
        return fits;
    }

    bool fill(const StencilCopy& part, const Filling& filling) {
        const std::uint32_t size = part.stencil().size;
        const std::uint64_t place =
            filling.at < size ? begin_ + filling.at : cold_ + filling.at - size;
        if (filling.read_as != ReadAs::memory) {
            const std::uint8_t from = part.sources[static_cast<std::size_t>(filling.hole)];
            const bool is_word = filling.read_as == ReadAs::word;
            if (from != no_register && (from < first_real) == is_word) {
                read_from(from, first_ + place, filling.before);
                return true;
            }
        }
        const std::uint64_t value =
            value_of(filling, part) + static_cast<std::uint64_t>(std::int64_t{filling.addend});
        return fill(filling.width, place, value);
    }

    /// Lets the instruction with that many bytes before a place read a register instead. What it
    /// is shorter stands before it, as prefixes that mean nothing there.
    static void read_from(std::uint8_t from, std::byte* place, std::size_t before) {
        unsigned char code[16];
        std::memcpy(code, place - before, before);
        unsigned char* next = code;
        std::byte* to = place - before;
        const bool has_prefix = *next == 0x66 || *next == 0xF2 || *next == 0xF3;
        const bool is_extended = next[has_prefix] >> 4 == 4;
        const bool is_load = std::memcmp(code, real_load, sizeof real_load) == 0;
        for (int i = is_extended ? 4 : 3; i > 0; --i) *to++ = std::byte{0x3E};
        if (has_prefix) *to++ = std::byte{is_load ? std::uint8_t{0x66} : *next++};
        next += is_load;
        const int extension = is_extended ? *next++ : 0x40;
        *to++ = std::byte(extension | 1);
        for (; next < code + before - 1; ++next) *to++ = std::byte{*next};
        if (is_load) to[-1] = std::byte{0x28};
        *to = std::byte((*next & 0x38) | 0xC0 | (from & 7));
    }

    void write_load(const KeptSlot& one) {
        const auto modes = static_cast<unsigned char>(0x87 | (one.in & 7) << 3);
        const std::uint32_t bytes = 8 * one.slot;
        if (one.in < first_real)
            append({0x4C, 0x8B, modes});
        else
            append({0xF2, 0x44, 0x0F, 0x10, modes});
        std::memcpy(first_ + hot_, &bytes, sizeof bytes);
        hot_ += sizeof bytes;
    }

    void write_move(std::uint8_t to, std::uint8_t from) {
        const int late = to & 7, early = from & 7;
        if (to < first_real)
            append({0x49, 0x89, static_cast<unsigned char>(0xC0 | early << 3 | late)});
        else
            append({0x66, 0x44, 0x0F, 0x28, static_cast<unsigned char>(0xC0 | late << 3 | early)});
    }

    void append(std::initializer_list<unsigned char> code) {
        for (const unsigned char byte : code) first_[hot_++] = std::byte{byte};
    }

    /// Where a place in the code will be.
    std::uint64_t address(std::uint64_t place) const {
        return reinterpret_cast<std::uint64_t>(first_) + place;
    }
    std::uint64_t address_of_table(std::uint64_t number) const {
        return reinterpret_cast<std::uint64_t>(&code_.tables.data()[number]);
    }

    std::uint64_t value_of(const Filling& filling, const StencilCopy& part) const {
        const Instruction& in = part.in;
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
                return part.number + 1;
            case Hole::next_instruction:
                return address(hot_);
            case Hole::jump_target:
            case Hole::repeat_target:
                return address(native_.places[code_.place_of(in.c)] + part.skipped);
            case Hole::called_routine:
                return address(native_.places[called(in).entry]);
            case Hole::external:
                return address(far_jump_size * filling.number);
            case Hole::constant:
                return address(constants_ + filling.number);
            case Hole::own_cold:
                return address(cold_ + filling.number);
            case Hole::own:
                return address(begin_ + filling.number);
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
    const StencilCopies parts_;
    std::byte* first_ = nullptr;
    std::uint64_t constants_ = 0;
    std::uint64_t hot_ = 0, cold_ = 0;  ///< how far they are written
    std::uint64_t begin_ = 0;           ///< where the whole stencil at hand would begin
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
    for (const CodeRoutine& routine : code.routines)
        native->copied.push_back(native->entry(routine.entry));
    native->scans = native->copied.data();
    compile_code(code, native);
    return native;
}

#else

std::shared_ptr<const Native> native_code(const Code&) {
    return {};
}

#endif

}  // namespace lineshaft::st
