#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include <QObject>
#include <QString>

#include "app/studio/base/jobs.h"
#include "app/studio/base/notices.h"
#include "app/studio/base/settings.h"
#include "app/studio/devices/device_service.h"
#include "app/studio/devices/tracker_service.h"
#include "app/studio/document/project_service.h"
#include "app/studio/document/studio_loop.h"

namespace lumorph::studio {

/// Records the show: frames of the loop in its own thread, poses as they arrive, what goes to the servos and comes from
/// them, and what the user is told. Whatever the disk does, the show goes on. Lives in the window's thread.
class RecordingService : public QObject {
    Q_OBJECT
public:
    enum class Phase { idle, starting, recording };
    /// Less room than this on the disk ends a recording.
    static constexpr std::int64_t kLeastRoom = 500'000'000;

    RecordingService(Settings& settings, StudioDocument& document, ProjectService& service, StudioLoop& loop,
                     DeviceService& devices, TrackerService& trackers, Jobs& jobs, Notices& notices);
    /// Finishes the recording.
    ~RecordingService() override;

    /// Into the usual folder, under a name with the date and time.
    void start();
    void start(const std::filesystem::path& file);
    void stop();
    /// A mark of the user's, at a moment of the steady clock.
    void mark(const QString& text, Microseconds when);

    [[nodiscard]] Phase phase() const noexcept;
    [[nodiscard]] const std::filesystem::path& file() const noexcept; ///< of this recording, or the last
    [[nodiscard]] double seconds() const;                             ///< since it began
    [[nodiscard]] std::int64_t bytes() const noexcept;                ///< on the disk, a moment ago
    /// Where recordings go, unless the user says otherwise: where the last one went.
    [[nodiscard]] std::filesystem::path folder() const;
    [[nodiscard]] std::filesystem::path freshFile() const;
    /// Room on a file's disk, bytes; for tests of a disk that fills.
    void setRoom(std::function<std::int64_t(const std::filesystem::path&)> room);

signals:
    void changed(); ///< phase; and while recording time and size, twice a second
    /// The file is complete.
    void finished(const QString& file);
    void chooseFile();                    ///< the remedy of a notice: ask where to record to
    void showWanted(const QString& file); ///< the remedy of a notice: replay it

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

/// "0:07", "12:34", "1:02:03".
[[nodiscard]] QString clockText(double seconds);
/// "3.4 MB".
[[nodiscard]] QString bytesText(std::int64_t bytes);

} // namespace lumorph::studio
