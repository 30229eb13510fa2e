#include "calibration/registration/landmarks.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "calibration/registration/pivot.h"
#include "calibration/registration/registration.h"
#include "calibration/registration/rigid_fit.h"
#include "tracked_motion.h"

// R25: a tracked pointer: its tip by pivoting, and a model by the points that it touches.

namespace lumorph {
namespace {

const glm::dvec3 kTip{0.11, -0.02, 0.015};

/// A pointer whose tip is at `place`, held as the hand likes at that time.
Pose holding(const glm::dvec3& place, double seconds, double swing = 0.3) {
    const glm::dquat turn = rotationOfTurn({swing * std::sin(1.3 * seconds), swing * std::sin(0.9 * seconds + 1.0),
                                            swing * std::sin(1.1 * seconds + 2.0)});
    return {place - turn * kTip, turn};
}

std::string why(const std::function<void()>& run, Cause cause) {
    try {
        run();
    } catch (const CaptureRefused& refused) {
        EXPECT_EQ(keyOf(refused.finding().cause), keyOf(cause)) << refused.what();
        return refused.what();
    }
    ADD_FAILURE() << "not refused: " << keyOf(cause);
    return {};
}

TEST(Pivot, TipIsFoundWithinAFewTenthsOfAMillimetre) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const PoseTrack swings = test::trackOf(
            [](double t) {
                return holding({0.3, 0.8, -0.2}, t, 0.45);
            },
            15.0, 60.0, seed);
        const Pivot pivot = solvePivot(swings);
        EXPECT_LT(glm::distance(pivot.tip, kTip), 0.0005) << seed;
        EXPECT_LT(glm::distance(pivot.tip, kTip), 5.0 * glm::length(pivot.tipSigma)) << seed;
        EXPECT_TRUE(pivot.warnings.empty());
    }
}

TEST(Pivot, SlippingSwingsAreNamedAndLeftOut) {
    PoseTrack swings = test::trackOf([](double t) { return holding({0.0, 0.8, 0.0}, t, 0.45); }, 15.0, 60.0, 1);
    for (std::size_t i = 240; i < 360; ++i) swings.poses[i].pose.position.x += 0.02; // 4 s to 6 s
    const Pivot pivot = solvePivot(swings);
    EXPECT_LT(glm::distance(pivot.tip, kTip), 0.0006);
    ASSERT_EQ(pivot.warnings.size(), 1U);
    EXPECT_NE(pivot.warnings[0].why.find("from 4.0 s to 6."), std::string::npos) << pivot.warnings[0].why;
}

// A loose dimple: at once, or little by little.
TEST(Pivot, ADimpleThatSlidesIsSaidAndTheTipFoundAllTheSame) {
    const auto slid = [](bool atOnce, double far) {
        return [atOnce, far](double t) {
            const double share = atOnce ? (t < 7.0 ? 0.0 : 1.0) : t / 15.0;
            return holding(glm::dvec3(0.3, 0.8, -0.2) + far * share * glm::dvec3(0.6, 0.0, 0.8), t, 0.45);
        };
    };
    for (unsigned seed = 700; seed < 706; ++seed)
        for (const bool atOnce : {true, false})
            for (const double far : {0.010, 0.025}) {
                const Pivot pivot = solvePivot(test::trackOf(slid(atOnce, far), 15.0, 60.0, seed));
                const std::string what = std::to_string(1000.0 * far) + (atOnce ? " mm at once" : " mm slowly");
                ASSERT_FALSE(pivot.warnings.empty()) << what;
                for (const Finding& warning : pivot.warnings) EXPECT_EQ(keyOf(warning.cause), "tip_slipped") << what;
                double said = 0.0;
                ASSERT_EQ(std::sscanf(pivot.warnings[0].why.c_str(), "the dimple slid by %lf mm", &said), 1) << what;
                EXPECT_NEAR(said, 1000.0 * far, std::max(2.0, 150.0 * far)) << what; // parts are as long as an eighth
                EXPECT_LT(glm::distance(pivot.tip, kTip), atOnce && far < 0.02 ? 0.001 : 0.002) << what;
            }
}

