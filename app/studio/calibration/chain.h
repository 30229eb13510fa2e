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
#include "calibration/stages/session.h"
#include "core/base/progress.h"
#include "core/rig/rig.h"
#include "core/scene/installation_store.h"

/// The whole chain from boxes to a calibrated show: the stages in the words of the window.
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

/// What a measurement came to, as it is read.
struct LinkWords {
    QString summary; ///< one sentence
    std::vector<LinkFigure> figures;
    std::vector<LinkPoint> points;
    std::vector<FindingWords> findings; ///< what stands in the way, or is to be known
};
[[nodiscard]] LinkWords wordsOf(const StageOutcome& outcome);

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

/// A stage as the window has it.
struct ChainLink {
    LinkId id = LinkId::projector;
    const char* key = "";                    ///< of names of widgets: "pointer"
    QString title, purpose;                  ///< what it is, and in one sentence what it is for
    std::vector<QString> how;                ///< what will happen and what one does, a sentence each
    QString warning;                         ///< in large letters; empty: none
    const CalibrationStage* stage = nullptr; ///< which records, solves and applies it
    std::vector<LinkFile> files; ///< of a tracker's own recordings, in place of one of ours; all of them are needed
    std::function<StageResult(const FileTask& task, const Progress& progress)> fromFiles; ///< empty: without files
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

/// In the order of the stages.
[[nodiscard]] const std::vector<ChainLink>& chainLinks();
/// As a card says it: "8 alignments, 26 November, 14:05".
[[nodiscard]] QString wordsOf(const StageStand& stand);

/// The room with what was measured, and what is kept of that beside.
[[nodiscard]] InstallationVersion versionOf(const ChainLink& link, const StageOutcome& outcome,
                                            const Installation& room);

} // namespace lumorph::studio
