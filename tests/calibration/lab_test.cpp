#include "calibration/lab/lab.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "calibration/lab/lab_lens.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

// The judge of the lab's own optics: OpenCV.
glm::dvec2 opencvPixel(const CalibratedCamera& camera, const glm::dvec3& point) {
    cv::Matx33d rotation;
    cv::Vec3d translation;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) rotation(row, column) = camera.cameraFromWorld[column][row];
        translation[row] = camera.cameraFromWorld[3][row];
    }
    cv::Vec3d rodrigues;
    cv::Rodrigues(rotation, rodrigues);
    const cv::Matx33d matrix(camera.focal.x, 0, camera.principal.x, 0, camera.focal.y, camera.principal.y, 0, 0, 1);
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(std::vector<cv::Point3d>{{point.x, point.y, point.z}}, rodrigues, translation, matrix,
                      std::vector<double>(camera.distortion.begin(), camera.distortion.end()), pixels);
    return {pixels[0].x, pixels[0].y};
}

// Looks from a place to a place; written out, so that the tests share no camera code with the program.
CalibratedCamera lookingFrom(const glm::dvec3& from, const glm::dvec3& to, glm::ivec2 size, double focal) {
    const glm::dvec3 forward = glm::normalize(to - from);
    const glm::dvec3 helper = std::abs(forward.y) > 0.99 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, helper));
    const glm::dmat3 worldFromCamera(right, glm::cross(forward, right), forward);
    CalibratedCamera camera;
    camera.size = size;
    camera.focal = glm::dvec2(focal, 1.01 * focal);
    camera.principal = 0.5 * glm::dvec2(size - 1);
    camera.cameraFromWorld = glm::dmat4(glm::transpose(worldFromCamera));
    camera.cameraFromWorld[3] = glm::dvec4(-(glm::transpose(worldFromCamera) * from), 1.0);
    return camera;
}

// An observer, one with much distortion, and one whose principal point lies beside its image.
std::vector<CalibratedCamera> cameras() {
    CalibratedCamera plain = lookingFrom({0.1, 0.6, 0.7}, {0, 0, 0}, {1280, 800}, 1600);
    CalibratedCamera bent = lookingFrom({-0.4, 0.9, 0.2}, {0, 0.02, 0}, {1024, 768}, 1300);
    bent.distortion = {-0.21, 0.09, 0.004, -0.003, -0.01};
    CalibratedCamera wide = lookingFrom({0.2, 0.35, -0.3}, {0, 0, 0}, {960, 600}, 620);
    wide.distortion = {0.08, -0.05, -0.002, 0.001, 0.02};
    CalibratedCamera shifted = lookingFrom({0.0, 1.5, 0.9}, {0, 0, -0.3}, {1280, 800}, 2500);
    shifted.principal = {600.0, -50.0};
    shifted.distortion = {-0.05, 0.02, 0.001, 0.002, 0.0};
    return {plain, bent, wide, shifted};
}

InstalledProjector projectorAbove() {
    InstalledProjector projector;
    projector.camera = lookingFrom({0.05, 2.0, 0.1}, {0, 0, 0}, {1280, 800}, 2400);
    projector.camera.distortion = {-0.06, 0.03, 0.001, -0.001, 0.0};
    projector.camera.principal = {630.0, 500.0};
    return projector;
}

// A flat disc of triangles around a point; its normal is `up`.
TriangleMesh disc(const glm::vec3& centre, const glm::vec3& up, float radius) {
    const glm::vec3 side = glm::normalize(glm::cross(up, glm::vec3(0.3F, -0.2F, 0.9F)));
    const glm::vec3 other = glm::normalize(glm::cross(up, side));
    constexpr unsigned kCorners = 48;
    TriangleMesh mesh;
    mesh.positions.push_back(centre);
    for (unsigned i = 0; i < kCorners; ++i) {
        const float angle = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kCorners;
        mesh.positions.push_back(centre + radius * (std::cos(angle) * side + std::sin(angle) * other));
        mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % kCorners});
    }
    return mesh;
}

