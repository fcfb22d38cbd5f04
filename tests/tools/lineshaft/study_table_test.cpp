#include "tools/lineshaft/study_table.hpp"

#include <limits>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

/// Two cases that differ in speed, a bound that holds and one that fails, and two claims.
struct Example {
    Study study;
    std::vector<std::shared_ptr<StudyCase>> cases;
    StudyReport report;

    Example() {
        study.title = "An example";
        study.notes = {"A note."};
        cases = {one_case("5 mm/s", 2), one_case("10 mm/s", 4)};
        for (const auto& c : cases)
            study.groups.push_back({.mark = {},
                                    .name = {},
                                    .settings = c->settings,
                                    .grid = {},
                                    .random = {},
                                    .comparisons = c->comparisons});
        Claim reduction{.text = "falls by", .formula = "1 - a / b", .percent = true, .bounds = {}};
        reduction.bounds.paper = 0.5;
        reduction.bounds.within = {0.05};
        study.claims = {reduction, {.text = "ratio", .formula = "a / b", .bounds = {}}};
        add_row(0, 2.1, true);
        add_row(1, 6, false);
        report.claims = {{&study.claims[0], 0.65, false}, {&study.claims[1], 0.35, true}};
    }

    static std::shared_ptr<StudyCase> one_case(const char* speed, double paper) {
        Comparison comparison{.signal = "fit.offset", .unit = "mm", .bounds = {}};
        comparison.bounds.paper = paper;
        comparison.bounds.within = {0.5};
        return std::make_shared<StudyCase>(
            StudyCase{.name = {},
                      .settings = {{"method", "early"}, {"speed", speed}},
                      .comparisons = {comparison}});
    }
    void add_row(std::size_t index, double ours, bool ok) {
        const auto& c = cases[index];
        report.rows.push_back({c, &c->comparisons[0], ours, ours - 1, ours + 1, ok});
        ++report.cases;
        if (!ok) ++report.failed;
    }
};

}  // namespace

TEST_CASE("a study's table has what varies, the paper's value, ours, the difference, a verdict") {
    const Example e;
    CHECK(study_table(e.study, e.report) ==
          "An example\n"
          "\n"
          "speed    signal      paper  ours    difference\n"
          "5 mm/s   fit.offset  2      2.1 mm  +0.1 (+5.0 %)  ok\n"
          "10 mm/s  fit.offset  4      6 mm    +2 (+50.0 %)   FAILED\n"
          "\n"
          "claim     paper   ours    difference\n"
          "falls by  50.0 %  65.0 %  +15.0 points  FAILED\n"
          "ratio             0.35\n"
          "\n"
          "A note.\n");
}

TEST_CASE("limits have a column when there are any") {
    Example e;
    e.cases[0]->comparisons[0].bounds.at_most = 3;
    e.cases[1]->comparisons[0].bounds.at_least = 0.5;
    const std::string table = study_table(e.study, e.report);
    CHECK_THAT(table, Catch::Contains("limit"));
    CHECK_THAT(table, Catch::Contains("<= 3    ok"));
    CHECK_THAT(table, Catch::Contains(">= 0.5  FAILED"));
}

TEST_CASE("repeats have a column with the least and the greatest value") {
    Example e;
    e.cases[0]->repeat = 4;
    CHECK(
        study_table(e.study, e.report)
            .starts_with(
                "An example\n"
                "\n"
                "speed    signal      paper  ours    difference     least .. greatest\n"
                "5 mm/s   fit.offset  2      2.1 mm  +0.1 (+5.0 %)  1.1 .. 3.1         ok\n"
                "10 mm/s  fit.offset  4      6 mm    +2 (+50.0 %)                      FAILED\n"));
}

namespace {

/// Two methods by three radii, two signals without a paper's value.
struct Grid {
    Study study;
    StudyReport report;

    Grid() {
        study.title = "A grid";
        CaseGroup group{
            .mark = {}, .name = {}, .settings = {}, .grid = {}, .random = {}, .comparisons = {}};
        group.settings = {{"speed", "5 mm/s"}};
        group.grid = {{"method", {}, {{"method", "early"}, {"method", "late"}}},
                      {"radius", {}, {{"radius", "1 m"}, {"radius", "2 m"}, {"radius", "3 m"}}}};
        group.comparisons = {{.signal = "a", .unit = "mm", .bounds = {}},
                             {.signal = "b", .unit = "", .bounds = {}}};
        group.comparisons[0].bounds.at_most = 4;
        group.count = 6;
        study.groups = {group};
    }

    void run() {
        for (std::int64_t index = 0; index < 6; ++index) {
            const auto of = std::make_shared<StudyCase>(study.make_case(index));
            const auto value = static_cast<double>(index);
            report.rows.push_back(
                {of, &of->comparisons[0], value, value - 1, value + 1, index < 5});
            report.rows.push_back({of, &of->comparisons[1], 10 * value, 0, 0, true});
        }
    }
};

}  // namespace

