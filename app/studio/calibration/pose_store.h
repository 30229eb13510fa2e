#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "calibration/capture/pose_capture.h"
#include "core/base/progress.h"

namespace lumorph::studio {

/// Keeps the images of one calibration on the disk, as `calibrateProcamFolder` reads them: a folder for each pose in a
/// dated one that is made for the first. Any thread.
class PoseStore {
public:
    using Pose = std::shared_ptr<const CapturedPose>;

    /// `isSimulated`: the images are the virtual lab's, and the folder says so. `folder`: of the poses so far, where
    /// they were saved at another time.
    explicit PoseStore(bool isSimulated = false, std::filesystem::path folder = {})
        : isSimulated_(isSimulated), folder_(std::move(folder)) {}

    /// Saves a pose (null: none) below `parent`, after those that could not be saved before. Where the poses so far lie
    /// below another parent they are copied there first, so that all are together. Throws DeviceError where the disk
    /// refuses, and Cancelled: then the pose waits in memory, up to a gigabyte of them, and is saved with the next.
    void save(const std::filesystem::path& parent, Pose pose, const Progress& progress = {});

    /// The dated folder; empty before the first pose.
    [[nodiscard]] std::filesystem::path folder() const;
    /// How many poses are not on the disk.
    [[nodiscard]] int unsaved() const;

private:
    void moveTo(const std::filesystem::path& parent, const Progress& progress);
    void wait(Pose pose);

    bool isSimulated_;
    std::mutex saving_;        ///< one save at a time
    mutable std::mutex mutex_; ///< of the rest, for moments
    std::filesystem::path folder_;
    std::vector<Pose> waiting_;
    int lost_ = 0; ///< poses for which memory had no room
};

} // namespace lumorph::studio
