#pragma once

#include <string>

namespace lineshaft {

/// A picture, or why there is none.
struct Picture {
    std::string bytes;
    std::string error;  ///< empty when all is well
};

/// What gnuplot writes to its standard output when it is given `script`. Its own messages go to
/// the standard error.
Picture run_gnuplot(const std::string& script);

/// In single quotes, where gnuplot takes every character as it is; line ends become blanks.
std::string gnuplot_text(std::string text);

}  // namespace lineshaft
