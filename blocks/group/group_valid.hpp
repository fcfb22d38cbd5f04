#pragma once

#include "blocks/group/group_administration.hpp"
#include "blocks/group/group_moves.hpp"
#include "blocks/group/path_table.hpp"
#include "runtime/model/kept_state.hpp"

/// Which states that were kept groups and their commands can go on with.
namespace lineshaft {

bool is_valid(const AxesGroup& group, const KeptState& machine);
/// Forgets jobs that are not linked with it: their commands were not retained.
void mend(AxesGroup& group, const KeptState& machine);

bool is_valid(const GroupCommandBlock& command, const KeptState& machine);
/// Leaves a list that it is not in: its group was not retained.
void mend(GroupCommandBlock& command, const KeptState& machine);

}  // namespace lineshaft
