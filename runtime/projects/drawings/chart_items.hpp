#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/projects/drawings/archive.hpp"
#include "runtime/projects/drawings/box_calls.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

/// What a chart of TwinCAT is drawn of.
enum class Item : std::uint8_t {
    input,
    output,
    box,
    composer,
    selector,
    jump,
    label,
    return_,
    comment,
    other
};

struct NamedItem {
    std::string_view name;
    Item kind;
};
inline constexpr NamedItem items_by_name[] = {
    {"CFCInputElement", Item::input},       {"CFCOutputElement", Item::output},
    {"CFCBoxElement", Item::box},           {"CFCComposerElement", Item::composer},
    {"CFCSelectorElement", Item::selector}, {"CFCJumpElement", Item::jump},
    {"CFCLabelElement", Item::label},       {"CFCReturnElement", Item::return_},
    {"CFCCommentElement", Item::comment},
};

/// A pin of an element.
struct PinPlace {
    std::size_t item = 0, pin = 0;
    bool is_input = false;  ///< from which what is VAR_IN_OUT goes on
};

struct ChartPin {
    pugi::xml_node node;
    std::string name = {};
    bool is_negated = false;
    std::string wire = {};  ///< the variable of a METHOD's output beside its result
};

struct ChartItem {
    pugi::xml_node node;
    Item kind = Item::other;
    std::string text = {};      ///< what stands in it; of a box what is called
    std::string instance = {};  ///< of a box
    std::string call = {};      ///< of a box: `Method`, `FunctionBlock`, an operator's
    int x = 0, y = 0;
    std::vector<ChartPin> inputs = {}, outputs = {};
    std::size_t takers = 0;           ///< of what comes out
    std::optional<Value> value = {};  ///< of a function, as soon as it is evaluated
    std::string loop = {};            ///< the variable of what goes back

    bool is_of_instance() const { return calls_member(call, instance); }
    /// Its outputs are those of an instance.
    bool is_block() const { return has_own_outputs(call, instance); }
    bool has_eno() const { return !outputs.empty() && st::same_name(outputs[0].name, "eno"); }
    /// A METHOD without a result has its VAR_OUTPUTs alone.
    bool has_result() const;
    /// The first output beside ENO and the result.
    std::size_t first_other() const { return (has_eno() ? 1 : 0) + (has_result() ? 1 : 0); }
    /// The type of what comes out, as far as the name tells.
    std::string type() const;
    /// `bounds`: `x, y, width, height`.
    void stand_at(const std::string& bounds);
};

/// Where what leads to a pin comes from; empty: nothing does.
using SourceOfPin = std::function<std::optional<PinPlace>(const ChartPin&)>;
/// Elements behind those that they take values from, networks from top to bottom.
std::vector<std::size_t> order_by_data_flow(const std::vector<ChartItem>& items,
                                            const SourceOfPin& source_of);

}  // namespace lineshaft::projects
