#include "app/studio/rendering/frame_reader.h"

#include <array>

#include <gtest/gtest.h>

#include "core/render/gl/headless_context.h"

namespace lumorph::studio {
namespace {

// A quarter of the frame in each colour, lower left first as OpenGL counts.
void paintQuarters(unsigned framebuffer, QSize size) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glEnable(GL_SCISSOR_TEST);
    const int w = size.width() / 2;
    const int h = size.height() / 2;
    constexpr std::array<std::array<float, 3>, 4> colors{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}}};
    for (int i = 0; i < 4; ++i) {
        glScissor(i % 2 * w, i / 2 * h, w, h);
        const auto& c = colors[static_cast<std::size_t>(i)];
        glClearColor(c[0], c[1], c[2], 1.0F);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
}

class FrameReaderTest : public testing::TestWithParam<ReadBack> {
protected:
    HeadlessContext context;
    ImagePool pool;
};
INSTANTIATE_TEST_SUITE_P(Ways, FrameReaderTest, testing::Values(ReadBack::direct, ReadBack::buffered));

TEST_P(FrameReaderTest, ThePictureIsUprightInTheRightColoursAndScaled) {
    FrameReader reader(GetParam(), pool);
    for (const QSize drawn : {QSize(64, 48), QSize(32, 24)}) {
        paintQuarters(reader.framebuffer(drawn), drawn);
        reader.start({64, 48});
        EXPECT_TRUE(reader.started());
        const QImage image = reader.collect();
        EXPECT_FALSE(reader.started());
        ASSERT_EQ(image.size(), QSize(64, 48));
        EXPECT_EQ(image.pixelColor(2, 45), QColor(255, 0, 0));
        EXPECT_EQ(image.pixelColor(61, 45), QColor(0, 255, 0));
        EXPECT_EQ(image.pixelColor(2, 2), QColor(0, 0, 255));
        EXPECT_EQ(image.pixelColor(61, 2), QColor(255, 255, 0));
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_P(FrameReaderTest, AStreamOfFramesAllocatesNothing) {
    FrameReader reader(GetParam(), pool);
    QImage shown;
    for (int i = 0; i < 100; ++i) {
        paintQuarters(reader.framebuffer({64, 48}), {64, 48});
        reader.start({64, 48});
        shown = reader.collect();
    }
    EXPECT_LE(pool.allocations(), 3U);
    const std::size_t objects = reader.objectCount();
    for (const QSize size : {QSize(20, 30), QSize(300, 20), QSize(64, 48)}) {
        (void)reader.framebuffer(size);
        reader.start(size);
        (void)reader.collect();
    }
    EXPECT_EQ(reader.objectCount(), objects);
}

TEST(ImagePool, AnImageOutlivesItsPool) {
    QImage image;
    {
        ImagePool pool;
        image = pool.take({10, 10});
        image.fill(Qt::red);
    }
    EXPECT_EQ(image.pixelColor(9, 9), QColor(Qt::red));
}

} // namespace
} // namespace lumorph::studio
