#pragma once

#include "runtime/st/check/check.hpp"
#include "runtime/st/code/code.hpp"

namespace lineshaft::st {

/// What an Op::stop of a test stands for. Its slots have what was found and expected, and the
/// tolerance; of texts, addresses. The instruction behind it is not executed, and has the slot with
/// the address of the message.
struct Assertion {
    std::uint32_t instruction = 0;
    TestCall call = TestCall::none;
    Place place = {};
    const Type *found = nullptr, *wanted = nullptr;
    std::string part = {};  ///< of an array or a structure: `[2].x`
    bool has_message = false;
};

/// Lays out the memory of all types and routines (notes slots in them), and writes their code.
/// `images` has that of each block and each global by its type: an instance as it begins.
struct Generated {
    Code code;
    std::unordered_map<const Type*, std::vector<std::uint64_t>> images;
    std::vector<Assertion> assertions;
};

struct CodeOptions {
    bool overflow_faults = false;  ///< an integer beyond its type is a fault, else it wraps
    bool covered = false;          ///< count what is executed, other than of the file of tests
    bool counted = false;          ///< instructions are counted: none is fused
};

/// L0912: more memory than a block may have.
Generated generate(Checked& checked, Diagnostics& out, const CodeOptions& options);

}  // namespace lineshaft::st
