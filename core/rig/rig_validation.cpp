#include "core/rig/rig_validation.h"

#include <cmath>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/motion_setup.h"

namespace lumorph {
namespace {

// What is farther away would be beyond the numbers of a pose once it is turned and multiplied.
constexpr double kFar = 1e6;

bool within(double value) { return std::abs(value) <= kFar; } // false for what is no number
bool within(const glm::vec3& v) {
    return within(static_cast<double>(v.x)) && within(static_cast<double>(v.y)) && within(static_cast<double>(v.z));
}

void require(bool good, const std::string& subject, const char* why, const char* remedy) {
    if (!good) throw InvalidInput(subject, why, remedy);
}

void requireText(const std::string& text, const std::string& subject, const char* why) {
    require(isUtf8(text), subject, why, "write it in UTF-8, for example in plain letters");
}

void requireAxis(const glm::vec3& axis, const std::string& subject, const char* what) {
    require(within(axis) && glm::length(axis) > 1e-6F, subject, what,
            "give three numbers of at most a million, not all zero");
}

void requirePlace(const glm::vec3& origin, const std::string& subject) {
    require(within(origin), subject, "the origin is not finite, or farther than 1,000 km away",
            "give three numbers in metres");
}

void requireRange(double min, double max, const std::string& subject) {
    require(within(min) && within(max), subject, "the range is not finite, or beyond all measure",
            "give two numbers of at most a million");
    require(min < max, subject, "the range is empty or runs backwards",
            "put the smaller number first; to move the other way turn the axis round");
}

void requireTurn(double min, double max, const std::string& subject) {
    requireRange(min, max, subject);
    require(max - min <= 2.0 * std::numbers::pi + 1e-9, subject, "the range is more than a full turn",
            "use at most 360 degrees");
}

struct DeformerCheck {
    const RigParts& parts;
    const Actuator& actuator;
    const std::string& subject;

