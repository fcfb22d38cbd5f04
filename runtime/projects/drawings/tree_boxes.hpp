#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/projects/drawings/archive.hpp"
#include "runtime/projects/drawings/box_calls.hpp"

namespace lineshaft::projects {

/// A box of a network of TwinCAT: what it calls, and what leads to it and from it.
struct TreeBox : BoxCall {
    pugi::xml_node node = {};
    std::string call = {};      ///< `Function`, `FunctionBlock`, `Method`, `Action`, an operator's
    std::string instance = {};  ///< empty: none, or it is a part of the type, `instance.Method`
    std::vector<pugi::xml_node> takers = {};  ///< operands at the outputs; null: none
    std::vector<std::string> outputs = {}, output_types = {};
    bool has_enable = false, has_eno = false;
    Value enabled = {};  ///< empty: always

    bool is_method() const { return call == "Method"; }
    /// Its outputs are those of an instance, or of none.
    bool is_block() const { return has_own_outputs(call, instance); }
    /// It calls `member` of the instance.
    bool is_of_instance() const { return calls_member(call, instance); }
    std::string_view member() const { return member_of_type(type); }

    std::size_t result() const { return has_eno ? 1 : 0; }
    /// A METHOD without a result has its VAR_OUTPUTs alone.
    bool has_result() const;
    /// The first output beside ENO and the result.
    std::size_t first_other() const { return result() + (has_result() ? 1 : 0); }
    /// The output that what is behind the box takes.
    std::size_t main() const;
    /// Empty: not known.
    std::string output_type(std::size_t i) const;
};

/// All but what leads to it, and its place.
TreeBox read_tree_box(const Archive& archive, pugi::xml_node node);

}  // namespace lineshaft::projects
