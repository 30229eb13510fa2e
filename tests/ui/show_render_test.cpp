#include <epoxy/gl.h>

#include "app/studio/rendering/render_thread.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include <QSignalSpy>

#include "app/applications/water/water.h"
#include "app/studio/rendering/show_frames.h"
#include "app/studio/rendering/show_pace.h"
#include "app/workspaces/scene/item_pick.h"
#include "core/geometry/calibrated_camera.h"
#include "core/loop/show_stage.h"
#include "show_fixture.h"
#include "studio_window.h"
#include "viewport_fixture.h"

namespace lumorph::studio {
namespace {

using ViewKind = ShowView::Kind;

class ShowRender : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(waitFor([&] { return !ready.isEmpty(); }));
    }

    DrawnShow still(ShowRequest request) {
        DrawnShow last;
        const auto match = request.match;
        thread.requestShow(std::move(request));
        EXPECT_TRUE(waitFor([&] {
            if (auto shown = thread.takeShow()) last = std::move(*shown);
            return last.still && last.match == match;
        }));
        return last;
    }

    RenderThread thread;
    QSignalSpy ready{&thread, &RenderThread::ready};
    QSignalSpy broke{&thread, &RenderThread::showBroke};
};

ShowRequest requestOf(std::shared_ptr<const MatchFrame> match, std::vector<WantedView> views) {
    ShowRequest request;
    request.match = std::move(match);
    request.views = std::move(views);
    return request;
}

QImage pictureOf(const DrawnShow& shown, int id) {
    for (const DrawnShow::Picture& picture : shown.pictures)
        if (picture.id == id) return picture.image;
    return {};
}

double meanDifference(const QImage& a, const QImage& b) {
    if (a.size() != b.size()) return 255.0;
    double sum = 0.0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) {
            const QRgb p = a.pixel(x, y), q = b.pixel(x, y);
            sum += std::abs(qRed(p) - qRed(q)) + std::abs(qGreen(p) - qGreen(q)) + std::abs(qBlue(p) - qBlue(q));
        }
    return sum / (3.0 * a.width() * a.height());
}

/// Where the corners of the fixture's box fall, by the calibrated camera's own arithmetic.
QRectF boxPart(const ShowFrame& frame, const CalibratedCamera& camera) {
    const Box box = boxOf(frame, 900);
    QRectF part;
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec3 corner(i & 1U ? box.max.x : box.min.x, i & 2U ? box.max.y : box.min.y,
                               i & 4U ? box.max.z : box.min.z);
        const glm::dvec2 at = pixelOf(camera, glm::dvec3(corner)).value() + 0.5;
        const QRectF point(at.x, at.y, 1e-3, 1e-3);
        part = part.isNull() ? point : part.united(point);
    }
    return part;
}

TEST_F(ShowRender, TheEyeSeesTheBoxWhereItsCameraSays) {
    // Off the middle: a picture that is upside down or mirrored would show.
    const auto match = showFrame(0.05F);
    const DrawnShow shown = still(requestOf(match, {wantedView(1, ViewKind::eye, {640, 400})}));
    const QImage eye = pictureOf(shown, 1);
    ASSERT_EQ(eye.size(), QSize(640, 400));
    ASSERT_TRUE(shown.frame);
    const QRect seen = redPart(eye);
    const QRectF expected = boxPart(*shown.frame, deviceView(*shown.frame, viewerOf(*shown.frame), {640, 400}));
    EXPECT_NEAR(seen.left(), expected.left(), 3.0);
    EXPECT_NEAR(seen.right() + 1, expected.right(), 3.0);
    EXPECT_NEAR(seen.top(), expected.top(), 3.0);
    EXPECT_NEAR(seen.bottom() + 1, expected.bottom(), 3.0);
    EXPECT_EQ(thread.errorCount(), 0U);
    EXPECT_TRUE(broke.isEmpty());
}

