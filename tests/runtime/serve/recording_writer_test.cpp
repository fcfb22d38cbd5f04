#include "runtime/serve/recording_writer.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/program/meaning.hpp"
#include "runtime/serve/desk.hpp"
#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr const char* source = R"(
TYPE Colour : (red, green, true_blue, null); END_TYPE
TYPE Part : STRUCT on : BOOL; size : LREAL; kind : Colour; left : ARRAY[-1..1] OF LINT; END_STRUCT END_TYPE
FUNCTION_BLOCK Io
VAR_INPUT
    b : BOOL; i : LINT; small : INT; r : LREAL; t : TIME; c : Colour; g : ARRAY[1..4] OF LREAL;
    m : ARRAY[0..1, -1..1] OF DINT; p : Part; parts : ARRAY[0..1] OF Part;
END_VAR
VAR_OUTPUT n : LINT; END_VAR
n := n + 1;
END_FUNCTION_BLOCK
)";

constexpr const char* recorded_program = R"(lineshaft: 1
tasks: {main: {every: 2 ms}}
sources: s.st
inputs: {go: false, level: 1.5, count: 1, "null": 1, "true": 2}
blocks:
  io: {type: Io, task: main}
  x: {type: axis, task: main, has_drive: true}
  f: {type: MC_MoveVelocity, task: main, Axis: x}
run: {for: 1 s}
)";

/// A value that a field takes, often one of the edge.
Value random_value(const Target& target, std::mt19937_64& random) {
    const Field& field = target.field;
    if (field.type == Type::boolean) return random() % 2 == 0;
    if (field.type == Type::enumeration)
        return static_cast<std::int64_t>(random() % field.names.size());
    if (field.type == Type::integer) {
        const auto least = std::isfinite(field.minimum) ? static_cast<std::int64_t>(field.minimum)
                                                        : std::numeric_limits<std::int64_t>::min();
        const auto most = std::isfinite(field.maximum) ? static_cast<std::int64_t>(field.maximum)
                                                       : std::numeric_limits<std::int64_t>::max();
        const std::uint64_t width =
            static_cast<std::uint64_t>(most) - static_cast<std::uint64_t>(least);
        const std::uint64_t off = random() % 4 == 0            ? 0
                                  : random() % 4 == 0          ? width
                                  : width == ~std::uint64_t{0} ? random()
                                                               : random() % (width + 1);
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(least) + off);
    }
    for (;;) {
        double value = 0;
        const std::uint64_t bits = random() % 3 == 0 ? random() % 4 << 62 | random() % 3 : random();
        std::memcpy(&value, &bits, sizeof value);
        if (std::isfinite(value) && std::abs(value) < 1e300) return value;
    }
}

}  // namespace

TEST_CASE("whatever is recorded of any signal is played back") {
    const Folder folder;
    std::ofstream(folder / "s.st") << source;
    std::ofstream(folder / "p.yaml") << recorded_program;
    Diagnostics out;
    auto loaded = load_program(folder / "p.yaml", {}, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(loaded);
    Desk desk(*loaded);
    Connecting to{loaded->program, loaded->linked.net, loaded->linked.machine, Reader(out)};
    const std::string meaning = meaning_of(loaded->program).in_force;
    std::mt19937_64 random(41);
    std::string text =
        fmt::format("lineshaft_recording: 1\nprogram: p.yaml\nmeaning: '{}'\nentries:\n", meaning);
    std::vector<Stimulus> wanted;
    std::vector<Force> forced;
    std::int64_t time = 1;
    for (int round = 0; round < 60; ++round)
        for (const Signal& signal : loaded->linked.machine.signals) {
            Node node;
            node.text = signal.name;
            const auto kind = static_cast<Change::Kind>(random() % 3);
            Diagnostics unfit;
            const Connecting look{to.program, to.net, to.machine, Reader(unfit)};
            const auto target =
                kind == Change::Kind::set ? find_settable(look, node) : find_target(look, node);
            if (!target) continue;
            const std::string value = describe(random_value(*target, random), target->field.type,
                                               target->field.names, target->signal.unit);
            const auto changes = desk.changes(kind, {{signal.name, value}}, unfit);
            if (!unfit.empty()) continue;
            text += recorded(++time, changes);
            for (Change change : changes) {
                change.stimulus.at = change.force.from = time;
                if (kind == Change::Kind::set) wanted.push_back(change.stimulus);
                if (kind == Change::Kind::force) forced.push_back(change.force);
            }
        }
    REQUIRE(wanted.size() > 300);
    REQUIRE(forced.size() > 300);
    std::ofstream(folder / "r.yaml") << text << "- {at: 1 s, end: true}\n";
    LoadOptions options;
    options.recording = folder / "r.yaml";
    auto again = load_program(folder / "p.yaml", options, standard_blocks(), out);
    INFO(out.render());
    REQUIRE(again);
    const Machine &before = loaded->linked.machine, &played = again->linked.machine;
    const auto place = [](const Machine& machine, const std::byte* at) {
        return at - machine.memory.data();
    };
    REQUIRE(played.stimuli.size() == wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        INFO(wanted[i].text);
        CHECK(played.stimuli[i].at == wanted[i].at);
        CHECK((played.stimuli[i].value == wanted[i].value));
        CHECK(place(played, played.stimuli[i].target) == place(before, wanted[i].target));
    }
    REQUIRE(played.forces.size() == forced.size());
    for (std::size_t i = 0; i < forced.size(); ++i) {
        INFO(forced[i].text());
        CHECK(played.forces[i].from == forced[i].from);
        CHECK((played.forces[i].value == forced[i].value));
        CHECK(place(played, played.forces[i].live) == place(before, forced[i].live));
    }
}
