#pragma once

#include <optional>
#include <span>

#include "runtime/model/catalog.hpp"
#include "runtime/model/field.hpp"
#include "runtime/model/scan.hpp"

namespace lineshaft {

/// Type of a counter's value, whose limits it stops at (a ULINT at those of a LINT). The standard's
/// CTU counts in INT, its CTU_DINT, CTU_LINT, CTU_UDINT and CTU_ULINT in others, Siemens' in all.
enum class CounterType : std::int64_t { int_, dint, lint, udint, ulint, sint, usint, uint };

/// Counters of IEC 61131-3:2013, table 45. They count rising edges of `cu` and `cd`; an input that
/// is true at the first scan has risen. An edge during reset or load is not counted later. cv stops
/// at the limits of `data_type`; a pv beyond them is loaded as the limit, and cv never gets there.
/// With `stops_at_preset`, as in MatIEC, it is counted up to pv and down to 0 at most.
///
/// CTU: r sets cv to 0, else an edge of cu adds 1; q = cv >= pv.
struct Ctu {
    CounterType data_type = CounterType::int_;
    bool cu = false, r = false;
    std::int64_t pv = 0;

    bool q = false;
    std::int64_t cv = 0;

    bool last_cu = false;
    bool stops_at_preset = false;

    static constexpr std::string_view type = "ctu";
    static constexpr std::string_view doc = "up counter";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Ctu::cu;
    std::optional<Misfit> misfit(const IsConstant& is_constant) const;
    void scan(const Scan& now);
};

/// CTD: ld sets cv to pv, else an edge of cd takes 1; q = cv <= 0.
struct Ctd {
    CounterType data_type = CounterType::int_;
    bool cd = false, ld = false;
    std::int64_t pv = 0;

    bool q = false;
    std::int64_t cv = 0;

    bool last_cd = false;
    bool stops_at_preset = false;

    static constexpr std::string_view type = "ctd";
    static constexpr std::string_view doc = "down counter";
    static std::span<const Field> fields();
    static constexpr auto main_input = &Ctd::cd;
    std::optional<Misfit> misfit(const IsConstant& is_constant) const;
    void scan(const Scan& now);
};

/// CTUD: r sets cv to 0, else ld sets it to pv, else an edge of cu adds 1 and one of cd takes 1;
/// both in one scan change nothing. qu = cv >= pv, qd = cv <= 0.
struct Ctud {
    CounterType data_type = CounterType::int_;
    bool cu = false, cd = false, r = false, ld = false;
    std::int64_t pv = 0;

    bool qu = false, qd = false;
    std::int64_t cv = 0;

    bool last_cu = false, last_cd = false;
    bool stops_at_preset = false;

    static constexpr std::string_view type = "ctud";
    static constexpr std::string_view doc = "up and down counter";
    static std::span<const Field> fields();
    std::optional<Misfit> misfit(const IsConstant& is_constant) const;
    void scan(const Scan& now);
};

}  // namespace lineshaft
