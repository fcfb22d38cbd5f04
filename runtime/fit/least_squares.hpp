#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace lineshaft {

/// Residuals at several points of the unit box [0, 1]^n, in their order; an empty vector where they
/// cannot be had. All others have the same length m >= n.
using Residuals =
    std::function<std::vector<Eigen::VectorXd>(const std::vector<Eigen::VectorXd>& points)>;

struct LeastSquares {
    Eigen::VectorXd point;      ///< in the unit box
    Eigen::VectorXd residuals;  ///< there; empty: not even the start could be evaluated
    Eigen::MatrixXd jacobian;   ///< there, d residual / d coordinate
    bool converged = false;     ///< else: stopped, or out of evaluations

    double sum() const { return residuals.squaredNorm(); }  ///< of squares
};

struct LeastSquaresOptions {
    Eigen::VectorXd start;  ///< in the unit box; brought in from its faces by 0.02
    Eigen::VectorXd steps;  ///< of the difference quotients, as coordinates, > 0
    int most_evaluations = 200;
    std::function<bool()> stop = [] { return false; };  ///< asked before every evaluation
};

/// Minimises the sum of squares in the unit box by Levenberg-Marquardt (MINPACK's, as Eigen has
/// it). The box is held by a change of variable, x = (1 - cos u) / 2 (after MINUIT), so a minimum
/// on a face is approached, not crossed. Derivatives are central difference quotients, one-sided on
/// a face; all points of one Jacobian are asked for at once.
LeastSquares minimise(const Residuals& residuals, const LeastSquaresOptions& options);

/// Standard errors of the coordinates, from the Jacobian at the minimum:
///     sqrt(diag(s^2 (J^T J)^-1)),  s^2 = sum / (m - n),
/// or s = 1 when m = n, where the residuals say nothing of the noise: they are then as good as the
/// uncertainties in which the residuals are counted. NaN where the residuals do not determine a
/// coordinate (J has not full rank).
Eigen::VectorXd standard_errors(const LeastSquares& minimum);

/// Correlations of the coordinates' errors, -1..1: the scaled (J^T J)^-1. NaN as above.
Eigen::MatrixXd correlations(const LeastSquares& minimum);

}  // namespace lineshaft
