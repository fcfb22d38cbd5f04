#include "runtime/projects/drawings/types.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "runtime/source/reader.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::projects {

using st::StandardFunction;

namespace {

struct Fixed {
    std::string_view name, type;
};
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

/// The type that arguments are meant to share. A number without one takes that of the others.
std::string common_type(std::span<const std::string> types) {
    std::string common;
    for (const std::string& one : types) {
        const std::string type = lower(one);
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

/// The arguments of a call that its result is of the type of: of the `count` behind the first
/// `skipped` ones.
struct LikeArguments {
    std::size_t skipped = 0, count = 0;
};
LikeArguments like_arguments(const StandardFunction& f, std::size_t given) {
    switch (f.typing) {
        case st::Typing::real:
        case st::Typing::reals:
        case st::Typing::own:
        case st::Typing::common:
        case st::Typing::bits:
            return {0, given};
        case st::Typing::chosen:
            return {1, given - 1};
        case st::Typing::places:
            return {0, 1};
        case st::Typing::operation:
            return {0, f.word == st::Word::power ? 1 : given};
        default:
            return {};
    }
}

bool is_of_dates(const StandardFunction& f) {
    return f.word == st::Word::plus || f.word == st::Word::minus;
}

/// NOT is an operator that is drawn as a function, and no row.
bool is_not(std::string_view function) {
    return st::same_name(function, "not");
}

/// Its operands are truth values, unless something is known to be otherwise.
bool is_of_bits(const StandardFunction& f) {
    return f.word == st::Word::and_ || f.word == st::Word::or_ || f.word == st::Word::xor_;
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

/// In small letters: `motor`, of a METHOD `motor.stop`.
static std::string name_of_unit(const XmlFile& file, pugi::xml_node unit) {
    std::string name = lower(file.plain(unit.attribute("name")));
    if (std::string_view(unit.name()) != "Method") return name;
    pugi::xml_node owner = unit.parent();
    while (owner && std::string_view(owner.name()) != "pou") owner = owner.parent();
    return lower(file.plain(owner.attribute("name"))) + "." + name;
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
        if (kind == "pou" || kind == "Method") {
            const std::string name = name_of_unit(file, node);
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
    if (is_identifier(expression)) {
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
    if (dot == expression.npos || !is_identifier(expression.substr(0, dot))) return {};
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

/// The result of a function by what its row says.
static std::string of_row(const StandardFunction& f, const std::vector<std::string>& arguments) {
    const st::GenericType& result = st::generic_types[static_cast<std::size_t>(f.result)];
    if (result.doc.empty()) return std::string(result.name);
    if (f.typing == st::Typing::real && f.result == st::Generic::any_int) return "DINT";
    if (arguments.empty()) return {};
    const LikeArguments like = like_arguments(f, arguments.size());
    if (like.count == 0) return {};
    if (is_of_dates(f) && has(dates, lower(arguments.front())))
        return same(arguments) ? "TIME" : upper(arguments.front());
    const std::string type = common_type(std::span(arguments).subspan(like.skipped, like.count));
    if (type.empty() && is_of_bits(f)) return "BOOL";
    const bool is_kept =
        f.result != st::Generic::any_real || f.word == st::Word::power || type.ends_with("REAL");
    return is_kept ? type : std::string();
}

bool NetworkTypes::is_of_one_type(std::string_view function) const {
    if (is_declared(function)) return false;
    const StandardFunction* f = st::find_standard_function(function);
    if (!f) return is_not(function);
    const bool are_alike =
        std::ranges::all_of(std::span(f->parameters).first(static_cast<std::size_t>(f->least)),
                            [&](const st::Parameter& p) { return p.type == f->result; });
    return f->least > 0 && are_alike && like_arguments(*f, 2).count == 2;
}

std::string NetworkTypes::of_call(std::string_view function,
                                  const std::vector<std::string>& arguments) const {
    const std::string name = lower(function);
    if (const auto own = declared_.functions.find(name); own != declared_.functions.end())
        return own->second;
    if (is_not(name)) {
        const std::string type = arguments.empty() ? "" : common_type(arguments);
        return type.empty() && !arguments.empty() ? "BOOL" : type;
    }
    if (const StandardFunction* f = st::find_standard_function(name)) return of_row(*f, arguments);
    const std::size_t to = name.rfind("to_");
    const bool converts = to == 0 || (to != name.npos && name[to - 1] == '_');
    const std::string target = converts ? name.substr(to + 3) : std::string();
    return has(elementary, target) ? upper(target) : std::string();
}

}  // namespace lineshaft::projects
