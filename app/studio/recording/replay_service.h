#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include <QObject>
#include <QString>

#include "app/recording/recording.h"
#include "app/studio/base/jobs.h"
#include "app/studio/base/notices.h"
#include "app/studio/devices/device_service.h"
#include "app/studio/document/project_service.h"
#include "app/studio/document/studio_loop.h"

namespace lumorph::studio {

/// Shows a recording instead of the live show: every view, dock and projector get the recorded frames by the loop. The
/// servos stay where they are, unless the user lets the recording drive them. Lives in the window's thread.
class ReplayService : public QObject {
    Q_OBJECT
public:
    ReplayService(StudioDocument& document, ProjectService& service, StudioLoop& loop, DeviceService& devices,
                  Jobs& jobs, Notices& notices);
    ~ReplayService() override;

    /// Read beside the window, then shown and played; the notices of "replay" say why not, or that it was made with
    /// another project than the open one, and offer that.
    void open(const std::filesystem::path& file);
    /// Back to the live show, from where the actuators stand.
    void close();
    /// Back to the live show for as long as somebody else moves the servos, which an edit in the document does;
    /// `resume` goes on where it was left.
    void suspend();
    void resume();
    [[nodiscard]] bool suspended() const noexcept;
    /// What is shown; empty while the show is live.
    [[nodiscard]] const std::shared_ptr<const Recording>& recording() const noexcept;
    [[nodiscard]] const std::filesystem::path& file() const noexcept;

    void setPlaying(bool playing);
    void seek(double seconds);
    void setSpeed(double times);
    [[nodiscard]] bool playing() const;
    [[nodiscard]] double position() const; ///< seconds
    [[nodiscard]] double duration() const;
    [[nodiscard]] double speed() const;

    /// Whether servos are driven by what is shown; they go there slowly. False with each recording that is opened.
    /// A window asks its user before (`DeviceService::askStart`).
    void setDrivesServos(bool drives);
    [[nodiscard]] bool drivesServos() const;

    /// Runs the recorded servo traffic again and says whether the same bytes come out.
    void verify();
    /// Tables for a study, into a folder.
    void exportTables(const std::filesystem::path& folder);
    /// The project that was recorded, as a copy in a folder of its own; the replay goes on with it.
    void openProject();

signals:
    void changed(); ///< opened, closed, played, paused, speed
    void drivesServosChanged();
    void moved(); ///< another position

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph::studio
