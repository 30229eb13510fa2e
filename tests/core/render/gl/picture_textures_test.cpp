#include "core/render/gl/picture_textures.h"

#include <gtest/gtest.h>

#include "core/render/gl/headless_context.h"

namespace lumorph {
namespace {

using Use = PictureTextures::Use;

std::shared_ptr<const Image> picture(glm::ivec2 size, Image::Pixel fill = {200, 100, 50, 255}) {
    return std::make_shared<const Image>(size, fill);
}

/// What the driver itself has.
std::size_t liveTextures() {
    std::size_t count = 0;
    for (GLuint name = 1; name < 4000; ++name) count += glIsTexture(name);
    return count;
}

TEST(PictureTextures, SlowFlipBookUploadsEachCellOnce) {
    const HeadlessContext context;
    PictureTextures textures;
    const auto sheet = picture({8, 8});
    std::vector<GLuint> first;
    for (int cell = 0; cell < 4; ++cell) {
        for (int round = 0; round < 300; ++round) {
            textures.sweep();
            const auto shown = textures.picture(sheet, Use::color, {2, 2}, cell);
            if (round == 0) first.push_back(shown.texture);
        }
    }
    EXPECT_EQ(textures.objectCount(), 4U);
    EXPECT_EQ(liveTextures(), 4U);
    for (int cell = 0; cell < 4; ++cell)
        EXPECT_EQ(textures.picture(sheet, Use::color, {2, 2}, cell).texture, first[static_cast<std::size_t>(cell)]);
}

TEST(PictureTextures, EndlessFlipBookKeepsTheCellsShownLast) {
    const HeadlessContext context;
    PictureTextures textures;
    const auto sheet = picture({32, 32});
    for (int cell = 0; cell < 1024; ++cell) {
        textures.sweep();
        const auto shown = textures.picture(sheet, Use::color, {32, 32}, cell);
        ASSERT_TRUE(glIsTexture(shown.texture)) << cell;
        ASSERT_LE(textures.objectCount(), PictureTextures::kMostCells) << cell;
    }
    EXPECT_EQ(liveTextures(), PictureTextures::kMostCells);
    (void)textures.picture(sheet, Use::color, {32, 32}, 1024 - static_cast<int>(PictureTextures::kMostCells));
    EXPECT_EQ(liveTextures(), PictureTextures::kMostCells);
}

TEST(PictureTextures, PicturesReadAnewReplaceThoseBefore) {
    const HeadlessContext context;
    PictureTextures textures;
    const auto kept = picture({4, 4});
    const GLuint texture = textures.picture(kept, Use::data).texture;
    std::weak_ptr<const Image> before;
    for (int i = 0; i < 20; ++i) {
        const auto anew = picture({4, 4});
        textures.sweep();
        textures.keepOnly({kept.get(), anew.get()});
        EXPECT_TRUE(before.expired()) << i;
        (void)textures.picture(anew, Use::color);
        (void)textures.picture(anew, Use::data);
        EXPECT_EQ(textures.picture(kept, Use::data).texture, texture);
        EXPECT_EQ(textures.objectCount(), 3U);
        EXPECT_EQ(liveTextures(), 3U);
        before = anew;
    }
}

TEST(PictureTextures, HiddenPicturesAreForgottenAfterAWhile) {
    const HeadlessContext context;
    PictureTextures textures;
    const auto hidden = picture({4, 4});
    (void)textures.picture(hidden, Use::color);
    for (int i = 0; i < 200; ++i) textures.sweep();
    EXPECT_EQ(textures.objectCount(), 1U);
    for (int i = 0; i < 100; ++i) textures.sweep();
    EXPECT_EQ(liveTextures(), 0U);
    EXPECT_EQ(hidden.use_count(), 1);
}

} // namespace
} // namespace lumorph
