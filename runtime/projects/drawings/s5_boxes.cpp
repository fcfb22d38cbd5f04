#include <algorithm>

#include "runtime/projects/drawings/s7_boxes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"
#include "runtime/st/vendors/names.hpp"

namespace lineshaft::projects::s7 {

using st::same_name;

namespace {

/// `S_ODT` and the names of its box and its coil, with a blank around each.
struct S5Row {
    std::string_view function, names;
};
constexpr S5Row timers[] = {{"S_PULSE", " s_pulse sp sp_coil spcoil "},
                            {"S_PEXT", " s_pext se se_coil secoil "},
                            {"S_ODT", " s_odt sd sd_coil sdcoil "},
                            {"S_ODTS", " s_odts ss ss_coil sscoil "},
                            {"S_OFFDT", " s_offdt sf sf_coil sfcoil "}};
constexpr S5Row counter_coils[] = {
    {"CU", " cu_coil cucoil "}, {"CD", " cd_coil cdcoil "}, {"S", " sc_coil sccoil "}};

template <std::size_t n>
std::string_view function_of(const Running& r, const S5Row (&rows)[n]) {
    const auto* found = std::ranges::find_if(
        rows, [&](const S5Row& row) { return st::has_word(row.names, r.it.name); });
    return found == std::end(rows) ? std::string_view() : found->function;
}

/// The timer or the counter, whatever its pin is called: the one that is no other.
Value object_of(Running& r) {
    for (const auto& pin : r.it.pins)
        if (!is_any(pin.name, {"s", "tv", "r", "q", "bi", "bcd", "cu", "cd", "pv", "cv", "cv_bcd",
                               "value", "time", "in"}))
            return pin.value;
    return r.operand("operand");
}

/// At whichever of the pins.
Value value_of(Running& r, std::initializer_list<std::string_view> pins) {
    for (const std::string_view pin : pins)
        if (const auto* found = r.it.find(pin)) return found->value;
    return r.operand(*pins.begin());
}

/// `bcd := S_ODT(T_NO := timer, S := power, TV := tv, R := r, Q => q, BI => bi);`
Value run_box(Running& r, std::string_view function, std::string_view number,
              std::string_view power) {
    const Value behind = r.goes_on ? r.wire() : Value{};
    std::vector<Argument> given{{std::string(number), object_of(r)}, {std::string(power), r.power}};
    Value digits;
    for (const auto& pin : r.it.pins) {
        if (is_any(pin.name, {"bcd", "cv_bcd"})) digits = pin.value;
        if (same_name(pin.name, power)) continue;
        if (is_any(pin.name, {"s", "tv", "r", "bi", "cu", "cd", "pv", "cv"}))
            given.push_back({same_name(pin.name, "bi") && number == "C_NO" ? "CV" : pin.name,
                             pin.value, pin.is_output});
        if (same_name(pin.name, "q") && behind.is_empty())
            given.push_back({pin.name, pin.value, true});
    }
    if (!behind.is_empty()) given.push_back({"Q", behind, true});
    const Value call = r.call(function, given);
    if (digits.is_empty()) {
        r.to.append(call.text);
        r.write(";\n");
    } else {
        r.assign(digits, call);
    }
    const auto* q = r.it.find("q");
    if (q && !behind.is_empty()) r.assign(q->value, behind);
    return behind.is_empty() ? r.power : behind;
}

/// Runs a timer or a counter without outputs.
Value run_coil(Running& r, std::string_view function, const std::vector<Argument>& given) {
    r.to.append(r.call(function, given).text);
    r.write(";\n");
    return r.power;
}

}  // namespace

Value s5_timer(Running& r) {
    return run_box(r, function_of(r, timers), "T_NO", "S");
}

Value s5_counter(Running& r) {
    return run_box(r, upper(r.it.name), "C_NO", same_name(r.it.name, "s_cd") ? "CD" : "CU");
}

Value s5_timer_coil(Running& r) {
    r.enable();
    return run_coil(
        r, function_of(r, timers),
        {{"T_NO", object_of(r)}, {"S", r.power}, {"TV", value_of(r, {"value", "tv", "time"})}});
}

Value s5_counter_coil(Running& r) {
    r.enable();
    const std::string_view input = function_of(r, counter_coils);
    std::vector<Argument> given{{"C_NO", object_of(r)}, {std::string(input), r.power}};
    if (input == "S") given.push_back({"PV", value_of(r, {"value", "pv"})});
    return run_coil(r, input == "S" ? "SC_Coil" : std::string(input) + "_Coil", given);
}

}  // namespace lineshaft::projects::s7
