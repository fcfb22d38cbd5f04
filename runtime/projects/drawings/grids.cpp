#include "runtime/projects/drawings/grids.hpp"

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/box_calls.hpp"
#include "runtime/projects/drawings/jumps.hpp"
#include "runtime/projects/drawings/values.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

bool is_true(pugi::xml_node node, const char* attribute) {
    return std::string_view(node.attribute(attribute).value()) == "true";
}

std::string_view kind_of(pugi::xml_node node) {
    return node.name();
}

bool is_box(pugi::xml_node node) {
    return kind_of(node) == "function" || kind_of(node) == "functionblock" ||
           kind_of(node) == "actionblock";
}

std::string_view position_of(pugi::xml_node node) {
    return node.attribute("position").value();
}

/// A constant or a variable at a pin.
bool is_operand(pugi::xml_node node) {
    return kind_of(node) == "analog" ||
           (kind_of(node) == "contact" &&
            std::string_view(node.attribute("type").value()) == "address");
}

/// A variable behind an output.
bool is_target(pugi::xml_node node) {
    return kind_of(node) == "analog" &&
           std::string_view(node.attribute("type").value()) == "output";
}

class Grid {
  public:
    Grid(const XmlFile& file, Diagnostics& out, MadeVariables& variables, pugi::xml_node networks)
        : file_(file), out_(out), variables_(variables), jumps_(variables, labels(networks)) {
        for (const pugi::xml_node network : networks.children("network")) add(network);
    }

    Excerpts finish() { return jumps_.finish(std::exchange(now_, {})); }

  private:
    struct Cell {
        pugi::xml_node node;
        std::size_t row = 0, begin = 0, end = 0;
    };
    /// What a box has in one row.
    struct Pins {
        pugi::xml_node part;
        std::size_t row = 0;
        pugi::xml_node input() const { return part.child("input"); }
        pugi::xml_node output() const { return part.child("output"); }
    };
    struct Box {
        Cell first;  ///< its uppermost cell
        std::vector<Pins> pins;
        Value enabled = {};  ///< empty: there is no EN
        std::vector<std::pair<std::string, Value>> inputs = {};
        Mark place = {};
    };
    using Node = std::pair<std::size_t, std::size_t>;  ///< row and column

    static bool is_left_out(pugi::xml_node network) {
        return std::string_view(network.attribute("commented").value()) == "1";
    }

    std::vector<std::string> labels(pugi::xml_node networks) const {
        std::vector<std::string> all;
        for (const pugi::xml_node network : networks.children("network"))
            if (std::string label = file_.plain(network.attribute("label"));
                !label.empty() && !is_left_out(network))
                all.push_back(std::move(label));
        return all;
    }

    void add(pugi::xml_node network) {
        ++network_;
        if (is_left_out(network)) return;
        if (const std::string label = file_.plain(network.attribute("label")); !label.empty())
            jumps_.label(label, std::exchange(now_, {}), place_of(network, "its label"));
        lay_out(network);
        for (const Cell& cell : cells_) run(cell);
    }

    /// Cells, and which end where, from left to right.
    void lay_out(pugi::xml_node network) {
        cells_.clear(), ends_.clear(), begins_.clear(), given_.clear(), powers_.clear();
        std::size_t row = 0;
        for (const pugi::xml_node each : network.children("row")) {
            std::size_t column = 0;
            for (const pugi::xml_node node : each.children()) {
                const std::size_t end = column + (is_box(node) ? 2 : 1);
                cells_.push_back({node, row, column, end});
                column = end;
            }
            ++row;
        }
        std::ranges::stable_sort(cells_, {}, &Cell::begin);
        for (const Cell& cell : cells_) {
            begins_.emplace(Node{cell.row, cell.begin}, cell.node);
            ends_.emplace(Node{cell.row, cell.end}, cell.node);
        }
    }

