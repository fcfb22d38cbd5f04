#include "runtime/st/library/suites_state.hpp"

#include <cstring>

#include "runtime/st/library/kind.hpp"

namespace lineshaft::st {

namespace {

const Variable* find(std::span<Variable* const> variables, std::string_view name) {
    const auto* found = find_called(variables, name, &Variable::text);
    return found ? *found : nullptr;
}

}  // namespace

SuitesState::SuitesState(const Compiled& made, std::byte* globals) : globals_(globals) {
    if (!made.checked.globals.empty())
        state_ = find(made.checked.globals.front().type->members, "TcUnit.GVL_TcUnit");
}

std::byte* SuitesState::place(std::string_view name) const {
    const Variable& found = *find(state_->type->members, name);
    return globals_ + 8 * std::size_t{state_->slot + found.slot};
}

std::int64_t SuitesState::get(std::string_view name) const {
    return read<std::int64_t>(place(name));
}

void SuitesState::set(std::string_view name, std::int64_t value) {
    std::memcpy(place(name), &value, sizeof value);
}

SuitesState::Test SuitesState::test(std::int64_t number) const {
    const Type& tests = *find(state_->type->members, "tests")->type;
    const Type& type = *tests.element;
    const std::byte* at =
        place("tests") + 8 * element_slots(tests) * static_cast<std::size_t>(number - 1);
    const auto part = [&](std::string_view name) {
        return at + 8 * std::size_t{find(type.members, name)->slot};
    };
    const std::byte* name = part("name");
    return {read<std::int64_t>(part("suite")),
            {reinterpret_cast<const char*>(name + 8), read<std::uint64_t>(name)},
            read<std::uint64_t>(part("finished")) != 0,
            read<std::uint64_t>(part("skipped")) != 0};
}

}  // namespace lineshaft::st