TEST_F(ShowRender, EachViewHasItsOwnSizeAndTheProjectorAllItsPixels) {
    WantedView exact = wantedView(3, ViewKind::projector, {300, 300});
    exact.view.exact = true;
    const auto match = showFrame();
    const glm::ivec2 own = match->installation->projectors.front().camera.size;
    const DrawnShow shown = still(
        requestOf(match, {wantedView(1, ViewKind::eye, {500, 301}), wantedView(2, ViewKind::projector, {300, 300}),
                          exact, wantedView(4, ViewKind::lab, {411, 333})}));
    EXPECT_EQ(pictureOf(shown, 1).size(), QSize(500, 301));
    EXPECT_EQ(pictureOf(shown, 2).width(), 300);
    EXPECT_NEAR(pictureOf(shown, 2).height(), 300.0 * own.y / own.x, 1.0);
    EXPECT_EQ(pictureOf(shown, 3).size(), QSize(own.x, own.y));
    EXPECT_EQ(pictureOf(shown, 4).size(), QSize(411, 333));
    EXPECT_EQ(thread.errorCount(), 0U);
}

TEST_F(ShowRender, ViewsOfOneFrameAgree) {
    const auto match = showFrame();
    const DrawnShow shown =
        still(requestOf(match, {wantedView(1, ViewKind::eye, {480, 300}), wantedView(2, ViewKind::eye, {480, 300}),
                                wantedView(3, ViewKind::lab, {480, 300})}));
    EXPECT_EQ(pictureOf(shown, 1), pictureOf(shown, 2));
    // What is lit looks like what is to be seen, as far as a projector can make it.
    EXPECT_LT(meanDifference(pictureOf(shown, 1), pictureOf(shown, 3)), 40.0);
    const DrawnShow alone = still(requestOf(showFrame(), {wantedView(1, ViewKind::eye, {480, 300})}));
    EXPECT_LT(meanDifference(pictureOf(shown, 1), pictureOf(alone, 1)), 0.5);
}

TEST_F(ShowRender, OnlyTheNewestFrameCounts) {
    std::shared_ptr<MatchFrame> last;
    for (std::uint64_t i = 1; i <= 60; ++i) {
        last = showFrame(0.001F * static_cast<float>(i), i);
        thread.requestShow(requestOf(last, {wantedView(1, ViewKind::eye, {320, 200})}));
    }
    int frames = 0;
    ASSERT_TRUE(waitFor([&] {
        const auto shown = thread.takeShow();
        frames += shown ? 1 : 0;
        return shown && shown->still && shown->match == last;
    }));
    EXPECT_LT(frames, 20);
}

TEST_F(ShowRender, ZeroSizesAndEmptyRequestsAskForNothing) {
    thread.requestShow(requestOf(showFrame(), {wantedView(1, ViewKind::eye, {0, 200})}));
    thread.requestShow(requestOf(nullptr, {wantedView(1, ViewKind::eye, {320, 200})}));
    auto noScene = showFrame();
    noScene->scene.reset();
    thread.requestShow(requestOf(noScene, {wantedView(1, ViewKind::eye, {320, 200})}));
    EXPECT_FALSE(waitFor([&] { return thread.takeShow().has_value(); }, 300));
    EXPECT_TRUE(broke.isEmpty());
}

TEST_F(ShowRender, ComparingBendsChangesTheDeviceAlone) {
    auto match = showFrame();
    WantedView flat = wantedView(1, ViewKind::lab, {480, 300}), bent = wantedView(2, ViewKind::lab, {480, 300});
    flat.view.bend = ShowView::Bend::without;
    bent.view.bend = ShowView::Bend::forViewer;
    match->eye = glm::vec3(0.0F, 0.15F, 0.7F); // low: much is bent
    const DrawnShow shown = still(requestOf(match, {flat, bent}));
    EXPECT_GT(meanDifference(pictureOf(shown, 1), pictureOf(shown, 2)), 2.0);
    // Both are seen by one camera: what lies before the device is the same.
    const QRect before(0, 270, 480, 30);
    EXPECT_LT(meanDifference(pictureOf(shown, 1).copy(before), pictureOf(shown, 2).copy(before)), 1.0);
}

TEST_F(ShowRender, AFrameThatCannotBeDrawnIsToldOnceAndTheNextIsDrawn) {
    auto broken = showFrame();
    auto installation = std::make_shared<Installation>(*broken->installation);
    installation->projectors.front().camera.size = {0, 0};
    broken->installation = installation;
    thread.requestShow(requestOf(broken, {wantedView(1, ViewKind::lab, {320, 200})}));
    ASSERT_TRUE(waitFor([&] { return !broke.isEmpty(); }));
    EXPECT_FALSE(broke.front().front().toString().isEmpty());
    const auto good = showFrame();
    ASSERT_TRUE(waitFor([&] {
        thread.requestShow(requestOf(good, {wantedView(1, ViewKind::lab, {320, 200})}));
        const auto shown = thread.takeShow();
        return shown && shown->match == good;
    }));
    EXPECT_EQ(broke.size(), 1);
}