TriangleMesh table(float height = 0.0F, float half = 0.6F) {
    return {{{-half, height, -half}, {-half, height, half}, {half, height, half}, {half, height, -half}},
            {{0, 1, 2}, {0, 2, 3}}};
}

struct Spot {
    glm::dvec2 centre{0.0};
    double light = 0.0;
};

// Centre of light in a window around a pixel.
Spot spotNear(const std::vector<glm::vec3>& radiance, glm::ivec2 size, const glm::dvec2& near, int reach,
              float background = 0.0F) {
    Spot spot;
    for (int y = static_cast<int>(near.y) - reach; y <= static_cast<int>(near.y) + reach; ++y)
        for (int x = static_cast<int>(near.x) - reach; x <= static_cast<int>(near.x) + reach; ++x) {
            if (x < 0 || y < 0 || x >= size.x || y >= size.y) continue;
            const double light = std::abs(radiance[static_cast<std::size_t>(y * size.x + x)].g - background);
            spot.centre += light * glm::dvec2(x, y);
            spot.light += light;
        }
    spot.centre /= spot.light;
    return spot;
}

// The place on the plane y = height that falls on a pixel, by Newton's method on OpenCV's projection.
glm::dvec3 placeOnPlane(const CalibratedCamera& camera, const glm::dvec2& pixel, double height) {
    glm::dvec3 place(0.0, height, 0.0);
    for (int i = 0; i < 20; ++i) {
        constexpr double kStep = 1e-5;
        const glm::dvec2 here = opencvPixel(camera, place);
        const glm::dvec2 alongX = (opencvPixel(camera, place + glm::dvec3(kStep, 0, 0)) - here) / kStep;
        const glm::dvec2 alongZ = (opencvPixel(camera, place + glm::dvec3(0, 0, kStep)) - here) / kStep;
        const glm::dvec2 move = glm::inverse(glm::dmat2(alongX, alongZ)) * (pixel - here);
        place += glm::dvec3(move.x, 0, move.y);
    }
    return place;
}

Image filled(glm::ivec2 size, std::uint8_t value) { return Image(size, {value, value, value, 255}); }

TEST(LabLens, ProjectsAsOpenCvDoesAndLooksBackThroughTheSamePixel) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> spread(-0.12, 0.12);
    for (const CalibratedCamera& camera : cameras()) {
        const LabLens lens = lensOf(camera, "camera");
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 point(spread(random), 0.5 * spread(random), spread(random));
            const auto pixel = imageOf(lens, point);
            ASSERT_TRUE(pixel);
            ASSERT_LT(glm::length(*pixel - opencvPixel(camera, point)), 1e-8);
            const auto ray = rayThrough(lens, *pixel);
            ASSERT_TRUE(ray);
            ASSERT_LT(glm::length(*ray - glm::normalize(point - lens.position)), 1e-9);
        }
        EXPECT_FALSE(imageOf(lens, 2.0 * lens.position));
    }
}

TEST(LabLens, ADirectionBeyondTheFoldOfTheDistortionHasNoPixel) {
    CalibratedCamera camera = lookingFrom({0, 1, 0}, {0, 0, 0}, {640, 480}, 500);
    camera.distortion = {-0.3, 0, 0, 0, 0}; // folds back where 1 = 0.9 r^2
    const LabLens lens = lensOf(camera, "camera");
    EXPECT_NEAR(lens.steepestSlope, std::sqrt(1.0 / 0.9), 1e-6);
    EXPECT_TRUE(imageOf(lens, {1.0, 0.0, 0.0}));
    EXPECT_FALSE(imageOf(lens, {1.1, 0.0, 0.0}));
    EXPECT_FALSE(rayThrough(lens, {319.5 + 500.0, 239.5}));
}

