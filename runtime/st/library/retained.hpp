#pragma once

#include <string>
#include <vector>

#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// A value that outlives the run because its declaration says so, or stands in what does.
struct RetainedVariable {
    std::string path;            ///< within its block: `table[3].x`, `delay`
    const Type* type = nullptr;  ///< a scalar, a text, a union, an instance of the catalogue, or a
                                 ///< list of more than most_elements numbers
    std::size_t offset = 0;      ///< in the memory of the block
    std::size_t size = 0;        ///< of it [bytes]
};

/// What of a block of a kind of some library stands in VAR RETAIN or VAR PERSISTENT, and what is in
/// instances and structures there. What a block declares to be RETAIN is so in each of its
/// instances, however these are declared, NON_RETAIN likewise; what it leaves open is as the
/// instance is. Constants, temporaries and references are not retained, nor what a program's file
/// gives the block: its inputs and parameters. Of another kind nothing.
std::vector<RetainedVariable> retained(const BlockType& kind);

/// A variable of that type may have what stands there, whatever its bytes are. Of what refers to
/// something, and of an instance, it is not known here.
bool is_value(const Type& type, const std::byte* place);

}  // namespace lineshaft::st
