#pragma once

#include <optional>
#include <string>

#include <QString>
#include <QStringList>

#include "app/studio/base/settings.h"
#include "app/studio/devices/device_shelf.h"
#include "core/rig/rig.h"

namespace lumorph::studio {

/// Device profiles of the studio, and which of them a rig had last.
class RigProfiles {
public:
    explicit RigProfiles(Settings& settings) : settings_(settings), shelf_(settings.folder() / "devices") {}

    [[nodiscard]] QStringList names() const { return shelf_.names(); }
    /// The name under which the rig's profile was kept last; empty where none was.
    [[nodiscard]] QString lastOf(const Rig& rig) const;
    /// Throws DataError, also where it is for another number of servos.
    [[nodiscard]] DeviceProfile load(const QString& name, const Rig& rig) const;
    /// Under the name that it has, which is remembered for the rig. Throws DataError; DeviceError where another studio
    /// has the settings.
    void keep(const DeviceProfile& profile, const Rig& rig);

private:
    Settings& settings_;
    DeviceShelf shelf_;
};

/// A fresh profile, named after the rig, as its file describes its drives.
[[nodiscard]] DeviceProfile freshProfile(const Rig& rig, ControllerKind kind);
/// After an edit of the rig: servos that are set up as it said before are set up as it says now (pulses, curve,
/// direction, velocity). False where it says something else now of a servo that was set up otherwise; that one stays.
[[nodiscard]] bool followEdit(DeviceProfile& profile, const Rig& before, const Rig& now);
/// The same set-up on another device. Who has not chosen channels has them counted as this kind of controller counts;
/// what was known of the very board is forgotten where the address is another.
[[nodiscard]] DeviceProfile readdressed(const DeviceProfile& profile, const Rig& rig, const std::string& address,
                                        ControllerKind kind);
/// Whether a link of the one must begin anew for the other, which a drag shall not do with every pixel.
[[nodiscard]] bool beginsAnew(const DeviceProfile& before, const DeviceProfile& after);

} // namespace lumorph::studio