    static pugi::xml_node at(const std::map<Node, pugi::xml_node>& nodes, const Node& node) {
        const auto it = nodes.find(node);
        return it == nodes.end() ? pugi::xml_node{} : it->second;
    }

    Mark place_of(pugi::xml_node node, std::string_view what) const {
        Mark place = file_.mark_of_tag(node);
        place.drawn =
            std::make_shared<const std::string>(fmt::format("network {}, {}", network_, what));
        return place;
    }
    Mark place_of(const Cell& cell) const {
        const std::string name = file_.plain(cell.node.attribute("name"));
        return place_of(cell.node, fmt::format("{} {}", kind_of(cell.node), name));
    }

    void refuse(const Mark& place, std::string why, std::string help) {
        out_.add(code::not_supported, place, std::move(why), std::move(help));
    }

    /// What is written at an element.
    Value written(pugi::xml_node node, const Mark& place) {
        const std::string plain = file_.plain(node.attribute("name"));
        if (plain.empty()) {
            refuse(place, "an operand is missing here", "name it, or remove it");
            return words("FALSE", place, "BOOL");
        }
        Value made{.text = {}, .form = shape_of(plain)};
        made.text.draw(place.drawn);
        file_.copy(made.text, node.attribute("name"));
        return made;
    }

    /// The right end of the row's cell there goes up to the row above.
    bool joins_up(std::size_t row, std::size_t column) const {
        return row > 0 && is_true(at(ends_, {row, column}), "or");
    }

    /// What leads to there; empty: nothing does.
    Value power(std::size_t row, std::size_t column, const Mark& place) {
        if (column == 0) return always(place);
        std::size_t first = row, last = row;
        while (joins_up(first, column)) --first;
        while (joins_up(last + 1, column)) ++last;
        if (const auto known = powers_.find({first, column}); known != powers_.end())
            return known->second;
        Value value;
        std::size_t takers = 0;
        for (std::size_t r = first; r <= last; ++r) {
            if (const auto it = given_.find({r, column}); it != given_.end())
                value = either(std::move(value), it->second, place);
            const pugi::xml_node next = at(begins_, {r, column});
            takers += next && kind_of(next) != "empty" && !is_operand(next);
        }
        value = within_length(std::move(value), place, out_);
        const bool is_made = value.form == Value::Form::atom && value.text.text().starts_with('_');
        if (takers > 1 && !value.is_empty() && !value.is_always && !is_made)
            value = kept_in(now_, variables_.make("_wire", "BOOL"), value, place);
        return powers_.emplace(Node{first, column}, value).first->second;
    }

    void give(const Cell& cell, Value value) {
        if (!value.is_empty()) given_[{cell.row, cell.end}] = std::move(value);
    }

    void run(const Cell& cell) {
        const std::string_view kind = kind_of(cell.node);
        const Mark place = place_of(cell);
        if (kind == "empty") return;
        if (is_operand(cell.node)) return give_operand(cell);
        if (kind == "line") return give(cell, power(cell.row, cell.begin, place));
        if (kind == "contact") return run_contact(cell, place);
        if (kind == "coil") return run_coil(cell, place);
        if (!is_box(cell.node))
            return refuse(place, fmt::format("'{}' of a ladder is not supported", kind),
                          "write it in Structured Text");
        const std::string_view position = position_of(cell.node);
        const bool is_inside = position == "middle" || position == "bottom" ||
                               (position == "top" && kind == "functionblock");
        if (!is_inside) run_box(cell);
    }

    void run_contact(const Cell& cell, const Mark& place) {
        const Value before = power(cell.row, cell.begin, place);
        if (before.is_empty()) return;
        const std::string_view type = cell.node.attribute("type").value();
        Value value = written(cell.node, place);
        if (type == "closed") {
            value = negated(value, place);
        } else if (const auto edge = edge_of(type); !edge.empty()) {
            value = on_edge(value, edge, place);
        } else if (type != "open") {
            refuse(place, fmt::format("a contact of the kind '{}' is not supported", type),
                   "write it in Structured Text");
        }
        give(cell, both(before, value, place));
    }

