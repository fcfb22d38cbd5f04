#include <deque>
#include <memory>
#include <random>

#include <fmt/format.h>

#include "runtime/run/link.hpp"
#include "runtime/scan/executive.hpp"
#include "tests/runtime/names/small_blocks.hpp"

using namespace lineshaft;

namespace {

struct WithPointer {
    std::int64_t number = 0;
    const char* text = nullptr;
};
struct WithoutPointer {
    std::int64_t number = 0;
    bool flag = false;
};
static_assert(!PlainData<WithPointer>);
static_assert(PlainData<WithoutPointer>);

/// Remembers more than it shows.
struct Ticker {
    std::int64_t ticks = 0, last = 0;

    static constexpr std::string_view type = "ticker";
    static constexpr std::string_view doc = "Counts in a local";
    static std::span<const Field> fields() {
        static const Field table[] = {
            local("ticks", &Ticker::ticks, "", "scans so far"),
            output("last", &Ticker::last, "", "ticks before this scan"),
        };
        return table;
    }
    void scan(const Scan&) { last = ticks++; }
};

struct Tank {
    std::int64_t level = 1;

    static constexpr std::string_view type = "tank";
    static constexpr std::string_view doc = "Has a level that pumps act on";
    static std::span<const Field> fields() {
        static const Field table[] = {output("level", &Tank::level, "", "of the tank")};
        return table;
    }
    void scan(const Scan&) { level %= 1'000'003; }
};

/// In which order two of these act on a tank makes a difference.
template <int factor>
struct Pump {
    std::int64_t tank = -1, seen = 0;

    static constexpr std::string_view type = factor == 3 ? "pump_3" : "pump_5";
    static constexpr std::string_view doc = "Changes a tank's level";
    static std::span<const Field> fields() {
        static const Field table[] = {
            in_out("tank", &Pump::tank, "tank", "that is filled"),
            output("seen", &Pump::seen, "", "its level before"),
        };
        return table;
    }
    void scan(const Scan&, const Context& context) {
        auto& level = context.instance<Tank>(tank).level;
        seen = level;
        level = factor * level + 1;
    }
};

/// A kind whose name, fields and factor exist at run time only: what a program brings along.
struct Times {
    std::string name, doc = "Multiplies by the kind's factor";
    std::vector<Field> fields;
    std::int64_t factor = 1;

    struct Memory {
        std::int64_t x = 0, y = 0;
    };

    static BlockType type(std::string name, std::int64_t factor) {
        const auto kind = std::make_shared<Times>();
        kind->name = std::move(name);
        kind->factor = factor;
        kind->fields = {input("x", &Memory::x, "", "taken"), output("y", &Memory::y, "", "given")};
        return {.name = kind->name,
                .doc = kind->doc,
                .fields = kind->fields,
                .tables = {},
                .size = sizeof(Memory),
                .alignment = alignof(Memory),
                .make = [](std::byte* place, const void*) { new (place) Memory{}; },
                .scan_blocks = scan,
                .context = kind.get(),
                .owner = kind};
    }
    static bool scan(std::byte* first, std::size_t count, const Scan&, const Context& context) {
        const auto& kind = *static_cast<const Times*>(context.kind);
        for (; count > 0; --count, first += sizeof(Memory)) {
            auto& block = *std::launder(reinterpret_cast<Memory*>(first));
            block.y = kind.factor * block.x;
        }
        return false;
    }
};

const Catalog& catalog() {
    static const Catalog blocks =
        small_catalog().add<Ticker>().add<Tank>().add<Pump<3>>().add<Pump<5>>();
    return blocks;
}

Linked linked(const Program& program, Diagnostics& out) {
    return link(program, catalog(), out);
}

Linked linked(const std::string& blocks, Diagnostics& out, const std::string& rest = {}) {
    return linked(
        read_program(
            small_file("lineshaft: 1\ntasks: {a: {every: 1 ms, priority: 2}, b: {every: 1 ms}}\n"
                       "run: {for: 9 ms}\nblocks:\n" +
                       blocks + rest),
            {}, out),
        out);
}

std::string mistakes(const std::string& blocks, const std::string& rest = {}) {
    Diagnostics out;
    linked(blocks, out, rest);
    return codes_of(out);
}

std::int64_t integer(const Machine& machine, const std::string& name) {
    const Signal* signal = machine.find(name);
    REQUIRE(signal);
    return std::get<std::int64_t>(signal->value());
}

}  // namespace

