#include "runtime/projects/drawings/types.hpp"

#include <algorithm>
#include <array>

namespace lineshaft::projects {

namespace {

constexpr std::string_view comparisons[] = {"gt", "ge", "eq", "le", "lt", "ne"};
/// Results that are as the arguments behind the first `skipped` ones.
struct LikeArguments {
    std::string_view name;
    std::size_t skipped = 0;
    bool is_first = false;  ///< only one of them
};
constexpr LikeArguments like_arguments[] = {
    {"add"},          {"sub"},          {"mul"},          {"div"},          {"mod"},
    {"and"},          {"or"},           {"xor"},          {"not"},          {"abs"},
    {"max"},          {"min"},          {"limit"},        {"move"},         {"sel", 1},
    {"mux", 1},       {"sqrt"},         {"ln"},           {"log"},          {"exp"},
    {"sin"},          {"cos"},          {"tan"},          {"asin"},         {"acos"},
    {"atan"},         {"shl", 0, true}, {"shr", 0, true}, {"rol", 0, true}, {"ror", 0, true},
    {"expt", 0, true}};
/// Of truth values, unless something is known to be otherwise.
constexpr std::string_view of_bits[] = {"and", "or", "xor", "not"};
struct Fixed {
    std::string_view name, type;
};
constexpr Fixed fixed[] = {
    {"len", "INT"},        {"find", "INT"},           {"concat", "STRING"},
    {"left", "STRING"},    {"right", "STRING"},       {"mid", "STRING"},
    {"insert", "STRING"},  {"delete", "STRING"},      {"replace", "STRING"},
    {"trunc", "DINT"},     {"add_time", "TIME"},      {"sub_time", "TIME"},
    {"multime", "TIME"},   {"divtime", "TIME"},       {"mul_time", "TIME"},
    {"div_time", "TIME"},  {"sub_date_date", "TIME"}, {"sub_tod_tod", "TIME"},
    {"sub_dt_dt", "TIME"}, {"add_tod_time", "TOD"},   {"sub_tod_time", "TOD"},
    {"add_dt_time", "DT"}, {"sub_dt_time", "DT"}};
/// Outputs that the standard's blocks have.
constexpr Fixed outputs[] = {{"q", "BOOL"},  {"qu", "BOOL"}, {"qd", "BOOL"},
                             {"q1", "BOOL"}, {"et", "TIME"}, {"cv", "INT"}};
/// A number and another are as the one further to the right.
constexpr std::string_view numbers[] = {"sint",  "usint", "int",   "uint", "dint",
                                        "udint", "lint",  "ulint", "real", "lreal"};
/// Types that values are converted to by functions of their names, and those whose literals say so.
constexpr std::string_view elementary[] = {"bool",  "byte", "word",   "dword",  "lword", "sint",
                                           "usint", "int",  "uint",   "dint",   "udint", "lint",
                                           "ulint", "real", "lreal",  "time",   "ltime", "date",
                                           "tod",   "dt",   "string", "wstring"};

constexpr std::string_view dates[] = {"date", "tod", "dt"};

template <class List>
bool has(const List& list, std::string_view name) {
    return std::ranges::find(list, name) != std::end(list);
}

/// Of arguments that are meant to be of one type. A number without one takes that of the others.
std::string common_type(const std::vector<std::string>& types, std::size_t skipped) {
    std::string common;
    for (std::size_t i = skipped; i < types.size(); ++i) {
        const std::string type = lower(types[i]);
        if (type.empty()) return {};
        if (type == "#") continue;
        const auto* rank = std::ranges::find(numbers, type);
        const auto* known = std::ranges::find(numbers, common);
        const bool are_numbers = rank != std::end(numbers) && known != std::end(numbers);
        if (common.empty() || (are_numbers && rank > known))
            common = type;
        else if (common != type && !are_numbers)
            return {};
    }
    return upper(common);
}

bool same(const std::vector<std::string>& types) {
    return std::ranges::all_of(types,
                               [&](const auto& type) { return lower(type) == lower(types[0]); });
}

/// Not by those that make a real number of an integer.
bool is_kept_by(std::string_view function, std::string_view type) {
    constexpr std::string_view real[] = {"sqrt", "ln",  "log",  "exp",  "sin",
                                         "cos",  "tan", "asin", "acos", "atan"};
    return !has(real, function) || type.ends_with("real");
}

bool is_name(std::string_view text) {
    return !text.empty() && (is_letter(text.front()) || text.front() == '_') &&
           std::ranges::all_of(text,
                               [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

}  // namespace

std::string type_name(const XmlFile& file, pugi::xml_node type) {
    for (const pugi::xml_node child : type.children()) {
        const std::string_view kind = child.name();
        if (child.type() != pugi::node_element) continue;
        if (kind == "derived") return file.plain(child.attribute("name"));
        const std::string small = lower(kind);
        return has(elementary, small) ? upper(small) : std::string();
    }
    return {};
}

DeclaredTypes declared_types(const XmlFile& file) {
    DeclaredTypes made;
    const auto add = [&](VariableTypes& to, pugi::xml_node section) {
        for (const pugi::xml_node variable : section.children("variable"))
            to.emplace(lower(file.plain(variable.attribute("name"))),
                       type_name(file, variable.child("type")));
    };
    for (pugi::xml_node node = file.root(); node;) {
        const std::string_view kind = node.name();
        if (kind == "globalVars") add(made.globals, node);
        if (kind == "pou") {
            const std::string name = lower(file.plain(node.attribute("name")));
            const pugi::xml_node interface = node.child("interface");
            for (const pugi::xml_node section : interface.children()) add(made.pous[name], section);
            if (const pugi::xml_node result = interface.child("returnType")) {
                made.functions.emplace(name, type_name(file, result));
                made.pous[name].emplace(name, type_name(file, result));
            }
        }
        if (node.first_child() && kind != "body") {
            node = node.first_child();
            continue;
        }
        while (node && !node.next_sibling()) node = node.parent();
        if (node) node = node.next_sibling();
    }
    return made;
}

NetworkTypes::NetworkTypes(const DeclaredTypes& declared, const std::string& pou)
    : declared_(declared) {
    const auto found = declared.pous.find(lower(pou));
    if (found != declared.pous.end()) own_ = &found->second;
}

std::string NetworkTypes::of_name(std::string_view name) const {
    const std::string small = lower(name);
    for (const VariableTypes* types : {own_, &declared_.globals}) {
        if (!types) continue;
        if (const auto found = types->find(small); found != types->end()) return found->second;
    }
    return {};
}

std::string NetworkTypes::of_expression(std::string_view expression) const {
    if (is_name(expression)) {
        const std::string small = lower(expression);
        return small == "true" || small == "false" ? "BOOL" : of_name(expression);
    }
    if (const std::size_t hash = expression.find('#'); hash != expression.npos) {
        const std::string type = lower(expression.substr(0, hash));
        if (type == "t") return "TIME";
        if (type == "lt") return "LTIME";
        return has(elementary, type) ? upper(type) : is_digit(expression.front()) ? "#" : "";
    }
    const auto is_number = [](char c) { return is_digit(c) || c == '_' || c == '.' || c == '-'; };
    if (!expression.empty() && std::ranges::all_of(expression, is_number)) return "#";
    if (expression.starts_with('\'')) return "STRING";
    const std::size_t dot = expression.find('.');
    if (dot == expression.npos || !is_name(expression.substr(0, dot))) return {};
    return of_output(expression.substr(0, dot), expression.substr(dot + 1));
}

std::string NetworkTypes::of_output(std::string_view instance, std::string_view pin) const {
    const std::string small = lower(pin);
    const auto pou = declared_.pous.find(lower(of_name(instance)));
    if (pou != declared_.pous.end()) {
        const auto found = pou->second.find(small);
        return found == pou->second.end() ? std::string() : found->second;
    }
    const auto* output = std::ranges::find(outputs, small, &Fixed::name);
    return output == std::end(outputs) ? std::string() : std::string(output->type);
}

std::string NetworkTypes::of_declared(std::string_view pou, std::string_view variable) const {
    const auto declared = declared_.pous.find(lower(pou));
    if (declared == declared_.pous.end()) return {};
    const auto found = declared->second.find(lower(variable));
    return found == declared->second.end() ? std::string() : found->second;
}

bool NetworkTypes::is_of_one_type(std::string_view function) const {
    const std::string name = lower(function);
    const auto* like = std::ranges::find(like_arguments, name, &LikeArguments::name);
    return like != std::end(like_arguments) && like->skipped == 0 && !like->is_first &&
           !declared_.functions.contains(name);
}

std::string NetworkTypes::of_call(std::string_view function,
                                  const std::vector<std::string>& arguments) const {
    const std::string name = lower(function);
    if (const auto own = declared_.functions.find(name); own != declared_.functions.end())
        return own->second;
    if (has(comparisons, name)) return "BOOL";
    if (const auto* type = std::ranges::find(fixed, name, &Fixed::name); type != std::end(fixed))
        return std::string(type->type);
    const auto* like = std::ranges::find(like_arguments, name, &LikeArguments::name);
    if (like != std::end(like_arguments)) {
        if (arguments.empty()) return {};
        const bool is_date = has(dates, lower(arguments.front()));
        if (is_date && (name == "add" || name == "sub"))
            return same(arguments) ? "TIME" : upper(arguments.front());
        std::string type = like->is_first ? common_type({arguments.front()}, 0)
                                          : common_type(arguments, like->skipped);
        if (type.empty() && has(of_bits, name)) return "BOOL";
        return is_kept_by(name, lower(type)) ? type : std::string();
    }
    const std::size_t to = name.rfind("to_");
    const bool converts = to == 0 || (to != name.npos && name[to - 1] == '_');
    const std::string target = converts ? name.substr(to + 3) : std::string();
    return has(elementary, target) ? upper(target) : std::string();
}

}  // namespace lineshaft::projects
