#include <bit>

#include "runtime/st/code/machine.hpp"
#include "runtime/st/generate/generator.hpp"
#include "runtime/st/library/compiled.hpp"
#include "runtime/st/types/elementary.hpp"

namespace lineshaft::st {

namespace {

Constant constant_of(const Type& type, const std::uint64_t* slots) {
    if (type.kind == Type::Kind::text)
        return {.text = {reinterpret_cast<const char*>(slots + 1), std::size_t{*slots}}};
    if (type.is_real()) return {.real = std::bit_cast<double>(*slots)};
    return {.integer = whole_in(type, *slots)};
}

}  // namespace

Evaluated evaluate(Expression& expression) {
    const Place place = expression.place;
    Pou pou{.place = place};
    Checked alone;
    Type block{.kind = Type::Kind::block};
    Routine& routine = alone.routines.emplace_back();
    routine.pou = &pou;
    routine.type = &block;
    block.routine = &routine;
    Variable& result = routine.variables.emplace_back();
    result.name.place = place;
    result.type = expression.type;
    Expression target{.kind = Expression::Kind::name, .place = place};
    target.type = expression.type;
    target.variable = &result;
    Statement assigned{.place = place, .target = &target, .value = &expression};
    routine.body = {&assigned};
    alone.order = {&routine};
    Diagnostics wrong;
    Generated made = generate(alone, wrong, {});
    std::vector<std::uint64_t>& image = made.images.at(&block);
    Scan scan;
    auto* const instance = reinterpret_cast<std::byte*>(image.data());
    if (execute(instance, {made.code, made.code.routines.front(), 1}, scan, {}))
        return {fault_of(made.code, instance).fault};
    return {Fault::none, constant_of(*expression.type, &image[result.slot])};
}

}  // namespace lineshaft::st
