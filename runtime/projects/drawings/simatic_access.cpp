#include "runtime/projects/drawings/simatic_access.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "runtime/projects/drawings/values.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/source/reader.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

bool is_called(pugi::xml_node node, std::string_view name) {
    return node.name() == name;
}

std::string_view scope_of(pugi::xml_node node) {
    return node.attribute("Scope").value();
}

bool is_local(std::string_view scope) {
    return scope.starts_with("Local");
}

bool has_tokens(pugi::xml_node node) {
    return static_cast<bool>(node.child("Token"));
}

}  // namespace

Excerpts SimaticAccess::quoted(pugi::xml_node named) const {
    Excerpts made;
    write_name(made, named, true);
    return made;
}

Excerpts SimaticAccess::label(pugi::xml_node named) const {
    Excerpts made;
    const std::string_view name = named.attribute("Name").value();
    write_name(made, named, st::word_of(name) || st::same_name(name, "end"));
    return made;
}

Excerpts SimaticAccess::reference(pugi::xml_node scoped) const {
    Excerpts made;
    write_components(made, scoped, is_local(scope_of(scoped)));
    return made;
}

Excerpts SimaticAccess::text_of(pugi::xml_node access) const {
    Excerpts made;
    const bool local = is_local(scope_of(access));
    if (const auto symbol = access.child("Symbol")) write_components(made, symbol, local);
    if (const auto constant = access.child("Constant")) write_constant(made, constant, local);
    if (const auto address = access.child("Address")) write_address(made, address);
    if (const auto named = access.child("Label")) made.append(label(named));
    if (const auto word = access.child("PredefinedVariable")) write_name(made, word, false);
    for (const char* call : {"CallInfo", "Instruction"})
        if (const auto called = access.child(call)) write_call(made, called);
    if (const auto expression = access.child("Expression")) write_tokens(made, expression);
    if (const auto type = access.child("DataType")) file_.copy(made, type);
    return made;
}

Excerpts SimaticAccess::statements(pugi::xml_node tokens) const {
    Excerpts made;
    write_tokens(made, tokens);
    made.write("\n", place(tokens));
    return made;
}

void SimaticAccess::write_tokens(Excerpts& to, pugi::xml_node parent) const {
    for (const pugi::xml_node token : parent.children()) write_token(to, token);
}

void SimaticAccess::write_token(Excerpts& to, pugi::xml_node token) const {
    if (is_called(token, "Token")) {
        file_.copy(to, token.attribute("Text"));
    } else if (is_called(token, "Blank")) {
        to.write(std::string(std::clamp(token.attribute("Num").as_uint(1), 1U, 200U), ' '),
                 place(token));
    } else if (is_called(token, "NewLine")) {
        to.write("\n", place(token));
    } else if (is_called(token, "Text")) {
        file_.copy(to, token);
    } else if (is_called(token, "Access")) {
        to.append(text_of(token));
    } else if (is_called(token, "Parameter")) {
        write_name(to, token, !is_identifier(file_.plain(token.attribute("Name"))));
        write_tokens(to, token);
    } else if (is_called(token, "Component")) {
        write_name(to, token, !is_identifier(file_.plain(token.attribute("Name"))));
    } else if (is_called(token, "NamelessParameter") || is_called(token, "Expression")) {
        write_tokens(to, token);
    }
}

/// `#` before a local name; a global one stands in quotes. Dots are there as tokens, or not at all;
/// a slice is a token, or a modifier.
void SimaticAccess::write_components(Excerpts& to, pugi::xml_node symbol, bool is_local) const {
    bool is_first = true;
    for (const pugi::xml_node part : symbol.children()) {
        if (is_called(part, "Address")) write_address(to, part);
        if (is_called(part, "Token") && symbol.child("Address")) write_token(to, part);
        if (const std::string slice = file_.plain(part.attribute("Text")); slice.starts_with('%'))
            to.write("." + slice, place(part));
        if (!is_called(part, "Component")) continue;
        const std::string name = file_.plain(part.attribute("Name"));
        if (!is_first) to.write(".", place(part));
        if (is_first && is_local) to.write("#", place(part));
        write_name(to, part, (is_first && !is_local) || !is_identifier(name));
        write_index(to, part);
        if (const std::string slice = file_.plain(part.attribute("SliceAccessModifier"));
            !slice.empty() && slice != "undef")
            to.write(".%" + upper(slice), place(part));
        is_first = false;
    }
}

