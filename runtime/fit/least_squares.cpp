#include "runtime/fit/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/QR>
#include <unsupported/Eigen/LevenbergMarquardt>

namespace lineshaft {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double from_face = 0.02;       // a start on a face has no derivative there
constexpr double first_radius = 0.2;     // of the trust region, as a share of |u|
constexpr double flat = 1e-8;            // relative change of the sum that ends the search
constexpr double near = 1e-6;            // relative change of the point that does
constexpr double cannot_be_had = 1e100;  // a residual that no step is taken to

VectorXd to_box(const VectorXd& u) {
    return (1 - u.array().cos()) / 2;
}

VectorXd from_box(const VectorXd& x) {
    return (1 - 2 * x.array()).acos();
}

/// The sum of squares as Eigen's LevenbergMarquardt asks for it, in u.
struct Problem : Eigen::DenseFunctor<double> {
    Problem(const Residuals& all, const LeastSquaresOptions& how, Eigen::Index residual_count)
        : DenseFunctor(static_cast<int>(how.start.size()), static_cast<int>(residual_count)),
          residuals(all),
          options(how) {}

    int operator()(const VectorXd& u, VectorXd& out) const {
        if (options.stop()) return -1;
        const VectorXd at = residuals({to_box(u)}).front();
        out = at.size() == 0 ? VectorXd::Constant(values(), cannot_be_had) : at;
        return options.stop() ? -1 : 0;
    }

    int df(const VectorXd& u, MatrixXd& out) const {
        if (options.stop()) return -1;
        out = derivatives(to_box(u)) * (u.array().sin() / 2).matrix().asDiagonal();
        return options.stop() ? -1 : 0;
    }

    MatrixXd derivatives(const VectorXd& x) const;

    const Residuals& residuals;
    const LeastSquaresOptions& options;
};

/// Where one side cannot be had the other does; where neither can the derivative is 0.
MatrixXd Problem::derivatives(const VectorXd& x) const {
    std::vector<VectorXd> points{x};
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        points.insert(points.end(), 2, x);
        points.end()[-2][i] = std::max(0.0, x[i] - options.steps[i]);
        points.back()[i] = std::min(1.0, x[i] + options.steps[i]);
    }
    const std::vector<VectorXd> at = residuals(points);
    MatrixXd out = MatrixXd::Zero(values(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        auto low = static_cast<std::size_t>(2 * i + 1), high = low + 1;
        if (at[low].size() == 0) low = 0;
        if (at[high].size() == 0) high = 0;
        if (low == high || at[low].size() == 0 || at[high].size() == 0) continue;
        out.col(i) = (at[high] - at[low]) / (points[high][i] - points[low][i]);
    }
    return out;
}

/// W, where W W^T = (J^T J)^-1 with the columns of J scaled to the norm 1; empty where J has not
/// full rank.
MatrixXd inverse_root(const LeastSquares& minimum) {
    const MatrixXd& J = minimum.jacobian;
    const Eigen::Index n = minimum.point.size(), m = minimum.residuals.size();
    if (J.rows() != m || m < n) return {};
    const VectorXd scale = J.colwise().norm();
    if (!(scale.minCoeff() > 0)) return {};
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(J * scale.cwiseInverse().asDiagonal());
    if (qr.rank() < n) return {};
    const MatrixXd R = qr.matrixR().topLeftCorner(n, n);
    const MatrixXd root = R.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(n, n));
    return qr.colsPermutation() * root;
}

}  // namespace

LeastSquares minimise(const Residuals& residuals, const LeastSquaresOptions& options) {
    LeastSquares found;
    found.point = options.start.cwiseMax(from_face).cwiseMin(1 - from_face);
    found.residuals = residuals({found.point}).front();
    if (found.residuals.size() == 0) return found;
    Problem problem(residuals, options, found.residuals.size());
    Eigen::LevenbergMarquardt<Problem> search(problem);
    search.setExternalScaling(true);
    search.diag() = VectorXd::Ones(found.point.size());
    search.setFactor(first_radius);
    search.setFtol(flat);
    search.setXtol(near);
    search.setMaxfev(options.most_evaluations);
    VectorXd u = from_box(found.point);
    search.minimize(u);
    found.converged = search.info() == Eigen::Success && !options.stop();
    found.point = to_box(u);
    found.residuals = search.fvec();
    if (!options.stop()) found.jacobian = problem.derivatives(found.point);
    return found;
}

VectorXd standard_errors(const LeastSquares& minimum) {
    const Eigen::Index n = minimum.point.size(), m = minimum.residuals.size();
    const MatrixXd root = inverse_root(minimum);
    if (root.size() == 0) return VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
    const double s = m > n ? std::sqrt(minimum.sum() / static_cast<double>(m - n)) : 1;
    return s * root.rowwise().norm().cwiseQuotient(minimum.jacobian.colwise().norm().transpose());
}

MatrixXd correlations(const LeastSquares& minimum) {
    const Eigen::Index n = minimum.point.size();
    const MatrixXd root = inverse_root(minimum);
    if (root.size() == 0) return MatrixXd::Constant(n, n, std::numeric_limits<double>::quiet_NaN());
    const MatrixXd unit = root.rowwise().normalized();
    return unit * unit.transpose();
}

}  // namespace lineshaft
