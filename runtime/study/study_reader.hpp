#pragma once

#include <memory>

#include "runtime/model/catalog.hpp"
#include "runtime/study/study_form.hpp"

namespace lineshaft {

/// Greatest number of runs of one study.
constexpr std::int64_t most_runs = 1'000'000;

/// What is checked before the first run.
enum class StudyCheck {
    values,  ///< the program is loaded with each value of each setting, once
    groups,  ///< once for each item of `cases:`; the rest is told by the cases
};

/// Reads and checks a study: its structure, and its program with its cases' settings.
Study read_study(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out, StudyCheck check = StudyCheck::values);

/// The same of a study that is read out of a file of another kind.
Study read_study(std::shared_ptr<const SourceFile> file, StudyPlan plan, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out);

/// True for a file that calls itself a study, or a program.
bool is_study(const SourceFile& file);
bool is_program(const SourceFile& file);

}  // namespace lineshaft
