#include "tests/support/chain_judge.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "calibration/lab/lab_lens.h"
#include "core/loop/tracked_room.h"
#include "core/render/gl/headless_context.h"
#include "core/scene/measured_servos.h"
#include "tests/support/truth_show.h"

namespace lumorph::test {
namespace {

constexpr glm::ivec2 kEyePicture{1280, 800};
constexpr int kBallReach = 24;                 // eye pixels to either side of a ball
constexpr int kBallSpacing = 46;               // projector pixels, so that no ball shines into the next one's window
constexpr double kFlat = 0.003, kHigh = 0.035; // metres of balls above the skin
constexpr double kSkinStep = 0.004;            // metres between places of the skin
constexpr double kSteepSkin = TruthBench::kSteepestIncidence;
constexpr double kOneSurface = 0.004; // metres: what falls farther beside has gone over an edge

/// Strokes that come to be when servos go to what is wanted.
struct Strokes {
    std::vector<double> believed, real;
};

Strokes strokesOf(const Rig& rig, const Installation& estimated, const Installation& truth, const ShownMoment& moment) {
    const ServoCurves known(rig.actuators(), estimated.servos), real(rig.actuators(), truth.servos);
    const std::vector<double> rest(rig.actuatorCount(), 0.0);
    Strokes strokes{rest, rest};
    std::vector<double> commanded = rest;
    for (const std::vector<double>* wanted : {&moment.before, &moment.strokes}) {
        commanded = known.commandsFor(*wanted, strokes.believed, commanded);
        known.follow(commanded, strokes.believed);
        real.follow(commanded, strokes.real);
    }
    return strokes;
}

TruthDevice deviceIn(const Installation& room, const std::shared_ptr<const Rig>& rig, const Pose& place) {
    TruthDevice device{rig, defaultSceneInRoom()};
    static_cast<Installation&>(device.scene) = room;
    device.scene.worldFromDevice = glm::mat4(matrixOf(place));
    return device;
}

glm::dvec3 pointIn(const Pose& pose, const glm::dvec3& point) { return pose.position + pose.rotation * point; }

/// The light of `lit` that the projector's black does not make: balls are on black, and are to be told from it.
LabPicture withoutBlack(LabPicture lit, const LabPicture& black) {
    for (std::size_t i = 0; i < lit.light.size(); ++i) lit.light[i] = glm::max(lit.light[i] - black.light[i], 0.0F);
    return lit;
}

/// Places spread over a mesh's triangles, as corners' weights.
struct SkinPlace {
    std::size_t triangle;
    glm::dvec3 weights;
};
std::vector<SkinPlace> skinPlaces(const TriangleMesh& mesh) {
    std::vector<SkinPlace> places;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::uvec3& k = mesh.triangles[t];
        const glm::dvec3 a(mesh.positions[k.x]), b(mesh.positions[k.y]), c(mesh.positions[k.z]);
        const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        const int steps = static_cast<int>(longest / kSkinStep);
        for (int i = 0; i < steps; ++i)
            for (int j = 0; i + j < steps; ++j) {
                const double u = (i + 1.0 / 3.0) / steps, v = (j + 1.0 / 3.0) / steps;
                places.push_back({t, {1.0 - u - v, u, v}});
            }
    }
    return places;
}
glm::dvec3 placeOf(const TriangleMesh& mesh, const SkinPlace& place) {
    const glm::uvec3& k = mesh.triangles[place.triangle];
    return place.weights.x * glm::dvec3(mesh.positions[k.x]) + place.weights.y * glm::dvec3(mesh.positions[k.y]) +
           place.weights.z * glm::dvec3(mesh.positions[k.z]);
}

/// Where light that is meant for places of the skin truly falls. No renderer has a part in it.
void judgeSkin(const TruthBench& bench, const TriangleMesh& real, const TriangleMesh& believed,
               const CalibratedCamera& estimated, ShownError& error) {
    const LabLens eye = lensOf(bench.eye(), "eye"), lamp = lensOf(bench.projector().camera, "projector");
    const LabLens planned = lensOf(estimated, "estimated projector");
    for (const SkinPlace& place : skinPlaces(real)) {
        const glm::dvec3 wanted = placeOf(real, place);
        const auto meant = imageOf(planned, placeOf(believed, place));
        const auto seen = imageOf(eye, wanted);
        if (!meant || !seen) continue;
        // Only what projector and eye see, not too slantingly.
        const auto sight = bench.lab().trace(eye.position, glm::normalize(wanted - eye.position));
        if (!sight || sight->surface != TruthBench::kDevice || glm::distance(sight->point, wanted) > 1e-4) continue;
        const glm::dvec3 towards = glm::normalize(lamp.position - wanted);
        if (glm::dot(sight->normal, towards) < kSteepSkin || !bench.lab().lit(0, sight->point, sight->normal)) continue;
        const auto ray = rayThrough(lamp, *meant);
        const auto hit = ray ? bench.lab().trace(lamp.position, *ray) : std::nullopt;
        if (!hit || glm::distance(hit->point, wanted) > kOneSurface) continue;
        const auto fell = imageOf(eye, hit->point);
        if (!fell) continue;
        error.skinPixels.push_back(glm::distance(*fell, *seen));
        error.skinMillimetres.push_back(1e3 * glm::distance(hit->point, wanted));
    }
}

} // namespace

