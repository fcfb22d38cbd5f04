#pragma once

#include <span>

#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Set-dominant memory, IEC 61131-3:2013, table 43: q1 = s1 or (not r and q1).
struct Sr {
    bool s1 = false, r = false;
    bool q1 = false;

    static constexpr std::string_view type = "sr";
    static constexpr std::string_view doc = "bistable memory, set dominant";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

/// Reset-dominant memory, table 43: q1 = not r1 and (s or q1).
struct Rs {
    bool s = false, r1 = false;
    bool q1 = false;

    static constexpr std::string_view type = "rs";
    static constexpr std::string_view doc = "bistable memory, reset dominant";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

}  // namespace lineshaft
