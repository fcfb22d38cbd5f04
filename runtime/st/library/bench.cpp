#include "runtime/st/library/bench.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "runtime/st/library/failed_assertion.hpp"

namespace lineshaft::st {

Bench::Bench(const Compiled& made, const Options& options, const Type& unit, Told told,
             std::span<const KeptReference> kept)
    : made_(made),
      options_(options),
      told_(std::move(told)),
      memory_(made.generated.images.at(&unit)) {
    const std::vector<std::size_t> begins = lay_out(unit, kept);
    unit_ = reinterpret_cast<std::byte*>(memory_.data());
    for (const std::size_t begin : begins) places_.push_back(unit_ + begin);
    add_types(unit, kept);
    context_ = {.instances = places_.data(),
                .seen = places_.data(),
                .types = types_.data(),
                .memory = unit_,
                .task = 0,
                .blocks = static_cast<int>(types_.size()),
                .published = &never};
    const std::size_t globals = made.checked.globals.size();
    for (std::size_t i = 0; i < globals; ++i)
        if (const Variable* object = made.checked.globals[i].object)
            objects_.emplace_back(object->type->standard, places_[i]);
    for (const Variable& variable : made.checked.variables)
        if (const std::int64_t named = variable.named; named >= 0)
            std::memcpy(
                global(static_cast<std::size_t>(variable.global)) + 8 * std::size_t{variable.slot},
                &named, sizeof named);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const std::int64_t number = std::ssize(made.checked.globals) + static_cast<int>(i);
        std::byte* const owner =
            kept[i].global < 0 ? unit_ : global(static_cast<std::size_t>(kept[i].global));
        std::memcpy(owner + kept[i].offset, &number, sizeof number);
        kept[i].to->construct(places_[globals + i]);
        objects_.emplace_back(kept[i].to, places_[globals + i]);
    }
}

/// As a machine has them, for blocks that look what a number names. The unit is the last one.
void Bench::add_types(const Type& unit, std::span<const KeptReference> kept) {
    const auto& globals = made_.checked.globals;
    sizes_.resize(globals.size() + 1);
    for (std::size_t i = 0; i < globals.size(); ++i) {
        const Type& type = *globals[i].type;
        sizes_[i].size = 8 * made_.generated.images.at(&type).size();
        types_.push_back(type.kind == Type::Kind::standard ? type.standard : &sizes_[i]);
    }
    for (const KeptReference& reference : kept) types_.push_back(reference.to);
    sizes_.back().size = 8 * made_.generated.images.at(&unit).size();
    types_.push_back(&sizes_.back());
    places_.push_back(unit_);
}

/// Where each global and each block of `kept` begins.
std::vector<std::size_t> Bench::lay_out(const Type& unit, std::span<const KeptReference> kept) {
    std::vector<std::size_t> begins;
    for (const Global& global : made_.checked.globals) {
        const bool is_unit = is_program(global) && global.type == &unit;
        begins.push_back(is_unit ? 0 : 8 * memory_.size());
        if (is_unit) continue;
        const auto& image = made_.generated.images.at(global.type);
        memory_.insert(memory_.end(), image.begin(), image.end());
    }
    for (const KeptReference& reference : kept) {
        begins.push_back(8 * memory_.size());
        memory_.resize(memory_.size() + (reference.to->size + 7) / 8);
    }
    return begins;
}

Bench::Bench(const Compiled& made, const Options& options, std::byte* unit, const Context& context,
             Told told)
    : made_(made), options_(options), told_(std::move(told)), unit_(unit), context_(context) {}

TestResult Bench::run(const CodeRoutine& routine, std::byte* instance) {
    return run_on(routine, instance, 0);
}

/// The part has no room for calls that recur, and its own slots are those of another scan.
TestResult Bench::run_part(const CodeRoutine& routine, const Type& block, int global,
                           std::size_t slot) {
    auto& caller = callers_.try_emplace(&block, made_.generated.images.at(&block)).first->second;
    const auto number =
        global < 0 ? static_cast<std::uint64_t>(std::ranges::find(places_, unit_) - places_.begin())
                   : static_cast<std::uint64_t>(global);
    return run_on(routine, reinterpret_cast<std::byte*>(caller.data()),
                  Address::in(number, slot).word());
}

TestResult Bench::run_on(const CodeRoutine& routine, std::byte* instance, std::uint64_t frame) {
    const Code& code = made_.generated.code;
    root_ = instance;
    for (std::uint64_t i = 0; i < made_.checked.globals.size() && !places_.empty(); ++i)
        std::memcpy(instance + 8 * (globals_slot + i), &i, sizeof i);
    code.witness = this;
    const Fault fault = execute_part(code, routine, instance, frame, now_, context_, options_.fuel);
    code.witness = nullptr;
    if (fault == Fault::none) return {};
    if (fault == Fault::assertion) return std::move(ended_);
    const FaultPlace place = fault_of(code, instance);
    return {fmt::format("the fault {}", fault_names[static_cast<std::size_t>(fault)]), place.mark,
            true, place.calls};
}

std::vector<std::uint64_t> Bench::end_of_scan() const {
    const auto word_at = [&](std::uint32_t slot) {
        return read<std::uint64_t>(unit_ + 8 * std::size_t{slot});
    };
    std::vector<std::uint64_t> end{word_at(place_slot), word_at(depth_slot)};
    const std::uint32_t stack = made_.generated.code.calls_slot();
    for (std::uint32_t i = 0; i < 2 * EndOfScan::of(end[0], end[1]).depth; ++i)
        end.push_back(word_at(stack + i));
    return end;
}

void Bench::end_at(std::span<const std::uint64_t> end) {
    std::memcpy(unit_ + 8 * std::size_t{place_slot}, end.data(), 2 * sizeof end[0]);
    std::memcpy(unit_ + 8 * std::size_t{made_.generated.code.calls_slot()}, end.data() + 2,
                end.size_bytes() - 2 * sizeof end[0]);
}

void Bench::advance() {
    constexpr std::int64_t step = 1'000'000;
    for (std::int64_t left = now_.interval; left > 0; left -= step) {
        now_of_objects_.interval = std::min(step, left);
        now_of_objects_.time += now_of_objects_.interval;
        ++now_of_objects_.index;
        for (const auto& [type, block] : objects_) {
            Context inner = context_;
            inner.kind = type->context;
            type->scan_blocks(block, 1, now_of_objects_, inner);
        }
    }
    now_.time += now_.interval;
    ++now_.index;
}

std::optional<Mark> Bench::cut() {
    return cut_of(made_.generated.code, unit_);
}

bool Bench::let_pass(std::int64_t time, std::int64_t interval) {
    now_.interval = interval;
    ++now_.index;
    return time >= 0 && !__builtin_add_overflow(now_.time, time, &now_.time);
}

bool Bench::ends_at(std::uint64_t instruction, std::uint64_t frame, std::uint64_t depth) {
    TestResult result = failed_assertion(
        made_, root_, context_,
        {static_cast<std::uint32_t>(instruction), static_cast<std::uint32_t>(depth), frame});
    const bool ends = told_(result);
    if (ends) ended_ = std::move(result);
    return ends;
}

}  // namespace lineshaft::st
