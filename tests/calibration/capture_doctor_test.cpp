#include "calibration/doctor/capture_calibration.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/decode/capture_folder.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/long_tests.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

namespace fs = std::filesystem;

/// A capture on disk whose files are those of another until they are changed.
class CaptureCopy {
public:
    explicit CaptureCopy(const fs::path& original) {
        for (const CapturedView& view : viewsIn(original)) {
            views_.push_back(view);
            fs::create_directories(folder_ / view.name);
            for (const fs::path& file : view.files) fs::create_symlink(file, folder_ / view.name / file.filename());
        }
    }
    [[nodiscard]] const fs::path& path() const { return folder_.path(); }
    [[nodiscard]] std::size_t viewCount() const { return views_.size(); }
    [[nodiscard]] std::size_t imageCount() const { return views_.front().files.size(); }
    [[nodiscard]] std::string nameOf(std::size_t image) const {
        return views_.front().files[image].filename().string();
    }
    [[nodiscard]] const CapturedView& original(std::size_t view) const { return views_[view]; }
    [[nodiscard]] fs::path place(std::size_t view, std::size_t image) const {
        return folder_ / views_[view].name / views_[view].files[image].filename();
    }

    void put(std::size_t view, std::size_t image, const fs::path& content) const {
        fs::remove(place(view, image));
        fs::create_symlink(content, place(view, image));
    }
    void remove(std::size_t view, std::size_t image) const { fs::remove(place(view, image)); }
    /// Changes the greys of images.
    void change(std::size_t view, std::size_t from, const std::function<void(Image&)>& how) const {
        for (std::size_t i = from; i < imageCount(); ++i) {
            Image image = readPng(views_[view].files[i]);
            how(image);
            fs::remove(place(view, i));
            writePng(image, place(view, i));
        }
    }

private:
    TemporaryFolder folder_;
    std::vector<CapturedView> views_;
};

void mirror(Image& image) {
    for (int y = 0; y < image.size().y; ++y)
        for (int x = 0; x < image.size().x / 2; ++x) std::swap(image.at(x, y), image.at(image.size().x - 1 - x, y));
}

void moveRight(Image& image, int by) {
    const Image before = image;
    for (int y = 0; y < image.size().y; ++y)
        for (int x = 0; x < image.size().x; ++x) image.at(x, y) = before.at(std::max(0, x - by), y);
}

void overexpose(Image& image) {
    for (Image::Pixel& pixel : image.pixels())
        for (int i = 0; i < 3; ++i)
            pixel[static_cast<std::size_t>(i)] =
                static_cast<std::uint8_t>(std::min(255, 4 * pixel[static_cast<std::size_t>(i)]));
}

/// What is done to a sound capture, and what has to be told of it.
struct Fault {
    std::string what;
    std::string key;
    std::string file; ///< that has to be named; empty: none in particular
    std::function<void(const CaptureCopy&)> inject;
    cv::Size projector; ///< what is said of it; empty: the truth
};

/// Faults that are found in the greys of the images, hence in real ones in another way than in simulated ones. All
/// others are found by names, sizes and bits, and take as long.
bool isSeenInGreys(const Fault& fault) {
    static const std::set<std::string> names{"sound", "late frame from image 12", "one pose mirrored",
                                             "moved by 3 pixels", "overexposed"};
    return names.contains(fault.what);
}

