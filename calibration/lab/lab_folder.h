#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "core/base/progress.h"

namespace lumorph {

/// One picture of a capture, as it is called.
struct LabShot {
    std::string view, file;
    cv::Mat grey; ///< 8 bits
};

/// The folder of a capture while it is made: hidden beside its place, which it takes at the end or never.
class LabFolder {
public:
    /// Throws InvalidInput for a place that holds something, DeviceError where the disk refuses; so do the others.
    explicit LabFolder(std::filesystem::path target);
    LabFolder(const LabFolder&) = delete;
    LabFolder& operator=(const LabFolder&) = delete;
    ~LabFolder();

    /// Pictures of one view, into a folder of its name. Throws Cancelled.
    void write(const std::vector<LabShot>& shots, const Progress& progress) const;
    void write(const std::string& file, const std::string& text) const;
    /// All of it appears in its place.
    void finish();

private:
    std::filesystem::path target_, place_;
};

} // namespace lumorph
