#include "app/cli/render_views.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "calibration/lab/lab_world.h"
#include "core/base/error.h"
#include "core/loop/hand_near.h"
#include "core/render/figure/figure.h"
#include "core/render/gl/headless_context.h"
#include "core/render/viewport/viewport_renderer.h"

namespace lumorph::cli {

namespace {

constexpr glm::ivec2 kEyeSize{1280, 800};

std::string words(glm::ivec2 size) { return std::to_string(size.x) + " x " + std::to_string(size.y); }

void checkPlace(const char* option, const glm::vec3& place, const char* whyAboveTable) {
    if (!std::isfinite(place.x + place.y + place.z))
        throw InvalidInput(option, "it is not a finite place", "give three numbers, metres: X,Y,Z");
    if (!(place.y > 0.0F))
        throw InvalidInput(option, whyAboveTable, "give a height (the second number) above 0, in metres");
}

void checkRequest(const ShowFrame& frame, const ViewRequest& request) {
    constexpr auto kSeesNothing = "it is not above the table, so nothing is seen from there";
    checkPlace("--eye", frame.eye.value_or(frame.installation->eye), kSeesNothing);
    if (request.observer) checkPlace("--observer", *request.observer, kSeesNothing);
    for (const glm::vec3& hand : request.hands)
        checkPlace("--hand", hand, "it is not above the table, so it is in no light");
    if (request.handsTracked && request.hands.empty())
        throw InvalidInput("--hands-tracked", "there is no hand that could be tracked", "add --hand X,Y,Z");
    if (request.view == ViewRequest::View::lab) return;
    if (!request.hands.empty())
        throw InvalidInput("--hand", "only the lab has visitors", "use it with --view lab, or leave it out");
    if (request.ambient > 0.0)
        throw InvalidInput("--ambient", "only the lab has the light of a room",
                           "use it with --view lab, or leave it out");
}

const InstalledProjector& projectorOf(const ShowFrame& frame, std::size_t number) {
    const auto& projectors = frame.installation->projectors;
    const std::string name = "projector " + std::to_string(number);
    if (projectors.empty()) throw InvalidInput(name, "the project has no projector", "add one to its installation");
    if (number >= projectors.size())
        throw InvalidInput(name, "there is no such projector",
                           "count from 0; the project's last one is " + std::to_string(projectors.size() - 1));
    if (!projectors[number].enabled)
        throw InvalidInput(name, "it is off in this project", "switch it on in its installation");
    return projectors[number];
}

glm::vec3 eyeOf(const ShowFrame& frame) { return frame.eye.value_or(frame.installation->eye); }

RenderedView projectorView(SpatialRenderer& renderer, const ShowFrame& frame, const ViewRequest& request) {
    const CalibratedCamera& camera = projectorOf(frame, request.projector).camera;
    if (request.size && *request.size != camera.size)
        throw InvalidInput("--size", "the projector's picture has its own size, " + words(camera.size),
                           "leave --size out");
    renderer.draw(frame);
    return {renderer.readProjector(request.projector), camera, renderer.times()};
}

RenderedView labView(SpatialRenderer& renderer, const ShowFrame& frame, const ViewRequest& request) {
    const CalibratedCamera camera =
        deviceView(frame, request.observer.value_or(eyeOf(frame)), request.size.value_or(kEyeSize));
    ShowFrame known = frame;
    if (request.handsTracked)
        for (const glm::vec3& hand : request.hands) {
            const std::vector<Capsule> shape = handAt(hand, eyeOf(frame));
            known.hands.insert(known.hands.end(), shape.begin(), shape.end());
        }
    renderer.draw(known);
    std::vector<Image> pictures;
    for (std::size_t i = 0; i < frame.installation->projectors.size(); ++i)
        pictures.push_back(frame.installation->projectors[i].enabled ? renderer.readProjector(i) : Image());
    const auto start = std::chrono::steady_clock::now();
    LabWorld world = labWorld(frame, pictures);
    for (const glm::vec3& hand : request.hands) world.blockers.push_back(visitorHand(hand, eyeOf(frame)));
    world.ambient = glm::vec3(static_cast<float>(request.ambient));
    RenderedView result{Lab(std::move(world)).view(camera), camera, renderer.times()};
    result.labMilliseconds =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return result;
}

RenderedView eyeView(SpatialRenderer& renderer, const ShowFrame& frame, const ViewRequest& request) {
    const glm::ivec2 size = request.size.value_or(kEyeSize);
    renderer.setEyeSize(size);
    const bool mask = request.view == ViewRequest::View::mask;
    mask ? renderer.draw(frame) : renderer.drawEye(frame);
    return {mask ? renderer.readMask() : renderer.readEye(), deviceView(frame, eyeOf(frame), size), renderer.times()};
}

/// Looks from a place at the middle of the device's reach, as near as holds all of it.
ViewCamera cameraFrom(const glm::vec3& place, const Box& reach, const glm::mat4& worldFromDevice, glm::ivec2 size) {
    ViewCamera camera;
    camera.pivot = glm::vec3(worldFromDevice * glm::vec4(reach.centre(), 1.0F));
    const glm::dvec3 way(place - camera.pivot);
    camera.distance = glm::length(way);
    camera.yaw = Angle::radians(std::atan2(way.x, way.z));
    camera.pitch = Angle::radians(std::asin(std::clamp(way.y / std::max(camera.distance, 1e-9), -1.0, 1.0)));
    Box box;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner((i & 1) != 0 ? reach.min.x : reach.max.x, (i & 2) != 0 ? reach.min.y : reach.max.y,
                               (i & 4) != 0 ? reach.min.z : reach.max.z);
        box.include(glm::vec3(worldFromDevice * glm::vec4(corner, 1.0F)));
    }
    // The distance stays the observer's; the field of view is what frames the device.
    const double near = framed(camera, box, static_cast<float>(size.x) / static_cast<float>(size.y)).distance;
    const double tangent = std::tan(0.5 * camera.fieldOfView.inRadians()) * near / camera.distance;
    camera.fieldOfView = Angle::radians(std::min(2.0 * std::atan(tangent), 2.6));
    return camera;
}

RenderedView plainView(const ShowFrame& frame, const ViewRequest& request) {
    const glm::ivec2 size = request.size.value_or(kEyeSize);
    ViewportSurface surface;
    surface.shading = std::make_shared<SurfaceShading>(frame.rig->restMesh(), Angle::degrees(35.0));
    surface.positions = frame.devicePositions;
    surface.worldFromSurface = frame.worldFromDevice;
    surface.color = kPaperColor;
    surface.paper = 1.0F;
    ViewportScene scene;
    scene.bounds = boundingBox(deviceMesh(frame).positions);
    scene.surfaces.push_back(std::move(surface));
    const ViewCamera camera =
        cameraFrom(request.observer.value_or(eyeOf(frame)), frame.rig->reach(), frame.worldFromDevice, size);
    ViewportRenderer renderer;
    return {renderViewport(renderer, scene, camera, size)};
}

} // namespace

RenderedView renderView(const ShowFrame& frame, const ViewRequest& request) {
    checkRequest(frame, request);
    const HeadlessContext context;
    if (request.view == ViewRequest::View::device) return plainView(frame, request);
    SpatialRenderer renderer;
    renderer.setMeasuring(true);
    RenderedView result = request.view == ViewRequest::View::projector ? projectorView(renderer, frame, request)
                          : request.view == ViewRequest::View::lab     ? labView(renderer, frame, request)
                                                                       : eyeView(renderer, frame, request);
    result.warnings = renderer.warnings();
    return result;
}

} // namespace lumorph::cli
