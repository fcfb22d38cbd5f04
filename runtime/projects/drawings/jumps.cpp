#include "runtime/projects/drawings/jumps.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/networks.hpp"
#include "runtime/projects/drawings/values.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

std::size_t Jumps::number_of(std::string_view label) const {
    const auto it = std::ranges::find_if(
        labels_, [&](const std::string& known) { return st::same_name(known, label); });
    return it == labels_.end() ? 0 : static_cast<std::size_t>(it - labels_.begin()) + 1;
}

std::string Jumps::leaving(std::string_view label) {
    if (jump_.empty()) jump_ = variables_.make("_jump", "INT");
    return fmt::format("{} := {};", jump_, number_of(label));
}

void Jumps::label(std::string name, Excerpts before, const Mark& place) {
    stretches_.push_back({.statements = std::move(before)});
    stretches_.push_back({.label = std::move(name), .place = place});
}

void Jumps::jump(std::string target, Excerpts before, const Mark& place) {
    stretches_.push_back({.statements = std::move(before)});
    stretches_.push_back({.target = std::move(target), .place = place});
}

/// What is jumped over is what stands between a jump, which leaves the number of its label, and
/// that label, which takes it away. One that goes back has the whole body repeated.
void Jumps::leave(Excerpts& now, const std::optional<std::string>& label, const Value& when,
                  const Mark& place, Diagnostics& out) {
    if (label && number_of(*label) == 0)
        return out.add(code::not_declared, place,
                       fmt::format("there is no label '{}' in this body", *label));
    write_if(now, when, place);
    now.write(label ? leaving(*label) + "\n" : "RETURN;\n", place);
    write_end_if(now, when, place);
    if (label) jump(*label, std::exchange(now, {}), place);
}

Excerpts Jumps::finish(Excerpts rest) {
    stretches_.push_back({.statements = std::move(rest)});
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
                                   number_of(stretch.label)),
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
