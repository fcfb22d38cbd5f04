#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lineshaft {

/// The names of a list of signals as users and clients write it: `a.x,table.m[1,2]`. A ',' within
/// brackets stands between indices.
std::vector<std::string> signals_in(std::string_view list);

}  // namespace lineshaft
