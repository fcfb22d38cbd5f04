#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/projects/excerpts.hpp"

namespace lineshaft::projects {

class MadeVariables;
struct Value;

/// Statements with labels and jumps, as statements without.
class Jumps {
  public:
    /// All labels of the body, in the order in which they stand.
    Jumps(MadeVariables& variables, std::vector<std::string> labels)
        : variables_(variables), labels_(std::move(labels)) {}

    /// From 1 on; 0: there is none of that name.
    std::size_t number_of(std::string_view label) const;
    /// What leaves for a label: `_jump1 := 2;`. It stands at the end of what is given to jump().
    std::string leaving(std::string_view label);

    /// `before` stands in front of the label.
    void label(std::string name, Excerpts before, const Mark& place);
    /// `before` ends with what leaves.
    void jump(std::string target, Excerpts before, const Mark& place);
    /// Adds to `now` that it is left where `when` is: for a label, else by RETURN.
    void leave(Excerpts& now, const std::optional<std::string>& label, const Value& when,
               const Mark& place, Diagnostics& out);
    /// All of it; `rest` stands behind the last of them.
    Excerpts finish(Excerpts rest);

  private:
    /// Statements, or a label, or where a jump goes away, in a row.
    struct Stretch {
        Excerpts statements = {};
        std::string label = {};
        std::string target = {};
        Mark place = {};
    };

    MadeVariables& variables_;
    std::vector<std::string> labels_;
    std::vector<Stretch> stretches_;
    std::string jump_;  ///< the variable that has the label which is jumped to
};

}  // namespace lineshaft::projects
