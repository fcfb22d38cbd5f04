#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "blocks/logic/number.hpp"
#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

/// Selection of numbers, IEC 61131-3:2013, table 32. An input that is not finite is an error even
/// if it is not the one selected.
namespace lineshaft {

/// SEL: out = g ? in1 : in0.
struct Sel {
    NumberUnit unit{};
    bool g = false;
    double in0 = 0, in1 = 0;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = "sel";
    static constexpr std::string_view doc = "one of two numbers: in0, or in1 while g is true";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

/// MUX: out = input number k, 0 to 7. Another k is an error.
struct Mux {
    NumberUnit unit{};
    std::int64_t k = 0;
    double in0 = 0, in1 = 0, in2 = 0, in3 = 0, in4 = 0, in5 = 0, in6 = 0, in7 = 0;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = "mux";
    static constexpr std::string_view doc = "one of up to eight numbers: input number k";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

/// LIMIT: out = MIN(MAX(in, mn), mx). With crossed limits mx wins.
struct Limit {
    NumberUnit unit{};
    double mn = 0, in = 0, mx = 0;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = "limit";
    static constexpr std::string_view doc = "a number held between mn and mx";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Limit::in;
    std::optional<Misfit> misfit(const IsConstant& is_constant) const;
    void scan(const Scan& now);
};

/// MIN, MAX of two numbers.
template <bool greatest>
struct Extremum {
    NumberUnit unit{};
    double in1 = 0, in2 = 0;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = greatest ? "max" : "min";
    static constexpr std::string_view doc =
        greatest ? "the greater of two numbers" : "the smaller of two numbers";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

using Min = Extremum<false>;
using Max = Extremum<true>;

/// MOVE with its enable input: out follows `in` while `en` is true and holds otherwise. Called
/// as Siemens titles it, for `move` is the motion of an axis.
struct MoveValue {
    NumberUnit unit{};
    bool en = true;
    double in = 0;

    double out = 0;
    bool error = false;
    NumberError error_id = NumberError::none;

    static constexpr std::string_view type = "move_value";
    static constexpr std::string_view doc = "MOVE: copies a number while en is true";
    static std::span<const Field> fields();
    void scan(const Scan& now);
};

}  // namespace lineshaft
