#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/model/catalog.hpp"
#include "runtime/st/syntax/dialect.hpp"

namespace lineshaft::st {

/// `name`, whatever its capitals, is one of `words`, small ones between two blanks each.
bool has_word(std::string_view words, std::string_view name);

/// IEC 61131-3's or PLCopen's name of a type or a kind of block that vendors call otherwise:
/// `TO_POSITIONINGAXIS` is AXIS_REF, `IEC_TIMER` is TON. Any other name is its own.
std::string_view standard_type_name(std::string_view name);

/// What a kind of block calls a part that vendors call otherwise, where it has that: RESET is R.
/// Empty for any other name.
std::string_view standard_part_name(std::string_view name);

/// What CODESYS calls a part of the standard's blocks: r is RESET, q is Q. One of PLCopen's blocks
/// is as it is.
std::string long_part_name(std::string_view name);

/// What CODESYS' and SIMATIC AX' functions of texts call an argument, as the standard does: STR1
/// and string1 are IN1, SIZE is L.
std::string_view standard_argument_name(std::string_view name);

/// A library of CODESYS, Beckhoff or SIMATIC AX whose names are here without it.
bool is_vendor_library(std::string_view name);

/// Its names are seen without its own, where nobody else has them. One is not open that has a point
/// in its name, or `{attribute 'qualified_only'}` before all.
bool is_open(const LibraryFile& file);

/// Whose names sources in SCL have without it, as they have the instructions of STEP 7.
inline constexpr std::string_view siemens_motion = "Siemens.Simatic.S71500.MotionControl.Native";

/// What a library is called here: newer editions of SIMATIC AX name its motion without a
/// controller.
constexpr std::string_view library_called(std::string_view name) {
    return name == "Siemens.Simatic.MotionControl.Native" ? siemens_motion : name;
}

/// Timers and counters of controllers themselves, filters, a clock; its names are seen as those.
inline constexpr std::string_view siemens_step7 = "Siemens.Step7";

/// What is written to it of TwinCAT's interface of an axis has an effect here.
bool counts_for_axis(std::string_view member);

/// `TON` of `Standard.TON`, where the first is such a library; else the name as it is.
std::string_view without_library(std::string_view name);

/// Stands before the name of a catalogue's block that one of CODESYS or TwinCAT extends.
inline constexpr std::string_view extended_blocks = "Standard.extended_";

/// What Siemens' programs name by `"Axis_1"` without declaring it.
inline constexpr std::string_view technology_object = "axis_ref";

/// An input that vendors add to PLCopen's commands of an axis: one without a real drive does the
/// same with and without, with some if they are this constant.
struct AddedInput {
    std::string_view name;
    std::optional<double> only = {};
};

/// Null for another name.
const AddedInput* find_added_input(std::string_view name);

/// What the numbers mean that Siemens gives an enumeration of PLCopen's commands.
struct Meanings {
    std::span<const std::int64_t> places;  ///< of a value in its list; -1: nothing
    bool all_others_as_last = false;  ///< of a number that has no place; else it has no meaning
};

/// By the name of the input. Empty where there are none.
Meanings meanings_of_numbers(std::string_view input);

/// What a block begins with in one vendor's language, and not elsewhere.
struct Beginning {
    std::string_view kind, part;
    int value = 0;
};

/// Null for another kind.
const Beginning* find_beginning(std::string_view kind, Vendor vendor);

// instead.cpp

/// What to write instead of a type, a function or an input of a block that controllers of Siemens,
/// Beckhoff or CODESYS have and this one does not: half a sentence of a message. Empty for any
/// other name; capital letters make no difference.
std::string_view instead_of_type(std::string_view name, Vendor vendor);
std::string_view instead_of_function(std::string_view name);
std::string_view instead_of_input(std::string_view name);
/// The same of an address, `%KW5`.
std::string_view instead_of_address(std::string_view address);
/// The same of what nobody declares, which another vendor's controller has: `GetTime`, and `X0`,
/// where no other name is like it.
std::string_view instead_of_undeclared(std::string_view name, bool may_be_device);

}  // namespace lineshaft::st