TEST(Pivot, SwingsThatTellTooLittleAreRefusedWithWhatIsMissing) {
    const auto swung = [](glm::dvec3 axis) {
        return test::trackOf(
            [axis](double t) {
                const glm::dquat turn = rotationOfTurn(axis * (0.5 * std::sin(t)));
                return Pose{-(turn * kTip), turn};
            },
            15.0, 60.0, 1);
    };
    EXPECT_NE(why(
                  [&] {
                      (void)solvePivot(swung({1.0, 0.0, 0.0}));
                  },
                  Cause::motionDegenerate)
                  .find("across"),
              std::string::npos);
    EXPECT_NE(why([&] { (void)solvePivot(swung(glm::dvec3(0.05))); }, Cause::motionDegenerate).find("30 degrees"),
              std::string::npos);
    const test::HandMotion waved(4);
    why([&] { (void)solvePivot(test::trackOf([&](double t) { return waved.at(t); }, 15.0, 60.0, 1)); },
        Cause::tipSlipped);
}

/// A block with points on it, touched one after another while it moves about with its own body.
struct Block {
    std::vector<NamedPoint> model{{"a", {0.0, 0.0, 0.0}},    {"b", {0.14, 0.0, 0.0}},   {"c", {0.14, 0.05, 0.0}},
                                  {"d", {0.02, 0.05, 0.02}}, {"e", {0.07, 0.02, 0.03}}, {"f", {0.0, 0.03, 0.05}}};
    Pose modelFromReference{{0.02, -0.04, 0.03}, rotationOfTurn({0.3, 1.2, -0.5})};
    test::HandMotion motion{21, glm::dvec3(0.1)};

    [[nodiscard]] PoseTrack reference() const {
        return test::trackOf([&](double t) { return motion.at(0.05 * t); }, double(model.size()) * 3.0, 60.0, 5,
                             {0.0003, 0.001});
    }
    /// Two seconds on each point, one on the way; in this order.
    [[nodiscard]] PoseTrack pointer(const std::vector<std::size_t>& order, double scale = 1.0) const {
        const auto tip = [&](std::size_t k) { return model[order[std::min(k, order.size() - 1)]].place; };
        const auto pose = [&](double t) {
            const auto k = static_cast<std::size_t>(t / 3.0);
            const double way = std::clamp(t - 3.0 * double(k) - 2.0, 0.0, 1.0);
            const glm::dvec3 place =
                glm::mix(tip(k), tip(k + 1), way) + glm::dvec3(0.0, 0.0, 0.08 * std::sin(3.1416 * way));
            Pose held = motion.at(0.05 * t) * inverseOf(modelFromReference) * holding(place, t, 0.15);
            held.position *= scale;
            return held;
        };
        return test::trackOf(pose, double(order.size()) * 3.0, 60.0, 6, {0.0002, 0.0005});
    }
};

TEST(Landmarks, ModelIsFoundOnItsBodyWithinHalfAMillimetre) {
    const Block block;
    const LandmarkFit fit = fitLandmarks(block.pointer({0, 1, 2, 3, 4, 5}), block.reference(), block.model, kTip);
    EXPECT_LT(fit.rms, 0.0004);
    for (const NamedPoint& at : block.model) {
        const glm::dvec3 inReference = inverseOf(block.modelFromReference) * at.place;
        EXPECT_LT(glm::distance(fit.modelFromReference * inReference, at.place), 0.0005) << at.name;
    }
    EXPECT_TRUE(fit.warnings.empty()) << sentenceOf(fit.warnings.front());
    for (const Landmark& at : fit.points) EXPECT_GE(at.leaveOneOut, at.error) << at.name;
}

TEST(Landmarks, PointsTouchedInAnotherOrderAreToldApartByTheirDistances) {
    const Block block;
    const LandmarkFit fit = fitLandmarks(block.pointer({3, 0, 5, 1, 4, 2}), block.reference(), block.model, kTip);
    EXPECT_LT(fit.rms, 0.0004);
    ASSERT_EQ(fit.warnings.size(), 1U);
    EXPECT_EQ(keyOf(fit.warnings[0].cause), "wrong_order");
}

TEST(Landmarks, PointThatWasNotTouchedIsNamed) {
    const Block block;
    const LandmarkFit fit = fitLandmarks(block.pointer({0, 1, 3, 4, 5}), block.reference(), block.model, kTip);
    ASSERT_FALSE(fit.points[2].touched);
    ASSERT_FALSE(fit.warnings.empty());
    EXPECT_NE(fit.warnings[0].why.find(": c"), std::string::npos) << fit.warnings[0].why;
}

