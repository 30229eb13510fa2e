#include "devices/firmware/part_board.h"

#include "devices/firmware/sketch.h"

namespace lumorph {

void wireAs(const BuildPlan& plan, DeviceProfile& profile) {
    for (std::size_t k = 0; k < plan.wiring.size() && k < profile.servos.size(); ++k) {
        const WiringRow& row = plan.wiring[k];
        ServoSetup& servo = profile.servos[k];
        servo.channel = row.pin;
        servo.pulseMin = row.pulseMin;
        servo.pulseMax = row.pulseMax;
        servo.curve = row.curve;
        servo.reversed = row.reversed;
    }
}

DeviceProfile profileOf(const Rig& rig, const BuildPlan& plan) {
    DeviceProfile profile = profileFor(rig);
    wireAs(plan, profile);
    return profile;
}

void addBoardFiles(const Rig& rig, const BuildPlan& plan, const std::filesystem::path& folder) {
    if (plan.wiring.empty() || plan.wiring.size() > kBoardServos) return;
    const DeviceProfile profile = profileOf(rig, plan);
    writeProfile(profile, folder / "profile.json");
    static_cast<void>(writeSketch(profile, folder)); // its name is plain in a fresh folder
}

} // namespace lumorph
