#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "runtime/model/address.hpp"
#include "runtime/st/syntax/constant.hpp"

namespace lineshaft::st {

/// `1_000`, `16#FF`, `2#1010_0000`; empty if it is none, or beyond 64 bits.
std::optional<Wide> read_integer(std::string_view text);

/// `1_000.5`, `1e3`; empty if it is beyond a double.
std::optional<double> read_real(std::string_view text);

/// What follows `T#`, in ns: `1h2m3.5s`, `-5ms`, `1d_2h`. Empty if it is none, or beyond 64 bits,
/// of which one is the sign, or none.
std::optional<Wide> read_duration(std::string_view text, bool has_no_sign = false);

/// What follows `D#`, `TOD#`, `DT#`: `2020-02-29` [ns since 1970], `12:30:15.25` [ns],
/// `2020-02-29-12:30:15` [ns since 1970]. Empty if it is none, or beyond 64 bits.
std::optional<Wide> read_date(std::string_view text);
std::optional<Wide> read_clock(std::string_view text);
std::optional<Wide> read_moment(std::string_view text);

/// The characters of a text between its quotes: `$'`, `$$`, `$L`, `$N`, `$P`, `$R`, `$T`, `$0A`;
/// `''` is one, but in a wide one, `"..."`.
std::optional<std::string> read_text(std::string_view text, bool is_wide = false);

/// `M0.3`, `EW4`: as STEP 7 V5 writes addresses, without a '%', the areas in German, too (E, A).
std::optional<ImageAddress> read_classic_address(std::string_view text);
/// `DB10`
bool is_data_block(std::string_view text);

std::string to_string(Wide value);

}  // namespace lineshaft::st
