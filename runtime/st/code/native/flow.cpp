#include "runtime/st/code/native/flow.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace lineshaft::st {

namespace {

constexpr std::uint32_t longest_loop = 64;

/// It changes no slot but those of its operands.
bool writes_only_operands(Op op) {
    const std::string_view operands = info(op).operands;
    return info(op).cost != OpClass::call &&
           (operands[0] == 'w' || operands[0] == '-' || operands[2] == 'j' || operands[2] == 'w');
}

/// From where an instruction is gone to.
struct Origins {
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), last = 0;

    bool are_there() const { return first <= last; }
};

class Ways {
  public:
    explicit Ways(const Code& code) : code_(code), origins_(code.instructions.size() + 1) {
        for (const CodeRoutine& routine : code.routines) add(routine.entry, routine.entry);
        for (std::uint32_t i = 0; i < code.instructions.size(); ++i) add_ways(i);
    }

    Flow flow() const {
        Flow flow;
        for (const Origins& origins : origins_) flow.labels.push_back(origins.are_there());
        for (const auto& [first, last] : ends_)
            if (last - first < longest_loop && is_closed(first, last))
                flow.loops.push_back({first, last});
        return flow;
    }

  private:
    void add(std::uint32_t from, std::uint64_t to) {
        origins_[to].first = std::min(origins_[to].first, from);
        origins_[to].last = std::max(origins_[to].last, from);
    }

    void add_ways(std::uint32_t number) {
        const Instruction& in = code_.instructions[number];
        if (info(in.op).operands[2] == 'j') {
            const std::uint64_t to = code_.place_of(in.c);
            add(number, to);
            if (to <= number) ends_[static_cast<std::uint32_t>(to)] = number;
        }
        if (in.op == Op::choose) {
            const IndexTable& table = code_.tables[in.c];
            for (std::uint64_t i = 0; i < table.count; ++i)
                add(number, code_.place_of(static_cast<std::uint64_t>(
                                code_.numbers[table.first + i * table.stride])));
        }
        if (info(in.op).cost == OpClass::call) add(number, number + 1);  // where it comes back
    }

    bool is_closed(std::uint32_t first, std::uint32_t last) const {
        const auto next = ends_.upper_bound(first);
        if (next != ends_.end() && next->first <= last) return false;
        for (std::uint32_t i = first; i <= last; ++i) {
            const Origins& origins = origins_[i];
            const bool is_entered =
                i > first && origins.are_there() && (origins.first < first || origins.last > last);
            if (is_entered || !writes_only_operands(code_.instructions[i].op)) return false;
        }
        return true;
    }

    const Code& code_;
    std::vector<Origins> origins_;                 ///< by instruction
    std::map<std::uint32_t, std::uint32_t> ends_;  ///< of loops, by their first instruction
};

}  // namespace

Flow flow_of(const Code& code) {
    return Ways(code).flow();
}

}  // namespace lineshaft::st
