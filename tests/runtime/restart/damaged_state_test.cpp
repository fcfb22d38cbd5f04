#include <array>
#include <cmath>
#include <new>
#include <random>

#include <catch2/catch.hpp>

#include "blocks/axis/axis.hpp"
#include "blocks/catalog.hpp"
#include "runtime/machine/kept_memory.hpp"
#include "runtime/run/link.hpp"
#include "tests/count_of.hpp"
#include "tests/folder.hpp"
#include "tests/fuzz/kept_runs.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// More for tools/long.
std::int64_t rounds() {
    return count_of("LINESHAFT_DAMAGED_STATES", 10);
}

/// One to eight damages.
std::vector<std::uint8_t> random_damage(std::mt19937_64& random) {
    std::vector<std::uint8_t> choices(6 * (1 + random() % 8));
    for (std::uint8_t& byte : choices) byte = static_cast<std::uint8_t>(random());
    return choices;
}

}  // namespace

TEST_CASE("a run goes on with its own checkpoint, and is safe with any that is damaged",
          "[resume]") {
    const Folder folder;
    std::mt19937_64 random(41);
    for (const auto& run : kept_runs(folder / "", false)) {
        CHECK(run->resume(run->checkpoint()));
        for (int i = 0; i < rounds(); ++i)
            run->resume(damaged(run->checkpoint(), random_damage(random)));
    }
}

TEST_CASE("every case goes on with its own checkpoint, and is safe with any that is damaged",
          "[resume]") {
    const Folder folder;
    std::mt19937_64 random(43);
    int resumed = 0;
    const auto cases = all_cases();
    const bool each = rounds() > 10;
    for (std::size_t n = 0; n < cases.size(); ++n)
        for (const std::int64_t eighth : {1, 4, 7}) {
            if (!each && eighth != std::array{1, 4, 7}[n % 3]) continue;
            const std::string& program = cases[n];
            const std::int64_t time = duration_of(program) * eighth / 8;
            INFO(program << " at " << time << " ns");
            const KeptRun run(program, time, folder / "", false);
            if (run.checkpoint().empty()) continue;
            CHECK(run.resume(run.checkpoint()));
            ++resumed;
            for (int i = 0; i < rounds() / 5; ++i)
                run.resume(damaged(run.checkpoint(), random_damage(random)));
        }
    CHECK(resumed > std::ssize(cases) * (each ? 3 : 1) / 3);
}

TEST_CASE("a run begins with what it retained, and is safe with any that is damaged", "[retain]") {
    const Folder folder;
    std::mt19937_64 random(42);
    for (const auto& run : kept_runs(folder / "", true)) {
        CHECK(run->begin(run->retained(), false));
        for (int i = 0; i < rounds(); ++i) {
            const std::string other = damaged(run->retained(), random_damage(random));
            run->begin(other, true);
            CHECK((other == run->retained() || !run->begin(other, false)));
        }
    }
}

TEST_CASE("a machine goes on with parameters of an axis that a command can have set, no others") {
    constexpr const char* text =
        "lineshaft: 1\ntasks: {main: {every: 1 ms}}\nblocks:\n  x: {type: axis, task: main, "
        "software_limits: true, lowest_position: -1 m, highest_position: 1 m}\nrun: {for: 1 s}\n";
    Diagnostics out;
    Program program =
        read_program(std::make_shared<SourceFile>(SourceFile{"p.yaml", text}), {}, out);
    Linked linked = link(program, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(out.empty());
    Machine& machine = linked.machine;
    const KeptMemory memory(machine, 0);
    REQUIRE(memory.damaged() == "");
    Axis& axis = *std::launder(reinterpret_cast<Axis*>(machine.blocks[0].live));
    const auto is_taken = [&](const auto& change) {
        const Axis before = axis;
        change();
        const bool taken = memory.damaged().empty();
        axis = before;
        return taken;
    };
    CHECK(is_taken([&] { axis.default_velocity = 7; }));
    CHECK(is_taken([&] { axis.default_jerk = 0; }));
    CHECK(is_taken([&] { axis.software_limits = false; }));
    CHECK(is_taken([&] { axis.lowest_position = 0; }));
    for (const double wrong : {-1.0, 0.0, std::nan("")})
        CHECK_FALSE(is_taken([&] { axis.default_velocity = wrong; }));
    CHECK_FALSE(is_taken([&] { axis.default_deceleration = -1; }));
    CHECK_FALSE(is_taken([&] { axis.lowest_position = 2000; }));
    CHECK_FALSE(is_taken([&] { axis.highest_position = std::nan(""); }));
    CHECK_FALSE(is_taken([&] { axis.modulo = true; }));
    CHECK_FALSE(is_taken([&] { axis.period = 360; }));
    CHECK_FALSE(is_taken([&] { axis.has_drive = true; }));
    CHECK_FALSE(is_taken([&] { axis.unit = AxisUnit::deg; }));
    CHECK_FALSE(is_taken([&] { axis.transition_quantum = 1; }));
}
