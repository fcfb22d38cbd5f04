#pragma once

#include "runtime/fit/fit_form.hpp"
#include "runtime/program/program_form.hpp"
#include "runtime/program/recording_form.hpp"
#include "runtime/study/study_form.hpp"

namespace lineshaft {

/// The forms of all files that lineshaft reads.
inline constexpr FormOf files[] = {program_form, controller_form, study_form, fit_form,
                                   recording_form};

}  // namespace lineshaft
