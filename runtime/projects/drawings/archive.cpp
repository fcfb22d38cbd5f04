#include "runtime/projects/drawings/archive.hpp"

#include <charconv>

namespace lineshaft::projects {

namespace {

std::string unquoted(const std::string& text) {
    const bool is_quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return is_quoted ? text.substr(1, text.size() - 2) : text;
}

}  // namespace

pugi::xml_node Archive::member(pugi::xml_node object, std::string_view name) {
    for (const pugi::xml_node child : object.children())
        if (child.attribute("n").value() == name) return child;
    return {};
}

std::vector<pugi::xml_node> Archive::items(pugi::xml_node list) {
    std::vector<pugi::xml_node> all;
    for (const pugi::xml_node child : list.children())
        if (child.type() == pugi::node_element) all.push_back(child);
    return all;
}

bool Archive::is_null(pugi::xml_node object) {
    return !object || std::string_view(object.name()) == "n";
}

std::string_view Archive::kind_of(pugi::xml_node object) {
    const std::string_view own = object.attribute("t").value();
    return own.empty() ? object.parent().attribute("cet").value() : own;
}

std::string Archive::text(pugi::xml_node object, std::string_view name) const {
    return unquoted(file_.plain(member(object, name)));
}

bool Archive::is_true(pugi::xml_node object, std::string_view name) const {
    return text(object, name) == "true";
}

std::vector<std::string> Archive::strings(pugi::xml_node object, std::string_view name) const {
    std::vector<std::string> all;
    for (const pugi::xml_node item : items(member(object, name)))
        all.push_back(unquoted(file_.plain(item)));
    return all;
}

Marks Archive::marks_in(pugi::xml_node flags) const {
    const std::string text = this->text(flags, "Flags");
    unsigned bits = 0;
    std::from_chars(text.data(), text.data() + text.size(), bits);
    const auto has = [&](unsigned bit) { return (bits & bit) != 0; };
    return {has(1), has(2), has(4), has(8), has(16), has(32)};
}

}  // namespace lineshaft::projects