TEST_CASE("cases that are every combination of two settings make a matrix a signal") {
    Grid grid;
    grid.run();
    CHECK(study_table(grid.study, grid.report) ==
          "A grid\n"
          "\n"
          "a [mm], limit <= 4\n"
          "\n"
          "method \\ radius  1 m  2 m  3 m\n"
          "early            0    1    2\n"
          "late             3    4    5 FAILED\n"
          "\n"
          "b\n"
          "\n"
          "method \\ radius  1 m  2 m  3 m\n"
          "early            0    10   20\n"
          "late             30   40   50\n");
}

TEST_CASE("what is no grid, or has limits of its own, or the paper's values, makes no matrix") {
    Grid missing, limits, paper;
    limits.study.groups[0].comparisons[0].bounds.at_most = 3;
    paper.study.groups[0].comparisons[0].bounds.paper = 3;
    for (Grid* grid : {&missing, &limits, &paper}) grid->run();
    missing.report.rows.resize(10);
    const auto last = std::make_shared<StudyCase>(*limits.report.rows.back().of);
    last->comparisons[0].bounds.at_most = 2;
    limits.report.rows[10].of = limits.report.rows[11].of = last;
    limits.report.rows[10].comparison = &last->comparisons[0];
    for (const Grid* grid : {&missing, &limits, &paper})
        CHECK_THAT(study_table(grid->study, grid->report),
                   Catch::Contains("method  radius  signal"));
}

TEST_CASE("a wide table has a row a case and a column a signal") {
    Grid grid;
    grid.study.groups[0].repeat = 2;
    grid.run();
    CHECK(study_table(grid.study, grid.report, TableStyle::wide)
              .starts_with("A grid\n"
                           "\n"
                           "method  radius  a [mm]             b\n"
                           "early   1 m     0 (-1 .. 1)        0 (0 .. 0)\n"
                           "early   2 m     1 (0 .. 2)         10 (0 .. 0)\n"));
}

TEST_CASE("faults and failed expectations stand below the table") {
    Example e;
    e.report.faults = {"a: disk full"};
    e.report.deviations = {"b: x is 1"};
    CHECK_THAT(study_table(e.study, e.report),
               Catch::EndsWith("\nexpectation failed: b: x is 1\nfault: a: disk full\n"));
}

TEST_CASE("the first failure is a row before a claim, in one line") {
    Example e;
    CHECK(first_failure(e.report) ==
          "fit.offset, method early, speed 10 mm/s is 6; paper 4, within 0.5");
    e.report.rows[1].ok = true;
    CHECK(first_failure(e.report) == "falls by is 65.0 %; paper 50.0 %, within 5.0 %");
    e.report.claims[0].ok = true;
    CHECK(first_failure(e.report).empty());
}

TEST_CASE("the JSON object has rows and claims with the same keys") {
    const Example e;
    const auto json = study_json(e.study, e.report);
    CHECK(json["title"] == "An example");
    REQUIRE(json["rows"].size() == 2);
    const auto& row = json["rows"][0];
    CHECK(row["set"]["method"] == "early");
    CHECK(row["set"]["speed"] == "5 mm/s");
    CHECK(row["signal"] == "fit.offset");
    CHECK(row["unit"] == "mm");
    CHECK(row["paper"] == 2.0);
    CHECK(row["ours"] == 2.1);
    CHECK(row["ok"] == true);
    CHECK_FALSE(row.contains("least"));
    CHECK(json["rows"][1]["ok"] == false);
    REQUIRE(json["claims"].size() == 2);
    const auto& claim = json["claims"][0];
    for (const auto& [key, value] : row.items()) CHECK(claim.contains(key));
    CHECK(row["case"] == 1);
    CHECK_FALSE(row.contains("traces"));
    CHECK(claim["unit"] == "%");
    CHECK(claim["ours"] == 65.0);
    CHECK(claim["paper"] == 50.0);
    CHECK(json["claims"][1]["paper"].is_null());
    CHECK(json["claims"][1]["unit"] == "");
    CHECK(json["ok"] == false);
    CHECK_FALSE(json.contains("faults"));
}

TEST_CASE("repeated cases show their spread, values that are no numbers are null") {
    Example e;
    e.cases[0]->repeat = 4;
    e.report.rows[1].ours = std::numeric_limits<double>::quiet_NaN();
    e.report.faults = {"a fault"};
    const auto json = study_json(e.study, e.report);
    CHECK(json["rows"][0]["repeats"] == 4);
    CHECK(json["rows"][0]["least"] == 1.1);
    CHECK(json["rows"][0]["greatest"] == 3.1);
    CHECK(json["rows"][1]["ours"].is_null());
    CHECK(json["faults"][0] == "a fault");
}
