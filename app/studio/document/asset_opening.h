#pragma once

#include <filesystem>

#include <QObject>

#include "app/studio/document/assets.h"
#include "app/studio/document/field_cache.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

/// Opens rigs, fields and targets into the document, each by a job and one step of undo.
class AssetOpening : public QObject {
    Q_OBJECT
public:
    /// `read` is told how the files looked.
    AssetOpening(StudioDocument& document, JobSlots& jobs, Notices& notices, ReadFiles& read, FieldCache cache);

    /// Opens the file as the kind that it is.
    void open(const std::filesystem::path& file);
    void openRig(const std::filesystem::path& path);
    /// A rig that was made here and has no file yet; `name` is what its step of undo says.
    void takeRig(const std::shared_ptr<const Rig>& rig, const QString& name);
    void openField(const std::filesystem::path& file);
    void openTarget(const std::filesystem::path& file);
    /// What the target's file holds by now, where the target stands.
    void readTargetAgain(const std::filesystem::path& file);

signals:
    void opened(const QString& path);
    void rigOpened(); ///< maybe without a field
    void targetOpened();
    /// What is no part of the document, or all of it.
    void projectChosen(const std::filesystem::path& file);
    void recordingChosen(const QString& path);
    /// The remedy of a notice.
    void fileWanted(const QString& place);

private:
    struct OpenedRig;
    void takeOpened(const OpenedRig& opened, const QString& step);
    void takeField(StudioState::FieldAsset field, const QString& what);
    void takeRigOfField(const StudioState::FieldAsset& field);
    void tellTarget(const StudioState::TargetAsset& target);
    [[nodiscard]] Notice::Action chooseAnother(const QString& place);

    StudioDocument& document_;
    JobSlots& jobs_;
    Notices& notices_;
    ReadFiles& read_;
    FieldCache cache_;
};

} // namespace lumorph::studio
