#include "runtime/projects/drawings/chart_items.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <numeric>
#include <utility>

#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

/// Elements that connections join have one number.
std::vector<std::size_t> networks(const std::vector<ChartItem>& items,
                                  const SourceOfPin& source_of) {
    std::vector<std::size_t> root(items.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto root_of = [&](std::size_t i) {
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (std::size_t i = 0; i < items.size(); ++i)
        for (const ChartPin& pin : items[i].inputs)
            if (const auto source = source_of(pin)) root[root_of(i)] = root_of(source->item);
    for (std::size_t i = 0; i < items.size(); ++i) root[i] = root_of(i);
    return root;
}

}  // namespace

std::vector<std::size_t> order_by_data_flow(const std::vector<ChartItem>& items,
                                            const SourceOfPin& source_of) {
    const std::vector<std::size_t> network = networks(items, source_of);
    std::vector<std::size_t> all(items.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    std::map<std::size_t, std::pair<int, int>> top;
    for (const std::size_t i : all) {
        const std::pair<int, int> at{items[i].y, items[i].x};
        const auto it = top.emplace(network[i], at).first;
        it->second = std::min(it->second, at);
    }
    std::ranges::stable_sort(all, {}, [&](std::size_t i) {
        return std::make_tuple(top[network[i]], network[i], items[i].y, items[i].x);
    });
    std::vector<std::size_t> order;
    std::vector<bool> is_seen(items.size());
    for (const std::size_t first : all) {
        std::vector<std::pair<std::size_t, std::size_t>> way;
        if (!is_seen[first]) way.emplace_back(first, 0);
        is_seen[first] = true;
        while (!way.empty()) {
            auto& [item, pin] = way.back();
            if (pin == items[item].inputs.size()) {
                order.push_back(item);
                way.pop_back();
                continue;
            }
            const auto source = source_of(items[item].inputs[pin++]);
            if (!source || is_seen[source->item]) continue;
            is_seen[source->item] = true;
            way.emplace_back(source->item, 0);
        }
    }
    return order;
}

bool ChartItem::has_result() const {
    const std::size_t at = has_eno() ? 1 : 0;
    return !is_of_instance() || (at < outputs.size() && names_result(outputs[at].name, text));
}

std::string ChartItem::type() const {
    if (kind == Item::composer) return text;
    if (compares(text)) return "BOOL";
    const std::string name = lower(text);
    const std::size_t to = name.starts_with("to_") ? 0 : name.find("_to_");
    return to == name.npos ? std::string() : text.substr(to + (to == 0 ? 3 : 4));
}

void ChartItem::stand_at(const std::string& bounds) {
    const char* const end = bounds.data() + bounds.size();
    const char* const behind_x = std::from_chars(bounds.data(), end, x).ptr;
    if (end - behind_x > 2) std::from_chars(behind_x + 2, end, y);
}

}  // namespace lineshaft::projects
