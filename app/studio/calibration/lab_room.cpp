#include "app/studio/calibration/lab_room.h"

#include "calibration/lab/true_room.h"

namespace lumorph::studio {
namespace {

constexpr auto kUnpackedKey = "lab/unpacked"; // seed of the lab that stands there
constexpr auto kNextKey = "lab/next";         // of the one after it
constexpr std::uint32_t kFirstLab = 7;
} // namespace

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
