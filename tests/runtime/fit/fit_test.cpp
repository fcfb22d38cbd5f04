#include "runtime/fit/fit.hpp"

#include <cmath>
#include <fstream>

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/model/random.hpp"
#include "tests/folder.hpp"
#include "tools/lineshaft/fit_table.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

/// y = a + b x, and what noise does to a drive's position.
constexpr const char* program = R"(lineshaft: 1
parameters: {a: 0, b: 1, x: 1, noise: 0 mm}
tasks: {main: {every: 10 ms}}
blocks:
  slope: {type: mul, task: main, in1: $b, in2: $x}
  y: {type: add, task: main, in1: slope.out, in2: $a}
  drive: {type: servo_drive, task: main, set_position: 0 mm, noise: $noise}
run: {for: 10 ms}
)";

struct Line {
    Eigen::VectorXd x, y;
    Eigen::Index count() const { return x.size(); }
};

Line noisy_line(std::uint64_t seed) {
    Random random(seed, "line");
    const Eigen::Index count = 4 + static_cast<Eigen::Index>(random.next() % 5);
    Line line{Eigen::VectorXd(count), Eigen::VectorXd(count)};
    for (Eigen::Index i = 0; i < count; ++i) {
        line.x[i] = static_cast<double>(i) + 0.3 * random.normal();
        line.y[i] = 0.7 + 0.4 * line.x[i] + 0.2 * random.normal();
    }
    return line;
}

/// The figures of the line as cases; the first `held_out` of them are held out.
std::string cases_of(const Line& line, Eigen::Index held_out) {
    std::string text;
    for (Eigen::Index i = 0; i < line.count(); ++i)
        text +=
            fmt::format("  - {{set: {{x: {}}}, hold_out: {}, compare: {{y.out: {{paper: {}}}}}}}\n",
                        line.x[i], i < held_out, line.y[i]);
    return text;
}

FitReport fit(const std::string& text, const FitOptions& options = {}) {
    const Folder folder;
    const Catalog catalog = standard_blocks();
    std::ofstream(folder / "program.yaml") << program;
    Diagnostics out;
    const FitPlan plan =
        read_fit(std::make_shared<SourceFile>(SourceFile{
                     folder / "fit.yaml", "lineshaft_fit: 1\nprogram: program.yaml\n" + text}),
                 {}, catalog, out);
    INFO(out.render());
    REQUIRE(out.empty());
    FitReport report = run(plan, catalog, options);
    CHECK(fit_json(plan, report)["parameters"].size() == plan.parameters.size());
    return report;
}

constexpr const char* parameters = "parameters: {a: {from: -5, to: 5}, b: {from: -4, to: 4}}\n";

}  // namespace

TEST_CASE("left out in turn, each case of a line is off by its residual over 1 - leverage",
          "[fit]") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const Line line = noisy_line(seed);
        const FitReport report = fit(parameters + std::string("hold_out: each\ncases:\n") +
                                     cases_of(line, static_cast<Eigen::Index>(seed % 3)));
        Eigen::MatrixXd A(line.count(), 2);
        A << Eigen::VectorXd::Ones(line.count()), line.x;
        const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A);
        const Eigen::VectorXd residuals = A * qr.solve(line.y) - line.y;
        const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(line.count(), 2);
        INFO("seed " << seed);
        REQUIRE(std::ssize(report.left_out) == line.count());
        for (Eigen::Index i = 0; i < line.count(); ++i) {
            const FitLeftOut& one = report.left_out[static_cast<std::size_t>(i)];
            REQUIRE(one.rows.size() == 1);
            CHECK(one.converged);
            CHECK(one.rows[0].difference ==
                  Approx(residuals[i] / (1 - Q.row(i).squaredNorm())).margin(1e-5));
        }
    }
}

TEST_CASE("the identification and the cases left out in turn do not depend on each other",
          "[fit]") {
    const std::string cases = "cases:\n" + cases_of(noisy_line(1), 2);
    const FitReport alone = fit(parameters + cases);
    const FitReport each = fit(parameters + std::string("hold_out: each\n") + cases,
                               {.jobs = 3, .interrupt = nullptr, .progress = {}});
    const FitReport other =
        fit(parameters + std::string("hold_out: each\ncases:\n") + cases_of(noisy_line(1), 0));
    CHECK(each.values[0].value != other.values[0].value);
    for (std::size_t i = 0; i < each.left_out.size(); ++i)
        CHECK(each.left_out[i].values == other.left_out[i].values);
    CHECK(alone.left_out.empty());
    CHECK(alone.runs < each.runs);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(alone.values[i].value == each.values[i].value);
        CHECK(alone.values[i].standard_error == each.values[i].standard_error);
    }
}

TEST_CASE("the errors of a line's height and slope correlate as its points lie", "[fit]") {
    const Line line = noisy_line(2);
    const FitReport report = fit(parameters + std::string("cases:\n") + cases_of(line, 0));
    const double expected = -line.x.mean() / std::sqrt(line.x.array().square().mean());
    CHECK(report.values[0].correlations[0] == Approx(1));
    CHECK(report.values[0].correlations[1] == Approx(expected).margin(1e-6));
    CHECK(report.values[1].correlations[0] == report.values[0].correlations[1]);
}

TEST_CASE("the jackknife error of a mean is that of the mean", "[fit]") {
    const double values[] = {2, 3, 7, 8, 10};
    std::vector<FitLeftOut> left_out;
    for (const double value : values) left_out.push_back({nullptr, {(30 - value) / 4}, {}, true});
    CHECK(jackknife_error(left_out, 0) == Approx(std::sqrt(46.0 / 4 / 5)));
}

TEST_CASE("a bound that a left-out case breaks fails the fit", "[fit]") {
    const std::string cases = R"(cases:
  - {set: {x: 0}, compare: {y.out: {paper: 0}}}
  - {set: {x: 1}, compare: {y.out: {paper: 1}}}
  - {set: {x: 2}, compare: {y.out: {paper: 2.6, within: 0.5}}}
)";
    CHECK(fit(parameters + cases).ok());
    const FitReport each = fit(parameters + std::string("hold_out: each\n") + cases);
    CHECK(each.left_out[2].rows[0].difference == Approx(-0.6).margin(1e-4));
    CHECK_FALSE(each.ok());
}

TEST_CASE("a spread is fitted as any figure", "[fit]") {
    const FitReport report = fit(R"(
repeat: 100
parameters: {noise: {from: 0 mm, to: 0.1 mm, start: 0.08 mm}}
cases:
  - compare: {drive.position: {paper: 0 mm, uncertainty: 1 mm, spread: {paper: 0.03 mm, uncertainty: 0.001 mm}}}
)");
    REQUIRE(report.rows.size() == 2);
    CHECK(report.rows[1].comparison->name() == "drive.position.spread");
    CHECK(report.rows[1].ours == Approx(0.03).margin(1e-5));
    CHECK(report.values[0].value == Approx(0.03).epsilon(0.3));
}
