#pragma once

#include "runtime/study/study_form.hpp"

namespace lineshaft {

struct FitParameterPlan {
    Node name;
    Node from, to;
    std::optional<Node> start = {}, step = {};
};

/// `trace: FILE`, or a map. Without a file there is none.
struct FitTracePlan {
    Node place;
    Node file;
    std::optional<Node> time;
    std::int64_t offset = 0;  ///< [ns]
};

struct FitCasePlan {
    CasePlan run;
    bool hold_out = false;
    FitTracePlan trace;
};

/// A fit as it is written.
struct FitFilePlan {
    StudyPlan study;  ///< without cases
    std::vector<FitParameterPlan> parameters;
    std::int64_t starts = 1;
    std::uint64_t seed = 1;
    Node hold_out = {};  ///< `each`, or nothing
    std::vector<FitCasePlan> cases;
};

const Form& fit_form();

}  // namespace lineshaft
