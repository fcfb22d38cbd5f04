#pragma once

#include <memory>

#include "runtime/model/catalog.hpp"
#include "runtime/study/study.hpp"

namespace lineshaft {

/// Greatest number of runs of one study.
constexpr std::int64_t most_runs = 1'000'000;

/// Reads and checks a study: its structure, and its program with every case's settings.
Study read_study(std::shared_ptr<const SourceFile> file, const LoadOptions& options,
                 const Catalog& catalog, Diagnostics& out);

/// True for a file that calls itself a study, or a program.
bool is_study(const SourceFile& file);
bool is_program(const SourceFile& file);

}  // namespace lineshaft
