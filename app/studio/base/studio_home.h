#pragma once

#include <optional>

#include <QDateTime>
#include <QObject>
#include <QTimer>

#include "app/studio/base/folder_lock.h"
#include "app/studio/base/settings.h"

namespace lumorph::studio {

/// Of several studios of one user, one writes the settings and the room's installation; the others read them, until it
/// ends. Lives in the window's thread.
class StudioHome : public QObject {
    Q_OBJECT
public:
    /// Where another studio has them, the settings become read only. Waits for a second at most.
    explicit StudioHome(Settings& settings);

    [[nodiscard]] bool first() const noexcept { return lock_.held(); }
    /// Since when another studio has them; empty where there is none, or it does not say.
    [[nodiscard]] std::optional<QDateTime> otherSince() const;

signals:
    void tookOver(); ///< the other studio has ended; settings are written again

private:
    Settings& settings_;
    FolderLock lock_;
    QTimer again_;
};

} // namespace lumorph::studio
