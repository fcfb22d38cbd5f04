#pragma once

#include <cstddef>
#include <vector>

#include "blocks/path/path.hpp"
#include "tests/blocks/path/path_random.hpp"

namespace lineshaft::test {

/// Curves behind each other, each with its limits and the joint before it.
struct RandomPath {
    std::vector<PathCurve> curves;
    std::vector<PathLimits> limits;
    std::vector<PathJoint> joints;
};

/// Lines, arcs and splines, some lines cut in two, so that there are smooth joints.
RandomPath random_path(Random& random, std::size_t most);

/// It has the length 1, in a plane or in space.
PathVector random_direction(Random& random, std::size_t axes);

}  // namespace lineshaft::test
