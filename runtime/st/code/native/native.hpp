#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/st/code/machine.hpp"

namespace lineshaft::st {

namespace meaning {
struct Frames;
}

/// How an instruction is entered: with the first slot of the frame that it works on, and how many
/// passes of loops and calls are left.
using NativeEntry = Fault (*)(std::byte* base, meaning::Frames& frames, std::int64_t fuel);

/// The code of a library as the processor's, made of stencils: of each instruction the code of its
/// line, its operands filled in. It is never writable and executable at the same time.
struct Native {
    const std::byte* first = nullptr;   ///< of the memory that has it
    std::size_t size = 0;               ///< of that memory [bytes]
    std::vector<std::uint32_t> places;  ///< of each instruction, from `first` on
    std::vector<NativeEntry> copied;    ///< the scans of the routines
    /// The same by what a compiler made of each routine, as soon as it did: `compile`.
    std::atomic<const NativeEntry*> scans = nullptr;

    Native() = default;
    ~Native();
    Native(const Native&) = delete;
    Native& operator=(const Native&) = delete;

    NativeEntry entry(std::uint64_t instruction) const {
        return reinterpret_cast<NativeEntry>(const_cast<std::byte*>(first) +
                                             places.data()[instruction]);
    }
    NativeEntry scan_of(std::uint32_t routine) const {
        return scans.load(std::memory_order_acquire)[routine];
    }
};

/// Native code of code that is verified, and stays where it is. Null: there is none, on another
/// processor, for an operand that does not fit its hole, or where the system refuses memory that
/// is executed, which `is_refused` tells from then on.
std::shared_ptr<const Native> native_code(const Code& code);
bool is_native_refused();

/// From now on this process interprets all that it compiles, as if there were no native code.
void switch_native_off();

/// The end of a scan at the instruction before `behind`. The stencils end with it.
extern "C" [[gnu::cold]] Fault native_end(std::byte* base, meaning::Frames& frames,
                                          std::int64_t fuel, std::uint64_t behind, Fault fault);

/// Code::call_block, for what a compiler made.
extern "C" void native_call_block(const Code& code, std::byte* block, std::uint32_t number,
                                  const Scan& now, const Context& context);

}  // namespace lineshaft::st
