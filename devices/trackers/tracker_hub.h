#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "devices/trackers/tracker.h"

namespace lumorph {

/// Who a tracked body is in the show. Remembered by the body's name.
using RoleMap = std::map<std::string, PoseRole>;

/// Makes a tracker of an address, as openTracker does; for those who know of more kinds.
using TrackerOpener = std::function<std::unique_ptr<Tracker>(const std::string& uri, TrackerOptions options)>;

/// All open trackers of a session: poses go to the board under the roles that their names have. Where several bring a
/// body of the same name, the first is followed as long as it sees it, then another. Any thread.
class TrackerHub {
public:
    explicit TrackerHub(std::shared_ptr<PoseBoard> board, std::shared_ptr<const Clock> clock,
                        TrackerOpener opener = openTracker);
    ~TrackerHub();

    /// Throws as the opener; then all stays as it was. One tracker an address.
    void open(const std::string& uri, bool openToNetwork);
    void close(const std::string& uri);
    void setRoles(RoleMap roles);
    [[nodiscard]] RoleMap roles() const;
    /// As the trackers tell it; their advice also names bodies that are not followed because another tracker's are.
    [[nodiscard]] std::vector<TrackerStatus> status() const;
    /// Poses from elsewhere (a camera that sees a board, a replay) take the same way.
    void take(const std::string& source, const TrackerFrame& frame);
    using Tap = std::function<void(const std::string& source, const TrackerFrame& frame)>;
    /// Called with all that arrives, whatever role it has, in the thread that brings it; must return at once. Returns
    /// its number.
    int addTap(Tap tap);
    /// When this returns, it is called no more.
    void removeTap(int id);

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
