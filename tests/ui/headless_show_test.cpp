#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "app/studio/headless_show.h"
#include "core/base/error.h"
#include "core/base/image.h"
#include "tests/core/temporary_folder.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;

/// Share of pixels whose green stands out by this much, as field voxels and level surfaces do.
double greenShare(const Image& image) {
    std::size_t green = 0;
    for (const Image::Pixel& p : image.pixels()) green += p[1] > p[0] + 20 && p[1] > p[2] + 12 ? 1 : 0;
    return static_cast<double>(green) / static_cast<double>(image.pixels().size());
}

/// Share of pixels that two pictures of one size differ in.
double differentShare(const Image& a, const Image& b) {
    std::size_t different = 0;
    for (std::size_t k = 0; k < a.pixels().size(); ++k) {
        int distance = 0;
        for (std::size_t c = 0; c < 3; ++c) distance += std::abs(int(a.pixels()[k][c]) - int(b.pixels()[k][c]));
        different += distance > 24 ? 1 : 0;
    }
    return static_cast<double>(different) / static_cast<double>(a.pixels().size());
}

/// How alike two pictures of one size are, -1 to 1, however light a room makes one of them.
double correlation(const Image& a, const Image& b) {
    double n = 0.0, sumA = 0.0, sumB = 0.0, ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t k = 0; k < a.pixels().size(); ++k)
        for (std::size_t c = 0; c < 3; ++c) {
            const double x = a.pixels()[k][c], y = b.pixels()[k][c];
            n += 1.0, sumA += x, sumB += y, ab += x * y, aa += x * x, bb += y * y;
        }
    return (n * ab - sumA * sumB) / std::sqrt((n * aa - sumA * sumA) * (n * bb - sumB * sumB));
}

TEST(HeadlessShow, DrawsPicturesAVideoAndATableWithoutADisplay) {
    const TemporaryFolder own;
    const fs::path folder = own / "show";
    std::ostringstream out;
    runHeadlessShow(folder, 0.2, out);
    EXPECT_THAT(out.str(), testing::HasSubstr(folder.string()));

    const auto picture = [&](const char* name) { return readPng(folder / name); };
    const Image start = picture("start.png");
    EXPECT_EQ(start.size(), glm::ivec2(1600, 1000));
    EXPECT_GT(differentShare(start, picture("end.png")), 0.01) << "the device moved";
    EXPECT_GT(differentShare(picture("end.png"), picture("unmatched.png")), 0.002) << "what does not match is tinted";
    EXPECT_GT(greenShare(picture("voxels.png")), greenShare(start) + 0.03);
    EXPECT_GT(greenShare(picture("level-surface.png")), greenShare(start) + 0.01);

    cv::VideoCapture video((folder / "bloom.mp4").string(), cv::CAP_FFMPEG);
    int frames = 0;
    for (cv::Mat frame; video.read(frame); ++frames) EXPECT_EQ(frame.size(), cv::Size(960, 600));
    EXPECT_EQ(frames, 6);

    // The water as eye, projector and lab see it.
    const Image eye = picture("water-eye.png"), lab = picture("water-lab.png");
    EXPECT_EQ(eye.size(), glm::ivec2(1600, 1000));
    EXPECT_EQ(lab.size(), eye.size());
    EXPECT_GT(correlation(eye, lab), 0.9) << "what is lit looks like what is to be seen";
    EXPECT_LT(correlation(eye, start), 0.5) << "and like nothing else";
    EXPECT_EQ(picture("water-projector.png").size(), glm::ivec2(1920, 1080)) << "the projector's own pixels";
    cv::VideoCapture water((folder / "water.mp4").string(), cv::CAP_FFMPEG);
    cv::Mat first, last;
    ASSERT_TRUE(water.read(first));
    frames = 1;
    for (cv::Mat frame; water.read(frame); ++frames) last = frame.clone();
    EXPECT_EQ(frames, 6);
    EXPECT_GT(cv::norm(first, last, cv::NORM_L1) / static_cast<double>(first.total()), 1.0) << "it moves";

    std::ifstream table(folder / "bloom.csv");
    int lines = 0;
    for (std::string line; std::getline(table, line); ++lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 14);
    EXPECT_EQ(lines, 7) << "a line of names and one for each picture";
}

TEST(HeadlessShow, RefusesAPlaceAndATimeThatCannotBe) {
    std::ostringstream out;
    EXPECT_THROW(runHeadlessShow("/proc/nowhere", 1.0, out), DeviceError);
    for (const double seconds : {0.0, -1.0, 1e9, std::nan("")})
        EXPECT_THROW(runHeadlessShow(fs::temp_directory_path(), seconds, out), InvalidInput) << seconds;
}

} // namespace
} // namespace lumorph::studio
