#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "calibration/decode/pattern_decoder.h"
#include "calibration/lab/board_lab.h"
#include "calibration/lab/check_lab.h"
#include "calibration/lab/lab_world.h"
#include "calibration/patterns/capture_order.h"
#include "calibration/report/calibrated_room.h"
#include "calibration/solve/device_calibration.h"
#include "calibration/stages/stage_rows.h"
#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// Projectors and camera by the device itself, without a board: light on it at rest and with each actuator raised. The
// last shot is held out.

namespace lumorph {

namespace {

constexpr const char* kDeviceMethod = "structured light on the device";
constexpr double kRaised = 0.5, kCheckRaised = 0.3; // of a stroke: upright flaps show light only their edge
constexpr int kMostCells = 20'000;                  // of one picture

/// At rest, with each actuator raised by itself, and all of them raised a little.
std::vector<std::vector<double>> shotsFor(std::size_t actuators) {
    std::vector<std::vector<double>> shots(actuators + 2, std::vector<double>(actuators, 0.0));
    for (std::size_t i = 0; i < actuators; ++i) shots[i + 1][i] = kRaised;
    shots.back().assign(actuators, kCheckRaised);
    return shots;
}

/// The room's projectors that are on, by number.
std::vector<std::size_t> lampsOf(const Installation& room) {
    std::vector<std::size_t> lamps;
    for (std::size_t k = 0; k < room.projectors.size(); ++k)
        if (room.projectors[k].enabled) lamps.push_back(k);
    if (lamps.empty()) throw InvalidInput("the room", "it has no projector that is on", "switch one on in Scene");
    return lamps;
}

StageRecording recordShots(const StageSite& site, Bench& bench, const Progress& progress) {
    StageRecording recording = stages::emptyRecording("device", site, bench);
    recording.method = kFourStepPattern;
    const std::size_t actuators = site.rig->actuatorCount();
    RecordedTable &devices = recording.tables["devices"], &shots = recording.tables["shots"],
                  &light = recording.tables["light"];
    devices.columns = stages::kDeviceColumns;
    shots.columns = stages::shotColumns(actuators);
    light.columns = stages::kLightColumns;
    const std::vector<std::size_t> lamps = lampsOf(site.room);
    const auto stands = shotsFor(actuators);
    const double share = 1.0 / static_cast<double>(stands.size() * lamps.size());
    DeviceBench& device = bench.device(site);
    cv::Size pictures;
    for (std::size_t shot = 0; shot < stands.size(); ++shot) {
        shots.add({shot + 1 == stands.size() ? 1.0 : 0.0});
        shots.numbers.insert(shots.numbers.end(), stands[shot].begin(), stands[shot].end());
        device.stand(stands[shot], progress);
        for (std::size_t p = 0; p < lamps.size(); ++p) {
            const std::size_t look = shot * lamps.size() + p;
            const glm::ivec2 panel = site.room.projectors[lamps[p]].camera.size;
            const CaptureOrder order = parsePattern(kFourStepPattern, {panel.x, panel.y});
            const double from = static_cast<double>(look) * share;
            const auto images = device.photograph(lamps[p], order, progress.part(from, from + share));
            if (images.size() != order.images.size() || images.front().empty())
                throw DeviceError("the camera", "it stopped in between",
                                  "look whether it is plugged in, and measure again");
            pictures = images.front().size();
            stages::addLight(light, look, lightOf(decodeView(images, order), kMostCells));
        }
    }
    const auto add = [&devices](const std::string& name, bool isProjector, int width, int height) {
        devices.add(name, {isProjector ? 1.0 : 0.0, static_cast<double>(width), static_cast<double>(height)});
    };
    add(site.room.cameras.empty() ? "Camera" : site.room.cameras.front().name, false, pictures.width, pictures.height);
    for (const std::size_t k : lamps)
        add(site.room.projectors[k].name, true, site.room.projectors[k].camera.size.x,
            site.room.projectors[k].camera.size.y);
    return recording;
}

glm::dmat4 placeOf(const PoseVector& fromDevice, const Installation& room) {
    return (Rigid::exp(fromDevice) * Rigid(glm::dmat4(room.worldFromDevice)).inverse()).matrix();
}

/// Light on the shot that was held out: rays of the camera meet the device there, and what they meet is lit by a pixel.
std::vector<stages::LightBeside> besideOnDevice(const Rig& rig, const Installation& room, const DeviceShot& shot,
                                                std::size_t lamp, const CalibratedCamera& camera,
                                                const CalibratedCamera& projector) {
    std::vector<stages::LightBeside> all;
    const Lab lab(roomWorld(room, rig, shot.strokes));
    const glm::dvec3 eye = positionOf(camera), from = positionOf(projector);
    constexpr double kStray = 20.0; // pixels: a code that was read wrongly tells nothing
    for (const ProjectorPoint& point : shot.light.front()[lamp]) {
        const auto hit = lab.trace(eye, directionOf(camera, {point.camera.x, point.camera.y}));
        if (!hit || hit->surface != 0) continue;
        const auto pixel = pixelOf(projector, hit->point);
        if (!pixel) continue;
        const double pixels = std::hypot(pixel->x - point.projector.x, pixel->y - point.projector.y);
        if (pixels < kStray) all.push_back({pixels, pixels * glm::length(hit->point - from) / projector.focal.x});
    }
    return all;
}

StageResult solveDeviceAlone(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    PlacedDevices result;
    result.room = site.room;
    stages::RecordedShots read = stages::shotsOf(recording, site.rig->actuatorCount());
    for (DeviceShot& shot : read.shots) shot.strokes = risenStrokes(site.room, *site.rig, shot.strokes);
    std::optional<DeviceShot> held;
    if (read.hasCheck) {
        held = std::move(read.shots.back());
        read.shots.pop_back();
    }
    try {
        const DeviceCalibration solved =
            calibrateOnDevice(*site.rig, read.shots, {read.camera}, read.projectors, {}, progress);
        result.rms = solved.rms;
        result.warnings = solved.warnings;
        const std::string method = std::string(kDeviceMethod) + ", " + std::to_string(read.shots.size()) + " states";
        const Origin origin{Origin::Way::measured, method, utcDate()};
        Installation room = site.room;
        if (room.cameras.empty()) room.cameras.emplace_back();
        InstalledCamera& camera = room.cameras.front();
        const glm::ivec2 before = camera.camera.size;
        CalibratedCamera seen = cameraOf(solved.cameras.front());
        seen.cameraFromWorld = placeOf(solved.state.cameras.front().fromWorld, room);
        // The lab photographs with fewer pixels than its camera has.
        const bool isScaled = before.x * seen.size.y == before.y * seen.size.x;
        camera.camera = isScaled ? withSize(seen, before) : seen;
        camera.lens = camera.pose = origin;
        const auto shiftOf = [](const PoseVector& sigma) { return std::hypot(sigma[3], sigma[4], sigma[5]); };
        result.devices.push_back({read.camera.name,
                                  false,
                                  solved.cameras.front().rms,
                                  solved.cameras.front().sigma[kFocalLength],
                                  shiftOf(solved.sigma.cameras.front().fromWorld),
                                  {}});
        std::vector<stages::LightBeside> all;
        for (std::size_t p = 0; p < read.projectors.size(); ++p) {
            const auto named = std::ranges::find(room.projectors, read.projectors[p].name, &InstalledProjector::name);
            if (named == room.projectors.end())
                throw InvalidInput("the room", "it has no projector " + read.projectors[p].name,
                                   "add one of this name in Scene, or choose another recording");
            named->camera = cameraOf(solved.projectors[p]);
            named->camera.cameraFromWorld = placeOf(solved.state.projectors[p].fromWorld, room);
            named->lens = named->pose = origin;
            std::vector<stages::LightBeside> beside;
            if (held) beside = besideOnDevice(*site.rig, room, *held, p, seen, named->camera);
            all.insert(all.end(), beside.begin(), beside.end());
            result.devices.push_back(
                {read.projectors[p].name, true, solved.projectors[p].rms, solved.projectors[p].sigma[kFocalLength],
                 shiftOf(solved.sigma.projectors[p].fromWorld), stages::heldOutOf(std::move(beside))});
        }
        result.heldOut = stages::heldOutOf(std::move(all));
        checkInstallation(room);
        stages::judgePlaces(result);
        if (result.good()) result.room = std::move(room);
    } catch (const CaptureRefused& refused) {
        result.refusal = refused.finding();
    }
    return result;
}

} // namespace

CalibrationStage stages::deviceStage() {
    CalibrationStage stage;
    stage.key = "device";
    stage.title = "Projectors by the device alone";
    stage.needs = {"servos"}; // the solver needs the true strokes: unmeasured servo curves make the model wrong
    stage.isWanted = isNeverWanted;
    stage.measure = [](const StageSite& site, Bench& bench, const Progress& progress) {
        StageRecording recording = recordShots(site, bench, progress.part(0.0, 0.6));
        StageResult result = solveDeviceAlone(recording, site, progress.part(0.6, 1.0));
        return MeasuredStage{std::move(recording), std::move(result)};
    };
    stage.solve = solveDeviceAlone;
    stage.apply = applyPlaces;
    stage.origin = [](const Installation& room) { return originByMethod(room, kDeviceMethod); };
    return stage;
}

} // namespace lumorph
