#pragma once

#include <string>

namespace lineshaft::test {

/// The path of a file of this checkout: in_source("programs/01_first_axis.yaml"). Only its own
/// source file is compiled with the path, so that a compiler cache knows all others again in
/// another checkout.
std::string in_source(const std::string& path);

}  // namespace lineshaft::test
