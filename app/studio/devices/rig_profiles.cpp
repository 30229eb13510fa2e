#include "app/studio/devices/rig_profiles.h"

#include <algorithm>

#include "core/base/error.h"
#include "devices/controllers/controller_kinds.h"

namespace lumorph::studio {
namespace {

constexpr auto kProfileKey = "device/profile/"; ///< and the rig's name

QString usualName(const Rig& rig) { return fileNameOf(QString::fromStdString(rig.name())); }

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
