#pragma once

#include <optional>
#include <string>

#include "tools/lineshaft/lsp/session.hpp"

/// What an editor asks of a place or a file; each takes the request's parameters and gives its
/// result, null for nothing.
namespace lineshaft::lsp {

/// Where in which file a request is about.
struct Asked {
    std::string path;
    std::string text;
    std::size_t offset = 0;
};
/// Empty: the file is not open and cannot be read.
std::optional<Asked> asked(const Session& session, const Json& params);

Json document_symbols(Session& session, const Json& params);
Json folding_ranges(Session& session, const Json& params);
Json hover(Session& session, const Json& params);
Json completion(Session& session, const Json& params);
Json signature_help(Session& session, const Json& params);
Json definition(Session& session, const Json& params);
Json references(Session& session, const Json& params);
Json prepare_rename(Session& session, const Json& params);
Json rename(Session& session, const Json& params);
Json code_actions(Session& session, const Json& params);
Json formatting(Session& session, const Json& params);
Json code_lenses(Session& session, const Json& params);

/// A name that cannot be changed to another; the text says why.
struct RefusedName {
    std::string why;
};

}  // namespace lineshaft::lsp
