#pragma once

#include "runtime/projects/drawings/networks.hpp"
#include "runtime/st/syntax/cursor.hpp"

namespace lineshaft::projects {

/// The rungs of a NETWORK of SIMATIC SD, LAD or FBD, as statements in SCL: from where `p` stands,
/// a `Label( here )` or a RUNG, to END_NETWORK. `text` is what `p` reads.
///
/// A rung is executed from the left to the right, in its turn, or where a wire that it ends at is
/// first needed. What leads to several rungs is a variable.
Excerpts text_of_rungs(st::Cursor& p, const PlacedFile& text, Diagnostics& out,
                       MadeVariables& variables, int network);

}  // namespace lineshaft::projects
