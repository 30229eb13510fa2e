#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>
#include <QString>

#include "app/studio/calibration/live_capture.h"
#include "app/studio/devices/tracker_service.h"

class QTimer;

namespace lumorph::studio {

/// "head", as sentences say it.
[[nodiscard]] QString wordOf(PoseRole role);

/// Where a measurement with the connected tracker stands.
struct LiveStand {
    std::size_t step = 0, steps = 0;
    double fraction = 0.0;                 ///< of the step
    QString title;                         ///< what is to be done
    QString trouble;                       ///< why it does not go on; empty: it does
    std::optional<PlannedLandmark> corner; ///< of the device, to be touched
    bool operator==(const LiveStand&) const = default;
};

/// Takes the poses of the open trackers through a `LiveCapture`, and has the projector show what is to be touched.
/// Lives in the window's thread.
class LiveService : public QObject {
    Q_OBJECT
public:
    /// Shows a picture on the first projector; a null one brings the show back. Throws DeviceError.
    using Shower = std::function<void(const QImage& picture)>;
    LiveService(TrackerService& trackers, Shower show);
    ~LiveService() override;

    /// Why a plan for these bodies cannot begin, in a sentence with what to do; empty: it can.
    [[nodiscard]] QString obstacle(const std::vector<PoseRole>& roles) const;
    /// `picture` is the projector's size, pixels. Throws DeviceError where the projector cannot show what is touched;
    /// then nothing has begun.
    void begin(LivePlan plan, const glm::dvec3& tip, const glm::ivec2& picture);
    void cancel();
    /// The last step is done again.
    void takeBack();
    [[nodiscard]] const std::optional<LiveStand>& stand() const noexcept { return stand_; } ///< empty: none runs

signals:
    void changed();
    /// All steps were done; `stand` is empty then. `isSimulated`: a tracker that was followed is no real one.
    void finished(const LivePlan& plan, const std::vector<LiveTake>& takes, bool isSimulated);

private:
    struct Arrivals;
    void follow();
    void end();
    void showDot();
    [[nodiscard]] LiveStand standOf(const LiveCapture& capture) const;

    TrackerService& trackers_;
    Shower show_;
    std::shared_ptr<Arrivals> arrivals_; ///< of the trackers' threads
    int tap_ = 0;
    std::optional<LiveCapture> capture_;
    std::optional<LiveStand> stand_;
    std::map<PoseRole, std::string> sources_; ///< the tracker that is followed, by bodies
    glm::ivec2 picture_{0};
    std::optional<glm::dvec2> shown_; ///< the dot that the projector shows
    QTimer* timer_;
};

} // namespace lumorph::studio
