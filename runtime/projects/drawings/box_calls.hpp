#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/projects/drawings/values.hpp"

namespace lineshaft::projects {

/// A box with what leads to it, as TwinCAT keeps both kinds of networks.
struct BoxCall {
    std::string type;                     ///< `ADD`, or what is called
    std::vector<Value> inputs = {};       ///< empty ones: nothing leads there
    std::vector<std::string> names = {};  ///< of inputs
    Mark place = {};
};

/// `INT`, `Lib.Type`: as the type of a variable.
bool is_type_name(std::string_view type);

/// Its result is an expression of what leads to it, and it has no names of inputs.
bool is_operator(std::string_view type);

/// Whether a box of an instance calls a METHOD or an ACTION of it, which stands behind the last '.'
/// of the box' type (`Motor.Stop`).
bool calls_member(std::string_view call, std::string_view instance);
std::string_view member_of_type(std::string_view type);
/// Whether the outputs of a box are those of an instance, or of none, and not a METHOD's.
bool has_own_outputs(std::string_view call, std::string_view instance);
/// Whether an output of a METHOD's box is the result, which has the METHOD's name, or none.
bool names_result(std::string_view output, std::string_view type);

/// `(IN := a, PT := b)`; of a function without names `(a, b)`; `outputs` stand behind that.
Excerpts arguments_of(const BoxCall& box,
                      const std::vector<std::pair<std::string, Excerpts>>& outputs = {});

/// Whether so many elements stand behind one another that no more are read, which is told.
bool is_too_deep(int depth, const Mark& place, Diagnostics& out);
/// The value; FALSE, and told, where its text is too long.
Value within_length(Value value, const Mark& place, Diagnostics& out);

/// What an operator makes of its inputs. Empty: nothing leads to one of them.
Value result_of_operator(const BoxCall& box);

}  // namespace lineshaft::projects
