#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/projects/xml.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

/// Types of variables by their names in small letters.
using VariableTypes = std::map<std::string, std::string, std::less<>>;

/// What a file of PLCopen XML declares, as far as the types of its values go.
struct DeclaredTypes {
    VariableTypes globals;
    VariableTypes functions;                    ///< their results; of METHODs, too: `motor.stop`
    std::map<std::string, VariableTypes> pous;  ///< by their names in small letters
};
DeclaredTypes declared_types(const XmlFile& file);

/// `INT`, `Motor`; empty: a type without a name.
std::string type_name(const XmlFile& file, pugi::xml_node type);

/// Types that values of networks have, where they can be told without compiling. Empty: not known.
class NetworkTypes {
  public:
    NetworkTypes(const DeclaredTypes& declared, const std::string& pou);

    /// The type of what is written at a variable: `a`, `timer.Q`, `T#1s`, `2.5`.
    std::string of_expression(std::string_view expression) const;
    std::string of_output(std::string_view instance, std::string_view pin) const;
    std::string of_declared(std::string_view pou, std::string_view variable) const;
    /// The type of a function's result, from those of its arguments.
    std::string of_call(std::string_view function, const std::vector<std::string>& arguments) const;
    /// By the file: what it does beside its result is not known.
    bool is_declared(std::string_view function) const {
        return declared_.functions.contains(lower(function));
    }
    /// Whether all arguments and the result are of one type: `ADD`, `MAX`, `LIMIT`.
    bool is_of_one_type(std::string_view function) const;

  private:
    std::string of_name(std::string_view name) const;

    const DeclaredTypes& declared_;
    const VariableTypes* own_ = nullptr;
};

}  // namespace lineshaft::projects
