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

}  // namespace lineshaft
