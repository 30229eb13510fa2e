#pragma once

#include <QObject>
#include <QTimer>

#include "app/studio/base/notices.h"
#include "app/studio/base/settings.h"
#include "app/studio/document/project_service.h"
#include "core/scene/installation_store.h"

namespace lumorph::studio {

/// Keeps what stands in the room for the next start, in the user's configuration, and asks once which installation to
/// use where a project comes with another. Lives in the window's thread.
class InstallationKeeper : public QObject {
    Q_OBJECT
public:
    /// Puts the one that was kept last into the document. The others outlive it.
    InstallationKeeper(Settings& settings, StudioDocument& document, ProjectService& projects, Notices& notices);
    ~InstallationKeeper() override; ///< keeps what has not been kept yet

    /// The files of earlier ones, the newest first.
    [[nodiscard]] std::vector<std::filesystem::path> earlier() const { return store_.earlier(); }
    /// Puts an earlier one back, as a step of undo.
    void bringBack(const std::filesystem::path& file);

private:
    void load();
    void keep();
    void compare(const QString& project, const std::shared_ptr<const Installation>& installation);
    void take(Installation installation, const std::string& from, const QString& what);
    [[nodiscard]] bool answered(const QString& question) const;
    void setAnswered(const QString& question);

    Settings& settings_;
    StudioDocument& document_;
    Notices& notices_;
    InstallationStore store_;
    std::shared_ptr<const Installation> kept_; ///< what the file holds
    QTimer due_;
};

} // namespace lumorph::studio
