#include "calibration/stages/placed_devices.h"

#include <algorithm>
#include <cstdio>

#include "calibration/stages/stage_rows.h"

namespace lumorph::stages {

HeldOutLight heldOutOf(std::vector<LightBeside> all) {
    HeldOutLight light;
    light.points = all.size();
    if (all.empty()) return light;
    const auto at = [&all](double share, double LightBeside::*which) {
        const auto place = all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
        std::ranges::nth_element(all, place, {}, which);
        return (*place).*which;
    };
    light.median = at(0.5, &LightBeside::metres);
    light.most = at(0.95, &LightBeside::metres);
    light.medianPixels = at(0.5, &LightBeside::pixels);
    light.mostPixels = at(0.95, &LightBeside::pixels);
    return light;
}

void judgePlaces(PlacedDevices& result) {
    constexpr std::size_t kFewestPoints = 3;
    constexpr double kMostMedian = 1.5, kMostOfMost = 5.0; // projector pixels
    char text[200];
    for (const PlacedDevices::Device& device : result.devices) {
        if (!device.isProjector) continue;
        const HeldOutLight& light = device.heldOut;
        if (light.points < kFewestPoints) {
            result.warnings.push_back({Cause::tooFewPoints, "", "", "what checks shows no light of " + device.name,
                                       "record what comes last where all projectors light it"});
        } else if (light.medianPixels > kMostMedian || light.mostPixels > kMostOfMost) {
            std::snprintf(text, sizeof(text), "light of %s lies %.1f pixels beside where the fit never saw it",
                          device.name.c_str(), light.medianPixels);
            result.refusal = {Cause::freshPointsFar, "", "", text,
                              "fix projectors and cameras, and record all of it again"};
        }
    }
    if (result.heldOut.points < kFewestPoints)
        std::snprintf(text, sizeof(text), "All fits to %.2f pixels; nothing was there to check it.", result.rms);
    else
        std::snprintf(text, sizeof(text),
                      "Light lies %.2f mm beside where the fit never saw it (median; 95 of 100 points: %.2f mm).",
                      1e3 * result.heldOut.median, 1e3 * result.heldOut.most);
    result.summary = text;
}

void applyPlaces(const Installation& measured, Installation& room) {
    for (std::size_t k = 0; k < measured.projectors.size(); ++k) {
        if (k == room.projectors.size()) room.projectors.push_back(measured.projectors[k]);
        InstalledProjector& projector = room.projectors[k];
        projector.camera = measured.projectors[k].camera;
        projector.lens = measured.projectors[k].lens;
        projector.pose = measured.projectors[k].pose;
    }
    for (std::size_t k = 0; k < measured.cameras.size(); ++k) {
        if (k == room.cameras.size()) room.cameras.push_back(measured.cameras[k]);
        InstalledCamera& camera = room.cameras[k];
        camera.camera = measured.cameras[k].camera;
        camera.lens = measured.cameras[k].lens;
        camera.pose = measured.cameras[k].pose;
    }
}

const Origin* originByMethod(const Installation& room, std::string_view method) {
    const bool isOurs = !room.projectors.empty() && room.projectors.front().pose.method.starts_with(method);
    return isOurs ? &room.projectors.front().pose : nullptr;
}

} // namespace lumorph::stages
