#include "runtime/projects/drawings/box_trees.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/archive.hpp"
#include "runtime/projects/drawings/tree_boxes.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

class BoxTrees {
  public:
    BoxTrees(const XmlFile& file, Diagnostics& out, MadeVariables& variables, bool is_kept,
             pugi::xml_node body)
        : archive_(file),
          file_(file),
          out_(out),
          variables_(variables),
          is_kept_(is_kept),
          networks_(Archive::items(Archive::member(Archive::root(body), "NetworkList"))),
          jumps_(variables, labels()) {}

    Excerpts statements() {
        for (const pugi::xml_node network : networks_) {
            ++network_;
            if (!archive_.is_true(network, "OutCommented")) add_network(network);
        }
        return jumps_.finish(std::exchange(now_, {}));
    }

  private:
    /// A label may also be a heading; one that is jumped to is one.
    std::vector<std::string> labels() const {
        std::vector<std::string> all;
        for (const pugi::xml_node network : networks_)
            if (!archive_.is_true(network, "OutCommented") &&
                !archive_.text(network, "Label").empty())
                all.push_back(archive_.text(network, "Label"));
        return all;
    }

    Mark place_of(pugi::xml_node object, std::string_view what) const {
        Mark place = file_.mark_of_tag(object ? object : networks_[network_ - 1]);
        place.drawn =
            std::make_shared<const std::string>(fmt::format("network {}, {}", network_, what));
        return place;
    }

    void refuse(const Mark& place, std::string why, std::string help) {
        out_.add(code::not_supported, place, std::move(why), std::move(help));
    }

    /// Into a variable, so that it may be taken again; as it is, where its type is not known.
    Value fixed(const Value& value, const Mark& place) {
        const std::string_view text = value.text.text();
        const bool is_made = value.form == Value::Form::atom &&
                             (text.starts_with("_wire") || text.starts_with("_edge"));
        if (value.is_always || is_made || !is_type_name(value.type)) return value;
        return kept_in(now_, variables_.make("_wire", value.type), value, place);
    }

    void add_network(pugi::xml_node network) {
        if (archive_.is_true(network, "ILActive"))
            return refuse(place_of(network, "a list"),
                          "an instruction list of TwinCAT is not supported",
                          "show the network as FBD or LD, and save it");
        wires_.clear();
        if (const std::string label = archive_.text(network, "Label"); !label.empty())
            jumps_.label(label, std::exchange(now_, {}), place_of(network, "its label"));
        for (const pugi::xml_node item : Archive::items(Archive::member(network, "NetworkItems")))
            evaluate(item);
    }

    /// A tree that nothing is behind.
    void evaluate(pugi::xml_node tree) {
        if (Archive::is_null(tree)) return;
        const std::string_view kind = Archive::kind_of(tree);
        if (kind == "BoxTreeBox")
            value_of_box(tree, false);
        else if (kind == "BoxTreeTerminator")
            evaluate(Archive::member(tree, "Input"));
        else
            value_of(tree);
    }

    Value value_of(pugi::xml_node tree) {
        if (Archive::is_null(tree)) return {};
        const Mark place = place_of(tree, "a line");
        if (is_too_deep(depth_, place, out_)) return words("FALSE", place, "BOOL");
        ++depth_;
        Value value = value_of_kind(tree, place);
        value = both(std::exchange(left_, {}), std::move(value), place);
        --depth_;
        return within_length(std::move(value), place, out_);
    }

    Value value_of_kind(pugi::xml_node tree, const Mark& place) {
        const std::string_view kind = Archive::kind_of(tree);
        if (kind == "BoxTreeOperand") {
            const pugi::xml_node operand = Archive::member(tree, "Operand");
            const Value value = written(operand);
            return marked(value, archive_.marks_of(operand),
                          place_of(operand, archive_.text(operand, "Operand")));
        }
        if (kind == "BoxTreeBox") return value_of_box(tree, true);
        if (kind == "BoxTreeAssign") return assign(tree);
        if (kind == "BoxTreeDemux") return value_of_wire(tree, place);
        if (kind == "BoxTreeParallel") return value_of_parallel(tree, place);
        if (kind == "BoxTreeTerminator") {
            const pugi::xml_node input = Archive::member(tree, "Input");
            if (!Archive::is_null(input)) return value_of(input);
            return left_.is_empty() ? always(place) : std::exchange(left_, {});
        }
        refuse(place, fmt::format("'{}' of a network is not supported", kind),
               "convert the body to Structured Text in TwinCAT");
        return words("FALSE", place, "BOOL");
    }

