#pragma once

#include <QObject>

#include "app/studio/document/job_slots.h"
#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

/// Where the document's target stands: as large as fits, or where it matches best, to which a new one glides.
class TargetPlacing : public QObject {
    Q_OBJECT
public:
    TargetPlacing(StudioDocument& document, JobSlots& jobs, Notices& notices);

    void setPlacesNewTargets(bool places) { placesNewTargets_ = places; }
    void fit();
    void autoPlace();
    /// The target stands where auto-place put it, by the field that there is: again would change nothing.
    [[nodiscard]] bool autoPlaced() const;
    /// The document's target was just opened and stands where it fits; it is placed better as soon as there is a field.
    void expect();

signals:
    /// Remedies of notices: a field to place it with, another target.
    void fieldWanted();
    void targetWanted();

private:
    void placeNew();
    void glideTo(const Placement& place, const QString& what);

    /// A target that was just opened and waits for its better place, and where it stands until then.
    struct Unplaced {
        std::shared_ptr<const MatchTarget> target;
        Placement placement;
    };

    StudioDocument& document_;
    JobSlots& jobs_;
    Notices& notices_;
    bool placesNewTargets_ = false;
    Unplaced unplaced_;
    /// What auto-place found last.
    struct Placed {
        std::shared_ptr<const MatchTarget> target;
        std::shared_ptr<const MatchField> field;
        Placement placement;
    };
    Placed placed_;
};

} // namespace lumorph::studio
