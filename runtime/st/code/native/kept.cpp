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

void add_parts(const Code& code, std::uint32_t number, std::vector<StencilCopy>& to) {
    const Instruction& in = code.instructions[number];
    const auto add = [&](const Instruction& part) {
        to.emplace_back();
        to.back().in = part;
        to.back().number = number;
    };
    if (const auto halves = halves_of(in.op)) {
        add({.op = (*halves)[0], .a = in.a, .b = in.a, .c = in.b});
        add({.op = (*halves)[1], .a = in.a, .b = in.d, .c = in.c});
    } else {
        add(in);
    }
}

/// What the part before has left in a register need not be loaded.
bool leaves_out_load(const StencilCopy& before, const StencilCopy& part) {
    const std::string_view operands = info(before.in.op).operands;
    if (operands[0] != 'w' || !before.has_result() ||
        part.stencil().into != before.stencil().result)
        return false;
    const Filling& load = part.fillings().front();
    return load.at + 4 == part.stencil().load && part.slot(load.hole) == before.result_slot();
}

/// What a loop has in registers.
class Keeping {
  public:
    Keeping(const Code& code, const Loop& loop) : code_(code), first_(loop.first) {
        for (std::uint32_t i = loop.first; i <= loop.last; ++i) add_parts(code, i, parts_);
    }

    /// Its parts; none where nothing is kept.
    std::vector<StencilCopy> parts() {
        if (!keep()) parts_.clear();
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

    static bool repeats(const StencilCopy& part) {
        return std::ranges::count(part.fillings(), Hole::repeat_target, &Filling::hole) > 0;
    }

    bool keep() {
        std::uint8_t spoiled = 0;
        for (const StencilCopy& part : parts_) {
            spoiled |= part.stencil().spoils;
            if (spoiled == 0xFF) return false;
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
        for (StencilCopy& part : parts_) {
            keep(part, kept);
            if (repeats(part) && code_.place_of(part.in.c) == first_) part.skipped = bytes;
        }
        parts_.front().loads = std::move(kept);
        return true;
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

    const Code& code_;
    std::uint32_t first_;
    std::vector<StencilCopy> parts_;
    std::vector<Use> uses_;
};

}  // namespace

StencilCopies::StencilCopies(const Code& code) : code_(code) {
    Flow flow = flow_of(code);
    labels_ = std::move(flow.labels);
    for (const Loop& loop : flow.loops)
        if (auto parts = Keeping(code, loop).parts(); !parts.empty())
            loops_.emplace(loop.first, std::move(parts));
}

void StencilCopies::each(const std::function<void(const StencilCopy&)>& with) const {
    std::optional<StencilCopy> before;
    std::vector<StencilCopy> parts;
    for (std::uint32_t i = 0; i < code_.instructions.size(); i = before->number + 1) {
        const auto loop = loops_.find(i);
        parts.clear();
        if (loop == loops_.end())
            add_parts(code_, i, parts);
        else
            parts = loop->second;
        for (StencilCopy& part : parts) {
            const bool is_gone_to = before && before->number != part.number && labels_[part.number];
            part.leaves_out_load = before && !is_gone_to && leaves_out_load(*before, part);
            with(part);
            before = std::move(part);
        }
    }
}

#endif

}  // namespace lineshaft::st