void SimaticAccess::write_index(Excerpts& to, pugi::xml_node component) const {
    if (has_tokens(component)) return write_tokens(to, component);
    std::string_view between = "[";
    for (const pugi::xml_node index : component.children("Access")) {
        to.write(between, place(index));
        to.append(text_of(index));
        between = ", ";
    }
    if (between != "[") to.write("]", place(component));
}

/// A literal as it is written, or a constant by its name.
void SimaticAccess::write_constant(Excerpts& to, pugi::xml_node constant, bool is_local) const {
    if (const auto value = constant.child("ConstantValue")) {
        const bool is_bool = st::same_name(file_.plain(constant.child("ConstantType")), "bool");
        const std::string written = file_.plain(value);
        if (is_bool && (written == "1" || written == "0"))
            return to.write(written == "1" ? "TRUE" : "FALSE", place(value));
        return file_.copy(to, value);
    }
    if (is_local) to.write("#", place(constant));
    write_name(to, constant, !is_local || !is_identifier(file_.plain(constant.attribute("Name"))));
}

namespace {

/// X, B, W, D or L of what has 1, 8, 16, 32 or 64 bits; 0: its type is none of these.
char size_of(std::string_view type) {
    static constexpr std::pair<char, std::string_view> sizes[] = {
        {'X', " bool "},
        {'B', " byte char sint usint "},
        {'W', " word int uint date s5time "},
        {'D', " dword dint udint real time time_of_day "},
        {'L', " lword lint ulint lreal ltime ldt ltime_of_day "}};
    const std::string word = fmt::format(" {} ", lower(type));
    for (const auto& [size, types] : sizes)
        if (types.find(word) != types.npos) return size;
    return '\0';
}

}  // namespace

/// Bits from the beginning of an area, or of a data block, which has a number, or stands before a
/// dot with its name for a type; of timers and counters their number.
void SimaticAccess::write_address(Excerpts& to, pugi::xml_node address) const {
    const std::string area = file_.plain(address.attribute("Area"));
    const std::string type = file_.plain(address.attribute("Type"));
    const std::string block = file_.plain(address.attribute("BlockNumber"));
    const std::uint64_t bits = address.attribute("BitOffset").as_ullong();
    if (area == "Timer" || area == "Counter")
        return to.write(fmt::format("{}{}", area[0], bits), place(address));
    const char size = size_of(type);
    const bool is_block = area == "DB";
    if (is_block && size == '\0') return to.write(fmt::format("\"{}\"", type), place(address));
    if (is_block && !block.empty()) to.write(fmt::format("%DB{}.", block), place(address));
    const char letter = area == "Input" ? 'I' : area == "Output" ? 'Q' : 'M';
    const bool is_bit = size == 'X' || size == '\0';
    const std::string before = is_block ? fmt::format("{}DB{}", block.empty() ? "%" : "", size)
                               : is_bit ? fmt::format("%{}", letter)
                                        : fmt::format("%{}{}", letter, size);
    to.write(is_bit ? fmt::format("{}{}.{}", before, bits / 8, bits % 8)
                    : fmt::format("{}{}", before, bits / 8),
             place(address));
}

/// `"Fc"(...)`, `#motor(...)`, `#delay.TON(...)`, `NORM_X(...)`.
void SimaticAccess::write_call(Excerpts& to, pugi::xml_node call) const {
    const auto instance = call.child("Instance");
    if (instance) write_components(to, instance, is_local(scope_of(instance)));
    if (is_called(call, "Instruction")) {
        if (instance) to.write(".", place(call));
        file_.copy(to, call.attribute("Name"));
    } else if (!instance) {
        write_name(to, call, true);
    }
    for (const pugi::xml_node part : call.children())
        if (!is_called(part, "Instance")) write_token(to, part);
}

void SimaticAccess::write_name(Excerpts& to, pugi::xml_node named, bool is_quoted) const {
    if (is_quoted) to.write("\"", place(named));
    file_.copy(to, named.attribute("Name"));
    if (is_quoted) to.write("\"", place(named));
}

}  // namespace lineshaft::projects
