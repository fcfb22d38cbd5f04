#pragma once

#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

#include "runtime/model/catalog.hpp"
#include "runtime/run/link.hpp"

namespace lineshaft {

enum class Pace : std::int64_t { slow, fast };
enum class SmallUnit : std::int64_t { mm, rad };

inline constexpr std::string_view pace_names[] = {"slow", "fast"};
inline constexpr std::string_view small_unit_names[] = {"mm", "rad"};

/// Counts its scans.
struct Counter {
    bool enable = true;
    std::int64_t step = 1;
    std::int64_t count = 0;
    bool odd = false;
    Pace pace = Pace::slow;

    static constexpr std::string_view type = "counter";
    static constexpr std::string_view doc = "Counts its scans";
    static std::span<const Field> fields() {
        static const Field table[] = {
            input("enable", &Counter::enable, "", "counts while true"),
            input("step", &Counter::step, "", "added each scan").at_least(1).at_most(9),
            output("count", &Counter::count, "", "scans"),
            output("odd", &Counter::odd, "", "the count is odd"),
            output("pace", &Counter::pace, "", "fast when odd").one_of(pace_names),
        };
        return table;
    }
    void scan(const Scan&) {
        if (enable) count += step;
        odd = count % 2 != 0;
        pace = odd ? Pace::fast : Pace::slow;
    }
};

/// Multiplies.
struct Gain {
    SmallUnit unit = SmallUnit::mm;
    double factor = 1, x = 0, y = 0, rate = 0;

    static constexpr std::string_view type = "gain";
    static constexpr std::string_view doc = "Multiplies";
    static std::span<const Field> fields() {
        static const Field table[] = {
            parameter("unit", &Gain::unit, "", "of x and y").one_of(small_unit_names),
            parameter("factor", &Gain::factor, "", "y / x").above(0).below(100),
            input("x", &Gain::x, "{unit}", "taken").must_be_set(),
            output("y", &Gain::y, "{unit}", "factor * x"),
            output("rate", &Gain::rate, "{unit}/s", "nothing, for its unit"),
        };
        return table;
    }
    void scan(const Scan&) { y = factor * x; }
};

/// Keeps what it gets.
struct Probe {
    bool flag = false;
    double number = 0, length = 0, delay = 0;
    Pace pace = Pace::slow;

    static constexpr std::string_view type = "probe";
    static constexpr std::string_view doc = "Keeps what it gets";
    static std::span<const Field> fields() {
        static const Field table[] = {
            input("flag", &Probe::flag, "", "any"),
            input("number", &Probe::number, "", "any"),
            input("length", &Probe::length, "m", "any"),
            input("delay", &Probe::delay, "s", "any"),
            input("pace", &Probe::pace, "", "any").one_of(pace_names),
        };
        return table;
    }
    void scan(const Scan&) {}
};

/// Reads a counter that it refers to.
struct Display {
    std::int64_t counter = -1, shown = 0, highest = 0;

    static constexpr std::string_view type = "display";
    static constexpr std::string_view doc = "Shows a counter";
    static std::span<const Field> fields() {
        static const Field table[] = {
            in_out("counter", &Display::counter, "counter", "that is shown"),
            output("shown", &Display::shown, "", "its count"),
            local("highest", &Display::highest, "", "greatest count so far"),
        };
        return table;
    }
    void scan(const Scan&, const Context& context) {
        shown = context.instance<Counter>(counter).count;
        highest = std::max(highest, shown);
    }
};

inline Catalog small_catalog() {
    Catalog catalog;
    catalog.add<Counter>().add<Gain>().add<Probe>();
    return catalog;
}

inline std::shared_ptr<const SourceFile> small_file(std::string text) {
    return std::make_shared<const SourceFile>(SourceFile{"p.yaml", std::move(text)});
}

/// Each diagnostic as `code line:column`, in order of place.
inline std::string codes_of(const Diagnostics& out) {
    std::string text;
    std::istringstream lines(out.render());
    for (std::string line; std::getline(lines, line);) {
        const auto code = line.find("error[");
        if (!line.starts_with("p.yaml:") || code == std::string::npos) continue;
        if (!text.empty()) text += "; ";
        text += line.substr(code + 6, 5) + " " + line.substr(7, code - 9);
    }
    return text;
}

}  // namespace lineshaft
