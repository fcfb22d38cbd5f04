#include <set>

#include "runtime/projects/drawings/box_calls.hpp"
#include "runtime/projects/drawings/networks.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

constexpr std::size_t most_typed = 200;  // elements that are looked at for one type

bool is_known(const std::string& type) {
    return !type.empty() && type != "#";
}

}  // namespace

/// What CODESYS says that a box calls: `operator`, `function`, `functionblock`, `execute`, ...
std::string NetworkText::call_type(const Element& box) const {
    for (const pugi::xml_node data : box.node.child("addData").children("data"))
        if (const pugi::xml_node type = data.child("CallType")) return file_.plain(type);
    return {};
}

/// A METHOD or an ACTION of the instance beside the box (`instanceName`).
bool NetworkText::is_of_instance(const Element& box) const {
    return calls_member(call_type(box), attribute(box, "instanceName"));
}

/// Its outputs are those of an instance.
bool NetworkText::is_block(const Element& box) const {
    return !attribute(box, "instanceName").empty() && !st::same_name(call_type(box), "method");
}

/// The first output beside ENO is the result, unless a METHOD of the instance has none.
bool NetworkText::gives_result(const Element& box, const Pin& output) const {
    return is_block(box) || !is_of_instance(box) || names_result(output.name, type_name_of(box));
}

/// `instance`, `instance.Method`, or a function's name.
Value NetworkText::called(const Element& box) {
    Value made;
    if (!attribute(box, "instanceName").empty()) {
        made = instance_of(box);
        if (is_of_instance(box))
            made.text.write(fmt::format(".{}", member_of_type(attribute(box, "typeName"))),
                            place_of(box));
        return made;
    }
    made.text.draw(std::make_shared<const std::string>(name_of(box)));
    file_.copy(made.text, box.node.attribute("typeName"));
    return made;
}

std::vector<std::string> NetworkText::types_of_arguments(std::size_t i,
                                                         std::set<std::size_t>& seen) const {
    std::vector<std::string> types;
    for (const Pin& pin : drawing_.elements[i].inputs) {
        if (st::same_name(pin.name, "EN") || (pin.lines.empty() && !pin.expression)) continue;
        const std::string type = pin.lines.empty()
                                     ? context_.types.of_expression(file_.plain(pin.expression))
                                     : type_of(pin.lines.front(), seen);
        types.push_back(type.empty() ? "#" : type);
    }
    return types;
}

/// While its arguments are not evaluated yet. `seen` keeps lines that go around from doing so
/// without end.
std::string NetworkText::type_of_result(std::size_t i, std::set<std::size_t>& seen) const {
    if (!seen.insert(i).second || seen.size() > most_typed) return {};
    return context_.types.of_call(type_name_of(drawing_.elements[i]), types_of_arguments(i, seen));
}

std::string NetworkText::type_of(const Line& line, std::set<std::size_t>& seen) const {
    const Element& from = drawing_.elements[line.from];
    if (from.kind == Drawn::contact || from.kind == Drawn::left_rail) return "BOOL";
    if (from.kind != Drawn::block)
        return context_.types.of_expression(file_.plain(from.node.child("expression")));
    if (st::same_name(line.pin, "ENO")) return "BOOL";
    return is_block(from) ? context_.types.of_output(attribute(from, "instanceName"), line.pin)
                          : type_of_result(line.from, seen);
}

/// The type of the variables that a result goes to, else of what it is reckoned with.
std::string NetworkText::type_of_takers(std::size_t i) const {
    std::set<std::size_t> seen;
    for (const bool are_variables : {true, false})
        for (const Use& use : states_[i].uses) {
            const bool is_variable = drawing_.elements[use.by].kind == Drawn::out_variable;
            if (use.pin == "eno" || is_variable != are_variables) continue;
            std::string type = type_of_taker(i, use.by, seen);
            if (is_known(type)) return type;
        }
    return {};
}

/// What is overloaded takes what its other arguments are, or what its result goes to.
std::string NetworkText::type_of_taker(std::size_t i, std::size_t by,
                                       std::set<std::size_t>& seen) const {
    const Element& to = drawing_.elements[by];
    if (to.kind == Drawn::out_variable)
        return context_.types.of_expression(file_.plain(to.node.child("expression")));
    if (to.kind == Drawn::coil || to.kind == Drawn::contact) return "BOOL";
    if (to.kind != Drawn::block || is_block(to)) return {};
    if (!is_operator(to) && !context_.types.is_of_one_type(type_name_of(to))) return {};
    if (seen.size() > most_typed || !seen.insert(by).second) return {};
    std::set<std::size_t> without{i};
    std::string type = context_.types.of_call("add", types_of_arguments(by, without));
    if (is_known(type) || compares(type_name_of(to))) return type;
    for (const Use& use : states_[by].uses)
        if (use.pin != "eno" && !is_known(type)) type = type_of_taker(by, use.by, seen);
    return type;
}

}  // namespace lineshaft::projects
