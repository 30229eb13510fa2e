#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <QString>

#include "app/studio/calibration/calibration_state.h"
#include "app/studio/calibration/live_capture.h"
#include "calibration/stages/stage.h"
#include "core/base/progress.h"
#include "core/rig/rig.h"
#include "core/scene/installation_store.h"

/// The whole chain from boxes to a calibrated show: what is measured one after the other, and where it stands.
namespace lumorph::studio {

enum class LinkId { projector, room, light, pointer, tracker, device, eye, servos, delays, check, mirror, deviceAlone };

/// A figure of a measurement, as it is read.
struct LinkFigure {
    QString name, value;
    bool isGood = true;
};

/// How far a point lies from where the measurement has it.
struct LinkPoint {
    QString name;
    double millimetres = 0.0;
    bool isFresh = false; ///< the fit never saw it
};

/// What a measurement came to.
struct LinkOutcome {
    bool isGood = false; ///< it may be used; a check: nothing has moved
    QString summary;     ///< one sentence
    std::vector<LinkFigure> figures;
    std::vector<LinkPoint> points;
    std::vector<FindingWords> findings;       ///< what stands in the way, or is to be known
    std::optional<Installation> installation; ///< as the room would be; empty: refused, or nothing is to be changed
    bool isUsed = false;                      ///< the room has it
    bool isSimulated = false;                 ///< made in the virtual lab, or with simulated devices
    std::shared_ptr<const StageRecording> recording; ///< that it was made of; null: of other files
    /// Refused because the tracker's coordinates are mirrored or in another unit: what was measured by the same tracker
    /// before is as wrong, though it fits itself.
    bool doubtsTracker = false;
};

/// A recording that a link can be measured from.
struct LinkFile {
    const char* key = ""; ///< of names of widgets: "swings"
    QString title, words; ///< what it is, and in a sentence what is in it
};

/// What a measurement from recordings begins with.
struct FileTask {
    Installation believed;
    std::vector<std::filesystem::path> files; ///< as many, and in the order of, the link's
};

/// One thing that is measured. Those before it that it builds on are its needs.
struct ChainLink {
    LinkId id = LinkId::projector;
    const char* key = "";     ///< of names of widgets: "pointer"
    QString title, purpose;   ///< what it is, and in one sentence what it is for
    std::vector<QString> how; ///< what will happen and what one does, a sentence each
    QString warning;          ///< in large letters; empty: none
    std::vector<LinkId> needs;
    /// Whether a room is measured by it in its turn; null: any. Others are there to be chosen.
    bool (*isWanted)(const Installation& room) = nullptr;
    /// Its row among the stages, which records, solves and applies it; null: the link has a sequence of its own.
    const CalibrationStage* stage = nullptr;
    std::vector<LinkFile> files; ///< of a tracker's own recordings, in place of one of ours; all of them are needed
    std::function<LinkOutcome(const FileTask& task, const Progress& progress)> fromFiles; ///< empty: without files
    /// Bodies that the connected tracker must see where it is measured with that, the pointer first; empty: it cannot
    /// be.
    std::vector<PoseRole> liveRoles;
    /// The steps of it. Throws InvalidInput for a room in which there is nothing to touch.
    std::vector<LiveStep> (*liveSteps)(const Rig& rig, const Installation& room) = nullptr;
    bool isOnTable = false; ///< it can be measured with the camera and projectors that are connected
    QString onTable;        ///< what is to be known of that, in a sentence; may be empty
    bool isMoved = false;   ///< and with the servos
    QString notConnected;   ///< why it cannot be measured with what is connected, in a sentence; empty: it can

    [[nodiscard]] bool isWithTracker() const noexcept { return !liveRoles.empty(); }
};

/// In the order in which they are measured.
[[nodiscard]] const std::vector<ChainLink>& chainLinks();
/// What it came to is no figure of the room, but that the room is as it was.
[[nodiscard]] inline bool isCheck(const ChainLink& link) { return link.stage != nullptr && !link.stage->origin; }
/// Null where it changes nothing.
[[nodiscard]] const Origin* originOf(const ChainLink& link, const Installation& room);

/// What a stage came to, as it is read.
[[nodiscard]] LinkOutcome outcomeOf(MeasuredStage measured, const StageSite& site);

/// Where a link stands.
struct LinkStand {
    enum class How {
        open,    ///< never measured
        waits,   ///< what it needs was not measured yet
        entered, ///< by hand
        measured,
        simulated, ///< by the virtual lab
        spare,     ///< not needed in this room, or another link measures the same
        stale      ///< something that it builds on was measured later
    };
    How how = How::open;
    QString words; ///< such as "measured on 26 November at 14:05, 8 alignments"
    bool operator==(const LinkStand&) const = default;
};

/// The last check that found all well.
struct LastCheck {
    std::string date; ///< ISO 8601 in UTC; empty: there was none
    bool isSimulated = false;
};

/// By links.
[[nodiscard]] std::vector<LinkStand> standsOf(const Installation& room, const LastCheck& checked);
/// The first that can be measured and should be; empty: all are.
[[nodiscard]] std::optional<std::size_t> nextLink(const std::vector<LinkStand>& stands);

/// The room with what was measured, and what is kept of that beside.
[[nodiscard]] InstallationVersion versionOf(const ChainLink& link, const LinkOutcome& outcome,
                                            const Installation& room);
/// Whether the room has what was measured.
[[nodiscard]] bool isUsed(const ChainLink& link, const LinkOutcome& outcome, const Installation& room);

} // namespace lumorph::studio
