#include "runtime/names/left_out.hpp"

#include <fmt/format.h>

#include "runtime/source/codes.hpp"
#include "runtime/st/library/shortened.hpp"

namespace lineshaft {

bool refuse_left_out(const Reader& read, const Node& node, const Instance& block,
                     std::string_view port) {
    if (st::find_shortened(*block.type, port).empty()) return false;
    read.fail(code::unknown_port, node,
              fmt::format("'{}.{}' is not known here: of a block's arrays {} elements are, of its "
                          "instances and structures {} parts",
                          block.name, port, st::most_elements, st::most_parts),
              fmt::format("give {} a variable of its own with that value, and name it",
                          block.type->name));
    return true;
}

}  // namespace lineshaft
