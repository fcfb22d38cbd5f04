#include "runtime/projects/drawings/flag_nets.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/s7_instructions.hpp"
#include "runtime/projects/drawings/simatic_access.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

using st::same_name;

/// What SimaticML calls otherwise than SIMATIC SD.
std::string name_of(std::string_view part, bool is_negated) {
    static constexpr std::pair<std::string_view, std::string_view> named[] = {
        {"PContact", "P_Contact"},
        {"NContact", "N_Contact"},
        {"PBox", "P_Trig"},
        {"NBox", "N_Trig"},
        {"SCoil", "S_Coil"},
        {"RCoil", "R_Coil"},
        {"PCoil", "P_Coil"},
        {"NCoil", "N_Coil"},
        {"Rs", "S_RS"},
        {"Sr", "S_SR"},
        {"Jump", "JumpCoil"},
        {"JumpNot", "I_JumpCoil"},
        {"CoilTON", "TON_Coil"},
        {"CoilTOF", "TOF_Coil"},
        {"CoilTP", "TP_Coil"},
        {"CoilTONR", "TONR_Coil"},
        {"SBitfield", "SET_BF"},
        {"RBitfield", "RESET_BF"},
        {"Calc", "Calculate"},
        {"MoveBlockI", "MOVE_BLK"},
        {"MoveBlockU", "UMOVE_BLK"},
    };
    for (const auto& [name, other] : named)
        if (part == name) return std::string(other);
    return (is_negated && is_any(part, {"Contact", "Coil"}) ? "I_" : "") + std::string(part);
}

bool is_s5_timer(std::string_view part) {
    return is_any(
        part, {"S_PULSE", "S_PEXT", "S_ODT", "S_ODTS", "S_OFFDT", "Sp", "Se", "Sd", "Ss", "Sf"});
}

/// `SCoil`, `CoilTON`, `ReturnTrue`, in small letters.
bool is_coil(std::string_view part) {
    return part.ends_with("coil") || part.starts_with("coil") || part.starts_with("return");
}

/// Where power comes in: the first of them that is connected.
std::vector<std::string_view> power_pins(std::string_view part) {
    if (is_any(part, {"TON", "TOF", "TP", "TONR"})) return {"IN"};
    if (is_any(part, {"CTU", "CTUD"})) return {"CU"};
    if (is_any(part, {"CTD", "S_CD"})) return {"CD"};
    if (is_any(part, {"S_CU", "S_CUD"})) return {"CU"};
    if (is_s5_timer(part)) return {"S"};
    if (same_name(part, "Sr")) return {"s"};
    if (same_name(part, "Rs")) return {"r"};
    if (is_any(part, {"A", "O", "X"})) return {};
    if (is_any(part, {"PContact", "NContact"})) return {"pre"};
    if (is_any(part, {"SET_BF", "RESET_BF"})) return {"en", "in"};
    const std::string small = lower(part);
    if (small.ends_with("contact") || small.ends_with("box") || is_coil(small) ||
        is_any(part, {"Not", "Jump", "JumpNot"}))
        return {"in"};
    return {"en", "pre"};
}

/// Whether the part is executed without a condition where nothing leads to its power pin.
bool is_unconditional(std::string_view part) {
    const std::vector<std::string_view> pins = power_pins(part);
    return pins.empty() || is_any(pins.front(), {"en", "in", "pre"});
}

/// Whether an open connection leaves the pin out. Power that nothing stops is always there.
bool is_left_out(std::string_view part, std::string_view pin) {
    return !is_unconditional(part) || !std::ranges::any_of(power_pins(part), st::is_called(pin));
}

/// Whether what comes out there is power, and no value that a box writes.
bool is_power(std::string_view part, std::string_view pin) {
    const std::string small = lower(part);
    if (same_name(pin, "eno")) return true;
    if (is_s5_timer(part) || is_any(part, {"TON", "TOF", "TP", "TONR", "CTU", "CTD", "Sr", "Rs",
                                           "S_CU", "S_CD", "S_CUD"}))
        return same_name(pin, "Q");
    if (same_name(part, "CTUD")) return same_name(pin, "QU");
    return same_name(pin, "out") &&
           (small.ends_with("contact") || small.ends_with("box") || is_coil(small) ||
            is_any(part, {"Not", "A", "O", "X", "Eq", "Ne", "Gt", "Lt", "Ge", "Le", "InRange",
                          "OutRange", "OK", "NotOk", "SET_BF", "RESET_BF"}));
}

/// Whether it does nothing but give what comes out of it.
bool is_pure(std::string_view part) {
    return is_any(part, {"Contact", "Not", "A", "O", "X", "Eq", "Ne", "Gt", "Lt", "Ge", "Le",
                         "InRange", "OutRange", "OK", "NotOk"});
}

