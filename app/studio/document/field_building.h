#pragma once

#include <QObject>

#include "app/studio/document/field_cache.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/document/studio_document.h"
#include "core/mdf/builder.h"

namespace lumorph::studio {

/// Builds the document's field as a job, keeps it for the next time, and says when it is of the rig before an edit.
class FieldBuilding : public QObject {
    Q_OBJECT
public:
    FieldBuilding(StudioDocument& document, JobSlots& jobs, Notices& notices, FieldCache cache);

    /// One that was `asked` for is always a step of undo, and where it fails the usual settings are offered.
    void build(const BuildOptions& options, bool asked);
    void buildMissing();

signals:
    /// The remedy of a notice: there is no rig to build it for.
    void rigWanted();

private:
    void tellStale();

    StudioDocument& document_;
    JobSlots& jobs_;
    Notices& notices_;
    FieldCache cache_;
};

} // namespace lumorph::studio