std::vector<Fault> faultsOf(const CaptureCopy& capture, cv::Size projector, cv::Size wrongSize) {
    const std::size_t count = capture.imageCount();
    const auto late = [count](std::size_t from) {
        return [=](const CaptureCopy& copy) {
            for (std::size_t i = from; i < count; ++i) copy.put(0, i, copy.original(0).files[i - 1]);
        };
    };
    const auto lateAndNoisy = [count](const CaptureCopy& copy) {
        for (std::size_t i = 12; i < count; ++i) copy.put(0, i, copy.original(0).files[i - 1]);
        Image image = readPng(copy.original(0).files[11]); // the same pattern, photographed again
        for (std::size_t p = 0; p < image.pixels().size(); p += 3)
            image.pixels()[p][0] = image.pixels()[p][1] = image.pixels()[p][2] =
                static_cast<std::uint8_t>(std::min(255, image.pixels()[p][0] + 1));
        fs::remove(copy.place(0, 12));
        writePng(image, copy.place(0, 12));
    };
    return {
        {"sound", "", "", [](const CaptureCopy&) {}, {}},
        {"late frame from image 12", "late_frame", capture.nameOf(12), lateAndNoisy, {}},
        {"doubled in place of image 9",
         "doubled_image",
         capture.nameOf(9),
         [](const CaptureCopy& copy) { copy.put(0, 9, copy.original(0).files[8]); },
         {}},
        {"doubled, the rest late", "doubled_image", capture.nameOf(7), late(7), {}},
        {"one image too many",
         "doubled_image",
         "",
         [](const CaptureCopy& copy) {
             fs::create_symlink(copy.original(0).files[5], copy.place(0, 5).string() + ".copy.png");
         },
         {}},
        {"image 7 missing", "missing_image", capture.nameOf(8), [](const CaptureCopy& copy) { copy.remove(0, 7); }, {}},
        {"image 7 missing, the rest renamed",
         "missing_image",
         capture.nameOf(6), // its twin: which of the two is missing nothing tells
         [count](const CaptureCopy& copy) {
             for (std::size_t i = 7; i + 1 < count; ++i) copy.put(0, i, copy.original(0).files[i + 1]);
             copy.remove(0, count - 1);
         },
         {}},
        {"white and black swapped",
         "black_white_swapped",
         capture.nameOf(count - 2),
         [count](const CaptureCopy& copy) {
             copy.put(0, count - 2, copy.original(0).files[count - 1]);
             copy.put(0, count - 1, copy.original(0).files[count - 2]);
         },
         {}},
        {"patterns and inverses exchanged",
         "inverse_swapped",
         "",
         [count](const CaptureCopy& copy) {
             for (std::size_t i = 0; i + 2 < count; ++i) copy.put(0, i, copy.original(0).files[i ^ 1U]);
         },
         {}},
        {"pattern and inverse of the second bit exchanged",
         "inverse_swapped",
         capture.nameOf(2),
         [](const CaptureCopy& copy) {
             copy.put(0, 2, copy.original(0).files[3]);
             copy.put(0, 3, copy.original(0).files[2]);
         },
         {}},
        {"two bits exchanged",
         "bit_order",
         capture.nameOf(4),
         [](const CaptureCopy& copy) {
             for (const std::size_t i : {4U, 5U, 6U, 7U}) copy.put(0, i, copy.original(0).files[i ^ 2U]);
         },
         {}},
        {"rows before columns",
         "wrong_order",
         "",
         [count](const CaptureCopy& copy) {
             const std::size_t half = (count - 2) / 2;
             for (std::size_t view = 0; view < copy.viewCount(); ++view)
                 for (std::size_t i = 0; i < 2 * half; ++i)
                     copy.put(view, i, copy.original(view).files[(i + half) % (2 * half)]);
         },
         {}},
        {"one pose mirrored", "mirrored", "", [](const CaptureCopy& copy) { copy.change(0, 0, mirror); }, {}},
        {"moved by 9 pixels half way",
         "rig_moved",
         "",
         [count](const CaptureCopy& copy) { copy.change(0, count / 2 - 1, [](Image& image) { moveRight(image, 9); }); },
         {}},
        {"moved by 3 pixels",
         "rig_moved",
         "",
         [count](const CaptureCopy& copy) { copy.change(0, count / 2 - 1, [](Image& image) { moveRight(image, 3); }); },
         {}},
        {"projector size wrong, same number of images", "projector_size", "", [](const CaptureCopy&) {}, wrongSize},
        {"projector size wrong",
         "projector_size",
         "",
         [](const CaptureCopy&) {},
         {2 * projector.width, projector.height}},
        {"width and height swapped",
         "width_height_swapped",
         "",
         [](const CaptureCopy&) {},
         {projector.height, projector.width}},
        {"only frontal views",
         "frontal_views",
         "",
         [](const CaptureCopy& copy) { // the board slid without tilting
             for (std::size_t view = 1; view < copy.viewCount(); ++view) {
                 for (std::size_t i = 0; i < copy.imageCount(); ++i) {
                     Image image = readPng(copy.original(0).files[i]);
                     moveRight(image, 5 * static_cast<int>(view));
                     fs::remove(copy.place(view, i));
                     writePng(image, copy.place(view, i));
                 }
             }
         },
         {}},
        {"the same view in all poses",
         "repeated_poses",
         "",
         [count](const CaptureCopy& copy) {
             for (std::size_t view = 1; view < copy.viewCount(); ++view)
                 for (std::size_t i = 0; i < count; ++i) copy.put(view, i, copy.original(0).files[i]);
         },
         {}},
        {"overexposed", "clipped", "", [](const CaptureCopy& copy) { copy.change(0, 0, overexpose); }, {}},
        {"an image cut off",
         "unreadable_image",
         capture.nameOf(4),
         [](const CaptureCopy& copy) {
             fs::remove(copy.place(0, 4));
             fs::copy_file(copy.original(0).files[4], copy.place(0, 4));
             fs::permissions(copy.place(0, 4), fs::perms::owner_all);
             fs::resize_file(copy.place(0, 4), 3000);
         },
         {}},
        {"an image of another size",
         "image_size",
         capture.nameOf(4),
         [](const CaptureCopy& copy) {
             fs::remove(copy.place(0, 4));
             writePng(Image({100, 80}), copy.place(0, 4));
         },
         {}},
    };
}