/// The end of a wire at an element.
struct End {
    std::string element = {};  ///< its `UId`; empty: the power rail
    std::string pin = {};
};

struct Input {
    std::string pin;
    End from;
    bool is_negated = false;
};

struct Output {
    std::string pin;
    std::vector<std::string> targets = {};  ///< `UId`s of variables
    std::vector<std::string> takers = {};   ///< `UId`s of other elements
    Value value = {};                       ///< when it is executed
};

struct Piece {
    pugi::xml_node node;
    std::string part;  ///< `TON`; of a call the block's name in quotes
    std::vector<Input> inputs = {};
    std::vector<Output> outputs = {};
    std::size_t turn = 0;  ///< in the order of the file
    enum class State : std::uint8_t { waits, runs, done } state = State::waits;
};

class FlagNet {
  public:
    FlagNet(const XmlFile& file, Diagnostics& out, MadeVariables& variables, int number)
        : file_(file), access_(file), out_(out), instructions_(out, variables), number_(number) {}

    Excerpts read(pugi::xml_node net) {
        for (const auto label : net.child("Labels").children("LabelDeclaration")) {
            now_.append(access_.label(label.child("Label")));
            now_.write(": ;\n", file_.mark_of_tag(label));
        }
        for (const auto part : net.child("Parts").children()) add_part(part);
        for (const auto wire : net.child("Wires").children("Wire")) add_wire(wire);
        for (const std::string& each : order_) run(each);
        return std::move(now_);
    }

  private:
    static constexpr int deepest = 500;

    std::string plain(pugi::xml_node node, const char* attribute) const {
        return file_.plain(node.attribute(attribute));
    }
    Mark place_of(const Piece& element) const {
        Mark made = file_.mark_of_tag(element.node);
        made.drawn = std::make_shared<const std::string>(
            fmt::format("network {}, {} {}", number_, element.part, plain(element.node, "UId")));
        return made;
    }
    void tell(const Piece& element, std::string why, std::string help) {
        out_.add(code::not_supported, place_of(element), std::move(why), std::move(help));
    }

    void add_part(pugi::xml_node part) {
        const std::string id = plain(part, "UId");
        if (std::string_view(part.name()) == "Access") {
            accesses_[id] = part;
            return;
        }
        const bool is_call = std::string_view(part.name()) == "Call";
        elements_[id] = {.node = part,
                         .part = is_call
                                     ? fmt::format("\"{}\"", plain(part.child("CallInfo"), "Name"))
                                     : plain(part, "Name"),
                         .turn = order_.size()};
        order_.push_back(id);
    }

    /// From the first of its ends to the others.
    void add_wire(pugi::xml_node wire) {
        const pugi::xml_node first = wire.first_child();
        End from{plain(first, "UId"), plain(first, "Name")};
        Piece* source = find(from.element);
        Output* output = source ? &output_of(*source, from.pin) : nullptr;
        for (auto to = first.next_sibling(); to; to = to.next_sibling()) {
            const std::string id = plain(to, "UId");
            if (Piece* element = find(id)) {
                const std::string pin = plain(to, "Name");
                if (is_open(first) && is_left_out(element->part, pin)) continue;
                element->inputs.push_back({pin, from, is_negated(*element, pin)});
                if (output) output->takers.push_back(id);
            } else if (output && accesses_.contains(id)) {
                output->targets.push_back(id);
            }
        }
    }

    /// Nothing stands there: a call leaves the pin out, and what it had stays.
    static bool is_open(pugi::xml_node end) { return std::string_view(end.name()) == "OpenCon"; }

    Piece* find(const std::string& id) {
        const auto found = elements_.find(id);
        return found == elements_.end() ? nullptr : &found->second;
    }
    static Output& output_of(Piece& element, const std::string& pin) {
        for (Output& output : element.outputs)
            if (same_name(output.pin, pin)) return output;
        return element.outputs.emplace_back(Output{.pin = pin});
    }
    bool is_negated(const Piece& element, std::string_view pin) const {
        for (const auto negated : element.node.children("Negated"))
            if (same_name(plain(negated, "Name"), pin)) return true;
        return false;
    }

    void run(const std::string& id) {
        Piece& element = elements_[id];
        if (element.state == Piece::State::done) return;
        if (element.state == Piece::State::runs)
            return tell(element, "the wires lead round in a circle", "use a variable");
        if (depth_ == deepest)
            return tell(element, "so many parts stand behind those that take from them", "");
        element.state = Piece::State::runs;
        ++depth_;
        execute(element);
        --depth_;
        element.state = Piece::State::done;
    }