std::vector<ShownMoment> shownMoments() {
    const auto turned = [](double degrees, const glm::dvec3& axis) {
        return glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
    };
    const auto eyeAt = [&](const char* name, double degrees) {
        return Pose{glm::dvec3(truthEye(name)), turned(degrees, {0.2, 1.0, 0.3})};
    };
    const auto strokesOfState = [](const char* name) { return truthState(name).strokes; };
    return {{strokesOfState("rest"),
             strokesOfState("low relief"),
             {{0.0, 0.0, 0.0}, turned(0.0, {0, 1, 0})},
             eyeAt("front", 5.0)},
            {strokesOfState("all"),
             strokesOfState("mixed"),
             {{0.03, 0.0, -0.02}, turned(12.0, {0, 1, 0})},
             eyeAt("front right", -14.0)},
            {strokesOfState("mixed"),
             strokesOfState("diagonal"),
             {{-0.02, 0.01, 0.015}, turned(-9.0, {0.1, 1, 0.05})},
             eyeAt("left", 25.0)}};
}

void ShownError::add(const ShownError& other) {
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
        to.insert(to.end(), from.begin(), from.end());
    };
    append(balls, other.balls);
    append(skinPixels, other.skinPixels);
    append(skinMillimetres, other.skinMillimetres);
    judgedBalls += other.judgedBalls;
    eyeMillimetres = std::max(eyeMillimetres, other.eyeMillimetres);
    deviceMillimetres = std::max(deviceMillimetres, other.deviceMillimetres);
}

ShownError shownError(SpatialRenderer& renderer, const std::shared_ptr<const Rig>& rig, const Installation& estimated,
                      const Installation& truth, const ShownMoment& moment) {
    const Pose device = inRoom(estimated, PoseRole::device, trackedOf(truth, PoseRole::device, moment.device));
    const Pose head = inRoom(estimated, PoseRole::head, trackedOf(truth, PoseRole::head, moment.eye));
    const glm::dvec3 eye = pointIn(head, glm::dvec3(estimated.eyeFromHead));
    const Strokes strokes = strokesOf(*rig, estimated, truth, moment);

    const TruthDevice real = deviceIn(truth, rig, moment.device), believed = deviceIn(estimated, rig, device);
    const TruthState realState{"real", strokes.real}, believedState{"believed", strokes.believed};
    const glm::vec3 realEye(moment.eye.position), believedEye(eye);
    const auto setup = [&](const ShowFrame& frame) {
        TruthSetup made{truthMesh(real, realState), tableMesh(truth.tableSize), truth.projectors.front(),
                        deviceView(frame, realEye, kEyePicture)};
        made.fine = 1;
        return made;
    };
    // Balls are given on the device, wherever that is.
    std::vector<glm::dvec3> onDevice;
    for (const glm::dvec3& point :
         TruthBench(setup(ballsFrame(real, realState, realEye, {}))).devicePoints(kBallSpacing))
        onDevice.push_back(glm::inverse(moment.device.rotation) * (point - moment.device.position) +
                           glm::dvec3(0.0, onDevice.size() % 3 == 0 ? kHigh : kFlat, 0.0));
    std::vector<glm::dvec3> wanted, meant;
    for (const glm::dvec3& point : onDevice) {
        wanted.push_back(pointIn(moment.device, point));
        meant.push_back(pointIn(device, point));
    }
    const ShowFrame wantedFrame = ballsFrame(real, realState, realEye, wanted);
    TruthBench bench(setup(wantedFrame));
    const LabLens lens = lensOf(bench.eye(), "eye");
    std::vector<glm::dvec2> places;
    for (const glm::dvec3& point : wanted)
        if (const auto place = imageOf(lens, point)) places.push_back(*place);

    const LabPicture black = bench.seen(Image(truth.projectors.front().camera.size));
    const auto errorsOf = [&](const ShowFrame& frame, const LabPicture& eyePicture) {
        renderer.draw(frame);
        return spotErrors(withoutBlack(bench.seen(renderer.readProjector(0)), black), eyePicture, places, kBallReach,
                          bench.judged());
    };
    renderer.drawEye(wantedFrame);
    const LabPicture eyePicture = lightOf(renderer.readEye());
    ShownError error;
    error.judgedBalls = errorsOf(wantedFrame, eyePicture).size();
    error.balls = errorsOf(ballsFrame(believed, believedState, believedEye, meant), eyePicture);
    judgeSkin(bench, truthMesh(real, realState), truthMesh(believed, believedState),
              estimated.projectors.front().camera, error);
    error.eyeMillimetres = 1e3 * glm::distance(eye, moment.eye.position);
    error.deviceMillimetres =
        1e3 * glm::distance(pointIn(device, {0.0, 0.02, 0.0}), pointIn(moment.device, {0.0, 0.02, 0.0}));
    return error;
}

ShownError shownError(const std::shared_ptr<const Rig>& rig, const Installation& estimated, const Installation& truth) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    ShownError all;
    for (const ShownMoment& moment : shownMoments()) all.add(shownError(renderer, rig, estimated, truth, moment));
    return all;
}

ShownError lightBeside(const std::shared_ptr<const Rig>& rig, const Installation& room,
                       const std::vector<double>& believed, const std::vector<double>& real) {
    const ShownMoment moment = shownMoments().front();
    const TruthDevice device = deviceIn(room, rig, moment.device);
    const TruthState realState{"real", real}, believedState{"believed", believed};
    const ShowFrame frame = ballsFrame(device, realState, glm::vec3(moment.eye.position), {});
    TruthSetup setup{truthMesh(device, realState), tableMesh(room.tableSize), room.projectors.front(),
                     deviceView(frame, glm::vec3(moment.eye.position), kEyePicture)};
    setup.fine = 1;
    const TruthBench bench(setup);
    ShownError error;
    judgeSkin(bench, truthMesh(device, realState), truthMesh(device, believedState), room.projectors.front().camera,
              error);
    return error;
}

} // namespace lumorph::test
