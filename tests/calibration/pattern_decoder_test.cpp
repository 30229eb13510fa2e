#include "calibration/decode/pattern_decoder.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/procam_capture.h"

namespace lumorph::test {
namespace {

std::vector<cv::Mat> greysOf(const std::vector<Image>& images) {
    std::vector<cv::Mat> greys;
    for (const Image& image : images) {
        cv::Mat grey(image.size().y, image.size().x, CV_8U);
        for (int y = 0; y < grey.rows; ++y)
            for (int x = 0; x < grey.cols; ++x) grey.at<uchar>(y, x) = image.at(x, y)[0];
        greys.push_back(grey);
    }
    return greys;
}

/// Errors of what was decoded against where the light of each pixel truly comes from, projector pixels, sorted; and the
/// share of the white squares' pixels that are known.
struct DecodeTruth {
    std::vector<double> errors;
    double known = 0.0;
};

DecodeTruth compare(const ProcamSetup& setup, const DecodedView& decoded, const glm::dmat4& pose) {
    const std::vector<SeenSample> samples = seenSamples(setup, pose);
    DecodeTruth truth;
    double white = 0.0;
    for (int y = 0; y < setup.camera.size.y; ++y)
        for (int x = 0; x < setup.camera.size.x; ++x) {
            const SeenSample* four = &samples[static_cast<std::size_t>(4 * (y * setup.camera.size.x + x))];
            if (four[0].albedo < 0.8 || four[3].albedo < 0.8) continue;
            double column = 0.0;
            double row = 0.0;
            for (int k = 0; k < 4; ++k) column += four[k].column / 4, row += four[k].row / 4;
            if (column < 2 || row < 2 || column > setup.projector.size.x - 3 || row > setup.projector.size.y - 3)
                continue;
            white += 1.0;
            if (!(decoded.confidence(y, x) > 0.0F)) continue;
            truth.known += 1.0;
            truth.errors.push_back(std::abs(decoded.column(y, x) - column));
            truth.errors.push_back(std::abs(decoded.row(y, x) - row));
        }
    truth.known /= white;
    std::ranges::sort(truth.errors);
    return truth;
}

double quantile(const std::vector<double>& sorted, double share) {
    return sorted.at(static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1)));
}

TEST(PatternDecoder, GrayCodeIsReadToAFractionOfAProjectorPixel) {
    const ProcamSetup setup = ProcamSetup::usual();
    for (const std::size_t pose : {0U, 1U}) {
        const auto images =
            greysOf(photographAll(setup, setup.cameraFromBoard[pose], grayCodeLights(setup.projector.size), 1));
        const DecodedView decoded = decodeView(images, parsePattern("graycode", {256, 192}));
        const DecodeTruth truth = compare(setup, decoded, setup.cameraFromBoard[pose]);
        EXPECT_GT(truth.known, 0.9);
        EXPECT_LT(quantile(truth.errors, 0.5), 0.06);
        EXPECT_LT(quantile(truth.errors, 0.99), 0.3);
        EXPECT_NEAR(decoded.noise, setup.noise, 0.2);
    }
}

// A camera of fewer pixels than the projector, and a board that is tilted away from it.
TEST(PatternDecoder, StripesNarrowerThanPixelsAreReadFromCoarserOnes) {
    ProcamSetup setup = ProcamSetup::usual();
    setup.projector.size = {640, 480};
    setup.projector.focal *= 2.5;
    setup.projector.principal = 2.5 * setup.projector.principal + 0.75;
    for (const std::size_t pose : {0U, 1U, 3U, 5U}) {
        const auto images =
            greysOf(photographAll(setup, setup.cameraFromBoard[pose], grayCodeLights(setup.projector.size), 7));
        const DecodedView decoded = decodeView(images, parsePattern("graycode", {640, 480}));
        const DecodeTruth truth = compare(setup, decoded, setup.cameraFromBoard[pose]);
        EXPECT_GT(truth.known, 0.85) << pose;
        EXPECT_LT(quantile(truth.errors, 0.5), 0.3) << pose;
        EXPECT_LT(quantile(truth.errors, 0.99), 1.2) << pose; // of a camera pixel and a half
    }
}

// Within a projector pixel all light is the same, and its phase that of the pixel's centre: half a pixel off at most.
TEST(PatternDecoder, PhaseShiftIsReadToAFractionOfAProjectorPixel) {
    const ProcamSetup setup = ProcamSetup::usual();
    const auto images =
        greysOf(photographAll(setup, setup.cameraFromBoard[3], phaseLights(setup.projector.size, 16), 2));
    const DecodedView decoded = decodeView(images, parsePattern("phase:16x3+1x3", {256, 192}));
    const DecodeTruth truth = compare(setup, decoded, setup.cameraFromBoard[3]);
    EXPECT_GT(truth.known, 0.97);
    EXPECT_LT(quantile(truth.errors, 0.5), 0.16);
    EXPECT_LT(quantile(truth.errors, 0.99), 0.5);
}