std::atomic<int> resetsToTell = 0;

GLenum tellReset() {
    if (resetsToTell == 0) return GL_NO_ERROR;
    --resetsToTell;
    return GL_INNOCENT_CONTEXT_RESET;
}

/// What the driver says of resets is ours to say.
class DriverResets {
public:
    DriverResets() : asked_(std::exchange(epoxy_glGetGraphicsResetStatus, tellReset)) {}
    ~DriverResets() { epoxy_glGetGraphicsResetStatus = asked_; }
    DriverResets(const DriverResets&) = delete;
    DriverResets& operator=(const DriverResets&) = delete;

private:
    PFNGLGETGRAPHICSRESETSTATUSPROC asked_;
};

TEST(ShowRenderResets, TheShowComesBackByItself) {
    const DriverResets resets;
    RenderThread thread;
    const auto drawn = [&] {
        const auto match = showFrame();
        return waitFor([&] {
            thread.requestShow(requestOf(match, {wantedView(1, ViewKind::projector, {320, 200})}));
            const auto shown = thread.takeShow();
            return shown && shown->match == match && meanDifference(pictureOf(*shown, 1), QImage()) > 0.0;
        });
    };
    ASSERT_TRUE(drawn());
    EXPECT_FALSE(thread.failure());
    for (const int times : {1, 1, 3}) { // some come again at once
        const auto late = showFrame();
        resetsToTell = times;
        (void)waitFor([&] {
            if (thread.failure()) return true;
            const auto shown = thread.takeShow();
            EXPECT_FALSE(shown && shown->match == late) << "what a lost context draws is nothing to show";
            thread.requestShow(requestOf(late, {wantedView(1, ViewKind::projector, {320, 200})}));
            return false;
        });
        ASSERT_TRUE(thread.failure());
        EXPECT_TRUE(thread.failure()->contains("driver was reset")) << thread.failure()->toStdString();
        ASSERT_TRUE(waitFor([&] { return resetsToTell == 0 && !thread.failure(); }));
        EXPECT_TRUE(drawn());
    }
}

TEST(ShowRenderResets, APictureThatWasLostIsSaidToBe) {
    const DriverResets resets;
    RenderThread thread;
    FrameRequest request;
    request.scene = std::make_shared<const ViewportScene>();
    request.pixels = {64, 48};
    std::vector<std::pair<QImage, QString>> answers;
    const auto ask = [&] {
        thread.picture(request, [&](const QImage& image, const QString& why) { answers.emplace_back(image, why); });
        const std::size_t asked = answers.size();
        return waitFor([&] { return answers.size() > asked; });
    };
    ASSERT_TRUE(ask());
    EXPECT_FALSE(answers.back().first.isNull());
    resetsToTell = 1;
    ASSERT_TRUE(ask());
    EXPECT_TRUE(answers.back().first.isNull());
    EXPECT_TRUE(answers.back().second.contains("driver was reset")) << answers.back().second.toStdString();
    ASSERT_TRUE(waitFor([&] { return thread.failure().has_value(); }));
    ASSERT_TRUE(waitFor([&] { return !thread.failure(); }));
    ASSERT_TRUE(ask());
    EXPECT_FALSE(answers.back().first.isNull());
}

/// The same pictures as other objects, as after their files were read again.
std::shared_ptr<const SceneAssets> readAnew(const SceneAssets& assets) {
    auto anew = std::make_shared<SceneAssets>(assets);
    for (auto& [name, image] : anew->images) image = std::make_shared<const Image>(*image);
    return anew;
}

