#pragma once

#include <algorithm>

#include "runtime/st/code/opcodes.hpp"
#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// The opcode that stands so many lines behind.
constexpr Op after(Op op, int by) {
    return static_cast<Op>(static_cast<int>(op) + by);
}

/// An opcode of a family, for a type: `add_sint` and DINT give `add_dint`.
Op of_type(Op first, const Type& type);

/// A slot as an operand.
using Slot = std::uint32_t;

/// A call of a standard function as what is emitted for it sees it: the arguments and the result's
/// type. `generate` is what is behind it.
struct Emission {
    explicit Emission(const Expression& of_function) : call(of_function) {}
    virtual ~Emission() = default;

    const Type& type() const { return *call.type; }
    bool is_narrow() const { return type().kind == Type::Kind::real && type().bits == 32; }
    std::size_t count() const { return call.arguments.size(); }
    /// A text that is given has units of UTF-16.
    bool is_wide() const {
        return std::ranges::any_of(call.arguments,
                                   [](const Argument& a) { return a.value->type->is_wide; });
    }
    const Expression& given(std::size_t argument) const { return *call.arguments[argument].value; }

    /// The instruction's value in a new temporary.
    virtual Slot emit(Op op, Slot b, Slot c = 0) = 0;
    /// The last instruction's value, which is the function's and is where that is wanted.
    virtual Slot result(Op op, Slot b, Slot c = 0) = 0;
    /// The same of an instruction of LREAL, rounded to what the function gives.
    Slot rounded(Op op, Slot b, Slot c = 0) {
        return is_narrow() ? result(Op::narrow, emit(op, b, c)) : result(op, b, c);
    }
    Op of_real(Op real, Op lreal) const { return is_narrow() ? real : lreal; }
    Op of_number(Op real, Op of_unsigned, Op of_signed) const {
        return type().is_real() ? real : type().is_unsigned_64() ? of_unsigned : of_signed;
    }

    /// It stays what it is while the arguments behind it are computed; so does a text.
    virtual Slot value(std::size_t argument) = 0;
    virtual Slot text(std::size_t argument) = 0;  ///< a slot with its address
    /// A value; of a text, an array, a structure a slot with its address.
    virtual Slot value_or_address(std::size_t argument) = 0;
    /// Those of the arguments from `first` on, one behind the other.
    virtual Slot several(std::size_t first) = 0;
    /// A slot for the result, where it is wanted.
    virtual Slot wanted_slot() = 0;
    virtual Slot capacity(std::size_t argument) = 0;  ///< of a text

    virtual Slot reference(std::size_t argument) = 0;  ///< the first of its slots
    /// A slot with the address of a reference that is so many bytes behind another one.
    virtual Slot moved(Slot reference, Slot bytes) = 0;
    /// An instruction that gives nothing, or whose slot `a` is given.
    virtual void put(Op op, Slot a, Slot b, Slot c, Slot d = 0) = 0;

    virtual Slot constant(std::uint64_t bits) = 0;
    /// What is emitted next is not fused with what was before.
    virtual void land() = 0;
    /// `slot` again, where what is not below `count` is a fault.
    virtual Slot index(Slot slot, std::uint64_t count) = 0;
    /// `slot`, whose number is the result: wrapped, or a fault where overflow is one.
    virtual Slot fitted(Slot slot) = 0;
    /// A slot with the address of a new text, which is empty.
    virtual Slot new_text() = 0;
    /// Puts characters of one text behind another, from the one numbered `first` (from 0) on.
    virtual void append(Slot to, Slot from, Slot first, Slot count) = 0;
    /// The argument as a timer begins, but with the time that was given to it.
    virtual void reset_timer(std::size_t argument) = 0;

    const Expression& call;
};

/// Emits a function, and gives the slot with its value; of a text, an array or a structure a slot
/// with its address; of a statement none that is read.
using Emit = Slot (*)(Emission& e);

}  // namespace lineshaft::st
