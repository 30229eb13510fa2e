#pragma once

#include <array>
#include <concepts>
#include <string>
#include <type_traits>
#include <variant>

#include "core/scene/installation.h"
#include "core/scene/scene.h"

/// What every part of a scene and of an installation consists of: names, ranges and words, stated once for reading,
/// writing and checking. A visitor has number, vector, color, degrees, flag, text, asset, word, rigid, object (read
/// over what is there), whole (read over a fresh one), plain (like whole, and not written while it is a fresh one),
/// list, and kind. Private to core/scene.
namespace lumorph {

struct Range {
    double min = 0.0;
    double max = 1.0;
};

template <typename T, typename U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

/// An enumeration's words, in its order.
template <std::size_t Count> using Words = std::array<const char*, Count>;
inline constexpr Words<3> kRoles = {"virtual", "physical", "split"};
inline constexpr Words<2> kAnchors = {"device", "world"};
inline constexpr Words<3> kAlphas = {"opaque", "cutout", "blend"};
inline constexpr Words<4> kForms = {"box", "sphere", "cylinder", "plane"};
inline constexpr Words<2> kLightKinds = {"sun", "lamp"};
inline constexpr Words<2> kSkinShows = {"material", "content"};
inline constexpr Words<3> kShowings = {"both", "physical", "virtual"};
inline constexpr Words<5> kOriginWays = {"assumed", "entered", "measured", "simulated", "recorded"};
inline constexpr Words<4> kViewers = {"automatic", "first", "nearest", "none"};
/// In the order of ItemKind; also the keys under which the kinds' own values stand.
inline constexpr Words<std::variant_size_v<ItemKind>> kKinds = {"mesh", "target", "shape", "heights",
                                                                "fog",  "light",  "group"};

inline constexpr double kFar = 100.0; ///< metres: no table is larger
inline constexpr Range kPlace{-kFar, kFar};
inline constexpr Range kShare{0.0, 1.0};
inline constexpr std::size_t kMaxWaves = 32;
inline constexpr std::size_t kMaxHoles = 256;
inline constexpr std::size_t kMaxProjectors = 16;
inline constexpr std::size_t kMaxServos = 256;
inline constexpr std::size_t kMaxCurvePoints = 257;
inline constexpr Range kTrueStroke{-1.0, 2.0}; ///< where a servo really is may lie beyond the rig's range

template <typename V, Is<SceneTexture> T> void fields(V& v, T& texture) {
    v.asset("image", texture.image);
    v.vector("tile", texture.tile, {1e-5, 1e4});
    v.degrees("turnDegrees", texture.turn);
    v.vector("velocity", texture.velocity, {-1e3, 1e3});
    v.number("columns", texture.columns, {1, 256});
    v.number("rows", texture.rows, {1, 256});
    v.number("framesPerSecond", texture.framesPerSecond, {0.0, 1000.0});
}

template <typename V, Is<Material> T> void fields(V& v, T& material) {
    v.text("name", material.name);
    v.color("color", material.color);
    v.plain("colorTexture", material.colorTexture);
    v.plain("normalMap", material.normalMaps[0]);
    v.plain("secondNormalMap", material.normalMaps[1]);
    v.number("normalStrength", material.normalStrength, {-10.0, 10.0});
    v.number("roughness", material.roughness, kShare);
    v.number("metallic", material.metallic, kShare);
    v.color("emission", material.emission);
    v.number("emissionStrength", material.emissionStrength, {0.0, 1000.0});
    v.number("reflection", material.reflection, kShare);
    v.number("refraction", material.refraction, kShare);
    v.number("refractiveIndex", material.refractiveIndex, {1.0, 4.0});
    v.word("alpha", material.alpha, kAlphas);
    v.number("opacity", material.opacity, kShare);
    v.plain("holes", material.holes);
    v.number("holeThreshold", material.holeThreshold, kShare);
    v.flag("unlit", material.unlit);
}

template <typename V, Is<MeshItem> T> void fields(V& v, T& mesh) {
    v.asset("model", mesh.model);
    v.number("animation", mesh.animation, {-1, 100'000});
    v.number("speed", mesh.speed, {-100.0, 100.0});
    v.flag("ownMaterials", mesh.ownMaterials);
}

template <typename V, Is<TargetItem> T> void fields(V& /*v*/, T& /*target*/) {}

template <typename V, Is<ShapeItem> T> void fields(V& v, T& shape) {
    v.word("form", shape.form, kForms);
    v.vector("size", shape.size, {1e-4, kFar});
}

template <typename V, Is<Wave> T> void fields(V& v, T& wave) {
    v.number("amplitude", wave.amplitude, {-1.0, 1.0});
    v.number("length", wave.length, {1e-3, kFar});
    v.number("period", wave.period, {0.0, 1e4});
    v.degrees("directionDegrees", wave.direction);
    v.degrees("phaseDegrees", wave.phase);
}

template <typename V, Is<HeightItem> T> void fields(V& v, T& field) {
    v.vector("size", field.size, {1e-3, kFar});
    v.list("waves", field.waves, kMaxWaves);
    v.asset("image", field.image);
    v.number("imageHeight", field.imageHeight, kPlace);
    v.number("floor", field.floor, kPlace);
    v.number("calmEdge", field.calmEdge, {0.0, kFar});
}

template <typename V, Is<FogItem> T> void fields(V& v, T& fog) {
    v.vector("size", fog.size, {1e-4, kFar});
    v.number("density", fog.density, {0.0, 1e4});
    v.color("color", fog.color);
    v.number("grain", fog.grain, {1e-4, kFar});
    v.vector("drift", fog.drift, kPlace);
}

template <typename V, Is<LightItem> T> void fields(V& v, T& light) {
    v.word("form", light.kind, kLightKinds);
    v.color("color", light.color);
    v.number("intensity", light.intensity, {0.0, 1000.0});
    v.number("softness", light.softness, kShare);
    v.flag("shadows", light.shadows);
}

template <typename V, Is<GroupItem> T> void fields(V& /*v*/, T& /*group*/) {}

template <typename V, Is<ItemMotion> T> void fields(V& v, T& motion) {
    v.turnRate("spinDegrees", motion.spin, {-1000.0, 1000.0});
    v.number("bob", motion.bob, kPlace);
    v.number("bobPeriod", motion.bobPeriod, {0.01, 1e6});
}

template <typename V, Is<SceneItem> T> void fields(V& v, T& item) {
    constexpr int kMostIds = 1'000'000'000;
    v.number("id", item.id, {1, kMostIds});
    v.number("parent", item.parent, {0, kMostIds});
    v.text("name", item.name);
    v.flag("visible", item.visible);
    v.number("opacity", item.opacity, kShare);
    v.word("anchor", item.anchor, kAnchors);
    v.word("role", item.role, kRoles);
    v.vector("position", item.position, kPlace);
    v.rotation("rotation", item.rotation);
    v.vector("scale", item.scale, {1e-4, 1e4});
    v.plain("motion", item.motion);
    v.plain("material", item.material);
    v.kind(item.kind);
}

template <typename V, Is<DeviceSkin::Hole> T> void fields(V& v, T& hole) {
    v.vector("centre", hole.centre, kPlace);
    v.number("radius", hole.radius, {1e-5, kFar});
}

template <typename V, Is<DeviceSkin::Creases> T> void fields(V& v, T& creases) {
    v.number("emphasis", creases.emphasis, {-1.0, 1.0});
    v.degrees("thresholdDegrees", creases.threshold, {0.0, 180.0});
    v.number("width", creases.width, {1e-5, 1.0});
    v.color("color", creases.color);
}

template <typename V, Is<DeviceSkin> T> void fields(V& v, T& skin) {
    v.word("show", skin.show, kSkinShows);
    v.whole("material", skin.material);
    v.number("shrink", skin.shrink, {0.0, 0.9});
    v.list("holes", skin.holes, kMaxHoles);
    v.object("creases", skin.creases);
}

template <typename V, Is<Table> T> void fields(V& v, T& table) { v.whole("material", table.material); }

template <typename V, Is<CalibratedCamera> T> void fields(V& v, T& camera) {
    v.vector("size", camera.size, {16, 16384});
    v.vector("focal", camera.focal, {1.0, 1e6});
    v.vector("principal", camera.principal, {-1e6, 1e6});
    v.vector("distortion", camera.distortion, {-100.0, 100.0});
    v.rigid("cameraFromWorld", camera.cameraFromWorld);
}

template <typename V, Is<Origin> T> void fields(V& v, T& origin) {
    v.word("way", origin.way, kOriginWays);
    v.text("method", origin.method);
    v.text("date", origin.date);
}

template <typename V, Is<InstalledProjector::ResponsePoint> T> void fields(V& v, T& point) {
    v.number("value", point.value, kShare);
    v.vector("light", point.light, {0.0, 2.0});
}

template <typename V, Is<MeasuredServo::Point> T> void fields(V& v, T& point) {
    v.number("commanded", point.commanded, kShare);
    v.number("rising", point.rising, kTrueStroke);
    v.number("falling", point.falling, kTrueStroke);
}

template <typename V, Is<MeasuredServo> T> void fields(V& v, T& servo) {
    v.text("actuator", servo.actuator);
    v.list("points", servo.points, kMaxCurvePoints);
    v.number("lagSeconds", servo.lagSeconds, kShare);
}

template <typename V, Is<InstalledProjector> T> void fields(V& v, T& projector) {
    v.text("name", projector.name);
    v.flag("enabled", projector.enabled);
    v.whole("camera", projector.camera);
    v.number("aperture", projector.focus.aperture, {0.0, 0.5});
    v.number("focusDistance", projector.focus.focusDistance, {0.01, kFar});
    v.number("referenceDistance", projector.referenceDistance, {0.01, kFar});
    v.number("peak", projector.peak, {0.01, 1000.0});
    v.vector("gain", projector.gain, {0.001, 1000.0});
    v.number("gamma", projector.gamma, {0.0, 5.0});
    v.vector("black", projector.black, kShare);
    v.list("responseCurve", projector.responseCurve, kMaxCurvePoints);
    v.plain("lensOrigin", projector.lens);
    v.plain("poseOrigin", projector.pose);
    v.plain("responseOrigin", projector.response);
}

template <typename V, Is<ViewDependence> T> void fields(V& v, T& dependence) {
    v.flag("on", dependence.on);
    v.degrees("thetaDegrees", dependence.theta, {1.0, 90.0});
}

template <typename V, Is<Scene> T> void fields(V& v, T& scene) {
    v.list("items", scene.items, kMaxItems);
    v.object("device", scene.device);
    v.object("table", scene.table);
    v.vector("sky", scene.sky, {0.0, 100.0});
    v.number("exposure", scene.exposure, {1e-3, 1e3});
    v.flag("toneMapping", scene.toneMapping);
    v.word("showing", scene.showing, kShowings);
    v.object("viewDependence", scene.viewDependence);
}

template <typename V, Is<InstalledCamera> T> void fields(V& v, T& camera) {
    v.text("name", camera.name);
    v.text("address", camera.address);
    v.whole("camera", camera.camera);
    v.plain("lensOrigin", camera.lens);
    v.plain("poseOrigin", camera.pose);
}

template <typename V, Is<Installation> T> void fields(V& v, T& installation) {
    v.list("projectors", installation.projectors, kMaxProjectors);
    v.list("cameras", installation.cameras, kMaxProjectors);
    v.vector("tableSize", installation.tableSize, {0.01, kFar});
    v.rigid("worldFromDevice", installation.worldFromDevice);
    v.color("deviceColor", installation.deviceColor);
    v.color("tableColor", installation.tableColor);
    v.vector("eye", installation.eye, kPlace);
    v.vector("eyeFromHead", installation.eyeFromHead, {-1.0, 1.0});
    v.vector("pointerTip", installation.pointerTip, {-2.0, 2.0});
    v.rigid("worldFromTracker", installation.worldFromTracker);
    v.rigid("bodyFromDevice", installation.bodyFromDevice);
    v.list("servos", installation.servos, kMaxServos);
    v.word("viewer", installation.viewer, kViewers);
    v.flag("compensation", installation.compensation);
    v.number("predictionSeconds", installation.predictionSeconds, kShare);
    v.number("trackerSeconds", installation.trackerSeconds, kShare);
    v.plain("tableOrigin", installation.origins.table);
    v.plain("devicePlaceOrigin", installation.origins.devicePlace);
    v.plain("colorsOrigin", installation.origins.colors);
    v.plain("eyeOffsetOrigin", installation.origins.eyeOffset);
    v.plain("delaysOrigin", installation.origins.delays);
    v.plain("trackerOrigin", installation.origins.tracker);
    v.plain("deviceBodyOrigin", installation.origins.deviceBody);
    v.plain("pointerOrigin", installation.origins.pointer);
    v.plain("servosOrigin", installation.origins.servos);
}

} // namespace lumorph
