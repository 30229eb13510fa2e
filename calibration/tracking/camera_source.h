#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lumorph {

/// A camera of this machine.
struct CameraInfo {
    std::string path; ///< "/dev/video0"
    std::string name; ///< as its maker calls it
    bool operator==(const CameraInfo&) const = default;
};

/// All that give pictures, by number; `folder` is where the system lists them.
[[nodiscard]] std::vector<CameraInfo> listCameras(const std::filesystem::path& folder = "/sys/class/video4linux");

/// What can be told of a camera or video that does not open.
struct SourceFacts {
    bool isCamera = false; ///< it should be one, by its name
    bool exists = false;
    bool permitted = false;
    std::string holder;              ///< "cheese (process 1234)"; empty where nobody is known to use it
    std::vector<CameraInfo> cameras; ///< those that are there
};
[[nodiscard]] bool isCameraPath(const std::string& source);
[[nodiscard]] SourceFacts lookAt(const std::string& source);

/// Why it does not open, and what to do: one or two sentences.
[[nodiscard]] std::string adviceFor(const std::string& source, const SourceFacts& facts);

} // namespace lumorph
