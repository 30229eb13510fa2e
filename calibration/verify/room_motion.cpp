#include "calibration/verify/room_motion.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "calibration/solve/projection.h"

namespace lumorph {

namespace {

constexpr double kGrazingLight = 0.12; // cosine: light or sight that grazes more says little

Eigen::Vector3d vectorOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// y + turn x y + shift, exactly.
glm::dmat4 smallMotion(const Eigen::VectorXd& motion, const RoomPart& part) {
    const auto at = [&](Eigen::Index i) { return motion[part.first + i]; };
    const glm::dvec3 turn(at(0), at(1), at(2));
    const double angle = glm::length(turn);
    const glm::dmat4 shifted = glm::translate(glm::dmat4(1.0), glm::dvec3(at(3), at(4), at(5)));
    return angle > 0.0 ? glm::rotate(shifted, angle, turn / angle) : shifted;
}

/// How a point moves with the six numbers: turn x y + shift.
Eigen::Matrix<double, 3, 6> motionOfPoint(const Eigen::Vector3d& y) {
    Eigen::Matrix<double, 3, 6> all;
    all.leftCols<3>() = -crossOf(y);
    all.rightCols<3>().setIdentity();
    return all;
}

/// What is left of motions when the point slides along `ray` until it is on the plane again.
template <typename Motions>
Eigen::Matrix<double, 3, Motions::ColsAtCompileTime> slid(const Motions& motions, const Eigen::Vector3d& ray,
                                                          const Eigen::Vector3d& normal) {
    return motions - ray * (normal.transpose() * motions) / normal.dot(ray);
}

Lens lensVectorOf(const CalibratedCamera& camera) {
    const auto& k = camera.distortion;
    return {camera.focal.x,
            camera.focal.y / camera.focal.x,
            camera.principal.x,
            camera.principal.y,
            k[0],
            k[1],
            k[2],
            k[3],
            k[4]};
}

} // namespace

RoomParts::RoomParts(std::size_t projectors, std::size_t servos) : projectors_(projectors) {
    const auto add = [this](RoomPart::Kind kind, std::size_t index, Eigen::Index count) {
        parts_.push_back({kind, index, size_, count});
        size_ += count;
    };
    for (std::size_t i = 0; i < projectors; ++i) add(RoomPart::Kind::projector, i, 6);
    add(RoomPart::Kind::camera, 0, 6);
    add(RoomPart::Kind::device, 0, 6);
    for (std::size_t i = 0; i < servos; ++i) add(RoomPart::Kind::servo, i, 1);
}

RoomParts partsOf(const Installation& room, const Rig& rig) {
    const std::size_t servos = rig.actuatorCount() <= RoomSurface::kMostServos ? rig.actuatorCount() : 0;
    return {room.projectors.size(), servos};
}

std::string nameOf(const RoomPart& part, const Installation& room, const Rig& rig) {
    switch (part.kind) {
    case RoomPart::Kind::projector:
        return room.projectors.size() > 1 ? "projector '" + room.projectors[part.index].name + "'" : "projector";
    case RoomPart::Kind::camera:
        return "camera";
    case RoomPart::Kind::device:
        return "device";
    case RoomPart::Kind::servo:
        return "servo of '" + rig.actuators()[part.index].name + "'";
    }
    return {};
}

Installation movedBy(Installation room, const RoomParts& parts, const Eigen::VectorXd& motion, std::size_t camera) {
    for (std::size_t i = 0; i < room.projectors.size(); ++i) {
        glm::dmat4& pose = room.projectors[i].camera.cameraFromWorld;
        pose = smallMotion(motion, parts.projector(i)) * pose;
    }
    glm::dmat4& pose = room.cameras[camera].camera.cameraFromWorld;
    pose = smallMotion(motion, parts.camera()) * pose;
    room.worldFromDevice = glm::mat4(glm::dmat4(room.worldFromDevice) * smallMotion(motion, parts.device()));
    return room;
}

std::vector<double> movedBy(std::span<const double> strokes, const RoomParts& parts, const Eigen::VectorXd& motion) {
    std::vector<double> moved(strokes.begin(), strokes.end());
    for (std::size_t i = 0; i < parts.servos(); ++i)
        moved[i] = std::clamp(moved[i] + motion[parts.servo(i).first], 0.0, 1.0);
    return moved;
}

LightModel::Optics LightModel::opticsOf(const CalibratedCamera& camera) {
    Optics optics;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) optics.turn(row, column) = camera.cameraFromWorld[column][row];
    optics.shift = vectorOf(glm::dvec3(camera.cameraFromWorld[3]));
    optics.place = vectorOf(positionOf(camera));
    return optics;
}

