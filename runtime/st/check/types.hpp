#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

constexpr Wide most_elements = 1 << 24;  ///< of an array

/// The type that is written; null where it is wrong, which was told: L0904 for a name that is none,
/// L0911 for a type that contains itself.
const Type* resolve(Checking& c, const TypeText& text);
/// The same of what is given to a call, which alone may be an ARRAY[*].
const Type* resolve_parameter(Checking& c, const TypeText& text);
/// `REF_TO ARRAY[*] OF T` of a variable, which resolve_parameter() takes: it has bounds as well.
bool refers_to_open_array(const TypeText& text);
const Type* resolve_name(Checking& c, const Token& name);
/// LTIME, which has no sign in CODESYS and TwinCAT.
const Type& long_time_type(const Place& place);
/// WSTRING and WCHAR are STRING and CHAR in SCL, an LTIME is that of the dialect; another type, or
/// null, is itself.
const Type* in_dialect(const Type* type, const Place& place);
const Type* resolve_declared(Checking& c, NamedType& named);

// catalog_types.cpp

/// A block of the catalogue, or a reference to one, also by the name that vendors give it; null for
/// another name. It begins as the vendor has it.
const Type* standard_type(Checking& c, std::string_view name, Vendor vendor = Vendor::none);

}  // namespace lineshaft::st
