#include "runtime/projects/drawings/function_charts.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/archive.hpp"
#include "runtime/projects/drawings/chart_items.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

class FunctionChart {
  public:
    FunctionChart(const XmlFile& file, Diagnostics& out, MadeVariables& variables, bool is_kept,
                  pugi::xml_node body)
        : archive_(file),
          file_(file),
          out_(out),
          variables_(variables),
          is_kept_(is_kept),
          properties_(Archive::root(body.parent().parent().child("ObjectProperties"))) {
        for (const pugi::xml_node node : members(Archive::root(body), "Items")) read(node);
        for (const auto& [to, from] : sources_)
            if (const auto it = outputs_.find(from); it != outputs_.end())
                ++items_[it->second.item].takers;
    }

    Excerpts statements() {
        std::vector<std::string> labels;
        for (const ChartItem& item : items_)
            if (item.kind == Item::label) labels.push_back(item.text);
        Jumps jumps(variables_, std::move(labels));
        jumps_ = &jumps;
        for (const std::size_t i : in_order()) evaluate(items_[i]);
        return jumps.finish(std::exchange(now_, {}));
    }

  private:
    /// Those of a list that is kept in an object of its own.
    static std::vector<pugi::xml_node> members(pugi::xml_node object, std::string_view name) {
        return Archive::items(Archive::member(Archive::member(object, name), "InnerList"));
    }

    void read(pugi::xml_node node) {
        const std::string_view kind = Archive::kind_of(node);
        if (kind == "CFCConnection") {
            sources_.emplace(archive_.text(node, "DestPinId"), archive_.text(node, "SourcePinId"));
            return;
        }
        const auto* known = std::ranges::find(items_by_name, kind, &NamedItem::name);
        ChartItem item{.node = node};
        if (known != std::end(items_by_name)) item.kind = known->kind;
        item.text = archive_.text(Archive::member(node, "Text"), "Text");
        item.stand_at(archive_.text(node, "Bounds"));
        add_pins(item);
        items_.push_back(std::move(item));
    }

    void add_pins(ChartItem& item) {
        const auto add = [&](std::vector<ChartPin>& pins, auto& places, pugi::xml_node node) {
            places[archive_.text(node, "Id")] = {items_.size(), pins.size(), &places == &inputs_};
            pins.push_back({.node = node, .is_negated = archive_.is_true(node, "Negated")});
        };
        for (const pugi::xml_node node : members(item.node, "Inputs"))
            add(item.inputs, inputs_, node);
        for (const pugi::xml_node node : members(item.node, "Outputs"))
            add(item.outputs, outputs_, node);
        if (const auto node = Archive::member(item.node, "Input"); !Archive::is_null(node))
            add(item.inputs, inputs_, node);
        if (const auto node = Archive::member(item.node, "Output"); !Archive::is_null(node))
            add(item.outputs, outputs_, node);
        name_pins(item);
    }

    /// Names of inputs, then of outputs, then what is called, and its instance.
    void name_pins(ChartItem& item) {
        std::vector<std::string> texts;
        for (const pugi::xml_node text : members(item.node, "Texts"))
            texts.push_back(archive_.text(text, "Text"));
        std::size_t next = 0;
        const auto take = [&] { return next < texts.size() ? texts[next++] : std::string(); };
        if (texts.empty()) return;
        for (ChartPin& pin : item.inputs) pin.name = take();
        if (item.kind != Item::composer)
            for (ChartPin& pin : item.outputs) pin.name = take();
        item.text = function_of(take());
        item.instance = take();
        item.call = archive_.text(item.node, "KindOfCall");
    }

    /// By the properties of the object, which stand behind its body.
    bool orders_itself() const {
        return archive_.text(properties_, "UseExplicitExecutionOrder") == "false";
    }

