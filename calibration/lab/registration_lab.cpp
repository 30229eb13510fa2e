#include "calibration/lab/registration_lab.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab.h"
#include "calibration/lab/lab_lens.h"
#include "calibration/lab/lab_world.h"
#include "calibration/registration/touch_plan.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kPixelStep = 5;        ///< camera pixels between rays of structured light
constexpr double kDecodeNoise = 0.1; ///< pixels
constexpr std::size_t kTouchesADimple = 3;

/// Recordings of one step differ from those of the others.
enum class Step : std::uint32_t { pointer = 1, dots, landmarks, surface, eye };
std::uint32_t seedOf(std::uint32_t seed, Step step) { return seed * 7919U + static_cast<std::uint32_t>(step); }

TrackerLab labOf(const Installation& truth, std::uint32_t seed, Step step, const RegistrationLabOptions& options) {
    return {truth, seedOf(seed, step), options.errors, options.hands, options.fault};
}

std::string numbered(const char* what, std::size_t i) { return std::string(what) + " " + std::to_string(i + 1); }

/// Where the light of a projector's pixel meets the table, by the lab's own arithmetic.
glm::dvec3 onTable(const InstalledProjector& projector, const glm::dvec2& pixel) {
    const LabLens lens = lensOf(projector.camera, "projector of the lab");
    const auto direction = rayThrough(lens, pixel);
    if (!direction || direction->y > -1e-3)
        throw InvalidInput("dots in the lab", "the projector's light does not reach the table", "turn it down");
    return lens.position - lens.position.y / direction->y * *direction;
}

const InstalledProjector& firstProjector(const Installation& room) {
    if (room.projectors.empty())
        throw InvalidInput("registration in the lab", "the room has no projector", "add one in the studio");
    return room.projectors.front();
}

std::vector<PlannedDot> dotsFor(const Rig& rig, const Installation& believed, std::size_t count) {
    (void)firstProjector(believed);
    std::vector<PlannedDot> dots = planDots(believed, 0, rig, count);
    if (dots.size() < count)
        throw InvalidInput("dots in the lab", "there is no room for them beside the device", "light more of the table");
    return dots;
}

/// Where the camera sees the projector's light, and what it reads there, off by the noise of both.
std::vector<ProjectorPoint> decodedLight(const Lab& lab, const LabLens& camera, const LabLens& projector,
                                         std::uint32_t seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> noise(0.0, kDecodeNoise);
    const auto off = [&](const glm::dvec2& pixel) {
        const glm::dvec2 by(noise(engine), noise(engine));
        return cv::Point2d(pixel.x + by.x, pixel.y + by.y);
    };
    std::vector<ProjectorPoint> light;
    for (int y = 0; y < camera.size.y; y += kPixelStep)
        for (int x = 0; x < camera.size.x; x += kPixelStep) {
            const glm::dvec2 pixel(x, y);
            const auto sight = rayThrough(camera, pixel);
            if (!sight) continue;
            const auto hit = lab.trace(camera.position, *sight);
            if (!hit || !lab.lit(0, hit->point, hit->normal)) continue;
            const auto lit = imageOf(projector, hit->point);
            if (!lit) continue;
            const cv::Point2d seen = off(pixel);
            light.push_back({seen, off(*lit)});
        }
    return light;
}

/// Servos that came down to rest stop where their play lets them.
std::vector<double> strokesAtRest(const Rig& rig, const Installation& room) {
    std::vector<double> strokes;
    for (const Actuator& actuator : rig.actuators()) {
        const auto servo = std::ranges::find(room.servos, actuator.name, &MeasuredServo::actuator);
        const bool isKnown = servo != room.servos.end() && !servo->points.empty();
        strokes.push_back(isKnown ? std::clamp(servo->points.front().falling, 0.0, 1.0) : 0.0);
    }
    return strokes;
}

std::vector<TouchedLandmark> touchAll(TrackerLab& lab, const std::vector<PlannedLandmark>& planned, std::size_t from,
                                      std::size_t to, const char* what) {
    std::vector<TouchedLandmark> touches;
    for (std::size_t i = from; i < std::min(to, planned.size()); ++i)
        touches.push_back(
            {planned[i].onModel, planned[i].outward, lab.touchDevice(numbered(what, i - from), planned[i].onModel)});
    return touches;
}

} // namespace