TEST_CASE("a local is seen, forced and retained, and neither set nor wired") {
    Diagnostics out;
    Linked program =
        linked("  t: {type: ticker, task: a}\n", out,
               "force: [{from: 4 ms, until: 6 ms, set: {t.ticks: 100}}]\nretain: [t.ticks]\n"
               "trace: {task: a, signals: [t.ticks]}\nexpect: [{at: end, t.ticks: 105}]\n");
    INFO(out.render());
    REQUIRE(out.empty());
    CHECK(program.machine.retained.size() == 1);
    CHECK(program.traces.front().signals.front().name == "t.ticks");
    Executive(program.machine).run({});
    CHECK(integer(program.machine, "t.ticks") == 104);  // from 100 on, which it read last
    const std::string t = "  t: {type: ticker, task: a}\n";
    CHECK(mistakes(t + "  p: {type: probe, task: a, number: t.ticks}\n") == "L0203 6:37");
    CHECK(mistakes("  t: {type: ticker, task: a, ticks: 1}\n") == "L0405 5:30");
    CHECK(mistakes(t, "stimulus: [{at: 1 ms, set: {t.ticks: 1}}]\n") == "L0405 6:29");
}

TEST_CASE("blocks that refer to one block are scanned in the order of the file") {
    std::mt19937 random(1);
    for (int i = 0; i < 300; ++i) {
        INFO("program " << i);
        std::string text;
        std::vector<int> factors;
        const auto tank_at = random() % 8;
        for (unsigned k = 0; k < 8; ++k) {
            if (k == tank_at) text += "  tank: {type: tank, task: a}\n";
            factors.push_back(random() % 2 == 0 ? 3 : 5);
            text +=
                fmt::format("  p{}: {{type: pump_{}, task: a, tank: tank}}\n", k, factors.back());
        }
        Diagnostics out;
        Linked program = linked(text, out);
        INFO(text << out.render());
        REQUIRE(out.empty());
        Executive(program.machine).run({});
        std::int64_t level = 1;
        for (int scan = 0; scan < 10; ++scan)
            for (unsigned k = 0; k < 8; ++k) {
                if (k == tank_at) level %= 1'000'003;
                level = factors[k] * level + 1;
            }
        REQUIRE(integer(program.machine, "tank.level") == level);
    }
}

TEST_CASE("what is wrong with a reference") {
    const std::string tank = "  tank: {type: tank, task: a}\n";
    CHECK(mistakes(tank + "  p: {type: pump_3, task: b, tank: tank}\n").empty());
    CHECK(mistakes(tank + "  p: {type: pump_3, task: a}\n") == "L0403 6:3");
    CHECK(mistakes(tank + "  p: {type: pump_3, task: a, tank: tnak}\n") == "L0204 6:36");
    CHECK(mistakes(tank + "  p: {type: pump_3, task: a, tank: p}\n") == "L0401 6:36");
    CHECK(mistakes(tank + "  p: {type: pump_3, task: a, tank: tank.level}\n") == "L0204 6:36");
}

TEST_CASE("a saved machine with references goes on in another place of memory") {
    const std::string text =
        "  tank: {type: tank, task: a}\n  p: {type: pump_3, task: a, tank: tank}\n";
    Diagnostics out;
    Linked whole = linked(text, out), first = linked(text, out), second = linked(text, out);
    Executive(whole.machine).run({});
    StateWriter saved;
    Executive begun(first.machine);
    begun.begin();
    begun.run_until(5'000'000);
    begun.save(saved);
    StateReader state(saved.bytes());
    Executive resumed(second.machine);
    resumed.restore(state);
    REQUIRE(state.at_end());
    resumed.run({});
    CHECK(integer(second.machine, "tank.level") == integer(whole.machine, "tank.level"));
}

TEST_CASE("a program brings kinds of block along, with what each kind shares") {
    Diagnostics out;
    Linked program;
    {
        Program plan = read_program(
            small_file("lineshaft: 1\ntasks: {a: {every: 1 ms}}\nrun: {for: 3 ms}\nblocks:\n"
                       "  c: {type: counter, task: a}\n"
                       "  x: {type: triple, task: a, x: c.count}\n"
                       "  y: {type: sevenfold, task: a, x: x.y}\n"),
            {}, out);
        auto kinds = std::make_shared<Catalog>();
        kinds->add(Times::type("triple", 3)).add(Times::type("sevenfold", 7));
        program = link(plan, catalog(), out, kinds);
    }
    INFO(out.render());
    REQUIRE(out.empty());
    Executive(program.machine).run({});
    CHECK(integer(program.machine, "y.y") == 4 * 21);
}
