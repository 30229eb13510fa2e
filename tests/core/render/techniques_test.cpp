#include "app/applications/techniques/techniques.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

#include "tests/core/render/gl/predicted_region.h"

// Each technique changes what is displayed where a ray caster says it may, and nothing elsewhere.

namespace lumorph {
namespace {

constexpr double kTop = 0.02; // metres: the resting device's top
constexpr glm::dvec2 kHalf(0.105, 0.075);
constexpr int kBand = 2; // pixels around a predicted region

int countOf(const std::vector<bool>& marked) {
    return static_cast<int>(std::count(marked.begin(), marked.end(), true));
}

/// The pixels with nothing but marked ones within the band.
std::vector<bool> shrunken(std::vector<bool> marked, glm::ivec2 size) {
    marked.flip();
    marked = grown(marked, size, kBand);
    marked.flip();
    return marked;
}

/// Squares two centimetres and more a side, so that one place of the table is told from another.
void layCloth(EyeStage& stage) {
    stage.scene.sky = glm::vec3(0.3F);
    stage.assets->images["squares"] = EyeStage::checks({64, 64}, 16, {230, 190, 120, 255}, {110, 60, 30, 255});
    stage.scene.table.material.colorTexture = EyeStage::textured("squares", 0.09F);
}
LinearPicture drawTableAlone(EyeStage& stage) {
    ShowFrame frame = stage.frame();
    frame.rig.reset();
    return stage.draw(frame, stage.camera());
}

/// Which pixels the first light, a sun, does not reach. An edge of a shadow may lie a little beside the true one, and
/// anywhere where the sun only grazes.
struct Darkness {
    std::vector<bool> dark;   ///< or near to it, or grazed
    std::vector<bool> robbed; ///< would be well lit, were nothing in the way
};
Darkness darknessOf(const ShowFrame& frame, const CalibratedCamera& camera) {
    constexpr double kGrazing = 0.08; // cosine
    constexpr double kBeside = 0.001; // metres
    const RayOracle rays = EyeStage::oracle(frame);
    const glm::dvec3 sun = glm::normalize(glm::dvec3(frame.posed.lights.front().position));
    const glm::dvec3 side = kBeside * glm::normalize(glm::cross(sun, glm::dvec3(0.0, 1.0, 0.0)));
    const glm::dvec3 up = glm::cross(side, sun);
    Darkness result;
    for (const Met& met : meet(frame, camera)) {
        const bool there = met.thing != EyeStage::nothing;
        const double facing = glm::dot(met.normal, sun);
        const auto hiddenAt = [&](const glm::dvec3& place) {
            return there && rays.cast(place + 1e-6 * met.normal, sun).has_value();
        };
        const bool hidden = hiddenAt(met.place);
        bool dim = hidden || facing < kGrazing;
        for (const glm::dvec3& way : {side, -side, up, -up}) {
            const glm::dvec3 onSurface = way - glm::dot(way, met.normal) * met.normal;
            dim = dim || hiddenAt(met.place + onSurface);
        }
        result.dark.push_back(there && dim);
        result.robbed.push_back(hidden && facing > kGrazing);
    }
    return result;
}

// R29
TEST(Techniques, OneShapeHasTheShadowOfEachPlaceOfTheLight) {
    EyeStage stage;
    stage.strokes = {0.3, 0.3, 0.3, 0.3, 0, 0};
    std::vector<std::vector<bool>> shadows;
    for (const glm::vec3& sun : {glm::vec3(-0.45F, 0.8F, -0.3F), glm::vec3(0.6F, 0.5F, 0.15F)}) {
        stage.scene.items.front().position = sun;
        stage.sun().shadows = false;
        const LinearPicture open = stage.draw();
        stage.sun().shadows = true;
        const LinearPicture shaded = stage.draw();
        const Darkness darkness = darknessOf(stage.frame(), stage.camera());
        const Change change = changeOf(open, shaded, grown(darkness.dark, stage.size, kBand));
        EXPECT_EQ(change.outside, 0) << sun.x;
        EXPECT_LT(change.area, static_cast<int>(open.pixels.size()) / 2) << sun.x;
        const std::vector<bool> sure = shrunken(darkness.robbed, stage.size);
        EXPECT_GT(countOf(sure), 1'000) << sun.x;
        EXPECT_GE(changeOf(open, shaded, sure).inside, 0.99 * countOf(sure)) << sun.x;
        shadows.push_back(darkness.robbed);
    }
    int other = 0;
    for (std::size_t i = 0; i < shadows[0].size(); ++i) other += shadows[0][i] != shadows[1][i] ? 1 : 0;
    EXPECT_GT(other, 5'000);
}

/// An edge of a mesh, by how much the surface turns about it.
struct Fold {
    glm::dvec3 a{0.0}, b{0.0};
    double own = 0.0;    ///< radians, at the edge itself
    double around = 0.0; ///< radians, from the one end to the other of what lies within the search's radius
};

/// What a mesh turns about each of its edges. Looks at all triangles around, and so finds no less than any walk across
/// an edge does; edges of a box part what lies on both sides of them.
class Folding {
public:
    Folding(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& positions) {
        std::map<std::pair<unsigned, unsigned>, std::vector<std::size_t>> sides;
        for (const glm::uvec3& t : triangles) {
            const glm::dvec3 a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
            for (int k = 0; k < 3; ++k) sides[std::minmax(t[k], t[(k + 1) % 3])].push_back(normals_.size());
            normals_.push_back(glm::normalize(glm::cross(b - a, c - a)));
        }
        ways_.resize(normals_.size());
        for (const auto& [ends, beside] : sides) {
            if (beside.size() != 2) continue;
            const Edge edge{glm::dvec3(positions[ends.first]), glm::dvec3(positions[ends.second]), beside[0],
                            beside[1]};
            for (const std::size_t triangle : beside) ways_[triangle].push_back(edges_.size());
            edges_.push_back(edge);
        }
    }

    [[nodiscard]] std::vector<Fold> within(double radius) const {
        std::vector<Fold> folds;
        for (const Edge& edge : edges_) {
            const double own = std::acos(std::min(glm::dot(normals_[edge.left], normals_[edge.right]), 1.0));
            if (own < 0.0045) continue; // of a flat place
            folds.push_back({edge.a, edge.b, own, turningAround(edge, radius)});
        }
        return folds;
    }

    static double distanceTo(const glm::dvec3& place, const glm::dvec3& a, const glm::dvec3& b) {
        const glm::dvec3 u = b - a;
        const double share = glm::clamp(glm::dot(place - a, u) / glm::dot(u, u), 0.0, 1.0);
        return glm::distance(place, a + share * u);
    }

private:
    struct Edge {
        glm::dvec3 a, b;
        std::size_t left, right;
    };

    [[nodiscard]] double turningAround(const Edge& edge, double radius) const {
        const glm::dvec3 middle = 0.5 * (edge.a + edge.b);
        const glm::dvec3 axis = glm::normalize(edge.b - edge.a);
        const glm::dvec3& first = normals_[edge.left];
        std::vector<std::size_t> reached{edge.left, edge.right};
        double low = 0.0, high = 0.0;
        for (std::size_t i = 0; i < reached.size(); ++i) {
            const glm::dvec3& normal = normals_[reached[i]];
            const double turn = std::atan2(glm::dot(glm::cross(first, normal), axis), glm::dot(first, normal));
            low = std::min(low, turn);
            high = std::max(high, turn);
            for (const std::size_t way : ways_[reached[i]]) {
                const Edge& next = edges_[way];
                const std::size_t to = next.left == reached[i] ? next.right : next.left;
                if (distanceTo(middle, next.a, next.b) > radius || sharp(next) ||
                    std::find(reached.begin(), reached.end(), to) != reached.end())
                    continue;
                reached.push_back(to);
            }
        }
        return high - low;
    }
    [[nodiscard]] bool sharp(const Edge& edge) const {
        return glm::dot(normals_[edge.left], normals_[edge.right]) < std::cos(0.5);
    }

    std::vector<glm::dvec3> normals_;
    std::vector<Edge> edges_;
    std::vector<std::vector<std::size_t>> ways_; ///< out of each triangle
};

// R30
TEST(Techniques, LinesAreDrawnWhereTheSheetTurnsByTheThreshold) {
    constexpr double kRadius = 0.012; // metres over which turning counts as one fold
    EyeStage stage;
    stage.strokes = {0, 0, 0, 0, 0.3, 0};
    stage.sun().shadows = false;
    const LinearPicture before = stage.draw();
    stage.scene.device.creases.emphasis = 1.0;
    const LinearPicture after = stage.draw();
    const ShowFrame frame = stage.frame();
    const DeviceSkin::Creases& creases = frame.scene->device.creases;
    std::vector<Fold> folds = Folding(frame.rig->restMesh().triangles, *frame.devicePositions).within(kRadius);
    const double least = 0.9 * creases.threshold.inRadians(); // what is summed step by step may come out a little more
    std::erase_if(folds, [&](const Fold& fold) { return fold.around < least; });

    const auto nearFold = [&](double distance, double own) {
        return [=, &folds](const Met& met) {
            return onDevice(met) && std::any_of(folds.begin(), folds.end(), [&](const Fold& fold) {
                       const double reach = 0.5 * glm::distance(fold.a, fold.b) + distance;
                       return fold.own >= own && glm::distance(met.place, 0.5 * (fold.a + fold.b)) <= reach &&
                              Folding::distanceTo(met.place, fold.a, fold.b) <= distance;
                   });
        };
    };
    const std::vector<Met> met = meet(frame, stage.camera());
    const auto region = near(met, stage.size, kBand, nearFold(0.5 * creases.width + 0.0002, 0.0));
    const Change change = changeOf(before, after, region);
    EXPECT_EQ(change.outside, 0);
    EXPECT_GT(change.inside, 1'500);
    EXPECT_LT(change.area, countOf(near(met, stage.size, 0, onDevice)) * 2 / 3);
    // Every edge of the box is a line, but where it meets the table.
    const auto sharpEdge = nearFold(0.2 * creases.width, 0.5);
    const auto lines = near(met, stage.size, 0, [&](const Met& m) { return m.place.y > 0.001 && sharpEdge(m); });
    EXPECT_GT(countOf(lines), 300);
    EXPECT_GE(changeOf(before, after, lines).inside, 0.85 * countOf(lines));
}

// R32
TEST(Techniques, ShrinkingTurnsTheRimAloneIntoTable) {
    EyeStage stage;
    layCloth(stage);
    stage.sun().shadows = false;
    stage.scene.device.material.color = {0.1F, 0.2F, 0.9F};
    const LinearPicture whole = stage.draw();
    stage.scene.device.shrink = 0.2;
    const LinearPicture smaller = stage.draw();
    const LinearPicture table = drawTableAlone(stage);
    const std::vector<Met> met = meet(stage.frame(), stage.camera());
    const auto cutOff = [](const Met& m) {
        const glm::dvec2 share = glm::abs(glm::dvec2(m.place.x, m.place.z)) / kHalf;
        return onDevice(m) && std::max(share.x, share.y) > 0.8;
    };
    EXPECT_EQ(changeOf(whole, smaller, near(met, stage.size, kBand, cutOff)).outside, 0);
    const std::vector<bool> rim = shrunken(near(met, stage.size, 0, cutOff), stage.size);
    EXPECT_GT(countOf(rim), 8'000);
    EXPECT_GE(changeOf(whole, smaller, rim).inside, 0.99 * countOf(rim));
    EXPECT_GE(psnr(smaller, table, rim), 30.0);
}

/// The mask of a hole picture at places of the device's page (x to the right, z down, metres).
class HoleOracle {
public:
    HoleOracle(const Material& material, const Image& image)
        : tile_(material.holes.tile), threshold_(255.0 * static_cast<double>(material.holeThreshold)), image_(image) {}

    /// The least and the greatest value of the texels around a place, over the threshold.
    [[nodiscard]] glm::dvec2 around(const glm::dvec3& place) const {
        const glm::ivec2 size = image_.size();
        const glm::dvec2 page = glm::fract(glm::dvec2(place.x, place.z) / tile_) * glm::dvec2(size);
        glm::dvec2 range(255.0, 0.0);
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const glm::ivec2 at = (glm::ivec2(page) + glm::ivec2(x, y) + size) % size;
                const double value = image_.at(at.x, at.y)[0];
                range = {std::min(range.x, value), std::max(range.y, value)};
            }
        return range / threshold_;
    }

private:
    glm::dvec2 tile_;
    double threshold_;
    const Image& image_;
};

// R32: with the holes of the demo.
TEST(Techniques, HolesOfAPictureAreTheTableAlongTheEyesRay) {
    const Scene demo = techniqueScene(6);
    const Material& ice = demo.device.material;
    ASSERT_FALSE(ice.holes.image.empty());
    EyeStage stage;
    stage.assets->images = loadSceneAssets(demo, {})->images;
    layCloth(stage);
    stage.scene.device.material.color = {0.1F, 0.2F, 0.9F};
    stage.sun().shadows = false; // else light falls through the holes beside the device too
    const LinearPicture whole = stage.draw();
    stage.scene.device.material.holes = ice.holes;
    stage.scene.device.material.holeThreshold = ice.holeThreshold;
    const LinearPicture holed = stage.draw();
    const LinearPicture table = drawTableAlone(stage);

    const HoleOracle mask(ice, *stage.assets->images.at(ice.holes.image));
    const std::vector<Met> met = meet(stage.frame(), stage.camera());
    const auto onTop = [](const Met& m) { return onDevice(m) && m.place.y > kTop - 1e-4 && m.normal.y > 0.99; };
    // On the walls the page goes on, but what it shows there is not judged.
    const auto mayOpen = [&](const Met& m) { return onDevice(m) && (!onTop(m) || mask.around(m.place).x < 1.0); };
    const auto isOpen = [&](const Met& m) { return onTop(m) && mask.around(m.place).y < 1.0; };
    const Change change = changeOf(whole, holed, near(met, stage.size, kBand, mayOpen));
    EXPECT_EQ(change.outside, 0);
    EXPECT_LT(change.area, countOf(near(met, stage.size, 0, onDevice)));
    const std::vector<bool> open = shrunken(near(met, stage.size, 0, isOpen), stage.size);
    EXPECT_GT(countOf(open), 3'000);
    EXPECT_GE(changeOf(whole, holed, open).inside, 0.99 * countOf(open));
    EXPECT_GE(psnr(holed, table, open), 30.0);

    // Nor does the device's own shadow darken them, but close to its rim.
    stage.sun().shadows = true;
    const LinearPicture shaded = stage.draw();
    const auto inner = [&](const Met& m) {
        return isOpen(m) && glm::all(glm::lessThan(glm::abs(glm::dvec2(m.place.x, m.place.z)), kHalf - 0.015));
    };
    EXPECT_GE(psnr(shaded, table, shrunken(near(met, stage.size, 0, inner), stage.size)), 30.0);
}

TEST(Techniques, FogChangesWhatLiesBehindItsBox) {
    EyeStage stage;
    stage.scene.sky = glm::vec3(0.4F);
    stage.scene.device.material.color = glm::vec3(0.05F);
    stage.scene.table.material.color = glm::vec3(0.05F);
    const LinearPicture clear = stage.draw();
    const glm::dvec3 centre(0.0, 0.05, 0.0);
    const glm::dvec3 half(0.1, 0.04, 0.07);
    SceneItem fog;
    fog.id = 7;
    fog.name = "Fog";
    fog.position = glm::vec3(centre);
    fog.kind = FogItem{.size = glm::vec3(2.0 * half), .density = 30.0};
    stage.scene.items.push_back(fog);
    const LinearPicture veiled = stage.draw();

    const glm::dvec3 eye = EyeStage::origin(stage.camera());
    const auto behindBox = [&](const Met& m) {
        if (m.thing == EyeStage::nothing) return false;
        double enter = 0.0, leave = 1.0;
        for (int k = 0; k < 3; ++k) {
            const double way = m.place[k] - eye[k];
            const double a = (centre[k] - half[k] - eye[k]) / way;
            const double b = (centre[k] + half[k] - eye[k]) / way;
            if (std::isnan(a) || std::isnan(b)) continue; // along a side
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave;
    };
    const auto region = near(meet(stage.frame(), stage.camera()), stage.size, kBand, behindBox);
    const Change change = changeOf(clear, veiled, region);
    EXPECT_EQ(change.outside, 0);
    EXPECT_GT(change.inside, change.area * 7 / 10);
    EXPECT_LT(change.area, static_cast<int>(region.size()) * 4 / 5);
}

} // namespace
} // namespace lumorph
