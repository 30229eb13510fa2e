#include "app/studio/output/projector_window.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>

#include <QGuiApplication>
#include <QPointer>
#include <QScreen>
#include <QSignalSpy>
#include <QTest>
#include <QWindow>
#include <gtest/gtest.h>

#include "app/studio/document/scene_edit.h"
#include "app/studio/output/pattern_screen.h"
#include "app/studio/output/projector_outputs.h"
#include "app/studio/shell/escape_twice.h"
#include "calibration/patterns/capture_order.h"
#include "core/render/gl/headless_context.h"
#include "core/render/spatial_renderer.h"
#include "event_loop.h"
#include "show_fixture.h"

// Runs again at desktop scales 1.25 and 1.5.

namespace lumorph::studio {
namespace {

using namespace std::chrono_literals;
using test::eventually;

/// The studio's parts that projector outputs need, without its window.
class ProjectorOutput : public testing::Test {
protected:
    void SetUp() override {
        StudioState state;
        state.rig.rig = showFrame()->rig;
        state.scene = showFrame()->scene;
        state.installation = showFrame()->installation;
        state.assets = showFrame()->assets;
        document.reset(state, {});
        setProjectorSize(screenPixels());
    }
    void setProjectorSize(QSize size) {
        document.change("Size", [size](StudioState& state) {
            installationToEdit(state).projectors.front().camera.size = {size.width(), size.height()};
        });
    }
    /// What really is on the screen, asked from the display server.
    static QImage onScreen() {
        return QGuiApplication::primaryScreen()->grabWindow(0).toImage().convertToFormat(QImage::Format_RGB32);
    }
    static QSize screenPixels() { return onScreen().size(); }
    static QString screenName() { return QGuiApplication::primaryScreen()->name(); }
    ProjectorWindow* cover() {
        outputs.showOnScreen(0, screenName());
        ProjectorWindow* window = outputs.window(0);
        if (window == nullptr) return nullptr;
        EXPECT_TRUE(QTest::qWaitForWindowActive(window));
        // The window manager says that it is full screen before it gives it the screen's size.
        EXPECT_TRUE(
            eventually([&] { return window->isFullScreen() && window->size() == window->screen()->size(); }, 5s));
        return window;
    }

