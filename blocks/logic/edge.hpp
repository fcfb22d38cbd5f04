#pragma once

#include <span>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Edge detection, IEC 61131-3:2013, table 44: q is true for one scan per rising (R_TRIG) or
/// falling (F_TRIG) edge of `clk`. As there, before the first scan the memory is clear: R_TRIG with
/// clk true, and F_TRIG with clk false, give one pulse at the first scan (F_TRIG in some languages
/// does not).
template <bool falling>
struct Edge {
    bool clk = false;

    bool q = false;

    bool last = false;  ///< the level looked for was there

    static constexpr std::string_view type = falling ? "f_trig" : "r_trig";
    static constexpr std::string_view doc =
        falling ? "falling edge: q is true for one scan; clk false at the first scan is one"
                : "rising edge: q is true for one scan; clk true at the first scan is one";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Edge::clk;
    void scan(const Scan& now);
};

using RTrig = Edge<false>;
using FTrig = Edge<true>;

}  // namespace lineshaft
