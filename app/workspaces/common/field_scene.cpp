#include "app/workspaces/common/field_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <map>
#include <span>
#include <utility>

#include "app/workspaces/common/field_cloud.h"
#include "core/mdf/field_view.h"

namespace lumorph::studio {

namespace {

using Positions = std::shared_ptr<const std::vector<glm::vec3>>;

/// Where neighbouring faces meet at more than this, an edge is drawn sharp.
constexpr double kCreaseDegrees = 35.0;
/// Triangles that are shaded at once; a larger mesh would hold the window up.
constexpr std::size_t kShadedAtOnce = 20'000;

struct Shaped {
    std::shared_ptr<const SurfaceShading> shading;
    Positions positions;
};

/// A number for each vertex: the same where the same actuators move it.
std::vector<std::uint32_t> partsOf(const Rig& rig) {
    std::map<std::vector<std::uint16_t>, std::uint32_t> numbers;
    std::vector<std::uint32_t> parts;
    for (std::uint32_t vertex = 0; vertex < rig.restMesh().positions.size(); ++vertex) {
        const auto moves = rig.actuatorsOf(vertex);
        const auto number = static_cast<std::uint32_t>(numbers.size());
        parts.push_back(numbers.try_emplace({moves.begin(), moves.end()}, number).first->second);
    }
    return parts;
}

Shaped shapeOf(TriangleMesh mesh, std::span<const std::uint32_t> parts = {}) {
    Shaped shaped;
    shaped.shading = std::make_shared<SurfaceShading>(mesh, Angle::degrees(kCreaseDegrees), parts);
    shaped.positions = std::make_shared<std::vector<glm::vec3>>(std::move(mesh.positions));
    return shaped;
}

/// A surface made from `Key`, once for each key; beside the window's thread where it may take long. Until the new one
/// is there, the last one of the same object is kept (`keepLast`) or there is none.
template <class Key> class Prepared {
public:
    template <class Make> const Shaped& of(const Key& key, bool aside, bool keepLast, Make make) {
        if (!key_ || *key_ != key) {
            key_ = key;
            if (!keepLast) shaped_ = {};
            // A future that is dropped waits for its work, so a job that is no longer wanted finishes elsewhere first.
            if (coming_.valid()) old_.push_back(std::move(coming_));
            coming_ = std::async(aside ? std::launch::async : std::launch::deferred, std::move(make));
            if (!aside) shaped_ = coming_.get();
        }
        std::erase_if(old_, [](const auto& work) { return isDone(work); });
        if (coming_.valid() && isDone(coming_)) shaped_ = coming_.get();
        return shaped_;
    }
    void clear() {
        key_.reset();
        shaped_ = {};
    }
    [[nodiscard]] bool pending() const { return coming_.valid(); }

private:
    static bool isDone(const std::future<Shaped>& work) {
        return work.wait_for(std::chrono::seconds(0)) != std::future_status::timeout;
    }

    std::optional<Key> key_;
    Shaped shaped_;
    std::future<Shaped> coming_;
    std::vector<std::future<Shaped>> old_;
};

struct SurfaceKey {
    std::shared_ptr<const MatchField> field;
    std::optional<int> actuator;
    int level = 0;
    bool operator==(const SurfaceKey&) const = default;
};

/// What a voxel cloud was made from.
struct CloudKey {
    std::shared_ptr<const MatchField> field;
    FieldDisplay display;
    glm::vec3 low{0.0F}, high{0.0F};
    bool operator==(const CloudKey&) const = default;
};

/// The parts of a display that a voxel cloud does not depend on are made equal.
FieldDisplay cloudPart(FieldDisplay display) {
    display.surfaceLevel = 0;
    display.showTarget = display.showMismatch = display.showWish = false;
    display.voxel.reset();
    return display;
}

glm::vec3 frameLineColor(Theme theme) {
    return theme == Theme::dark ? glm::vec3(0.36F, 0.39F, 0.42F) : glm::vec3(0.62F, 0.65F, 0.68F);
}

void include(Box& box, const Box& part, const glm::mat4& worldFromPart) {
    if (part.empty()) return;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner((i & 1) != 0 ? part.max.x : part.min.x, (i & 2) != 0 ? part.max.y : part.min.y,
                               (i & 4) != 0 ? part.max.z : part.min.z);
        box.include(glm::vec3(worldFromPart * glm::vec4(corner, 1.0F)));
    }
}

bool differ(const std::vector<double>& a, const std::vector<double>& b) {
    return !std::equal(a.begin(), a.end(), b.begin(), b.end(),
                       [](double x, double y) { return std::abs(x - y) < 0.004; });
}

} // namespace

struct FieldSceneBuilder::Data {
    FieldSceneColors colors;
    bool patient = true;
    std::shared_ptr<const Rig> shadedRig;
    Prepared<std::shared_ptr<const Rig>> deviceShape;
    Prepared<std::shared_ptr<const MatchTarget>> targetShape;
    Prepared<SurfaceKey> levelShape;
    std::optional<CloudKey> cloudKey;
    std::shared_ptr<const std::vector<std::uint8_t>> cloudClasses;
    std::shared_ptr<const std::vector<std::uint8_t>> tintOf;
    std::shared_ptr<const std::vector<std::uint8_t>> thick;
    BitColumns touched;
    std::shared_ptr<const std::vector<ViewportVoxel>> cloud;
    std::vector<double> wishStrokes;
    Positions wish;
    std::shared_ptr<const Rig> wishRig;

