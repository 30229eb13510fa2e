#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/loop/pose_stream.h"
#include "core/render/spatial_renderer.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph::test {

/// A moment of a show in the virtual lab.
struct ShownMoment {
    std::vector<double> before;  ///< strokes from which servos come, so that their play shows
    std::vector<double> strokes; ///< that are wanted
    Pose device;                 ///< where it truly lies, world metres
    Pose eye;                    ///< where the tracked eye truly is, and how its head is turned
};
/// The tablet carried and turned on the table, raised and flat, before eyes all around.
[[nodiscard]] std::vector<ShownMoment> shownMoments();

/// How far a show by an estimated installation is beside what the eye should see, in the room as it truly is.
struct ShownError {
    /// Of balls on and above the device, eye pixels (1280 x 800 tight around the device): the centre of their light in
    /// the lab's picture from the true eye, against where they should be seen.
    std::vector<double> balls;
    std::size_t judgedBalls = 0; ///< that a show by the truth itself has
    /// Of places of the device's skin that projector and eye see: how far beside them their light falls.
    std::vector<double> skinPixels, skinMillimetres;
    double eyeMillimetres = 0.0, deviceMillimetres = 0.0; ///< of where they are believed to be, the world as believed
    void add(const ShownError& other);
};

/// Tracks device and head as the true room's tracker would without noise, tells servos what the estimated curves say,
/// draws by the estimated installation, lights the true device with that by the true projector, and looks from the true
/// eye by the lab's rays.
[[nodiscard]] ShownError shownError(SpatialRenderer& renderer, const std::shared_ptr<const Rig>& rig,
                                    const Installation& estimated, const Installation& truth,
                                    const ShownMoment& moment);
/// Of all moments, one after the other, in a context of its own.
[[nodiscard]] ShownError shownError(const std::shared_ptr<const Rig>& rig, const Installation& estimated,
                                    const Installation& truth);

/// Of places of the device's skin as in ShownError, while its servos stand elsewhere than is believed: light that is
/// meant for them at `believed` strokes falls on the device at `real` ones.
[[nodiscard]] ShownError lightBeside(const std::shared_ptr<const Rig>& rig, const Installation& room,
                                     const std::vector<double>& believed, const std::vector<double>& real);

} // namespace lumorph::test
