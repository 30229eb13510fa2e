#pragma once

#include <functional>
#include <map>
#include <optional>

#include <QObject>

#include "app/studio/base/step_tone.h"
#include "app/studio/calibration/chain.h"
#include "app/studio/calibration/lab_room.h"
#include "app/studio/calibration/live_service.h"
#include "app/studio/calibration/simulated_question.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/document/studio_document.h"
#include "app/studio/document/studio_loop.h"

namespace lumorph::studio {

/// Where a link is measured: in the virtual lab, with what is connected (tracker, or camera and servos), or from its
/// recordings.
enum class LinkWay { lab, live, files };

/// Where the whole chain stands: a plain value.
struct ChainState {
    CalibrationSession session; ///< a link has the number of its stage
    std::size_t chosen = 0;
    double fraction = 0.0; ///< of what is measured now; negative: unknown
    QString stage;
    LinkWay way = LinkWay::lab;    ///< of links that can be measured so; the others are measured in the lab
    std::optional<LiveStand> live; ///< what is done just now with the connected tracker
    /// By links: those of `ChainLink::files`, and as the last one the folder of a recording of ours. Empty paths: not
    /// chosen yet.
    std::map<std::size_t, std::vector<std::filesystem::path>> files;
    std::map<std::size_t, std::filesystem::path> kept; ///< folders of recordings, by links
    std::optional<std::size_t> restEnded;              ///< the link at which measuring all that is missing has ended
};

/// How a link is measured now.
[[nodiscard]] LinkWay wayOf(const ChainState& state, std::size_t link);
/// Of its files the first that was not chosen yet; as many as there are: the folder of a recording.
[[nodiscard]] std::optional<std::size_t> missingFile(const ChainState& state, std::size_t link);

/// The one thing that is to be done with the chosen link.
struct ChainStep {
    enum class Do { nothing, sequence, chooseFile, measure, use, cancel, goOn };
    using Tone = StepTone;
    Do what = Do::nothing;
    Tone tone = Tone::quiet;
    QString title, text, button;
    bool operator==(const ChainStep&) const = default;
};
[[nodiscard]] ChainStep stepOf(const ChainState& state);

/// Measures the links of the chain in the virtual lab, with a tracker or from recordings, one at a time, as jobs. What
/// was measured is shown first and used when one says so: a step of undo, and a version. Lives in the window's thread.
class ChainService : public QObject {
    Q_OBJECT
public:
    /// Puts a measured installation into the document, as a step of undo and a version; false where that failed.
    using VersionTaker = std::function<bool(InstallationVersion version)>;
    /// The device on the table. Throws DeviceError with what to do where not all of it is connected.
    /// `isMoved`: with its servos.
    using TableOpener = std::function<std::shared_ptr<Bench>(const Installation& room, bool isMoved)>;
    /// STOP of the loop ends what is measured. The first link that is measured in the lab unpacks it.
    ChainService(StudioDocument& document, StudioLoop& loop, LabRoom& lab, Jobs& jobs, Notices& notices,
                 LiveService& live, TableOpener table, VersionTaker take);

    [[nodiscard]] const ChainState& state() const noexcept { return state_; }
    void choose(std::size_t link);
    /// What was measured another way and is not used goes.
    void setWay(LinkWay way);
    void setFile(std::size_t link, std::size_t file, const std::filesystem::path& path);
    /// Does what `stepOf` says; a sequence of its own and choosing a file are the window's: nothing happens.
    void doNext();
    void measure();
    /// All that is open or stale, in turn, each used when it is good; ends with the first that is not,
    /// and with the first that asks something of the user: a recording, or to touch something.
    void measureRest();
    void use();
    /// What devices said while it was measured, into a new folder; what fails is a notice.
    void keepRecording(std::size_t link, const std::filesystem::path& folder);
    void cancel();

signals:
    void changed();
    void handsOff(); ///< servos are about to move by themselves

private:
    void begin(std::size_t link);
    void beginLive(std::size_t link);
    [[nodiscard]] std::shared_ptr<const PoseBoard> devicePoses() const;
    void beginOnTable(std::size_t link);
    void run(std::size_t link, std::function<StageOutcome(const Progress&)> work);
    void fail(std::size_t link, const std::exception& error);
    [[nodiscard]] std::function<StageOutcome(const Progress&)> workOf(std::size_t link);
    void take(std::size_t link, StageOutcome outcome);
    bool useOf(std::size_t link);
    void goOn();
    void endRestAt(std::size_t link);
    void follow();

    StudioDocument& document_;
    StudioLoop& loop_;
    LabRoom& lab_;
    LiveService& live_;
    TableOpener table_;
    VersionTaker take_;
    JobSlots jobs_;
    ChainState state_;
    std::uint32_t seed_ = 1; ///< another for each measurement
};

} // namespace lumorph::studio
