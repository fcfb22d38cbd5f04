#include "runtime/study/study.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>

#include <catch2/catch.hpp>

#include "blocks/catalog.hpp"
#include "runtime/study/report.hpp"
#include "runtime/study/study_reader.hpp"
#include "tests/folder.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// After `time` the axis is at speed * time, if no jitter comes between.
constexpr const char* program = R"(lineshaft: 1
parameters: {speed: 10 mm/s, time: 1 s, jitter: 0 ms, top: 1000 mm}
tasks: {main: {every: 10 ms, jitter: $jitter}}
blocks:
  axis:
    type: path_move
    task: main
    execute: true
    length: 1e6 mm
    start_velocity: $speed
    velocity_limit: $speed
    end_velocity: $speed
run: {for: $time}
expect:
  - {always: axis.position, at_most: $top}
)";

/// A study in a folder of its own, beside its program.
class StudyFile {
  public:
    explicit StudyFile(const std::string& text, const std::string& program_text = program) {
        std::ofstream(folder_ / "program.yaml") << program_text;
        const std::string whole = "lineshaft_study: 1\nprogram: program.yaml\n" + text;
        file_ = std::make_shared<SourceFile>(SourceFile{folder_ / "study.yaml", whole});
        study = read_study(file_, {}, catalog, diagnostics);
    }

    StudyReport report(unsigned jobs = 1) {
        INFO(diagnostics.render());
        REQUIRE(diagnostics.empty());
        return run(study, catalog, {.jobs = jobs, .interrupt = nullptr, .progress = {}});
    }
    std::string code() const { return diagnostics.empty() ? "" : diagnostics.list().front().code; }

    const Catalog catalog = standard_blocks();
    Diagnostics diagnostics;
    Study study;

  private:
    Folder folder_;
    std::shared_ptr<const SourceFile> file_;
};

std::vector<double> values(const StudyReport& report) {
    std::vector<double> result;
    for (const StudyRow& row : report.rows) result.push_back(row.ours);
    return result;
}

}  // namespace

