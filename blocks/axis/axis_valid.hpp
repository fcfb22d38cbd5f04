#pragma once

#include "blocks/axis/axis.hpp"
#include "blocks/axis/servo_drive.hpp"
#include "runtime/model/kept_state.hpp"

/// Which states that were kept an axis and what it is made of can go on with.
namespace lineshaft {

bool is_valid(const Axis& axis, const KeptState& machine);
/// Forgets jobs that are not linked with it: their commands were not retained.
void mend(Axis& axis, const KeptState& machine);
bool is_valid(const ServoDrive& drive, const KeptState& machine);

bool is_valid(const Coupling& coupling, const KeptState& machine);
bool is_valid(const Request& request, const KeptState& machine);
bool is_valid(const Job& job, const KeptState& machine);
bool is_valid(MotionError error);

/// Whether what jobs for axes and for groups have in common may be so.
bool is_valid(const JobState& job, JobFor whom, const KeptState& machine);
/// Whether a job stands there.
bool is_job(std::int64_t place, JobFor whom, const KeptState& machine);
/// Every job once, each knows where it is, and the last is the last.
bool lists_are_valid(const JobList& inbox, const JobList& queue, JobFor whom,
                     const KeptState& machine);
/// Whether the list leads to the job, however it goes on: it may be damaged.
bool leads_to(const JobList& list, std::int64_t job, const KeptState& machine);

}  // namespace lineshaft
