#include "app/studio/calibration/lab_room.h"

#include "app/studio/calibration/capture_bench.h"
#include "calibration/lab/boards_lab.h"
#include "calibration/lab/true_room.h"

namespace lumorph::studio {
namespace {

constexpr auto kUnpackedKey = "lab/unpacked"; // seed of the lab that stands there
constexpr auto kNextKey = "lab/next";         // of the one after it
constexpr std::uint32_t kFirstLab = 7;
constexpr double kSameLight =
    0.006; // metres over `kLitSide`: nearer than this it is the lab's projector that was measured
constexpr double kLitSide = 0.4;

/// As boxes come: nothing is known of what the chain measures.
Installation packed(const Installation& believed) {
    const Installation fresh;
    Installation room = believed;
    room.worldFromTracker = fresh.worldFromTracker;
    room.bodyFromDevice = fresh.bodyFromDevice;
    room.pointerTip = fresh.pointerTip;
    room.eyeFromHead = fresh.eyeFromHead;
    room.servos.clear();
    room.trackerSeconds = fresh.trackerSeconds;
    room.predictionSeconds = fresh.predictionSeconds;
    if (room.origins.colors.isCalibrated()) {
        room.deviceColor = fresh.deviceColor;
        room.tableColor = fresh.tableColor;
    }
    for (InstalledProjector& projector : room.projectors) {
        const InstalledProjector unknown;
        projector.gain = unknown.gain;
        projector.black = unknown.black;
        projector.gamma = unknown.gamma;
        projector.responseCurve.clear();
    }
    return room;
}

/// What the lab's sequence measured is a little beside what stands there.
void putWhereTheLabHasThem(Installation& room) {
    for (std::size_t k = 0; k < room.projectors.size(); ++k) {
        InstalledProjector& projector = room.projectors[k];
        if (!projector.lens.isCalibrated()) continue;
        const Installation lab = labTruth(room, k);
        const CalibratedCamera& truly = lab.projectors.front().camera;
        const auto beside = lightError(projector.camera, truly, kLitSide);
        if (truly.size != projector.camera.size || !beside || *beside > kSameLight) continue;
        projector.camera = truly;
        InstalledCamera* camera = room.cameras.empty() ? nullptr : &room.cameras.front();
        if (k == 0 && camera && camera->camera.size == lab.cameras.front().camera.size)
            camera->camera = lab.cameras.front().camera;
    }
}

} // namespace

Installation unpackedLab(const Installation& believed, std::span<const Actuator> actuators, std::uint32_t seed) {
    const Installation before = packed(believed);
    // Drawn without actuators first, so that another device finds the same room.
    Installation room = trueRoom(before, {}, seed);
    room.servos = trueRoom(before, actuators, seed).servos;
    putWhereTheLabHasThem(room);
    return room;
}

LabRoom::LabRoom(Settings& settings, StudioDocument& document, TrackerService& trackers)
    : settings_(settings), document_(document), trackers_(trackers) {
    const QVariant kept = settings.value(kUnpackedKey);
    if (bool isNumber = false; kept.isValid()) {
        const uint seed = kept.toUInt(&isNumber);
        if (isNumber) seed_ = seed;
    }
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & (StatePart::installation | StatePart::rig | StatePart::rigEdited)) follow();
    });
    follow();
}

void LabRoom::unpack() {
    if (seed_) return;
    seed_ = settings_.value(kNextKey, kFirstLab).toUInt();
    settings_.setValue(kUnpackedKey, *seed_);
    follow();
    emit changed();
}

void LabRoom::packUp() {
    if (!seed_) return;
    settings_.setValue(kNextKey, *seed_ + 1U);
    settings_.remove(kUnpackedKey);
    seed_.reset();
    follow();
    emit changed();
}

void LabRoom::follow() {
    truth_ = document_.state().installation;
    if (seed_) {
        const auto& rig = document_.state().rig.rig;
        const std::span<const Actuator> actuators = rig ? std::span(rig->actuators()) : std::span<const Actuator>();
        truth_ = std::make_shared<const Installation>(unpackedLab(*truth_, actuators, *seed_));
    }
    trackers_.setSimulatedRoom(truth_);
}

} // namespace lumorph::studio