TEST(Landmarks, WrongTipModelUnitAndHandAreRefusedByName) {
    const Block block;
    const PoseTrack pointer = block.pointer({0, 1, 2, 3, 4, 5}), reference = block.reference();
    const std::string tip =
        why([&] { (void)fitLandmarks(pointer, reference, block.model, kTip + glm::dvec3(0.0, 0.06, 0.04)); },
            Cause::tipWrong);
    EXPECT_NE(tip.find("one at 0.1"), std::string::npos) << tip; // that would do: 0.11

    std::vector<NamedPoint> other = block.model;
    for (NamedPoint& at : other) at.place = {at.place.y * 1.7, at.place.x + at.place.z, at.place.z * 2.0 + at.place.y};
    why([&] { (void)fitLandmarks(pointer, reference, other, kTip); }, Cause::modelDoesNotFit);

    std::vector<NamedPoint> large = block.model;
    for (NamedPoint& at : large) at.place *= 100.0;
    why([&] { (void)fitLandmarks(pointer, reference, large, kTip); }, Cause::wrongUnits);

    std::vector<NamedPoint> mirror = block.model;
    for (NamedPoint& at : mirror) at.place.z = -at.place.z;
    why([&] { (void)fitLandmarks(pointer, reference, mirror, kTip); }, Cause::mirrored);
}

TEST(RecordedLandmarks, CheckPointsAreHeldOutBeforeItIsSolved) {
    Block block;
    block.model.push_back({"g", {0.05, 0.05, 0.04}});
    block.model.push_back({"h", {0.11, 0.01, 0.06}});
    block.model.push_back({"i", {0.09, 0.06, 0.01}});
    const std::vector<std::size_t> order{0, 1, 2, 3, 4, 5, 6, 7, 8};
    Installation room = defaultInstallation();
    room.pointerTip = glm::vec3(kTip);
    const Registration found = registerDevice({block.pointer(order), block.reference(), block.model}, room);
    ASSERT_TRUE(found.good()) << found.summary;
    std::printf("  %s\n", found.summary.c_str());
    EXPECT_NE(found.summary.find("3 check points that the fit never saw"), std::string::npos) << found.summary;
    ASSERT_EQ(found.fresh.points.size(), 3U);
    EXPECT_EQ(found.points.size(), 6U);
    for (const PointError& point : found.points)
        EXPECT_TRUE(std::ranges::none_of(found.fresh.points, [&](const auto& at) { return at.name == point.name; }));
    const Pose truth = inverseOf(block.modelFromReference);
    EXPECT_LT(glm::distance(glm::dvec3(found.installation.bodyFromDevice[3]), truth.position), 0.001);
    // What happens to a check point changes its error, and nothing else.
    for (const PointError& held : found.fresh.points) {
        Block other = block;
        auto& place = std::ranges::find(other.model, held.name, &NamedPoint::name)->place;
        place.z += 0.0012;
        const Registration moved = registerDevice({block.pointer(order), block.reference(), other.model}, room);
        EXPECT_EQ(moved.installation.bodyFromDevice, found.installation.bodyFromDevice) << held.name;
        EXPECT_NE(std::ranges::find(moved.fresh.points, held.name, &PointError::name)->metres, held.metres);
    }
    // Too few to hold any out.
    const Block six;
    const Registration few = registerDevice({six.pointer({0, 1, 2, 3, 4, 5}), six.reference(), six.model}, room);
    ASSERT_TRUE(few.refusal);
    EXPECT_EQ(few.refusal->cause, Cause::tooFewPoints);
    EXPECT_NE(few.refusal->remedy.find("seven"), std::string::npos);
}

