#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "runtime/source/reader.hpp"

namespace lineshaft {

/// The parameters' texts in force, where they are declared or where a study sets them; from the
/// command line they have no place, and what cannot be read (it is reported) is no scalar.
using ParameterValues = std::map<std::string, Node>;

/// Replaces `$name` by the parameter's text throughout a tree, and a formula (`$speed * 2`, see
/// formula.hpp) by what it comes to.
class Substitution {
  public:
    /// `declared` is `parameters:`, which may be something else than a map; null: none. What
    /// `values` have not, `outer` may have.
    Substitution(const ParameterValues& values, const Node* declared, const Reader& read,
                 Substitution* outer = nullptr)
        : values_(values), declared_(declared), read_(read), outer_(outer) {}

    void apply(Node& node);

    /// All of a program's root but its title, its parameters and templates.
    void apply_to_program(Node& root);

    const std::set<std::string>& used() const { return used_; }

  private:
    const Node* find(const std::string& name);
    std::vector<std::string> names() const;
    void unknown(Node& node, const std::string& name) const;
    void compute(Node& node);
    std::string why_not_a_number(const std::string& name);

    const ParameterValues& values_;
    const Node* declared_;
    const Reader& read_;
    Substitution* outer_;
    std::set<std::string> used_;
};

}  // namespace lineshaft
