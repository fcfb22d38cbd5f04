#pragma once

#include "runtime/st/library/kind.hpp"

namespace lineshaft::st {

/// A PROGRAM that sources name: its memory is that of the program's block of its name.
inline bool is_program(const Global& global) {
    return !global.pou && !global.object && global.type->kind == Type::Kind::block;
}

/// The fields of a PROGRAM or a FUNCTION_BLOCK, and of them those that are checked or given by a
/// call.
void write_fields(Library::Made& made, KindContext& kind, const Routine& routine);
/// Those of a data block.
void write_fields(Library::Made& made, KindContext& kind, const Global& global);

/// Writes the fields of a block of tests, which names all that is beside it.
void write_test_fields(Library::Made& made, KindContext& kind, const Routine& fixture);

/// A kind of each data block and `VAR_GLOBAL`, and of a PROGRAM that is named and has none yet.
void add_data_blocks(Library::Made& made, const Options& options);

/// An AXIS_REF or another reference to a block of the program that nobody gives.
struct KeptReference {
    int global = -1;  ///< whose it is; -1: the PROGRAM's
    std::size_t offset = 0;
    const BlockType* to = nullptr;
};

/// All that a PROGRAM and the globals keep for themselves, in their blocks, structures and arrays.
std::vector<KeptReference> kept_references(Library::Made& made, const Routine& program,
                                           const Catalog& standard);

/// `Base.` of a PRIVATE variable whose name what extends its block has, too; else nothing.
std::string of_base(const Routine& block, const Variable& variable);

/// What comments say, in one line.
std::string text_of_comments(std::string_view written);

// image.cpp

/// The kind of block that has a program's process image: its bytes, and of each address that is
/// named a value as others see it, which is a field `%QW4`. Before all blocks of its task it takes
/// what has changed of these values since (wires, stimuli, forces, clients) into the bytes, and
/// after them it shows what the bytes have. Of an address in I the field is an input, in Q an
/// output, in M a local,
/// and an input of the same name, which others set.
BlockType image_type(Library::Made& made, const std::shared_ptr<const Library::Made>& owner,
                     const Global& global);

}  // namespace lineshaft::st
