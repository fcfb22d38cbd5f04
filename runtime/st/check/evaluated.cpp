#include <algorithm>
#include <bit>
#include <cstring>

#include "runtime/st/check/checker_class.hpp"
#include "runtime/st/code/machine.hpp"
#include "runtime/st/functions/standard.hpp"
#include "runtime/st/generate/generator.hpp"

namespace lineshaft::st {

namespace {

/// Made of constants, operators, conversions and standard functions alone.
bool is_fixed(const Expression& e) {
    using E = Expression::Kind;
    if (e.kind == E::call) {
        const bool is_standard = e.standard && e.type && e.standard->rule != Rule::time;
        return is_standard && std::ranges::all_of(e.arguments, [](const Argument& a) {
                   return is_fixed(*a.value);
               });
    }
    const bool is_made = e.kind == E::unary || e.kind == E::binary || e.kind == E::converted;
    return is_made ? is_fixed(*e.operands[0]) && (!e.operands[1] || is_fixed(*e.operands[1]))
                   : is_constant(e);
}

Constant constant_of(const Type& type, const std::uint64_t* slots) {
    if (type.kind == Type::Kind::text)
        return {.text = {reinterpret_cast<const char*>(slots + 1), std::size_t{*slots}}};
    if (type.is_real()) return {.real = std::bit_cast<double>(*slots)};
    return {.integer = type.is_unsigned_64() ? Wide{*slots} : static_cast<std::int64_t>(*slots)};
}

}  // namespace

/// The machine does it, in a program of its own, so that the bits are those of a scan.
bool Checker::evaluate(Expression& e) {
    if (is_constant(e) || !e.type || !is_fixed(e)) return is_constant(e);
    Pou pou{.place = e.place};
    Checked alone;
    Type block{.kind = Kind::block};
    Routine& routine = alone.routines.emplace_back();
    routine.pou = &pou;
    routine.type = &block;
    block.routine = &routine;
    Variable& result = routine.variables.emplace_back();
    result.name.place = e.place;
    result.type = e.type;
    Expression target{.kind = Expression::Kind::name, .place = e.place};
    target.type = e.type;
    target.variable = &result;
    Statement assigned{.place = e.place, .target = &target, .value = &e};
    pou.body = {&assigned};
    alone.order = {&routine};
    Diagnostics wrong;
    Generated made = generate(alone, wrong, {});
    std::vector<std::uint64_t>& image = made.images.at(&block);
    Scan scan;
    const Fault fault = execute(made.code, made.code.routines.front(),
                                reinterpret_cast<std::byte*>(image.data()), scan, {}, 1, nullptr);
    if (fault == Fault::none) {
        become(e, *e.type, constant_of(*e.type, &image[result.slot]));
        return true;
    }
    e.type =
        fail("L0908", e.place,
             fmt::format("this is the fault {}", fault_names[static_cast<std::size_t>(fault)]));
    return false;
}

}  // namespace lineshaft::st
