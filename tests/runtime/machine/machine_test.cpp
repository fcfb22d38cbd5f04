#include "runtime/machine/machine.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("a signal is found by its whole name") {
    double value = 2.5;
    Machine machine;
    machine.signals = {
        {.name = "a.x", .unit = {}, .names = {}, .slot = nullptr},
        {.name = "a.xy", .unit = "mm", .names = {}, .slot = reinterpret_cast<std::byte*>(&value)}};
    REQUIRE(machine.find("a.xy"));
    CHECK(machine.find("a.xy")->unit == "mm");
    CHECK(machine.find("a.x") == &machine.signals[0]);
    CHECK(machine.find("a") == nullptr);
    CHECK(machine.find("") == nullptr);
}

TEST_CASE("a signal's value is what stands in its slot, described with its unit or name") {
    static constexpr std::string_view names[] = {"idle", "run"};
    double real = -0.125;
    std::int64_t state = 1;
    bool on = true;
    const auto at = [](auto& member) { return reinterpret_cast<std::byte*>(&member); };
    const Signal speed{.name = "s", .unit = "mm/s", .names = {}, .slot = at(real)};
    const Signal mode{.name = "m",
                      .type = Type::enumeration,
                      .unit = {},
                      .names = ValueNames(names),
                      .slot = at(state)};
    const Signal flag{.name = "f", .type = Type::boolean, .unit = {}, .names = {}, .slot = at(on)};
    CHECK(speed.value() == Value(-0.125));
    CHECK(speed.describe(speed.value()) == "-0.125 mm/s");
    CHECK(mode.value() == Value(std::int64_t{1}));
    CHECK(mode.describe(mode.value()) == "run");
    CHECK(flag.describe(flag.value()) == "true");
    real = 3;
    CHECK(speed.value() == Value(3.0));
}
