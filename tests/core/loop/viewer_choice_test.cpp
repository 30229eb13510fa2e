#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/loop/viewer_choice.h"

namespace lumorph {
namespace {

constexpr double kFrameSeconds = 1.0 / 60.0;
constexpr glm::dvec3 kCentre{0.0, 0.0, 0.0};

TrackedHead head(const char* name, double distance, double side = 1.0) { return {name, {side * distance, 0.0, 0.0}}; }

class ViewerDirectorTest : public testing::Test {
protected:
    std::optional<ViewerDirector::View> run(const std::vector<TrackedHead>& heads, double seconds,
                                            ViewerChoice choice = ViewerChoice::automatic) {
        std::optional<ViewerDirector::View> view;
        for (double t = 0.0; t < seconds; t += kFrameSeconds)
            view = director_.step(heads, kCentre, choice, kFrameSeconds);
        return view;
    }
    ViewerDirector director_;
};

TEST_F(ViewerDirectorTest, NobodyIsFollowedWhenNobodyIsThere) {
    EXPECT_FALSE(director_.step({}, kCentre, ViewerChoice::automatic, kFrameSeconds));
    const std::vector<TrackedHead> one{head("Ada", 1.0)};
    const auto view = director_.step(one, kCentre, ViewerChoice::automatic, kFrameSeconds);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->name, "Ada");
    EXPECT_EQ(view->eye, one[0].eye) << "at once, since nobody was followed before";
    EXPECT_FALSE(view->handingOver);
    EXPECT_FALSE(director_.step(one, kCentre, ViewerChoice::none, kFrameSeconds));
    EXPECT_FALSE(director_.step({}, kCentre, ViewerChoice::nearest, kFrameSeconds));
    const std::vector<TrackedHead> nowhere{{"Ada", {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}}};
    EXPECT_FALSE(director_.step(nowhere, kCentre, ViewerChoice::first, kFrameSeconds));
}

TEST_F(ViewerDirectorTest, ChoosesAsItIsTold) {
    const std::vector<TrackedHead> heads{head("Ada", 1.0), head("Bo", 0.5), head("Cy", 2.0)};
    EXPECT_EQ(run(heads, 1.0, ViewerChoice::first)->name, "Ada");
    EXPECT_EQ(run(heads, 1.0, ViewerChoice::nearest)->name, "Bo");
    ViewerDirector fresh;
    EXPECT_EQ(fresh.step(heads, kCentre, ViewerChoice::automatic, kFrameSeconds)->name, "Bo");
    EXPECT_EQ(fresh.step(heads, {2.1, 0.0, 0.0}, ViewerChoice::nearest, kFrameSeconds)->name, "Cy")
        << "nearest to the device";
}

TEST_F(ViewerDirectorTest, KeepsItsViewerUntilAnotherIsClearlyNearerForHalfASecond) {
    ASSERT_EQ(run({head("Ada", 1.0), head("Bo", 1.5)}, 1.0)->name, "Ada");
    EXPECT_EQ(run({head("Ada", 1.0), head("Bo", 0.85)}, 5.0)->name, "Ada") << "not 20 % nearer";
    EXPECT_EQ(run({head("Ada", 1.0), head("Bo", 0.75)}, 0.45)->name, "Ada") << "not for long enough";
    EXPECT_EQ(run({head("Ada", 1.0), head("Bo", 0.85)}, 0.1)->name, "Ada");
    EXPECT_EQ(run({head("Ada", 1.0), head("Bo", 0.75)}, 0.45)->name, "Ada") << "counted anew";
    EXPECT_EQ(run({head("Ada", 1.0), head("Bo", 0.75)}, 0.1)->name, "Bo");
    EXPECT_EQ(run({head("Ada", 1.0), head("Bo", 1.1)}, 5.0)->name, "Bo") << "who now keeps it";
    EXPECT_EQ(run({head("Ada", 1.0)}, 0.02)->name, "Ada") << "at once when he is gone";
}

TEST_F(ViewerDirectorTest, TheEyeGlidesWithoutAJump) {
    std::vector<TrackedHead> heads{head("Ada", 1.0, 1.0), head("Bo", 1.2, -1.0)};
    glm::dvec3 last = run(heads, 0.2)->eye;
    heads.erase(heads.begin());
    double farthest = 0.0;
    double handed = 0.0;
    for (int k = 0; k < 60; ++k) {
        const auto view = director_.step(heads, kCentre, ViewerChoice::automatic, kFrameSeconds);
        ASSERT_TRUE(view);
        EXPECT_EQ(view->name, "Bo");
        farthest = std::max(farthest, glm::distance(view->eye, last));
        handed += view->handingOver ? kFrameSeconds : 0.0;
        // Mid-way somebody else comes, and Bo leaves: still no jump.
        if (k == 10) break;
        last = view->eye;
    }
    heads = {head("Cy", 1.0, 2.0)};
    last = glm::dvec3(0.0);
    bool first = true;
    for (int k = 0; k < 40; ++k) {
        const auto view = director_.step(heads, kCentre, ViewerChoice::automatic, kFrameSeconds);
        if (!first) farthest = std::max(farthest, glm::distance(view->eye, last));
        first = false;
        last = view->eye;
        handed += view->handingOver ? kFrameSeconds : 0.0;
    }
    // 3.2 m at most in 0.4 s, at most half again as fast in the middle.
    EXPECT_LE(farthest, 1.5 * 3.2 / 0.4 * kFrameSeconds + 1e-9);
    EXPECT_EQ(last, heads[0].eye);
    EXPECT_NEAR(handed, 11 * kFrameSeconds + 0.4, 2.5 * kFrameSeconds);
    EXPECT_FALSE(director_.step(heads, kCentre, ViewerChoice::automatic, kFrameSeconds)->handingOver);
}

TEST_F(ViewerDirectorTest, TimeThatMakesNoSenseIsNoTime) {
    ASSERT_EQ(run({head("Ada", 1.0), head("Bo", 3.0)}, 0.1)->name, "Ada");
    const std::vector<TrackedHead> heads{head("Bo", 3.0)};
    for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), -1.0, HUGE_VAL}) {
        const auto view = director_.step(heads, kCentre, ViewerChoice::automatic, wrong);
        EXPECT_EQ(view->eye, glm::dvec3(1.0, 0.0, 0.0));
        EXPECT_TRUE(view->handingOver);
    }
}

} // namespace
} // namespace lumorph
