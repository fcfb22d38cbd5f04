#include "runtime/study/study_csv.hpp"

#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

Study example() {
    Study study;
    CaseGroup group{
        .mark = {}, .name = {}, .settings = {}, .grid = {}, .random = {}, .comparisons = {}};
    group.settings = {{"method", "early, late"}, {"outcome", "5"}};
    group.grid.push_back({"speed", {}, {{"speed", "5 mm/s"}, {"speed", "2 cm/s"}}});
    group.comparisons.push_back({.signal = "fit.offset", .unit = "mm", .bounds = {}});
    group.count = 2;
    study.groups.push_back(group);
    return study;
}

CaseResult result(const Study& study, std::int64_t index) {
    CaseResult made;
    made.of = std::make_shared<StudyCase>(study.make_case(index));
    made.values = {{0.1, 0.1, 0.1}};
    made.machine_seconds = 1.5;
    return made;
}

}  // namespace

TEST_CASE("a study's CSV has settings as numbers in one unit, and texts with commas in quotes") {
    const Study study = example();
    const StudyCsv csv(study);
    CHECK(csv.header() == "case,method,$outcome,speed,fit.offset,machine_time,outcome,message\n");
    CHECK(csv.row(result(study, 0)) == "1,\"early, late\",5,5,0.1,1.5,ok,\n");
    CHECK(csv.row(result(study, 1)) == "2,\"early, late\",5,20,0.1,1.5,ok,\n");
    CHECK(csv.schema()[3]["unit"] == "mm/s");
    CHECK(csv.schema()[1]["datatype"] == "string");
}

TEST_CASE("a row has the values in force, of what no case sets as well") {
    Study study = example();
    study.parameters = {{"speed", "5 mm/s"}, {"step", "1 mm"}, {"lag", "2 mm"}};
    const StudyCsv csv(study);
    CHECK_THAT(csv.header(), Catch::StartsWith("case,method,$outcome,speed,step,lag,fit.offset,"));
    CaseResult made = result(study, 1);
    made.parameters = {{"speed", "2 cm/s"}, {"step", "1 mm"}, {"lag", "0.4 cm"}};
    const std::string row = csv.row(made);
    CHECK_THAT(row, Catch::StartsWith("2,\"early, late\",5,20,1,4,"));
    const auto back = csv.parse(row.substr(0, row.size() - 1));
    REQUIRE(back);
    CHECK(csv.row(*back) == row);
    CHECK_THAT(csv.row(result(study, 1)), Catch::StartsWith("2,\"early, late\",5,20,1,2,"));
}

TEST_CASE("repeats have their mean, least and greatest value") {
    Study study = example();
    study.groups[0].repeat = 2;
    const StudyCsv csv(study);
    CHECK_THAT(csv.header(), Catch::Contains("fit.offset,fit.offset.least,fit.offset.greatest,"));
    CaseResult made = result(study, 0);
    made.values = {{2, 1, 3}};
    const auto back = csv.parse(csv.row(made).substr(0, csv.row(made).size() - 1));
    REQUIRE(back);
    CHECK(back->values[0].ours == 2);
    CHECK(back->values[0].least == 1);
    CHECK(back->values[0].greatest == 3);
}

TEST_CASE("a spread has one column") {
    Study study = example();
    study.groups[0].repeat = 2;
    Comparison spread = study.groups[0].comparisons[0];
    spread.statistic = Statistic::spread;
    study.groups[0].comparisons.push_back(spread);
    const StudyCsv csv(study);
    CHECK_THAT(csv.header(),
               Catch::Contains("fit.offset.least,fit.offset.greatest,fit.offset.spread,machine"));
    CaseResult made = result(study, 0);
    made.values = {{2, 1, 3}, {1.5, 1.5, 1.5}};
    const std::string row = csv.row(made);
    const auto back = csv.parse(row.substr(0, row.size() - 1));
    REQUIRE(back);
    CHECK(back->values[0].greatest == 3);
    CHECK(back->values[1].ours == 1.5);
    CHECK(csv.row(*back) == row);
}

TEST_CASE("a row reads back as the result it was written of") {
    Study study = example();
    study.groups[0].comparisons[0].bounds.at_most = 0.05;
    const StudyCsv csv(study);
    CaseResult failed = result(study, 1), fault = result(study, 0), unknown = result(study, 0);
    failed.deviations = {"a, \"b\"", "c\nd"};
    fault.faults = {"it stopped"};
    fault.values.clear();
    unknown.values[0].ours = std::numeric_limits<double>::quiet_NaN();
    for (const CaseResult& made : {failed, fault, unknown}) {
        const std::string row = csv.row(made);
        const auto back = csv.parse(row.substr(0, row.size() - 1));
        REQUIRE(back);
        CHECK(csv.row(*back) == row);
        CHECK(back->ok() == made.ok());
        CHECK(back->faults == made.faults);
    }
    CHECK_THAT(csv.row(failed), Catch::Contains("failed,\"a, \"\"b\"\" | c d | fit.offset is out"));
}

TEST_CASE("what is no row of the study is not taken for one") {
    const Study study = example();
    const StudyCsv csv(study);
    for (const char* row :
         {"", "1", "3,x,5,5,0.1,1.5,ok,", "0,x,5,5,0.1,1.5,ok,", "1.5,x,5,5,0.1,1.5,ok,",
          "1,x,5,5,0.1x,1.5,ok,", "1,x,5,5,0.1,1.5,ok,,"})
        CHECK_FALSE(csv.parse(row));
    CHECK(csv.parse("1,x,5,5,0.1,1.5,ok,"));
}
