#include "app/studio/calibration/pose_store.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "calibration/decode/capture_folder.h"
#include "core/base/error.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;

PoseStore::Pose poseOf(const std::string& name, int grey) {
    auto pose = std::make_shared<CapturedPose>();
    pose->name = name;
    for (int i = 0; i < 3; ++i) {
        pose->images.emplace_back(48, 64, CV_8U, cv::Scalar(grey + i));
        pose->files.push_back("shot_" + std::to_string(i) + ".png");
    }
    return pose;
}

/// Name and grey of the first image of each pose.
std::vector<std::pair<std::string, int>> readBack(const fs::path& folder) {
    std::vector<std::pair<std::string, int>> poses;
    for (const CapturedView& view : viewsIn(folder)) {
        EXPECT_EQ(view.files.size(), 3U) << view.name;
        poses.emplace_back(view.name, readGrey(view.files.front(), view.name).at<uchar>(20, 20));
    }
    std::ranges::sort(poses);
    return poses;
}

std::size_t countIn(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

using Poses = std::vector<std::pair<std::string, int>>;

TEST(PoseStore, MakesADatedFolderForTheFirstPoseAndKeepsToIt) {
    const TemporaryFolder folder;
    const fs::path parent = folder / "not" / "there yet";
    PoseStore store, other;
    EXPECT_TRUE(store.folder().empty());
    EXPECT_FALSE(fs::exists(parent));
    store.save(parent, poseOf("pose_1", 10));
    store.save(parent, poseOf("pose_2", 20));
    store.save(parent, poseOf("pose_2", 30)); // taken again
    EXPECT_EQ(store.folder().parent_path(), parent);
    EXPECT_EQ(readBack(store.folder()), (Poses{{"pose_1", 10}, {"pose_2", 30}}));
    other.save(parent, poseOf("pose_1", 40)); // another calibration, most likely in the same second
    EXPECT_NE(other.folder(), store.folder());
    EXPECT_EQ(readBack(other.folder()), (Poses{{"pose_1", 40}}));
    EXPECT_EQ(countIn(parent), 2U);
}

TEST(PoseStore, KeepsPosesThatTheDiskRefusesUntilThereIsAPlace) {
    const TemporaryFolder folder;
    std::ofstream(folder / "file") << "no folder";
    PoseStore store;
    for (const auto& [name, grey] : Poses{{"pose_1", 10}, {"pose_2", 20}, {"pose_2", 30}}) {
        try {
            store.save(folder / "file", poseOf(name, grey));
            ADD_FAILURE() << "a file was taken for a folder";
        } catch (const DeviceError& error) {
            EXPECT_FALSE(error.remedy().empty());
        }
    }
    EXPECT_EQ(store.unsaved(), 2);
    EXPECT_TRUE(store.folder().empty());
    store.save(folder / "good", poseOf("pose_3", 40));
    EXPECT_EQ(store.unsaved(), 0);
    EXPECT_EQ(readBack(store.folder()), (Poses{{"pose_1", 10}, {"pose_2", 30}, {"pose_3", 40}}));
}

TEST(PoseStore, BringsAllPosesBelowANewParent) {
    const TemporaryFolder folder;
    PoseStore store;
    store.save(folder / "first", poseOf("pose_1", 10));
    const fs::path before = store.folder();
    store.save(folder / "second", nullptr);
    EXPECT_EQ(store.folder().parent_path(), folder / "second");
    store.save(folder / "second", poseOf("pose_2", 20));
    EXPECT_EQ(readBack(store.folder()), (Poses{{"pose_1", 10}, {"pose_2", 20}}));
    EXPECT_EQ(readBack(before), (Poses{{"pose_1", 10}})) << "what lay there stays";
    // A parent that cannot be used changes nothing.
    std::ofstream(folder / "file") << "no folder";
    EXPECT_THROW(store.save(folder / "file", poseOf("pose_3", 30)), DeviceError);
    EXPECT_EQ(store.folder().parent_path(), folder / "second");
    EXPECT_EQ(store.unsaved(), 1);
}

TEST(PoseStore, LeavesNothingHalfWrittenWhereItIsCancelled) {
    const TemporaryFolder folder;
    PoseStore store;
    std::stop_source stop;
    const Progress progress([&](double, std::string_view) { stop.request_stop(); }, stop.get_token());
    EXPECT_THROW(store.save(folder / "poses", poseOf("pose_1", 10), progress), Cancelled);
    EXPECT_EQ(store.unsaved(), 1);
    EXPECT_EQ(countIn(store.folder()), 0U);
}

} // namespace
} // namespace lumorph::studio