/// Frame `i` of a show in which all moves: time, device, eye and box; now and then the pictures are read anew.
std::shared_ptr<MatchFrame> busyFrame(int i, std::shared_ptr<const Scene> scene,
                                      std::shared_ptr<const SceneAssets> assets) {
    auto match = showFrame(0.0001F * static_cast<float>(i % 300), static_cast<std::uint64_t>(i));
    if (scene) match->scene = std::move(scene);
    if (assets) match->assets = std::move(assets);
    match->sceneSeconds = i / 30.0;
    for (std::size_t k = 0; k < match->estimatedStrokes.size(); ++k)
        match->estimatedStrokes[k] = 0.5 + 0.5 * std::sin(0.1 * i + static_cast<double>(k));
    auto positions = std::make_shared<std::vector<glm::vec3>>(*match->devicePositions);
    match->rig->deform(match->estimatedStrokes, *positions);
    match->devicePositions = std::move(positions);
    match->eye->x = 0.1F * std::sin(0.07F * static_cast<float>(i));
    return match;
}

/// A session draws some hundred thousand frames: 10,000 of them with LUMORPH_SOAK=10.
class ShowRenderEndurance : public ShowRender {
protected:
    int frames = test::soakFactor() > 1 ? 1000 * test::soakFactor() : 200;

    void drawMany(const std::shared_ptr<const Scene>& scene) {
        auto assets = scene ? loadSceneAssets(*scene, {}) : showFrame()->assets;
        std::size_t objects = 0;
        std::vector<double> allocated, resident; // megabytes, of pictures in full, from frame 100 on
        for (int i = 0; i < frames; ++i) {
            if (i % 10 == 9) assets = readAnew(*assets);
            const bool full = i % 25 == 0;
            draw(busyFrame(i, scene, assets), full);
            ASSERT_FALSE(HasFailure()) << "frame " << i;
            // How coarse a moving picture is, and so its memory, is the machine's: those in full are compared.
            if (full && i >= 100) {
                allocated.push_back(std::numeric_limits<double>::max());
                resident.push_back(std::numeric_limits<double>::max());
                // Pictures that another test's load holds up in flight only add: the least of some looks is what stays.
                for (int look = 0; look < 8; ++look) {
                    test::pass(std::chrono::milliseconds(50));
                    allocated.back() = std::min(allocated.back(), test::allocatedMegabytes());
                    resident.back() = std::min(resident.back(), test::residentMegabytes());
                }
            }
            if (i == 100) objects = thread.objectCount();
            if (i % 1000 == 0) std::printf("frame %d: %.1f MB\n", i, test::residentMegabytes());
        }
        // The same again, after the same: what earlier frames needed stays a little.
        for (int again = 76; again <= 100; ++again) {
            if (again % 10 == 9) assets = readAnew(*assets);
            draw(busyFrame(again, scene, assets), again == 100);
        }
        std::printf("%zu objects at frame 100, %zu at %d\n", objects, thread.objectCount(), frames);
        expectFlat("allocated", allocated, 6.0); // one picture may still be kept in one half alone: 4.5 MB
        // Holes in the heap come and go with the order of two threads, 8 MB were seen; this one is for what a driver
        // maps by itself, and for the 10,000.
        expectFlat("resident", resident, 16.0);
        EXPECT_GT(objects, 0U);
        EXPECT_TRUE(waitFor([&] { return thread.objectCount() == objects; }, 2000)) << thread.objectCount();
        EXPECT_EQ(thread.errorCount(), 0U);
        EXPECT_TRUE(broke.isEmpty());
    }

private:
    /// What a sample finds still in flight only adds: what stays is the least of each half.
    static void expectFlat(const char* what, const std::vector<double>& megabytes, double growth) {
        const auto half = megabytes.begin() + std::ssize(megabytes) / 2;
        const double early = *std::min_element(megabytes.begin(), half),
                     late = *std::min_element(half, megabytes.end());
        std::printf("%s: at least %.2f MB in the first half, %.2f MB in the last\n", what, early, late);
        EXPECT_LT(late - early, growth) << what;
    }
    /// Waits for the picture, and for all its pixels where it is wanted in `full`.
    void draw(const std::shared_ptr<MatchFrame>& match, bool full) {
        ShowRequest request =
            requestOf(match, {wantedView(1, ViewKind::eye, {160, 100}), wantedView(2, ViewKind::lab, {120, 90}),
                              wantedView(3, ViewKind::projector, {160, 100})});
        request.refine = full;
        thread.requestShow(request);
        ASSERT_TRUE(waitFor([&] {
            const auto shown = thread.takeShow();
            return shown && shown->match == match && (!full || shown->still);
        }));
    }
};