/// What is told of a capture: the keys of a refusal or of warnings, and the file that is named.
struct Told {
    bool refused = false;
    std::vector<std::string> keys;
    std::string file, sentence;
};

Told toldOf(const fs::path& folder, const CalibrationBoard& board, cv::Size projector) {
    Told told;
    try {
        const ProcamCalibration result = calibrateProcamFolder(folder, board, parsePattern("graycode", projector));
        for (const Finding& warning : result.warnings) told.keys.emplace_back(keyOf(warning.cause));
        if (!result.warnings.empty()) told.sentence = sentenceOf(result.warnings.front());
    } catch (const CaptureRefused& refused) {
        told = {
            true, {std::string(keyOf(refused.finding().cause))}, refused.finding().file, sentenceOf(refused.finding())};
    }
    return told;
}

/// `few`: of the faults that are seen in greys every third.
void expectTold(const fs::path& original, const CalibrationBoard& board, cv::Size projector, cv::Size wrongSize,
                bool few = false) {
    int passed = 0;
    for (const Fault& fault : faultsOf(CaptureCopy(original), projector, wrongSize)) {
        if (few && (!isSeenInGreys(fault) || passed++ % 3 != 0)) continue;
        const CaptureCopy copy(original);
        fault.inject(copy);
        const Told told = toldOf(copy.path(), board, fault.projector.empty() ? projector : fault.projector);
        std::string keys;
        for (const std::string& key : told.keys) keys += (keys.empty() ? "" : " ") + key;
        std::printf("%-44s %-8s %-22s %s\n", fault.what.c_str(), told.refused ? "refused" : "accepted", keys.c_str(),
                    told.sentence.c_str());
        if (fault.key.empty()) {
            EXPECT_FALSE(told.refused) << fault.what;
            EXPECT_EQ(keys, "") << fault.what;
        } else {
            EXPECT_THAT(told.keys, ::testing::Contains(fault.key)) << fault.what << ": " << told.sentence;
        }
        if (!fault.file.empty()) {
            EXPECT_EQ(told.file, fault.file) << fault.what;
        }
    }
}

