#pragma once

#include "runtime/projects/drawings/networks.hpp"

namespace lineshaft::projects {

/// What a body makes of its own beside its statements.
struct BodyText {
    Excerpts members;     ///< ACTIONs and METHODs of a chart, which stand before the body
    Excerpts statements;  ///< or a chart's steps and transitions
};

/// The text of a `<body>`, or of what stands in its place in a chart, in the language that it is
/// written or drawn in. `name` is what messages call its owner.
BodyText body_text(BodyContext& context, pugi::xml_node body, const std::string& name);

/// What the instructions of a list are read with.
struct ListContext {
    const PlacedFile& file;
    Diagnostics& out;
    const NetworkTypes& types;
    MadeVariables& variables;
};

/// Instructions (IL), whose result is an expression until it is stored.
Excerpts list_text(const ListContext& context, const std::vector<Part>& list);

/// `<SFC>`: steps and transitions; `pou` has those that are named.
BodyText chart_text(BodyContext& context, pugi::xml_node chart, pugi::xml_node pou);

}  // namespace lineshaft::projects
