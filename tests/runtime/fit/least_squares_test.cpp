#include "runtime/fit/least_squares.hpp"

#include <cmath>

#include <catch2/catch.hpp>

#include "runtime/model/random.hpp"

using namespace lineshaft;
using Eigen::VectorXd;

namespace {

using Function = VectorXd (*)(const VectorXd&);

Residuals at_each_point(Function function) {
    return [function](const std::vector<VectorXd>& points) {
        std::vector<VectorXd> out;
        for (const VectorXd& x : points) out.push_back(function(x));
        return out;
    };
}

LeastSquaresOptions from(VectorXd start, double step = 1e-5) {
    LeastSquaresOptions options;
    options.steps = VectorXd::Constant(start.size(), step);
    options.start = std::move(start);
    return options;
}

/// Rosenbrock's valley with its minimum at (0.75, 0.75).
VectorXd valley(const VectorXd& x) {
    const double a = 4 * x[0] - 2, b = 4 * x[1] - 2;
    return Eigen::Vector2d(10 * (b - a * a), 1 - a);
}

/// No minimum inside: the nearest is (1, 0.25).
VectorXd beyond_the_face(const VectorXd& x) {
    return Eigen::Vector2d(x[0] - 1.5, x[1] - 0.25);
}

/// Cannot be had for x < 0.4; the minimum is 0.45.
VectorXd half_known(const VectorXd& x) {
    if (x[0] < 0.4) return {};
    return VectorXd::Constant(1, x[0] - 0.45);
}

VectorXd sum_only(const VectorXd& x) {
    return Eigen::Vector3d(x[0] + x[1] - 1, 2 * (x[0] + x[1]) - 2, x[0] + x[1] - 1.1);
}

double gauss(Random& random) {  // sum of twelve: variance 1, mean 0
    double sum = 0;
    for (int i = 0; i < 12; ++i) sum += std::ldexp(static_cast<double>(random.next() >> 11), -53);
    return sum - 6;
}

}  // namespace

TEST_CASE("the minimum at the end of a curved valley is found") {
    const LeastSquares found = minimise(at_each_point(valley), from(Eigen::Vector2d(0.2, 0.6)));
    CHECK(found.converged);
    CHECK(found.point[0] == Approx(0.75).margin(1e-5));
    CHECK(found.point[1] == Approx(0.75).margin(1e-5));
    CHECK(found.sum() < 1e-8);
}

TEST_CASE("a minimum outside of the box is approached as far as the face") {
    const auto inside = [](const std::vector<VectorXd>& points) {
        for (const VectorXd& x : points) CHECK((x.minCoeff() >= 0 && x.maxCoeff() <= 1));
        return at_each_point(beyond_the_face)(points);
    };
    const LeastSquares found = minimise(inside, from(Eigen::Vector2d(0, 1)));
    CHECK(found.point[0] == Approx(1).margin(1e-4));
    CHECK(found.point[1] == Approx(0.25).margin(1e-5));
    CHECK(found.jacobian(0, 0) == Approx(1));
}

TEST_CASE("no step is taken to where there are no residuals") {
    const LeastSquares found = minimise(at_each_point(half_known), from(VectorXd::Ones(1)));
    CHECK(found.point[0] == Approx(0.45).margin(1e-5));
    CHECK(minimise(at_each_point(half_known), from(VectorXd::Zero(1))).residuals.size() == 0);
}

TEST_CASE("a search that is stopped keeps the best point so far") {
    int left = 20;
    LeastSquaresOptions options = from(Eigen::Vector2d(0.2, 0.6));
    options.stop = [&left] { return --left < 0; };
    const LeastSquares found = minimise(at_each_point(valley), options);
    CHECK_FALSE(found.converged);
    CHECK(found.sum() < valley(Eigen::Vector2d(0.2, 0.6)).squaredNorm());
    CHECK(found.sum() > 1e-3);
    CHECK(std::isnan(standard_errors(found)[0]));
}

TEST_CASE("what the residuals do not determine has no standard error") {
    const LeastSquares found = minimise(at_each_point(sum_only), from(Eigen::Vector2d(0.2, 0.3)));
    CHECK(found.point.sum() == Approx(6.1 / 6).margin(1e-5));
    CHECK(std::isnan(standard_errors(found)[0]));
    CHECK(std::isnan(standard_errors(found)[1]));
}

TEST_CASE("standard errors are the spread of the estimates under noise") {
    constexpr int repeats = 400, samples = 25;
    constexpr double noise = 0.03;
    Random random(1, "noise");
    Eigen::Array2d sum = Eigen::Array2d::Zero(), squares = sum, errors = sum;
    for (int repeat = 0; repeat < repeats; ++repeat) {
        VectorXd measured(samples);
        const auto model = [](const VectorXd& x, int i) {
            const double t = i / (samples - 1.0);
            return x[0] * std::exp(-5 * x[1] * t);
        };
        for (int i = 0; i < samples; ++i)
            measured[i] = model(Eigen::Vector2d(0.6, 0.4), i) + noise * gauss(random);
        const auto residuals = [&](const std::vector<VectorXd>& points) {
            std::vector<VectorXd> out;
            for (const VectorXd& x : points) {
                out.emplace_back(samples);
                for (int i = 0; i < samples; ++i) out.back()[i] = model(x, i) - measured[i];
            }
            return out;
        };
        const LeastSquares found = minimise(residuals, from(Eigen::Vector2d(0.5, 0.5)));
        sum += found.point.array();
        squares += found.point.array().square();
        errors += standard_errors(found).array();
    }
    const Eigen::Array2d spread = (squares / repeats - (sum / repeats).square()).sqrt();
    for (int i = 0; i < 2; ++i) CHECK(errors[i] / repeats == Approx(spread[i]).epsilon(0.1));
}
