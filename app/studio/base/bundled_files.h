#pragma once

#include <filesystem>
#include <vector>

#include <QString>

namespace lumorph::studio {

/// A rig or a target that comes with the program.
struct BundledFile {
    QString title; ///< "Pin display"
    std::filesystem::path file;
    std::filesystem::path picture; ///< 320 x 200; empty where there is none
};

/// In the order of their names; none where the resources are missing.
[[nodiscard]] std::vector<BundledFile> bundledRigs();
[[nodiscard]] std::vector<BundledFile> bundledTargets();

} // namespace lumorph::studio
