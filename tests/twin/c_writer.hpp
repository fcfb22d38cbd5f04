#pragma once

#include <string>

#include "runtime/st/check/check.hpp"

namespace lineshaft::st {

/// The checked sources as C: a second reading of what they mean, which shares nothing with the
/// generator and the machine. `p<number>_begin`, `p<number>_scan` and `p<number>_dump` are those of
/// the PROGRAM `main`, see `struct twin` of prelude.h. A scan returns 0, or 1,000,000 times the
/// fault plus its line; it takes the VAR_INPUTs, which are scalars, each as a slot of 64 bits. A
/// dump is what parts_of() lists.
std::string write_c(const Checked& checked, const Routine& main, int number);

/// A scalar, a text, or bytes of an instance.
struct Part {
    std::string name;
    const Type* type = nullptr;
    int global = -1;         ///< the data block that it is of; -1: the program itself
    std::size_t offset = 0;  ///< in bytes
    bool is_byte = false;
    std::size_t bytes = 0;  ///< of a UNION, or of the process image
};

/// All that lives in a program and in the data blocks, after generate() has given it memory.
std::vector<Part> parts_of(const Checked& checked, const Routine& main);

}  // namespace lineshaft::st
