#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/st/library/compiled.hpp"
#include "tools/lineshaft/lsp/requests.hpp"

namespace lineshaft::lsp {

/// What the names in the Structured Text of a root mean.
struct Meaning {
    st::Compiled compiled = {};
    std::vector<st::NameUse> uses = {};

    /// The use of the name at a byte of a file; null: there is none.
    const st::NameUse* find(const Asked& where) const;
    /// The block, function, method or program that the byte stands in; null: none.
    const st::Routine* routine_at(const Asked& where) const;
    const st::Routine* find_block(std::string_view name) const;
};

std::shared_ptr<const Meaning> meaning_of(Session& session, const std::string& root);

/// What the text means now, else as it last was when nothing in it was lost.
std::shared_ptr<const Meaning> whole_meaning_of(Session& session, const std::string& root);

bool is_in(const st::Place& place, const std::string& path);

/// Where a byte of a file stands in a text that was put together of it; empty: it is not in that.
std::optional<std::size_t> offset_in(const SourceFile& source, const Asked& where);

/// A declaration as the editor shows it: `speed : REAL (VAR_INPUT)`, unit, value, what comments
/// say.
std::string about(const st::NameUse& use);

/// `FUNCTION Clamp(x : REAL; limit : REAL) : REAL`
std::string signature_of(const st::Routine& routine);
/// Inputs and outputs, in their order.
std::vector<const st::Variable*> parameters_of(const st::Routine& routine);

}  // namespace lineshaft::lsp
