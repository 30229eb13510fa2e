#include "calibration/budget/slip_model.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "calibration/solve/projection.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastCosine = 0.3; // of sight and light that graze less than this is said
constexpr double kNear = 5e-4;       // metres: a ray that is meant for a place and meets one so near has met it
constexpr double kFloatsMost = 0.2;  // metres

Vector3d vectorOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Places spread over the mesh by area, the same each time.
std::vector<glm::dvec3> placesOn(const TriangleMesh& mesh, std::size_t count) {
    std::vector<double> areas; // summed up
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        sum += 0.5 * glm::length(glm::cross(b - a, c - a));
        areas.push_back(sum);
    }
    std::vector<glm::dvec3> places;
    constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532; // the plane's golden ratios
    for (std::size_t k = 0; k < count && sum > 0.0; ++k) {
        const double at = sum * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
        const auto found = std::ranges::lower_bound(areas, at);
        const glm::uvec3& t = mesh.triangles[static_cast<std::size_t>(found - areas.begin())];
        double u = std::fmod(static_cast<double>(k) * kFirst, 1.0),
               v = std::fmod(static_cast<double>(k) * kSecond, 1.0);
        if (u + v > 1.0) {
            u = 1.0 - u;
            v = 1.0 - v;
        }
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        places.push_back(a + u * (b - a) + v * (c - a));
    }
    return places;
}

bool isInImage(const CalibratedCamera& camera, const glm::dvec3& place) {
    const std::optional<glm::dvec2> pixel = pixelOf(camera, place);
    return pixel && pixel->x >= -0.5 && pixel->y >= -0.5 && pixel->x < camera.size.x - 0.5 &&
           pixel->y < camera.size.y - 0.5;
}

/// The projector that meets a place most squarely.
std::optional<std::size_t> lightOf(const Installation& room, const RoomSurface& surface, const SurfacePoint& at) {
    std::optional<std::size_t> best;
    double square = kLeastCosine;
    for (std::size_t i = 0; i < room.projectors.size(); ++i) {
        const InstalledProjector& projector = room.projectors[i];
        if (!projector.enabled || !isInImage(projector.camera, at.point)) continue;
        const glm::dvec3 place = positionOf(projector.camera);
        const double cosine = glm::dot(at.normal, glm::normalize(place - at.point));
        if (cosine <= square || !surface.sees(at, place)) continue;
        square = cosine;
        best = i;
    }
    return best;
}

/// One place: how it slips, to first order, with whatever moves.
class Slip {
public:
    Slip(const SlipPoint& point, const Installation& room, double floats)
        : place_(vectorOf(point.at.point)), eye_(vectorOf(glm::dvec3(room.eye))) {
        const Vector3d normal = vectorOf(point.at.normal);
        beam_ = (place_ - vectorOf(positionOf(room.projectors[point.projector].camera))).normalized();
        const double far = (eye_ - place_).norm();
        const Vector3d sight = (eye_ - place_) / far;
        floats_ = place_ + floats * sight;
        byShown_ = far / (far - floats);
        byEye_ = floats / (far - floats);
        across_ = Matrix3d::Identity() - sight * sight.transpose();
        const Matrix3d along = beam_ * normal.transpose() / normal.dot(beam_);
        bySurface_ = across_ * along;
        byLight_ = across_ * (Matrix3d::Identity() - along);
    }
    /// The surface moves, and nothing else.
    [[nodiscard]] Vector3d ofSurface(const Vector3d& motion) const { return bySurface_ * motion; }
    [[nodiscard]] Matrix3d ofShift() const { return bySurface_ - byShown_ * across_; }
    [[nodiscard]] Matrix3d ofTurn(const Vector3d& about) const {
        return -bySurface_ * crossOf(place_ - about) + byShown_ * across_ * crossOf(floats_ - about);
    }
    [[nodiscard]] Matrix3d ofEye() const { return byEye_ * across_; }
    /// Device and eye move together.
    [[nodiscard]] Matrix3d ofAllShift() const { return ofShift() + ofEye(); }
    [[nodiscard]] Matrix3d ofAllTurn(const Vector3d& about) const {
        return ofTurn(about) - ofEye() * crossOf(eye_ - about);
    }
    [[nodiscard]] double ofLight() const {
        return 0.5 * (byLight_ * (Matrix3d::Identity() - beam_ * beam_.transpose())).squaredNorm();
    }

private:
    Vector3d place_, eye_, beam_, floats_;
    Matrix3d across_, bySurface_, byLight_;
    double byShown_ = 1.0, byEye_ = 0.0;
};

