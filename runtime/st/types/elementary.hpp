#pragma once

#include <span>
#include <string_view>

#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// Bytes that a text may have: LEN, FIND and MAX_LEN are INT.
inline constexpr Wide longest_text = 32767;

/// `INT`, `ARRAY[0..3] OF LREAL`: for messages.
std::string describe(const Type& type);

/// BOOL, SINT, ..., LTIME; null for another name. Texts are UTF-8,
/// and what counts the characters of a STRING counts bytes.
const Type* find_elementary(std::string_view name);

/// STRING without a length, as the dialect has it.
const Type& unsized_string(const Dialect& dialect);
/// WSTRING without a length.
const Type& unsized_wide_string(const Place& place);
/// A WSTRING counts units of UTF-16 there, and a WCHAR is one. In SCL they are STRING and CHAR.
bool has_wide_texts(const Place& place);

/// What stands before '#': also Siemens' B, W, DW, LW and L.
const Type* find_prefix(std::string_view name);

/// NULL, before it is known where it goes.
extern const Type null_type;

/// What CODESYS has beside the standard's: BIT, a BOOL, of which eight in a structure share a byte;
/// __XWORD, __UXINT and __XINT, as wide as a pointer. Null for another name.
const Type* find_codesys_type(std::string_view name);

extern const Type &bool_type, &int_type, &dint_type, &lint_type, &ulint_type, &real_type,
    &lreal_type, &time_type, &ltime_type, &date_type, &clock_type, &moment_type, &any_integer_type,
    &any_real_type, &any_bits_type, &string_type, &open_string_type, &char_type, &wide_string_type,
    &open_wide_string_type, &wide_char_type, &unsigned_ltime_type;

/// The integer or bit string of that width.
const Type& integer_type(int bits, bool is_signed);
const Type& bits_type(int bits);

/// True where every value of `from` is one of `to`.
bool widens(const Type& from, const Type& to);

/// The smallest type that holds all values of both; null if there is none.
const Type* common_type(const Type& a, const Type& b);

bool same_type(const Type& a, const Type& b);

/// Limits of an integer, a bit string, a boolean; of a subrange its own.
Wide smallest(const Type& type);
Wide largest(const Type& type);

/// What a slot has of an integer, a bit string, a time.
Wide whole_in(const Type& type, std::uint64_t slot);

/// `value` in the type's width: what is beyond it wraps.
Wide wrapped(const Type& type, Wide value);

}  // namespace lineshaft::st
