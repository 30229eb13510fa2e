#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/model.h"
#include "core/rig/rig_extras.h"

namespace lumorph {

/// The joints of a model's skins as one skeleton, at the pose that is the rig's rest.
struct JointTable {
    std::vector<Skeleton::Joint> joints;
    std::vector<int> jointOfNode;  ///< one a node; -1 for none
    std::vector<glm::mat4> placed; ///< deviceFromJoint at rest
    int fixed = -1;                ///< a joint for what follows none; it never moves

    [[nodiscard]] bool empty() const noexcept { return joints.empty(); }
    /// The nearest joint at or above a node, or the fixed one.
    [[nodiscard]] int above(const Model& model, int node) const noexcept;
};

/// Joints of all skins in the scene, at the pose as drawn. Throws DataError when there are too many.
[[nodiscard]] JointTable tableOfJoints(const Model& model, const std::string& file);

/// Joints that an animation turns, as actuators over the range it uses, about the axis of its widest turn.
[[nodiscard]] std::vector<ActuatorEntry> jointsOfAnimations(const Model& model, const std::string& file,
                                                            const JointTable& table);
/// All other joints, as actuators that turn about their own X axis by 45 degrees from the pose as drawn.
[[nodiscard]] std::vector<ActuatorEntry> jointsAtRest(const Model& model, const std::string& file,
                                                      const JointTable& table,
                                                      const std::vector<ActuatorEntry>& animated);
/// Sets the table to the lower end of the range of each of these joints.
void restAtLowerEnds(const std::vector<ActuatorEntry>& entries, JointTable& table);

/// Gathers the model's meshes into one, in device coordinates, with the skin and the influences of
/// the actuators, whose entries it completes. Throws DataError.
[[nodiscard]] RigParts gatherParts(const Model& model, const std::string& file, std::vector<ActuatorEntry> entries,
                                   const JointTable& table);

} // namespace lumorph