    std::vector<std::size_t> in_order() const {
        if (orders_itself())
            return order_by_data_flow(items_, [&](const ChartPin& pin) { return source_of(pin); });
        std::vector<std::size_t> order(items_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        return order;
    }

    std::optional<PinPlace> source_of(const ChartPin& pin) const {
        const auto source = sources_.find(archive_.text(pin.node, "Id"));
        if (source == sources_.end()) return {};
        if (const auto it = outputs_.find(source->second); it != outputs_.end()) return it->second;
        const auto through = inputs_.find(source->second);  // of what is VAR_IN_OUT
        return through == inputs_.end() ? std::optional<PinPlace>() : through->second;
    }

    Mark place_of(const ChartItem& item) const {
        Mark place = file_.mark_of_tag(item.node);
        const bool is_box = item.kind == Item::box;
        place.drawn = std::make_shared<const std::string>(
            fmt::format("{}{} at {}, {}", is_box ? "box " : "", item.text, item.x, item.y));
        return place;
    }

    void refuse(const ChartItem& item, std::string why, std::string help) {
        out_.add(code::not_supported, place_of(item), std::move(why), std::move(help));
    }

    void evaluate(ChartItem& item) {
        const Mark place = place_of(item);
        switch (item.kind) {
            case Item::input:
            case Item::selector:
            case Item::comment:
                return;
            case Item::output:
                return assign(item);
            case Item::box:
                return evaluate_box(item);
            case Item::composer:
                return compose(item);
            case Item::label:
                return jumps_->label(item.text, std::exchange(now_, {}), place);
            case Item::jump:
                return jumps_->leave(now_, item.text, condition_of(item), place, out_);
            case Item::return_:
                return jumps_->leave(now_, {}, condition_of(item), place, out_);
            case Item::other:
                return refuse(
                    item,
                    fmt::format("'{}' of a chart is not supported", Archive::kind_of(item.node)),
                    "convert the body to Structured Text in TwinCAT");
        }
    }

    Value condition_of(const ChartItem& item) {
        Value value;
        if (!item.inputs.empty()) value = value_of(item, item.inputs.front());
        return value.is_empty() ? always(place_of(item)) : value;
    }

    void assign(const ChartItem& item) {
        const Mark place = place_of(item);
        if (item.inputs.empty() || item.text.empty()) return;
        const ChartPin& pin = item.inputs.front();
        const Value value = value_of(item, pin);
        if (value.is_empty()) return;
        const std::string storage = archive_.text(pin.node, "SetReset");
        const bool is_reference = archive_.text(pin.node, "SetResetRef") == "Ref";
        const bool is_stored = storage == "Set" || storage == "Reset";
        if (is_stored) write_if(now_, value, place);
        now_.append(written(item).text);
        now_.write(is_reference ? " REF= " : " := ", place);
        if (is_stored)
            now_.write(storage == "Set" ? "TRUE" : "FALSE", place);
        else
            now_.append(value.text);
        now_.write(";\n", place);
        if (is_stored) write_end_if(now_, value, place);
    }

    /// What stands in an element, as it is written.
    Value written(const ChartItem& item) {
        const Mark place = place_of(item);
        if (item.text.empty() || item.text == "???") {
            refuse(item, "this element has no variable", "name one, or remove it");
            return words("FALSE", place, "BOOL");
        }
        if (st::same_name(item.text, "true")) return always(place);
        Value made{.text = {}, .form = shape_of(item.text)};
        made.text.draw(place.drawn);
        const std::vector<Part> parts =
            file_.texts(Archive::member(Archive::member(item.node, "Text"), "Text"));
        if (parts.size() == 1 && file_.text(parts.front()) == fmt::format("\"{}\"", item.text))
            file_.copy(made.text, {parts.front().begin + 1, parts.front().end - 1});
        else
            made.text.write(item.text, place);
        return made;
    }

    /// What leads to a pin; empty: nothing.
    Value value_of(const ChartItem& item, const ChartPin& pin) {
        const auto source = source_of(pin);
        if (!source) return {};
        const Mark place = place_of(item);
        if (is_too_deep(depth_, place, out_)) return words("FALSE", place, "BOOL");
        ++depth_;
        Value value = value_of(*source);
        --depth_;
        if (pin.is_negated && !value.is_empty()) value = negated(value, place);
        return within_length(std::move(value), place, out_);
    }

    Value value_of(const PinPlace& source) {
        ChartItem& item = items_[source.item];
        const std::size_t pin = source.pin;
        if (source.is_input) return value_of(item, item.inputs[pin]);
        Value value;
        if (item.kind == Item::input)
            value = written(item);
        else if (item.kind == Item::selector)
            value = item.inputs.empty() ? Value{}
                                        : member_of(value_of(item, item.inputs.front()), item, pin);
        else if (item.kind == Item::box || item.kind == Item::composer)
            value = value_of_box(item, pin);
        else
            refuse(item, "nothing comes out of this element", "connect another one");
        const bool is_negated = pin < item.outputs.size() && item.outputs[pin].is_negated;
        return is_negated && !value.is_empty() ? negated(value, place_of(item)) : value;
    }

    Value member_of(const Value& of, const ChartItem& item, std::size_t pin) const {
        Value made;
        if (of.is_empty()) return made;
        made.text.append(of.text);
        made.text.write("." + item.outputs[pin].name, place_of(item));
        return made;
    }

    /// What the box is a call of, or has its outputs of.
    static Value instance_of(const ChartItem& item, const Mark& place) {
        return words(item.instance.empty() ? item.text : item.instance, place);
    }
    Value called(const ChartItem& item) const {
        Value made = instance_of(item, place_of(item));
        if (item.is_of_instance())
            made.text.write(fmt::format(".{}", member_of_type(item.text)), place_of(item));
        return made;
    }

    /// A block's output; what a function gave when it was evaluated, or gives now.
    Value value_of_box(ChartItem& item, std::size_t pin) {
        const Mark place = place_of(item);
        if (item.has_eno() && pin == 0) return enabled_of(item);
        if (item.is_block()) return member_of(instance_of(item, place), item, pin);
        if (pin >= item.first_other()) return value_of_other(item, item.outputs[pin]);
        if (item.value) return *item.value;
        const std::string type = type_in_loop(item);
        if (!item.loop.empty()) return words(item.loop, place, type);
        if (type.empty() || !is_kept_) {
            refuse(item,
                   type.empty() ? "what comes out of this is taken before it is evaluated, and "
                                  "its type is not known"
                                : "what comes out of this is taken before it is evaluated, and a "
                                  "function keeps no value of the last scan",
                   "connect it to a variable, and take its value from there");
            return words("FALSE", place, "BOOL");
        }
        item.loop = variables_.make("_wire", type);
        return words(item.loop, place, type);
    }

    /// What a METHOD gives beside its result is in a variable of the type of what takes it.
    Value value_of_other(ChartItem& item, ChartPin& output) {
        const Mark place = place_of(item);
        const std::string type = type_of_takers(output);
        if (item.is_of_instance() && is_kept_ && !type.empty()) {
            if (output.wire.empty()) output.wire = variables_.make("_wire", type);
            return words(output.wire, place, type);
        }
        refuse(item,
               item.is_of_instance()
                   ? fmt::format("the type of '{}' is not known here", output.name)
                   : "an output of a function beside its result is not supported in a chart",
               item.is_of_instance() ? "connect it to variables that the block declares"
                                     : "call it in Structured Text");
        return words("FALSE", place, "BOOL");
    }

    /// The type of the variables that an output leads to. Empty: something else takes it, or they
    /// differ.
    std::string type_of_takers(const ChartPin& output) const {
        std::string type;
        for (const auto& [to, from] : sources_) {
            if (from != archive_.text(output.node, "Id")) continue;
            const auto pin = inputs_.find(to);
            const bool is_variable =
                pin != inputs_.end() && items_[pin->second.item].kind == Item::output;
            const std::string one =
                is_variable ? declared_type(items_[pin->second.item]) : std::string();
            if (one.empty() || (!type.empty() && !st::same_name(type, one))) return {};
            type = one;
        }
        return type;
    }

    std::string declared_type(const ChartItem& variable) const {
        return upper(variables_.known_type("#" + variable.text));
    }

    /// A METHOD's result has the type of what takes it.
    std::string type_of(const ChartItem& item) const {
        const std::size_t result = item.has_eno() ? 1 : 0;
        const bool is_method = item.is_of_instance() && result < item.outputs.size();
        return is_method ? type_of_takers(item.outputs[result]) : item.type();
    }

    /// What goes back has a type by what leads to it, too: bits are truths, unless a declaration
    /// says that they are otherwise.
    std::string type_in_loop(const ChartItem& item) const {
        constexpr std::string_view of_bits[] = {"and", "or", "xor", "not"};
        std::string type = type_of(item);
        if (!type.empty() || std::ranges::find(of_bits, lower(item.text)) == std::end(of_bits))
            return type;
        for (const ChartPin& pin : item.inputs) {
            const auto source = source_of(pin);
            if (source && !source->is_input && type.empty())
                type = declared_type(items_[source->item]);
        }
        return type.empty() ? "BOOL" : type;
    }

    Value enabled_of(const ChartItem& item) {
        if (item.inputs.empty() || !st::same_name(item.inputs[0].name, "en")) return {};
        const Value value = value_of(item, item.inputs.front());
        return value.is_empty() ? always(place_of(item)) : value;
    }

    BoxCall call_of(const ChartItem& item) {
        BoxCall call{.type = item.text, .place = place_of(item)};
        for (const ChartPin& pin : item.inputs) {
            if (st::same_name(pin.name, "en")) continue;
            call.inputs.push_back(value_of(item, pin));
            call.names.push_back(pin.name);
        }
        return call;
    }

    std::vector<std::pair<std::string, Excerpts>> outputs_of(ChartItem& item) {
        std::vector<std::pair<std::string, Excerpts>> made;
        for (std::size_t i = item.first_other(); i < item.outputs.size() && !item.is_block(); ++i)
            if (is_taken(item.outputs[i]))
                made.emplace_back(item.outputs[i].name, value_of_other(item, item.outputs[i]).text);
        return made;
    }

    bool is_taken(const ChartPin& output) const {
        return std::ranges::any_of(sources_, [&](const auto& way) {
            return way.second == archive_.text(output.node, "Id");
        });
    }

    void evaluate_box(ChartItem& item) {
        const BoxCall call = call_of(item);
        const Value enabled = enabled_of(item);
        Value made{.text = {}, .type = item.type()};
        if (is_operator(item.text)) {
            made = result_of_operator(call);
            if (made.is_empty()) return refuse_open(item);
        } else {
            made.text.append(called(item).text);
            made.text.append(arguments_of(call, outputs_of(item)));
        }
        const std::size_t result = item.has_eno() ? 1 : 0;
        const bool has_result = !item.is_block() && item.has_result();
        if (has_result && result < item.outputs.size() && is_taken(item.outputs[result])) {
            if (made.type.empty() || !item.loop.empty()) made.type = type_of(item, made);
            return keep(item, std::move(made), enabled);
        }
        if (is_operator(item.text)) return;
        write_if(now_, enabled, call.place);
        now_.append(made.text);
        now_.write(";\n", call.place);
        write_end_if(now_, enabled, call.place);
    }

    /// Where it is needed for what is made of the value of the last scan, too.
    std::string type_of(const ChartItem& item, const Value& made) const {
        return item.loop.empty() && !takes_last_scan(made) ? type_of(item) : type_in_loop(item);
    }

    /// It has to be kept in its turn.
    bool takes_last_scan(const Value& value) const {
        return std::ranges::any_of(items_, [&](const ChartItem& item) {
            const bool is_due = !item.loop.empty() && !item.value;
            return is_due && value.text.text().find(item.loop) != std::string_view::npos;
        });
    }

    void refuse_open(ChartItem& item) {
        refuse(item, "nothing leads to an input of this box", "connect it");
        item.value = words("FALSE", place_of(item), "BOOL");
    }

    /// Its result goes into a variable, where its type is known, or is written where it is taken.
    void keep(ChartItem& item, Value value, const Value& enabled) {
        const Mark place = place_of(item);
        const bool is_guarded = !enabled.is_empty() && !enabled.is_always;
        const bool is_a_type =
            is_type_name(value.type) || (item.is_of_instance() && !value.type.empty());
        const bool is_late = item.is_of_instance() || !item.loop.empty() || takes_last_scan(value);
        if (!is_a_type && is_guarded)
            return refuse(item, "the type of what comes out of this box is not known",
                          "connect it to a variable, and take its value from there");
        if (!is_a_type || (item.takers == 1 && !is_guarded && !is_late)) {
            item.value = std::move(value);
            return;
        }
        const std::string name =
            item.loop.empty() ? variables_.make("_wire", value.type) : item.loop;
        write_if(now_, enabled, place);
        item.value = kept_in(now_, name, value, place);
        write_end_if(now_, enabled, place);
    }

    /// A structure of what leads to it.
    void compose(ChartItem& item) {
        const Mark place = place_of(item);
        const std::string name = variables_.make("_wire", item.text);
        for (const ChartPin& pin : item.inputs)
            if (const Value value = value_of(item, pin); !value.is_empty())
                kept_in(now_, fmt::format("{}.{}", name, pin.name), value, place);
        item.value = words(name, place, item.text);
    }

    Archive archive_;
    const XmlFile& file_;
    Diagnostics& out_;
    MadeVariables& variables_;
    bool is_kept_;
    pugi::xml_node properties_;
    Jumps* jumps_ = nullptr;
    std::vector<ChartItem> items_;
    std::map<std::string, PinPlace, std::less<>> inputs_, outputs_;  ///< pins by their numbers
    std::map<std::string, std::string, std::less<>> sources_;  ///< of pins that take something
    Excerpts now_;  ///< statements since the last label or jump
    int depth_ = 0;
};

}  // namespace

Excerpts text_of_function_chart(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                                bool is_kept, pugi::xml_node body) {
    if (Archive::is_null(Archive::root(body)))
        out.add(code::not_supported, file.mark_of_tag(body),
                "this chart is not as TwinCAT keeps one",
                "save it anew in TwinCAT, or leave it out");
    return FunctionChart(file, out, variables, is_kept, body).statements();
}

}  // namespace lineshaft::projects
