#include "runtime/trace/report_setup.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/source/formula.hpp"

namespace lineshaft {

namespace {

using Json = nlohmann::ordered_json;

class ReportSetup {
  public:
    ReportSetup(const Connecting& to, const std::vector<TraceSetup>& traces,
                const ReportPlan& report)
        : to_(to), traces_(traces), report_(report) {}

    Json connect() const {
        Json made = Json::object();
        if (report_.plots)
            for (const Node& plot : report_.plots->items) made["plots"].push_back(drawn(plot));
        if (report_.own_axis) made["own_axis"] = drawn(*report_.own_axis);
        if (report_.hide) made["hide"] = drawn(*report_.hide);
        if (report_.curves)
            for (const auto& [name, formula] : report_.curves->entries) {
                check(formula);
                made["curves"][name.text] = formula.text;
            }
        if (report_.paths)
            for (const Node& pair : report_.paths->items) made["paths"].push_back(path(pair));
        if (report_.circle) made["circle"] = circle_of(*report_.circle);
        if (report_.band) made["band"] = band_of(*report_.band);
        if (report_.condition) made["while"] = recorded(*report_.condition);
        return made;
    }

  private:
    const Signal* find(std::string_view name) const {
        for (const TraceSetup& trace : traces_)
            if (const auto it = std::ranges::find(trace.signals, name, &Signal::name);
                it != trace.signals.end())
                return &*it;
        return nullptr;
    }

    /// The signal's name as it is declared.
    std::string recorded(const Node& node) const {
        const auto signal = to_.net.find(to_.read, node, node.text);
        if (!signal) return {};
        if (!find(signal->name))
            to_.read.fail(code::unknown_port, node,
                          fmt::format("no trace records '{}'", signal->name),
                          "add it to the signals of 'trace'");
        return signal->name;
    }

    /// Signals and curves.
    Json drawn(const Node& names) const {
        Json list = Json::array();
        for (const Node& node : names.items)
            list.push_back(report_.curves && report_.curves->find(node.text) ? node.text
                                                                             : recorded(node));
        return list;
    }

    Json path(const Node& pair) const {
        if (pair.items.size() == 2)
            return {{"x", recorded(pair.items[0])}, {"y", recorded(pair.items[1])}};
        to_.read.fail(code::entry_is_missing, pair, "a path takes two signals",
                      "write [x.position, y.position]: the second is drawn over the first");
        return {};
    }

    std::optional<Unit> unit_of_paths() const {
        if (!report_.paths || report_.paths->items[0].items.empty()) return {};
        const Signal* signal = find(report_.paths->items[0].items[0].text);
        return signal ? Unit::parse(signal->unit) : std::nullopt;
    }

    Json circle_of(const Node& node) const {
        constexpr std::array names{"x", "y", "radius"};
        if (node.items.size() != names.size()) {
            to_.read.fail(code::entry_is_missing, node, "a circle takes three numbers",
                          "they are x, y and radius");
            return {};
        }
        Json made;
        const auto unit = unit_of_paths();
        if (!unit) return {};
        for (std::size_t i = 0; i < names.size(); ++i) {
            const auto value = to_.read.real(node.items[i], *unit);
            if (!value) return {};
            made[names[i]] = *value;
        }
        if (made["radius"] <= 0.0)
            to_.read.fail(code::number_out_of_range, node.items[2],
                          fmt::format("the radius '{}' is not above 0", node.items[2].text));
        return made;
    }

    /// The table of a block whose rows describe a line; null: it has none.
    static const TableField* find_outline(const Instance& block) {
        if (!block.type) return nullptr;
        const auto it = std::ranges::find_if(
            block.type->tables, [](const TableField& table) { return table.outline != nullptr; });
        return it == block.type->tables.end() ? nullptr : &*it;
    }

    /// A table's line, and how far from it the band reaches.
    Json band_of(const Node& node) const {
        if (node.items.size() != 2) {
            to_.read.fail(code::entry_is_missing, node, "a band takes a table and a width",
                          "write [plate, 0.5 mm]: how far it reaches from the points of plate");
            return {};
        }
        const Node& name = node.items[0];
        const auto it = to_.net.instance_numbers.find(name.text);
        const Instance* block =
            it == to_.net.instance_numbers.end() ? nullptr : &to_.net.instance(it->second);
        const TableField* table = block ? find_outline(*block) : nullptr;
        const auto unit = unit_of_paths();
        if (!table) {
            to_.read.fail(code::unknown_block, name,
                          fmt::format("'{}' is no table of a path", name.text),
                          "name a path_table of the program");
            return {};
        }
        const auto within = unit ? to_.read.real(node.items[1], *unit) : std::nullopt;
        if (!within) return {};
        if (!(*within > 0))
            to_.read.fail(code::number_out_of_range, node.items[1],
                          fmt::format("the band '{}' is not above 0", node.items[1].text));
        const Unit& own = to_.net.unit_of(*block, table->columns[0].unit);
        Json points = Json::array();
        for (const auto& [x, y] : table->outline(block->image.data()))
            points.push_back({convert(x, own, *unit), convert(y, own, *unit)});
        return {{"table", block->name}, {"within", *within}, {"points", std::move(points)}};
    }

    void check(const Node& formula) const {
        const auto known = [this](std::string_view name) {
            return find(name) ? std::optional(1.0) : std::nullopt;
        };
        const FormulaResult result = evaluate(formula.text, known, "derivative");
        if (result.error.empty()) return;
        if (result.name.empty())
            return to_.read.fail(code::mistake_in_formula, formula, result.error);
        std::vector<std::string> names;
        for (const TraceSetup& trace : traces_)
            for (const Signal& signal : trace.signals) names.push_back(signal.name);
        to_.read.fail(code::mistake_in_formula, formula,
                      fmt::format("no trace records '{}'", result.name),
                      suggest(result.name, names));
    }

    const Connecting& to_;
    const std::vector<TraceSetup>& traces_;
    const ReportPlan& report_;
};

}  // namespace

nlohmann::ordered_json connect_report(const Connecting& to, const std::vector<TraceSetup>& traces) {
    const auto& report = to.program.report;
    return report ? ReportSetup(to, traces, *report).connect() : Json();
}

}  // namespace lineshaft
