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

#include "app/studio/base/notices.h"
#include "app/studio/base/settings.h"
#include "app/studio/document/studio_loop.h"
#include "devices/trackers/simulated_orders.h"
#include "devices/trackers/tracker_hub.h"

namespace lumorph::studio {

/// Who a body is as long as the user has not said it, by its name; nobody where the name does not tell.
[[nodiscard]] std::optional<PoseRole> likelyRole(std::string_view body);

/// One open tracker, and what it was like in the last ten seconds: ten values a second, NaN where there was none.
struct OpenTracker {
    TrackerStatus status;
    std::deque<double> latency; ///< milliseconds
    std::deque<double> rate;    ///< frames a second
    QString event;              ///< "12:03:04 head jumped by 3.00 m": the newest oddity; empty while there was none
    std::shared_ptr<SimulatedSteering> steering; ///< of a simulated one; else null
};

/// A tracked body as it was seen last, for those who draw it.
struct SeenBody {
    std::string name;
    std::optional<PoseRole> role;
    Pose pose;
    double age = 0.0; ///< seconds since then
    std::shared_ptr<SimulatedSteering> steering;
};

/// The trackers of the studio. Nothing is opened until the user says so. While one is open the match loop follows what
/// it sees, from its own thread, whatever the window does. Lives in the window's thread; nothing here waits for a port.
class TrackerService : public QObject {
    Q_OBJECT
public:
    TrackerService(Settings& settings, StudioLoop& loop, Notices& notices);
    ~TrackerService() override;

    /// Those that were open before, newest first, then one example of each kind.
    [[nodiscard]] QStringList addresses() const;
    /// Soon open, or a notice at "devices" that says why not. Only packets from this machine are taken unless it is
    /// open to the network.
    void open(const QString& address, bool openToNetwork = false);
    void close(const QString& address);
    [[nodiscard]] bool opening() const noexcept;
    [[nodiscard]] const std::vector<OpenTracker>& trackers() const noexcept;
    /// Of all trackers, as of now: newer than the last `changed`. What was never seen is left out.
    [[nodiscard]] std::vector<SeenBody> bodies() const;

    /// All that the trackers see, as long as this lives and after.
    [[nodiscard]] std::shared_ptr<const PoseBoard> poses() const noexcept;

    /// None: the body is seen, and does nothing.
    [[nodiscard]] std::optional<PoseRole> role(const std::string& body) const;
    /// Remembered by the body's name.
    void setRole(const std::string& body, std::optional<PoseRole> role);
    /// The room in which simulated bodies truly move (see SimulatedSteering::room); null: trackers see rooms as they
    /// are.
    void setSimulatedRoom(std::shared_ptr<const Installation> room);
    /// Called with all that arrives, as TrackerHub::addTap.
    int addTap(TrackerHub::Tap tap);
    void removeTap(int id);

signals:
    void changed(); ///< ten times a second while one is open; and when one was opened, closed, or got a role
    void addressesChanged();

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
