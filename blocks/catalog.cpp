#include "blocks/catalog.hpp"

#include "blocks/axis/gear_axis.hpp"
#include "blocks/axis/move.hpp"
#include "blocks/axis/simulated_drive.hpp"
#include "blocks/axis/virtual_axis.hpp"
#include "blocks/circle/circle_fit.hpp"
#include "blocks/circle/circle_ratio.hpp"
#include "blocks/circle/path_circle.hpp"
#include "blocks/pulse/constant_jerk_line.hpp"
#include "blocks/pulse/pto.hpp"

namespace lineshaft {

Catalog standard_blocks() {
    Catalog blocks;
    blocks.add<VirtualAxis>();
    blocks.add<GearAxis>();
    blocks.add<Move>();
    blocks.add<SimulatedDrive>();
    blocks.add<CircleRatio>();
    blocks.add<CircleFit>();
    blocks.add<PathCircle>();
    blocks.add<Pto>();
    blocks.add<ConstantJerkLine>();
    return blocks;
}

}  // namespace lineshaft
