#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/networks.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

/// A jump or a return, if what leads there is TRUE.
void NetworkText::leave(const Element& element) {
    const Mark place = place_of(element);
    Value when;
    if (!element.inputs.empty()) when = value_of(element, element.inputs.front());
    const bool is_always = when.is_empty() || when.is_always;
    std::string what = "RETURN;";
    const bool is_jump = element.kind == Drawn::jump;
    const std::string target = attribute(element, "label");
    if (is_jump) {
        if (jump_.empty()) jump_ = context_.variables.make("_jump", "INT");
        const std::size_t number = number_of_label(target);
        if (number == 0)
            return context_.out.add(code::not_declared, place,
                                    fmt::format("there is no label '{}' in this body", target));
        what = fmt::format("{} := {};", jump_, number);
    }
    if (!is_always) {
        now_.write("IF ", place);
        now_.append(when.text);
        now_.write(" THEN ", place);
    }
    now_.write(what + (is_always ? "\n" : " END_IF\n"), place);
    if (!is_jump) return;
    end_stretch({}, place);
    stretches_.back().target = target;
}

/// From 1 on; 0: there is none.
std::size_t NetworkText::number_of_label(std::string_view name) const {
    std::size_t number = 0;
    for (const Element& element : drawing_.elements) {
        if (element.kind != Drawn::label) continue;
        ++number;
        if (st::same_name(attribute(element, "label"), name)) return number;
    }
    return 0;
}

/// What was written goes before a label, or before where a jump has gone.
void NetworkText::end_stretch(std::string label, const Mark& place) {
    stretches_.push_back({.statements = std::exchange(now_, {})});
    stretches_.push_back({.label = std::move(label), .place = place});
}

/// What is jumped over is what stands between a jump, which leaves the number of its label, and
/// that label, which takes it away. One that goes back has the whole body repeated.
Excerpts NetworkText::with_jumps() {
    stretches_.push_back({.statements = std::exchange(now_, {})});
    Excerpts made;
    const auto is_jump = [](const Stretch& stretch) { return !stretch.target.empty(); };
    const auto first = std::ranges::find_if(stretches_, is_jump);
    const Mark place = first == stretches_.end() ? Mark{} : first->place;
    bool goes_back = false;
    for (auto label = stretches_.begin(); label != stretches_.end(); ++label)
        goes_back = goes_back || (!label->label.empty() &&
                                  std::any_of(label, stretches_.end(), [&](const Stretch& jump) {
                                      return st::same_name(jump.target, label->label);
                                  }));
    if (first != stretches_.end()) made.write(jump_ + " := 0;\n", place);
    if (goes_back) made.write("REPEAT\n", place);
    bool is_behind_jump = goes_back;
    for (Stretch& stretch : stretches_) {
        is_behind_jump = is_behind_jump || is_jump(stretch);
        const bool is_aim = std::ranges::any_of(stretches_, [&](const Stretch& jump) {
            return !stretch.label.empty() && st::same_name(jump.target, stretch.label);
        });
        if (is_aim)
            made.write(fmt::format("IF {0} = {1} THEN {0} := 0; END_IF\n", jump_,
                                   number_of_label(stretch.label)),
                       stretch.place);
        if (stretch.statements.is_empty()) continue;
        if (is_behind_jump) made.write(fmt::format("IF {} = 0 THEN\n", jump_), place);
        made.append(stretch.statements);
        if (is_behind_jump) made.write("END_IF\n", place);
    }
    if (goes_back) made.write(fmt::format("UNTIL {} = 0 END_REPEAT;\n", jump_), place);
    return made;
}

}  // namespace lineshaft::projects
