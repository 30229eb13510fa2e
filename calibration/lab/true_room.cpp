#include "calibration/lab/true_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "calibration/lab/board_lab.h"

namespace lumorph {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
/// A whole stroke of something that does not turn is as much play as one of so many degrees.
constexpr double kUsualDegrees = 60.0;
constexpr int kCurvePoints = 33;

class Dice {
public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}
    double normal(double sigma) { return std::normal_distribution<double>(0.0, 1.0)(engine_) * sigma; }
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    glm::dvec3 vector(double sigma) { return {normal(sigma), normal(sigma), normal(sigma)}; }
    glm::dmat4 rigid(double metres, double radians) {
        const glm::dvec3 turn = vector(radians), shift = vector(metres);
        const double angle = glm::length(turn);
        const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), shift);
        return angle > 0.0 ? glm::rotate(moved, angle, turn / angle) : moved;
    }

private:
    std::mt19937 engine_;
};

/// A bow with a slight S in it, zero at both ends, then the play: on the way up the horn trails behind.
MeasuredServo trueServo(const Actuator& actuator, const LabErrors& errors, Dice& dice) {
    MeasuredServo servo;
    servo.actuator = actuator.name;
    servo.lagSeconds = errors.servoLagSeconds * dice.between(0.7, 1.3);
    const double bow = std::clamp(dice.normal(errors.servoBend), -0.15, 0.15);
    const double wave = std::clamp(dice.normal(0.5 * errors.servoBend), -0.05, 0.05);
    const double play = errors.backlashDegrees / degreesOf(actuator).value_or(kUsualDegrees);
    for (int k = 0; k < kCurvePoints; ++k) {
        const double u = k / (kCurvePoints - 1.0);
        const double real = u + bow * std::sin(std::numbers::pi * u) + wave * std::sin(2.0 * std::numbers::pi * u);
        servo.points.push_back({u, real - 0.5 * play, real + 0.5 * play});
    }
    return servo;
}

void changeLight(InstalledProjector& projector, const LabErrors& errors, Dice& dice) {
    for (int channel = 0; channel < 3; ++channel) {
        projector.gain[channel] *= static_cast<float>(std::exp(dice.normal(errors.gain)));
        projector.black[channel] = static_cast<float>(errors.black * dice.between(0.5, 1.5));
    }
    projector.gamma = dice.between(1.9, 2.5);
    projector.responseCurve.clear();
}

constexpr int kLabCameraWidth = 1280;
/// Metres over `kLitSide`: nearer than this it is the lab's projector that was measured.
constexpr double kSameLight = 0.006;
constexpr double kLitSide = 0.4;

/// As boxes come: nothing is known of what the chain measures.
Installation packed(const Installation& believed) {
    const Installation fresh;
    Installation room = believed;
    room.worldFromTracker = fresh.worldFromTracker;
    room.bodyFromDevice = fresh.bodyFromDevice;
    room.pointerTip = fresh.pointerTip;
    room.eyeFromHead = fresh.eyeFromHead;
    room.servos.clear();
    room.trackerSeconds = fresh.trackerSeconds;
    room.predictionSeconds = fresh.predictionSeconds;
    if (room.origins.colors.isCalibrated()) {
        room.deviceColor = fresh.deviceColor;
        room.tableColor = fresh.tableColor;
    }
    for (InstalledProjector& projector : room.projectors) {
        const InstalledProjector unknown;
        projector.gain = unknown.gain;
        projector.black = unknown.black;
        projector.gamma = unknown.gamma;
        projector.responseCurve.clear();
    }
    return room;
}

/// What the lab's sequence measured is a little beside what stands there.
void putWhereTheLabHasThem(Installation& room) {
    for (std::size_t k = 0; k < room.projectors.size(); ++k) {
        InstalledProjector& projector = room.projectors[k];
        if (!projector.lens.isCalibrated()) continue;
        const Installation lab = labTruth(room, k);
        const CalibratedCamera& truly = lab.projectors.front().camera;
        const auto beside = lightError(projector.camera, truly, kLitSide);
        if (truly.size != projector.camera.size || !beside || *beside > kSameLight) continue;
        projector.camera = truly;
        InstalledCamera* camera = room.cameras.empty() ? nullptr : &room.cameras.front();
        if (k == 0 && camera && camera->camera.size == lab.cameras.front().camera.size)
            camera->camera = lab.cameras.front().camera;
    }
}

} // namespace

std::optional<double> degreesOf(const Actuator& actuator) {
    if (const auto* hinge = std::get_if<Hinge>(&actuator.deformer))
        return hinge->max.inDegrees() - hinge->min.inDegrees();
    if (const auto* bend = std::get_if<Bend>(&actuator.deformer)) return bend->max.inDegrees() - bend->min.inDegrees();
    if (const auto* joint = std::get_if<SkinJoint>(&actuator.deformer))
        if (joint->motion == SkinJoint::Motion::rotate) return (joint->max - joint->min) / kDegree;
    if (const auto* lift = std::get_if<SheetLift>(&actuator.deformer))
        return lift->max.inDegrees() - lift->min.inDegrees();
    return std::nullopt;
}

