#include "calibration/placement/light_plan.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "calibration/placement/projector_models.h"
#include "core/base/error.h"
#include "core/rig/shape_report.h"
#include "tests/support/small_rigs.h"

namespace lumorph {
namespace {

/// A box of 20 x 2 x 10 cm whose right half rises by 8 cm as one block.
Rig stepRig() {
    RigParts parts;
    parts.name = "step";
    parts.restMesh = test::boxMesh({-0.1F, 0.0F, -0.05F}, {0.1F, 0.02F, 0.05F}, 16);
    Actuator lift;
    lift.name = "lift";
    lift.deformer = Slide{{0.0F, 1.0F, 0.0F}, 0.0, 0.08};
    for (std::uint32_t v = 0; v < parts.restMesh.positions.size(); ++v)
        if (parts.restMesh.positions[v].y > 0.01F && parts.restMesh.positions[v].x > -0.001F)
            lift.influences.push_back({v, 1.0F});
    parts.actuators.push_back(lift);
    return Rig(std::move(parts));
}

/// Every triangle, one after the other (Moeller and Trumbore).
bool isBlocked(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles,
               const glm::dvec3& from, const glm::dvec3& to, std::size_t but) {
    const glm::dvec3 way = to - from;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (t == but) continue;
        const glm::dvec3 a(positions[triangles[t].x]);
        const glm::dvec3 ab = glm::dvec3(positions[triangles[t].y]) - a;
        const glm::dvec3 ac = glm::dvec3(positions[triangles[t].z]) - a;
        const glm::dvec3 p = glm::cross(way, ac);
        const double det = glm::dot(ab, p);
        if (std::abs(det) < 1e-18) continue;
        const double u = glm::dot(from - a, p) / det;
        const glm::dvec3 q = glm::cross(from - a, ab);
        const double v = glm::dot(way, q) / det;
        const double along = glm::dot(ac, q) / det;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && along > 1e-7 && along < 1.0) return true;
    }
    return false;
}

TEST(LightPlan, FromStraightAbovePixelsAreAsDenseAsThePinholeSays) {
    RigParts parts;
    parts.name = "plate";
    parts.restMesh = test::boxMesh({-0.1F, 0.0F, -0.05F}, {0.1F, 0.02F, 0.05F}, 8);
    const LitDevice device(Rig(std::move(parts)), glm::mat4(1.0F));
    EXPECT_EQ(device.states(), 1U);
    const CalibratedCamera projector = cameraLookingAt({0.0, 1.02, 0.0}, {0.0, 0.0, 0.0}, {1280, 800}, 2000.0);
    const LightMap map = device.lightOf({&projector, 1});
    ASSERT_EQ(map.places.size(), 128U);
    double area = 0.0;
    for (const LightAt& at : map.places) {
        EXPECT_NEAR(at.pixelsPerMillimetre, 2.0, 1e-3); // f / distance, anywhere on a plane that faces the lens
        EXPECT_NEAR(at.incidence.inRadians(), std::atan(std::hypot(at.place.x, at.place.z) / 1.0), 1e-6);
        EXPECT_EQ(at.lit, 1.0);
        area += at.area;
    }
    EXPECT_NEAR(area, 0.2 * 0.1, 1e-7);
    EXPECT_NEAR(map.worth, 1.0, 1e-3);
    EXPECT_NEAR(map.pixelsPerMillimetre, 2.0, 1e-3);

    // Slantwise one direction of the surface is foreshortened by the cosine.
    const CalibratedCamera aside = cameraLookingAt({0.0, 1.02, 1.0}, {0.0, 0.02, 0.0}, {1280, 800}, 2000.0);
    for (const LightAt& at : device.lightOf({&aside, 1}).places) {
        if (std::hypot(at.place.x, at.place.z) > 0.02) continue;
        EXPECT_NEAR(at.pixelsPerMillimetre, 2.0 / std::sqrt(2.0) * std::cos(at.incidence.inRadians()), 0.03);
    }
}

