#include "runtime/projects/memory_bytes.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

using Start = OrganizationBlock::Start;

/// S7-1200 System Manual, table "Clock memory".
struct Clock {
    std::string_view name;
    char bit;
    int period;  ///< [ms]
};
constexpr Clock clocks[] = {
    {"Clock_10Hz", '0', 100},     {"Clock_5Hz", '1', 200},    {"Clock_2.5Hz", '2', 400},
    {"Clock_2Hz", '3', 500},      {"Clock_1.25Hz", '4', 800}, {"Clock_1Hz", '5', 1000},
    {"Clock_0.625Hz", '6', 1600}, {"Clock_0.5Hz", '7', 2000},
};

bool is_bit(std::string_view address, char bit) {
    return address.starts_with("%M") && address.ends_with(std::string{'.', bit});
}

/// A name that needs no quotes in YAML.
std::string plain(std::string_view name) {
    std::string made(name);
    for (char& c : made)
        if (!is_letter(c) && !is_digit(c) && c != ' ') c = '_';
    return made;
}

}  // namespace

void MemoryBytes::add(std::string_view name, std::string_view address) {
    const auto* clock = std::ranges::find(clocks, name, &Clock::name);
    if (clock != std::end(clocks) && is_bit(address, clock->bit))
        clocks_ += fmt::format("    \"{}\" := TIME_TO_DINT(TIME_TCK()) MOD {} >= {};\n", name,
                               clock->period, clock->period / 2);
    if (name == "FirstScan" && is_bit(address, '0'))
        system_ += "    \"FirstScan\" := NOT #scanned;\n    #scanned := TRUE;\n";
}

bool MemoryBytes::is_always_true(std::string_view name, std::string_view address) {
    return name == "AlwaysTRUE" && is_bit(address, '2');
}

std::string MemoryBytes::add_to(Project& project, std::string_view table, const Mark& mark) const {
    std::string text;
    const auto add = [&](Start start, std::string_view kind, std::string_view body) {
        const std::string name = fmt::format("{} of {}", kind, plain(table));
        text += fmt::format("PROGRAM \"{}\"\n{}END_PROGRAM\n", name, body);
        project.organization_blocks.push_back({{name, mark}, start});
    };
    if (!clocks_.empty()) add(Start::clock_memory, "Clock memory", "BEGIN\n" + clocks_);
    if (!system_.empty())
        add(Start::system_memory, "System memory",
            "VAR scanned : Bool; END_VAR\nBEGIN\n" + system_);
    return text;
}

}  // namespace lineshaft::projects
