#include "runtime/projects/drawings/tree_boxes.hpp"

#include <algorithm>

#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

bool TreeBox::has_result() const {
    return !is_method() || (result() < outputs.size() && names_result(outputs[result()], type));
}

std::size_t TreeBox::main() const {
    const auto it = std::ranges::find_if(takers, Archive::is_null);
    return it == takers.end() ? 0 : static_cast<std::size_t>(it - takers.begin());
}

std::string TreeBox::output_type(std::size_t i) const {
    return i < output_types.size() && is_type_name(output_types[i]) ? output_types[i] : "";
}

TreeBox read_tree_box(const Archive& archive, pugi::xml_node node) {
    TreeBox box;
    box.type = function_of(archive.text(node, "BoxType"));
    box.names = archive.strings(Archive::member(node, "InputParam"), "Names");
    box.node = node;
    box.call = archive.text(node, "CallType");
    box.instance = archive.text(Archive::member(node, "Instance"), "Operand");
    box.takers =
        Archive::items(Archive::member(Archive::member(node, "OutputItems"), "OutputItems"));
    const pugi::xml_node outputs = Archive::member(node, "OutputParam");
    box.outputs = archive.strings(outputs, "Names");
    box.output_types = archive.strings(outputs, "Types");
    box.has_enable = archive.is_true(node, "EN");
    box.has_eno = archive.is_true(node, "ENO");
    return box;
}

}  // namespace lineshaft::projects