Installation trueRoom(const Installation& believed, std::span<const Actuator> actuators, std::uint32_t seed,
                      const LabErrors& errors) {
    Dice dice(seed);
    Installation room = believed;
    if (errors.unknownTracker) {
        const double turn = dice.between(-std::numbers::pi, std::numbers::pi);
        const glm::dvec3 place{dice.between(-1.0, 1.0), dice.between(-0.2, 1.0), dice.between(-1.0, 1.0)};
        const glm::dmat4 stands = glm::translate(glm::dmat4(1.0), place);
        room.worldFromTracker =
            glm::mat4(glm::rotate(stands, turn, glm::dvec3(0.0, 1.0, 0.0)) * dice.rigid(0.0, 10.0 * kDegree));
    }
    room.bodyFromDevice = glm::mat4(glm::dmat4(room.bodyFromDevice) *
                                    dice.rigid(1e-3 * errors.deviceMillimetres, errors.deviceDegrees * kDegree));
    room.pointerTip +=
        glm::vec3(dice.vector(3e-3)) - glm::vec3(0.0F, static_cast<float>(1e-3 * errors.tipMillimetres), 0.0F);
    room.eyeFromHead += glm::vec3(dice.vector(1e-3 * errors.eyeMillimetres));
    room.servos.clear();
    for (const Actuator& actuator : actuators) room.servos.push_back(trueServo(actuator, errors, dice));
    room.trackerSeconds = errors.trackerSeconds * dice.between(0.6, 1.4);
    room.predictionSeconds = errors.lightSeconds * dice.between(0.7, 1.3);
    for (InstalledProjector& projector : room.projectors) changeLight(projector, errors, dice);
    for (glm::vec3* color : {&room.deviceColor, &room.tableColor})
        for (int channel = 0; channel < 3; ++channel)
            (*color)[channel] *= static_cast<float>(std::exp(-std::abs(dice.normal(errors.color))));
    return room;
}

Installation labTruth(const Installation& room, std::size_t number) {
    Installation truth = defaultInstallation();
    InstalledProjector& projector = truth.projectors.front();
    if (number < room.projectors.size())
        projector.camera = withSize(projector.camera, room.projectors[number].camera.size);
    constexpr double kRadians = std::numbers::pi / 180.0;
    // Each further projector stands a quarter of the way round the table from the one before it.
    const glm::dmat4 aside =
        glm::rotate(glm::dmat4(1.0), 90.0 * kRadians * static_cast<double>(number), glm::dvec3(0.0, 1.0, 0.0));
    projector.camera.cameraFromWorld *= aside;
    const glm::dvec3 position = positionOf(projector.camera) + glm::dvec3(0.03, -0.04, 0.02);
    glm::dmat4 turned = projector.camera.cameraFromWorld;
    turned = glm::rotate(glm::dmat4(1.0), 0.4 * kRadians, glm::dvec3(0.3, 1.0, 0.4)) * turned;
    turned[3] = glm::dvec4(-(glm::dmat3(turned) * position), 1.0);
    projector.camera.cameraFromWorld = turned;
    projector.camera.focal *= 1.01;
    truth.cameras.resize(1);
    // Half as many pixels again as the projector, so that it resolves the finest stripes; up to what is worked out
    // quickly.
    const int width = std::clamp(projector.camera.size.x * 3 / 2, 320, kLabCameraWidth);
    truth.cameras.front().camera = withSize(defaultLabCamera(projector.camera), {width, width * 4 / 5});
    return truth;
}

Installation labRoomTruth(Installation room) {
    const Installation first = labTruth(room);
    for (std::size_t k = 0; k < room.projectors.size(); ++k)
        if (!room.projectors[k].pose.isCalibrated())
            room.projectors[k].camera = labTruth(room, k).projectors.front().camera;
    if (room.cameras.empty()) room.cameras.emplace_back();
    for (InstalledCamera& camera : room.cameras)
        if (!camera.pose.isCalibrated()) camera.camera = first.cameras.front().camera;
    return room;
}

std::optional<double> lightError(const CalibratedCamera& believed, const CalibratedCamera& truth, double side) {
    constexpr int kSteps = 9;
    double sum = 0.0;
    int count = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < kSteps; ++j) {
            const glm::dvec3 point(side * (i / (kSteps - 1.0) - 0.5), 0.0, side * (j / (kSteps - 1.0) - 0.5));
            const auto pixel = pixelOf(believed, point);
            if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x >= believed.size.x ||
                pixel->y >= believed.size.y)
                continue;
            // The pixel that is meant for this point truly lights another.
            const glm::dvec3 from = positionOf(truth);
            const glm::dvec3 direction = directionOf(truth, *pixel);
            if (direction.y > -1e-6) continue;
            const glm::dvec3 off = from - (from.y / direction.y) * direction - point;
            sum += glm::dot(off, off);
            ++count;
        }
    if (count == 0) return std::nullopt;
    return std::sqrt(sum / count);
}

Installation unpackedLab(const Installation& believed, std::span<const Actuator> actuators, std::uint32_t seed) {
    const Installation before = packed(believed);
    // Drawn without actuators first, so that another device finds the same room.
    Installation room = trueRoom(before, {}, seed);
    room.servos = trueRoom(before, actuators, seed).servos;
    putWhereTheLabHasThem(room);
    return room;
}

} // namespace lumorph