// Each term of the distortion bends on its own, and folds back where d(r (1 + k r^n)) / dr is zero.
TEST(LabLens, EveryTermOfTheDistortionBendsAndFolds) {
    struct Row {
        std::array<double, 5> distortion;
        double fold; ///< tangent
    };
    for (const Row& row : {Row{{-0.3, 0, 0, 0, 0}, std::sqrt(1.0 / 0.9)}, Row{{0, -0.1, 0, 0, 0}, std::pow(2.0, 0.25)},
                           Row{{0, 0, 0, 0, -0.2}, std::pow(1.0 / 1.4, 1.0 / 6.0)},
                           Row{{0, 0, 0, 0, -0.02}, std::pow(1.0 / 0.14, 1.0 / 6.0)}}) {
        CalibratedCamera camera = lookingFrom({0, 1, 0}, {0, 0, 0}, {640, 480}, 500);
        camera.distortion = row.distortion;
        const LabLens lens = lensOf(camera, "camera");
        EXPECT_NEAR(lens.steepestSlope, row.fold, 1e-6);
        for (int i = 0; i < 24; ++i) {
            const double angle = 0.26 * i;
            for (const double share : {0.1, 0.5, 0.9, 0.99}) {
                const glm::dvec3 point(share * row.fold * std::cos(angle), 0.0, share * row.fold * std::sin(angle));
                const auto pixel = imageOf(lens, point);
                ASSERT_TRUE(pixel) << share;
                EXPECT_LT(glm::length(*pixel - opencvPixel(camera, point)), 1e-8);
                const auto ray = rayThrough(lens, *pixel);
                ASSERT_TRUE(ray) << share;
                EXPECT_LT(glm::length(*ray - glm::normalize(point - lens.position)), 1e-8);
            }
            const double beyond = 1.001 * row.fold;
            EXPECT_FALSE(imageOf(lens, {beyond * std::cos(angle), 0.0, beyond * std::sin(angle)}));
        }
    }
}

TEST(Lab, MarkersAppearWhereOpenCvProjectsThem) {
    for (const CalibratedCamera& camera : cameras()) {
        const LabLens lens = lensOf(camera, "camera");
        LabWorld world;
        world.ambient = glm::vec3(1.0F);
        std::vector<glm::dvec3> points; // scattered so that none hides another
        for (int i = 0; i < 12; ++i)
            points.emplace_back(-0.09 + 0.03 * (i % 6) + 0.015 * (i / 6), 0.01 * (i % 4), i < 6 ? -0.05 : 0.05);
        for (const glm::dvec3& point : points)
            world.surfaces.push_back({disc(point, glm::normalize(lens.position - point), 0.0025F)});
        const auto radiance = Lab(std::move(world)).radiance(camera, 5);
        for (const glm::dvec3& point : points) {
            const glm::dvec2 expected = opencvPixel(camera, point);
            const Spot spot = spotNear(radiance, camera.size, expected, 12);
            ASSERT_GT(spot.light, 1.0);
            EXPECT_LT(glm::length(spot.centre - expected), 0.05) << expected.x << ", " << expected.y;
        }
    }
}

