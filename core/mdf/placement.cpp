#include "core/mdf/placement.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/vector_relational.hpp>

#include "core/base/error.h"
#include "core/geometry/mesh_check.h"
#include "core/voxels/winding.h"

namespace lumorph {

namespace {

/// All repairs in one sentence.
std::string repairedBy(const std::vector<std::string>& actions) {
    std::string text = "It was no closed solid and has been repaired for matching";
    for (std::size_t k = 0; k < actions.size(); ++k) {
        std::string action = actions[k].substr(0, actions[k].find_last_not_of('.') + 1);
        if (!action.empty()) action[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(action[0])));
        text += (k == 0 ? ": " : "; ") + action;
    }
    return text + ".";
}

} // namespace

bool isClosedSolid(const TriangleMesh& mesh) {
    const MeshReport report = checkMesh(mesh, IntersectionTest::skip);
    return report.closed() && report.manifold();
}

Target makeTarget(TriangleMesh mesh) {
    if (isClosedSolid(mesh)) return {std::move(mesh), true, {}};
    MeshRepair repair = repairMesh(mesh);
    if (repair.after.closed() && repair.after.manifold()) {
        return {std::move(repair.mesh), true, {repairedBy(repair.actions)}};
    }
    Target target{std::move(mesh), false, repair.before.findings()};
    target.warnings.emplace_back("The target is not a closed solid; what counts as inside is estimated by winding "
                                 "numbers, which is slower and may differ near the holes.");
    return target;
}

void voxelizeTarget(const VoxelFrame& frame, const Target& target, SolidVoxelizer& voxelizer, BitColumns& out,
                    const Progress& progress) {
    if (target.closed)
        voxelizer.voxelize(frame, target.mesh.positions, target.mesh.triangles, out);
    else
        out = voxelizeWinding(frame, target.mesh, progress);
}

double shareBeyondFrame(const VoxelFrame& frame, const Target& target, const BitColumns& bits) noexcept {
    const Box box = boundingBox(target.mesh.positions);
    const Box room = frame.box();
    const bool beyond = glm::any(glm::lessThan(box.min, room.min)) || glm::any(glm::greaterThan(box.max, room.max));
    const double volume = std::abs(signedVolume(target.mesh));
    if (!beyond || !target.closed || !(volume > 0.0)) return 0.0;
    return std::clamp(1.0 - static_cast<double>(bits.count()) * frame.voxelVolume() / volume, 0.0, 1.0);
}

glm::mat4 Placement::deviceFromTarget() const {
    glm::mat4 m = glm::translate(glm::mat4(1.0F), translation);
    m = glm::rotate(m, static_cast<float>(yaw.inRadians()), glm::vec3(0.0F, 1.0F, 0.0F));
    if (orientation != glm::quat(1.0F, 0.0F, 0.0F, 0.0F)) m *= glm::mat4_cast(orientation);
    return glm::scale(m, glm::vec3(static_cast<float>(scale)));
}

glm::quat Placement::rotation() const {
    return glm::angleAxis(static_cast<float>(yaw.inRadians()), glm::vec3(0.0F, 1.0F, 0.0F)) * orientation;
}

void placePoints(std::span<const glm::vec3> points, const glm::mat4& deviceFromTarget, std::vector<glm::vec3>& out) {
    out.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) out[i] = glm::vec3(deviceFromTarget * glm::vec4(points[i], 1.0F));
}

TriangleMesh placed(const TriangleMesh& mesh, const Placement& placement) {
    TriangleMesh result;
    placePoints(mesh.positions, placement.deviceFromTarget(), result.positions);
    result.triangles = mesh.triangles;
    return result;
}

Placement fitPlacement(const Field& field, const Box& box, Angle yaw, const glm::quat& orientation) {
    return fitPlacement(field.frame, field.restSurface, box, yaw, orientation);
}

Placement fitPlacement(const VoxelFrame& voxels, float restSurface, const Box& box, Angle yaw,
                       const glm::quat& orientation) {
    Box turned;
    Placement placement{1.0, yaw, glm::vec3(0.0F), orientation};
    const glm::mat4 turn = placement.deviceFromTarget();
    for (int corner = 0; corner < 8 && !box.empty(); ++corner)
        turned.include(
            glm::vec3(turn * glm::vec4(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                       corner & 4 ? box.max.z : box.min.z, 1.0F)));
    const glm::vec3 size = turned.size();
    if (box.empty() || !(std::max({size.x, size.y, size.z}) > 0.0F) || !std::isfinite(size.x + size.y + size.z))
        throw InvalidInput("target", "it has no extent", "give a mesh with a volume");
    const Box frame = voxels.box();
    const glm::vec3 room(frame.max.x - frame.min.x, frame.max.y - restSurface, frame.max.z - frame.min.z);
    if (!(room.y > 0.0F)) throw InvalidInput("frame", "it has no room above the rest surface", "use a rig that lifts");
    double scale = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        if (size[axis] > 0.0F)
            scale = std::min(scale, static_cast<double>(room[axis]) / static_cast<double>(size[axis]));
    placement.scale = scale;
    const glm::vec3 stand = static_cast<float>(scale) * glm::vec3(turned.centre().x, turned.min.y, turned.centre().z);
    placement.translation = glm::vec3(frame.centre().x, restSurface, frame.centre().z) - stand;
    return placement;
}

} // namespace lumorph
