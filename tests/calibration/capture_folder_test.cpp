#include "calibration/decode/capture_folder.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "calibration/doctor/capture_calibration.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Every grey, in a picture that is no square.
cv::Mat1b allGreys() {
    cv::Mat1b grey(40, 64);
    for (int y = 0; y < grey.rows; ++y)
        for (int x = 0; x < grey.cols; ++x) grey(y, x) = static_cast<uchar>((y * grey.cols + x) % 256);
    return grey;
}

void save(const fs::path& file, const cv::Mat& image, const std::vector<int>& how = {}) {
    ASSERT_TRUE(cv::imwrite(file.string(), image, how)) << file;
}

void saveText(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

/// The most by which pictures differ.
double mostApart(const cv::Mat& one, const cv::Mat& other) { return cv::norm(one, other, cv::NORM_INF); }

TEST(CaptureFolder, PicturesOfEveryKindAreReadAlike) {
    const TemporaryFolder folder;
    const cv::Mat1b grey = allGreys();
    cv::Mat colour, alpha, deep, twelve;
    cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
    cv::cvtColor(grey, alpha, cv::COLOR_GRAY2BGRA);
    grey.convertTo(deep, CV_16U, 257.0);
    grey.convertTo(twelve, CV_16U, 4095.0 / 255.0);
    const fs::path place = folder.path();
    for (const char* name : {"a.png", "b.bmp", "c.tif", "d.TIFF", "e.pgm", "f.ppm", "g.PNG"})
        save(place / name, std::string(name) == "f.ppm" ? colour : static_cast<const cv::Mat&>(grey));
    save(place / "h.webp", colour, {cv::IMWRITE_WEBP_QUALITY, 101}); // above 100: without loss
    save(place / "i.png", alpha);
    for (const fs::path& file : imagesIn(place)) EXPECT_LE(mostApart(readGrey(file, "pose"), grey), 0.0) << file;
    for (const auto& [name, image] :
         {std::pair("16.png", deep), {"16.tif", deep}, {"12.png", twelve}, {"12.pgm", twelve}}) {
        const fs::path file = place / name;
        save(file, image);
        EXPECT_LE(mostApart(readGrey(file, "pose"), grey), 1.0) << file;
    }
}

TEST(CaptureFolder, BitsOfAPoseAreThoseOfItsBrightestImage) {
    const TemporaryFolder folder;
    cv::Mat bright, dark;
    allGreys().convertTo(bright, CV_16U, 4095.0 / 255.0);
    allGreys().convertTo(dark, CV_16U, 40.0 / 255.0); // black: alone it would be taken for 10 bits
    save(folder / "0.png", bright);
    save(folder / "1.png", dark);
    const std::vector<cv::Mat> images = readImages({"pose", imagesIn(folder.path())});
    double most = 0.0;
    cv::minMaxLoc(images[1], nullptr, &most);
    EXPECT_LE(mostApart(images[0], allGreys()), 1.0);
    EXPECT_NEAR(most, 40.0 * 255.0 / 4095.0, 1.0);
}

TEST(CaptureFolder, NamesAreSortedAsPeopleMeanThem) {
    const TemporaryFolder folder;
    for (const char* name : {"shot (10).png", "shot.png", "Shot (2).PNG", "shot (1).png", "._shot.png", ".hidden.png"})
        save(folder / name, allGreys());
    std::vector<std::string> names;
    for (const fs::path& file : imagesIn(folder.path())) names.push_back(file.filename().string());
    EXPECT_THAT(names, ElementsAre("shot.png", "shot (1).png", "Shot (2).PNG", "shot (10).png"));
}

/// A capture as people have it: BMP with capital endings, and all that gathers beside it.
TEST(CaptureFolder, WhatIsNoneOfTheCaptureIsPassedOverAndNamed) {
    const TemporaryFolder folder;
    const ProcamSetup setup = ProcamSetup::usual();
    const CaptureOrder order = parsePattern("graycode", {setup.projector.size.x, setup.projector.size.y});
    const std::vector<Light> lights = grayCodeLights(setup.projector.size);
    std::vector<std::vector<Image>> poses;
    for (std::uint32_t pose = 0; pose < 4; ++pose)
        poses.push_back(photographAll(setup, setup.cameraFromBoard[pose + 1], lights, 61 + pose));
    const fs::path clean = folder / "clean";
    const fs::path untidy = folder / "untidy";
    writeCapture(clean, poses);
    for (std::size_t pose = 0; pose < poses.size(); ++pose) {
        const fs::path place = untidy / ("pose_" + std::to_string(pose));
        fs::create_directories(place);
        for (std::size_t i = 0; i < lights.size(); ++i)
            save(place / ("Frame (" + std::to_string(i) + ").BMP"),
                 cv::imread((clean / place.filename() / imageName(i)).string(), cv::IMREAD_GRAYSCALE));
        saveText(place / "Thumbs.db", "system");
        saveText(place / ".DS_Store", "system");
    }
    fs::create_directories(untidy / "graycode_pattern");
    for (std::size_t i = 0; i < order.images.size(); ++i)
        save(untidy / "graycode_pattern" / ("pattern_" + std::to_string(i) + ".png"),
             drawPattern(order.images[i], order.projector));
    save(untidy / "the room.jpg", allGreys());
    save(untidy / "pose_1" / "tripod.jpg", allGreys());
    saveText(untidy / "pose_2" / "IMG_0001.HEIC", "no picture for us");
    fs::create_directories(untidy / "later");
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:30");
    const ProcamCalibration known = calibrateProcamFolder(clean, board, order);
    const ProcamCalibration result = calibrateProcamFolder(untidy, board, order);
    EXPECT_EQ(result.camera.lens, known.camera.lens);
    EXPECT_EQ(result.projector.lens, known.projector.lens);
    EXPECT_TRUE(known.warnings.empty()) << sentenceOf(known.warnings.front());
    std::string told;
    for (const Finding& warning : result.warnings) {
        EXPECT_EQ(warning.cause, Cause::passedOver) << sentenceOf(warning);
        told += sentenceOf(warning) + "\n";
    }
    EXPECT_THAT(result.warnings, SizeIs(5)) << told;
    for (const char* name : {"graycode_pattern", "the room.jpg", "tripod.jpg", "IMG_0001.HEIC", "later"})
        EXPECT_THAT(told, HasSubstr(name));
}

TEST(CaptureFolder, AFolderWithoutPosesSaysWhatItHoldsInstead) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "pose_0");
    saveText(folder / "pose_0" / "a.cr2", "raw");
    try {
        (void)viewsIn(folder.path());
        FAIL() << "accepted";
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), HasSubstr("a.cr2"));
        EXPECT_THAT(error.what(), HasSubstr("BMP"));
    }
}

} // namespace
} // namespace lumorph::test