TEST(Lab, LightFollowsItsFormula) {
    struct Row {
        double tilt, height;
        int value;
        double gamma;
        glm::vec3 gain, ambient, albedo;
    };
    const std::array rows{
        Row{0.0, 0.0, 255, 0.0, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}},
        Row{60.0, 0.0, 255, 0.0, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}},
        Row{30.0, 1.0, 255, 0.0, {1, 1, 1}, {0, 0, 0}, {0.5F, 0.4F, 0.3F}},
        Row{-45.0, 0.2, 128, 0.0, {1, 1, 1}, {0.1F, 0.2F, 0.3F}, {1, 0.5F, 1}},
        Row{10.0, 0.1, 128, 2.2, {1, 0.8F, 0.6F}, {0, 0, 0}, {1, 1, 1}},
        Row{80.0, 0.0, 10, 0.0, {1, 0.8F, 0.6F}, {0.05F, 0, 0}, {0.9F, 0.9F, 0.9F}},
    };
    for (const Row& row : rows) {
        LabProjector lamp{projectorAbove(), filled({1280, 800}, static_cast<std::uint8_t>(row.value))};
        lamp.projector.referenceDistance = 1.7;
        lamp.projector.peak = 2.5;
        lamp.projector.gain = row.gain;
        lamp.projector.gamma = row.gamma;
        const double tilt = row.tilt * std::numbers::pi / 180.0;
        const glm::dvec3 up(std::sin(tilt), std::cos(tilt), 0.0);
        const glm::dvec3 centre(0.0, row.height, 0.0);
        LabWorld world{{{disc(centre, up, 0.05F), row.albedo}}, {}, {lamp}, row.ambient};
        const auto seen = Lab(std::move(world)).radiance(lookingFrom(centre + 0.5 * up, centre, {3, 3}, 1e4), 1)[4];

        const glm::dvec3 way = glm::dvec3(0.05, 2.0, 0.1) - centre; // the projector's place
        const double cosine = glm::dot(glm::normalize(way), up);
        const double v = row.value / 255.0;
        const double value = row.gamma > 0.0 ? std::pow(v, row.gamma)
                             : v <= 0.04045  ? v / 12.92
                                             : std::pow((v + 0.055) / 1.055, 2.4);
        for (int c = 0; c < 3; ++c) {
            const double light = 2.5 * value * row.gain[c] * cosine * 1.7 * 1.7 / glm::dot(way, way);
            const double expected = row.albedo[c] * (light + row.ambient[c]);
            EXPECT_NEAR(seen[c], expected, 2e-4 * std::max(0.05, expected)) << row.tilt << ", channel " << c;
        }
    }
}

TEST(Lab, LightIsInterpolatedLinearlyBetweenPixelCentres) {
    LabProjector lamp{projectorAbove(), filled({1280, 800}, 0)};
    for (int y = 0; y < 800; ++y)
        for (int x = 700; x < 1280; ++x) lamp.image.at(x, y) = {255, 255, 255, 255};
    const Lab lab({{{table()}}, {}, {lamp}});
    const auto lightAt = [&](const glm::dvec2& pixel) {
        const glm::dvec3 place = placeOnPlane(lamp.projector.camera, pixel, 0.0);
        return static_cast<double>(
            lab.radiance(lookingFrom(place + glm::dvec3(0.1, 0.5, 0.2), place, {1, 1}, 1e6), 1)[0].g);
    };
    const double full = lightAt({702.0, 450.0});
    EXPECT_GT(full, 1.0);
    for (const double share : {0.0, 0.25, 0.5, 0.9, 1.0})
        EXPECT_NEAR(lightAt({699.0 + share, 450.0}) / full, share, 2e-3) << share;
    EXPECT_GT(lightAt({1279.4, 450.0}), 0.9 * full) << "the outermost half pixel is lit";
    EXPECT_EQ(lightAt({1279.6, 450.0}), 0.0) << "and nothing beyond";
}

TEST(Lab, PixelsOfAPictureLandWhereTheProjectorSendsThem) {
    const CalibratedCamera observer = cameras()[1];
    for (const double height : {0.0, 0.05}) {
        LabProjector lamp{projectorAbove(), filled({1280, 800}, 0)};
        const std::vector<glm::ivec2> lit{{640, 470}, {560, 430}, {760, 520}, {730, 420}};
        for (const glm::ivec2& pixel : lit) lamp.image.at(pixel.x, pixel.y) = {255, 255, 255, 255};
        const Lab lab({{{table(static_cast<float>(height))}}, {}, {lamp}});
        const auto radiance = lab.radiance(observer, 4);
        for (const glm::ivec2& pixel : lit) {
            const glm::dvec3 place = placeOnPlane(lamp.projector.camera, pixel, height);
            const glm::dvec2 expected = opencvPixel(observer, place);
            const Spot spot = spotNear(radiance, observer.size, expected, 8);
            ASSERT_GT(spot.light, 0.5);
            EXPECT_LT(glm::length(spot.centre - expected), 0.05) << pixel.x << ", " << pixel.y;
        }
    }
}

