#pragma once

#include <cmath>

#include "runtime/study/study.hpp"

namespace lineshaft {

/// Mean and standard deviation of the values that repeated runs give, taken one by one.
class Scatter {
  public:
    void add(double value) {
        ++count_;
        sum_ += value;
        const double above = value - middle_;
        middle_ += above / count_;
        squares_ += above * (value - middle_);
    }
    double mean() const { return sum_ / count_; }
    /// The standard deviation of the sample: sqrt(sum of (value - mean)^2 / (count - 1)); 0 of
    /// fewer than two.
    double spread() const { return count_ > 1 ? std::sqrt(squares_ / (count_ - 1)) : 0; }
    double value(Statistic statistic) const {
        return statistic == Statistic::mean ? mean() : spread();
    }

  private:
    double count_ = 0, sum_ = 0;
    double middle_ = 0, squares_ = 0;  ///< mean, and squares about it (Welford 1962)
};

}  // namespace lineshaft
