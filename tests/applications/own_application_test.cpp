#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "app/applications/demo_items.h"
#include "app/applications/ripple/ripple.h" // written by `lumorph demo new ripple` and the guide
#include "tests/support/cut_tablet.h"

// The application that the guide's page makes of the example, followed to the letter when the tests are built.

namespace lumorph {
namespace {

class OwnApplication : public ::testing::Test {
protected:
    OwnApplication() {
        moment_.rig = std::make_shared<const Rig>(test::cutTablet());
        moment_.installation = std::make_shared<const Installation>(defaultInstallation());
    }
    ShowContent frames(double seconds, const std::vector<ShowInput>& inputs = {}) {
        moment_.inputs = inputs;
        ShowContent content = program_->frame(moment_);
        moment_.inputs = {};
        moment_.step = 1.0 / 60.0;
        for (int k = 1; k < std::lround(seconds * 60.0); ++k) content = program_->frame(moment_);
        return content;
    }
    static glm::dvec2 ballOf(const ShowContent& content) {
        const glm::vec3 at = findItem(*content.scene, 100)->position;
        return {at.x, at.z};
    }

    Demo demo_ = ripple::rippleDemo();
    std::unique_ptr<ShowProgram> program_ = demo_.program({.seed = 1}, {});
    ShowMoment moment_;
};

TEST_F(OwnApplication, IsNamedAsItsMakerSaid) {
    EXPECT_EQ(demo_.name, "ripple");
    EXPECT_EQ(demo_.title.in(Language::english), "Ripple");
    EXPECT_FALSE(demo_.sentence.german.empty()) << "to be changed, and so not forgotten";
    EXPECT_EQ(demo_.open({}).rig->actuators().size(), moment_.rig->actuators().size());
}

TEST_F(OwnApplication, FollowsThePointerAndBeginsAgain) {
    const glm::dvec2 right = ballOf(frames(3.0, {{"pointer.x", 1.0}, {"pointer.y", -1.0}}));
    EXPECT_NEAR(right.x, 0.11, 0.001);
    EXPECT_NEAR(right.y, -0.075, 0.001);
    const glm::dvec2 middle = ballOf(frames(0.1, {{"key.restart", 1.0}}));
    EXPECT_NEAR(middle.x, 0.0, 1e-6); // as the page says in its step 5
}

TEST_F(OwnApplication, PlaysByItselfAfterSilence) {
    const glm::dvec2 first = ballOf(frames(1.0));
    EXPECT_NE(first, ballOf(frames(1.0)));
    const glm::dvec2 held = ballOf(frames(5.0, {{"pointer.x", 0.5}}));
    EXPECT_EQ(held.x, ballOf(frames(30.0)).x);
    EXPECT_NE(held.x, ballOf(frames(20.0)).x);
}

TEST_F(OwnApplication, LiftsARingThatRunsOutwardFromTheBall) {
    frames(5.0, {{"pointer.x", 1e-9}}); // somebody who lets it stay in the middle
    std::vector<double> rings;
    for (int k = 0; k < 4; ++k) {
        const ShowContent content = frames(0.4);
        const auto& grid = std::get<HeightGrid>(content.target);
        double best = 0.0;
        for (double far = 0.0; far < 0.075; far += 0.0005)
            if (heightAt(grid, {0.0, far}) > heightAt(grid, {0.0, best})) best = far;
        EXPECT_NEAR(heightAt(grid, {0.0, best}), static_cast<double>(kSheet) + 0.012, 0.0005);
        rings.push_back(best);
    }
    int outward = 0; // 2 cm a second, so 8 mm in 0.4 s, but for the once that it begins anew
    for (std::size_t k = 1; k < rings.size(); ++k)
        if (std::abs(rings[k] - rings[k - 1] - 0.008) < 0.003) ++outward;
    EXPECT_GE(outward, 2);
}

} // namespace
} // namespace lumorph
