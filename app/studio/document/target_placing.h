#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <QObject>

#include "app/studio/document/job_slots.h"
#include "app/studio/document/studio_document.h"
#include "core/mdf/auto_place.h"

namespace lumorph::studio {

/// Where the document's target stands: as large as fits, or where it matches best, to which a new one glides.
class TargetPlacing : public QObject {
    Q_OBJECT
public:
    TargetPlacing(StudioDocument& document, JobSlots& jobs, Notices& notices);

    void setPlacesNewTargets(bool places) { placesNewTargets_ = places; }
    void fit();
    void autoPlace(ReliefChoice relief = ReliefChoice::automatic);
    /// The different places that were found last, the best first; none where target or field are other ones by now.
    [[nodiscard]] std::span<const PlacementCandidate> places() const;
    void choosePlace(std::size_t index);
    /// The target stands where auto-place put it, by the field that there is: again would change nothing.
    [[nodiscard]] bool autoPlaced() const;
    /// The document's target was just opened and stands where it fits; it is placed better as soon as there is a field.
    void expect();

signals:
    void placesChanged();
    /// Remedies of notices: a field to place it with, another target.
    void fieldWanted();
    void targetWanted();

private:
    void placeNew();
    void keep(const std::shared_ptr<const MatchTarget>& target, const std::shared_ptr<const MatchField>& field,
              const AutoPlacement& found, const Placement& stands);
    void tellPlaces();
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
        std::vector<PlacementCandidate> places;
    };
    Placed placed_;
    bool placesShown_ = false; ///< at the last placesChanged
};

} // namespace lumorph::studio
