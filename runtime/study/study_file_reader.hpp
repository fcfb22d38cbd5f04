#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runtime/run/link.hpp"
#include "runtime/source/reader.hpp"
#include "runtime/study/study_reader.hpp"

namespace lineshaft {

/// A comparison whose numbers wait for the signal's unit.
struct PendingComparison {
    Node signal;
    Node body;  ///< map, or empty for a bare report
    Statistic statistic = Statistic::mean;
};

/// Makes a Study of a file, see read_study(). Its functions stand in study_reader.cpp (the file,
/// identity), study_cases.cpp (cases, grids, random values, their check) and study_claims.cpp
/// (comparisons, bounds, claims).
class StudyFileReader {
  public:
    StudyFileReader(const LoadOptions& options, const Catalog& catalog, StudyCheck check,
                    Diagnostics& out)
        : options_(options), catalog_(catalog), check_(check), read_(out) {}

    Study read(std::shared_ptr<const SourceFile> file);
    Study read(std::shared_ptr<const SourceFile> file, const Node& root);

  private:
    void program(const Node& root);
    void notes(const Node& node);
    std::string identity();
    void add_files(std::string& hash);
    std::set<std::string> choices(const Node& root, const Node& node) const;

    void cases(const Node& node);
    void one_case(const Node& node);
    void parts(const Node& node, CaseGroup& group);
    std::string name(const Node& node);
    std::int64_t positive(const Node& node, std::string_view least) const;
    void settings(const Node& node, std::vector<Setting>& into) const;
    void grid(const Node& node, CaseGroup& group) const;
    void random(const Node& node, CaseGroup& group) const;
    void distribution(const Node& name, const Node& body, CaseGroup& group) const;
    bool limits(const Node& kind, const Node& values, RandomParameter& parameter) const;
    bool check_limits(const Node& values, const RandomParameter& parameter) const;
    bool count(const Node& place, CaseGroup& group);

    void check(CaseGroup& group, const std::vector<PendingComparison>& comparisons);
    void check_values(const CaseGroup& group, const std::vector<Setting>& base);
    void check_value(std::vector<Setting> settings, const Setting& value);
    std::optional<Linked> load(const std::vector<Setting>& settings);
    bool enough() const;

    void comparisons(const Node& node, std::vector<PendingComparison>& into) const;
    std::optional<Comparison> compare(const PendingComparison& pending, const Machine& machine,
                                      std::int64_t repeat);
    void claims(const Node& node);
    void claim(const Node& node);
    void check_formula(const Node& formula) const;
    Bounds bounds(const Node& map, const Unit& unit) const;
    void within(const Node& node, const Unit& unit, Bounds& bounds) const;

    const LoadOptions& options_;
    const Catalog& catalog_;
    StudyCheck check_;
    Reader read_;
    YamlFiles files_;
    Study study_;
    std::shared_ptr<const SourceFile> program_file_;
    std::vector<Setting> common_;
    std::vector<PendingComparison> common_comparisons_;
    std::int64_t common_repeat_ = 1;
    std::int64_t runs_ = 0;
    bool checkable_ = true;    ///< there is a program, and the runs are not too many
    bool cases_known_ = true;  ///< every case so far is without mistakes
    std::set<std::string> names_;
    std::set<std::pair<std::string, std::string>> checked_;  ///< names and values of settings
};

}  // namespace lineshaft