TEST_CASE("a bound holds within any distance of the paper's value and inside both limits") {
    Bounds bounds;
    CHECK(bounds.hold(1e300));
    CHECK_FALSE(bounds.judged());
    bounds.paper = 10;
    CHECK_FALSE(bounds.judged());
    bounds.within = {1, 0.5};
    CHECK(bounds.judged());
    CHECK(bounds.hold(11));
    CHECK(bounds.hold(9));
    CHECK_FALSE(bounds.hold(11.1));
    CHECK_FALSE(bounds.hold(8.9));
    bounds.at_most = 10.5;
    CHECK(bounds.hold(10.5));
    CHECK_FALSE(bounds.hold(10.6));
    Bounds limits;
    limits.at_least = 1;
    CHECK(limits.judged());
    CHECK(limits.hold(1));
    CHECK_FALSE(limits.hold(0.9));
    for (const Bounds& b : {bounds, limits})
        CHECK_FALSE(b.hold(std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("a study sets the paper's value beside each case's") {
    StudyFile file(R"(
cases:
  - set: {speed: 5 mm/s}
    compare: {axis.position: {paper: 5.4 mm, within: 10 %}}
  - set: {speed: 2 cm/s}
    compare: {axis.position: {paper: 0.02 m, within: 0.1 mm, at_most: 19 mm}}
  - compare: [axis.position, axis.busy]
)");
    const StudyReport report = file.report();
    CHECK(values(report) == std::vector<double>{5, 20, 10, 1});
    CHECK(report.rows[0].ok);
    CHECK(*report.rows[0].comparison->bounds.paper == 5.4);
    CHECK(report.rows[0].comparison->unit == "mm");
    CHECK(*report.rows[1].comparison->bounds.paper == 20);
    CHECK_FALSE(report.rows[1].ok);
    CHECK(report.rows[2].ok);
    CHECK_FALSE(report.ok());
    CHECK(report.machine_seconds == Approx(3));
}

TEST_CASE("a distance may be a length or a share of the paper's value, whichever is wider") {
    StudyFile file(R"(
compare: {axis.position: {paper: 20 mm, within: [10 %, 1 mm]}}
cases:
  - set: {speed: 18 mm/s}
  - set: {speed: 17.9 mm/s}
)");
    const StudyReport report = file.report();
    CHECK(report.rows[0].ok);
    CHECK_FALSE(report.rows[1].ok);
}

TEST_CASE("a case's settings override the study's") {
    StudyFile file(R"(
set: {speed: 3 mm/s, time: 2 s}
compare: [axis.position]
cases:
  - {}
  - set: {speed: 4 mm/s}
  - set: {time: 1 s}
)");
    CHECK(values(file.report()) == std::vector<double>{6, 8, 3});
}

TEST_CASE("a grid runs every combination, its last name varying fastest") {
    StudyFile file(R"(
compare: [axis.position]
cases:
  - grid: {time: [1 s, 2 s], speed: [1 mm/s, 3 mm/s, 5 mm/s]}
)");
    const StudyReport report = file.report();
    CHECK(values(report) == std::vector<double>{1, 3, 5, 2, 6, 10});
    CHECK(report.rows[4].of->settings[0].value == "2 s");
    CHECK(report.rows[4].of->settings[1].value == "3 mm/s");
}

TEST_CASE("repeats run with seeds that follow each other, ours is their mean") {
    StudyFile file(R"(
set: {jitter: 5 ms}
compare: [axis.position]
repeat: 3
cases: [{}]
)");
    const StudyReport repeated = file.report();
    std::vector<double> single;
    for (const char* seed : {"1", "2", "3"}) {
        std::string seeded = program;
        seeded.replace(seeded.find("run: {for: $time}"), 17,
                       "run: {for: $time, seed: " + std::string(seed) + "}");
        StudyFile one("set: {jitter: 5 ms}\ncompare: [axis.position]\ncases: [{}]\n", seeded);
        single.push_back(one.report().rows[0].ours);
    }
    CHECK(single[0] != single[1]);
    REQUIRE(repeated.rows.size() == 1);
    const StudyRow& row = repeated.rows[0];
    CHECK(row.ours == (single[0] + single[1] + single[2]) / 3);
    CHECK(row.least == *std::min_element(single.begin(), single.end()));
    CHECK(row.greatest == *std::max_element(single.begin(), single.end()));
}

TEST_CASE("a spread is the standard deviation over the repeats") {
    StudyFile file(R"(
set: {jitter: 5 ms}
compare: {axis.position: {paper: 10 mm, spread: {paper: 0.1 mm, at_most: 1 mm}}}
cases:
  - {name: two, repeat: 2}
  - {name: many, repeat: 50}
claims:
  - {claim: of two, formula: two.axis.position.spread}
  - {claim: mean, formula: mean_relative_error}
)");
    const StudyReport report = file.report();
    REQUIRE(report.rows.size() == 4);
    const StudyRow &mean = report.rows[0], &spread = report.rows[1];
    CHECK(spread.ours == Approx((mean.greatest - mean.least) / std::sqrt(2)));
    CHECK(spread.ours > 0);
    CHECK(spread.ok);
    CHECK(report.claims[0].ours == spread.ours);
    CHECK(report.rows[3].ours > 0);
    CHECK(report.rows[3].ours < report.rows[2].greatest - report.rows[2].least);
    // The means alone count.
    CHECK(report.claims[1].ours ==
          Approx((std::abs(mean.ours - 10) + std::abs(report.rows[2].ours - 10)) / 20));
}

TEST_CASE("the number of jobs changes neither values nor order") {
    const std::string text = R"(
set: {jitter: 4 ms}
compare: [axis.position]
repeat: 2
cases:
  - grid: {speed: [1 mm/s, 2 mm/s, 3 mm/s, 4 mm/s, 5 mm/s, 6 mm/s, 7 mm/s]}
)";
    StudyFile one(text), many(text);
    CHECK(values(one.report(1)) == values(many.report(4)));
}

TEST_CASE("claims are formulas over the cases' values") {
    StudyFile file(R"(
cases:
  - {name: slow, set: {speed: 2 mm/s}, compare: {axis.position: {paper: 2.5 mm}, axis.velocity: {}}}
  - {name: fast, set: {speed: 8 mm/s}, compare: {axis.position: {paper: 8 mm}}}
claims:
  - {claim: slower by, formula: 1 - slow / fast, unit: '%', paper: 70 %, within: 6 points}
  - {claim: far off, formula: fast - slow, at_most: 5}
  - {claim: velocity, formula: slow.axis.velocity}
  - {claim: mean, formula: mean_relative_error, at_most: 0.1}
  - {claim: greatest, formula: greatest_relative_error, at_least: 0.2}
)");
    const StudyReport report = file.report();
    REQUIRE(report.claims.size() == 5);
    CHECK(report.claims[0].ours == 0.75);
    CHECK(report.claims[0].ok);
    CHECK(report.claims[0].claim->percent);
    CHECK(report.claims[1].ours == 6);
    CHECK_FALSE(report.claims[1].ok);
    CHECK(report.claims[2].ours == 2);
    CHECK(report.claims[3].ours == Approx(0.1));
    CHECK(report.claims[4].ours == Approx(0.2));
    CHECK_FALSE(report.ok());
}

TEST_CASE("a case that does not run to its end is a fault, and its claims fail") {
    std::string stuck = program;
    stuck.replace(stuck.find("run: {for: $time}"), 17, "run: {for: $time, until: axis.done}");
    StudyFile file(R"(
compare: [axis.position]
cases: [{name: only}]
claims:
  - {claim: anything, formula: only}
)",
                   stuck);
    const StudyReport report = file.report();
    REQUIRE(report.faults.size() == 1);
    CHECK(report.faults[0] == "only: 'axis.done' did not become true within 1 s");
    CHECK_FALSE(report.ok());
    REQUIRE(report.claims.size() == 1);
    CHECK_FALSE(report.claims[0].ok);
}

TEST_CASE("a failed expectation of the program fails the study and names the case") {
    StudyFile file(R"(
compare: [axis.position]
cases:
  - set: {top: 9 mm}
)");
    const StudyReport report = file.report();
    REQUIRE(report.deviations.size() == 1);
    CHECK(report.deviations[0] ==
          "top=9 mm: axis.position is 9.1 mm at 0.91 s, scan 91; expected at most 9 mm");
    CHECK_FALSE(report.ok());
}

TEST_CASE("an interrupted study runs no further case and judges nothing") {
    StudyFile file(
        "compare: [axis.position]\ncases: [{name: a}]\n"
        "claims: [{claim: x, formula: a}]\n");
    REQUIRE(file.diagnostics.empty());
    const std::atomic<bool> interrupt = true;
    const StudyReport report =
        run(file.study, file.catalog, {.jobs = 1, .interrupt = &interrupt, .progress = {}});
    CHECK(report.interrupted);
    CHECK(report.rows.empty());
    CHECK(report.claims.empty());
    CHECK_FALSE(report.ok());
}

TEST_CASE("progress counts every case once") {
    StudyFile file("compare: [axis.position]\ncases: [{}, {}, {}]\n");
    REQUIRE(file.diagnostics.empty());
    std::vector<std::size_t> seen;
    run(file.study, file.catalog,
        {.jobs = 2, .interrupt = nullptr, .progress = [&](std::size_t done, std::size_t all) {
             CHECK(all == 3);
             seen.push_back(done);
         }});
    CHECK(seen == std::vector<std::size_t>{1, 2, 3});
}

TEST_CASE("every mistake of a study is known before its first run") {
    CHECK(StudyFile("compare: [axis.positio]\ncases: [{}]\n").code() == "L0203");
    CHECK(StudyFile("cases: [{set: {sped: 1 mm/s}}]\n").code() == "L0501");
    CHECK(StudyFile("cases: [{set: {speed: 1 kg}}]\n").code() == "L0304");
    CHECK(StudyFile("compare: {axis.position: {within: 1 mm}}\ncases: [{}]\n").code() == "L0202");
    CHECK(StudyFile("cases: [{repeat: 0}]\n").code() == "L0305");
    CHECK(StudyFile("cases: [{name: a, compare: [axis.position]}]\n"
                    "claims: [{claim: x, formula: b}]\n")
              .code() == "L0602");
    CHECK(StudyFile("cases: [{repeat: 1000001}]\n").code() == "L0601");
    CHECK(StudyFile("title: no cases\n").code() == "L0202");
}

TEST_CASE("a study that would run nothing is a mistake") {
    CHECK(StudyFile("cases: []\n").code() == "L0202");
    CHECK(StudyFile("cases: [{grid: {speed: []}}]\n").code() == "L0202");
}

TEST_CASE("a file says in its first keys whether it is a study or a program") {
    const SourceFile study{"a", "title: x\nlineshaft_study: 1\n"};
    const SourceFile program_file{"b", "lineshaft: 1\n"};
    const SourceFile neither{"c", "# lineshaft: 1\n  lineshaft_study: 1\n"};
    CHECK(is_study(study));
    CHECK_FALSE(is_program(study));
    CHECK(is_program(program_file));
    CHECK_FALSE(is_study(program_file));
    CHECK_FALSE(is_study(neither));
    CHECK_FALSE(is_program(neither));
}
