#include "runtime/study/draw.hpp"

#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <sleef.h>

#include "runtime/model/random.hpp"

namespace lineshaft {

namespace {

std::string with_unit(std::string number, const Unit& unit) {
    return unit.text.empty() ? number : fmt::format("{} {}", number, unit.text);
}

double nine_digits(double value) {
    const std::string text = fmt::format("{:.9g}", value);
    double rounded = 0;
    std::from_chars(text.data(), text.data() + text.size(), rounded);
    return rounded;
}

/// Times are whole nanoseconds, as tasks and stimuli want them.
std::string text(double value, const Unit& unit) {
    static const Unit second = *Unit::parse("s"), ns = *Unit::parse("ns");
    const double rounded = nine_digits(value);
    if (!unit.same_dimension(second)) return with_unit(format_number(rounded), unit);
    return with_unit(format_number(convert(std::round(convert(rounded, unit, ns)), ns, unit)),
                     unit);
}

}  // namespace

std::string draw(const RandomParameter& p, std::uint64_t seed, std::int64_t index) {
    Random random(seed, fmt::format("{}.{}", p.name, index));
    switch (p.distribution) {
        case Distribution::uniform:
            return text(p.a + (p.b - p.a) * random.share(), p.unit);
        case Distribution::log_uniform:
            return text(p.a * Sleef_cinz_expd1_u10purec(random.share() *
                                                        Sleef_cinz_logd1_u10purec(p.b / p.a)),
                        p.unit);
        case Distribution::normal:
            return text(p.a + p.b * random.normal(), p.unit);
        case Distribution::integer: {
            const auto count = static_cast<std::uint64_t>(p.b - p.a) + 1;
            const auto offset = static_cast<std::int64_t>(random.below(count));
            return with_unit(fmt::format("{}", static_cast<std::int64_t>(p.a) + offset), p.unit);
        }
        case Distribution::choice:
            return p.choices[random.below(p.choices.size())];
    }
    return {};
}

std::vector<std::string> probes(const RandomParameter& p) {
    if (p.distribution == Distribution::choice) return p.choices;
    const auto at = [&](double value) {
        return p.distribution == Distribution::integer
                   ? with_unit(fmt::format("{:.0f}", value), p.unit)
                   : text(value, p.unit);
    };
    if (p.distribution == Distribution::normal) return {at(p.a)};
    return {at(p.a), at(p.b)};
}

}  // namespace lineshaft
