#include "runtime/st/code/native/kept.hpp"

#include <algorithm>
#include <optional>

#include "runtime/st/code/native/flow.hpp"

namespace lineshaft::st {

#ifdef LINESHAFT_NATIVE

namespace {

constexpr std::uint8_t first_late = 8, words_end = 12, reals_end = 16;

/// Two instructions that the end of a WHILE that counts is.
std::optional<std::array<Op, 2>> halves_of(Op op) {
    switch (op) {
        case Op::count_lt_int:
            return {{Op::add_int, Op::repeat_if_lt_signed}};
        case Op::count_le_int:
            return {{Op::add_int, Op::repeat_if_le_signed}};
        case Op::count_lt_dint:
            return {{Op::add_dint, Op::repeat_if_lt_signed}};
        case Op::count_le_dint:
            return {{Op::add_dint, Op::repeat_if_le_signed}};
        case Op::count_lt_lint:
            return {{Op::add_lint, Op::repeat_if_lt_signed}};
        case Op::count_le_lint:
            return {{Op::add_lint, Op::repeat_if_le_signed}};
        default:
            return {};
    }
}

class Keeping {
  public:
    explicit Keeping(const Code& code) : code_(code), flow_(flow_of(code)) {}

    std::vector<StencilCopy> parts() {
        for (std::uint32_t i = 0; i < code_.instructions.size(); ++i) add(i);
        for (const Loop& loop : flow_.loops) keep_in(loop);
        for (std::size_t i = 1; i < parts_.size(); ++i) leave_out_load(i);
        return std::move(parts_);
    }

  private:
    /// What a loop does with a slot.
    struct Use {
        std::uint32_t slot = 0;
        bool is_word_read = false, is_real_read = false;
        bool is_lost = false;               ///< written where no register has it
        std::uint8_t result = no_register;  ///< that has it where it is written

        bool is_real() const { return result >= first_real; }
        bool is_kept() const {
            return !is_lost && result != no_register && (is_real() ? is_real_read : is_word_read);
        }
    };

    void add(std::uint32_t number) {
        firsts_.push_back(static_cast<std::uint32_t>(parts_.size()));
        const Instruction& in = code_.instructions[number];
        if (const auto halves = halves_of(in.op)) {
            append({.op = (*halves)[0], .a = in.a, .b = in.a, .c = in.b}, number);
            append({.op = (*halves)[1], .a = in.a, .b = in.d, .c = in.c}, number);
        } else {
            append(in, number);
        }
    }

    void append(const Instruction& in, std::uint32_t number) {
        StencilCopy& part = parts_.emplace_back();
        part.in = in;
        part.number = number;
    }

    static bool repeats(const StencilCopy& part) {
        return std::ranges::count(part.fillings(), Hole::repeat_target, &Filling::hole) > 0;
    }

    std::span<StencilCopy> parts_in(const Loop& loop) {
        const auto end = loop.last + 1 < firsts_.size() ? firsts_[loop.last + 1] : parts_.size();
        return std::span(parts_).subspan(firsts_[loop.first], end - firsts_[loop.first]);
    }

    void keep_in(const Loop& all) {
        const std::span<StencilCopy> loop = parts_in(all);
        uses_.clear();
        std::uint8_t spoiled = 0;
        for (const StencilCopy& part : loop) {
            spoiled |= part.stencil().spoils;
            if (spoiled == 0xFF) return;
            note_uses(part);
        }
        std::vector<KeptSlot> kept;
        std::uint8_t word = first_late, real = first_late;
        for (const Use& use : uses_) {
            if (!use.is_kept()) continue;
            std::uint8_t& next = use.is_real() ? real : word;
            const std::uint8_t end = use.is_real() ? reals_end : words_end;
            while (next < end && spoiled >> (next - first_late) & 1) ++next;
            if (next == end) continue;
            kept.push_back(
                {use.slot, static_cast<std::uint8_t>(next++ + (use.is_real() ? first_real : 0))});
        }
        std::uint32_t bytes = 0;
        for (const KeptSlot& one : kept) bytes += load_size(one.in);
        for (StencilCopy& part : loop) {
            keep(part, kept);
            if (repeats(part) && code_.place_of(part.in.c) == all.first) part.skipped = bytes;
        }
        loop.front().loads = std::move(kept);
    }

    Use& use_of(std::uint32_t slot) {
        const auto it = std::ranges::find(uses_, slot, &Use::slot);
        return it != uses_.end() ? *it : uses_.emplace_back(Use{slot});
    }

    void note_uses(const StencilCopy& part) {
        const std::string_view operands = info(part.in.op).operands;
        for (const Filling& filling : part.fillings()) {
            if (filling.read_as == ReadAs::memory) continue;
            Use& use = use_of(part.slot(filling.hole));
            (filling.read_as == ReadAs::real ? use.is_real_read : use.is_word_read) = true;
        }
        for (std::size_t i = 0; i < operands.size(); ++i) {
            if (operands[i] != 'w') continue;
            Use& use = use_of(part.slot(static_cast<Hole>(i)));
            const std::uint8_t result = part.stencil().result;
            const bool is_result = part.has_result() && operands[0] == 'w' &&
                                   part.stencil().written == Hole(i) &&
                                   std::ranges::count(operands, 'w') == 1;
            const bool is_same_kind =
                use.result == no_register || (use.result < first_real) == (result < first_real);
            use.is_lost |= !is_result || !is_same_kind;
            use.result = result;
        }
    }

    static void keep(StencilCopy& part, std::span<const KeptSlot> kept) {
        const std::string_view operands = info(part.in.op).operands;
        for (const KeptSlot& one : kept) {
            for (std::size_t i = 0; i < operands.size(); ++i)
                if ((operands[i] == 'w' || operands[i] == 'r') &&
                    part.slot(static_cast<Hole>(i)) == one.slot)
                    part.sources[i] = one.in;
            if (part.has_result() && operands[0] == 'w' && part.result_slot() == one.slot)
                part.into = one.in;
        }
    }

    /// What the part before has left in a register need not be loaded.
    void leave_out_load(std::size_t at) {
        StencilCopy& part = parts_[at];
        const StencilCopy& before = parts_[at - 1];
        const bool is_gone_to = before.number != part.number && flow_.labels[part.number];
        const std::string_view operands = info(before.in.op).operands;
        if (is_gone_to || operands[0] != 'w' || !before.has_result() ||
            part.stencil().into != before.stencil().result)
            return;
        const Filling& load = part.fillings().front();
        part.leaves_out_load =
            load.at + 4 == part.stencil().load && part.slot(load.hole) == before.result_slot();
    }

    const Code& code_;
    std::vector<StencilCopy> parts_;
    std::vector<std::uint32_t> firsts_;  ///< parts, by instruction
    Flow flow_;
    std::vector<Use> uses_;
};

}  // namespace

std::vector<StencilCopy> parts_of(const Code& code) {
    return Keeping(code).parts();
}

#endif

}  // namespace lineshaft::st