    void addDevice(ViewportScene& scene, const MatchFrame& frame, bool tinted);
    void addWish(ViewportScene& scene, const MatchFrame& frame);
    void addTarget(ViewportScene& scene, const MatchFrame& frame, bool selected);
    void addTint(ViewportScene& scene, const MatchFrame& frame);
    void addField(ViewportScene& scene, const MatchFrame& frame, const FieldDisplay& display);
    void addLevelSurface(ViewportScene& scene, const MatchFrame& frame, const FieldDisplay& display);
    void addFrameLines(ViewportScene& scene, const MatchFrame& frame, const FieldDisplay& display) const;
    void updateCloud(const MatchFrame& frame, const FieldDisplay& display);
    bool updateTouched(const MatchFrame& frame);
};

void FieldSceneBuilder::Data::addDevice(ViewportScene& scene, const MatchFrame& frame, bool tinted) {
    const TriangleMesh& rest = frame.rig->restMesh();
    // Few edits of a rig touch its mesh, and looking whether one did takes less time than shading.
    if (!shadedRig || (shadedRig != frame.rig && !(shadedRig->restMesh() == rest))) shadedRig = frame.rig;
    const Shaped& shaped = deviceShape.of(shadedRig, !patient && rest.triangles.size() > kShadedAtOnce, false,
                                          [rig = shadedRig] { return shapeOf(rig->restMesh(), partsOf(*rig)); });
    if (!shaped.shading) return;
    ViewportSurface surface;
    surface.id = kDeviceId;
    surface.shading = shaped.shading;
    const bool posed = frame.devicePositions && frame.devicePositions->size() == rest.positions.size();
    surface.positions = posed ? frame.devicePositions : shaped.positions;
    surface.color = colors.device;
    surface.paper = 1.0F;
    surface.tinted = tinted;
    surface.tintedBy = 1U << kVoxelOverfilled; // what the target lacks is seen on the target
    scene.surfaces.push_back(std::move(surface));
}

void FieldSceneBuilder::Data::addWish(ViewportScene& scene, const MatchFrame& frame) {
    const Rig& rig = *frame.rig;
    if (frame.wantedStrokes.size() != rig.actuatorCount() || !differ(frame.wantedStrokes, frame.estimatedStrokes))
        return;
    if (wishRig != frame.rig || wishStrokes != frame.wantedStrokes) {
        auto positions = std::make_shared<std::vector<glm::vec3>>(rig.restMesh().positions.size());
        rig.deform(frame.wantedStrokes, *positions);
        wish = std::move(positions);
        wishRig = frame.rig;
        wishStrokes = frame.wantedStrokes;
    }
    const auto shading = scene.surfaces.empty() ? nullptr : scene.surfaces.front().shading;
    if (!shading) return;
    ViewportSurface surface;
    surface.shading = shading;
    surface.positions = wish;
    surface.color = colors.wish;
    surface.opacity = 0.28F;
    scene.surfaces.push_back(std::move(surface));
}

void FieldSceneBuilder::Data::addTarget(ViewportScene& scene, const MatchFrame& frame, bool selected) {
    const TriangleMesh& mesh = frame.target->solid.mesh;
    const Shaped& shaped = targetShape.of(frame.target, !patient && mesh.triangles.size() > kShadedAtOnce, false,
                                          [kept = frame.target] { return shapeOf(kept->solid.mesh); });
    if (!shaped.shading) return;
    ViewportSurface surface;
    surface.id = kTargetId;
    surface.shading = shaped.shading;
    const bool posed = frame.targetPositions && frame.targetPositions->size() == shaped.shading->meshVertexCount();
    surface.positions = posed ? frame.targetPositions : shaped.positions;
    surface.worldFromSurface = frame.deviceFromTarget;
    surface.color = colors.target;
    surface.opacity = frame.matched ? 0.5F : 0.6F;
    surface.tinted = true;
    surface.tintedBy = 1U << kVoxelUnmatched;
    surface.outlined = selected;
    scene.surfaces.push_back(std::move(surface));
}

void FieldSceneBuilder::Data::addTint(ViewportScene& scene, const MatchFrame& frame) {
    ViewportTint tint;
    tint.frame = frame.field->field.frame;
    if (tintOf != frame.classes) {
        tintOf = frame.classes;
        thick = std::make_shared<const std::vector<std::uint8_t>>(thickClasses(tint.frame, *frame.classes));
    }
    tint.classes = thick;
    tint.colors[kVoxelUnmatched] = glm::vec4(colors.unmatched, 0.75F);
    tint.colors[kVoxelOverfilled] = glm::vec4(colors.overfilled, 0.75F);
    scene.tint = std::move(tint);
}