    /// An operand, as it is written. Empty: nothing is.
    Value written(pugi::xml_node operand) {
        const pugi::xml_node named = Archive::member(operand, "Operand");
        const std::string plain = archive_.text(operand, "Operand");
        if (plain.empty()) return {};
        const Mark place = place_of(operand, plain);
        if (st::same_name(plain, "true")) return always(place);
        if (plain == "???") {
            refuse(place, "an operand is missing here", "name it, or remove it");
            return words("FALSE", place, "BOOL");
        }
        Value made{.text = {}, .form = shape_of(plain), .type = archive_.text(operand, "Type")};
        if (made.type.empty() && archive_.is_true(operand, "Boolean")) made.type = "BOOL";
        made.text.draw(place.drawn);
        std::vector<Part> parts = file_.texts(named);
        if (parts.size() != 1 || file_.text(parts.front()) != fmt::format("\"{}\"", plain))
            return words(plain, place, made.type);
        file_.copy(made.text, {parts.front().begin + 1, parts.front().end - 1});
        return made;
    }

    Value marked(Value value, const Marks& marks, const Mark& place) {
        if (value.is_empty()) return value;
        if (marks.is_rising || marks.is_falling)
            value = edge_of(value, marks.is_rising ? "R_TRIG" : "F_TRIG", place);
        return marks.is_negated ? negated(value, place) : value;
    }

    Value edge_of(const Value& value, std::string_view type, const Mark& place) {
        if (!is_kept_)
            refuse(place, "an edge needs a variable that is kept from scan to scan",
                   "draw it in a function block or a program");
        const std::string name = variables_.make("_edge", type);
        now_.write(name + "(CLK := ", place);
        now_.append(value.text);
        now_.write(");\n", place);
        return words(name + ".Q", place, "BOOL");
    }

    /// A wire that leads to several. Where it has an input it is defined.
    Value value_of_wire(pugi::xml_node wire, const Mark& place) {
        const std::string number = archive_.text(wire, "VarId");
        const pugi::xml_node input = Archive::member(wire, "Input");
        if (!Archive::is_null(input)) {
            Value value = value_of(input);
            if (value.is_empty()) value = always(place);
            return wires_[number] = fixed(value, place);
        }
        const auto it = wires_.find(number);
        if (it != wires_.end()) return it->second;
        refuse(place, fmt::format("the wire {} leads here, and nothing leads to it", number),
               "draw it anew");
        return words("FALSE", place, "BOOL");
    }

    /// Branches beside each other, behind what leads to all of them.
    Value value_of_parallel(pugi::xml_node parallel, const Mark& place) {
        const pugi::xml_node input = Archive::member(parallel, "Input");
        Value before = Archive::is_null(input) ? std::exchange(left_, {}) : value_of(input);
        const auto trees = Archive::items(Archive::member(parallel, "Trees"));
        if (std::ranges::none_of(trees, [&](auto tree) { return has_box(tree); }))
            return both(before, any_of(trees, {}, place), place);
        if (!before.is_empty()) before.type = "BOOL";
        if (archive_.text(parallel, "Mode") == "BoxShortCircuit")
            return short_circuit(before, trees, place);
        if (!before.is_empty()) before = fixed(before, place);
        return any_of(trees, before, place);
    }

    /// `before` leads to each of them.
    Value any_of(const std::vector<pugi::xml_node>& trees, const Value& before, const Mark& place) {
        Value value;
        for (const pugi::xml_node tree : trees) {
            left_ = before;
            value = either(std::move(value), value_of(tree), place);
            left_ = {};
        }
        return value;
    }

