#include "blocks/logic/counter.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "blocks/inputs.hpp"

namespace lineshaft {

namespace {

constexpr std::string_view type_names[] = {"int",   "dint", "lint",  "udint",
                                           "ulint", "sint", "usint", "uint"};

struct Range {
    std::int64_t least, most;
};

template <class T>
constexpr Range range_of() {
    return {std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};
}

constexpr Range ranges[] = {range_of<std::int16_t>(),
                            range_of<std::int32_t>(),
                            range_of<std::int64_t>(),
                            range_of<std::uint32_t>(),
                            {0, std::numeric_limits<std::int64_t>::max()},
                            range_of<std::int8_t>(),
                            range_of<std::uint8_t>(),
                            range_of<std::uint16_t>()};

constexpr Range range(CounterType type) {
    return ranges[static_cast<std::size_t>(type)];
}

template <class Counter>
void count_up(Counter& counter) {
    const std::int64_t most = range(counter.data_type).most;
    if (counter.cv < (counter.stops_at_preset ? std::min(counter.pv, most) : most)) ++counter.cv;
}

template <class Counter>
void count_down(Counter& counter) {
    const std::int64_t least = range(counter.data_type).least;
    if (counter.cv > (counter.stops_at_preset ? 0 : least)) --counter.cv;
}

std::int64_t preset(std::int64_t pv, CounterType type) {
    return std::clamp(pv, range(type).least, range(type).most);
}

/// A `pv` that cv never comes to.
std::optional<Misfit> preset_misfit(std::int64_t pv, CounterType type,
                                    const IsConstant& is_constant) {
    if (preset(pv, type) == pv || !is_constant("pv")) return {};
    const auto [least, most] = range(type);
    return Misfit{"pv", fmt::format("data_type: {} counts from {} to {}",
                                    type_names[static_cast<std::size_t>(type)], least, most)};
}

constexpr std::string_view data_type_doc = "type of cv: its limits",
                           stops_doc = "counts up to pv and down to 0 at most";

}  // namespace

std::span<const Field> Ctu::fields() {
    static const Field table[] = {
        parameter("data_type", &Ctu::data_type, "", data_type_doc).one_of(type_names),
        input("cu", &Ctu::cu, "", "counts up at each rising edge").must_be_set(),
        input("r", &Ctu::r, "", "sets cv to 0; wins over cu"),
        input("pv", &Ctu::pv, "", "preset value").must_be_set(),
        output("q", &Ctu::q, "", "cv has reached pv"),
        output("cv", &Ctu::cv, "", "counter value"),
        local("stops_at_preset", &Ctu::stops_at_preset, "", stops_doc),
    };
    return table;
}

std::optional<Misfit> Ctu::misfit(const IsConstant& is_constant) const {
    return preset_misfit(pv, data_type, is_constant);
}

void Ctu::scan(const Scan&) {
    const bool up = rising_edge(cu, last_cu);
    if (r)
        cv = 0;
    else if (up)
        count_up(*this);
    q = cv >= pv;
}

std::span<const Field> Ctd::fields() {
    static const Field table[] = {
        parameter("data_type", &Ctd::data_type, "", data_type_doc).one_of(type_names),
        input("cd", &Ctd::cd, "", "counts down at each rising edge").must_be_set(),
        input("ld", &Ctd::ld, "", "sets cv to pv; wins over cd"),
        input("pv", &Ctd::pv, "", "preset value").must_be_set(),
        output("q", &Ctd::q, "", "cv has reached 0"),
        output("cv", &Ctd::cv, "", "counter value"),
        local("stops_at_preset", &Ctd::stops_at_preset, "", stops_doc),
    };
    return table;
}

std::optional<Misfit> Ctd::misfit(const IsConstant& is_constant) const {
    return preset_misfit(pv, data_type, is_constant);
}

void Ctd::scan(const Scan&) {
    const bool down = rising_edge(cd, last_cd);
    if (ld)
        cv = preset(pv, data_type);
    else if (down)
        count_down(*this);
    q = cv <= 0;
}

std::span<const Field> Ctud::fields() {
    static const Field table[] = {
        parameter("data_type", &Ctud::data_type, "", data_type_doc).one_of(type_names),
        input("cu", &Ctud::cu, "", "counts up at each rising edge"),
        input("cd", &Ctud::cd, "", "counts down at each rising edge"),
        input("r", &Ctud::r, "", "sets cv to 0; wins over all others"),
        input("ld", &Ctud::ld, "", "sets cv to pv; wins over cu and cd"),
        input("pv", &Ctud::pv, "", "preset value").must_be_set(),
        output("qu", &Ctud::qu, "", "cv has reached pv"),
        output("qd", &Ctud::qd, "", "cv has reached 0"),
        output("cv", &Ctud::cv, "", "counter value"),
        local("stops_at_preset", &Ctud::stops_at_preset, "", stops_doc),
    };
    return table;
}

std::optional<Misfit> Ctud::misfit(const IsConstant& is_constant) const {
    return preset_misfit(pv, data_type, is_constant);
}

void Ctud::scan(const Scan&) {
    const bool up = rising_edge(cu, last_cu);
    const bool down = rising_edge(cd, last_cd);
    if (r)
        cv = 0;
    else if (ld)
        cv = preset(pv, data_type);
    else if (up && !down)
        count_up(*this);
    else if (down && !up)
        count_down(*this);
    qu = cv >= pv;
    qd = cv <= 0;
}

}  // namespace lineshaft