    void execute(Piece& element) {
        const Mark place = place_of(element);
        const std::vector<Value> values = values_of(element, place);
        S7Instruction it{.name = name_of(element.part, is_negated(element, "operand")),
                         .types = types_of(element.node),
                         .formula = file_.plain(element.node.child("Equation")),
                         .place = place,
                         .has_eno = plain(element.node, "DisabledENO") != "true"};
        set_callee(element, it);
        const std::vector<std::string_view> pins = power_pins(element.part);
        Value power =
            is_unconditional(element.part) ? always(place) : words("FALSE", place, "BOOL");
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Input& input = element.inputs[i];
            if (std::ranges::any_of(pins, st::is_called(input.pin)))
                power = values[i];
            else
                it.pins.push_back({.name = input.pin, .value = values[i]});
        }
        add_outputs(element, it);
        const bool goes_on = std::ranges::any_of(element.outputs, [&](const Output& output) {
            return is_power(element.part, output.pin);
        });
        power = instructions_.run(now_, it, std::move(power), goes_on);
        for (Output& output : element.outputs)
            if (is_power(element.part, output.pin)) give(element, output, power, place);
    }

    /// What stands at inputs. Where one needs statements, those before it keep what they had.
    std::vector<Value> values_of(const Piece& element, const Mark& place) {
        std::vector<Value> values;
        for (const Input& input : element.inputs) {
            Excerpts before = std::exchange(now_, {});
            Value value = value_of(input, place);
            const Excerpts mine = std::exchange(now_, std::move(before));
            for (std::size_t i = 0; !mine.is_empty() && i < values.size(); ++i)
                if (find(element.inputs[i].from.element))
                    values[i] = instructions_.fixed(now_, std::move(values[i]), place);
            now_.append(mine);
            const bool is_operand = same_name(input.pin, "operand");
            values.push_back(input.is_negated && !is_operand ? negated(value, place) : value);
        }
        return values;
    }

    Value value_of(const Input& input, const Mark& place) {
        if (input.from.element.empty()) return always(place);
        if (const auto access = accesses_.find(input.from.element); access != accesses_.end()) {
            Value made{.text = access_.text_of(access->second), .form = Value::Form::atom};
            return made;
        }
        Piece* source = find(input.from.element);
        if (!source) return always(place);
        run(input.from.element);
        return output_of(*source, input.from.pin).value;
    }

    /// Power behind an element: to variables, and to others.
    void give(const Piece& element, Output& output, Value power, const Mark& place) {
        if (is_negated(element, output.pin)) power = negated(power, place);
        if (output.takers.size() + output.targets.size() > 1 || !is_taken_at_once(element, output))
            power = instructions_.fixed(now_, std::move(power), place);
        for (const std::string& target : output.targets) {
            now_.append(access_.text_of(accesses_[target]));
            now_.write(" := ", place);
            now_.append(power.text);
            now_.write(";\n", place);
        }
        output.value = std::move(power);
    }

    /// Nothing that does something stands between an element and the one that takes its output.
    bool is_taken_at_once(const Piece& element, const Output& output) const {
        if (output.takers.empty()) return true;
        const std::size_t taken = elements_.at(output.takers.front()).turn;
        for (std::size_t turn = element.turn + 1; turn < taken; ++turn)
            if (!is_pure(elements_.at(order_[turn]).part)) return false;
        return taken > element.turn;
    }

    /// What a box writes: to variables, or by one of its own to others.
    void add_outputs(Piece& element, S7Instruction& it) {
        for (Output& output : element.outputs) {
            if (is_power(element.part, output.pin)) continue;
            if (!output.takers.empty()) output.value = instructions_.result_of(it);
            if (!output.takers.empty()) it.pins.push_back({output.pin, output.value, true});
            for (const std::string& target : output.targets)
                it.pins.push_back({output.pin, {.text = access_.text_of(accesses_[target])}, true});
        }
    }

    void set_callee(const Piece& element, S7Instruction& it) const {
        const auto info = element.node.child("CallInfo");
        const auto instance = (info ? info : element.node).child("Instance");
        if (instance) it.callee.text = access_.reference(instance);
        if (info && !instance) it.callee.text = access_.quoted(info);
        if (info) it.name = it.callee.text.text();
    }

    /// `SrcType := Int`, as SIMATIC SD has it.
    std::string types_of(pugi::xml_node node) const {
        std::string made;
        for (const auto value : node.children("TemplateValue"))
            made += fmt::format("{} := {}, ", plain(value, "Name"), file_.plain(value));
        return made;
    }

    const XmlFile& file_;
    SimaticAccess access_;
    Diagnostics& out_;
    S7Instructions instructions_;
    int number_;
    std::map<std::string, pugi::xml_node> accesses_ = {};
    std::map<std::string, Piece> elements_ = {};
    std::vector<std::string> order_ = {};  ///< of elements, as they stand in the file
    Excerpts now_ = {};
    int depth_ = 0;
};

}  // namespace

Excerpts text_of_flag_net(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                          pugi::xml_node net, int network) {
    return FlagNet(file, out, variables, network).read(net);
}

}  // namespace lineshaft::projects
