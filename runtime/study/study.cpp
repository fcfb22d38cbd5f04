#include "runtime/study/study.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace lineshaft {

namespace {

void replace(std::vector<Setting>& settings, Setting setting) {
    std::erase_if(settings, [&](const Setting& old) { return old.name == setting.name; });
    settings.push_back(std::move(setting));
}

/// Adds the settings of a combination of the grid, counted with the last axis fastest.
void choose(const std::vector<GridAxis>& grid, std::int64_t combination,
            std::vector<Setting>& settings) {
    std::vector<const Setting*> chosen(grid.size());
    for (std::size_t i = grid.size(); i-- > 0;) {
        const auto count = static_cast<std::int64_t>(grid[i].values.size());
        chosen[i] = &grid[i].values[static_cast<std::size_t>(combination % count)];
        combination /= count;
    }
    for (const Setting* setting : chosen) replace(settings, *setting);
}

}  // namespace

bool Bounds::hold(double value) const {
    if (!judged()) return true;
    if (at_least && !(value >= *at_least)) return false;
    if (at_most && !(value <= *at_most)) return false;
    return within.empty() || std::ranges::any_of(within, [&](double distance) {
               return std::abs(value - *paper) <= distance;
           });
}

std::string Comparison::name() const {
    return statistic == Statistic::mean ? signal : signal + ".spread";
}

std::string describe(const StudyCase& c) {
    if (!c.name.empty()) return c.name;
    std::string text;
    for (const Setting& s : c.settings)
        text += fmt::format("{}{}={}", text.empty() ? "" : ", ", s.name, s.value);
    return text;
}

std::string file_stem(const StudyCase& c, std::int64_t cases) {
    if (!c.name.empty()) return c.name;
    constexpr std::size_t most = 120;
    std::string text = fmt::format("{:0{}}", c.number, fmt::format("{}", cases).size());
    for (const Setting& s : c.settings) text += fmt::format("_{}={}", s.name, s.value);
    std::ranges::replace_if(
        text,
        [](char letter) {
            constexpr std::string_view kept = "_=.-+";
            return std::isalnum(static_cast<unsigned char>(letter)) == 0 &&
                   kept.find(letter) == std::string_view::npos;
        },
        '_');
    return text.substr(0, most);
}

std::int64_t Study::case_count() const {
    return groups.empty() ? 0 : groups.back().first + groups.back().count;
}

StudyCase Study::make_case(std::int64_t index) const {
    const auto after = std::ranges::upper_bound(groups, index, {}, &CaseGroup::first);
    const CaseGroup& group = *std::prev(after);
    StudyCase made{.number = index + 1,
                   .name = group.name,
                   .settings = group.settings,
                   .comparisons = group.comparisons,
                   .repeat = group.repeat};
    const std::int64_t at = index - group.first;
    choose(group.grid, at / group.draws, made.settings);
    for (const RandomParameter& p : group.random)
        replace(made.settings, {p.name, draw(p, group.seed, at % group.draws), group.mark, p.mark});
    return made;
}

}  // namespace lineshaft
