#include "runtime/run/link.hpp"

#include "runtime/scan/executive.hpp"
#include "tests/runtime/names/small_blocks.hpp"

using namespace lineshaft;

namespace {

const Catalog catalog = small_catalog();

/// A program with these blocks, in tasks `a` (1 ms) and `b` (1 ms, after it), and what else is
/// given.
std::string program_of(const std::string& blocks, const std::string& rest = {}) {
    return "lineshaft: 1\ntasks: {a: {every: 1 ms, priority: 2}, b: {every: 1 ms}}\nblocks:\n" +
           blocks + "run: {for: 2 ms}\n" + rest;
}

struct Result {
    Linked linked;
    Diagnostics out;

    std::string value(const char* signal) const {
        const Signal* found = linked.machine.find(signal);
        REQUIRE(found);
        return found->describe(found->value());
    }
};

Result link_text(const std::string& text) {
    Result result;
    const Program program = read_program(small_file(text), {}, result.out);
    result.linked = link(program, catalog, result.out);
    return result;
}

/// After three scans, at 0, 1 and 2 ms.
Result run_text(const std::string& text) {
    Result result = link_text(text);
    INFO(result.out.render());
    REQUIRE(result.out.empty());
    CHECK(Executive(result.linked.machine).run({}).outcome == Outcome::completed);
    return result;
}

std::string mistakes(const std::string& blocks, const std::string& rest = {}) {
    return codes_of(link_text(program_of(blocks, rest)).out);
}

}  // namespace

TEST_CASE("link: a wire carries this scan's value, previous() the last one's") {
    const Result result =
        run_text(program_of("  before: {type: probe, task: a, number: previous(c.count)}\n"
                            "  c: {type: counter, task: a}\n"
                            "  after: {type: probe, task: a, number: c.count}\n"));
    CHECK(result.value("c.count") == "3");
    CHECK(result.value("before.number") == "2");
    CHECK(result.value("after.number") == "3");
}

TEST_CASE("link: a block may read its own last scan") {
    const Result result =
        run_text(program_of("  g: {type: gain, task: a, x: previous(g.y), factor: 2}\n"));
    CHECK(result.value("g.y") == "0 mm");
}

TEST_CASE("link: each kind of wire") {
    const Result result = run_text(
        program_of("  c: {type: counter, task: a}\n"
                   "  p: {type: probe, task: a, flag: c.odd, pace: c.pace, number: c.count}\n"
                   "  n: {type: probe, task: a, flag: NOT c.odd}\n"));
    CHECK(result.value("c.odd") == "true");
    CHECK(result.value("p.flag") == "true");
    CHECK(result.value("n.flag") == "false");
    CHECK(result.value("p.pace") == "fast");
    CHECK(result.value("p.number") == "3");
}

TEST_CASE("link: wires are scaled to the unit of their input") {
    const Result result =
        run_text(program_of("  g: {type: gain, task: a, x: 1500 mm, factor: 2}\n"
                            "  p: {type: probe, task: a, length: g.y}\n"
                            "  h: {type: gain, task: a, x: inputs.feed}\n",
                            "inputs: {feed: 3 cm}\n"));
    CHECK(result.value("g.y") == "3000 mm");
    CHECK(result.value("p.length") == "3 m");
    CHECK(result.value("h.y") == "30 mm");
}

TEST_CASE("link: units follow a block's own parameter, wherever it stands") {
    const Result result =
        run_text(program_of("  p: {type: gain, task: b, unit: rad, x: g.y}\n"
                            "  g: {type: gain, task: a, x: 180 deg, unit: rad}\n"));
    CHECK(result.linked.machine.find("g.rate")->unit == "rad/s");
    CHECK(result.value("p.y") == result.value("g.y"));
    CHECK(mistakes("  g: {type: gain, task: a, x: 1 mm, unit: rad}\n") == "L0303 4:31");
}

TEST_CASE("link: other tasks see what was published, after its cost") {
    const std::string blocks =
        "  c: {type: counter, task: a}\n"
        "  p: {type: probe, task: b, number: c.count}\n";
    CHECK(run_text(program_of(blocks)).value("p.number") == "3");
    const std::string slow =
        "lineshaft: 1\n"
        "tasks: {b: {every: 1 ms, priority: 2}, a: {every: 1 ms, cost: 100 us}}\n"
        "blocks:\n" +
        blocks + "run: {for: 2 ms}\n";
    const Result result = run_text(slow);
    CHECK(result.value("p.number") == "2");
    CHECK(result.value("c.count") == "2");
}

