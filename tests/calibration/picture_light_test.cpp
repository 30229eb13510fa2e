#include "calibration/capture/picture_light.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace lumorph {
namespace {

/// A camera whose grey rises evenly with its exposure: half of the picture has `light` greys a second, the rest a
/// tenth.
class EvenCamera final : public CaptureCamera {
public:
    EvenCamera(double light, Exposures can, bool heeds = true) : light_(light), can_(can), heeds_(heeds) {}
    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        progress.throwIfCancelled();
        cv::Mat1b picture(40, 40);
        const auto greyAt = [&](double share) { return cv::saturate_cast<uchar>(share * light_ * seconds_); };
        picture.rowRange(0, 20).setTo(greyAt(1.0));
        picture.rowRange(20, 40).setTo(greyAt(0.1));
        seconds_ = heeds_ ? told_ : seconds_; // a frame later
        return picture;
    }
    [[nodiscard]] std::string name() const override { return "even"; }
    [[nodiscard]] cv::Size size() const override { return {40, 40}; }
    [[nodiscard]] std::optional<Exposures> exposures() const override { return can_; }
    void setExposure(double seconds) override { told_ = seconds; }

private:
    double light_;
    Exposures can_;
    bool heeds_;
    double seconds_ = 0.01, told_ = 0.01;
};

TEST(FindExposure, BringsTheBrightestBelowWhiteInAnyRoom) {
    for (const double light : {600.0, 5e3, 3e4, 2e5, 8e6}) {
        EvenCamera camera(light, {1e-5, 0.5});
        const auto seconds = findExposure(camera);
        ASSERT_TRUE(seconds) << light;
        EXPECT_GE(light * *seconds, 150.0) << light;
        EXPECT_LT(light * *seconds, 235.0) << light;
        if (*seconds > 1.0 / 60.0) {
            const double refreshes = 60.0 * *seconds;
            EXPECT_NEAR(refreshes, std::round(refreshes), 1e-6) << "whole pictures of a projector";
        }
    }
}

TEST(FindExposure, EndsWhereTheCameraCanDoNoMore) {
    EvenCamera dark(10.0, {1e-4, 0.1});
    EXPECT_NEAR(findExposure(dark).value_or(0.0), 0.1, 1e-9);
    EvenCamera glaring(1e8, {1e-4, 0.1});
    EXPECT_NEAR(findExposure(glaring).value_or(0.0), 1e-4, 1e-9);
    EvenCamera deaf(5e3, {1e-5, 0.5}, false);
    EXPECT_FALSE(findExposure(deaf));
}

TEST(PictureLight, TellsClippedGreysAndSharpness) {
    cv::Mat1b picture(200, 200, 20);
    picture.colRange(0, 20).setTo(255);
    const PictureLight light = lightOf(picture);
    EXPECT_NEAR(light.clipped, 0.1, 1e-9);
    EXPECT_EQ(light.bright, 255.0);
    EXPECT_NEAR(light.histogram[5], 0.9, 1e-6);
    EXPECT_NEAR(light.histogram[63], 0.1, 1e-6);

    cv::Mat1b board(200, 200, 200);
    for (int y = 0; y < 10; ++y)
        for (int x = y % 2; x < 10; x += 2) board(cv::Rect(20 * x, 20 * y, 20, 20)).setTo(30);
    double last = 1e9;
    for (const double blur : {0.3, 1.0, 2.0, 4.0}) {
        cv::Mat seen, dim;
        cv::GaussianBlur(board, seen, {}, blur);
        seen.convertTo(dim, CV_8U, 0.4, 10.0);
        const double sharpness = lightOf(seen).sharpness;
        EXPECT_LT(sharpness, 0.9 * last) << blur;
        EXPECT_NEAR(lightOf(dim).sharpness / sharpness, 1.0, 0.1) << "whatever the exposure is: " << blur;
        last = sharpness;
    }
    EXPECT_LT(last, 1.6) << "nothing is sharp";
}

} // namespace
} // namespace lumorph
