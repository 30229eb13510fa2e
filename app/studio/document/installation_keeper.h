#pragma once

#include <QObject>
#include <QTimer>

#include "app/studio/base/notices.h"
#include "app/studio/base/settings.h"
#include "app/studio/document/installation_writer.h"
#include "app/studio/document/project_service.h"
#include "core/scene/installation_store.h"

namespace lumorph::studio {

/// Keeps what stands in the room for the next start, in the user's configuration, and asks once which installation to
/// use where a project comes with another. Edits are written beside the window, the newest of them; a version is
/// written before `takeVersion` returns. While the settings are read only it writes nothing, and says so. Lives in the
/// window's thread.
class InstallationKeeper : public QObject {
    Q_OBJECT
public:
    /// Puts the one that was kept last into the document. The others outlive it.
    InstallationKeeper(Settings& settings, StudioDocument& document, ProjectService& projects, Notices& notices);
    ~InstallationKeeper() override; ///< keeps what has not been kept yet, and waits until it is on disk

    /// The files of earlier ones, the newest first.
    [[nodiscard]] std::vector<std::filesystem::path> earlier() const { return store_.earlier(); }
    /// Puts an earlier one back, as a step of undo.
    void bringBack(const std::filesystem::path& file);

    /// What measurements made of the installation, the newest first.
    [[nodiscard]] std::vector<KeptVersion> versions() const { return store_.versions(); }
    /// Keeps a measured installation as a version and puts it into the document as a step of undo. Where no version
    /// shows the room as it stood before, that is kept first, so that one can go back. False, with a notice, where the
    /// disk refuses, another studio has the room, or the version is not sound: then nothing changes. An empty date
    /// becomes that of now.
    bool takeVersion(InstallationVersion version);
    /// Whether the document's installation has this version's figures.
    [[nodiscard]] bool isCurrent(const InstallationVersion& version) const;
    /// Puts a version back, as a step of undo.
    void bringBackVersion(const std::filesystem::path& file);
    void removeVersion(const std::filesystem::path& file);

signals:
    void versionsChanged();

private:
    void load();
    void keep();
    /// The newest installation that no drag is at, unless it is kept or about to be.
    void offer();
    void takeWritten(const std::shared_ptr<const Installation>& written, const std::exception_ptr& failure);
    void takeOver();
    void reportReadOnly();
    void compare(const QString& project, const std::shared_ptr<const Installation>& installation);
    void take(Installation installation, const std::string& from, const QString& what);
    [[nodiscard]] bool answered(const QString& question) const;
    void setAnswered(const QString& question);

    Settings& settings_;
    StudioDocument& document_;
    Notices& notices_;
    InstallationStore store_;
    std::shared_ptr<const Installation> kept_;    ///< what the file holds
    std::shared_ptr<const Installation> offered_; ///< what it will hold; the same where nothing is under way
    std::shared_ptr<const Installation> settled_; ///< the document's, before a drag that goes on
    QTimer due_;
    std::unique_ptr<InstallationWriter> writer_; ///< last: what it says is taken by the rest
};

} // namespace lumorph::studio
