#include "calibration/lab/true_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <variant>

#include <glm/gtc/matrix_transform.hpp>

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

} // namespace lumorph