TEST_CASE("link: tasks run by priority, blocks in the order of the file") {
    const Result result = link_text(
        "lineshaft: 1\ntasks: {low: {every: 1 ms}, high: {every: 1 ms, priority: 9}}\nblocks:\n"
        "  one: {type: counter, task: low}\n  two: {type: probe, task: low, number: one.count}\n"
        "run: {for: 1 ms}\n");
    REQUIRE(result.out.empty());
    const auto& tasks = result.linked.machine.tasks;
    REQUIRE(tasks.size() == 2);
    CHECK(tasks[0].name == "high");
    REQUIRE(tasks[1].calls.size() == 2);
    CHECK(tasks[1].calls[0].feed == Feed::no_wire);
    CHECK(tasks[1].calls[1].feed == Feed::widened);
}

TEST_CASE("link: constants and the interval of a task") {
    const Result result =
        run_text(program_of("  p: {type: probe, task: a, delay: every(b), length: 2 cm}\n"));
    CHECK(result.value("p.delay") == "0.001 s");
    CHECK(result.value("p.length") == "0.02 m");
}

TEST_CASE("link: stimuli reach inputs of the program and of blocks") {
    const Result result =
        run_text(program_of("  c: {type: counter, task: a, enable: inputs.go}\n"
                            "  d: {type: counter, task: a}\n",
                            "inputs: {go: false}\n"
                            "stimulus:\n"
                            "  - {at: 1 ms, set: {inputs.go: true, d.step: 5}}\n"));
    CHECK(result.value("c.count") == "2");
    CHECK(result.value("d.count") == "11");
}

TEST_CASE("link: what is wrong with a wire") {
    const std::string c = "  c: {type: counter, task: a}\n";
    struct Row {
        std::string blocks, mistakes;
    };
    const auto row = GENERATE_COPY(values<Row>({
        {"  g: {type: gain, task: a}\n", "L0403 4:3"},
        {"  g: {type: gain, task: a, x: g.y}\n", "L0404 4:31"},
        {"  g: {type: gain, task: a, x: h.y}\n  h: {type: gain, task: a, x: g.y}\n", "L0404 4:31"},
        {c + "  p: {type: probe, task: b, number: previous(c.count)}\n", "L0407 5:37"},
        {c + "  p: {type: probe, task: a, number: NOT c.count}\n", "L0408 5:37"},
        {c + "  p: {type: probe, task: a, number: c.odd}\n", "L0401 5:37"},
        {c + "  p: {type: probe, task: a, number: NOT c.odd}\n", "L0401 5:37"},
        {c + "  p: {type: probe, task: a, flag: c.pace}\n", "L0401 5:35"},
        {c + "  p: {type: probe, task: a, length: c.count}\n", "L0402 5:37"},
        {c + "  p: {type: probe, task: a, number: c.step}\n", "L0203 5:37"},
        {c + "  p: {type: probe, task: a, number: c.cuont}\n", "L0203 5:37"},
        {c + "  p: {type: probe, task: a, number: d.count}\n", "L0204 5:37"},
        {c + "  p: {type: probe, task: a, number: inputs.go}\n", "L0208 5:37"},
        {c + "  p: {type: probe, task: a, flag: not c.odd}\n", "L0208 5:35"},
        {c + "  g: {type: gain, task: a, x: 1 mm, factor: c.count}\n", "L0406 5:45"},
        {c + "  g: {type: gain, task: a, x: 1 mm, unit: c.pace}\n", "L0406 5:43"},
    }));
    INFO(row.blocks);
    CHECK(mistakes(row.blocks) == row.mistakes);
}

TEST_CASE("link: a loop through another task needs no previous()") {
    CHECK(mistakes("  g: {type: gain, task: a, x: h.y}\n  h: {type: gain, task: b, x: g.y}\n")
              .empty());
}

TEST_CASE("link: a loop is named hop by hop") {
    const Result result =
        link_text(program_of("  f: {type: gain, task: a, x: h.y}\n"
                             "  g: {type: gain, task: a, x: f.y}\n"
                             "  h: {type: gain, task: a, x: g.y}\n"));
    REQUIRE(result.out.list().size() == 1);
    CHECK(result.out.list()[0].message == "this feedback needs previous(): f -> g -> h -> f");
}

TEST_CASE("link: what could not be read causes no further mistakes") {
    CHECK(mistakes("  c: [counter]\n  p: {type: probe, task: a, number: c.count}\n") ==
          "L0209 4:6");
    CHECK(
        mistakes("  c: {type: contour, task: a}\n  p: {type: probe, task: a, number: c.count}\n") ==
        "L0205 4:13");
    CHECK(mistakes("  p: {type: probe, task: a, flag: inputs.go}\n", "inputs: {go: yes}\n") ==
          "L0307 6:14");
    CHECK(codes_of(link_text("lineshaft: 1\ntasks: [a]\nblocks: {c: {type: counter, task: a}}\n"
                             "run: {for: 1 s}\n")
                       .out) == "L0209 2:8");
}

