#include "app/studio/rendering/render_thread.h"

#include <set>

#include <QSignalSpy>

#include "viewport_fixture.h"

namespace lumorph::studio {
namespace {

constexpr glm::vec3 kRedTriangle{0.9F, 0.08F, 0.08F};

ViewCamera camera() {
    ViewCamera made;
    made.yaw = Angle::degrees(25.0);
    made.pitch = Angle::degrees(20.0);
    made.distance = 0.5;
    return made;
}

class RenderThreadTest : public testing::Test {
protected:
    // The first context of a program takes long in software GL while other programs draw too.
    void SetUp() override {
        ASSERT_TRUE(waitFor([this] { return !ready.isEmpty(); }, 60'000));
    }

    // The frame in full quality that answers a request.
    DrawnFrame still(int viewport, FrameRequest request) {
        DrawnFrame last;
        thread.request(viewport, std::move(request));
        EXPECT_TRUE(waitFor([&] {
            if (auto frame = thread.takeFrame(viewport)) last = std::move(*frame);
            return last.still;
        }));
        return last;
    }

    RenderThread thread;
    QSignalSpy ready{&thread, &RenderThread::ready};
};

void expectCubeAt(const QImage& image, const ViewCamera& from, const glm::vec3& centre, float side) {
    const QRect seen = redPart(image);
    const QRectF expected = cubePart(from, centre, side, {image.width(), image.height()});
    EXPECT_NEAR(seen.left(), expected.left(), 2.0);
    EXPECT_NEAR(seen.right() + 1, expected.right(), 2.0);
    EXPECT_NEAR(seen.top(), expected.top(), 2.0);
    EXPECT_NEAR(seen.bottom() + 1, expected.bottom(), 2.0);
}

TEST_F(RenderThreadTest, ACubeIsSeenWhereTheCameraSays) {
    EXPECT_FALSE(thread.failure());
    // Off the middle: a picture that is upside down or mirrored would show.
    const glm::vec3 centre(0.04F, 0.05F, 0.0F);
    for (const bool orthographic : {false, true}) {
        ViewCamera from = camera();
        from.orthographic = orthographic;
        const auto scene = cubeScene(centre, 0.06F, kRedTriangle);
        const DrawnFrame frame = still(1, {scene, from, {640, 401}, 1.0, true});
        EXPECT_EQ(frame.image.size(), QSize(640, 401));
        EXPECT_EQ(frame.scene, scene);
        EXPECT_EQ(frame.camera, from);
        expectCubeAt(frame.image, from, centre, 0.06F);
    }
    EXPECT_EQ(thread.errorCount(), 0U);
}

TEST_F(RenderThreadTest, EachViewportGetsItsOwnFrames) {
    thread.request(1, {cubeScene({0, 0, 0}, 0.05F, kRedTriangle), camera(), {300, 200}, 1.0, true});
    thread.request(2, {cubeScene({0.05F, 0, 0}, 0.08F, kRedTriangle), camera(), {411, 333}, 1.0, true});
    std::map<int, DrawnFrame> got;
    ASSERT_TRUE(waitFor([&] {
        for (const int viewport : {1, 2})
            if (auto frame = thread.takeFrame(viewport)) got[viewport] = *frame;
        return got[1].still && got[2].still;
    }));
    expectCubeAt(got[1].image, camera(), {0, 0, 0}, 0.05F);
    expectCubeAt(got[2].image, camera(), {0.05F, 0, 0}, 0.08F);
}

TEST_F(RenderThreadTest, OnlyTheNewestRequestCounts) {
    std::shared_ptr<ViewportScene> last;
    for (int i = 0; i < 50; ++i) {
        last = cubeScene({0, 0, 0}, 0.02F + 0.001F * static_cast<float>(i), kRedTriangle);
        thread.request(1, {last, camera(), {320, 240}, 1.0, true});
    }
    std::set<const ViewportScene*> shown;
    ASSERT_TRUE(waitFor([&] {
        const auto frame = thread.takeFrame(1);
        if (frame) shown.insert(frame->scene.get());
        return frame && frame->still && frame->scene == last;
    }));
    EXPECT_LT(shown.size(), 10U);
}

TEST_F(RenderThreadTest, AForgottenViewportGetsNoFrames) {
    QSignalSpy drawn(&thread, &RenderThread::drawn);
    const auto count = thread.objectCount();
    (void)still(1, {cubeScene({0, 0, 0}, 0.05F, kRedTriangle), camera(), {300, 200}, 1.0, true});
    thread.request(1, {cubeScene({0, 0, 0}, 0.05F, kRedTriangle), camera(), {300, 200}, 1.0, true});
    thread.forget(1);
    drawn.clear();
    EXPECT_FALSE(waitFor([&] { return thread.takeFrame(1).has_value(); }, 400));
    // Others go on.
    (void)still(2, {cubeScene({0, 0, 0}, 0.05F, kRedTriangle), camera(), {300, 200}, 1.0, true});
    EXPECT_GE(thread.objectCount(), count);
}

TEST_F(RenderThreadTest, APictureOfAnySizeComesWhole) {
    const glm::vec3 centre(0.03F, 0.02F, 0.0F);
    QImage picture;
    QString why;
    bool done = false;
    thread.picture({cubeScene(centre, 0.06F, kRedTriangle), camera(), {3000, 2000}, 1.0, true},
                   [&](const QImage& image, const QString& reason) {
                       picture = image;
                       why = reason;
                       done = true;
                   });
    ASSERT_TRUE(waitFor([&] { return done; }, 60000));
    EXPECT_EQ(why, QString());
    ASSERT_EQ(picture.size(), QSize(3000, 2000));
    expectCubeAt(picture, camera(), centre, 0.06F);
}

TEST_F(RenderThreadTest, APictureThatCannotBeSaysWhy) {
    for (const QSize size : {QSize(0, 100), QSize(20000, 100)}) {
        QImage picture(1, 1, QImage::Format_RGB32);
        QString why;
        thread.picture({cubeScene({0, 0, 0}, 0.06F, kRedTriangle), camera(), size, 1.0, true},
                       [&](const QImage& image, const QString& reason) {
                           picture = image;
                           why = reason;
                       });
        ASSERT_TRUE(waitFor([&] { return !why.isEmpty(); }));
        EXPECT_TRUE(picture.isNull());
        EXPECT_TRUE(why.contains(QStringLiteral("size"))) << why.toStdString();
    }
}

TEST_F(RenderThreadTest, ChangingScenesAndSizesKeepsNoOpenGlObjects) {
    std::size_t first = 0;
    for (int i = 0; i < 200; ++i) {
        const QSize size(200 + i % 3 * 20, 160);
        (void)size;
        const float side = 0.03F + 0.0002F * static_cast<float>(i);
        const auto scene = cubeScene({0, 0, 0}, side, kRedTriangle);
        thread.request(1, {scene, camera(), size, 1.0, i % 20 == 19});
        ASSERT_TRUE(waitFor([&] {
            const auto frame = thread.takeFrame(1);
            return frame && frame->scene == scene && (frame->still || i % 20 != 19);
        }));
        if (i == 39) first = thread.objectCount();
    }
    // Counted after the frame was handed over: wait until nothing is under way.
    (void)still(1, {cubeScene({0, 0, 0}, 0.05F, kRedTriangle), camera(), {200, 160}, 1.0, true});
    EXPECT_GT(first, 0U);
    EXPECT_TRUE(waitFor([&] { return thread.objectCount() <= first; }, 2000)) << thread.objectCount() << " " << first;
    EXPECT_EQ(thread.errorCount(), 0U);
}

} // namespace
} // namespace lumorph::studio