TEST(Lab, ABlockerIsBlackAndItsShadowFallsWhereTheLightIsMissing) {
    const LabProjector lamp{projectorAbove(), filled({1280, 800}, 255)};
    const glm::dvec3 hand(0.03, 0.15, -0.02);
    const glm::dvec3 source(0.05, 2.0, 0.1);
    const Lab lab({{{table()}}, {disc(hand, glm::normalize(source - hand), 0.012F)}, {lamp}, glm::vec3(0.2F)});
    const CalibratedCamera observer = lookingFrom({0.0, 0.4, 0.8}, {0, 0.05, 0}, {1280, 800}, 1400);
    const auto radiance = lab.radiance(observer, 1);

    const glm::dvec3 shadow = source + (hand - source) * (source.y / (source.y - hand.y));
    const glm::dvec2 expected = opencvPixel(observer, shadow);
    const auto at = [&](const glm::dvec2& pixel) {
        return radiance[static_cast<std::size_t>(std::lround(pixel.y) * 1280 + std::lround(pixel.x))].g;
    };
    EXPECT_FLOAT_EQ(at(expected), 0.2F) << "the room's light is left in the shadow";
    EXPECT_EQ(at(opencvPixel(observer, hand)), 0.0F);
    // A circle with the shadow's rim: half a millimetre inside it is dark, half a millimetre outside lit.
    const double radius = 0.012 * glm::length(shadow - source) / glm::length(hand - source);
    const glm::dvec3 along = glm::normalize(glm::cross(source - hand, glm::dvec3(0, 0, 1))); // lies in hand and table
    ASSERT_NEAR(along.z, 0.0, 1e-12);
    const glm::dvec3 level = glm::normalize(glm::dvec3(along.x, 0, along.z));
    EXPECT_LT(at(opencvPixel(observer, shadow + (radius - 5e-4) * level)), 0.21F);
    EXPECT_GT(at(opencvPixel(observer, shadow + (radius + 5e-4) * level)), 1.0F);
    EXPECT_FALSE(lab.lit(0, shadow, {0, 1, 0}));
    EXPECT_TRUE(lab.lit(0, shadow + glm::dvec3(0.05, 0, 0), {0, 1, 0}));
    EXPECT_FALSE(lab.lit(0, shadow + glm::dvec3(0.05, 0, 0), {0, -1, 0})) << "the underside";
}