TEST_CASE("link: what a stimulus may not set") {
    const std::string blocks =
        "  c: {type: counter, task: a}\n  g: {type: gain, task: a, x: inputs.x}\n";
    const auto set = [&](const std::string& what) {
        return mistakes(blocks, "inputs: {x: 0 mm}\nstimulus: [{at: 1 ms, set: {" + what + "}}]\n");
    };
    CHECK(set("c.step: 2").empty());
    CHECK(set("c.step: 20") == "L0305 8:37");
    CHECK(set("c.count: 2") == "L0405 8:29");
    CHECK(set("g.factor: 2") == "L0405 8:29");
    CHECK(set("g.x: 2 mm") == "L0409 8:29");
    CHECK(set("inputs.x: 2") == "L0302 8:39");
}

TEST_CASE("link: bounds of expectations") {
    const Result result =
        link_text(program_of("  g: {type: gain, task: a, x: 2 mm}\n  c: {type: counter, task: a}\n",
                             "expect:\n"
                             "  - {at: end, g.y: 20 mm, within: 10 %}\n"
                             "  - {at: 1 ms, g.y: 2 cm, within: 1 mm}\n"
                             "  - {always: g.y, at_least: 1 mm, at_most: 3 mm}\n"
                             "  - {at: end, c.odd: true}\n"
                             "  - {at: end, c.pace: fast}\n"));
    INFO(result.out.render());
    REQUIRE(result.out.empty());
    const auto& e = result.linked.expectations;
    REQUIRE(e.size() == 5);
    CHECK(as_real(e[0].low) == 18);
    CHECK(as_real(e[0].high) == 22);
    CHECK(as_real(e[1].low) == 19);
    CHECK(e[1].from == 1'000'000);
    CHECK(e[2].when == Expectation::When::always);
    CHECK(as_real(e[2].low) == 1);
    CHECK(as_real(e[2].high) == 3);
    CHECK(as_real(e[3].low) == 1);
    CHECK(as_real(e[4].high) == 1);
    CHECK(e[0].text == "at the end: g.y = 20 mm within 10 %");
}

TEST_CASE("link: bounds of integers are exact, and end where integers end") {
    const Result result =
        link_text(program_of("  c: {type: counter, task: a}\n",
                             "inputs: {n: 9007199254740992}\n"
                             "expect:\n"
                             "  - {at: end, inputs.n: 9007199254740993}\n"
                             "  - {at: end, inputs.n: 9007199254740993, within: 1}\n"
                             "  - {at: end, inputs.n: 9223372036854775807, within: 2}\n"
                             "  - {at: end, inputs.n: -9223372036854775808, within: 0.5}\n"
                             "  - {at: end, inputs.n: 100, within: 10.5 %}\n"));
    INFO(result.out.render());
    REQUIRE(result.out.empty());
    const auto& e = result.linked.expectations;
    const auto bounds = [&](std::size_t i) { return format(e[i].low) + " " + format(e[i].high); };
    CHECK(bounds(0) == "9007199254740993 9007199254740993");
    CHECK(bounds(1) == "9007199254740992 9007199254740994");
    CHECK(bounds(2) == "9223372036854775805 9223372036854775807");
    CHECK(bounds(3) == "-9223372036854775808 -9223372036854775808");
    CHECK(bounds(4) == "90 110");
}

TEST_CASE("link: what is wrong with an expectation, a trace or a run") {
    const std::string c = "  c: {type: counter, task: a}\n";
    CHECK(mistakes(c, "expect: [{at: end, c.odd: true, within: 1}]\n") == "L0213 6:41");
    CHECK(mistakes(c, "expect: [{at: end, c.count: {at_least: 2, at_most: 1}}]\n") == "L0213 6:40");
    CHECK(mistakes(c, "expect: [{at: end, c.count: 2, within: -1}]\n") == "L0305 6:40");
    CHECK(mistakes(c, "expect: [{at: end, c.pace: fsat}]\n") == "L0306 6:28");
    CHECK(mistakes(c, "trace: {task: d, signals: [c.count, c]}\n") == "L0206 6:15; L0208 6:37");
    CHECK(codes_of(link_text("lineshaft: 1\ntasks: {a: {every: 1 ms}}\nblocks:\n" + c +
                             "run: {for: 1 s, until: c.count}\n")
                       .out) == "L0401 5:24");
}
