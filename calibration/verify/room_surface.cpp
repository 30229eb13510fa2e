#include "calibration/verify/room_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "calibration/lab/lab_world.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kStrokeStep = 0.01; // by which the surface's motion is found

/// How all vertices move with one stroke.
std::vector<glm::vec3> motionOf(const Installation& room, const Rig& rig, std::vector<double> strokes,
                                std::size_t actuator) {
    const double at = strokes[actuator];
    const double low = std::max(0.0, at - kStrokeStep), high = std::min(1.0, at + kStrokeStep);
    const std::span<const std::uint32_t> vertices = rig.verticesOf(actuator);
    std::vector<glm::vec3> below(vertices.size()), above(vertices.size());
    strokes[actuator] = low;
    rig.deform(strokes, vertices, below);
    strokes[actuator] = high;
    rig.deform(strokes, vertices, above);
    std::vector<glm::vec3> all(rig.restMesh().positions.size(), glm::vec3(0.0F));
    const glm::mat3 turn(room.worldFromDevice);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        all[vertices[i]] = turn * (above[i] - below[i]) / static_cast<float>(high - low);
    return all;
}

/// Shares of a triangle's corners at a point in its plane.
glm::dvec3 barycentric(const TriangleMesh& mesh, std::uint32_t triangle, const glm::dvec3& point) {
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double area = glm::dot(normal, normal);
    if (!(area > 0.0)) return {1.0, 0.0, 0.0};
    const double v = glm::dot(glm::cross(point - a, c - a), normal) / area;
    const double w = glm::dot(glm::cross(b - a, point - a), normal) / area;
    return {1.0 - v - w, v, w};
}

glm::dvec3 mixed(const std::vector<glm::vec3>& values, const glm::uvec3& corners, const glm::dvec3& shares) {
    return shares.x * glm::dvec3(values[corners.x]) + shares.y * glm::dvec3(values[corners.y]) +
           shares.z * glm::dvec3(values[corners.z]);
}

double strokeOf(const MeasuredServo& servo, double commanded, StrokesFrom from) {
    const auto real = [from](const MeasuredServo::Point& p) {
        return from == StrokesFrom::below ? p.rising : 0.5 * (p.rising + p.falling);
    };
    if (servo.points.empty()) return commanded;
    const auto after = std::ranges::lower_bound(servo.points, commanded, {}, &MeasuredServo::Point::commanded);
    if (after == servo.points.begin()) return real(servo.points.front());
    if (after == servo.points.end()) return real(servo.points.back());
    const auto before = std::prev(after);
    const double share = (commanded - before->commanded) / (after->commanded - before->commanded);
    return real(*before) + share * (real(*after) - real(*before));
}

} // namespace

RoomSurface::RoomSurface(const Installation& room, const Rig& rig, std::span<const double> strokes)
    : table_(tableMesh(room.tableSize)) {
    const bool sound = strokes.size() == rig.actuatorCount() &&
                       std::ranges::all_of(strokes, [](double s) { return s >= 0.0 && s <= 1.0; });
    if (!sound)
        throw InvalidInput("strokes of the device", "they are not one number from 0 to 1 for each of its actuators",
                           "give " + std::to_string(rig.actuatorCount()) + " of them");
    device_ = deviceMesh(room, rig, strokes);
    if (rig.actuatorCount() <= kMostServos)
        for (std::size_t i = 0; i < rig.actuatorCount(); ++i)
            byStroke_.push_back(motionOf(room, rig, {strokes.begin(), strokes.end()}, i));
    LabWorld world;
    world.surfaces = {{device_, glm::vec3(1.0F)}, {table_, glm::vec3(1.0F)}};
    lab_ = std::make_shared<const Lab>(std::move(world));
}

std::optional<SurfacePoint> RoomSurface::trace(const glm::dvec3& origin, const glm::dvec3& direction) const {
    const std::optional<Lab::Hit> hit = lab_->trace(origin, direction);
    if (!hit) return std::nullopt;
    return SurfacePoint{hit->surface == 0, hit->triangle, hit->point, hit->normal};
}

bool RoomSurface::sees(const SurfacePoint& from, const glm::dvec3& place) const {
    return lab_->sees(from.point, from.normal, place);
}

std::vector<glm::dvec3> RoomSurface::velocities(const SurfacePoint& at) const {
    std::vector<glm::dvec3> all(byStroke_.size(), glm::dvec3(0.0));
    if (!at.isOnDevice) return all;
    const glm::dvec3 shares = barycentric(device_, at.triangle, at.point);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = mixed(byStroke_[i], device_.triangles[at.triangle], shares);
    return all;
}

SurfacePoint RoomSurface::counterpart(const RoomSurface& other, const SurfacePoint& there) const {
    const TriangleMesh& mine = meshOf(there);
    const TriangleMesh& theirs = other.meshOf(there);
    const auto normalOf = [&there](const TriangleMesh& mesh) {
        const glm::uvec3& t = mesh.triangles[there.triangle];
        const glm::dvec3 a(mesh.positions[t.x]);
        return glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
    };
    SurfacePoint here = there;
    here.point =
        mixed(mine.positions, mine.triangles[there.triangle], barycentric(theirs, there.triangle, there.point));
    const glm::dvec3 normal = normalOf(mine);
    const double side = glm::dot(normalOf(theirs), there.normal) > 0.0 ? 1.0 : -1.0;
    if (glm::length(normal) > 0.0) here.normal = side * glm::normalize(normal);
    return here;
}

std::vector<double> standingStrokes(const Installation& room, const Rig& rig, std::span<const double> commanded,
                                    StrokesFrom from) {
    std::vector<double> strokes(commanded.begin(), commanded.end());
    for (std::size_t i = 0; i < std::min(strokes.size(), rig.actuatorCount()); ++i) {
        const auto servo = std::ranges::find(room.servos, rig.actuators()[i].name, &MeasuredServo::actuator);
        if (servo != room.servos.end()) strokes[i] = strokeOf(*servo, strokes[i], from);
        strokes[i] = std::clamp(strokes[i], 0.0, 1.0);
    }
    return strokes;
}

} // namespace lumorph
