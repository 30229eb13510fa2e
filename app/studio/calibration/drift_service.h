#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QElapsedTimer>
#include <QImage>
#include <QObject>

#include "app/studio/base/notices.h"
#include "app/studio/rendering/show_feed.h"
#include "calibration/verify/drift_watch.h"
#include "calibration/verify/output_watch.h"
#include "core/base/progress.h"

class QTimer;

namespace lumorph::studio {

/// What projectors show just now, and the room in which they do.
struct SentShow {
    std::shared_ptr<const Rig> rig;
    std::shared_ptr<const Installation> room;
    std::vector<QImage> pictures; ///< one a projector, of any size; null: it is dark
    std::vector<double> strokes;  ///< one an actuator, as it is told
};

/// Where a watch gets the show from; in the window's thread.
class SentShowSource {
public:
    virtual ~SentShowSource() = default;
    /// Nothing where no show is drawn yet.
    [[nodiscard]] virtual std::optional<SentShow> now() = 0;
    /// Nobody watches any more, until the next `now`.
    virtual void rest() {}
};
/// The studio's show: small pictures of what its projectors get. The feed outlives it.
[[nodiscard]] std::unique_ptr<SentShowSource> sentShowOf(ShowFeed& feed);

/// Takes the photograph of a look, of which all else is set; runs beside the window, one call at a time, and may throw:
/// then the camera gives nothing. Cancelled it returns soon.
using ShowCamera = std::function<cv::Mat(const ShowLook& look, const SentShow& show, const Progress& progress)>;
/// The virtual lab's camera, in a room that truly is so.
[[nodiscard]] ShowCamera labShowCamera(Installation truth);
/// A camera of this machine, such as "/dev/video0", opened with the first look and again after it failed.
[[nodiscard]] ShowCamera machineShowCamera(const std::string& address);
/// Gives the camera of a watch that begins; called in the window's thread, so it opens nothing.
using ShowCameraChooser = std::function<ShowCamera()>;

/// Watches the running show through a camera, beside the window: whether its light lies where it belongs, and whether
/// it comes out of the projectors at all. Each trouble is one notice at the place "calibrate", with a button; it goes
/// when the trouble does. Lives in the window's thread.
class DriftService : public QObject {
    Q_OBJECT
public:
    static constexpr int kLookMilliseconds = 2000;
    static constexpr int kLooksADrift = 3; ///< of which one also looks for drift

    /// `check`: what the notices' button does.
    DriftService(std::unique_ptr<SentShowSource> show, ShowCameraChooser choose, Notices& notices,
                 std::function<void()> check, QObject* parent = nullptr);
    ~DriftService() override; ///< cancels a look that runs; a part of what it computes may still be waited for

    /// Begins anew, or ends; what was said is taken back. The camera is closed beside the window, as soon as it has
    /// answered; a watch that begins before that looks then, through a camera of its own.
    void setWatching(bool on);
    [[nodiscard]] bool isWatching() const noexcept;
    /// A look at this time (seconds, by any clock that goes forward), unless one still runs. The timer calls it.
    void look(double seconds);
    [[nodiscard]] bool isLooking() const noexcept { return isLooking_; }

    [[nodiscard]] const DriftReport& drift() const noexcept { return drift_; }
    [[nodiscard]] const OutputReport& output() const noexcept { return output_; }

signals:
    void changed(); ///< a look has ended

private:
    class Watcher;
    void take(int session, std::optional<DriftReport> drift, OutputReport output);
    void choose();
    void tell();
    void post(bool isThere, Notice::Level level, const QString& subject, const std::string& why, const QString& remedy);

    std::unique_ptr<SentShowSource> show_;
    ShowCameraChooser choose_;
    Notices& notices_;
    std::function<void()> check_;
    QTimer* timer_;
    QElapsedTimer clock_;
    DriftReport drift_;
    OutputReport output_;
    std::map<QString, std::string> told_; ///< by subject: why
    int session_ = 0, looks_ = 0;
    int chosen_ = -1;   ///< the session whose camera was chosen
    ShowCamera camera_; ///< until the first look takes it, and opens it
    bool isLooking_ = false;
    std::unique_ptr<Watcher> watcher_; ///< last: its thread hands results to the rest
};

} // namespace lumorph::studio
