#include "runtime/source/units.hpp"

#include <fmt/core.h>

#include "tools/lineshaft/command.hpp"

namespace lineshaft {

namespace {

constexpr const char* grammar =
    "They are combined with '*' and '/' and a power, without blanks: mm/s, mm/s^2, rad/s, "
    "pulses/cm, 1/s.\n"
    "A value is converted within what it measures: 2 cm is 20 mm, 60 rpm is 1 rev/s.\n";

/// How much of the quantity's first unit one is.
std::string in_base(const Unit& unit) {
    static const char* const bases[] = {"m", "rad", "s", "pulse"};
    std::string text;
    for (std::size_t i = 0; i < Unit::dimensions; ++i) {
        if (unit.exponents[i] > 0) text += fmt::format("{}{}", text.empty() ? "" : "*", bases[i]);
        if (unit.exponents[i] < 0) text += fmt::format("{}/{}", text.empty() ? "1" : "", bases[i]);
    }
    return text.empty() ? text : " " + text;
}

}  // namespace

void add_units(CLI::App& app, Exit&) {
    CLI::App* sub = app.add_subcommand("units", "List the units that values are written in");
    sub->callback([] {
        for (const std::string& name : unit_names()) {
            const Unit unit = *Unit::parse(name);
            fmt::print("{:8} {:12} {}{}\n", name, unit.dimension_name(),
                       format_number(unit.numerator / unit.denominator), in_base(unit));
        }
        fmt::print("\n{}", grammar);
    });
}

}  // namespace lineshaft