LightModel::LightModel(const Installation& room, const RoomParts& parts, std::size_t camera)
    : parts_(parts), camera_(room.cameras.at(camera).camera), cameraOptics_(opticsOf(camera_)) {
    for (const InstalledProjector& projector : room.projectors) {
        projectors_.push_back(projector.camera);
        projectorOptics_.push_back(opticsOf(projector.camera));
    }
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            deviceTurn_(row, column) = static_cast<double>(room.worldFromDevice[column][row]);
    devicePlace_ = vectorOf(glm::dvec3(room.worldFromDevice[3]));
}

std::optional<LightEquation> LightModel::equation(const RoomSurface& surface, const LitPoint& seen) const {
    const glm::dvec3 sight = directionOf(camera_, seen.camera);
    const std::optional<SurfacePoint> hit = surface.trace(positionOf(camera_), sight);
    if (!hit) return std::nullopt;
    const Optics& lamp = projectorOptics_[seen.projector];
    const Eigen::Vector3d point = vectorOf(hit->point), normal = vectorOf(hit->normal), ray = vectorOf(sight);
    const Eigen::Vector3d beam = (point - lamp.place).normalized();
    const Eigen::Vector3d inLamp = lamp.turn * point + lamp.shift;
    if (-normal.dot(ray) < kGrazingLight || -normal.dot(beam) < kGrazingLight || inLamp.z() <= 0.0) return std::nullopt;

    LightEquation equation;
    equation.projector = seen.projector;
    equation.at = *hit;
    const Projected lit = project(lensVectorOf(projectors_[seen.projector]), inLamp);
    equation.error = lit.pixel - Eigen::Vector2d(seen.panel.x, seen.panel.y);
    equation.byMotion.setZero(2, parts_.size());
    equation.beside.setZero(3, parts_.size());
    const Eigen::Matrix<double, 2, 3> byPoint = lit.byPoint * lamp.turn;

    const Eigen::Index p = parts_.projector(seen.projector).first;
    const Eigen::Matrix<double, 3, 6> ofLamp = motionOfPoint(inLamp);
    equation.byMotion.middleCols<6>(p) = lit.byPoint * ofLamp;
    equation.beside.middleCols<6>(p) = slid((-lamp.turn.transpose() * ofLamp).eval(), beam, normal);

    // A camera that moved sees, by the same pixel, another place: its frame takes the ray along.
    const Eigen::Vector3d inCamera = cameraOptics_.turn * point + cameraOptics_.shift;
    const Eigen::Matrix<double, 3, 6> ofSight =
        slid((-cameraOptics_.turn.transpose() * motionOfPoint(inCamera)).eval(), ray, normal);
    equation.byMotion.middleCols<6>(parts_.camera().first) = byPoint * ofSight;
    equation.beside.middleCols<6>(parts_.camera().first) = ofSight;
    if (!hit->isOnDevice) return equation;

    // A surface that moved lets the same ray end elsewhere along itself.
    const Eigen::Matrix3d along = ray * normal.transpose() / normal.dot(ray);
    const Eigen::Matrix<double, 3, 6> ofDevice =
        deviceTurn_ * motionOfPoint(deviceTurn_.transpose() * (point - devicePlace_));
    equation.byMotion.middleCols<6>(parts_.device().first) = byPoint * (along * ofDevice);
    equation.beside.middleCols<6>(parts_.device().first) = ofDevice;
    const std::vector<glm::dvec3> velocities = surface.velocities(*hit);
    for (std::size_t i = 0; i < parts_.servos(); ++i) {
        const Eigen::Vector3d velocity = vectorOf(velocities[i]);
        equation.byMotion.col(parts_.servo(i).first) = byPoint * (along * velocity);
        equation.beside.col(parts_.servo(i).first) = velocity;
    }
    return equation;
}

} // namespace lumorph