TEST(Lab, ACurvedSurfaceDoesNotShadowItself) {
    constexpr unsigned kAround = 160;
    constexpr unsigned kRings = 80;
    TriangleMesh ball;
    for (unsigned ring = 0; ring <= kRings; ++ring)
        for (unsigned i = 0; i < kAround; ++i) {
            const double polar = std::numbers::pi * ring / kRings;
            const double angle = 2.0 * std::numbers::pi * i / kAround;
            ball.positions.emplace_back(0.1 * std::sin(polar) * std::cos(angle), 0.1 * std::cos(polar),
                                        0.1 * std::sin(polar) * std::sin(angle));
            const unsigned next = ring * kAround + (i + 1) % kAround;
            if (ring == kRings) continue;
            ball.triangles.push_back({ring * kAround + i, next, next + kAround});
            ball.triangles.push_back({ring * kAround + i, next + kAround, (ring + 1) * kAround + i});
        }
    const LabProjector lamp{projectorAbove(), filled({1280, 800}, 255)};
    const Lab lab({{{ball}}, {}, {lamp}});
    const LabLens observer = lensOf(lookingFrom({0.3, 1.0, 0.2}, {0, 0, 0}, {300, 300}, 1300), "observer");
    int looked = 0;
    for (int y = 0; y < 300; ++y)
        for (int x = 0; x < 300; ++x) {
            const auto hit = lab.trace(observer.position, *rayThrough(observer, {x, y}));
            if (!hit) continue;
            const double cosine = glm::dot(glm::normalize(glm::dvec3(0.05, 2.0, 0.1) - hit->point), hit->normal);
            if (std::abs(cosine) < 0.03) continue; // a facet beside one turned away may truly lie in its shadow
            ASSERT_EQ(lab.lit(0, hit->point, hit->normal), cosine > 0.0) << x << ", " << y;
            ++looked;
        }
    EXPECT_GT(looked, 30'000);
}

TEST(Lab, ASightLitAgainIsTheSameView) {
    LabProjector lamp{projectorAbove(), filled({1280, 800}, 90)};
    Lab lab({{{table()}, {disc({0, 0.05, 0}, {0, 1, 0}, 0.05F), {1, 0.5F, 0.2F}}}, {}, {lamp}, glm::vec3(0.01F)});
    const CalibratedCamera observer = lookingFrom({0.0, 0.5, 0.6}, {0, 0, 0}, {160, 100}, 150);
    const LabSight sight = lab.look(observer, 3);
    EXPECT_EQ(lab.radiance(sight), lab.radiance(observer, 3));
    const auto before = lab.view(observer);
    lab.show(0, filled({1280, 800}, 200));
    EXPECT_EQ(lab.radiance(sight), lab.radiance(observer, 3));
    EXPECT_FALSE(before == lab.view(observer));
}

TEST(Lab, AFinerSightIsTheViewOfFourRaysAPixel) {
    Image stripes({1280, 800});
    for (int y = 0; y < 800; ++y)
        for (int x = 0; x < 1280; ++x) {
            const std::uint8_t grey = x / 3 % 2 == 0 ? 220 : 30;
            stripes.at(x, y) = {grey, grey, grey, 255};
        }
    LabProjector lamp{projectorAbove(), stripes};
    const Lab lab(
        {{{table()}, {disc({0, 0.05, 0}, {0.3, 1, 0}, 0.05F), {1, 0.5F, 0.2F}}}, {}, {lamp}, glm::vec3(0.01F)});
    const CalibratedCamera observer = lookingFrom({0.0, 0.5, 0.6}, {0, 0, 0}, {320, 200}, 300);
    const LabSight once = lab.look(observer, 1);
    const auto wanted = lab.radiance(observer, 2), finer = lab.radiance(lab.finer(observer, once)),
               coarse = lab.radiance(once);
    float worst = 0.0F, brightest = 0.0F, before = 0.0F;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        worst = std::max(worst, glm::distance(wanted[i], finer[i]));
        before = std::max(before, glm::distance(wanted[i], coarse[i]));
        brightest = std::max(brightest, glm::length(wanted[i]));
    }
    EXPECT_LT(worst, 0.02F * brightest);
    EXPECT_GT(before, 0.3F * brightest) << "there are edges";
    EXPECT_THROW((void)lab.finer(observer, lab.look(observer, 2)), InvalidInput);
}

TEST(Lab, AProjectorThatIsOffIsDark) {
    LabProjector lamp{projectorAbove(), filled({1280, 800}, 255)};
    lamp.projector.enabled = false;
    const Lab lab({{{table()}}, {}, {lamp}, glm::vec3(0.0F)});
    const Image seen = lab.view(lookingFrom({0.0, 0.5, 0.6}, {0, 0, 0}, {32, 20}, 40));
    EXPECT_TRUE(seen == filled({32, 20}, 0));
}

TEST(Lab, WhatCannotBeLookedAtIsRefused) {
    const LabProjector wrong{projectorAbove(), filled({640, 480}, 0)};
    EXPECT_THROW(Lab({{{table()}}, {}, {wrong}}), InvalidInput);
    EXPECT_THROW(Lab(LabWorld{}), InvalidInput);
    TriangleMesh broken = table();
    broken.triangles[1].y = 9;
    EXPECT_THROW(Lab({{{broken}}, {}, {}}), InvalidInput);
    broken = table();
    broken.positions[2].z = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(Lab({{{table()}}, {broken}, {}}), InvalidInput);
    Lab lab({{{table()}}, {}, {}});
    EXPECT_THROW(lab.show(0, filled({1280, 800}, 0)), InvalidInput);
    CalibratedCamera observer = cameras()[0];
    EXPECT_THROW((void)lab.radiance(observer, 0), InvalidInput);
    observer.focal.x = std::numeric_limits<double>::infinity();
    EXPECT_THROW((void)lab.radiance(observer), InvalidInput);
}

} // namespace
} // namespace lumorph
