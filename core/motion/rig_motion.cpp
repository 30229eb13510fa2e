#include "core/motion/rig_motion.h"

namespace lumorph {

std::vector<MotionLimits> motionLimits(const Rig& rig) {
    std::vector<MotionLimits> limits;
    limits.reserve(rig.actuatorCount());
    for (const Actuator& actuator : rig.actuators()) {
        MotionLimits limit;
        limit.maxVelocity = actuator.maxVelocity;
        limit.dampingRatio = actuator.dampingRatio;
        limits.push_back(limit);
    }
    return limits;
}

} // namespace lumorph