    void operator()(const Hinge& hinge) const {
        requireAxis(hinge.axis, subject, "the axis has no direction");
        requirePlace(hinge.origin, subject);
        requireTurn(hinge.min.inRadians(), hinge.max.inRadians(), subject);
    }
    void operator()(const Bend& bend) const {
        requireAxis(bend.axis, subject, "the axis has no direction");
        requireAxis(bend.direction, subject, "the direction to the free end is missing");
        requirePlace(bend.origin, subject);
        require(std::abs(glm::dot(glm::normalize(bend.axis), glm::normalize(bend.direction))) < 1e-3F, subject,
                "axis and direction are not perpendicular", "let the direction point straight away from the bend line");
        require(within(bend.length) && bend.length > 1e-6, subject, "the arc has no length",
                "give the length of the arc in metres, or use a hinge");
        requireTurn(bend.min.inRadians(), bend.max.inRadians(), subject);
        require(bend.min.inRadians() == 0.0, subject, "the range of a bend does not start at 0",
                "draw the sheet flat and start at 0; to bend the other way turn the axis round");
    }
    void operator()(const Slide& slide) const {
        requireAxis(slide.direction, subject, "the direction is zero");
        requireRange(slide.min, slide.max, subject);
    }
    void operator()(const MorphTarget& morph) const {
        requireText(morph.target, subject, "the name of the morph target is no text");
        require(!morph.keys.empty() && morph.keys.size() == morph.displacements.size(), subject,
                "the morph target has no keys or not one set of displacements a key",
                "give displacements for every key");
        float last = 0.0F;
        for (const float key : morph.keys) {
            require(key > last && key <= 1.0F, subject, "the keys are not ascending within 0 and 1", "sort the keys");
            last = key;
        }
        for (const auto& displacements : morph.displacements) {
            require(displacements.size() == actuator.influences.size(), subject,
                    "there is not one displacement an influence", "give each influenced vertex its displacement");
            for (const glm::vec3& d : displacements)
                require(within(d), subject, "a displacement is not finite, or beyond all measure",
                        "export the shape again");
        }
    }
    void operator()(const SkinJoint& joint) const {
        require(parts.skeleton.has_value(), subject, "the rig has no skeleton", "give the model a skin");
        require(joint.joint >= 0 && static_cast<std::size_t>(joint.joint) < parts.skeleton->joints.size(), subject,
                "the joint does not exist", "name a joint of the skin");
        requireAxis(joint.axis, subject, "the axis has no direction");
        if (joint.motion == SkinJoint::Motion::rotate)
            requireTurn(joint.min, joint.max, subject);
        else
            requireRange(joint.min, joint.max, subject);
    }
    void operator()(const SheetLift& lift) const {
        require(parts.sheet.has_value(), subject, "the rig has no sheet that it could lift",
                "give the rig the modes of its sheet, or use another deformer");
        require(lift.axis >= 0 && static_cast<std::size_t>(lift.axis) < parts.sheet->modes.strokes.size(), subject,
                "the sheet's grid has no such axis", "count the axes from 0");
        require(actuator.influences.empty(), subject, "a lever of the sheet has influences",
                "leave them out: what follows it is the sheet's");
        requireTurn(lift.min.inRadians(), lift.max.inRadians(), subject);
        require(lift.torque >= 0.0 && std::isfinite(lift.torque), subject, "its torque is no positive number",
                "give it in newton metres");
    }
};

void checkActuator(const RigParts& parts, const Actuator& actuator, const std::string& subject) {
    std::visit(DeformerCheck{parts, actuator, subject}, actuator.deformer);
    const std::size_t vertices = parts.restMesh.positions.size();
    for (std::size_t i = 0; i < actuator.influences.size(); ++i) {
        const Influence& influence = actuator.influences[i];
        require(influence.vertex < vertices, subject, "an influence names a vertex that does not exist",
                "use vertices of the rest mesh");
        require(i == 0 || actuator.influences[i - 1].vertex < influence.vertex, subject,
                "the influences are not ascending by vertex", "sort them and name each vertex once");
        require(influence.weight >= 0.0F && influence.weight <= 1.0F, subject, "an influence is not within 0 and 1",
                "use weights from 0 to 1");
    }
    require(actuator.levels >= 2 && actuator.levels <= kMaxLevels, subject, "the level count is out of range",
            "use 2 to 200 levels");
    // As far as the motion after it goes.
    require(actuator.maxVelocity > 0.0, subject, "the maximum velocity is not a positive number",
            "give the speed of the servo");
    require(actuator.maxVelocity >= 1e-6 && actuator.maxVelocity <= 1e6, subject,
            "the maximum velocity is that of no servo", "use 1e-6 to 1e6 strokes a second");
    require(actuator.dampingRatio >= 1.0, subject, "the damping ratio is below 1, so that the device would oscillate",
            "use 1 (critical) or more");
    require(actuator.dampingRatio <= 1e3, subject, "the damping ratio is so large that the device would stand still",
            "use 1 (critical) to 1000");
    require(std::isfinite(actuator.drive.pulseMin) && std::isfinite(actuator.drive.pulseMax), subject,
            "a pulse width is not finite", "give microseconds, for example 1000 and 2000");
    require(isPulseCurve(actuator.drive.curve), subject, "its pulse curve does not rise from 0 to 1",
            "give 2 to 65 numbers, each greater than the one before");
    requireText(actuator.drive.servo, subject, "the name of its servo is no text");
}

void checkSkeleton(const Skeleton& skeleton, std::size_t vertices) {
    const std::string subject = "skeleton";
    require(skeleton.joints.size() <= kMaxJoints, subject, "there are more than 256 joints",
            "remove joints that move nothing");
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const Skeleton::Joint& joint = skeleton.joints[j];
        require(joint.parent < static_cast<int>(j), subject, "a joint stands before its parent", "put parents first");
        const glm::mat3 m(joint.localRest);
        const float scale = glm::length(m[0]);
        const glm::mat3 gram = glm::transpose(m) * m;
        require(scale > 1e-6F && within(static_cast<double>(scale)) && within(glm::vec3(joint.localRest[3])), subject,
                "a joint's place is not finite or its scale is zero", "export the model again");
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                require(std::abs(gram[column][row] - (row == column ? scale * scale : 0.0F)) < 1e-3F * scale * scale,
                        subject, "a joint is sheared or scaled unevenly", "apply the scale in the modelling tool");
    }
    require(skeleton.vertexJoints.size() == vertices && skeleton.vertexWeights.size() == vertices, subject,
            "there is not one set of joints and weights a vertex", "give every vertex its joints and weights");
    for (std::size_t v = 0; v < vertices; ++v) {
        float sum = 0.0F;
        for (int k = 0; k < 4; ++k) {
            const float weight = skeleton.vertexWeights[v][k];
            require(weight >= 0.0F, subject, "a skin weight is negative or not a number", "normalise the weights");
            require(weight == 0.0F || skeleton.vertexJoints[v][k] < skeleton.joints.size(), subject,
                    "a vertex names a joint that does not exist", "export the model again");
            sum += weight;
        }
        require(std::abs(sum - 1.0F) < 1e-3F, subject, "the skin weights of a vertex do not add up to 1",
                "normalise the weights");
    }
}

void checkModes(const SheetModes& modes, const std::string& subject) {
    require(!modes.strokes.empty() && modes.strokes.size() <= SheetModes::kMostActuators, subject,
            "its grid has no axes, or more than 8", "give it one axis a lever");
    for (const std::vector<float>& nodes : modes.strokes) {
        const char* const remedy = "give each axis 2 to 5 strokes from 0 to 1, for example 0, 0.5, 1";
        require(nodes.size() >= 2 && nodes.size() <= SheetModes::kMostLevels, subject,
                "an axis has fewer than 2 strokes or more than 5", remedy);
        require(nodes.front() == 0.0F && nodes.back() == 1.0F, subject, "the strokes of an axis do not go from 0 to 1",
                remedy);
        for (std::size_t i = 1; i < nodes.size(); ++i)
            require(nodes[i] - nodes[i - 1] >= 0.0099F, subject,
                    "the strokes of an axis are not ascending, or closer than 0.01", remedy);
    }
    require(modes.modeCount >= 1 && modes.modeCount <= SheetModes::kMostModes, subject,
            "it has no modes, or more than 64", "keep the modes with the largest singular values");
    const std::size_t states = modes.stateCount();
    require(states * modes.modeCount <= SheetModes::kMostCoefficients, subject, "it has more than 65,536 coefficients",
            "keep fewer modes, or a coarser grid");
    require(modes.coefficients.size() == states * modes.modeCount, subject,
            "there is not one coefficient a state and mode", "give the coefficients of all states of the grid");
    for (std::size_t i = 0; i < modes.coefficients.size(); ++i) {
        require(within(static_cast<double>(modes.coefficients[i])), subject,
                "a coefficient is not finite, or beyond all measure", "compute the modes again");
        require(i >= modes.modeCount || modes.coefficients[i] == 0.0F, subject,
                "a coefficient of the state of rest is not 0",
                "let the modes displace the sheet from its shape at rest");
    }
    require(!modes.modes.empty() && modes.modes.size() % modes.modeCount == 0, subject,
            "there is not one displacement a row and mode", "give each row its displacement in every mode");
    for (const glm::vec3& mode : modes.modes)
        require(within(mode), subject, "a displacement is not finite, or beyond all measure",
                "compute the modes again");
}

void checkFollowers(const SheetMotion& motion, std::size_t vertices, const std::string& subject) {
    require(motion.followers.size() == vertices, subject, "there is not one row and share a vertex",
            "give every vertex its row, or none");
    std::vector<bool> followed(motion.modes.rowCount(), false);
    std::set<float> shares;
    for (const SheetMotion::Follower& follower : motion.followers) {
        require(follower.share > 0.0F && follower.share <= 1.0F, subject, "the share of a path is not within 0 and 1",
                "use shares above 0, up to 1");
        if (follower.row == SheetMotion::kNoRow) continue;
        require(follower.row < followed.size(), subject, "a vertex follows a row that does not exist",
                "use rows of the modes");
        followed[follower.row] = true;
        shares.insert(follower.share);
        require(shares.size() <= SheetMotion::kMostShares, subject, "paths have more than 64 different shares",
                "use the same shares all around the rim");
    }
    for (const bool one : followed)
        require(one, subject, "no vertex follows one of its rows", "leave the row out, or let a vertex follow it");
}

/// One lever an axis, and nothing else that moves what follows the sheet.
void checkLevers(const RigParts& parts, const std::string& rig, const std::string& subject) {
    std::vector<bool> driven(parts.sheet->modes.strokes.size(), false);
    for (const Actuator& actuator : parts.actuators) {
        const std::string name = rig + ", actuator " + inQuotes(actuator.name);
        if (const auto* lift = std::get_if<SheetLift>(&actuator.deformer)) {
            const auto axis = static_cast<std::size_t>(lift->axis);
            require(!driven[axis], name, "another lever drives the same axis of the sheet's grid",
                    "give each axis one lever");
            driven[axis] = true;
        }
        for (const Influence& influence : actuator.influences)
            require(influence.weight == 0.0F || parts.sheet->followers[influence.vertex].row == SheetMotion::kNoRow,
                    name, "it moves vertices that follow the sheet",
                    "let the sheet's vertices follow its levers alone");
    }
    for (std::size_t axis = 0; axis < driven.size(); ++axis)
        if (!driven[axis])
            throw InvalidInput(subject, "no lever drives axis " + std::to_string(axis) + " of its grid",
                               "give each axis one lever");
}

} // namespace