std::vector<SlipPoint> pointsOf(const Rig& rig, const Installation& room, const RoomSurface& surface,
                                const std::vector<double>& strokes, std::size_t tries, const Progress& progress) {
    TriangleMesh mesh = deformed(rig, strokes);
    for (glm::vec3& vertex : mesh.positions) vertex = glm::vec3(room.worldFromDevice * glm::vec4(vertex, 1.0F));
    const glm::dvec3 eye(room.eye);
    std::vector<SlipPoint> points;
    for (const glm::dvec3& place : placesOn(mesh, tries)) {
        progress.throwIfCancelled();
        const std::optional<SurfacePoint> hit = surface.trace(eye, glm::normalize(place - eye));
        if (!hit || !hit->isOnDevice || glm::distance(hit->point, place) > kNear) continue;
        if (glm::dot(hit->normal, glm::normalize(eye - place)) < kLeastCosine) continue;
        if (const std::optional<std::size_t> projector = lightOf(room, surface, *hit))
            points.push_back({*hit, *projector});
    }
    return points;
}

} // namespace

std::vector<double> commandedOf(const SlipView& view, const Rig& rig) {
    return view.commanded.empty() ? std::vector<double>(rig.actuatorCount(), 0.5) : view.commanded;
}

SlipModel slipModelOf(const Rig& rig, const Installation& room, const SlipView& view, const Progress& progress) {
    if (!(view.floats >= 0.0 && view.floats <= kFloatsMost))
        throw InvalidInput("height that things float at", "it is not from 0 to 0.2 m", "give another");
    progress.report(0.0, "where the device is lit and seen");
    const std::vector<double> strokes = standingStrokes(room, rig, commandedOf(view, rig), StrokesFrom::anywhere);
    const RoomSurface surface(room, rig, strokes);
    SlipModel model;
    model.points = pointsOf(rig, room, surface, strokes, view.tries, progress.part(0.3, 0.9));
    if (model.points.empty())
        throw InvalidInput("device in the room", "no place of it is both lit by a projector and seen by the viewer",
                           "lay it into the light, before the viewer");
    model.lights.resize(room.projectors.size());
    const Vector3d device = vectorOf(glm::dvec3(room.worldFromDevice[3])), middle = Vector3d::Zero();
    for (const SlipPoint& point : model.points) {
        const Slip slip(point, room, view.floats);
        const auto add = [](Matrix3d& sum, const Matrix3d& by) { sum += by.transpose() * by; };
        add(model.deviceShift, slip.ofShift());
        add(model.deviceTurn, slip.ofTurn(device));
        add(model.trackerShift, slip.ofAllShift());
        add(model.trackerTurn, slip.ofAllTurn(middle));
        add(model.eye, slip.ofEye());
        const auto product = [](const Matrix3d& a, const Matrix3d& b) { return a.cwiseProduct(b).sum(); };
        model.trackerWithDevice += product(slip.ofAllShift(), slip.ofShift());
        model.trackerWithEye += product(slip.ofAllShift(), slip.ofEye());
        model.deviceWithEye += product(slip.ofShift(), slip.ofEye());
        model.lights[point.projector] += slip.ofLight();
        const std::vector<glm::dvec3> velocities = surface.velocities(point.at);
        model.strokes.resize(velocities.size());
        for (std::size_t i = 0; i < velocities.size(); ++i)
            model.strokes[i] += slip.ofSurface(vectorOf(velocities[i])).squaredNorm();
    }
    const double share = 1.0 / static_cast<double>(model.points.size());
    for (Matrix3d* sum : {&model.deviceShift, &model.deviceTurn, &model.trackerShift, &model.trackerTurn, &model.eye})
        *sum *= share;
    for (double* product : {&model.trackerWithDevice, &model.trackerWithEye, &model.deviceWithEye}) *product *= share;
    for (double& light : model.lights) light *= share;
    for (double& stroke : model.strokes) stroke *= share;
    return model;
}

} // namespace lumorph
