#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <QObject>

#include "app/studio/base/settings.h"
#include "app/studio/devices/tracker_service.h"
#include "app/studio/document/studio_document.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph::studio {

/// The one truth of the virtual lab, by which the chain measures and the simulated trackers see. As long as its boxes
/// are packed all is as the room is believed to be, so that a show is right from the first start. They are unpacked
/// when the first link of the chain is measured there; from then on the truth is kept for the machine, until the lab is
/// packed up again. Lives in the window's thread.
class LabRoom : public QObject {
    Q_OBJECT
public:
    /// The others outlive it.
    LabRoom(Settings& settings, StudioDocument& document, TrackerService& trackers);

    [[nodiscard]] bool isUnpacked() const noexcept { return seed_.has_value(); }
    void unpack();
    /// All is as it is believed to be again. The next lab that is unpacked is another.
    void packUp();
    [[nodiscard]] const Installation& truth() const noexcept { return *truth_; }

signals:
    void changed(); ///< it was unpacked or packed up

private:
    void follow();

    Settings& settings_;
    StudioDocument& document_;
    TrackerService& trackers_;
    std::optional<std::uint32_t> seed_; ///< while it is unpacked
    std::shared_ptr<const Installation> truth_;
};

} // namespace lumorph::studio