void validate(const RigParts& parts) {
    const std::string rig = parts.name.empty() ? "rig" : parts.name;
    if (!isUtf8(rig)) throw InvalidInput(inQuotes(rig), "the name is no text", "rename the file");
    require(!parts.restMesh.positions.empty() && !parts.restMesh.triangles.empty(), rig, "the mesh is empty",
            "give the device a closed mesh");
    for (const glm::vec3& p : parts.restMesh.positions)
        require(within(p), rig, "a vertex is not finite, or farther than 1,000 km away", "export the mesh again");
    for (const glm::uvec3& t : parts.restMesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            require(t[corner] < parts.restMesh.positions.size(), rig, "a triangle names a vertex that does not exist",
                    "export the mesh again");
    require(parts.actuators.size() <= kMaxActuators, rig, "there are more than 65,000 actuators",
            "join actuators that move together");
    if (parts.skeleton) checkSkeleton(*parts.skeleton, parts.restMesh.positions.size());
    const std::string sheet = rig + ", sheet";
    if (parts.sheet) {
        require(!parts.skeleton, sheet, "the rig has a skeleton too", "use one of the two");
        checkModes(parts.sheet->modes, sheet);
        checkFollowers(*parts.sheet, parts.restMesh.positions.size(), sheet);
    }
    std::set<std::string> names;
    for (const Actuator& actuator : parts.actuators) {
        require(!actuator.name.empty(), rig, "an actuator has no name", "give every actuator a name");
        if (!isUtf8(actuator.name))
            throw InvalidInput(rig + ", actuator " + inQuotes(actuator.name), "the name is no text",
                               "give it a name in plain letters");
        const std::string subject = rig + ", actuator \"" + actuator.name + "\"";
        require(names.insert(actuator.name).second, subject, "the name is used twice",
                "give every actuator a name of its own");
        checkActuator(parts, actuator, subject);
    }
    if (parts.sheet) checkLevers(parts, rig, sheet);
}

} // namespace lumorph