    static std::string_view edge_of(std::string_view type) {
        return type == "positive transition"   ? "EDGEPOS"
               : type == "negative transition" ? "EDGENEG"
               : type == "transition"          ? "EDGE"
                                               : "";
    }

    /// It is asked for in each scan, whatever leads to it.
    Value on_edge(const Value& value, std::string_view edge, const Mark& place) {
        return kept_in(now_, variables_.make("_edge", "BOOL"), called(edge, value, place), place);
    }

    void run_coil(const Cell& cell, const Mark& place) {
        Value value = power(cell.row, cell.begin, place);
        if (value.is_empty())
            return refuse(place, "nothing leads to this coil", "draw a line to it, or remove it");
        const std::string_view type = cell.node.attribute("type").value();
        if (type == "jump")
            return jumps_.leave(now_, file_.plain(cell.node.attribute("name")), value, place, out_);
        if (type == "return") return jumps_.leave(now_, {}, value, place, out_);
        if (const auto edge = edge_of(type); !edge.empty()) value = on_edge(value, edge, place);
        const Value target = written(cell.node, place);
        if (type == "set" || type == "reset") {
            write_if(now_, value, place);
            now_.append(target.text);
            now_.write(type == "set" ? " := TRUE;\n" : " := FALSE;\n", place);
            return write_end_if(now_, value, place);
        }
        if (type != "open" && type != "negated" && edge_of(type).empty())
            refuse(place, fmt::format("a coil of the kind '{}' is not supported", type),
                   "write it in Structured Text");
        now_.append(target.text);
        now_.write(" := ", place);
        now_.append((type == "negated" ? negated(value, place) : value).text);
        now_.write(";\n", place);
    }

    /// Its parts below each other, and what is given to them.
    Box read_box(const Cell& first) {
        Box box{.first = first, .pins = {}, .place = place_of(first)};
        for (std::size_t row = first.row;; ++row) {
            const pugi::xml_node part = at(begins_, {row, first.begin});
            if (!part || kind_of(part) != kind_of(first.node)) break;
            box.pins.push_back({part, row});
            if (position_of(part).ends_with("bottom")) break;
        }
        for (const Pins& pins : box.pins) {
            const pugi::xml_node input = pins.input();
            if (!input || kind_of(first.node) == "actionblock") continue;
            const std::string name = file_.plain(input.attribute("name"));
            if (name.starts_with("<!")) continue;
            Value value = power(pins.row, first.begin, box.place);
            if (name == "EN" && is_true(input, "ENO"))
                box.enabled = value.is_empty() ? words("FALSE", box.place, "BOOL") : value;
            else
                box.inputs.emplace_back(name, std::move(value));
        }
        return box;
    }

    void give_operand(const Cell& cell) {
        const std::string name = file_.plain(cell.node.attribute("name"));
        const Mark place = place_of(cell.node, name);
        const bool is_address = kind_of(cell.node) == "contact";
        if (is_target(cell.node)) return;
        Value value = written(cell.node, place);
        if (is_address) value = called("ADR", value, place);
        give(cell, std::move(value));
    }

    static Value called(std::string_view function, const Value& value, const Mark& place) {
        Value made{.text = {}};
        made.text.write(fmt::format("{}(", function), place);
        made.text.append(value.text);
        made.text.write(")", place);
        return made;
    }

    void run_box(const Cell& first) {
        if (kind_of(first.node) == "actionblock") return run_action(first);
        Box box = read_box(first);
        if (!box.enabled.is_empty() && box.enabled.form != Value::Form::atom)
            box.enabled = kept_in(now_, variables_.make("_wire", "BOOL"), box.enabled, box.place);
        if (kind_of(first.node) == "function")
            run_function(box);
        else
            run_block(box);
    }

