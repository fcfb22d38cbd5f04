#pragma once

#include <memory>
#include <vector>

#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

/// `{unit := 'mm/s'}`, or a comment: what it says, and which token it stands before.
struct Pragma {
    std::size_t before = 0;
    bool first_in_line = false;
    Place place = {};
};

struct Tokens {
    std::shared_ptr<const Source> source;  ///< that all places refer to
    std::vector<Token> tokens;             ///< the last is `end_of_file`
    std::vector<Pragma> pragmas, comments;
    std::vector<std::uint32_t> mistakes;  ///< where something was reported, in bytes
};

/// Takes a text apart, in the dialect of its file; one of the prelude is SCL. Comments are `//`,
/// `(* *)` and `/* */` (the last two nested). What is no token is reported and left out:
///   L0901  a character of no token, a comment or text that does not end
///   L0109  a character that only looks like one of the keyboard
Tokens read_tokens(const std::shared_ptr<const SourceFile>& file, Diagnostics& out,
                   SourceKind kind = SourceKind::program);

}  // namespace lineshaft::st