TEST(LightPlan, ShadowsAreThoseOfEachTriangle) {
    const Rig rig = stepRig();
    const LitDevice device(rig, glm::mat4(1.0F), 0, 100'000);
    ASSERT_EQ(device.states(), 2U) << "rest, and the one actuator";
    const glm::dvec3 lens(0.7, 0.6, 0.2);
    const CalibratedCamera projector = cameraLookingAt(lens, {0.0, 0.0, 0.0}, {1280, 800}, 1500.0);
    const LightMap map = device.lightOf({&projector, 1}, {2.0, Angle::degrees(85.0)});
    std::size_t k = 0;
    int shadowed = 0;
    for (std::uint32_t t = 0; t < rig.restMesh().triangles.size(); ++t) {
        if (!facesUp(rig.restMesh(), t)) continue;
        int lit = 0;
        for (const double stroke : {0.0, 1.0}) {
            const auto positions = deformed(rig, std::vector{stroke}).positions;
            const glm::uvec3& corners = rig.restMesh().triangles[t];
            const glm::dvec3 a(positions[corners.x]), b(positions[corners.y]), c(positions[corners.z]);
            const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
            const glm::dvec3 centre = (a + b + c) / 3.0;
            if (glm::dot(normal, glm::normalize(lens - centre)) <= std::cos(Angle::degrees(85.0).inRadians())) continue;
            if (isBlocked(positions, rig.restMesh().triangles, centre, lens, t))
                ++shadowed;
            else
                ++lit;
        }
        ASSERT_LT(k, map.places.size());
        EXPECT_DOUBLE_EQ(map.places[k].lit, lit / 2.0)
            << "at " << map.places[k].place.x << ", " << map.places[k].place.z;
        ++k;
    }
    EXPECT_EQ(k, map.places.size());
    EXPECT_GT(shadowed, 50) << "the raised half shadows much of the other";
}

TEST(LightPlan, OfSeveralProjectorsTheOneWithMorePixelsCountsAndFillsShadows) {
    const LitDevice device(stepRig(), glm::mat4(1.0F), 0);
    const std::vector<CalibratedCamera> both{cameraLookingAt({0.7, 0.6, 0.0}, {0.0, 0.0, 0.0}, {1280, 800}, 1500.0),
                                             cameraLookingAt({-0.7, 0.6, 0.0}, {0.0, 0.0, 0.0}, {1280, 800}, 1500.0)};
    const LightMap right = device.lightOf({both.data(), 1});
    const LightMap left = device.lightOf({both.data() + 1, 1});
    const LightMap together = device.lightOf(both);
    EXPECT_LT(right.lit, 0.9) << "the raised half shadows the other";
    EXPECT_EQ(left.lit, 1.0);
    EXPECT_EQ(together.lit, 1.0);
    for (std::size_t k = 0; k < together.places.size(); ++k) {
        EXPECT_GE(together.places[k].pixelsPerMillimetre, left.places[k].pixelsPerMillimetre);
        if (right.places[k].lit < 1.0) continue;
        EXPECT_GE(together.places[k].pixelsPerMillimetre, right.places[k].pixelsPerMillimetre);
    }
    EXPECT_EQ(device.lightOf({}).lit, 0.0);
}

TEST(LightPlan, ShiftedLensMeetsTheAimWithTheMiddleOfItsPicture) {
    const LitDevice device(stepRig(), glm::mat4(1.0F), 0);
    const auto corners = device.corners();
    const glm::dvec3 aim(boundingBox(corners).centre());
    for (const bool turned : {false, true}) {
        const CalibratedCamera camera =
            aimedProjector({{1920, 1080}, 0.5, 20.0, 0.66}, {0.4, 0.9, 0.3}, corners, turned);
        const auto middle = pixelOf(camera, aim);
        ASSERT_TRUE(middle);
        EXPECT_NEAR(middle->x, 959.5, 1e-6);
        EXPECT_NEAR(middle->y, 539.5, 1e-6);
        EXPECT_NEAR(camera.principal.y, 539.5 + 0.66 * 1080, 1e-9);
        EXPECT_NEAR(glm::length(positionOf(camera) - glm::dvec3(0.4, 0.9, 0.3)), 0.0, 1e-9);
        bool touches = false; // zoomed in until the device nearly fills one side
        for (const glm::vec3& corner : corners) {
            const auto pixel = pixelOf(camera, glm::dvec3(corner));
            ASSERT_TRUE(pixel);
            EXPECT_GT(pixel->x, 0.015 * 1920);
            EXPECT_LT(pixel->x, 0.985 * 1920);
            EXPECT_GT(pixel->y, 0.015 * 1080);
            EXPECT_LT(pixel->y, 0.985 * 1080);
            touches = touches || pixel->x < 0.03 * 1920 || pixel->x > 0.97 * 1920 || pixel->y < 0.03 * 1080 ||
                      pixel->y > 0.97 * 1080;
        }
        EXPECT_TRUE(touches);
    }
}

TEST(LightPlan, BestPlaceIsNoWorseThanTheBestOfAFullGrid) {
    const LitDevice device(stepRig(), glm::mat4(1.0F), 2, 150);
    const ProjectorLens lens{{1280, 800}, 1.2, 1.8, 0.0};
    const glm::dvec3 low(-0.6, 0.5, -0.4), high(0.6, 1.6, 0.4);
    const LightWish wish{3.0, Angle::degrees(70.0)};
    const ProjectorPlace best = bestProjectorPlace(device, lens, low, high, {}, wish);
    const glm::dvec3 place = positionOf(best.camera);
    for (int k = 0; k < 3; ++k) {
        EXPECT_GE(place[k], low[k] - 1e-9);
        EXPECT_LE(place[k], high[k] + 1e-9);
    }
    EXPECT_GE(best.throwRatio, 1.2 - 1e-9);
    EXPECT_LE(best.throwRatio, 1.8 + 1e-9);
    EXPECT_EQ(best.light.worth, device.lightOf({&best.camera, 1}, wish).worth);
    double most = 0.0;
    const auto corners = device.corners();
    for (int x = 0; x < 13; ++x)
        for (int y = 0; y < 12; ++y)
            for (int z = 0; z < 9; ++z)
                for (const bool turned : {false, true}) {
                    const glm::dvec3 at = low + glm::dvec3(0.1 * x, 0.1 * y, 0.1 * z);
                    const CalibratedCamera camera = aimedProjector(lens, at, corners, turned);
                    most = std::max(most, device.lightOf({&camera, 1}, wish).worth);
                }
    EXPECT_GT(best.light.worth, most - 0.002);
}

TEST(LightPlan, WhatIsNoLensOrNoPlaceIsRefused) {
    const LitDevice device(stepRig(), glm::mat4(1.0F), 0);
    EXPECT_THROW(
        (void)bestProjectorPlace(device, {{1280, 800}, 0.0, 1.0, 0.0}, glm::dvec3(0, 1, 0), glm::dvec3(1, 2, 1)),
        InvalidInput);
    EXPECT_THROW((void)bestProjectorPlace(device, {}, glm::dvec3(0, 2, 0), glm::dvec3(1, 1, 1)), InvalidInput);
    EXPECT_THROW((void)bestProjectorPlace(device, {}, glm::dvec3(0, NAN, 0), glm::dvec3(1, 1, 1)), InvalidInput);
    std::stop_source stopped;
    stopped.request_stop();
    EXPECT_THROW((void)LitDevice(stepRig(), glm::mat4(1.0F), 0, 100, Progress({}, stopped.get_token())), Cancelled);
}

TEST(LightPlan, EachTriangleThatLooksUpIsCountedWithOnePlace) {
    const Rig rig = stepRig();
    const LitDevice device(rig, glm::mat4(1.0F), 2, 20);
    const LightMap map = device.lightOf({});
    const TriangleMesh& mesh = rig.restMesh();
    ASSERT_EQ(device.placeOfTriangle().size(), mesh.triangles.size());
    std::vector<double> area(map.places.size(), 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::dvec3 a(mesh.positions[mesh.triangles[t].x]);
        const glm::dvec3 normal = glm::cross(glm::dvec3(mesh.positions[mesh.triangles[t].y]) - a,
                                             glm::dvec3(mesh.positions[mesh.triangles[t].z]) - a);
        const int place = device.placeOfTriangle()[t];
        EXPECT_EQ(place >= 0, normal.y > 0.9 * glm::length(normal)) << "triangle " << t;
        if (place >= 0) area.at(static_cast<std::size_t>(place)) += 0.5 * glm::length(normal);
    }
    for (std::size_t k = 0; k < area.size(); ++k) EXPECT_NEAR(area[k], map.places[k].area, 1e-9) << "place " << k;
}

TEST(LightPlan, BlurIsThatOfAThinLensAndTheBestFocusLiesBetweenNearestAndFarthest) {
    const Rig rig = stepRig(); // tops at 2 cm, of the right half at 10 cm too
    const LitDevice device(rig, glm::mat4(1.0F), 0);
    const std::vector above{cameraLookingAt({0.0, 1.02, 0.0}, {0.0, 0.0, 0.0}, {1280, 800}, 1500.0)};
    EXPECT_FALSE(device.lightOf(above).blurKnown);
    const std::vector<LensFocus> focus{{0.01, 0.8}};
    const LightMap map = device.lightOf(above, {}, focus);
    ASSERT_TRUE(map.blurKnown);
    for (const LightAt& at : map.places) {
        const double cosine = 1.0 / std::hypot(1.0, std::hypot(at.place.x, at.place.z));
        EXPECT_NEAR(at.blur, 0.01 * (1.0 / 0.8 - 1.0) / cosine, 2e-6) << "at rest it is farther from the focus";
    }
    EXPECT_NEAR(map.blur, 0.0025, 2e-5);
    ASSERT_EQ(map.bestFocus.size(), 1U);
    EXPECT_NEAR(map.bestFocus[0], 0.96, 1e-6) << "0.92 m to what rises, 1 m to the rest";
    const auto worst = [&](double distance) {
        return std::max(std::abs(0.92 / distance - 1.0), std::abs(1.0 / distance - 1.0));
    };
    for (double distance = 0.8; distance < 1.2; distance += 0.001)
        EXPECT_GE(worst(distance), worst(map.bestFocus[0]) - 1e-6) << distance;

    // Of two projectors each has a focus of its own, and one that lights nothing has none.
    const std::vector two{above[0], cameraLookingAt({0.0, 1.0, 5.0}, {0.0, 1.0, 9.0}, {64, 64}, 64.0)};
    const LightMap both = device.lightOf(two, {}, std::vector<LensFocus>{{0.0, 1.0}, {0.02, 1.0}});
    EXPECT_NEAR(both.bestFocus.at(0), 0.96, 1e-6);
    EXPECT_EQ(both.bestFocus.at(1), 0.0);
    EXPECT_EQ(both.blur, 0.0) << "the one whose aperture is known lights nothing";
}

TEST(LightPlan, MeasuredBlurTellsApertureAndFocus) {
    const auto seen = [](const LensFocus& lens, const std::vector<double>& distances, double noise, unsigned seed) {
        std::mt19937 numbers(seed);
        std::normal_distribution<double> error(0.0, noise);
        std::vector<MeasuredBlur> measured;
        for (const double at : distances)
            measured.push_back(
                {at, std::max(0.0, lens.aperture * std::abs(at - lens.focusDistance) / lens.focusDistance +
                                       error(numbers))});
        return measured;
    };
    for (const LensFocus& truth : {LensFocus{0.009, 1.83}, LensFocus{0.02, 0.6}, LensFocus{0.004, 3.0}}) {
        const double f = truth.focusDistance;
        for (const auto& shares :
             {std::vector{0.7, 0.9, 1.2, 1.4}, std::vector{1.1, 1.2, 1.5}, std::vector{0.6, 0.7, 0.8}}) {
            std::vector<double> distances;
            for (const double share : shares) distances.push_back(share * f);
            const LensFocus found = lensFocusOf(seen(truth, distances, 0.0, 1));
            EXPECT_NEAR(found.aperture, truth.aperture, 1e-9);
            EXPECT_NEAR(found.focusDistance, f, 1e-9) << "also where it was looked at from one side alone";
        }
        const LensFocus noisy = lensFocusOf(seen(truth, {0.6 * f, 0.75 * f, 0.9 * f, 1.1 * f, 1.3 * f}, 1e-4, 77));
        EXPECT_NEAR(noisy.focusDistance, f, 0.03 * f);
        EXPECT_NEAR(noisy.aperture, truth.aperture, 0.1 * truth.aperture);
    }
    EXPECT_THROW((void)lensFocusOf(std::vector<MeasuredBlur>{{1.0, 0.001}, {2.0, 0.001}}), InvalidInput);
    EXPECT_THROW((void)lensFocusOf(std::vector<MeasuredBlur>{{1.0, 0.001}, {1.0, 0.001}, {1.0, 0.001}}), InvalidInput);
    EXPECT_THROW((void)lensFocusOf(std::vector<MeasuredBlur>{{1.0, 0.001}, {NAN, 0.001}, {2.0, 0.001}}), InvalidInput);
    EXPECT_THROW((void)lensFocusOf(std::vector<MeasuredBlur>{{1.0, 0.001}, {1.5, -0.1}, {2.0, 0.001}}), InvalidInput);
}

TEST(ProjectorModel, NamedLensesAreAsTheirDataSheetsSay) {
    const ProjectorModel* optoma = findProjectorModel("optoma gt1080hdr");
    ASSERT_TRUE(optoma);
    // Its sheet: throw ratio 0.496, offset 116 %: the lower edge stands 16 % of the height above the lens.
    const CalibratedCamera camera = aimedProjector(lensOf(*optoma), {0.0, 1.0, 0.0}, std::vector{glm::vec3(0.0F)});
    EXPECT_NEAR(camera.focal.x / camera.size.x, 0.496, 1e-9);
    EXPECT_NEAR((camera.principal.y - (camera.size.y - 0.5)) / camera.size.y, 0.16, 1e-9);
    EXPECT_EQ(findProjectorModel("no such"), nullptr);
    double before = 0.0;
    for (const ProjectorModel& model : projectorModels()) {
        EXPECT_GE(model.throwMost, model.throwLeast) << model.name;
        EXPECT_GE(model.throwLeast, before) << model.name << ": the shortest throw comes first";
        before = model.throwLeast;
        EXPECT_EQ(findProjectorModel(model.name), &model);
        EXPECT_EQ(lensOf(model, 9.0).shift, model.shift ? model.shift->most : 9.0);
    }
}

} // namespace
} // namespace lumorph
