#include "app/studio/document/state_rules.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/rig/rig_file.h"
#include "core/scene/driver.h"

namespace lumorph::studio {

namespace {

double soundNumber(double before, double value, double low, double high) {
    return std::isfinite(value) ? std::clamp(value, low, high) : before;
}

Placement soundPlacement(const Placement& before, const Placement& edited) {
    constexpr double kFar = 1e6;
    Placement sound;
    sound.scale = soundNumber(before.scale, edited.scale, 1e-6, 1e6);
    sound.yaw = Angle::radians(soundNumber(before.yaw.inRadians(), edited.yaw.inRadians(), -kFar, kFar));
    for (int axis = 0; axis < 3; ++axis)
        sound.translation[axis] =
            static_cast<float>(soundNumber(before.translation[axis], edited.translation[axis], -kFar, kFar));
    sound.relief = edited.relief;
    const float length = glm::length(edited.orientation);
    sound.orientation = !(length > 0.0F) || !std::isfinite(length) ? before.orientation
                        : std::abs(length - 1.0F) < 1e-4F          ? edited.orientation
                                                                   : edited.orientation / length;
    return sound;
}

std::vector<double> soundStrokes(const std::vector<double>& before, const std::vector<double>& edited,
                                 std::size_t count) {
    std::vector<double> sound(count, 0.0);
    for (std::size_t i = 0; i < std::min(count, edited.size()); ++i)
        sound[i] = soundNumber(i < before.size() ? before[i] : 0.0, edited[i], 0.0, 1.0);
    return sound;
}

std::shared_ptr<const RigParts> partsOf(const std::shared_ptr<const Rig>& rig) { return {rig, &rig->parts()}; }

StudioState::RigAsset soundRig(const StudioState::RigAsset& before, StudioState::RigAsset edited) {
    if (!edited.rig) return {edited.path, nullptr};
    const bool replaced = edited.rig != before.rig && (!edited.parts || edited.parts == before.parts);
    if (replaced || !edited.origin || !edited.parts) {
        edited.origin = edited.rig;
        edited.parts = partsOf(edited.rig);
    }
    if (edited.parts.get() == &edited.rig->parts())
        edited.compiled = true;
    else if (before.rig && edited.parts != before.parts)
        edited.compiled = false;
    return edited;
}

StudioState::FieldAsset soundField(const StudioState& before, const StudioState& edited) {
    StudioState::FieldAsset field = edited.field;
    if (!field.field || !edited.rig.rig) return {};
    const bool sameLine = edited.rig.origin == before.rig.origin;
    const bool asBefore = sameLine && field.field == before.field.field;
    // Whoever brings a field of an earlier edit, or a whole state, says what it was built for.
    const bool known = field.builtFor && field.builtFor != before.field.builtFor && (sameLine || !before.rig.rig);
    if (asBefore) {
        field.builtFor = before.field.builtFor;
    } else if (!known) {
        if (!isFieldOf(*field.field, *edited.rig.rig)) return {};
        field.builtFor = partsOf(edited.rig.rig);
    }
    if (!asBefore || edited.rig.parts != before.rig.parts)
        field.stale = !deformAlike(*field.builtFor, *edited.rig.parts);
    return field;
}

std::vector<std::string> namesOf(const StudioState::RigAsset& rig) {
    std::vector<std::string> names;
    if (rig.parts)
        for (const Actuator& actuator : rig.parts->actuators) names.push_back(actuator.name);
    return names;
}

std::shared_ptr<const PoseBook> soundPoses(const StudioState& before, const StudioState& edited) {
    std::shared_ptr<const PoseBook> sound = before.poses ? before.poses : std::make_shared<const PoseBook>();
    try {
        if (edited.poses && edited.poses != before.poses) {
            requireSound(*edited.poses);
            sound = edited.poses;
        }
    } catch (const InvalidInput&) {
    } // they stay as they were
    if (edited.rig.parts == before.rig.parts || edited.rig.origin != before.rig.origin) return sound;
    auto followed = std::make_shared<PoseBook>(*sound);
    followRenames(*followed, namesOf(before.rig), namesOf(edited.rig));
    return *followed == *sound ? sound : followed;
}

bool samePoses(const std::shared_ptr<const PoseBook>& a, const std::shared_ptr<const PoseBook>& b) {
    return a == b || (a && b && *a == *b);
}

bool sameScene(const std::shared_ptr<const Scene>& a, const std::shared_ptr<const Scene>& b) {
    return a == b || (a && b && *a == *b);
}

std::shared_ptr<const Scene> soundScene(const std::shared_ptr<const Scene>& before,
                                        const std::shared_ptr<const Scene>& edited) {
    if (edited && edited == before) return edited;
    try {
        if (edited) {
            checkScene(*edited);
            return edited;
        }
    } catch (const InvalidInput&) {
    } // it stays as it was
    return before ? before : std::make_shared<const Scene>(defaultScene());
}

bool sameInstallation(const std::shared_ptr<const Installation>& a, const std::shared_ptr<const Installation>& b) {
    return a == b || (a && b && *a == *b);
}

/// What an edit changes was entered by hand, unless the edit says where it came from.
std::shared_ptr<const Installation> soundInstallation(const std::shared_ptr<const Installation>& before,
                                                      const std::shared_ptr<const Installation>& edited) {
    if (edited && edited == before) return edited;
    try {
        if (edited) {
            checkInstallation(*edited);
            if (!before) return edited;
            auto marked = std::make_shared<Installation>(*edited);
            markOrigins(*before, *marked, {Origin::Way::entered, {}, utcDate()});
            return marked;
        }
    } catch (const InvalidInput&) {
    } // it stays as it was
    return before ? before : std::make_shared<const Installation>(defaultInstallation());
}

} // namespace

StateParts differenceOf(const StudioState& a, const StudioState& b) {
    StateParts parts;
    const bool otherRig = a.rig.path != b.rig.path || a.rig.origin != b.rig.origin;
    parts.setFlag(StatePart::rig, otherRig);
    parts.setFlag(StatePart::rigEdited, !otherRig && !(a.rig == b.rig));
    parts.setFlag(StatePart::field, !(a.field == b.field));
    parts.setFlag(StatePart::target, !(a.target == b.target));
    parts.setFlag(StatePart::placement, a.placement != b.placement);
    parts.setFlag(StatePart::strokes, a.strokes != b.strokes);
    parts.setFlag(StatePart::poses, !samePoses(a.poses, b.poses));
    parts.setFlag(StatePart::matching, !(a.matching == b.matching));
    parts.setFlag(StatePart::playback, !(a.playback == b.playback));
    parts.setFlag(StatePart::scene, !sameScene(a.scene, b.scene));
    parts.setFlag(StatePart::installation, !sameInstallation(a.installation, b.installation));
    return parts;
}

bool isEdited(const StudioState::RigAsset& rig) {
    return rig.origin && rig.parts && rig.parts.get() != &rig.origin->parts();
}

bool fieldFits(const StudioState& state) {
    if (!state.field.field || !state.field.builtFor || !state.rig.rig) return true;
    const std::vector<Actuator>& was = state.field.builtFor->actuators;
    const std::span<const Actuator> is = state.rig.rig->actuators();
    if (was.size() != is.size()) return false;
    for (std::size_t i = 0; i < was.size(); ++i) {
        // A name that nobody has any more was changed; one that stands elsewhere tells of another order.
        const bool moved = was[i].name != is[i].name && std::ranges::find(is, was[i].name, &Actuator::name) != is.end();
        if (moved) return false;
    }
    return true;
}

StudioState withRig(StudioState state, const StudioState::RigAsset& shown) {
    StudioState::RigAsset& rig = state.rig;
    if (rig.rig || !rig.origin) return state;
    const bool sameLine = shown.rig && shown.origin == rig.origin;
    rig.rig = sameLine ? shown.rig : rig.origin;
    rig.compiled = sameLine && shown.compiled && shown.parts == rig.parts;
    return state;
}

StudioState withTakeover(const StudioState& before, StudioState edited) {
    if (edited.matching.driver != before.matching.driver || !before.scene || !edited.scene) return edited;
    Driver& driver = edited.matching.driver;
    const SceneItem* item = drivingItemShown(*edited.scene);
    const SceneItem* itemBefore = drivingItemShown(*before.scene);
    const bool newItem = item && (!itemBefore || item->id != itemBefore->id || item->role != itemBefore->role);
    const bool newTarget = edited.target.target && edited.target.target != before.target.target;
    const bool itemGone = driver == Driver::sceneItem && !followableItem(*edited.scene);
    const bool targetGone = driver == Driver::target && before.target.target && !edited.target.target;
    if (newTarget || (itemGone && edited.target.target)) driver = Driver::target;
    if (newItem || targetGone) driver = driverOf(*edited.scene);
    return edited;
}

StudioState settled(const StudioState& before, StudioState edited) {
    edited.rig = soundRig(before.rig, std::move(edited.rig));
    edited.field = soundField(before, edited);
    if (!edited.target.target) edited.target.path.clear();
    edited.placement = soundPlacement(before.placement, edited.placement);
    edited.strokes =
        soundStrokes(before.strokes, edited.strokes, edited.rig.parts ? edited.rig.parts->actuators.size() : 0);
    edited.poses = soundPoses(before, edited);
    edited.matching.budget = std::clamp(edited.matching.budget, Microseconds{100}, Microseconds{10'000'000});
    edited.playback.spin = soundNumber(before.playback.spin, edited.playback.spin, -100.0, 100.0);
    edited.scene = soundScene(before.scene, edited.scene);
    edited.installation = soundInstallation(before.installation, edited.installation);
    return edited;
}

} // namespace lumorph::studio