/// Whether the target's voxels are others than last time.
bool FieldSceneBuilder::Data::updateTouched(const MatchFrame& frame) {
    if (cloudClasses == frame.classes) return false;
    cloudClasses = frame.classes;
    BitColumns now = frame.classes ? targetVoxels(frame.field->field.frame, *frame.classes) : BitColumns();
    if (now == touched) return false;
    touched = std::move(now);
    return true;
}

void FieldSceneBuilder::Data::updateCloud(const MatchFrame& frame, const FieldDisplay& display) {
    CloudKey key{frame.field, cloudPart(display), colors.levelLow, colors.levelHigh};
    const bool moved = display.touchedOnly && updateTouched(frame);
    if (cloud && cloudKey == key && !moved) return;
    const BitColumns* touchedBy = display.touchedOnly && frame.classes ? &touched : nullptr;
    cloud = std::make_shared<std::vector<ViewportVoxel>>(
        fieldCloud(frame.field->field, display, touchedBy, colors.levelLow, colors.levelHigh));
    cloudKey = std::move(key);
}

void FieldSceneBuilder::Data::addField(ViewportScene& scene, const MatchFrame& frame, const FieldDisplay& display) {
    if (display.show != FieldDisplay::Show::voxels) return;
    updateCloud(frame, display);
    ViewportVoxels voxels;
    voxels.id = kFieldId;
    voxels.frame = frame.field->field.frame;
    voxels.voxels = cloud;
    scene.voxels.push_back(std::move(voxels));
}

void FieldSceneBuilder::Data::addLevelSurface(ViewportScene& scene, const MatchFrame& frame,
                                              const FieldDisplay& display) {
    if (display.show != FieldDisplay::Show::surface) return;
    const Field& field = frame.field->field;
    const int level = std::clamp(display.surfaceLevel, 0, std::max(field.levels - 1, 0));
    const bool known = display.actuator && *display.actuator >= 0 &&
                       static_cast<std::size_t>(*display.actuator) < field.actuators.size();
    const SurfaceKey key{frame.field, known ? display.actuator : std::nullopt, level};
    const Shaped& shaped = levelShape.of(key, !patient, true, [key] {
        const auto actuator = key.actuator ? std::optional(static_cast<std::size_t>(*key.actuator)) : std::nullopt;
        return shapeOf(levelSurface(key.field->field, actuator, key.level));
    });
    if (!shaped.shading || shaped.positions->empty()) return;
    ViewportSurface drawn;
    drawn.id = kFieldId;
    drawn.shading = shaped.shading;
    drawn.positions = shaped.positions;
    drawn.color = levelColor(level, field.levels, colors.levelLow, colors.levelHigh);
    drawn.opacity = 0.7F;
    scene.surfaces.push_back(std::move(drawn));
}

void FieldSceneBuilder::Data::addFrameLines(ViewportScene& scene, const MatchFrame& frame,
                                            const FieldDisplay& display) const {
    const VoxelFrame& voxels = frame.field->field.frame;
    addBox(scene.lines, voxels.box(), frameLineColor(colors.theme), 1.0F);
    if (!display.voxel) return;
    const auto side = static_cast<float>(voxels.voxelSize);
    const glm::vec3 low = voxels.origin + side * glm::vec3(*display.voxel);
    addBox(scene.lines, {low, low + side}, colors.accent, 2.0F, true);
}

FieldSceneBuilder::FieldSceneBuilder() : data_(std::make_unique<Data>()) {}
FieldSceneBuilder::~FieldSceneBuilder() = default;

void FieldSceneBuilder::setColors(const FieldSceneColors& colors) { data_->colors = colors; }

void FieldSceneBuilder::setPatient(bool patient) { data_->patient = patient; }

bool FieldSceneBuilder::pending() const {
    return data_->deviceShape.pending() || data_->targetShape.pending() || data_->levelShape.pending();
}

std::shared_ptr<const ViewportScene> FieldSceneBuilder::build(const MatchFrame& frame, const FieldDisplay& display,
                                                              bool targetSelected) {
    auto scene = std::make_shared<ViewportScene>();
    scene->theme = data_->colors.theme;
    scene->accent = data_->colors.accent;
    const bool tinted = display.showMismatch && frame.matched && frame.field && frame.classes &&
                        frame.classes->size() == frame.field->field.frame.voxelCount();
    if (frame.rig) {
        scene->bounds = frame.rig->reach();
        scene->groundHeight = boundingBox(frame.rig->restMesh().positions).min.y;
        data_->addDevice(*scene, frame, tinted);
        if (display.showWish) data_->addWish(*scene, frame);
    }
    if (frame.field) {
        scene->bounds.include(frame.field->field.frame.box());
        data_->addFrameLines(*scene, frame, display);
        data_->addField(*scene, frame, display);
        data_->addLevelSurface(*scene, frame, display);
    }
    if (tinted) data_->addTint(*scene, frame);
    if (frame.target && display.showTarget) {
        data_->addTarget(*scene, frame, targetSelected);
        include(scene->bounds, frame.target->box, frame.deviceFromTarget);
    } else if (!frame.target) {
        data_->targetShape.clear();
    }
    return scene;
}

} // namespace lumorph::studio
