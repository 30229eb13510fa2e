#include <ctime>
#include <memory>

#include <QElapsedTimer>
#include <QEventLoop>
#include <QTimer>

#include "app/applications/demo.h"
#include "app/studio/shell/applications_page.h"
#include "app/workspaces/scene/view_pane.h"
#include "core/base/clock.h"
#include "tests/ui/studio_window.h"

// What nobody sees is not drawn. The judge is the processor time of the whole program, drawing threads included, which
// does not depend on what else the machine does.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;
using studio::ViewPane;

double processorSeconds() {
    timespec used{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

/// Share of a core that the program takes over some time, in which the test itself only waits.
double processorShare(std::chrono::milliseconds time) {
    QElapsedTimer elapsed;
    elapsed.start();
    const double before = processorSeconds();
    QEventLoop waits;
    QTimer::singleShot(time, &waits, &QEventLoop::quit);
    waits.exec();
    return 1e3 * (processorSeconds() - before) / static_cast<double>(elapsed.elapsed());
}

/// Whether it comes to rest within half a minute.
testing::AssertionResult rests() {
    constexpr double kMost = 0.01;
    double share = 1.0;
    for (int tries = 0; tries < 10 && share > kMost; ++tries) share = processorShare(2s);
    if (share <= kMost) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "it takes " << 100.0 * share << " % of a core";
}

/// One window for all, which shows a sea that never stands still.
class Unseen : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        window_ = std::make_unique<StudioWindow>(folder_->path(), "scene");
        window_->studio().project.openDemo("water");
    }
    static void TearDownTestSuite() {
        window_.reset();
        folder_.reset();
    }
    void SetUp() override {
        ASSERT_TRUE(eventually([&] {
            const Demo* demo = studio().project.demo();
            return demo != nullptr && demo->name == "water" && studio().jobs.running().empty();
        }));
        window().window().showWorkspace("scene");
        ASSERT_TRUE(draws());
    }

    static StudioWindow& window() { return *window_; }
    static studio::Studio& studio() { return window_->studio(); }
    /// Frames of the loop come, newer ones than now, and pictures of them.
    [[nodiscard]] static bool draws() {
        const Microseconds now = SteadyClock().now();
        return eventually([&] {
            const auto& match = studio().show.newest().match;
            return match && match->time > now && studio().loop.frame()->time > match->time;
        });
    }
    /// What is on the screen when the window comes back is a picture, and soon one of now.
    static void seenAgain() {
        EXPECT_FALSE(eye().grab().toImage().isNull());
        EXPECT_TRUE(draws());
    }
    [[nodiscard]] static ViewPane& eye() { return *window().find<ViewPane>("scene.eye"); }

private:
    inline static std::unique_ptr<TemporaryFolder> folder_;
    inline static std::unique_ptr<StudioWindow> window_;
};

TEST_F(Unseen, AMinimisedWindowDrawsNothing) {
    EXPECT_GT(processorShare(1s), 0.05) << "seen, it draws";
    window().window().showMinimized();
    EXPECT_TRUE(rests());
    EXPECT_TRUE(studio().loop.paused());
    window().window().showNormal();
    seenAgain();
    EXPECT_GT(processorShare(1s), 0.05) << "seen again, it draws again";
}

TEST_F(Unseen, NothingIsDrawnBelowTheCards) {
    window().click("bar.applications");
    auto* cards = window().find<studio::ApplicationsPage>("applications");
    ASSERT_NE(cards, nullptr);
    EXPECT_TRUE(rests());
    QTest::keyClick(cards, Qt::Key_Escape);
    ASSERT_TRUE(eventually([&] { return window().findNow<studio::ApplicationsPage>("applications") == nullptr; }));
    seenAgain();
}

TEST_F(Unseen, NothingIsDrawnBehindAWindowThatCoversIt) {
    // As another program's window: this one's keyboard is not taken, and no desktop reports it.
    QWidget other(nullptr, Qt::Window | Qt::X11BypassWindowManagerHint);
    other.setAttribute(Qt::WA_ShowWithoutActivating);
    other.setGeometry(other.screen()->geometry());
    other.show();
    other.raise();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(&other));
    EXPECT_TRUE(rests());
    other.hide();
    seenAgain();
}

TEST_F(Unseen, NothingIsDrawnInAnotherWorkspaceEither) {
    for (const char* workspace : {"field", "rig"}) {
        window().window().showWorkspace(workspace);
        window().window().showMinimized();
        EXPECT_TRUE(rests()) << workspace;
        window().window().showNormal();
        ASSERT_TRUE(QTest::qWaitForWindowExposed(&window().window()));
    }
}

TEST_F(Unseen, AProjectorsWindowGoesOnWithoutTheStudios) {
    studio().outputs.showInWindow(0);
    auto* output = window().find<QWidget>("output.projector1");
    ASSERT_NE(output, nullptr);
    window().window().showMinimized();
    ASSERT_TRUE(eventually([&] { return window().window().isMinimized(); }));
    EXPECT_TRUE(draws());
    EXPECT_FALSE(studio().loop.paused());
    studio().outputs.closeAll();
    EXPECT_TRUE(rests());
    window().window().showNormal();
}

TEST_F(Unseen, ServosGoOnFollowingWithoutTheWindow) {
    studio().devices.connectTo("sim://uno");
    ASSERT_TRUE(eventually([&] { return studio().devices.status().phase != LinkPhase::off; }));
    window().window().showMinimized();
    ASSERT_TRUE(eventually([&] { return !studio().show.isWanted(); })) << "but nothing is drawn";
    const std::uint64_t drawn = studio().show.count();
    const std::uint64_t number = studio().loop.frame()->number;
    EXPECT_TRUE(eventually([&] { return studio().loop.frame()->number > number + 30; }));
    EXPECT_LE(studio().show.count(), drawn + 2);
    studio().devices.disconnect();
    EXPECT_TRUE(rests());
    window().window().showNormal();
}

} // namespace
} // namespace lumorph::test