TEST(RecordedLandmarks, ARealStylusOnABlock) {
    const std::string folder = LUMORPH_SHARED_DIR "/data/landmarks/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without ../shared/data/landmarks";
    const RecordedLandmarks capture{parsePoseTrack(test::textOfFile(folder + "pointer.csv"), "pointer.csv"),
                                    parsePoseTrack(test::textOfFile(folder + "reference.csv"), "reference.csv"),
                                    parseNamedPoints(test::textOfFile(folder + "model.csv"), "model.csv")};
    Installation room = defaultInstallation();
    room.pointerTip = {0.108565F, 0.00777385F, 0.0025389F};
    room.origins.pointer = {Origin::Way::entered, "", ""};
    const Registration found = registerDevice(capture, room);
    std::printf("  %s\n", found.summary.c_str());
    ASSERT_TRUE(found.good()) << found.summary;
    EXPECT_EQ(found.fresh.points.size(), 3U);
    EXPECT_LT(found.fresh.rms, 0.001);
    room.pointerTip = glm::vec3(0.0F);
    EXPECT_TRUE(registerDevice(capture, room).refusal);
}

TEST(Landmarks, RealStylusOnABlockIsWithinAThirdOfAMillimetre) {
    const std::string folder = LUMORPH_SHARED_DIR "/data/landmarks/";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "without ../shared/data/landmarks";
    const PoseTrack pointer = parsePoseTrack(test::textOfFile(folder + "pointer.csv"), "pointer.csv");
    const PoseTrack reference = parsePoseTrack(test::textOfFile(folder + "reference.csv"), "reference.csv");
    const auto model = parseNamedPoints(test::textOfFile(folder + "model.csv"), "model.csv");
    const LandmarkFit fit = fitLandmarks(pointer, reference, model, {0.108565, 0.00777385, 0.0025389});
    std::printf("real landmarks: %.3f mm RMS\n", 1000.0 * fit.rms);
    EXPECT_LE(fit.rms, 0.00035);
    EXPECT_TRUE(fit.warnings.empty());
    for (const glm::dvec3 tip :
         {glm::dvec3(0.0), glm::dvec3(0.1, 0.03, 0.05), glm::dvec3(-0.108565, 0.00777385, 0.0025389)})
        why([&] { (void)fitLandmarks(pointer, reference, model, tip); }, Cause::tipWrong);
}

TEST(RigidFit, ScaleAndHandAreTold) {
    const std::vector<glm::dvec3> from{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {1, 1, 1}};
    std::vector<glm::dvec3> larger, mirror;
    for (const glm::dvec3& p : from) {
        larger.push_back(rotationOfTurn({0.2, 0.5, -1.0}) * (2.5 * p) + glm::dvec3(4.0, 5.0, 6.0));
        mirror.push_back({p.x, p.y, -p.z});
    }
    EXPECT_NEAR(fitRigid(from, larger).scale, 2.5, 1e-12);
    EXPECT_FALSE(fitRigid(from, larger).mirrored);
    EXPECT_TRUE(fitRigid(from, mirror).mirrored);
    EXPECT_THROW((void)fitRigid(std::vector<glm::dvec3>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, std::span(from).first(3)),
                 InvalidInput);
}

TEST(PoseTrack, BadRowsAreNamedByLine) {
    const auto message = [](const std::string& text) {
        try {
            (void)parsePoseTrack(text, "poses.csv");
        } catch (const DataError& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const std::string good = "0, 0,0,0, 0,0,0,1\n1, 0,0,0, 0,0,0,1\n";
    EXPECT_EQ(message("# time,x\n" + good), "accepted");
    EXPECT_EQ(parsePoseTrack(good, "").poses.size(), 2U);
    for (const char* bad :
         {"2,0,0,0,0,0,1", "2,0,0,0,0,0,0,1,5", "2,nan,0,0,0,0,0,1", "2,0,0,x,0,0,0,1", "2,0,0,0,1,1,1,1",
          "2,0,0,0,0,0,0,0", "0.5,0,0,0,0,0,0,1", "2,0,0,900,0,0,0,1", "inf,0,0,0,0,0,0,1"})
        EXPECT_NE(message(good + bad + "\n").find("line 3"), std::string::npos) << bad << ": " << message(good + bad);
    EXPECT_NE(message("0,0,0,0,0,0,0,1").find("two poses"), std::string::npos);
    EXPECT_NE(message("").find("two poses"), std::string::npos);
    const PoseTrack doubled = parsePoseTrack(good + "1, 0,0,0, 0,0,0,1\n", "p.csv");
    EXPECT_EQ(doubled.poses.size(), 2U);
    ASSERT_EQ(doubled.warnings.size(), 1U);
    EXPECT_EQ(keyOf(doubled.warnings[0].cause), "doubled_rows");
}

} // namespace
} // namespace lumorph
