#include "core/base/image.h"

#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/render/figure/text.h"
#include "tests/core/temporary_folder.h"

namespace lumorph {
namespace {

std::filesystem::path writeText(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

TEST(Image, APngComesBackAsItWas) {
    const TemporaryFolder folder;
    std::mt19937 random(3);
    Image image({37, 21});
    for (Image::Pixel& pixel : image.pixels())
        for (std::uint8_t& channel : pixel) channel = static_cast<std::uint8_t>(random());
    writePng(image, folder.path() / "a.png");
    EXPECT_EQ(readPng(folder.path() / "a.png"), image);
}

TEST(Image, BrokenFilesAreRefusedByName) {
    const TemporaryFolder folder;
    writePng(Image({50, 50}), folder.path() / "good.png");
    const auto bytes = std::filesystem::file_size(folder.path() / "good.png");
    std::filesystem::resize_file(folder.path() / "good.png", bytes / 2);
    writeText(folder / "text.png", "not a picture");
    for (const char* name : {"good.png", "text.png", "absent.png"}) {
        try {
            (void)readPng(folder.path() / name);
            ADD_FAILURE() << name;
        } catch (const DataError& error) {
            EXPECT_EQ(error.subject(), (folder.path() / name).string());
        }
    }
}

TEST(Image, RefusesSizesAndPlacesThatCannotBe) {
    EXPECT_THROW(Image({0, 5}), InvalidInput);
    EXPECT_THROW(Image({5, kMaxImageSide + 1}), InvalidInput);
    const TemporaryFolder folder;
    EXPECT_THROW(writePng(Image(), folder.path() / "a.png"), InvalidInput);
    EXPECT_THROW(writePng(Image({2, 2}), folder.path() / "no" / "a.png"), DeviceError);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Number of pixels that are not black, and the columns they span.
struct Inked {
    int count = 0;
    int left = 1 << 20;
    int right = -1;
};

Inked inkedIn(const Image& image) {
    Inked inked;
    for (int y = 0; y < image.size().y; ++y)
        for (int x = 0; x < image.size().x; ++x) {
            if (image.at(x, y)[0] == 0) continue;
            ++inked.count;
            inked.left = std::min(inked.left, x);
            inked.right = std::max(inked.right, x);
        }
    return inked;
}

TEST(Font, WritesWhereItMeasures) {
    const Font font(resourceFile("fonts/Inter-Regular.otf"));
    for (const char* text : {"HHH", "Target over fit", "Größe · 5 µm"}) {
        Image image({400, 60});
        font.write(image, text, {20.0F, 40.0F}, 24.0F, glm::vec3(1.0F));
        const Inked inked = inkedIn(image);
        EXPECT_GT(inked.count, 100);
        EXPECT_NEAR(inked.left, 20, 4);
        EXPECT_NEAR(inked.right, 20.0F + font.width(text, 24.0F), 4.0F);
    }
}

TEST(Font, CutsALongLineWithAnEllipsis) {
    const Font font(resourceFile("fonts/Inter-Regular.otf"));
    EXPECT_EQ(font.fitted("short", 20.0F, 500.0F), "short");
    const std::string cut = font.fitted("Größere Überschriften für jedes Bild", 20.0F, 120.0F);
    EXPECT_LE(font.width(cut, 20.0F), 120.0F);
    EXPECT_GT(font.width(cut, 20.0F), 80.0F);
    EXPECT_TRUE(cut.ends_with("…"));
}

TEST(Font, TextOutsideTheImageIsCutOff) {
    const Font font(resourceFile("fonts/Inter-Regular.otf"));
    Image image({30, 20});
    font.write(image, "Wide text", {-20.0F, 10.0F}, 24.0F, glm::vec3(1.0F));
    EXPECT_GT(inkedIn(image).count, 0);
    Image untouched({30, 20});
    font.write(untouched, "Below", {0.0F, 500.0F}, 24.0F, glm::vec3(1.0F));
    EXPECT_EQ(inkedIn(untouched).count, 0);
}

TEST(Font, RefusesWhatIsNoFont) {
    const TemporaryFolder folder;
    EXPECT_THROW(Font(writeText(folder / "a.otf", std::string(100, 'x'))), DataError);
    EXPECT_THROW(Font(folder.path() / "absent.otf"), DataError);
}

} // namespace
} // namespace lumorph
