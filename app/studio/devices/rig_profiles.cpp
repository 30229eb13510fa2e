#include "app/studio/devices/rig_profiles.h"

#include <algorithm>
#include <tuple>

#include "core/base/error.h"
#include "devices/controllers/controller_kinds.h"

namespace lumorph::studio {
namespace {

constexpr auto kProfileKey = "device/profile/"; ///< and the rig's name

QString usualName(const Rig& rig) { return fileNameOf(QString::fromStdString(rig.name())); }

/// What a rig's file says of a servo's pulses.
auto drivenBy(const ServoSetup& servo) { return std::tie(servo.pulseMin, servo.pulseMax, servo.curve, servo.reversed); }

bool sameChannels(const DeviceProfile& a, const DeviceProfile& b) {
    return std::ranges::equal(a.servos, b.servos, {}, &ServoSetup::channel, &ServoSetup::channel);
}

} // namespace

QString RigProfiles::lastOf(const Rig& rig) const {
    const QString usual = usualName(rig);
    const QString name = settings_.value(kProfileKey + usual, usual).toString();
    return shelf_.has(name) ? name : QString();
}

DeviceProfile RigProfiles::load(const QString& name, const Rig& rig) const {
    DeviceProfile loaded = shelf_.load(name);
    if (loaded.servos.size() != rig.actuatorCount())
        throw DataError("profile " + name.toStdString(),
                        "it is for " + std::to_string(loaded.servos.size()) + " servos, the open rig has " +
                            std::to_string(rig.actuatorCount()),
                        "choose another, or open the rig that it was made for");
    return loaded;
}

void RigProfiles::keep(const DeviceProfile& profile, const Rig& rig) {
    if (settings_.readOnly())
        throw DeviceError("profile " + profile.name, "another Lumorph has the device profiles: it is not kept",
                          "end the other one, then change it again");
    shelf_.save(profile);
    settings_.setValue(kProfileKey + usualName(rig), QString::fromStdString(profile.name));
}

DeviceProfile freshProfile(const Rig& rig, ControllerKind kind) {
    DeviceProfile profile = profileFor(rig, firstChannel(kind));
    profile.controller = kind;
    profile.name = usualName(rig).toStdString();
    return profile;
}

bool followEdit(DeviceProfile& profile, const Rig& before, const Rig& now) {
    bool all = true;
    const std::vector<ServoSetup> told = profileFor(before).servos, tells = profileFor(now).servos;
    for (std::size_t k = 0; k < profile.servos.size() && k < told.size() && k < tells.size(); ++k) {
        ServoSetup& servo = profile.servos[k];
        if (servo.maxVelocity == told[k].maxVelocity) servo.maxVelocity = tells[k].maxVelocity;
        if (drivenBy(told[k]) == drivenBy(tells[k]) || drivenBy(servo) == drivenBy(tells[k])) continue;
        if (drivenBy(servo) != drivenBy(told[k])) {
            all = false;
            continue;
        }
        servo.pulseMin = tells[k].pulseMin;
        servo.pulseMax = tells[k].pulseMax;
        servo.curve = tells[k].curve;
        servo.reversed = tells[k].reversed;
        const double most = 0.5 * (servo.pulseMax - servo.pulseMin);
        servo.trim = std::clamp(servo.trim, -most, most);
    }
    return all;
}

DeviceProfile readdressed(const DeviceProfile& profile, const Rig& rig, const std::string& address,
                          ControllerKind kind) {
    DeviceProfile next = profile;
    if (next.address != address) { // they were another board's
        next.identity.clear();
        next.confirmed = false;
    }
    next.address = address;
    next.controller = kind;
    if (kind == profile.controller || !sameChannels(freshProfile(rig, profile.controller), profile)) return next;
    const DeviceProfile fresh = freshProfile(rig, kind);
    for (std::size_t k = 0; k < next.servos.size(); ++k) next.servos[k].channel = fresh.servos[k].channel;
    return next;
}

bool beginsAnew(const DeviceProfile& before, const DeviceProfile& after) {
    const auto asNarrow = [](const ServoSetup& a, const ServoSetup& b) {
        return b.pulseMin >= a.pulseMin && b.pulseMax <= a.pulseMax;
    };
    return before.commandsPerSecond != after.commandsPerSecond || !sameOptions(before, after) ||
           !std::ranges::equal(before.servos, after.servos, asNarrow);
}

} // namespace lumorph::studio
