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
#include "calibration/capture/device_bench.h"
#include "core/base/progress.h"
#include "core/rig/rig.h"
#include "core/scene/installation_store.h"

/// The whole chain from boxes to a calibrated show: what is measured one after the other, and where it stands.
namespace lumorph::studio {

enum class LinkId { projector, light, pointer, tracker, device, eye, servos, delays, check };

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
    /// Refused because the tracker's coordinates are mirrored or in another unit: what was measured by the same tracker
    /// before is as wrong, though it fits itself.
    bool doubtsTracker = false;
};

/// What a measurement in the lab begins with.
struct LinkTask {
    std::shared_ptr<const Rig> rig;
    Installation believed;
    Installation truth; ///< what stands in the virtual lab, which nobody who measures knows
    std::uint32_t seed = 1;
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

/// What a measurement with the connected tracker begins with.
struct LiveTask {
    std::shared_ptr<const Rig> rig;
    Installation believed;
    LivePlan plan;
    std::vector<LiveTake> takes; ///< one a step of the plan
};

/// What a measurement with the device on the table begins with.
struct TableTask {
    std::shared_ptr<const Rig> rig;
    Installation believed;
    std::shared_ptr<DeviceBench> bench;
    std::uint32_t seed = 1;
};

/// One thing that is measured. Those before it that it builds on are its needs.
struct ChainLink {
    LinkId id = LinkId::projector;
    const char* key = "";     ///< of names of widgets: "pointer"
    QString title, purpose;   ///< what it is, and in one sentence what it is for
    std::vector<QString> how; ///< what will happen and what one does, a sentence each
    QString warning;          ///< in large letters; empty: none
    std::vector<LinkId> needs;
    const Origin* (*origin)(const Installation& room) = nullptr; ///< null, or null given: it changes nothing
    /// Takes over what this link measures, and nothing else.
    void (*apply)(const Installation& measured, Installation& room) = nullptr;
    /// Throws as measurements do. Empty: the link has a sequence of its own.
    std::function<LinkOutcome(const LinkTask& task, const Progress& progress)> inLab;
    std::vector<LinkFile> files; ///< all of them are needed
    /// The same from recordings of a real tracker. Empty: it cannot be.
    std::function<LinkOutcome(const FileTask& task, const Progress& progress)> fromFiles;
    /// Bodies that the connected tracker must see where it is measured with that, the pointer first; empty: it cannot
    /// be.
    std::vector<PoseRole> liveRoles;
    /// The steps of it. Throws InvalidInput for a room in which there is nothing to touch.
    std::vector<LiveStep> (*liveSteps)(const Rig& rig, const Installation& room) = nullptr;
    std::function<LinkOutcome(const LiveTask& task, const Progress& progress)> fromLive;
    /// The same with the camera, projectors and servos that are connected. Empty: it cannot be.
    std::function<LinkOutcome(const TableTask& task, const Progress& progress)> onTable;
};

/// In the order in which they are measured.
[[nodiscard]] const std::vector<ChainLink>& chainLinks();

/// Where a link stands.
struct LinkStand {
    enum class How {
        open,    ///< never measured
        waits,   ///< what it needs was not measured yet
        entered, ///< by hand
        measured,
        simulated, ///< by the virtual lab
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
