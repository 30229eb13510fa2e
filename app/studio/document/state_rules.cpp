#include "app/studio/document/state_rules.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/rig/rig_file.h"

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
    return sound;
}

std::vector<double> soundStrokes(const std::vector<double>& before, const std::vector<double>& edited,
                                 std::size_t count) {
    std::vector<double> sound(count, 0.0);
    for (std::size_t i = 0; i < std::min(count, edited.size()); ++i)
        sound[i] = soundNumber(i < before.size() ? before[i] : 0.0, edited[i], 0.0, 1.0);
    return sound;
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
    parts.setFlag(StatePart::rig, !(a.rig == b.rig));
    parts.setFlag(StatePart::field, !(a.field == b.field));
    parts.setFlag(StatePart::target, !(a.target == b.target));
    parts.setFlag(StatePart::placement, a.placement != b.placement);
    parts.setFlag(StatePart::strokes, a.strokes != b.strokes);
    parts.setFlag(StatePart::matching, !(a.matching == b.matching));
    parts.setFlag(StatePart::playback, !(a.playback == b.playback));
    parts.setFlag(StatePart::scene, !sameScene(a.scene, b.scene));
    parts.setFlag(StatePart::installation, !sameInstallation(a.installation, b.installation));
    return parts;
}

bool isFieldOf(const MatchField& field, const Rig& rig) {
    return &field.rig.parts() == &rig.parts() || writeRigGlb(rig) == field.field.rigGlb;
}

StudioState settled(const StudioState& before, StudioState edited) {
    const bool asBefore = edited.rig.rig == before.rig.rig && edited.field.field == before.field.field;
    if (edited.field.field && !asBefore && (!edited.rig.rig || !isFieldOf(*edited.field.field, *edited.rig.rig)))
        edited.field = {};
    if (!edited.field.field) edited.field.path.clear();
    if (!edited.target.target) edited.target.path.clear();
    edited.placement = soundPlacement(before.placement, edited.placement);
    edited.strokes = soundStrokes(before.strokes, edited.strokes, edited.rig.rig ? edited.rig.rig->actuatorCount() : 0);
    edited.matching.budget = std::clamp(edited.matching.budget, Microseconds{100}, Microseconds{10'000'000});
    edited.playback.spin = soundNumber(before.playback.spin, edited.playback.spin, -100.0, 100.0);
    edited.scene = soundScene(before.scene, edited.scene);
    edited.installation = soundInstallation(before.installation, edited.installation);
    return edited;
}

} // namespace lumorph::studio
