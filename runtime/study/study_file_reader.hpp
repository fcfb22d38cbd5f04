#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runtime/run/single_run.hpp"
#include "runtime/source/reader.hpp"
#include "runtime/study/study_reader.hpp"

namespace lineshaft {

/// Makes a Study of a file, see read_study(), and is as long as that form has parts. Its functions
/// stand in study_reader.cpp (the file, identity), study_cases.cpp (cases and their check) and
/// study_claims.cpp (comparisons, bounds, claims).
class StudyFileReader {
  public:
    StudyFileReader(const LoadOptions& options, const Catalog& catalog, StudyCheck check,
                    Diagnostics& out)
        : options_(options), catalog_(catalog), check_(check), read_(out) {}

    Study read(std::shared_ptr<const SourceFile> file);
    Study read(std::shared_ptr<const SourceFile> file, StudyPlan plan);

  private:
    void find_program();
    std::string identity();
    void add_files(std::string& hash);
    std::set<std::string> choices(const Node& root, const Node& node) const;

    void one_case(const CasePlan& plan);
    void check_name(const Node& name);
    bool count(CaseGroup& group, const Mark& place);

    void check(CaseGroup& group, const std::vector<ComparisonPlan>& plans);
    void check_values(const CaseGroup& group, const std::vector<Setting>& base);
    void check_value(std::vector<Setting> settings, const Setting& value);
    void learn(const Program& program);
    std::optional<Loaded> load(const std::vector<Setting>& settings);
    bool enough() const;

    void compare(const ComparisonPlan& plan, const Machine& machine, CaseGroup& group);
    void claim(const ClaimPlan& plan);
    void check_formula(const Node& formula) const;
    Bounds bounds(const BoundsPlan& plan, const Unit& unit) const;
    void within(const Node& node, const Unit& unit, Bounds& bounds) const;

    const LoadOptions& options_;
    const Catalog& catalog_;
    StudyCheck check_;
    Reader read_;
    YamlFiles files_;
    CompiledSources sources_;
    StudyPlan plan_;
    Study study_;
    std::shared_ptr<const SourceFile> program_file_;
    std::vector<Setting> common_;
    std::int64_t runs_ = 0;
    bool checkable_ = true;    ///< there is a program, and the runs are not too many
    bool cases_known_ = true;  ///< every case so far is without mistakes
    std::set<std::string> names_;
    std::set<std::pair<std::string, std::string>> checked_;  ///< names and values of settings
};

}  // namespace lineshaft
