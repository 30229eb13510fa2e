#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "tests/core/render/eye_stage.h"

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
