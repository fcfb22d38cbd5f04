#include "runtime/source/habits.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "runtime/source/diagnostic.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/reader.hpp"
#include "runtime/source/units.hpp"
#include "runtime/source/utf8.hpp"

namespace lineshaft {

namespace {

constexpr std::size_t shortest_misspelling = 4;  // mHz is not kHz

struct LookAlikes {
    char32_t first, last;
    std::string_view name, instead;
};

constexpr LookAlikes look_alikes[] = {
    {0x00A0, 0x00A0, "a no-break space", "a blank"},
    {0x00AB, 0x00AB, "a typographic quote", "'\"'"},
    {0x00AD, 0x00AD, "a soft hyphen", "'-'"},
    {0x00BB, 0x00BB, "a typographic quote", "'\"'"},
    {0x2000, 0x200A, "a typographic space", "a blank"},
    {0x200B, 0x200D, "an invisible character", "nothing"},
    {0x2010, 0x2015, "a dash", "'-'"},
    {0x2018, 0x201B, "a typographic quote", "\"'\""},
    {0x201C, 0x201F, "a typographic quote", "'\"'"},
    {0x202F, 0x202F, "a narrow no-break space", "a blank"},
    {0x2060, 0x2060, "an invisible character", "nothing"},
    {0x2212, 0x2212, "a minus sign", "'-'"},
    {0x3000, 0x3000, "a wide space", "a blank"},
    {0xFF1A, 0xFF1A, "a wide colon", "':'"},
};

struct Operator {
    std::string_view text, block;
};

/// Longer ones before those that they begin with.
constexpr Operator comparisons[] = {{">=", "ge"}, {"<=", "le"}, {"<>", "ne"}, {"!=", "ne"},
                                    {"==", "eq"}, {">", "gt"},  {"<", "lt"},  {" = ", "eq"}};
constexpr Operator words[] = {
    {" XOR ", "xor"}, {" AND ", "and"}, {"&&", "and"}, {" OR ", "or"}, {"||", "or"}};
constexpr Operator signs[] = {{" * ", "mul"}, {"*", "mul"},   {" / ", "div"},
                              {"/", "div"},   {" + ", "add"}, {" - ", "sub"}};

/// A number, a parameter or a signal, and not part of a unit.
bool is_operand(std::string_view text) {
    text = trimmed(text, " ");
    const std::string_view word = text.substr(0, text.find(' '));
    return !text.empty() && (is_digit(text.front()) || text.front() == '$' || split_signal(word));
}

const Operator* find_operator(std::string_view text) {
    const std::string capital = upper(text);
    for (const Operator& word : words)
        if (capital.find(word.text) != std::string::npos) return &word;
    for (const Operator& comparison : comparisons)
        if (text.find(comparison.text) != std::string_view::npos) return &comparison;
    for (const Operator& sign : signs) {
        const auto at = text.find(sign.text);
        if (at == std::string_view::npos) continue;
        if (is_operand(text.substr(0, at)) && is_operand(text.substr(at + sign.text.size())))
            return &sign;
    }
    return nullptr;
}

struct Spelling {
    std::string_view name, unit;
};

constexpr Spelling spellings[] = {
    {"sec", "s"},          {"secs", "s"},          {"second", "s"},       {"seconds", "s"},
    {"msec", "ms"},        {"usec", "us"},         {"minute", "min"},     {"minutes", "min"},
    {"mins", "min"},       {"hour", "h"},          {"hours", "h"},        {"hr", "h"},
    {"hrs", "h"},          {"meter", "m"},         {"meters", "m"},       {"metre", "m"},
    {"metres", "m"},       {"millimeter", "mm"},   {"millimeters", "mm"}, {"millimetre", "mm"},
    {"millimetres", "mm"}, {"micron", "um"},       {"microns", "um"},     {"micrometer", "um"},
    {"micrometre", "um"},  {"degree", "deg"},      {"degrees", "deg"},    {"\u00B0", "deg"},
    {"radian", "rad"},     {"radians", "rad"},     {"turn", "rev"},       {"turns", "rev"},
    {"revolution", "rev"}, {"revolutions", "rev"}, {"percent", "%"},      {"mps", "m/s"},
    {"rps", "rev/s"},      {"1/min", "rpm"},       {"U/min", "rpm"},
};

struct Quantities {
    std::string_view name, quantity;
};

constexpr Quantities other_quantities[] = {
    {"N", "force"},
    {"Nm", "torque"},
    {"A", "electric current"},
    {"V", "voltage"},
    {"W", "power"},
    {"VA", "power"},
    {"g", "mass"},
    {"t", "mass"},
    {"bar", "pressure"},
    {"Pa", "pressure"},
    {"J", "energy"},
    {"Wh", "energy"},
    {"K", "temperature"},
    {"C", "temperature"},
    {"degC", "temperature"},
    {"degF", "temperature"},
    {"\u00B0C", "temperature"},
    {"\u00B0F", "temperature"},
    {"l", "volume"},
    {"ohm", "resistance"},
    {"\u03A9", "resistance"},
    {"dB", "level"},
};

constexpr Spelling other_scales[] = {
    {"in", "25.4 mm"},  {"inch", "25.4 mm"},  {"inches", "25.4 mm"}, {"\"", "25.4 mm"},
    {"ft", "304.8 mm"}, {"foot", "304.8 mm"}, {"feet", "304.8 mm"},  {"yd", "914.4 mm"},
    {"mil", "25.4 um"}, {"km", "1000 m"},     {"dm", "10 cm"},       {"gon", "0.9 deg"},
    {"d", "24 h"},      {"day", "24 h"},      {"days", "24 h"},      {"GHz", "1000 MHz"},
};

/// `mA` as well as `A`.
const Quantities* other_quantity(std::string_view name) {
    const auto find = [](std::string_view text) {
        const auto it = std::ranges::find(other_quantities, text, &Quantities::name);
        return it == std::end(other_quantities) ? nullptr : it;
    };
    if (const auto* whole = find(name)) return whole;
    const bool prefixed = name.size() > 1 && std::string_view("numckMGhd").find(name.front()) !=
                                                 std::string_view::npos;
    return prefixed ? find(name.substr(1)) : nullptr;
}

/// "'Nm' measures torque", "1 in is 25.4 mm"; empty if nothing is known of it.
std::optional<std::string> measure_of(std::string_view name) {
    const auto* const it = std::ranges::find(other_scales, name, &Spelling::name);
    if (it != std::end(other_scales)) return fmt::format("1 {} is {}", name, it->unit);
    if (const Quantities* other = other_quantity(name))
        return fmt::format("'{}' measures {}", name, other->quantity);
    return {};
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

/// `s2`, `s\u00B2` and `\u00B5m` as they are written here; empty if they come to no unit.
std::string respelt(std::string_view name) {
    std::string text(name);
    if (name.size() > 1 && is_digit(name.back()) && name.find('^') == std::string_view::npos)
        text.insert(text.size() - 1, "^");
    for (const auto& [from, to] : {std::pair{"\u00B2", "^2"},
                                   {"\u00B3", "^3"},
                                   {"\u00B5", "u"},
                                   {"\u03BC", "u"},
                                   {"\u00B7", "*"}})
        replace_all(text, from, to);
    return text != name && Unit::parse(text) ? text : std::string();
}

/// The unit that `name` is in capitals or in small letters only; `mHz` might be two others.
std::string other_case(std::string_view name) {
    const bool small = std::ranges::none_of(name, [](char c) { return c >= 'A' && c <= 'Z'; });
    if (!small && upper(name) != name) return {};
    for (const std::string& unit : unit_names())
        if (upper(unit) == upper(name)) return unit;
    return {};
}

std::string right_spelling(std::string_view name) {
    const auto* const it = std::ranges::find(spellings, name, &Spelling::name);
    if (it != std::end(spellings)) return std::string(it->unit);
    if (measure_of(name)) return {};
    const std::string unit = respelt(name);
    return unit.empty() ? other_case(name) : unit;
}

}  // namespace

std::optional<LookAlike> find_look_alike(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const Utf8Character character = first_character(text.substr(at));
        const auto* const found = std::ranges::find_if(look_alikes, [&](const LookAlikes& range) {
            return character.code >= range.first && character.code <= range.last;
        });
        if (character.valid && found != std::end(look_alikes))
            return LookAlike{
                at,
                fmt::format("{} (U+{:04X})", found->name, static_cast<unsigned>(character.code)),
                found->instead};
        at += character.bytes;
    }
    return {};
}

std::string expression_help(std::string_view text) {
    text = trimmed(text, " ");
    for (const std::string_view bound : {">", "<"})
        if (text.starts_with(bound))
            return fmt::format(
                "a bound is written {}: {}", bound == ">" ? "at_least" : "at_most",
                trimmed(text.substr(std::min(text.find_first_not_of("<>="), text.size())), " "));
    if (text.starts_with('!') && split_signal(text.substr(1)))
        return fmt::format("write NOT {}", text.substr(1));
    const Operator* found = find_operator(text);
    const std::string_view block = found ? found->block : text.starts_with("NOT ") ? "not" : "";
    if (block.empty()) return {};
    const bool calculates = std::ranges::find(signs, block, &Operator::block) != std::end(signs);
    return fmt::format(
        "{0} block '{1}' does it, whose output stands here instead: see 'lineshaft blocks {1}'",
        calculates ? "write the result; of signals a" : "a", block);
}

std::string unit_help(std::string_view name, std::string_view expected) {
    const std::string meant = right_spelling(name);
    if (!meant.empty()) return fmt::format("did you mean '{}'?", meant);
    const std::string end = expected.empty() ? std::string() : fmt::format("; {}", expected);
    if (const auto measure = measure_of(name)) return *measure + end;
    std::vector<std::string> others = unit_names();
    std::erase_if(others, [&](const std::string& unit) { return upper(unit) == upper(name); });
    const bool long_enough = name.size() >= shortest_misspelling;
    if (long_enough && !nearest(name, others).empty()) return suggest(name, others);
    if (name.find(' ') != std::string_view::npos)
        return "a unit is written without blanks, such as mm/s";
    return "'lineshaft units' lists the units" + end;
}

}  // namespace lineshaft
