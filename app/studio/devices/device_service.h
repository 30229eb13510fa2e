#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <QDateTime>
#include <QObject>
#include <QString>
#include <QStringList>
#include <QUndoStack>

#include "app/studio/base/notices.h"
#include "app/studio/base/settings.h"
#include "app/studio/devices/device_log.h"
#include "app/studio/devices/hand_watch.h"
#include "app/studio/document/studio_document.h"
#include "app/studio/document/studio_loop.h"
#include "devices/controllers/servo_link.h"
#include "devices/transport/discovery.h"

namespace lumorph {

class SimulatedBench;

namespace studio {

/// The servo controller of the studio: what was found, how the rig hangs on it, the link, and what happened. Nothing is
/// connected until the user says so. Servos follow the match loop from its own thread, whatever the window does. Lives
/// in the window's thread; nothing here waits for a device.
class DeviceService : public QObject {
    Q_OBJECT
public:
    DeviceService(Settings& settings, StudioDocument& document, StudioLoop& loop, Notices& notices);
    /// Servos go to rest where the profile says so: at most two seconds.
    ~DeviceService() override;

    [[nodiscard]] SimulatedBench& bench() noexcept;
    /// While somebody looks, devices are looked for every two seconds and the status comes 20 times a second.
    void setShown(bool shown);
    [[nodiscard]] const std::vector<FoundDevice>& found() const noexcept;
    void searchBluetooth();
    [[nodiscard]] bool searchingBluetooth() const noexcept;

    /// How the open rig hangs on its controller; without servos while no rig is open.
    [[nodiscard]] const DeviceProfile& profile() const noexcept;
    /// At once in force, within the guard's limits, and kept under its name. False, and a notice at "servo", where it
    /// cannot be. `what` names it for undo, from where a preview before it began; empty: it is no step.
    bool setProfile(const DeviceProfile& profile, const QString& what = {});
    /// The same while something is dragged: in force, not kept; limits that grow wait for the end of the drag.
    bool previewProfile(const DeviceProfile& profile);
    /// Steps of the set-up alone; the board that is connected stays the one that it is. Forgotten with another rig, and
    /// with another kind of controller.
    [[nodiscard]] QUndoStack& undoStack() noexcept;
    [[nodiscard]] QStringList profileNames() const;
    void loadProfile(const QString& name);
    void saveProfileAs(const QString& name);
    /// A fresh one, as the rig's file describes its drives.
    void resetProfile();

    /// Remembers the address and connects to it; a notice at "devices" where it is none.
    void connectTo(const QString& address, std::optional<ControllerKind> controller = {});
    void disconnect();
    /// The user says that the board is what it seems to be; remembered with the profile.
    void confirm();
    /// Soft start, also after STOP, which it ends. A window asks its user before (`askStart`).
    void start(bool jumpAllowed = false);
    /// What servos are to be moved by, once their user has agreed.
    enum class StartBy { show, recording };
    /// Asks the user, who sees what will move and agrees by holding a button: `startAsked`.
    void askStart(StartBy by = StartBy::show);
    /// Strokes to which a start leads: where the show has the servos now. Empty before its first frame.
    [[nodiscard]] std::vector<double> wanted() const;
    /// Whether servos are told where a recording that is shown has them; they stay where they are while not, and go
    /// slowly to whatever they follow next.
    void setFollowsRecordings(bool follows);
    [[nodiscard]] bool followsRecordings() const noexcept;
    /// STOP for the servos alone, from any thread, whatever the window does; the loop is to be stopped too.
    void stopNow();
    /// As stopNow, and waits until the boards should know: at most so long. False where they may not.
    bool letGo(std::chrono::milliseconds atMost);
    /// The end of the program begins: servos go to rest where the profile says so, and are let go. Returns at once;
    /// nothing is connected any more.
    void beginLeave();
    /// At the end of the program: servos go to rest where the profile says so, and are let go. Waits for it, at most
    /// some seconds; STOP from other threads is heard meanwhile.
    void leave();
    /// Why Esc Esc is heard in the program's own windows alone; empty: it is heard everywhere.
    void setStopKeysProblem(const QString& why);
    [[nodiscard]] const QString& stopKeysProblem() const noexcept;
    /// Servos go limp, without STOP.
    void release();
    void wiggle(std::size_t servo);
    void setSlow(bool slow);
    [[nodiscard]] bool slow() const noexcept; ///< by the user's will; hands make it slow besides
    /// Who sees hands; null: nobody.
    void setPoses(std::shared_ptr<const PoseBoard> poses);
    [[nodiscard]] const HandSense& hands() const noexcept;
    /// Moves one servo slowly to a stroke and keeps it there, until `endTest`.
    void test(std::size_t servo, double stroke);
    void endTest();
    [[nodiscard]] std::optional<double> tested(std::size_t servo) const;
    [[nodiscard]] bool testing() const; ///< or on the way back from it
    /// Some servo is still on its way to where a test wants it, or back.
    [[nodiscard]] bool movesToTest() const;

    [[nodiscard]] const LinkStatus& status() const noexcept;
    /// When servos were last all started.
    [[nodiscard]] const QDateTime& liveSince() const noexcept;
    /// What the user calls the device that is, or would be, connected.
    [[nodiscard]] QString name() const;
    /// The name while servos are driven by it, else empty.
    [[nodiscard]] QString liveName() const;
    /// Newest first, at most 500.
    [[nodiscard]] const std::deque<DeviceLogLine>& log() const noexcept;
    void note(const QString& text);
    /// What goes into the machines behind the servos and comes out of them, from the present link's beginning on and of
    /// each that follows; in the link's thread. An empty sink ends it.
    void setTrace(std::function<void(const ServoTraceRow&)> sink);

signals:
    void startAsked(lumorph::studio::DeviceService::StartBy by);
    void changed(); ///< status; at most 20 times a second
    void foundChanged();
    void profileChanged();
    void logged(int lines); ///< so many new ones

private:
    class ChangeSetup;
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace studio
} // namespace lumorph
