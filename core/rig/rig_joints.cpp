#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "core/base/error.h"
#include "core/rig/motion_setup.h"
#include "core/rig/rig_document.h"

namespace lumorph {
namespace {

const Angle kUsualTurn = Angle::degrees(45.0); ///< of a joint whose range nothing tells

glm::mat4 localTransform(const Model::Node& node) {
    if (node.matrix) return *node.matrix;
    return glm::scale(glm::translate(glm::mat4(1.0F), node.translation) * glm::mat4_cast(node.rotation), node.scale);
}

void place(JointTable& table) {
    table.placed.clear();
    for (const Skeleton::Joint& joint : table.joints)
        table.placed.push_back(joint.parent < 0 ? joint.localRest : table.placed[joint.parent] * joint.localRest);
}

/// How an animation turns one joint away from the pose as drawn: the axis of its widest turn and the
/// angles about it.
struct Turning {
    glm::vec3 axis{0.0F};
    double min = 0.0;
    double max = 0.0;
};

Turning turningOf(const Model::Node& node, const std::vector<const Model::Channel*>& channels) {
    std::vector<glm::dquat> turns;
    for (const Model::Channel* channel : channels) {
        const bool cubic = channel->interpolation == Model::Interpolation::cubicSpline;
        const std::size_t stride = cubic ? 12 : 4;
        const std::size_t skip = cubic ? 4 : 0; // a spline's key stands between its tangents
        for (std::size_t k = 0; (k + 1) * stride <= channel->values.size(); ++k) {
            const float* const v = channel->values.data() + k * stride + skip;
            glm::dquat turn =
                glm::inverse(glm::dquat(node.rotation)) * glm::normalize(glm::dquat(v[3], v[0], v[1], v[2]));
            turns.push_back(turn.w < 0.0 ? -turn : turn);
        }
    }
    Turning turning;
    double widest = 0.0;
    for (const glm::dquat& turn : turns) {
        const glm::dvec3 way(turn.x, turn.y, turn.z);
        if (glm::length(way) <= widest) continue;
        widest = glm::length(way);
        turning.axis = glm::vec3(way / widest);
    }
    if (widest < 1e-4) return {};
    for (const glm::dquat& turn : turns) {
        const double angle =
            2.0 * std::atan2(glm::dot(glm::dvec3(turn.x, turn.y, turn.z), glm::dvec3(turning.axis)), turn.w);
        turning.min = std::min(turning.min, angle);
        turning.max = std::max(turning.max, angle);
    }
    // An angle that is rounding only must not shift the rest pose.
    if (turning.min > -1e-5) turning.min = 0.0;
    return turning;
}

ActuatorEntry jointEntry(const Model& model, const std::string& file, std::size_t node, const SkinJoint& joint) {
    ActuatorEntry entry;
    entry.node = static_cast<int>(node);
    entry.actuator.name = model.nodes[node].name.empty() ? "joint " + std::to_string(node) : model.nodes[node].name;
    entry.place = {file, "joint \"" + entry.actuator.name + "\""};
    entry.actuator.deformer = joint;
    return entry;
}

} // namespace

int JointTable::above(const Model& model, int node) const noexcept {
    for (; node >= 0; node = model.nodes[node].parent)
        if (jointOfNode[node] >= 0) return jointOfNode[node];
    return fixed;
}

namespace {

/// Of the scene's nodes those that are in it; a file may hold other scenes beside it.
std::vector<bool> nodesShown(const Model& model) {
    std::vector<bool> shown(model.nodes.size(), false);
    for (const int root : model.roots) shown[root] = true;
    for (std::size_t n = 0; n < shown.size(); ++n) // a parent stands before its children
        if (model.nodes[n].parent >= 0 && shown[model.nodes[n].parent]) shown[n] = true;
    return shown;
}

} // namespace

JointTable tableOfJoints(const Model& model, const std::string& file) {
    JointTable table;
    std::vector<bool> isJoint(model.nodes.size(), false);
    const std::vector<bool> shown = nodesShown(model);
    bool unskinned = false;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        const Model::Node& node = model.nodes[n];
        if (node.mesh < 0 || !shown[n]) continue;
        if (node.skin < 0)
            unskinned = true;
        else
            for (const int joint : model.skins[node.skin].joints) isJoint[joint] = true;
    }
    table.jointOfNode.assign(model.nodes.size(), -1);
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        if (!isJoint[n]) continue;
        Skeleton::Joint joint;
        joint.localRest = localTransform(model.nodes[n]);
        int ancestor = model.nodes[n].parent;
        for (; ancestor >= 0 && !isJoint[ancestor]; ancestor = model.nodes[ancestor].parent)
            joint.localRest = localTransform(model.nodes[ancestor]) * joint.localRest;
        joint.parent = ancestor < 0 ? -1 : table.jointOfNode[ancestor];
        table.jointOfNode[n] = static_cast<int>(table.joints.size());
        table.joints.push_back(joint);
    }
    if (table.empty()) return table;
    if (unskinned) {
        table.fixed = static_cast<int>(table.joints.size());
        table.joints.emplace_back();
    }
    if (table.joints.size() > kMaxJoints)
        throw DataError(file, "the skin has more than 256 joints", "remove joints that move nothing");
    place(table);
    return table;
}

std::vector<ActuatorEntry> jointsOfAnimations(const Model& model, const std::string& file, const JointTable& table) {
    std::vector<ActuatorEntry> entries;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        if (table.jointOfNode[n] < 0) continue;
        std::vector<const Model::Channel*> channels;
        for (const Model::Animation& animation : model.animations)
            for (const Model::Channel& channel : animation.channels)
                if (channel.node == static_cast<int>(n) && channel.path == Model::Path::rotation)
                    channels.push_back(&channel);
        const Turning turning = turningOf(model.nodes[n], channels);
        if (!(turning.min < turning.max)) continue;
        entries.push_back(jointEntry(
            model, file, n, {table.jointOfNode[n], SkinJoint::Motion::rotate, turning.axis, turning.min, turning.max}));
    }
    return entries;
}

std::vector<ActuatorEntry> jointsAtRest(const Model& model, const std::string& file, const JointTable& table,
                                        const std::vector<ActuatorEntry>& animated) {
    std::vector<ActuatorEntry> entries;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        const auto isThis = [n](const ActuatorEntry& entry) { return entry.node == static_cast<int>(n); };
        if (table.jointOfNode[n] < 0 || std::ranges::any_of(animated, isThis)) continue;
        entries.push_back(jointEntry(
            model, file, n,
            {table.jointOfNode[n], SkinJoint::Motion::rotate, {1.0F, 0.0F, 0.0F}, 0.0, kUsualTurn.inRadians()}));
    }
    return entries;
}

void restAtLowerEnds(const std::vector<ActuatorEntry>& entries, JointTable& table) {
    for (const ActuatorEntry& entry : entries) {
        const auto* joint = std::get_if<SkinJoint>(&entry.actuator.deformer);
        if (joint == nullptr || joint->min == 0.0) continue;
        glm::mat4& rest = table.joints[joint->joint].localRest;
        rest = glm::rotate(rest, static_cast<float>(joint->min), joint->axis);
    }
    if (!table.empty()) place(table);
}

} // namespace lumorph