    StudioDocument document;
    StudioLoop loop{document};
    Notices notices;
    Commands commands;
    RenderThread renderer;
    ShowFeed feed{loop, renderer, notices};
    std::unique_ptr<ProjectorOutputs> all = std::make_unique<ProjectorOutputs>(document, feed, commands, notices);
    ProjectorOutputs& outputs = *all;
};

/// The grab without its dots per inch, which are none of our business.
bool samePixels(const QImage& a, const QImage& b) {
    if (a.size() != b.size()) return false;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x)
            if (((a.pixel(x, y) ^ b.pixel(x, y)) & 0xFFFFFFU) != 0) return false;
    return true;
}

TEST_F(ProjectorOutput, OnePixelOfThePictureIsOnePixelOfTheScreen) {
    outputs.setPattern(TestPattern::checkerboard);
    ASSERT_NE(cover(), nullptr);
    const QImage wanted = testPattern(TestPattern::checkerboard, screenPixels());
    EXPECT_TRUE(eventually([&] { return samePixels(onScreen(), wanted); }, 5s))
        << "at scale " << QGuiApplication::primaryScreen()->devicePixelRatio();
    // The frame of the grid lies at the very edge.
    outputs.setPattern(TestPattern::grid);
    EXPECT_TRUE(eventually([&] { return samePixels(onScreen(), testPattern(TestPattern::grid, screenPixels())); }, 5s));
    EXPECT_TRUE(notices.at("output").empty());
}

/// A job that shows patterns, while the window's thread goes on.
template <typename Work> void inAnotherThread(const Work& work) {
    std::atomic<bool> done = false;
    std::jthread thread([&] {
        work();
        done = true;
    });
    EXPECT_TRUE(eventually([&] { return done.load(); }, 20s));
}

TEST_F(ProjectorOutput, AcknowledgedPatternIsOnTheScreen) {
    ASSERT_NE(cover(), nullptr);
    const QSize size = screenPixels();
    PatternScreen screen(outputs, 0);
    ASSERT_EQ(screen.size(), cv::Size(size.width(), size.height()));
    const CaptureOrder order = parsePattern("graycode", screen.size());
    int shown = 0;
    std::vector<double> waits;
    for (std::size_t i = 0; i < order.images.size(); i += 3) {
        const cv::Mat pattern = drawPattern(order.images[i], order.projector);
        bool isThere = false;
        inAnotherThread([&] {
            const auto begun = std::chrono::steady_clock::now();
            screen.show(pattern, {});
            waits.push_back(
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count());
            // Asked of the server at once, before the window's thread does anything more.
            QMetaObject::invokeMethod(
                &document,
                [&] {
                    const QImage there = onScreen();
                    isThere = there.size() == size;
                    for (int y = 0; y < size.height() && isThere; ++y)
                        for (int x = 0; x < size.width() && isThere; ++x)
                            isThere = qGray(there.pixel(x, y)) == pattern.at<uchar>(y, x);
                },
                Qt::BlockingQueuedConnection);
        });
        EXPECT_TRUE(isThere) << wordsOf(order.images[i]);
        ++shown;
    }
    EXPECT_GE(shown, 12);
    std::ranges::sort(waits);
    std::printf("from show to acknowledgement: median %.1f ms, longest %.1f ms\n", waits[waits.size() / 2],
                waits.back());
}

TEST_F(ProjectorOutput, PatternsGoWhateverHappens) {
    ProjectorWindow* window = cover();
    ASSERT_NE(window, nullptr);
    outputs.setPattern(TestPattern::white);
    const QColor white(Qt::white);
    const auto middle = [&] { return onScreen().pixelColor(screenPixels().width() / 2, screenPixels().height() / 2); };
    {
        PatternScreen screen(outputs, 0);
        const cv::Mat black = cv::Mat::zeros(screen.size(), CV_8U);
        inAnotherThread([&] { screen.show(black, {}); });
        // The window manager may still be at work on a window that has just covered the screen.
        EXPECT_TRUE(eventually([&] { return middle() == QColor(Qt::black); }, 5s)) << middle().name().toStdString();
        // Asked for by nobody who waits: a capture that was cancelled.
        std::stop_source stop;
        stop.request_stop();
        inAnotherThread([&] { EXPECT_THROW(screen.show(black, Progress({}, stop.get_token())), Cancelled); });
    }
    EXPECT_TRUE(eventually([&] { return middle() == white; }, 5s)) << "deleted";
    PatternScreen screen(outputs, 0);
    inAnotherThread([&] { EXPECT_THROW(screen.show(cv::Mat::zeros(7, 9, CV_8U), {}), InvalidInput); });
    inAnotherThread([&] { screen.show(cv::Mat::zeros(screen.size(), CV_8U), {}); });
    screen.clear();
    EXPECT_TRUE(eventually([&] { return middle() == white; }, 5s)) << "cleared";
    outputs.close(0);
    inAnotherThread([&] {
        try {
            screen.show(cv::Mat::zeros(screen.size(), CV_8U), {});
            ADD_FAILURE() << "the window is closed";
        } catch (const DeviceError& error) {
            EXPECT_NE(error.remedy().find("open"), std::string::npos) << error.what();
        }
    });
}

TEST_F(ProjectorOutput, PatternsNeedEveryPixelOfTheProjector) {
    EXPECT_THROW(PatternScreen(outputs, 0), DeviceError) << "not shown at all";
    setProjectorSize(screenPixels() - QSize(200, 100));
    const auto* window = cover();
    ASSERT_NE(window, nullptr);
    try {
        const PatternScreen screen(outputs, 0);
        ADD_FAILURE() << "another size";
    } catch (const DeviceError& error) {
        EXPECT_NE(error.remedy().find(std::to_string(window->pixels().width())), std::string::npos) << error.what();
    }
}

TEST_F(ProjectorOutput, AnotherSizeIsCentredAndNotScaled) {
    const QSize screen = screenPixels();
    const QSize small(screen.width() - 400, screen.height() - 200);
    setProjectorSize(small);
    outputs.setPattern(TestPattern::checkerboard);
    ASSERT_NE(cover(), nullptr);
    const QImage wanted = testPattern(TestPattern::checkerboard, small);
    EXPECT_TRUE(
        eventually([&] { return samePixels(onScreen().copy(200, 100, small.width(), small.height()), wanted); }, 5s));
    EXPECT_EQ(onScreen().pixelColor(199, 500), QColor(Qt::black));
    // The studio says so; the picture does not.
    ASSERT_TRUE(eventually([&] { return !notices.at("output").empty(); }, 5s));
    const auto told = notices.at("output");
    ASSERT_EQ(told.size(), 1U);
    EXPECT_TRUE(told.front().why.contains(QString::number(small.height()))) << told.front().why.toStdString();
    // On request it is scaled.
    outputs.setScaled(true);
    EXPECT_TRUE(eventually([&] { return onScreen().pixelColor(screen.width() / 2, 20) != QColor(Qt::black); }, 5s));
}

TEST_F(ProjectorOutput, EscapeLeavesTheScreenAndTwiceStops) {
    SteadyClock clock;
    EscapeTwice escape(clock);
    QSignalSpy stops(&escape, &EscapeTwice::pressed);
    ProjectorWindow* window = cover();
    ASSERT_NE(window, nullptr);
    EXPECT_EQ(window->cursor().shape(), Qt::BlankCursor);
    QTest::keyClick(window, Qt::Key_Escape);
    EXPECT_TRUE(eventually([&] { return !window->isFullScreen(); }, 5s));
    EXPECT_NE(window->cursor().shape(), Qt::BlankCursor);
    EXPECT_TRUE(stops.isEmpty());
    QTest::keyClick(window, Qt::Key_Escape);
    EXPECT_TRUE(eventually([&] { return stops.size() == 1; }, 5s));
}

TEST_F(ProjectorOutput, CommandsWorkWhileItHasTheKeyboard) {
    int before = 0, after = 0;
    commands.add("test.before", "Before", {{}, QKeySequence("Ctrl+J"), {}, {}, false}, [&] { ++before; });
    ProjectorWindow* window = cover();
    ASSERT_NE(window, nullptr);
    commands.add("test.after", "After", {{}, QKeySequence("Ctrl+L"), {}, {}, false}, [&] { ++after; });
    QTest::keyClick(window, Qt::Key_J, Qt::ControlModifier);
    QTest::keyClick(window, Qt::Key_L, Qt::ControlModifier);
    EXPECT_EQ(before, 1);
    EXPECT_EQ(after, 1);
}

TEST_F(ProjectorOutput, AnUnpluggedScreenTurnsItIntoAWindowWithAWayBack) {
    ProjectorWindow* window = cover();
    ASSERT_NE(window, nullptr);
    outputs.screenGone("another");
    EXPECT_TRUE(window->isFullScreen());
    emit qGuiApp->screenRemoved(QGuiApplication::primaryScreen()); // as Qt tells it
    EXPECT_TRUE(eventually([&] { return !window->isFullScreen() && window->isVisible(); }, 5s));
    const auto told = notices.at("output");
    ASSERT_EQ(told.size(), 1U);
    EXPECT_TRUE(told.front().why.contains(screenName()));
    ASSERT_EQ(told.front().actions.size(), 1U);
    told.front().actions.front().run();
    EXPECT_TRUE(eventually([&] { return window->isFullScreen(); }, 5s));
}

TEST_F(ProjectorOutput, TheStudiosOwnScreenIsNotCoveredWithoutAsking) {
    QWidget studio;
    studio.show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&studio));
    outputs.showOnScreen(0, screenName());
    EXPECT_EQ(outputs.window(0), nullptr);
    const auto told = notices.at("output");
    ASSERT_EQ(told.size(), 1U);
    ASSERT_EQ(told.front().actions.size(), 2U);
    told.front().actions.front().run();
    ASSERT_NE(outputs.window(0), nullptr);
    EXPECT_TRUE(eventually([&] { return outputs.window(0)->isFullScreen(); }, 5s));
    // Once is enough.
    outputs.close(0);
    outputs.showOnScreen(0, screenName());
    EXPECT_NE(outputs.window(0), nullptr);
}

