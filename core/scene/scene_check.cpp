#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "core/base/error.h"
#include "core/scene/project_assets.h"
#include "core/scene/scene.h"

namespace lumorph {
namespace {

constexpr double kFar = 100.0; ///< metres: no table is larger
constexpr double kManyTurns = 1e6;
constexpr std::size_t kMaxWaves = 32;
constexpr std::size_t kMaxHoles = 256;
constexpr std::size_t kMaxProjectors = 16;
constexpr std::size_t kMaxNameLength = 1000;

/// Refuses values of one part of a scene; `subject` names the part.
class Part {
public:
    explicit Part(std::string subject) : subject_(std::move(subject)) {}

    [[noreturn]] void refuse(const std::string& why, const std::string& remedy) const {
        throw InvalidInput(subject_, why, remedy);
    }
    void number(const char* what, double value, double min, double max) const {
        if (value >= min && value <= max) return;
        std::ostringstream why;
        why << what << " is " << value << ", not a number from " << min << " to " << max;
        refuse(why.str(), "correct it");
    }
    template <int Length>
    void vector(const char* what, const glm::vec<Length, float>& value, double min, double max) const {
        for (int i = 0; i < Length; ++i) number(what, static_cast<double>(value[i]), min, max);
    }
    void color(const char* what, const glm::vec3& value) const { vector(what, value, 0.0, 1.0); }
    void angle(const char* what, Angle value) const { number(what, value.inRadians(), -kManyTurns, kManyTurns); }
    void asset(const char* what, const std::string& name) const {
        if (name.size() > kMaxNameLength) refuse(std::string(what) + " has a name that is too long", "rename the file");
    }
    void count(const char* what, std::size_t value, std::size_t most) const {
        if (value > most)
            refuse("has " + std::to_string(value) + " " + what + ", and " + std::to_string(most) + " is the most",
                   "remove some");
    }

private:
    std::string subject_;
};

void check(const Part& part, const SceneTexture& texture) {
    part.asset("a texture", texture.image);
    part.vector("a texture's repeat", texture.tile, 1e-5, 1e4);
    part.angle("a texture's turn", texture.turn);
    part.vector("a texture's velocity", texture.velocity, -1e3, 1e3);
    part.number("a flip-book's columns", texture.columns, 1, 256);
    part.number("a flip-book's rows", texture.rows, 1, 256);
    part.number("a flip-book's pictures a second", texture.framesPerSecond, 0.0, 1000.0);
}

void check(const Part& part, const Material& material) {
    part.color("the colour", material.color);
    check(part, material.colorTexture);
    for (const SceneTexture& map : material.normalMaps) check(part, map);
    part.number("the strength of the bumps", static_cast<double>(material.normalStrength), -10.0, 10.0);
    part.number("the roughness", static_cast<double>(material.roughness), 0.0, 1.0);
    part.number("the metallic share", static_cast<double>(material.metallic), 0.0, 1.0);
    part.color("the glow's colour", material.emission);
    part.number("the glow's strength", static_cast<double>(material.emissionStrength), 0.0, 1000.0);
    part.number("the reflection", static_cast<double>(material.reflection), 0.0, 1.0);
    part.number("the refraction", static_cast<double>(material.refraction), 0.0, 1.0);
    part.number("the refractive index", static_cast<double>(material.refractiveIndex), 1.0, 4.0);
    part.number("the opacity", static_cast<double>(material.opacity), 0.0, 1.0);
    check(part, material.holes);
    part.number("the threshold of the holes", static_cast<double>(material.holeThreshold), 0.0, 1.0);
}

void check(const Part& part, const MeshItem& mesh) {
    part.asset("the model", mesh.model);
    part.number("the animation's number", mesh.animation, -1, 100'000);
    part.number("the animation's speed", mesh.speed, -100.0, 100.0);
}

void check(const Part& /*part*/, const TargetItem& /*target*/) {}

void check(const Part& part, const ShapeItem& shape) { part.vector("the size", shape.size, 1e-4, kFar); }

void check(const Part& part, const HeightItem& field) {
    part.vector("the size", field.size, 1e-3, kFar);
    part.count("waves", field.waves.size(), kMaxWaves);
    for (const Wave& wave : field.waves) {
        part.number("a wave's amplitude", wave.amplitude, -1.0, 1.0);
        part.number("a wave's length", wave.length, 1e-3, kFar);
        part.number("a wave's period", wave.period, 0.0, 1e4);
        part.angle("a wave's direction", wave.direction);
        part.angle("a wave's phase", wave.phase);
    }
    part.asset("the height picture", field.image);
    part.number("the height of white", field.imageHeight, -kFar, kFar);
    part.number("the floor", field.floor, -kFar, kFar);
    part.number("the calm edge", field.calmEdge, 0.0, kFar);
}

void check(const Part& part, const FogItem& fog) {
    part.vector("the size", fog.size, 1e-4, kFar);
    part.number("the density", fog.density, 0.0, 1e4);
    part.color("the colour of the fog", fog.color);
    part.number("the grain", fog.grain, 1e-4, kFar);
    part.vector("the drift", fog.drift, -kFar, kFar);
}

void check(const Part& part, const LightItem& light) {
    part.color("the colour of the light", light.color);
    part.number("the intensity", light.intensity, 0.0, 1000.0);
    part.number("the softness", light.softness, 0.0, 1.0);
}

void check(const Part& /*part*/, const GroupItem& /*group*/) {}

/// How an item is called in messages.
std::string subjectOf(const SceneItem& item) {
    return item.name.empty() ? "item " + std::to_string(item.id) : "item \"" + item.name.substr(0, 80) + "\"";
}

bool drives(const SceneItem& item) { return item.role != ItemRole::virtualOnly; }

bool hasShape(const SceneItem& item) {
    return !std::holds_alternative<LightItem>(item.kind) && !std::holds_alternative<FogItem>(item.kind) &&
           !std::holds_alternative<GroupItem>(item.kind);
}

void check(const SceneItem& item) {
    const Part part(subjectOf(item));
    if (item.name.size() > kMaxNameLength) part.refuse("its name is too long", "shorten it");
    if (item.id < 1) part.refuse("its id is " + std::to_string(item.id), "number items from 1 up");
    part.number("the opacity", static_cast<double>(item.opacity), 0.0, 1.0);
    part.vector("the position", item.position, -kFar, kFar);
    const glm::quat& q = item.rotation;
    part.number("the length of the rotation", static_cast<double>(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w), 0.98,
                1.02);
    part.vector("the scale", item.scale, 1e-4, 1e4);
    part.number("the spin", item.motion.spin, -1000.0, 1000.0);
    part.number("the rise and fall", item.motion.bob, -kFar, kFar);
    part.number("the period of rise and fall", item.motion.bobPeriod, 0.01, 1e6);
    if (drives(item) && !hasShape(item))
        part.refuse("servos cannot follow it: it has no shape", "give it the role \"virtual\"");
    check(part, item.material);
    std::visit([&part](const auto& kind) { check(part, kind); }, item.kind);
}

/// Ids once each; parents are groups that stand before their members, so that there are no circles.
void checkTree(const std::vector<SceneItem>& items) {
    std::map<int, bool> isGroup;
    for (const SceneItem& item : items) {
        const Part part(subjectOf(item));
        if (item.parent != 0) {
            const auto parent = isGroup.find(item.parent);
            if (parent == isGroup.end())
                part.refuse("its group " + std::to_string(item.parent) + " does not stand before it",
                            "put the group first, or take the item out of it");
            if (!parent->second)
                part.refuse("its parent " + std::to_string(item.parent) + " is no group", "take the item out of it");
        }
        if (!isGroup.emplace(item.id, std::holds_alternative<GroupItem>(item.kind)).second)
            part.refuse("its id " + std::to_string(item.id) + " is used twice", "give each item an id of its own");
    }
}

void checkDriving(const std::vector<SceneItem>& items) {
    const auto first = std::ranges::find_if(items, drives);
    if (first == items.end()) return;
    const auto second = std::find_if(first + 1, items.end(), drives);
    if (second != items.end())
        throw InvalidInput(subjectOf(*second), "the servos follow " + subjectOf(*first) + " already",
                           "give all but one of them the role \"virtual\"");
}

void check(const DeviceSkin& skin) {
    const Part part("device");
    check(part, skin.material);
    part.number("the shrinking", skin.shrink, 0.0, 0.9);
    part.count("holes", skin.holes.size(), kMaxHoles);
    for (const DeviceSkin::Hole& hole : skin.holes) {
        part.vector("a hole's centre", hole.centre, -kFar, kFar);
        part.number("a hole's radius", hole.radius, 1e-5, kFar);
    }
    part.number("the emphasis of creases", skin.creases.emphasis, -1.0, 1.0);
    part.number("the threshold of creases", skin.creases.threshold.inDegrees(), 0.0, 180.0);
    part.number("the width of creases", skin.creases.width, 1e-5, 1.0);
    part.color("the colour of creases", skin.creases.color);
}

void checkRigid(const Part& part, const char* what, const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) part.number(what, matrix[column][row], -1e3, 1e3);
    const glm::dmat3 rotation(matrix);
    const glm::dmat3 product = glm::transpose(rotation) * rotation;
    double worst = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            worst = std::max(worst, std::abs(product[column][row] - (column == row ? 1.0 : 0.0)));
    const bool lastRow = matrix[0][3] == 0.0 && matrix[1][3] == 0.0 && matrix[2][3] == 0.0 && matrix[3][3] == 1.0;
    if (worst > 1e-3 || glm::determinant(rotation) < 0.0 || !lastRow)
        part.refuse(std::string(what) + " is not a rotation and a translation", "correct it, or calibrate again");
}

void check(const SceneProjector& projector) {
    const Part part("projector \"" + projector.name.substr(0, 80) + "\"");
    if (projector.name.size() > kMaxNameLength) part.refuse("its name is too long", "shorten it");
    const CalibratedCamera& camera = projector.camera;
    for (int axis = 0; axis < 2; ++axis) {
        part.number("the number of pixels", camera.size[axis], 16, 16384);
        part.number("the focal length", camera.focal[axis], 1.0, 1e6);
        part.number("the principal point", camera.principal[axis], -1e6, 1e6);
    }
    for (const double coefficient : camera.distortion) part.number("the distortion", coefficient, -100.0, 100.0);
    checkRigid(part, "the pose", camera.cameraFromWorld);
    part.number("the reference distance", projector.referenceDistance, 0.01, kFar);
    part.number("the peak", projector.peak, 0.01, 1000.0);
    part.vector("the gain", projector.gain, 0.001, 1000.0);
    if (projector.gamma != 0.0) part.number("the gamma", projector.gamma, 0.2, 5.0);
}

} // namespace

void checkScene(const Scene& scene) {
    const Part part("scene");
    part.count("items", scene.items.size(), static_cast<std::size_t>(kMaxItems));
    for (const SceneItem& item : scene.items) check(item);
    checkTree(scene.items);
    checkDriving(scene.items);
    check(scene.device);
    part.vector("the table's size", scene.table.size, 0.01, kFar);
    check(Part("table"), scene.table.material);
    part.vector("the sky's light", scene.sky, 0.0, 100.0);
    part.number("the exposure", scene.exposure, 1e-3, 1e3);
    part.number("the view-dependent bend", scene.viewDependence.theta.inDegrees(), 1.0, 90.0);
    part.number("the prediction", scene.predictionSeconds, 0.0, 1.0);
    part.count("projectors", scene.projectors.size(), kMaxProjectors);
    for (const SceneProjector& projector : scene.projectors) check(projector);
    part.vector("the eye's position", scene.eye, -kFar, kFar);
    checkRigid(part, "the device's place", glm::dmat4(scene.worldFromDevice));
}

} // namespace lumorph