    /// It leads on what leads to it.
    void run_action(const Cell& cell) {
        const Mark place = place_of(cell);
        Value when = power(cell.row, cell.begin, place);
        if (when.is_empty()) return;
        const bool goes_on = !when.is_always && is_taken(cell.row, cell.end);
        if (goes_on) when = kept_in(now_, variables_.make("_wire", "BOOL"), when, place);
        write_if(now_, when, place);
        file_.copy(now_, cell.node.child("output").attribute("name"));
        now_.write("();\n", place);
        write_end_if(now_, when, place);
        give(cell, std::move(when));
    }

    /// Where a line from there ends that nothing else takes anything from.
    std::size_t end_of_line(std::size_t row, std::size_t column) const {
        while (kind_of(at(begins_, {row, column})) == "line" && !joins_up(row, column) &&
               !joins_up(row + 1, column))
            ++column;
        return column;
    }

    /// An output goes into a variable, or leads on.
    void put_out(const Box& box, std::size_t row, Value value) {
        const std::size_t end = end_of_line(row, box.first.end);
        const pugi::xml_node next = at(begins_, {row, end});
        if (is_target(next)) {
            const Value target = written(next, place_of(next, "output"));
            write_if(now_, box.enabled, box.place);
            now_.append(target.text);
            now_.write(" := ", box.place);
            now_.append(value.text);
            now_.write(";\n", box.place);
            return write_end_if(now_, box.enabled, box.place);
        }
        given_[{row, end}] = std::move(value);
    }

    bool is_taken(std::size_t row, std::size_t column) const {
        const pugi::xml_node next = at(begins_, {row, column});
        const bool joins = joins_up(row, column) || joins_up(row + 1, column);
        const bool is_input = next && is_operand(next) && !is_target(next);
        return joins || (next && kind_of(next) != "empty" && !is_input);
    }

    void run_function(const Box& box) {
        const std::size_t end = box.first.end;
        bool is_used = false;
        for (const Pins& pins : box.pins) {
            const pugi::xml_node output = pins.output();
            if (!output) continue;
            if (is_true(output, "ENO")) {
                given_[{pins.row, end}] = box.enabled;
                continue;
            }
            if (!is_taken(pins.row, end)) continue;
            is_used = true;
            put_out(box, pins.row, is_power(pins.row, end) ? power_of(box) : result_at(box, pins));
        }
        const Value result = is_used ? Value{} : result_of(box);
        if (!result.text.text().ends_with(')')) return;
        write_if(now_, box.enabled, box.place);
        now_.append(result.text);
        now_.write(";\n", box.place);
        write_end_if(now_, box.enabled, box.place);
    }

    /// No value of whatever type, which goes into a variable or the box beside it.
    bool is_power(std::size_t row, std::size_t column) const {
        column = end_of_line(row, column);
        const pugi::xml_node next = at(begins_, {row, column});
        const bool joins = joins_up(row, column) || joins_up(row + 1, column);
        return joins || (!is_target(next) && !is_box(next));
    }

    /// A BOOL that leads on: FALSE while the box is not enabled.
    Value power_of(const Box& box) {
        const std::string wire = variables_.make("_wire", "BOOL");
        const bool may_not_run = !box.enabled.is_empty() && !box.enabled.is_always;
        if (may_not_run) now_.write(wire + " := FALSE;\n", box.place);
        write_if(now_, box.enabled, box.place);
        const Value value = kept_in(now_, wire, result_of(box), box.place);
        write_end_if(now_, box.enabled, box.place);
        return value;
    }

    /// A MOVE may have several inputs, each with an output in its row.
    Value result_at(const Box& box, const Pins& pins) {
        const std::string type = file_.plain(box.first.node.attribute("type"));
        return st::same_name(type, "move") && pins.input()
                   ? power(pins.row, box.first.begin, box.place)
                   : result_of(box);
    }

