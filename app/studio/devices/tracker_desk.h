#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <QObject>
#include <QString>
#include <QStringList>

#include "app/studio/document/notices.h"
#include "app/studio/document/studio_loop.h"
#include "app/studio/shell/settings.h"
#include "devices/trackers/tracker_hub.h"

namespace lumorph::studio {

/// Who a body is as long as the user has not said it, by its name; nobody where the name does not tell.
[[nodiscard]] std::optional<PoseRole> likelyRole(std::string_view body);

/// One open tracker, and what it was like in the last ten seconds: ten values a second, NaN where there was none.
struct OpenTracker {
    TrackerStatus status;
    std::deque<double> latency; ///< milliseconds
    std::deque<double> rate;    ///< frames a second
};

/// The trackers of the studio. Nothing is opened until the user says so. While one is open the match loop follows what
/// it sees, from its own thread, whatever the window does. Lives in the window's thread; nothing here waits for a port.
class TrackerDesk : public QObject {
    Q_OBJECT
public:
    TrackerDesk(Settings& settings, StudioLoop& loop, Notices& notices);
    ~TrackerDesk() override;

    /// Those that were open before, newest first, then one example of each kind.
    [[nodiscard]] QStringList addresses() const;
    /// Soon open, or a notice at "devices" that says why not. Only packets from this machine are taken unless it is
    /// open to the network.
    void open(const QString& address, bool openToNetwork = false);
    void close(const QString& address);
    [[nodiscard]] bool opening() const noexcept;
    [[nodiscard]] const std::vector<OpenTracker>& trackers() const noexcept;

    /// None: the body is seen, and does nothing.
    [[nodiscard]] std::optional<PoseRole> role(const std::string& body) const;
    /// Remembered by the body's name.
    void setRole(const std::string& body, std::optional<PoseRole> role);
    /// As TrackerHub::setTap.
    void setTap(TrackerHub::Tap tap);

signals:
    void changed(); ///< ten times a second while one is open; and when one was opened, closed, or got a role
    void addressesChanged();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