TEST(CaptureDoctor, NamesEachFaultOfASimulatedCapture) {
    ProcamSetup setup = ProcamSetup::usual();
    std::vector<std::vector<Image>> poses;
    for (const std::size_t pose : {0U, 1U, 3U, 5U})
        poses.push_back(photographAll(setup, setup.cameraFromBoard[pose], grayCodeLights(setup.projector.size),
                                      static_cast<std::uint32_t>(pose) + 1));
    const TemporaryFolder folder;
    writeCapture(folder.path(), poses);
    expectTold(folder.path(), parseCalibrationBoard("chess:9x7:30"), {256, 192}, {160, 130});
}

TEST(CaptureDoctor, NamesEachFaultOfARealCapture) {
    const fs::path folder = fs::path(LUMORPH_SHARED_DIR) / "data/procam_chess";
    if (!fs::exists(folder)) GTEST_SKIP() << "without ../shared/data/procam_chess";
    expectTold(fs::canonical(folder), parseCalibrationBoard("chess:9x7:75"), {1024, 768}, {800, 600}, !longTests());
}

TEST(CaptureDoctor, RefusesWhatIsNoCapture) {
    const TemporaryFolder folder;
    const CalibrationBoard board = parseCalibrationBoard("chess:9x7:30");
    const CaptureOrder order = parsePattern("graycode", {256, 192});
    EXPECT_THROW((void)calibrateProcamFolder(folder / "nowhere", board, order), DataError);
    EXPECT_THROW((void)calibrateProcamFolder(folder.path(), board, order), DataError);
    EXPECT_THROW((void)calibrateIntrinsicsFolder(folder.path(), board), DataError);
}

// A picture of 50,000 pixels a side takes a few bytes on disk and ten gigabytes unpacked.
TEST(CaptureDoctor, RefusesAPictureOfAbsurdSizeBeforeUnpackingIt) {
    const TemporaryFolder folder;
    fs::create_directories(folder / "pose_0");
    const unsigned char header[] = {0x89, 'P',  'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A, 0,    0,    0,
                                    13,   'I',  'H', 'D', 'R',  0,    0,    0xC3, 0x50, 0,    0,
                                    0xC3, 0x50, 8,   0,   0,    0,    0,    0x3B, 0x8D, 0x1B, 0xC4};
    for (int i = 0; i < 34; ++i) {
        std::ofstream file(folder / "pose_0" / imageName(static_cast<std::size_t>(i)), std::ios::binary);
        file.write(reinterpret_cast<const char*>(header), sizeof(header));
    }
    const Told told = toldOf(folder.path(), parseCalibrationBoard("chess:9x7:30"), {256, 192});
    EXPECT_TRUE(told.refused);
    EXPECT_THAT(told.keys, ::testing::ElementsAre("unreadable_image"));
    EXPECT_EQ(told.file, imageName(0));
}

TEST(CaptureDoctor, EveryCauseHasAKeyOfItsOwn) {
    std::map<std::string_view, int> keys;
    for (int i = 0; i < kCauseCount; ++i) ++keys[keyOf(static_cast<Cause>(i))];
    EXPECT_EQ(static_cast<int>(keys.size()), kCauseCount);
    for (const auto& [key, count] : keys) EXPECT_THAT(std::string(key), ::testing::MatchesRegex("[a-z_]+")) << count;
}

TEST(CaptureFolder, NumbersInNamesCountAsNumbers) {
    const TemporaryFolder folder;
    for (const char* name : {"a10.png", "a2.png", "a1.PNG", "a02x.png", "b.txt", "a3.jpeg"})
        std::ofstream(folder / name) << "x";
    std::vector<std::string> names;
    for (const fs::path& file : imagesIn(folder.path())) names.push_back(file.filename().string());
    EXPECT_THAT(names, ::testing::ElementsAre("a1.PNG", "a2.png", "a02x.png", "a3.jpeg", "a10.png"));
}

} // namespace
} // namespace lumorph::test