TEST_F(ProjectorOutput, AWindowThatIsBeingClosedGoesBeforeTheFeed) {
    outputs.showInWindow(0);
    const QPointer<ProjectorWindow> first = outputs.window(0);
    ASSERT_NE(first, nullptr);
    first->close(); // as its user does
    EXPECT_EQ(outputs.window(0), nullptr);
    EXPECT_TRUE(eventually([&] { return first.isNull(); }, 5s));
    outputs.showInWindow(0);
    const QPointer<ProjectorWindow> second = outputs.window(0);
    ASSERT_NE(second, nullptr);
    outputs.close(0);
    all.reset(); // the program ends at once
    EXPECT_TRUE(second.isNull());
}

TEST_F(ProjectorOutput, ItsNumberIsShownForAWhile) {
    outputs.showInWindow(0);
    outputs.setPattern(TestPattern::white);
    ProjectorWindow* window = outputs.window(0);
    ASSERT_NE(window, nullptr);
    commands.find("output.identify")->trigger();
    EXPECT_EQ(window->picture(), numberPicture(1, screenPixels()));
    window->identify(50); // else three seconds
    EXPECT_TRUE(eventually([&] { return window->picture() == testPattern(TestPattern::white, screenPixels()); }, 5s));
}

TEST_F(ProjectorOutput, TheScenesPictureComesInTheProjectorsPixels) {
    setProjectorSize({800, 500});
    outputs.showInWindow(0);
    ProjectorWindow* window = outputs.window(0);
    ASSERT_NE(window, nullptr);
    EXPECT_TRUE(eventually([&] { return window->picture().size() == QSize(800, 500) && feed.newest().still; }));
    {
        const HeadlessContext context;
        SpatialRenderer alone;
        alone.setEyeSize({1280, 800});
        alone.draw(*feed.newest().frame);
        const Image sent = alone.readProjector(0);
        double difference = 0.0;
        double brightest = 0.0;
        for (int y = 0; y < 500; ++y)
            for (int x = 0; x < 800; ++x) {
                const QRgb pixel = window->picture().pixel(x, y);
                const Image::Pixel& own = sent.at(x, y);
                difference +=
                    std::abs(qRed(pixel) - own[0]) + std::abs(qGreen(pixel) - own[1]) + std::abs(qBlue(pixel) - own[2]);
                brightest = std::max<double>(brightest, own[1]);
            }
        EXPECT_LT(difference / (3.0 * 800 * 500), 1.0);
        EXPECT_GT(brightest, 100.0);
    }
    // The room loses its projector, and gets it back.
    editInstallation(document, "Remove", [](Installation& installation) { installation.projectors.clear(); });
    EXPECT_TRUE(eventually([&] { return window->picture().isNull(); }, 5s));
    document.undoStack().undo();
    EXPECT_TRUE(eventually([&] { return window->picture().size() == QSize(800, 500); }));
    // Whoever closes the window closes the output.
    window->close();
    EXPECT_EQ(outputs.window(0), nullptr);
}

TEST(TestPatterns, AreWhatTheySay) {
    const QImage ramp = testPattern(TestPattern::ramp, {1024, 4});
    EXPECT_EQ(qRed(ramp.pixel(0, 0)), 0);
    EXPECT_EQ(qRed(ramp.pixel(1023, 3)), 255);
    EXPECT_EQ(qRed(ramp.pixel(512, 1)), 128);
    const QImage board = testPattern(TestPattern::checkerboard, {5, 3});
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x) EXPECT_EQ(qRed(board.pixel(x, y)), (x + y) % 2 == 0 ? 255 : 0);
    const QImage grid = testPattern(TestPattern::grid, {200, 100});
    for (const QPoint corner : {QPoint(0, 0), QPoint(199, 0), QPoint(0, 99), QPoint(199, 99), QPoint(77, 0)})
        EXPECT_EQ(grid.pixelColor(corner), QColor(Qt::white));
}

} // namespace
} // namespace lumorph::studio