    Value result_of(const Box& box) {
        const std::string type = file_.plain(box.first.node.attribute("type"));
        if (type.ends_with('!')) return formula_of(box);
        for (const auto& [name, value] : box.inputs)
            if (value.is_empty()) {
                refuse(box.place, "nothing leads to an input of this box",
                       "connect it, or write the call in Structured Text");
                return words("FALSE", box.place, "BOOL");
            }
        if (st::same_name(type, "move") && box.inputs.size() == 1) return box.inputs[0].second;
        std::string_view sign = infix_of(type);
        if (st::same_name(type, "and")) sign = " AND ";
        if (st::same_name(type, "or")) sign = " OR ";
        const bool is_sum = !sign.empty() && box.inputs.size() > 1;
        Value made{.text = {}, .form = is_sum ? Value::Form::other : Value::Form::atom};
        if (!is_sum) made.text.write(type + "(", box.place);
        for (std::size_t i = 0; i < box.inputs.size(); ++i) {
            const Value& input = box.inputs[i].second;
            if (i > 0) made.text.write(is_sum ? sign : ", ", box.place);
            made.text.append(is_sum ? enclosed(input, box.place) : input.text);
        }
        if (!is_sum) made.text.write(")", box.place);
        return made;
    }

    /// `Compare!` and `Compute!` have an expression of Structured Text in them.
    Value formula_of(const Box& box) {
        for (const Pins& pins : box.pins) {
            const pugi::xml_attribute name = pins.input().attribute("name");
            const std::string plain = file_.plain(name);
            if (!plain.starts_with("<!")) continue;
            Value made{.text = {}, .form = Value::Form::other};
            const Part part = file_.part(name);
            const std::size_t sign = file_.text(part).find('!') + 1;
            made.text.draw(box.place.drawn);
            file_.copy(made.text, {part.begin + sign, part.end});
            return made;
        }
        refuse(box.place, "this box has no expression", "write one into it");
        return words("FALSE", box.place, "BOOL");
    }

    void run_block(const Box& box) {
        const Value instance = written(box.first.node, box.place);
        if (instance.text.text().starts_with("zz"))  // as the editor names what nobody has declared
            variables_.declare(instance.text.text(), file_.plain(box.first.node.attribute("type")));
        write_if(now_, box.enabled, box.place);
        now_.append(instance.text);
        now_.write("(", box.place);
        bool is_first = true;
        for (const auto& [name, value] : box.inputs) {
            if (value.is_empty() || name.empty()) continue;
            now_.write(fmt::format("{}{} := ", is_first ? "" : ", ", name), box.place);
            now_.append(value.text);
            is_first = false;
        }
        now_.write(");\n", box.place);
        write_end_if(now_, box.enabled, box.place);
        for (const Pins& pins : box.pins) {
            const pugi::xml_node output = pins.output();
            if (!output || !is_taken(pins.row, box.first.end)) continue;
            Value value{.text = instance.text};
            value.text.write("." + file_.plain(output.attribute("name")), box.place);
            if (is_true(output, "ENO"))
                given_[{pins.row, box.first.end}] = box.enabled;
            else
                put_out(box, pins.row, std::move(value));
        }
    }

    const XmlFile& file_;
    Diagnostics& out_;
    MadeVariables& variables_;
    Jumps jumps_;
    Excerpts now_;             ///< statements since the last label or jump
    std::size_t network_ = 0;  ///< under way, from 1 on
    std::vector<Cell> cells_;  ///< of the network, in the order of evaluation
    std::map<Node, pugi::xml_node> begins_, ends_;
    std::map<Node, Value> given_;  ///< by elements that end there
    std::map<Node, Value>
        powers_;  ///< what leads on from there, by the uppermost row of those joined
};

}  // namespace

Excerpts text_of_grid(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                      pugi::xml_node networks) {
    return Grid(file, out, variables, networks).finish();
}

}  // namespace lineshaft::projects
