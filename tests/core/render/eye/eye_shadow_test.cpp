#include <cmath>
#include <cstdio>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/render/eye/eye_stage.h"

namespace lumorph {
namespace {

constexpr int kBand = 2;          // pixels around every edge that are not judged
constexpr double kGrazing = 0.08; // cosine to the light below which lit and dark look alike

/// What a ray caster says of a pixel.
struct Seen {
    int thing = EyeStage::nothing;
    glm::dvec3 normal{0.0};
    double facing = 0.0; ///< cosine to the light
    double direct = 0.0; ///< light that comes straight from it where nothing is in the way
    bool lit = false;
};

std::vector<Seen> look(const ShowFrame& frame, const CalibratedCamera& camera) {
    const RayOracle rays = EyeStage::oracle(frame);
    const PosedLight& light = frame.posed.lights.front();
    std::vector<Seen> seen;
    for (int y = 0; y < camera.size.y; ++y)
        for (int x = 0; x < camera.size.x; ++x) {
            Seen pixel;
            const glm::dvec3 from = EyeStage::origin(camera);
            const glm::dvec3 direction = EyeStage::ray(camera, x, y);
            if (const auto hit = rays.cast(from, direction)) {
                const glm::dvec3 at = from + hit->distance * direction + 1e-6 * hit->normal;
                const glm::dvec3 way = glm::dvec3(light.position) - (light.parallel ? glm::dvec3(0.0) : at);
                pixel.thing = hit->thing;
                pixel.normal = hit->normal;
                pixel.facing = glm::dot(hit->normal, glm::normalize(way));
                pixel.direct = light.radiance.g * pixel.facing * (light.parallel ? 1.0 : 0.25 / glm::dot(way, way));
                const auto blocker = rays.cast(at, glm::normalize(way));
                pixel.lit =
                    pixel.facing > 0.0 && !(blocker && (light.parallel || blocker->distance < glm::length(way)));
            }
            seen.push_back(pixel);
        }
    return seen;
}

bool inside(const std::vector<Seen>& seen, glm::ivec2 size, int x, int y) {
    const auto at = [&](int i, int j) -> const Seen& { return seen[static_cast<std::size_t>(j * size.x + i)]; };
    const Seen& middle = at(x, y);
    if (middle.thing == EyeStage::nothing || middle.facing < kGrazing) return false;
    for (int j = y - kBand; j <= y + kBand; ++j)
        for (int i = x - kBand; i <= x + kBand; ++i) {
            if (i < 0 || j < 0 || i >= size.x || j >= size.y) return false;
            const Seen& other = at(i, j);
            if (other.thing != middle.thing || other.lit != middle.lit || glm::dot(other.normal, middle.normal) < 0.7)
                return false;
        }
    return true;
}

struct Score {
    int judged = 0, agree = 0, litJudged = 0, litAgree = 0, dark = 0, darkAgree = 0;
};

// A pixel is dark where shadows take away the light that comes straight from the source.
Score score(EyeStage& stage) {
    stage.sun().shadows = false;
    const LinearPicture open = stage.draw();
    stage.sun().shadows = true;
    const ShowFrame frame = stage.frame();
    const CalibratedCamera camera = stage.camera();
    const LinearPicture picture = stage.draw(frame, camera);
    const std::vector<Seen> seen = look(frame, camera);
    Score score;
    for (int y = 0; y < camera.size.y; ++y)
        for (int x = 0; x < camera.size.x; ++x) {
            if (!inside(seen, camera.size, x, y)) continue;
            const Seen& pixel = seen[static_cast<std::size_t>(y * camera.size.x + x)];
            const bool lit = open.at(x, y).g - picture.at(x, y).g < 0.5 * std::min(pixel.direct, 1.0);
            ++score.judged;
            score.agree += lit == pixel.lit ? 1 : 0;
            score.litJudged += pixel.lit ? 1 : 0;
            score.litAgree += pixel.lit && lit ? 1 : 0;
            score.dark += pixel.lit ? 0 : 1;
            score.darkAgree += pixel.lit || lit ? 0 : 1;
        }
    return score;
}

const std::vector<std::vector<double>> kStates{{0, 0, 0, 0, 0, 0},
                                               {0.3, 0.3, 0.3, 0.3, 0, 0},
                                               {0.7, 0, 0.2, 0.5, 0, 0.1},
                                               {0, 0, 0, 0, 0.5, 0.8},
                                               {0.15, 0.05, 0.2, 0.1, 0.12, 0.3}};

// R29, R31
TEST(EyeShadow, SilhouettesAgreeWithARayCaster) {
    EyeStage stage;
    stage.addBox({0.02F, 0.075F, 0.01F}, 0.03F);
    for (const auto& state : kStates)
        for (const glm::vec3& sun : {glm::vec3(-0.45F, 0.8F, -0.3F), glm::vec3(0.7F, 0.5F, 0.1F)}) {
            stage.strokes = state;
            stage.scene.items.front().position = sun;
            const Score result = score(stage);
            EXPECT_GT(result.judged, 150'000);
            EXPECT_GT(result.dark, 2'000);
            EXPECT_GE(result.agree, 0.99 * result.judged) << "state " << state[0] << " sun " << sun.x;
            EXPECT_GE(result.litAgree, 0.999 * result.litJudged) << "state " << state[0] << " sun " << sun.x;
        }
}

TEST(EyeShadow, OfALampToo) {
    EyeStage stage;
    stage.addBox({0.02F, 0.06F, 0.01F}, 0.03F);
    stage.sun().kind = LightItem::Kind::lamp;
    for (const glm::vec3& lamp : {glm::vec3(-0.25F, 0.4F, -0.1F), glm::vec3(0.02F, 0.2F, 0.0F)}) {
        stage.scene.items.front().position = lamp;
        stage.strokes = kStates[2];
        const Score result = score(stage);
        EXPECT_GT(result.dark, 2'000);
        EXPECT_GE(result.agree, 0.99 * result.judged) << lamp.x;
    }
}

// The near side of the device steps back in the map: close to the table its far side must throw the shadow.
TEST(EyeShadow, BeginsWhereTheDeviceTouchesTheTable) {
    EyeStage stage;
    for (const bool lamp : {false, true}) {
        stage.sun().kind = lamp ? LightItem::Kind::lamp : LightItem::Kind::sun;
        stage.scene.items.front().position = lamp ? glm::vec3(-0.4F, 0.12F, -0.3F) : glm::vec3(-0.7F, 0.2F, -0.5F);
        const Score result = score(stage);
        EXPECT_GT(result.dark, 1'000) << lamp;
        EXPECT_GE(result.darkAgree, 0.9998 * result.dark) << lamp;
        EXPECT_GE(result.litAgree, 0.999 * result.litJudged) << lamp;
    }
}

TEST(EyeShadow, OfAThinPlateCloseToTheTable) {
    EyeStage stage;
    SceneItem& plate = stage.addBox({0.02F, 0.0F, 0.14F}, 0.06F);
    for (const auto& [thickness, gap] : {std::pair(0.001F, 0.004F), std::pair(0.005F, 0.02F)}) {
        std::get<ShapeItem>(plate.kind).size = {0.06F, thickness, 0.05F};
        plate.position.y = gap + 0.5F * thickness;
        const Score result = score(stage);
        EXPECT_GT(result.dark, 1'000) << thickness;
        EXPECT_GE(result.darkAgree, 0.99 * result.dark) << thickness;
        EXPECT_GE(result.litAgree, 0.999 * result.litJudged) << thickness;
    }
}

// A resting or bent sheet in full light shows no speck of its own shadow.
TEST(EyeShadow, LeavesLitSheetsWhole) {
    EyeStage stage;
    for (const double softness : {0.0, 0.1})
        for (const glm::vec3& sun : {glm::vec3(-0.1F, 0.9F, 0.2F), glm::vec3(-0.6F, 0.5F, 0.3F)}) {
            stage.sun().softness = softness;
            stage.scene.items.front().position = sun;
            const ShowFrame frame = stage.frame();
            const LinearPicture picture = stage.draw(frame, stage.camera());
            const std::vector<Seen> seen = look(frame, stage.camera());
            const auto expected = static_cast<float>(frame.posed.lights.front().radiance.g * glm::normalize(sun).y);
            int tops = 0;
            int specks = 0;
            for (int y = 0; y < stage.size.y; ++y)
                for (int x = 0; x < stage.size.x; ++x) {
                    const Seen& pixel = seen[static_cast<std::size_t>(y * stage.size.x + x)];
                    if (pixel.thing != EyeStage::device || pixel.normal.y < 0.999 || !pixel.lit ||
                        !inside(seen, stage.size, x, y))
                        continue;
                    ++tops;
                    specks += std::abs(picture.at(x, y).g - expected) > 0.01F ? 1 : 0;
                }
            EXPECT_GT(tops, 50'000);
            EXPECT_LE(specks, softness > 0.0 ? tops / 100 : 0); // beside the slits edges are soft
        }
}

/// Which share of a round sun is seen from a place.
double shareOfSun(const RayOracle& rays, const glm::dvec3& from, const glm::dvec3& sun, double size) {
    const glm::dvec3 side = glm::normalize(glm::cross(sun, glm::dvec3(0.0, 0.0, 1.0)));
    const glm::dvec3 up = glm::cross(side, sun);
    int seen = 0;
    int all = 0;
    for (int i = -7; i <= 7; ++i)
        for (int j = -7; j <= 7; ++j) {
            const glm::dvec2 at(i / 7.0, j / 7.0);
            if (glm::length(at) > 1.0) continue;
            const glm::dvec3 way = sun + 0.5 * size * (at.x * side + at.y * up);
            seen += rays.cast(from, glm::normalize(way), 1e-9, EyeStage::firstItem) ? 0 : 1;
            ++all;
        }
    return static_cast<double>(seen) / all;
}

// R31: the wider, the larger the source and the higher what throws them.
TEST(EyeShadow, SoftEdgesAreAsWideAsTheSourceMakesThem) {
    EyeStage stage;
    stage.scene.items.front().position = {-0.15F, 0.9F, -0.1F};
    stage.addBox({0.0F, 0.0F, 0.0F}, 0.03F);
    stage.sun().shadows = false;
    const LinearPicture open = stage.draw(); // the device's top alone is judged
    stage.sun().shadows = true;
    for (const float height : {0.05F, 0.1F})
        for (const double softness : {0.1, 0.2}) {
            stage.sun().softness = softness;
            stage.scene.items.back().position = {0.0F, height, 0.0F};
            const ShowFrame frame = stage.frame();
            const LinearPicture picture = stage.draw(frame, stage.camera());
            const std::vector<Seen> seen = look(frame, stage.camera());
            const RayOracle rays = EyeStage::oracle(frame);
            const glm::dvec3 sun = glm::normalize(glm::dvec3(frame.posed.lights.front().position));
            int soft = 0;
            int drawnSoft = 0;
            double difference = 0.0;
            for (int y = 0; y < stage.size.y; y += 2)
                for (int x = 0; x < stage.size.x; x += 2) {
                    const Seen& pixel = seen[static_cast<std::size_t>(y * stage.size.x + x)];
                    const glm::dvec3 from = EyeStage::origin(stage.camera());
                    const glm::dvec3 direction = EyeStage::ray(stage.camera(), x, y);
                    const glm::dvec3 place = from + direction * ((0.02 - from.y) / direction.y);
                    if (pixel.thing != EyeStage::device || pixel.normal.y < 0.999 || std::abs(place.x) > 0.09 ||
                        std::abs(place.z) > 0.06)
                        continue;
                    const double share = shareOfSun(rays, place + 1e-6 * pixel.normal, sun, softness);
                    const double drawn = 1.0 - static_cast<double>(open.at(x, y).g - picture.at(x, y).g) / pixel.direct;
                    const bool half = share > 0.1 && share < 0.9;
                    soft += half ? 1 : 0;
                    drawnSoft += drawn > 0.1 && drawn < 0.9 ? 1 : 0;
                    difference += half ? std::abs(share - drawn) : 0.0;
                }
            RecordProperty("soft", soft);
            std::printf("source %.1f, %3.0f mm above: %d soft pixels, %d drawn, mean difference %.3f\n", softness,
                        1000.0 * static_cast<double>(height - 0.02F), soft, drawnSoft, difference / soft);
            EXPECT_GT(soft, 100);
            EXPECT_NEAR(static_cast<double>(drawnSoft) / soft, 1.0, 0.3) << softness << ' ' << height;
            EXPECT_LT(difference / soft, 0.08) << softness << ' ' << height;
        }
}

// R29
TEST(EyeShadow, AnotherPlaceOfTheLightGivesAnotherShadow) {
    EyeStage stage;
    stage.strokes = kStates[1];
    const LinearPicture left = stage.draw();
    stage.scene.items.front().position = {0.6F, 0.5F, 0.1F};
    const LinearPicture right = stage.draw();
    int changed = 0;
    for (std::size_t i = 0; i < left.pixels.size(); ++i)
        changed += std::abs(left.pixels[i].g - right.pixels[i].g) > 0.3F ? 1 : 0;
    EXPECT_GT(changed, 5'000);
}

/// Of the flap that is lifted, at rest: a hole there lets light through that falls far from it.
glm::vec2 middleOfFlap(const EyeStage& stage) {
    Box box;
    for (const std::uint32_t vertex : stage.rig->verticesOf(0)) box.include(stage.rig->restMesh().positions[vertex]);
    return {box.centre().x, box.centre().z};
}

// The map is kept while nothing casts another shadow. Each of these changes it, and nothing else tells of them: the
// light looks at the same box from the same side.
TEST(EyeShadow, KeptShadowsAreDrawnAnewWhateverChangesThem) {
    struct Case {
        const char* what;
        void (*change)(EyeStage& stage);
        int least; ///< pixels that look otherwise
    };
    const Case cases[] = {
        {"a hole",
         [](EyeStage& s) {
             s.scene.device.holes.push_back({middleOfFlap(s), 0.008});
         },
         40},
        {"a wider hole", [](EyeStage& s) { s.scene.device.holes.front().radius = 0.014; }, 40},
        {"a hole elsewhere", [](EyeStage& s) { s.scene.device.holes.front().centre.x += 0.012F; }, 40},
        {"no hole", [](EyeStage& s) { s.scene.device.holes.clear(); }, 40},
        {"a smaller skin", [](EyeStage& s) { s.scene.device.shrink = 0.3; }, 40},
        {"a plate that turns",
         [](EyeStage& s) { s.scene.items.back().rotation = glm::angleAxis(1.57F, glm::vec3(0.0F, 1.0F, 0.0F)); }, 40},
        {"a plate that moves", [](EyeStage& s) { s.scene.items.back().position.x -= 0.02F; }, 40},
        {"a plate that fades", [](EyeStage& s) { s.scene.items.back().opacity = 0.4F; }, 40},
        {"a softer light", [](EyeStage& s) { s.sun().softness = 0.25; }, 40},
        {"a flap that sinks", [](EyeStage& s) { s.strokes[0] = 0.35; }, 40},
    };
    EyeStage stage;
    stage.strokes = kStates[2];
    SceneItem& plate = stage.addBox({0.02F, 0.05F, -0.01F}, 0.06F);
    std::get<ShapeItem>(plate.kind).size = {0.07F, 0.002F, 0.025F};
    plate.rotation = {1.0F, 0.0F, 0.0F, 0.0F};
    const auto differing = [](const LinearPicture& a, const LinearPicture& b) {
        int pixels = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            pixels += std::abs(a.pixels[i].g - b.pixels[i].g) > 0.02F ? 1 : 0;
        return pixels;
    };
    LinearPicture last = stage.draw();
    for (const Case& one : cases) {
        one.change(stage);
        const ShowFrame frame = stage.frame();
        const LinearPicture now = stage.draw(frame, stage.camera());
        EyePass fresh;
        EXPECT_EQ(differing(now, stage.drawBy(fresh, frame, stage.camera())), 0) << one.what;
        EXPECT_GT(differing(now, last), one.least) << one.what;
        last = now;
    }
}

// What fades takes its shadow along.
TEST(EyeShadow, FadesWithItsThing) {
    EyeStage stage;
    stage.sun().softness = 0.15;
    SceneItem& box = stage.addBox({0.0F, 0.08F, 0.0F}, 0.04F);
    const auto mean = [&](float opacity) {
        box.opacity = opacity;
        const LinearPicture picture = stage.draw();
        double sum = 0.0;
        for (const glm::vec4& pixel : picture.pixels) sum += pixel.g;
        return sum;
    };
    const double whole = mean(1.0F);
    const double half = mean(0.5F);
    const double none = mean(0.001F);
    EXPECT_GT(half, whole + 0.3 * (none - whole));
    EXPECT_LT(half, whole + 0.8 * (none - whole));
}

} // namespace
} // namespace lumorph