TEST_F(ShowRenderEndurance, ManyFramesLeaveObjectsAndMemoryFlat) { drawMany(nullptr); }

TEST_F(ShowRenderEndurance, ManyFramesOfTheSeaLeaveObjectsAndMemoryFlat) {
    if (test::soakFactor() <= 1) GTEST_SKIP() << "minutes of waves: LUMORPH_SOAK=5";
    drawMany(std::make_shared<const Scene>(waterScene()));
}

TEST(ShowPaceTest, CoarserWhileItTakesLongAndFullWhenQuiet) {
    ShowPace pace;
    const auto start = ShowPace::Time(std::chrono::seconds(10));
    const auto ask = [&](int at) {
        ShowRequest request;
        request.views.push_back(wantedView(1, ViewKind::eye, {100, 100}));
        pace.request(std::move(request), start + std::chrono::milliseconds(at));
    };
    // Three times what there is: a third of the pixels, at once.
    for (int i = 0; i < 3; ++i) {
        ask(i);
        const auto work = pace.nextMoving();
        ASSERT_TRUE(work);
        EXPECT_EQ(work->resolution, 1.0);
        pace.finished(*work, 3.0 * ShowPace::kBudgetMilliseconds);
    }
    ask(3);
    const auto work = pace.nextMoving();
    ASSERT_TRUE(work);
    EXPECT_NEAR(work->resolution, 0.97 / std::sqrt(3.0), 0.03);
    EXPECT_FALSE(pace.pressing());
    EXPECT_FALSE(pace.nextStill(start + std::chrono::milliseconds(100)));
    const auto full = pace.nextStill(start + std::chrono::milliseconds(3) + ShowPace::kQuiet);
    ASSERT_TRUE(full);
    EXPECT_EQ(full->resolution, 1.0);
    EXPECT_FALSE(pace.nextStill(start + std::chrono::seconds(60)));
    // It ends at half, and comes back when there is time.
    double lowest = 1.0;
    for (int i = 0; i < 40; ++i) {
        ask(i);
        const auto slow = pace.nextMoving();
        pace.finished(*slow, 400.0);
        lowest = std::min(lowest, slow->resolution);
    }
    EXPECT_EQ(lowest, ShowPace::kLowestResolution);
    for (int i = 0; i < 40; ++i) {
        ask(i);
        pace.finished(*pace.nextMoving(), 5.0);
    }
    ask(99);
    EXPECT_EQ(pace.nextMoving()->resolution, 1.0);
}

// Each size of the pictures takes memory of its own: however long frames take, there are few.
TEST(ShowPaceTest, ResolutionGoesInTwentieths) {
    ShowPace pace;
    std::set<double> seen;
    for (int i = 0; i < 400; ++i) {
        ShowRequest request;
        request.views.push_back(wantedView(1, ViewKind::eye, {100, 100}));
        pace.request(std::move(request), ShowPace::Time(std::chrono::milliseconds(i)));
        const auto work = pace.nextMoving();
        ASSERT_TRUE(work);
        EXPECT_NEAR(20.0 * work->resolution, std::round(20.0 * work->resolution), 1e-9);
        seen.insert(work->resolution);
        // From full to the lowest and back, smoothly.
        const double share = 1.0 + 0.9 * std::cos(0.05 * i);
        pace.finished(*work, share * work->resolution * work->resolution * 2.0 * ShowPace::kBudgetMilliseconds);
    }
    EXPECT_GE(seen.size(), 5U);
    EXPECT_LE(seen.size(), 11U); // from a half to 1
}

TEST(ShowFrames, AResizedCameraSeesTheSame) {
    CalibratedCamera camera = defaultInstallation().projectors.front().camera;
    const CalibratedCamera half = resized(camera, camera.size / 2);
    for (const glm::dvec3 point : {glm::dvec3(0.1, 0.0, 0.05), glm::dvec3(-0.1, 0.03, 0.0)}) {
        const glm::dvec2 whole = (pixelOf(camera, point).value() + 0.5) / glm::dvec2(camera.size);
        const glm::dvec2 small = (pixelOf(half, point).value() + 0.5) / glm::dvec2(half.size);
        EXPECT_NEAR(whole.x, small.x, 1e-9);
        EXPECT_NEAR(whole.y, small.y, 1e-9);
    }
}

} // namespace
} // namespace lumorph::studio