PointerCapture capturePointerInLab(const Installation& truth, std::uint32_t seed,
                                   const RegistrationLabOptions& options) {
    TrackerLab lab = labOf(truth, seed, Step::pointer, options);
    PointerCapture capture;
    capture.swings = lab.swing({0.22, 0.0, 0.12});
    for (std::size_t i = 0; i < options.fresh; ++i) {
        std::vector<Touch>& dimple = capture.fresh.emplace_back();
        const double round = 1.9 * double(i);
        for (std::size_t k = 0; k < kTouchesADimple; ++k)
            dimple.push_back(
                lab.touchDimple(numbered("dimple", i), {0.3 * std::sin(round), 0.0, 0.2 * std::cos(round)}));
    }
    return capture;
}

DotCapture captureDotsInLab(const Rig& rig, const Installation& believed, const Installation& truth, std::uint32_t seed,
                            const RegistrationLabOptions& options) {
    const std::vector<PlannedDot> planned = dotsFor(rig, believed, options.dots + options.fresh);
    TrackerLab lab = labOf(truth, seed, Step::dots, options);
    DotCapture capture;
    for (std::size_t i = 0; i < planned.size(); ++i) {
        const bool fits = i < options.dots;
        const std::string name = fits ? numbered("dot", i) : numbered("check dot", i - options.dots);
        const glm::dvec3 place = onTable(firstProjector(truth), planned[i].pixel);
        (fits ? capture.dots : capture.fresh).push_back({0, planned[i].pixel, lab.touchDot(name, place)});
    }
    return capture;
}

LandmarkCapture captureLandmarksInLab(const Rig& rig, const Installation& truth, std::uint32_t seed,
                                      const RegistrationLabOptions& options) {
    const std::size_t count = options.landmarks + options.fresh;
    const std::vector<PlannedLandmark> planned = planLandmarks(rig, count);
    TrackerLab lab = labOf(truth, seed, Step::landmarks, options);
    LandmarkCapture capture;
    capture.touches = touchAll(lab, planned, 0, options.landmarks, "point");
    capture.fresh = touchAll(lab, planned, options.landmarks, count, "check point");
    return capture;
}

LitDeviceCapture captureLitDeviceInLab(const Rig& rig, const Installation& truth, std::uint32_t seed,
                                       const RegistrationLabOptions& options) {
    const InstalledProjector& projector = firstProjector(truth);
    LabWorld world = roomWorld(truth, rig, strokesAtRest(rig, truth));
    world.projectors = {{projector, {}}};
    LitDeviceCapture capture;
    capture.light = decodedLight(Lab(std::move(world)), lensOf(labCamera(truth), "camera of the lab"),
                                 lensOf(projector.camera, "projector of the lab"), seedOf(seed, Step::surface));
    TrackerLab lab = labOf(truth, seed, Step::surface, options);
    capture.body = lab.recordDevice(3.0);
    capture.fresh = touchAll(lab, planLandmarks(rig, options.fresh), 0, options.fresh, "check point");
    return capture;
}

TriangleMesh shapeAtRest(const Rig& rig, const Installation& believed) {
    return deformed(rig, strokesAtRest(rig, believed));
}

EyeCapture captureEyeInLab(const Rig& rig, const Installation& believed, const Installation& truth, std::uint32_t seed,
                           const RegistrationLabOptions& options) {
    const std::vector<PlannedDot> marks = dotsFor(rig, believed, options.alignments + options.fresh);
    TrackerLab lab = labOf(truth, seed, Step::eye, options);
    std::mt19937 engine(seedOf(seed, Step::eye));
    std::normal_distribution<double> moves(0.0, 0.06); // metres, of the visitor between alignments
    EyeCapture capture;
    for (std::size_t i = 0; i < marks.size(); ++i) {
        const bool fits = i < options.alignments;
        const std::string name = fits ? numbered("alignment", i) : numbered("check alignment", i - options.alignments);
        const glm::dvec3 eye = glm::dvec3(truth.eye) + glm::dvec3(moves(engine), moves(engine), moves(engine));
        (fits ? capture.alignments : capture.fresh).push_back(lab.align(name, marks[i].place, eye));
    }
    return capture;
}

} // namespace lumorph
