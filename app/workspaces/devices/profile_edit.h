#pragma once

#include <optional>
#include <utility>

#include "app/studio/devices/device_service.h"

namespace lumorph::studio {

/// The change of a profile by a control: in force while it is dragged, kept at the end, or taken back.
class ProfileEdit {
public:
    explicit ProfileEdit(DeviceService& devices) : devices_(devices) {}

    void preview(const DeviceProfile& profile) {
        if (!before_) before_ = devices_.profile();
        devices_.previewProfile(profile);
    }
    /// `what` names it for undo.
    void keep(const DeviceProfile& profile, const QString& what) {
        before_.reset();
        devices_.setProfile(profile, what);
    }
    void revert() {
        if (before_) devices_.previewProfile(*std::exchange(before_, std::nullopt));
    }

private:
    DeviceService& devices_;
    std::optional<DeviceProfile> before_; ///< the drag began with it
};

} // namespace lumorph::studio
