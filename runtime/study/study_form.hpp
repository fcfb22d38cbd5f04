#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/program/form.hpp"
#include "runtime/study/study.hpp"

/// A study as it is written: its structure is checked, its program is not loaded. A fit is made of
/// the same parts.

namespace lineshaft {

struct BoundsPlan {
    std::optional<Node> paper, at_least, at_most;
    std::vector<Node> within;
};

struct ComparisonPlan;

/// `spread` of a comparison: none, or one that is of the standard deviation over the repeats.
struct SpreadPlan {
    std::vector<ComparisonPlan> plans;
};

/// The numbers wait for the signal's unit.
struct ComparisonPlan {
    Node signal;
    BoundsPlan bounds;
    Statistic statistic = Statistic::mean;
    std::optional<Node> uncertainty = {}, column = {};  ///< of a fit
    SpreadPlan spread = {};                             ///< while it is read
};

struct CasePlan {
    Mark mark;
    Mark size_mark;  ///< of what makes many cases of it
    Node name;
    std::vector<Setting> settings;
    std::optional<std::int64_t> repeat;
    std::vector<ComparisonPlan> comparisons;
    std::vector<GridAxis> grid;
    std::vector<RandomParameter> random;
    std::int64_t draws = 1;
    std::uint64_t seed = 1;
    bool usable = true;  ///< all of it could be read
};

struct ClaimPlan {
    Node text, formula;
    bool percent = false;
    BoundsPlan bounds;
};

struct StudyPlan {
    std::string title;
    Node program;
    std::vector<std::string> notes;
    std::vector<Setting> settings;
    std::int64_t repeat = 1;
    std::vector<ComparisonPlan> comparisons;
    std::vector<CasePlan> cases;
    std::vector<ClaimPlan> claims;
};

const Form& study_form();

// Parts that a fit has as well.
const Form& study_head();  ///< of a StudyPlan: title, program, notes, slow, set, repeat
const Form& case_head();   ///< of a CasePlan: name, set, repeat
const Form& bounds_form();
Key spread_key(FormOf spread);
/// A list of signals, or a map of them to `comparison` or nothing.
Shape compared(FormOf comparison);

void put(const Reader&, const Key&, const Node&, std::vector<Setting>&);
void put(const Reader&, const Key&, const Node&, std::vector<ComparisonPlan>&);
void put(const Reader&, const Key&, const Node&, SpreadPlan&);

}  // namespace lineshaft
