#pragma once

#include <set>

#include "tools/lineshaft/lsp/meanings.hpp"

namespace lineshaft::lsp {

/// Where a name is written, without the quotes or the `#` around it.
struct Reference {
    Mark mark;
    bool operator<(const Reference& other) const;
};

/// The name at that place, likewise.
Mark mark_of_name(const st::Place& name);
std::string text_of_name(const st::Place& name);

/// Where the folders' files, those of programs too, have a name.
struct References {
    std::set<Reference> places = {};
    std::vector<std::shared_ptr<const Meaning>> meanings = {};  ///< of roots that have some
};

/// Uses of what a use in `meaning` is about. A method shares its name with those that it replaces
/// or implements, and those that do so with it; each of its parameters likewise.
References references_to(Session& session, const Meaning& meaning, const st::NameUse& use);

}  // namespace lineshaft::lsp
