#include "calibration/servos/servo_gain.h"

#include <glm/geometric.hpp>

#include "core/scene/measured_servos.h"

namespace lumorph {

namespace {

/// Mean way between the vertices of two states.
double vertexDistance(const Rig& rig, std::span<const double> a, std::span<const double> b) {
    const TriangleMesh first = deformed(rig, a), second = deformed(rig, b);
    double sum = 0.0;
    for (std::size_t i = 0; i < first.positions.size(); ++i)
        sum += static_cast<double>(glm::distance(first.positions[i], second.positions[i]));
    return sum / static_cast<double>(first.positions.size());
}

/// Servos on their way from one state to the next.
struct DrivenDevice {
    ServoCurves truth;
    std::vector<double> real;

    void go(std::span<const double> commanded) { truth.follow(commanded, real); }
};

} // namespace

ServoGain servoGain(const Rig& rig, std::span<const LibraryTarget> library, const Installation& known,
                    const Installation& truth, const LibraryFitOptions& options, const Progress& progress) {
    LibraryMatcher matcher(rig, library, options, progress.part(0.0, 0.4));
    const LibraryFit fit = matcher.fit(progress.part(0.4, 0.9));
    const ServoCurves trueCurves(rig.actuators(), truth.servos), knownCurves(rig.actuators(), known.servos);
    const std::vector<double> rest(rig.actuatorCount(), 0.0);
    DrivenDevice told{trueCurves, rest}, led{trueCurves, rest};
    std::vector<double> commanded = rest, believed = rest;
    CoverageScratch scratch;
    BitColumns covered = matcher.coverage().domain();
    ServoGain gain;
    const auto iouAt = [&](std::span<const double> strokes, std::size_t target) {
        matcher.coverage().coveredAt(strokes, covered, scratch);
        return compareVolumes(covered, matcher.voxelsOf(target)).iou();
    };
    for (std::size_t k = 0; k < fit.targets.size(); ++k) {
        progress.throwIfCancelled();
        const std::vector<double> wanted = strokesOf(rig, fit.targets[k].state, fit.levels);
        told.go(wanted);
        commanded = knownCurves.commandsFor(wanted, believed, commanded);
        knownCurves.follow(commanded, believed);
        led.go(commanded);
        const double share = 1.0 / static_cast<double>(fit.targets.size());
        gain.wanted += share * iouAt(wanted, k);
        gain.told += share * iouAt(told.real, k);
        gain.measured += share * iouAt(led.real, k);
        gain.toldOff += share * vertexDistance(rig, told.real, wanted);
        gain.measuredOff += share * vertexDistance(rig, led.real, believed);
    }
    return gain;
}

} // namespace lumorph
