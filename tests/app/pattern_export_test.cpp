#include "app/output/pattern_export.h"

#include <algorithm>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "core/base/error.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> picturesIn(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::path& file : fs::directory_iterator(folder))
        if (file.extension() == ".png") files.push_back(file);
    std::ranges::sort(files);
    return files;
}

// Read back as somebody else's reader has it: pictures by OpenCV, in the order of their names.
TEST(PatternExport, PicturesOrderAndFilmShowThePatterns) {
    TemporaryFolder folder;
    const cv::Size projector(320, 200);
    const CaptureOrder order = parsePattern("graycode", projector);
    writePatterns(order, folder / "patterns", 0.3);
    EXPECT_EQ(readCaptureOrder(folder / "patterns/order.txt", projector), order);
    const std::vector<fs::path> files = picturesIn(folder / "patterns");
    ASSERT_EQ(files.size(), order.images.size());
    cv::VideoCapture film((folder / "patterns/patterns.mp4").string());
    for (std::size_t i = 0; i < files.size(); ++i) {
        const cv::Mat wanted = drawPattern(order.images[i], projector);
        const cv::Mat written = cv::imread(files[i].string(), cv::IMREAD_GRAYSCALE);
        ASSERT_EQ(written.size(), wanted.size());
        EXPECT_EQ(cv::norm(written, wanted, cv::NORM_INF), 0.0) << files[i];
        for (int frame = 0; frame < 3; ++frame) {
            cv::Mat seen;
            ASSERT_TRUE(film.read(seen)) << i;
            if (frame != 1) continue; // fine stripes may lose some contrast
            EXPECT_NEAR(cv::mean(seen)[0], cv::mean(wanted)[0], 12.0) << i;
        }
    }
}

TEST(PatternExport, LeavesNothingWhereItCannotBeDone) {
    TemporaryFolder folder;
    const CaptureOrder order = parsePattern("graycode", {320, 200});
    fs::create_directories(folder / "full");
    std::ofstream(folder / "full/letter") << "dear";
    EXPECT_THROW(writePatterns(order, folder / "full", 1.0), InvalidInput);
    EXPECT_TRUE(fs::exists(folder / "full/letter"));
    EXPECT_THROW(writePatterns(order, folder / "slow", 1e3), InvalidInput);
    EXPECT_THROW(writePatterns(parsePattern("graycode", {321, 200}), folder / "odd", 1.0), InvalidInput);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(writePatterns(order, folder / "cancelled", 1.0, Progress({}, stop.get_token())), Cancelled);
    for (const char* name : {"slow", "odd", "cancelled"}) EXPECT_FALSE(fs::exists(folder / name)) << name;
}

} // namespace
} // namespace lumorph
