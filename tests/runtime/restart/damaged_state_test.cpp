#include <array>
#include <cstdlib>
#include <random>

#include <catch2/catch.hpp>

#include "tests/folder.hpp"
#include "tests/fuzz/kept_runs.hpp"

using namespace lineshaft::test;

namespace {

/// More for tools/long.
int rounds() {
    const char* wanted = std::getenv("LINESHAFT_DAMAGED_STATES");
    return wanted ? std::atoi(wanted) : 10;
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
    for (const std::string& program : cases)
        for (const std::int64_t eighth : {1, 4, 7}) {
            const std::int64_t time = duration_of(program) * eighth / 8;
            INFO(program << " at " << time << " ns");
            const KeptRun run(program, time, folder / "", false);
            if (run.checkpoint().empty()) continue;
            CHECK(run.resume(run.checkpoint()));
            ++resumed;
            for (int i = 0; i < rounds() / 5; ++i)
                run.resume(damaged(run.checkpoint(), random_damage(random)));
        }
    CHECK(resumed > std::ssize(cases));
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
