#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "runtime/study/study_runner.hpp"

namespace lineshaft {

/// A study's results as a table: a row a case. Its columns are known before the first case runs:
///   case          its number in the study, from 1
///   name          where a case has one
///   speed ...     every parameter that a case sets, then those that none does: the values in
///                 force. A number where all values are numbers of one dimension, in the unit of
///                 the first; else the text. `$name` where a parameter has the name of another
///                 column
///   fit.offset ... every signal that is compared, at the end of the run, the mean of its repeats;
///                 with repeats also fit.offset.least and fit.offset.greatest, and where it is
///                 compared their standard deviation fit.offset.spread; empty for a case that did
///                 not run to its end, or does not compare it
///   machine_time  virtual time of all repeats in s
///   outcome       ok, failed (a bound or an expectation), fault (it did not run to its end)
///   message       what failed, ' | ' between several
/// Shortest numbers that read back exactly. Nothing depends on the clock or the machine.
class StudyCsv {
  public:
    explicit StudyCsv(const Study& study);

    /// Both end with '\n'.
    std::string header() const;
    std::string row(const CaseResult& result) const;

    /// A row without its '\n'; empty when it is none of this study.
    std::optional<CaseResult> parse(std::string_view row) const;

    /// Columns for the CSVW sidecar.
    nlohmann::ordered_json schema() const;

  private:
    struct Parameter {
        std::string name, title;
        bool numeric = true;
        Unit unit;
    };
    /// A column, or three: the mean of repeats stands with the least and the greatest.
    struct SignalColumn {
        std::string name, unit;
        Statistic statistic = Statistic::mean;
    };

    void learn(const CaseGroup& group);
    void see(const std::string& name, const std::string& value);
    Parameter& parameter(const std::string& name);
    std::vector<std::string> titles() const;
    std::string cell(const Parameter& parameter, const CaseResult& result) const;
    std::string text(const Parameter& parameter, std::string_view cell) const;
    std::size_t width(const SignalColumn& s) const {
        return repeats_ && s.statistic == Statistic::mean ? 3 : 1;
    }

    const Study& study_;
    std::vector<Parameter> parameters_;
    std::vector<SignalColumn> signals_;
    bool named_ = false, repeats_ = false;
};

}  // namespace lineshaft
