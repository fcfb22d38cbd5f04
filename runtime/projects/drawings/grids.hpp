#pragma once

#include "runtime/projects/drawings/networks.hpp"

namespace lineshaft::projects {

/// A ladder of B&R (`.ld`, the element `<networks>`) as statements.
///
/// A network is rows of cells: contacts, lines, coils, operands, and boxes, which are two cells
/// wide and have a pin of each side a row. Power comes from the left; `or="true"` joins the right
/// end of a cell to that of the row above. What stands further left is evaluated first, then what
/// stands above.
Excerpts text_of_grid(const XmlFile& file, Diagnostics& out, MadeVariables& variables,
                      pugi::xml_node networks);

}  // namespace lineshaft::projects
