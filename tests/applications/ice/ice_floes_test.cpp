#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/ice/floe_model.h"
#include "app/applications/ice/ice.h"
#include "app/applications/ice/ice_picture.h"
#include "app/applications/ice/meltwater.h"
#include "app/applications/ice/pond_bed.h"
#include "tests/support/program_visit.h"

// R32: floes as they look: round rims, hollows, colours; and meltwater, which only runs down.

namespace lumorph::ice {
namespace {

constexpr double kStep = 1.0 / 60.0;

/// Frozen over.
IceCover wholeIce(std::uint64_t seed = 1) {
    IceCover ice(pondShore(), seed);
    for (double t = 0.0; t < IceCover::kFreezing + 0.1; t += 0.1) ice.advance(0.1, {});
    return ice;
}

Surroundings warmAt(const glm::dvec2& place, double power) {
    Surroundings around;
    around.warmths = {{place, 0.018, power}};
    return around;
}

/// As much as a shape's area says by its samples.
double areaIn(const FloeField& field) {
    double area = 0.0;
    for (const float share : field.shape) area += static_cast<double>(share);
    return area * FloeField::kStep * FloeField::kStep;
}

double areaOfTop(const SceneModel& model) {
    const Model::Primitive& top = model.model.meshes.front().primitives.front();
    double area = 0.0;
    for (const glm::uvec3& t : top.triangles) {
        const glm::dvec3 a(top.positions[t.x]), b(top.positions[t.y]), c(top.positions[t.z]);
        const double twice = glm::cross(b - a, c - a).y;
        EXPECT_GE(twice, -1e-12) << "it looks up";
        area += 0.5 * twice;
    }
    return area;
}

TEST(IceFloes, TheirFieldsAndTopsAreAsLargeAsTheIce) {
    IceCover ice = wholeIce();
    ASSERT_TRUE(ice.strike({0.0, 0.0}));
    for (int k = 0; k < 240; ++k) ice.advance(kStep, warmAt({0.03, 0.01}, 1.2));
    for (const Floe& floe : ice.floes()) {
        const FloeField field = fieldOf(ice, floe);
        EXPECT_NEAR(areaIn(field), floe.area, 1e-7 + 5e-4 * floe.area);
        // Corners are round: the top is a little smaller, the less the larger it is.
        const double top = areaOfTop(floeModel(ice, floe, field)), rim = 2.0 * std::sqrt(floe.area * 3.1416);
        EXPECT_LT(top, floe.area + 0.0004 * rim);
        EXPECT_GT(top, floe.area - 0.0012 * rim) << floe.area;
    }
}

TEST(IceFloes, TheirRimsBendDownAndTheirMiddlesAreLevel) {
    const IceCover ice = wholeIce();
    const Floe& floe = ice.floes().front();
    const FloeField field = fieldOf(ice, floe);
    EXPECT_NEAR(topAt(field, {0.0, 0.0}), 0.0, 1e-6);
    const Polygon& shore = ice.shore();
    const glm::dvec2 rim = 0.5 * (shore[0] + shore[1]), in = -rim / glm::length(rim);
    double before = -1.0;
    for (const double inside : {0.0002, 0.0008, 0.0014}) {
        const double height = topAt(field, rim + inside * in);
        EXPECT_GT(height, before) << "rises all the way in";
        EXPECT_LT(height, 0.0);
        before = height;
    }
    EXPECT_NEAR(topAt(field, rim + 0.004 * in), 0.0, 1e-5);
}

TEST(IceFloes, WarmthMakesAHollowBeforeAHole) {
    IceCover ice = wholeIce();
    const glm::dvec2 warm(0.01, -0.01);
    double deepest = 0.0;
    for (int k = 0; k < 90 && ice.melted() < 1e-9; ++k) {
        ice.advance(kStep, warmAt(warm, 0.6));
        const FloeField field = fieldOf(ice, ice.floes().front());
        if (field.between(field.shape, warm) > 0.95F) deepest = std::min(deepest, topAt(field, warm));
    }
    EXPECT_LT(deepest, -0.0002);
}

TEST(IcePicture, IsBrightAlongRimsAndWetWhereIceIsThin) {
    IceCover ice = wholeIce();
    const FloeField whole = fieldOf(ice, ice.floes().front());
    IcePicture picture(1);
    picture.paint(whole);
    const auto before = picture.image();
    EXPECT_EQ(picture.image(), before) << "the same object while it stays";
    const auto lightAt = [](const Image& image, const glm::dvec2& home) {
        const glm::ivec2 at((home / kPondHalf + 1.0) * 0.5 * glm::dvec2(image.size()));
        const Image::Pixel& pixel = image.at(at.x, at.y);
        return (pixel[0] + pixel[1] + pixel[2]) / 3.0;
    };
    // Along a straight part of the rim: lighter than the ice 4 mm farther in, on the mean.
    const Polygon& shore = ice.shore();
    double line = 0.0, inner = 0.0;
    for (std::size_t k = 0; k < shore.size(); ++k) {
        const glm::dvec2 rim = 0.5 * (shore[k] + shore[(k + 1) % shore.size()]), in = -rim / glm::length(rim);
        line += lightAt(*before, rim + 0.0007 * in);
        inner += lightAt(*before, rim + 0.004 * in);
    }
    EXPECT_GT(line, 1.1 * inner);
    // Warmth: darker there, and nothing else has changed.
    const glm::dvec2 warm(0.01, -0.01);
    for (int k = 0; k < 14; ++k) ice.advance(kStep, warmAt(warm, 1.0));
    const FloeField thin = fieldOf(ice, ice.floes().front());
    picture.paint(thin, &whole);
    ASSERT_NE(picture.image(), before);
    EXPECT_LT(lightAt(*picture.image(), warm), lightAt(*before, warm));
    for (int k = 0; k < before->size().x; k += 7)
        for (int j = 0; j < before->size().y; j += 7)
            if (glm::distance(IcePicture::placeOf(k, j), warm) > 0.03) {
                ASSERT_NEAR(lightAt(*picture.image(), IcePicture::placeOf(k, j)),
                            lightAt(*before, IcePicture::placeOf(k, j)), 3.0)
                    << k << " " << j;
            }
    // What is painted anew in part is what is painted at once.
    IcePicture other(1);
    other.paint(whole);
    other.paint(thin);
    int different = 0;
    for (std::size_t k = 0; k < before->pixels().size(); ++k)
        for (std::size_t c = 0; c < 3; ++c)
            different += std::abs(picture.image()->pixels()[k][c] - other.image()->pixels()[k][c]) > 6 ? 1 : 0;
    EXPECT_EQ(different, 0);
}

/// Ice with its fields, and water on it.
struct WetIce {
    explicit WetIce(std::uint64_t seed) : ice(wholeIce(seed)), water(seed) {}
    void advance(double seconds, const std::vector<Warmth>& warmths, const glm::dvec2& lean, double thaw = 0.0) {
        for (double t = 0.0; t < seconds; t += kStep) {
            for (const Floe& floe : ice.floes())
                if (!fields.contains(floe.number)) fields[floe.number] = fieldOf(ice, floe);
            water.advance(
                ice, [this](int number) { return &fields.at(number); }, {warmths, lean, thaw}, kStep);
        }
    }
    IceCover ice; // which stays as it is: its water alone moves
    Meltwater water;
    std::map<int, FloeField> fields;
};

TEST(IceMeltwater, GathersUnderWarmthRunsDownTheLeanAndDrips) {
    WetIce wet(1);
    const std::vector<Warmth> warm{{{0.02, 0.01}, 0.018, 1.0}};
    wet.advance(0.4, warm, {0.2, 0.0});
    ASSERT_EQ(wet.water.puddles().size(), 1U);
    EXPECT_LT(glm::distance(wet.water.puddles().front().home, warm.front().place), 0.002);
    wet.advance(2.0, warm, {0.2, 0.0});
    ASSERT_GE(wet.water.rivulets().size(), 3U);
    for (const Rivulet& rivulet : wet.water.rivulets())
        EXPECT_GE(rivulet.home.x - rivulet.way.front().home.x, -0.002) << "down, which is along x";
    EXPECT_TRUE(wet.water.drips().empty());
    bool dripped = false;
    for (int k = 0; k < 40 && !dripped; ++k) {
        wet.advance(0.2, warm, {0.2, 0.0});
        dripped = !wet.water.drips().empty();
    }
    ASSERT_TRUE(dripped);
    const glm::dvec2 place = wet.water.drips().front().place;
    EXPECT_GT(place.x, 0.06) << "at the low rim";
    EXPECT_LT(glm::distance(nearestOnRim(wet.ice.shore(), place), place), 0.002);
    // Without warmth it dries up.
    wet.advance(20.0, {}, {0.2, 0.0});
    EXPECT_TRUE(wet.water.puddles().empty());
    EXPECT_TRUE(wet.water.rivulets().empty());
    EXPECT_TRUE(wet.water.drips().empty());
}

TEST(IceMeltwater, IsTheSameForTheSameSeedAndNeverTooMuch) {
    WetIce one(5), other(5);
    const std::vector<Warmth> warm{{{0.02, 0.01}, 0.03, 2.0}, {{-0.04, 0.02}, 0.03, 2.0}, {{-0.02, -0.03}, 0.03, 2.0}};
    for (WetIce* wet : {&one, &other}) wet->advance(8.0, warm, {0.05, -0.04}, 0.001);
    ASSERT_EQ(one.water.rivulets().size(), other.water.rivulets().size());
    for (std::size_t k = 0; k < one.water.rivulets().size(); ++k)
        EXPECT_EQ(one.water.rivulets()[k].home, other.water.rivulets()[k].home);
    EXPECT_GT(one.water.rivulets().size(), 6U);
    EXPECT_LE(one.water.rivulets().size(), Meltwater::kMostRivulets);
    EXPECT_LE(one.water.drips().size(), Meltwater::kMostDrips);
}

TEST(IceMeltwater, IsSeenInTheShow) {
    IceProgram program(1);
    test::ProgramVisit visit(program);
    int wet = 0, rings = 0;
    for (int k = 0; k < 60 * 24; ++k) {
        visit.frame();
        wet += visit.item(kMeltwaterItem).visible ? 1 : 0;
        rings += visit.item(kFirstRing).visible ? 1 : 0;
        if (visit.item(kMeltwaterItem).visible) {
            ASSERT_TRUE(visit.content().assets->models.contains("ice meltwater")) << k;
        }
    }
    EXPECT_GT(wet, 60 * 12);
    EXPECT_GT(rings, 60 * 4);
}

} // namespace
} // namespace lumorph::ice
