#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph::table {

/// The room as it truly is.
struct TableTruth {
    std::uint32_t seed = 1;
    std::shared_ptr<const Rig> rig;
    /// Where things stand and how they are. `worldFromDevice` is where the device lies at first, `predictionSeconds`
    /// the time from a picture on the screen to its light, `trackerSeconds` the age of poses that nobody tells.
    Installation room;
    std::string board = "chess:9x7:25"; ///< that is printed, millimetres
};

/// What is drawn by a seed.
struct TableOrder {
    std::uint32_t seed = 1;
    std::vector<glm::ivec2> screens; ///< pixels, one a projector
    int cameras = 1;
    glm::ivec2 cameraSize{1280, 1024};
    std::string board = "chess:9x7:25";
};

/// Projectors a quarter of the way round the table from each other, a camera beside each of the first ones, all of them
/// a little turned and shifted from where they are usually put; everything else as `trueRoom` draws it. The same for
/// the same order. Throws InvalidInput without a screen, with more cameras than projectors, or for a board that is
/// none.
[[nodiscard]] TableTruth drawTruth(const TableOrder& order, const std::shared_ptr<const Rig>& rig);

/// For whoever judges: the installation, seed, rig and board. Throws DeviceError where the disk refuses.
void writeTruth(const TableTruth& truth, const std::filesystem::path& file);

} // namespace lumorph::table
