#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "runtime/projects/drawings/drawing.hpp"
#include "runtime/projects/drawings/jumps.hpp"
#include "runtime/projects/drawings/types.hpp"
#include "runtime/projects/drawings/values.hpp"

namespace lineshaft::projects {

/// What the bodies of a POU have beside what it declares.
class MadeVariables {
  public:
    /// A new one: `_wire1`.
    std::string make(std::string_view prefix, std::string_view type);
    /// One of that name, once.
    void declare(std::string_view name, std::string_view type);
    /// What the block declares itself; of a name with two types neither is known.
    void know(std::string_view name, std::string_view type);
    /// The type of `#count`, which the block declares; empty: not known.
    std::string known_type(std::string_view variable) const;
    /// A new name for what is no variable: `_action2`.
    std::string name(std::string_view prefix) { return fmt::format("{}{}", prefix, ++count_); }
    /// `_wire1 : BOOL;` and so on; empty: none.
    const std::string& declarations() const { return declarations_; }

  private:
    std::string declarations_;
    std::map<std::string, std::string, std::less<>> known_;
    int count_ = 0;
};

/// What the bodies of a POU are read with.
struct BodyContext {
    const XmlFile& file;
    Diagnostics& out;
    NetworkTypes types;
    MadeVariables& variables;
    bool is_kept = true;        ///< variables keep their values from scan to scan
    bool is_of_matiec = false;  ///< drawn with the editors of OpenPLC, Beremiz and their like
};

/// A body of networks as statements.
///
/// Elements are evaluated in the order of `Drawing::order`, each behind those that it takes values
/// from. A line that goes around takes the value of the last scan. What several lines take, or what
/// must be evaluated before something else is, goes into a variable, if its type can be told.
class NetworkText {
  public:
    NetworkText(BodyContext& context, pugi::xml_node body);

    /// All that the body does.
    Excerpts statements();
    /// What lines carry that end in a chart's transition, and what is done for it before.
    Value condition(pugi::xml_node transition);
    const Excerpts& before() const { return now_; }

  private:
    /// An element that takes something from another's output `pin`, in small letters.
    struct Use {
        std::size_t by;
        std::string pin;
    };
    /// What is known of an element's evaluation.
    struct State {
        bool is_done = false, is_active = false;
        bool is_written = false;  ///< of a variable that a box has assigned its result to
        std::size_t turn = 0;     ///< its place in the order
        std::vector<Use> uses = {};
        std::optional<Value> value = {};  ///< of its first output, from now on
        std::string loop = {};            ///< the variable of a line that goes around
        Value enabled = {};               ///< what comes out at ENO
        std::vector<std::pair<std::string, Value>> outputs = {};  ///< of a function, beside that
    };
    using Arguments = std::vector<std::pair<const Pin*, Value>>;

    // networks.cpp
    void evaluate(std::size_t i);
    void assign(std::size_t i);
    void leave(const Element& element);
    std::vector<std::string> labels() const;
    Value value_of(const Line& line, bool is_enabled);  ///< is_enabled: by ENO of a box
    bool goes_on_enabled(const Element& to, const Line& line) const;
    Value value_of(const Element& element, const Pin& pin);
    Value value_of_element(std::size_t i);
    Value value_of_wire(std::size_t i);
    Value value_of_loop(std::size_t i, const std::string& type);
    Value edge_of(const Value& value, Edge edge, const Element& element);
    Value kept_in(const std::string& variable, const Value& value, const Mark& place);
    void write_assignment(const Value& target, const Value& value, const Mark& place);
    Value written(const Element& element, pugi::xml_node text);
    Value words(std::string_view text, const Mark& place, std::string type = {}) const;
    bool comes_later(const Element& element) const;
    bool is_stored(const Element& element) const;
    bool is_read_again(const Value& value) const;
    Edge edge_of_attribute(const Element& element) const;
    Mark place_of(const Element& element) const;
    std::string name_of(const Element& element) const;
    void refuse(const Element& element, std::string_view why, std::string_view help);
    std::string attribute(const Element& element, const char* name) const {
        return file_.plain(element.node.attribute(name));
    }

    // boxes.cpp
    bool waits_for_use(std::size_t i) const;
    void evaluate_box(std::size_t i);
    void execute(const Element& box, State& state);
    void call_block(const Element& box, State& state);
    void call_function(std::size_t i);
    Value call_of(std::size_t i);
    Value in_between(const Element& box, const Arguments& arguments);
    Arguments other_outputs(std::size_t i);
    Value target_of(std::size_t i, const std::string& type);
    Value enabled_with(const Element& variable) const;
    bool ends_in_chart() const;
    std::string initial_value(const std::string& type);
    void write_guarded(const Value& enabled, const Value& target, const Value& value,
                       const Mark& place, std::string_view otherwise = {});
    Value enabled_of(const Element& box, State& state);
    std::string variable_of_eno(const Element& box, State& state);
    Value eno_of_last_scan(std::size_t i);
    Value value_of_box(std::size_t i, const std::string& name);
    Value instance_of(const Element& box);
    Value called(const Element& box);
    Value member_of(const Element& box, const std::string& pin);
    const Pin* result_of(const Element& box) const;
    const Pin* find_output(const Element& box, std::string_view name) const;
    bool is_used(const State& state, const Pin& pin) const;
    bool is_operator(const Element& box) const;
    static bool is_evaluated(const State& state);
    bool takes_result(const Element& box, const State& state) const;
    bool has_own_turn(std::size_t i) const;
    std::optional<std::size_t> only_target(std::size_t i) const;
    std::string type_name_of(const Element& box) const;
    std::string call_type(const Element& box) const;
    bool is_block(const Element& box) const;
    bool is_of_instance(const Element& box) const;
    bool gives_result(const Element& box, const Pin& output) const;
    std::string type_of_result(std::size_t i, std::set<std::size_t>& seen) const;
    std::vector<std::string> types_of_arguments(std::size_t i, std::set<std::size_t>& seen) const;
    std::string type_of_takers(std::size_t i) const;
    std::string type_of_taker(std::size_t i, std::size_t by, std::set<std::size_t>& seen) const;
    std::string type_of(const Line& line, std::set<std::size_t>& seen) const;

    BodyContext& context_;
    const XmlFile& file_;
    Drawing drawing_;
    Jumps jumps_;
    std::vector<State> states_;
    Excerpts now_;           ///< statements since the last label or jump
    std::int64_t turn_ = 0;  ///< `executionOrderId` of the element whose turn it is; in MatIEC's
                             ///< form of the box whose inputs are evaluated
    int depth_ = 0;
};

}  // namespace lineshaft::projects
