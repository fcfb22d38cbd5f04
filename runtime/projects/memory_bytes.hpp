#pragma once

#include <string>
#include <string_view>

#include "runtime/projects/project.hpp"

namespace lineshaft::projects {

/// The bits that an S7-1200 or S7-1500 writes itself into two bytes of its bit memory, where a tag
/// table has them by the names that TIA Portal gives them: `Clock_1Hz` at %M0.5, `FirstScan` at
/// %M1.0. Each byte is written by a PROGRAM of its own, which a task is to run.
class MemoryBytes {
  public:
    /// A tag of any name.
    void add(std::string_view name, std::string_view address);

    /// Notes the PROGRAMs, and gives them in SCL: `Clock memory of Default tag table`.
    std::string add_to(Project& project, std::string_view table, const Mark& mark) const;

    /// Such a bit begins as TRUE.
    static bool is_always_true(std::string_view name, std::string_view address);

  private:
    std::string clocks_, system_;  ///< statements
};

}  // namespace lineshaft::projects
