#include <optional>

#include <gtest/gtest.h>

#include "tests/core/render/gl/predicted_region.h"

// What water and mirrors show of the table, against rays that are bent and mirrored by the book.

namespace lumorph {
namespace {

/// A table of red and blue squares.
void layRedAndBlue(EyeStage& stage) {
    stage.sun().shadows = false;
    stage.assets->images["squares"] = EyeStage::checks({32, 32}, 16, {230, 10, 20, 255}, {20, 10, 230, 255});
    stage.scene.table.material.colorTexture = EyeStage::textured("squares", 0.05F);
}

/// How often a picture shows red and blue as a table alone does at the places that `wayFrom` leads to.
struct Agreement {
    int judged = 0, agree = 0, blue = 0;
};
template <class WayFrom> Agreement withTable(EyeStage& stage, const LinearPicture& picture, const WayFrom& wayFrom) {
    ShowFrame bare = stage.frame();
    const std::vector<Met> met = meet(bare, stage.camera());
    bare.rig.reset();
    bare.posed.surfaces.clear();
    const LinearPicture table = stage.draw(bare, stage.camera());
    const auto red = [](const glm::vec4& color) { return color.r > color.b; };
    Agreement result;
    for (int y = 0; y < stage.size.y; ++y)
        for (int x = 0; x < stage.size.x; ++x) {
            const Met& here = met[static_cast<std::size_t>(y * stage.size.x + x)];
            if (here.thing != EyeStage::firstItem) continue;
            const auto way = wayFrom(here, EyeStage::ray(stage.camera(), x, y));
            if (!way) continue;
            const auto pixel = pixelOf(stage.camera(), here.place - *way * (here.place.y / way->y));
            if (!pixel) continue;
            const glm::ivec2 at(glm::round(*pixel));
            if (at.x < 2 || at.y < 2 || at.x > stage.size.x - 3 || at.y > stage.size.y - 3) continue;
            bool plain = true; // no edge of a square about
            for (const glm::ivec2 by : {glm::ivec2(-2, 0), glm::ivec2(2, 0), glm::ivec2(0, -2), glm::ivec2(0, 2)})
                plain = plain && red(table.at(at.x + by.x, at.y + by.y)) == red(table.at(at.x, at.y));
            if (!plain) continue;
            ++result.judged;
            result.blue += red(picture.at(x, y)) ? 0 : 1;
            result.agree += red(picture.at(x, y)) == red(table.at(at.x, at.y)) ? 1 : 0;
        }
    return result;
}

// R28
TEST(EyeOptics, ClearWaterShowsTheTableWhereSnellSeesIt) {
    for (const float index : {1.0F, 1.33F, 1.7F}) {
        EyeStage stage;
        layRedAndBlue(stage);
        SceneItem water;
        water.id = 7;
        water.name = "Water";
        water.anchor = Anchor::world;
        water.position = {0.0F, 0.06F, 0.0F};
        water.material = EyeStage::plain({1.0F, 1.0F, 1.0F});
        water.material.refraction = 1.0F;
        water.material.refractiveIndex = index;
        HeightItem flat;
        flat.size = {0.16F, 0.12F};
        water.kind = flat;
        stage.scene.items.push_back(water);
        const Agreement result =
            withTable(stage, stage.draw(), [&](const Met& met, const glm::dvec3& view) -> std::optional<glm::dvec3> {
                if (met.normal.y < 0.999) return std::nullopt;
                return glm::refract(view, met.normal, 1.0 / static_cast<double>(index));
            });
        EXPECT_GT(result.judged, 10'000) << index;
        EXPECT_GT(result.blue, result.judged / 4) << index;
        EXPECT_LT(result.blue, result.judged * 3 / 4) << index;
        EXPECT_GE(result.agree, 0.98 * result.judged) << index;
    }
}

// R28
TEST(EyeOptics, MovingPicturesOnClearWaterLieOnTheGroundWhereSnellSeesIt) {
    for (const float turn : {0.0F, 0.6F}) {
        EyeStage stage;
        stage.sun().shadows = false;
        stage.assets->images["squares"] = EyeStage::checks({32, 32}, 16, {230, 10, 20, 255}, {20, 10, 230, 255});
        stage.assets->images["film"] = EyeStage::checks({64, 32}, 16, {230, 10, 20, 255}, {20, 10, 230, 255});
        SceneItem water;
        water.id = 7;
        water.name = "Water";
        water.anchor = Anchor::world;
        water.position = {0.0F, 0.06F, 0.0F};
        water.rotation = glm::angleAxis(turn, glm::vec3(0.0F, 1.0F, 0.0F));
        water.material = EyeStage::plain({1.0F, 1.0F, 1.0F});
        water.material.refraction = 1.0F;
        water.material.colorTexture = EyeStage::textured("film", 0.05F);
        water.material.colorTexture.columns = 2; // both pictures are the same squares
        HeightItem flat;
        flat.size = {0.16F, 0.12F};
        water.kind = flat;
        stage.scene.items.push_back(water);
        const LinearPicture picture = stage.draw(); // over a plain table
        stage.scene.table.material.colorTexture = EyeStage::textured("squares", 0.05F);
        stage.scene.table.material.colorTexture.turn = Angle::radians(static_cast<double>(turn));
        const Agreement result =
            withTable(stage, picture, [&](const Met& met, const glm::dvec3& view) -> std::optional<glm::dvec3> {
                if (met.normal.y < 0.999) return std::nullopt;
                return glm::refract(view, met.normal, 1.0 / 1.33);
            });
        EXPECT_GT(result.judged, 10'000) << turn;
        EXPECT_GT(result.blue, result.judged / 4) << turn;
        EXPECT_LT(result.blue, result.judged * 3 / 4) << turn;
        EXPECT_GE(result.agree, 0.98 * result.judged) << turn;
    }
}

TEST(EyeOptics, AMirrorShowsTheTableBeforeIt) {
    EyeStage stage;
    layRedAndBlue(stage);
    SceneItem& mirror = stage.addBox({0.0F, 0.05F, -0.02F}, 0.1F);
    mirror.rotation = {1.0F, 0.0F, 0.0F, 0.0F};
    mirror.material.metallic = 1.0F;
    mirror.material.reflection = 1.0F;
    const Agreement result =
        withTable(stage, stage.draw(), [](const Met& met, const glm::dvec3& view) -> std::optional<glm::dvec3> {
            if (met.normal.z < 0.999) return std::nullopt; // the side that the eye sees itself in
            return glm::reflect(view, met.normal);
        });
    EXPECT_GT(result.judged, 5'000);
    EXPECT_GT(result.blue, result.judged / 4);
    EXPECT_LT(result.blue, result.judged * 3 / 4);
    EXPECT_GE(result.agree, 0.98 * result.judged);
}

} // namespace
} // namespace lumorph