    /// Branches with boxes are left out where nothing leads to them, or another one is TRUE
    /// already.
    Value short_circuit(const Value& before, const std::vector<pugi::xml_node>& trees,
                        const Mark& place) {
        std::vector<pugi::xml_node> plain, rest;
        for (const pugi::xml_node tree : trees) (has_box(tree) ? rest : plain).push_back(tree);
        const Value others = any_of(plain, {}, place);
        Value due = others.is_empty() ? before : both(before, negated(others, place), place);
        if (due.is_empty() || due.is_always) return any_of(rest, {}, place);
        due.type = "BOOL";
        due = fixed(due, place);
        const std::string found = variables_.make("_wire", "BOOL");
        now_.write(found + " := FALSE;\n", place);
        write_if(now_, due, place);
        kept_in(now_, found, any_of(rest, {}, place), place);
        write_end_if(now_, due, place);
        const Value known = others.is_empty() ? Value{} : both(before, others, place);
        return either(known, words(found, place, "BOOL"), place);
    }

    /// One that does something, and is not only a part of an expression.
    bool has_box(pugi::xml_node tree) const {
        const auto is_box = [&](pugi::xml_node node) {
            return Archive::member(node, "BoxType") && takes_power(node) &&
                   !st::same_name(archive_.text(node, "BoxType"), "and");
        };
        return is_box(tree) || tree.find_node(is_box);
    }

    /// Its first input is what leads to it, and not a value.
    bool takes_power(pugi::xml_node box) const {
        const bool has_instance =
            !archive_.text(Archive::member(box, "Instance"), "Operand").empty();
        return has_instance || archive_.is_true(box, "EN") ||
               st::same_name(archive_.text(box, "BoxType"), "and");
    }

    /// Its targets take what leads to it.
    Value assign(pugi::xml_node assignment) {
        const Mark place = place_of(assignment, "an assignment");
        Value value = value_of(Archive::member(assignment, "RValue"));
        if (value.is_empty()) value = always(place);
        value = marked(value, plain_marks(archive_.marks_of(assignment)), place);
        const auto targets = Archive::items(
            Archive::member(Archive::member(assignment, "OutputItems"), "OutputItems"));
        if (targets.size() > 1) {
            if (value.type.empty()) value.type = archive_.text(targets.front(), "Type");
            value = fixed(value, place);
        }
        for (const pugi::xml_node target : targets)
            if (!Archive::is_null(target)) assign(target, value);
        return value;
    }

    /// A jump and a return are marked at the assignment and at its target.
    static Marks plain_marks(Marks marks) {
        marks.is_jump = marks.is_return = marks.is_set = false;
        return marks;
    }

    void assign(pugi::xml_node target, Value value) {
        const Marks marks = archive_.marks_of(target);
        const std::string name = archive_.text(target, "Operand");
        const Mark place = place_of(target, name);
        if (marks.is_jump) return jumps_.leave(now_, name, value, place, out_);
        if (marks.is_return) return jumps_.leave(now_, {}, value, place, out_);
        if (marks.is_rising || marks.is_falling)
            value = edge_of(value, marks.is_rising ? "R_TRIG" : "F_TRIG", place);
        const Value to = written(target);
        if (to.is_empty()) return;
        if (marks.is_set) {
            write_if(now_, value, place);
            now_.append(to.text);
            now_.write(marks.is_negated ? " := FALSE;\n" : " := TRUE;\n", place);
            return write_end_if(now_, value, place);
        }
        now_.append(to.text);
        now_.write(" := ", place);
        now_.append((marks.is_negated ? negated(value, place) : value).text);
        now_.write(";\n", place);
    }