TEST(PatternDecoder, TwoFinePhaseSetsTellPeriodsByTheirBeat) {
    const ProcamSetup setup = ProcamSetup::usual();
    std::vector<Light> lights;
    for (int axis = 0; axis < 2; ++axis)
        for (const int periods : {8, 9})
            for (int step = 0; step < 4; ++step)
                lights.emplace_back([=, size = setup.projector.size](int column, int row) {
                    const double share = ((axis == 0 ? column : row) + 0.5) / size[axis];
                    return 0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * (periods * share - step / 4.0));
                });
    const DecodedView decoded = decodeView(greysOf(photographAll(setup, setup.cameraFromBoard[0], lights, 3)),
                                           parsePattern("phase:8x4+9x4", {256, 192}));
    const DecodeTruth truth = compare(setup, decoded, setup.cameraFromBoard[0]);
    EXPECT_GT(truth.known, 0.95);
    EXPECT_LT(quantile(truth.errors, 0.99), 0.5);
}

// Light that reaches a pixel by way of others is the same for fine stripes and their inverse.
TEST(PatternDecoder, IndirectLightIsToldFromDirectLight) {
    ProcamSetup setup = ProcamSetup::usual();
    setup.noise = 0.3;
    const auto direct =
        greysOf(photographAll(setup, setup.cameraFromBoard[0], grayCodeLights(setup.projector.size), 4));
    std::vector<cv::Mat> images;
    for (std::size_t i = 0; i < direct.size(); ++i) {
        const double glow = i + 1 == direct.size()   ? 0.0
                            : i + 2 == direct.size() ? 40.0
                                                     : 20.0; // black, white, stripes
        images.push_back(direct[i] + cv::Scalar(glow));
    }
    const DecodedView decoded = decodeView(images, parsePattern("graycode", {256, 192}));
    const double plain = 0.85 * 200.0;
    std::vector<double> global;
    for (int y = 0; y < decoded.global.rows; ++y)
        for (int x = 0; x < decoded.global.cols; ++x)
            if (decoded.confidence(y, x) > 0.0F && decoded.direct(y, x) > 0.97 * plain)
                global.push_back(decoded.global(y, x));
    ASSERT_GT(global.size(), 500U);
    std::ranges::sort(global);
    EXPECT_NEAR(quantile(global, 0.5), 40.0, 5.0);
}

TEST(PatternDecoder, PixelsWithoutTheProjectorsLightAreUnknown) {
    ProcamSetup setup = ProcamSetup::usual();
    const auto images =
        greysOf(photographAll(setup, setup.cameraFromBoard[0], grayCodeLights(setup.projector.size), 5));
    const DecodedView decoded = decodeView(images, parsePattern("graycode", {256, 192}));
    const auto samples = seenSamples(setup, setup.cameraFromBoard[0]);
    int dark = 0;
    int claimed = 0;
    for (int y = 0; y < 360; ++y)
        for (int x = 0; x < 480; ++x) {
            const SeenSample& sample = samples[static_cast<std::size_t>(4 * (y * 480 + x))];
            if (sample.column > -3 && sample.row > -3 && sample.column < 259 && sample.row < 195) continue;
            ++dark;
            claimed += decoded.confidence(y, x) > 0.0F;
        }
    ASSERT_GT(dark, 2000);
    EXPECT_LT(claimed, dark / 1000);
}

TEST(PatternDecoder, WrongNumbersAndIncompleteOrdersAreRefused) {
    const std::vector<cv::Mat> images(34, cv::Mat(64, 64, CV_8U, cv::Scalar(9)));
    EXPECT_THROW((void)decodeView(images, parsePattern("graycode", {1024, 768})), InvalidInput);
    CaptureOrder order = parseCaptureOrder("column bit 0\ncolumn bit 1\nwhite\nblack\n", "o", {64, 64});
    EXPECT_THROW((void)decodeView({images.begin(), images.begin() + 4}, order), InvalidInput); // no rows
    order = parseCaptureOrder("column bit 1\nrow bit 0\nwhite\nblack\n", "o", {64, 64});
    EXPECT_THROW((void)decodeView({images.begin(), images.begin() + 4}, order), InvalidInput); // bit 0 is missing
    order = parseCaptureOrder("column bit 0\nrow bit 0\n", "o", {64, 64});
    EXPECT_THROW((void)decodeView({images.begin(), images.begin() + 2}, order), InvalidInput); // no inverse
}

} // namespace
} // namespace lumorph::test