    /// What a box is given is evaluated here.
    TreeBox read_box(pugi::xml_node node) {
        TreeBox box = read_tree_box(archive_, node);
        box.place = place_of(node, "box " + box.type);
        const auto marks = Archive::items(Archive::member(node, "InputFlags"));
        const auto inputs = Archive::items(Archive::member(node, "InputItems"));
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            Value value = value_of(inputs[i]);
            if (i < marks.size())
                value = marked(std::move(value), archive_.marks_in(marks[i]), box.place);
            box.inputs.push_back(std::move(value));
        }
        if (box.has_enable && !box.inputs.empty()) {
            box.enabled = box.inputs.front();
            box.inputs.erase(box.inputs.begin());
            if (!box.names.empty()) box.names.erase(box.names.begin());
            if (box.has_eno) box.enabled = fixed(box.enabled, box.place);
        }
        return box;
    }

    Value enabled_of(const TreeBox& box) const {
        return box.enabled.is_empty() ? always(box.place) : box.enabled;
    }

    /// Statements of a box, and what it gives to what is behind it.
    Value value_of_box(pugi::xml_node node, bool is_taken) {
        Value left = takes_power(node) ? Value{} : std::exchange(left_, {});
        TreeBox box = read_box(node);
        left_ = std::move(left);
        if (archive_.is_true(node, "ProvidesSTSnippet")) return execute(box);
        const Value value = box.is_block() ? call_block(box) : call_function(box, is_taken);
        return marked(value, plain_marks(archive_.marks_of(node)), box.place);
    }

    /// A box with Structured Text in it.
    Value execute(const TreeBox& box) {
        const pugi::xml_node snippet =
            Archive::member(Archive::member(box.node, "STSnippet"), "STSnippet");
        const pugi::xml_node text =
            Archive::member(Archive::member(snippet, "TextDocument"), "TextBlobForSerialisation");
        const std::vector<Part> parts = file_.texts(text);
        write_if(now_, box.enabled, box.place);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const std::size_t quote = file_.text(parts[i]).size() > 1 ? 1 : 0;
            const std::size_t begin = parts[i].begin + (i == 0 ? quote : 0);
            const std::size_t end = parts[i].end - (i + 1 == parts.size() ? quote : 0);
            file_.copy(now_, {begin, end});
        }
        now_.write("\n", box.place);
        write_end_if(now_, box.enabled, box.place);
        return enabled_of(box);
    }

    /// `instance`, `instance.Method`, or what stands at the box.
    Value called(const TreeBox& box) {
        if (box.instance.empty()) return words(box.type, box.place);
        Value made = written(Archive::member(box.node, "Instance"));
        if (box.is_of_instance()) made.text.write(fmt::format(".{}", box.member()), box.place);
        return made;
    }

    Value call_block(const TreeBox& box) {
        const Value block = box.instance.empty() ? words(box.type, box.place)
                                                 : written(Archive::member(box.node, "Instance"));
        const auto output = [&](std::size_t i) {
            if (box.has_eno && i == 0) return enabled_of(box);
            Value made{.text = {}, .type = box.output_type(i)};
            made.text.append(block.text);
            made.text.write(fmt::format(".{}", i < box.outputs.size() ? box.outputs[i] : "?"),
                            box.place);
            return made;
        };
        write_if(now_, box.enabled, box.place);
        now_.append(called(box).text);
        now_.append(arguments_of(box));
        now_.write(";\n", box.place);
        for (std::size_t i = box.result(); i < box.takers.size(); ++i) give(box, i, output(i));
        write_end_if(now_, box.enabled, box.place);
        if (box.has_eno) give(box, 0, enabled_of(box));
        return box.main() < box.outputs.size() ? output(box.main()) : enabled_of(box);
    }

    /// `???` at an output is a pin without a variable, as is an empty one.
    bool is_taken_at(const TreeBox& box, std::size_t output) const {
        if (output >= box.takers.size() || Archive::is_null(box.takers[output])) return false;
        const std::string text = archive_.text(box.takers[output], "Operand");
        return text.empty() ? archive_.marks_of(box.takers[output]).is_return : text != "???";
    }

    /// To what is connected to an output.
    void give(const TreeBox& box, std::size_t output, const Value& value) {
        if (!is_taken_at(box, output)) return;
        const Marks marks = archive_.marks_of(box.takers[output]);
        if (marks.is_jump || marks.is_return)
            return refuse(box.place, "a jump at an output of a box is not supported",
                          "draw it behind a contact");
        assign(box.takers[output], value);
    }

    /// A variable for what is behind the box, where that takes an output beside the result. Empty:
    /// it does not.
    Value wire_behind(const TreeBox& box) {
        const std::size_t main = box.main();
        const bool is_one = main >= box.first_other() && main < box.outputs.size() &&
                            main < box.takers.size() && Archive::is_null(box.takers[main]);
        const std::string type = box.output_type(main);
        if (!is_one) return {};
        if (!type.empty()) return words(variables_.make("_wire", type), box.place, type);
        refuse(box.place, "the type of what comes out of this box is not known",
               "assign it to a variable, and take that");
        return words("FALSE", box.place);
    }

    /// What a function gives beside its result, to operands and to what is `behind`.
    std::vector<std::pair<std::string, Excerpts>> outputs_of(const TreeBox& box,
                                                             const Value& behind) {
        std::vector<std::pair<std::string, Excerpts>> made;
        for (std::size_t i = box.first_other(); i < box.outputs.size(); ++i) {
            if (is_taken_at(box, i))
                made.emplace_back(box.outputs[i], written(box.takers[i]).text);
            else if (i == box.main() && !behind.is_empty())
                made.emplace_back(box.outputs[i], behind.text);
        }
        return made;
    }

    Value call_function(const TreeBox& box, bool is_taken) {
        const std::size_t result = box.result();
        const bool is_assigned = box.has_result() && is_taken_at(box, result);
        const bool is_result_taken = box.has_result() && is_taken && box.main() == result;
        const Value behind = is_taken ? wire_behind(box) : Value{};
        Value value = result_of(box, behind);
        if (is_assigned) {
            write_if(now_, box.enabled, box.place);
            give(box, result, value);
            write_end_if(now_, box.enabled, box.place);
            if (is_result_taken) value = written(box.takers[result]);
        } else if (!is_result_taken && !is_operator(box.type)) {
            write_if(now_, box.enabled, box.place);
            now_.append(value.text);
            now_.write(";\n", box.place);
            write_end_if(now_, box.enabled, box.place);
        }
        if (box.has_eno) give(box, 0, enabled_of(box));
        if (is_result_taken) return is_assigned ? value : if_enabled(box, value);
        return behind.is_empty() ? enabled_of(box) : behind;
    }

    /// While a box is not enabled its result is FALSE, or stays as it is.
    Value if_enabled(const TreeBox& box, const Value& value) {
        if (box.enabled.is_empty() || box.enabled.is_always) return value;
        if (value.type == "BOOL") return both(box.enabled, value, box.place);
        if (!is_type_name(value.type)) {
            refuse(box.place, "the type of what comes out of this box is not known",
                   "assign it to a variable, and take that");
            return value;
        }
        const std::string name = variables_.make("_wire", value.type);
        write_if(now_, box.enabled, box.place);
        const Value kept = kept_in(now_, name, value, box.place);
        write_end_if(now_, box.enabled, box.place);
        return kept;
    }

    Value result_of(const TreeBox& box, const Value& behind) {
        if (is_operator(box.type)) {
            Value made = result_of_operator(box);
            if (!made.is_empty()) return made;
            refuse(box.place, "nothing leads to an input of this box", "connect it");
            return words("FALSE", box.place, "BOOL");
        }
        Value made;
        if (box.call == "Function" || box.is_method()) made.type = box.output_type(box.result());
        made.text.append(called(box).text);
        made.text.append(arguments_of(box, outputs_of(box, behind)));
        return made;
    }

    Archive archive_;
    const XmlFile& file_;
    Diagnostics& out_;
    MadeVariables& variables_;
    bool is_kept_;
    std::vector<pugi::xml_node> networks_;
    Jumps jumps_;
    std::map<std::string, Value> wires_;  ///< of the network, by their numbers
    Excerpts now_;                        ///< statements since the last label or jump
    std::size_t network_ = 0;             ///< under way, from 1 on
    int depth_ = 0;
    Value left_ = {};  ///< what leads to the branch under way; empty: the rail, or it is taken
};

}  // namespace

Excerpts text_of_box_trees(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                           bool is_kept, pugi::xml_node body) {
    return BoxTrees(file, out, variables, is_kept, body).statements();
}

}  // namespace lineshaft::projects
