#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "calibration/budget/error_budget.h"
#include "calibration/lab/lab.h"
#include "calibration/lab/true_room.h"
#include "core/base/error.h"
#include "core/scene/measured_sigma.h"
#include "tests/support/cut_tablet.h"

// The budget against the lab: true rooms are drawn with the same errors, and rays say how far what is shown slips.

namespace lumorph {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kSpeed = 0.3; // of the hand, m/s

const Rig& budgetTablet() {
    static const Rig rig = test::cutTablet();
    return rig;
}

/// Errors that a draw may have.
struct Drawn {
    bool light = false, tracker = false, device = false, eye = false, servos = false, delay = false, tip = false;
};

/// By what a draw is judged: rays that meet the whole device, or the plane of the place's own triangle, where a picture
/// that slips farther than its flap is wide still has a place to be. Both are exact.
enum class Judge { rays, planes };

/// One true room beside the believed one.
class TrueShow {
public:
    TrueShow(const Installation& believed, const RoomErrors& errors, LabErrors lab, const SlipView& view,
             const Drawn& drawn, Judge judge, std::uint32_t seed)
        : believed_(believed), view_(view), judge_(judge), engine_(seed) {
        const Rig& rig = budgetTablet();
        lab.unknownTracker = false;
        if (!drawn.device) lab.deviceMillimetres = lab.deviceDegrees = 0.0;
        if (!drawn.eye) lab.eyeMillimetres = 0.0;
        const Installation truth = trueRoom(believed, rig.actuators(), seed, lab);
        commanded_ = commandedOf(view, rig);
        trueStrokes_ = commanded_;
        if (drawn.servos)
            for (std::size_t i = 0; i < trueStrokes_.size(); ++i)
                trueStrokes_[i] = realStrokeAt(truth.servos[i], commanded_[i], i % 2 == seed % 2);
        glm::dmat4 tracker(1.0);
        if (drawn.tracker) tracker = rigid(errors.tracker.metres, errors.tracker.radians);
        // A tip that is believed too far off by so much: touched points lie there, and the worlds are shifted back.
        const glm::dvec3 tip = drawn.tip ? dice(1.0) : glm::dvec3(0.0);
        glm::dmat4 carried(1.0);
        if (drawn.delay) {
            const double late =
                truth.predictionSeconds + truth.trackerSeconds - believed.predictionSeconds - believed.trackerSeconds;
            const double way = std::uniform_real_distribution<double>(0.0, 6.283185307179586)(engine_);
            carried = glm::translate(glm::dmat4(1.0), kSpeed * late * glm::dvec3(std::cos(way), 0.0, std::sin(way)));
        }
        const glm::dmat4 body =
            glm::dmat4(believed.worldFromDevice) * glm::inverse(glm::dmat4(believed.bodyFromDevice));
        tracker = glm::translate(tracker, errors.tip.tracker * tip);
        const glm::dmat4 touched = glm::translate(glm::dmat4(1.0), -errors.tip.device * tip);
        worldFromDevice_ = carried * tracker * touched * body * glm::dmat4(truth.bodyFromDevice);
        const glm::dvec3 head = glm::dvec3(believed.eye) - glm::dvec3(believed.eyeFromHead);
        eye_ = glm::dvec3(tracker * glm::dvec4(head + glm::dvec3(truth.eyeFromHead) - errors.tip.eye * tip, 1.0));
        projectors_ = believed.projectors;
        if (drawn.light)
            for (std::size_t i = 0; i < projectors_.size(); ++i) tilt(projectors_[i].camera, errors.lights[i].metres);
        mesh_ = deformed(rig, trueStrokes_);
        for (glm::vec3& vertex : mesh_.positions) vertex = glm::vec3(worldFromDevice_ * glm::dvec4(vertex, 1.0));
        if (judge_ == Judge::planes) return;
        LabWorld world;
        world.surfaces = {{mesh_, glm::vec3(1.0F)}};
        lab_.emplace(std::move(world));
    }

    /// Squares of slips, and how many of the places could be judged.
    void judge(const std::vector<SlipPoint>& points, double& squares, double& count, double& lost) const {
        for (const SlipPoint& point : points) {
            const std::optional<double> slip = slipAt(point);
            if (!slip) {
                lost += 1.0;
                continue;
            }
            squares += *slip * *slip;
            count += 1.0;
        }
    }

private:
    static double realStrokeAt(const MeasuredServo& servo, double commanded, bool rises) {
        const auto at = static_cast<std::size_t>(std::lround(commanded * double(servo.points.size() - 1)));
        return std::clamp(rises ? servo.points[at].rising : servo.points[at].falling, 0.0, 1.0);
    }
    glm::dvec3 dice(double sigma) {
        std::normal_distribution<double> normal(0.0, sigma);
        const double x = normal(engine_), y = normal(engine_), z = normal(engine_);
        return {x, y, z};
    }
    glm::dmat4 rigid(double metres, double radians) {
        const glm::dvec3 turn = dice(radians), shift = dice(metres);
        return glm::rotate(glm::translate(glm::dmat4(1.0), shift), glm::length(turn), glm::normalize(turn));
    }
    /// About the projector's own x and y, so that its light falls so far beside on the device.
    void tilt(CalibratedCamera& camera, double metres) {
        const glm::dvec3 device(believed_.worldFromDevice[3]);
        const double far = glm::distance(positionOf(camera), device);
        glm::dvec3 turn = dice(metres / std::sqrt(2.0) / far);
        // Its own axis of sight is not one of these.
        const glm::dvec3 beam = glm::normalize(glm::dvec3(camera.cameraFromWorld * glm::dvec4(device, 1.0)));
        turn -= beam * glm::dot(beam, turn);
        if (!(glm::length(turn) > 0.0)) return;
        camera.cameraFromWorld =
            glm::rotate(glm::dmat4(1.0), glm::length(turn), glm::normalize(turn)) * camera.cameraFromWorld;
    }
    [[nodiscard]] std::optional<glm::dvec3> meets(const SlipPoint& point, const glm::dvec3& from,
                                                  const glm::dvec3& way) const {
        if (judge_ == Judge::rays) {
            const auto hit = lab_->trace(from, way);
            return hit ? std::optional(hit->point) : std::nullopt;
        }
        const glm::uvec3& t = mesh_.triangles[point.at.triangle];
        const glm::dvec3 a(mesh_.positions[t.x]), b(mesh_.positions[t.y]), c(mesh_.positions[t.z]);
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        const double slant = glm::dot(normal, way);
        if (std::abs(slant) < 0.05) return std::nullopt; // grazed
        return from + way * (glm::dot(normal, a - from) / slant);
    }
    /// Where the light of what belongs to a place lands, less where the eye should see it, across the sight.
    [[nodiscard]] std::optional<double> slipAt(const SlipPoint& point) const {
        const glm::dvec3 believedEye(believed_.eye);
        const glm::dvec3 shown = point.at.point + view_.floats * glm::normalize(believedEye - point.at.point);
        const glm::dvec3 onDevice(glm::inverse(glm::dmat4(believed_.worldFromDevice)) * glm::dvec4(shown, 1.0));
        const glm::dvec3 real(worldFromDevice_ * glm::dvec4(onDevice, 1.0));
        const auto wanted = meets(point, eye_, glm::normalize(real - eye_));
        const auto pixel = pixelOf(believed_.projectors[point.projector].camera, point.at.point);
        if (!wanted || !pixel) return std::nullopt;
        const CalibratedCamera& projector = projectors_[point.projector].camera;
        const auto lands = meets(point, positionOf(projector), directionOf(projector, *pixel));
        if (!lands) return std::nullopt;
        const glm::dvec3 off = *lands - *wanted, sight = glm::normalize(real - eye_);
        return glm::length(off - sight * glm::dot(sight, off));
    }

    Installation believed_;
    SlipView view_;
    Judge judge_;
    std::mt19937 engine_;
    std::vector<double> commanded_, trueStrokes_;
    glm::dmat4 worldFromDevice_{1.0};
    glm::dvec3 eye_{0.0};
    std::vector<InstalledProjector> projectors_;
    TriangleMesh mesh_;
    std::optional<Lab> lab_;
};

struct Measured {
    double metres = 0.0, lost = 0.0;
};

/// As many draws of one kind of errors.
struct Draws {
    Installation believed;
    RoomErrors errors;
    LabErrors lab;
    SlipView view;
    SlipModel model;
    Judge judge = Judge::planes;

    [[nodiscard]] Measured measured(const Drawn& drawn, std::uint32_t first = 100U) const {
        // Few servos bend a lot: with 120 draws theirs is 14 % beside, with 1000 it is 6 %.
        constexpr int kDraws = 1000;
        double squares = 0.0, count = 0.0, lost = 0.0;
        for (int k = 0; k < kDraws; ++k)
            TrueShow(believed, errors, lab, view, drawn, judge, first + static_cast<std::uint32_t>(k))
                .judge(model.points, squares, count, lost);
        return {std::sqrt(squares / count), lost / (count + lost)};
    }
};

/// Errors as they are before anything is measured, or a share of them.
Draws drawsOf(double share, Judge judge) {
    Draws draws;
    draws.believed = defaultInstallation();
    draws.believed.predictionSeconds = draws.lab.lightSeconds;
    draws.believed.trackerSeconds = draws.lab.trackerSeconds;
    draws.lab.unknownTracker = false;
    for (double* error : {&draws.lab.deviceMillimetres, &draws.lab.deviceDegrees, &draws.lab.eyeMillimetres,
                          &draws.lab.servoBend, &draws.lab.backlashDegrees})
        *error *= share;
    draws.view.tries = 800;
    draws.judge = judge;
    draws.model = slipModelOf(budgetTablet(), draws.believed, draws.view);
    draws.errors = errorsOf(draws.believed, budgetTablet(), commandedOf(draws.view, budgetTablet()), draws.lab);
    for (double* error :
         {&draws.errors.lights.front().metres, &draws.errors.tracker.metres, &draws.errors.tracker.radians})
        *error *= share;
    draws.errors.noise = {}; // what prediction leaves is another test's
    draws.errors.ahead = 0.0;
    return draws;
}

void compare(const char* name, double told, const Measured& lab) {
    std::printf("  %-10s budget %7.3f mm, lab %7.3f mm, %.1f %% of the places lost\n", name, 1e3 * told,
                1e3 * lab.metres, 100.0 * lab.lost);
    EXPECT_NEAR(told, lab.metres, 0.1 * lab.metres) << name;
    EXPECT_LT(lab.lost, 0.05) << name;
}

/// Each part alone, and all at once.
void expectWhatTheLabMeasures(const Draws& draws) {
    const ErrorBudget budget = budgetOf(budgetTablet(), draws.model, draws.errors, CarryingHand{kSpeed});
    ASSERT_GT(draws.model.points.size(), 100U);
    struct Row {
        BudgetPart part;
        Drawn drawn;
    };
    const std::array<Row, 6> rows{
        Row{BudgetPart::projector, {.light = true}}, Row{BudgetPart::tracker, {.tracker = true}},
        Row{BudgetPart::device, {.device = true}},   Row{BudgetPart::eye, {.eye = true}},
        Row{BudgetPart::servos, {.servos = true}},   Row{BudgetPart::delay, {.delay = true}}};
    double squares = 0.0;
    for (const Row& row : rows) {
        const double told = budget.itemOf(row.part).metres;
        squares += told * told;
        compare(keyOf(row.part), told, draws.measured(row.drawn));
    }
    compare("all", std::sqrt(squares), draws.measured({true, true, true, true, true, true}));
}

TEST(ErrorBudget, IsWhatRaysOfTheLabMeasureInARoomThatWasMeasured) {
    expectWhatTheLabMeasures(drawsOf(0.1, Judge::rays));
}

TEST(ErrorBudget, IsWhatTheLabMeasuresBeforeAnythingIsMeasured) {
    expectWhatTheLabMeasures(drawsOf(1.0, Judge::planes));
}

Origin touchedWith(const MeasuredSigma& sigma, const char* date = "2026-11-26T10:00:00Z") {
    return {Origin::Way::measured, withSigma("touched", sigma), date};
}

/// A room in which a poor tip went into some of tracker, device and eye.
Draws drawsWithTip(bool isEyeTouched) {
    Draws draws = drawsOf(0.1, Judge::planes);
    Installation& room = draws.believed;
    room.origins.pointer = touchedWith({0.0026, 0.0, 0.0});
    room.origins.tracker = touchedWith({0.003, 0.006, 0.0, 0.0026});
    room.origins.deviceBody = touchedWith({0.0025, 0.005, 0.0, 0.002});
    if (isEyeTouched) room.origins.eyeOffset = touchedWith({0.004, 0.0, 0.0, 0.0024});
    draws.errors = errorsOf(room, budgetTablet(), commandedOf(draws.view, budgetTablet()), draws.lab);
    draws.errors.lights.front().metres = 0.0005;
    draws.errors.noise = {};
    draws.errors.ahead = 0.0;
    draws.lab.deviceMillimetres = 1e3 * draws.errors.device.metres;
    draws.lab.deviceDegrees = draws.errors.device.radians / kDegree;
    draws.lab.eyeMillimetres = 1e3 * draws.errors.eye;
    return draws;
}

TEST(ErrorBudget, AnErrorOfTheTipIsSharedByAllThatItTouched) {
    for (const bool isEyeTouched : {true, false}) {
        const Draws draws = drawsWithTip(isEyeTouched);
        const CarryingHand resting{0.0}; // a delay would be nearly all of it
        const ErrorBudget budget = budgetOf(budgetTablet(), draws.model, draws.errors, resting);
        constexpr std::uint32_t kFirst = 20'000;
        compare("tracker", budget.itemOf(BudgetPart::tracker).metres, draws.measured({.tracker = true}, kFirst));
        compare("device", budget.itemOf(BudgetPart::device).metres, draws.measured({.device = true}, kFirst));
        compare("eye", budget.itemOf(BudgetPart::eye).metres, draws.measured({.eye = true}, kFirst));
        compare("pointer", budget.itemOf(BudgetPart::pointer).metres, draws.measured({.tip = true}, kFirst));
        compare("all", budget.total, draws.measured({true, true, true, true, true, false, true}, kFirst));
        EXPECT_EQ(budget.itemOf(BudgetPart::pointer).source, ErrorSource::told);
        double squares = 0.0;
        for (const BudgetItem& item : budget.items) squares += item.metres * item.metres;
        EXPECT_NEAR(budget.total, std::sqrt(squares), 1e-12);
        // What errors of their own would make of it.
        Installation earlier = draws.believed;
        earlier.origins.pointer.date = "2026-11-27T10:00:00Z";
        RoomErrors apart = errorsOf(earlier, budgetTablet(), commandedOf(draws.view, budgetTablet()), draws.lab);
        EXPECT_EQ(apart.tip.tracker, 0.0) << "touched with a tip of before";
        EXPECT_NEAR(std::hypot(draws.errors.tracker.metres, draws.errors.tip.tracker), apart.tracker.metres, 1e-6);
        apart.lights = draws.errors.lights;
        apart.noise = {};
        EXPECT_LT(budget.total, 0.9 * budgetOf(budgetTablet(), draws.model, apart, resting).total);
    }
}

TEST(ErrorBudget, EachProjectorCountsWithItsOwnError) {
    Draws draws = drawsOf(0.1, Judge::planes);
    Installation& room = draws.believed;
    InstalledProjector other = room.projectors.front(), off = other;
    // From the other side, a quarter turn about the device.
    const glm::dvec3 device(room.worldFromDevice[3]);
    other.camera.cameraFromWorld = other.camera.cameraFromWorld * glm::translate(glm::dmat4(1.0), device) *
                                   glm::rotate(glm::dmat4(1.0), 1.5, glm::dvec3(0.0, 1.0, 0.0)) *
                                   glm::translate(glm::dmat4(1.0), -device);
    room.projectors.front().lens = touchedWith({0.0004, 0.0, 0.0});
    other.lens = touchedWith({0.003, 0.0, 0.0});
    off.enabled = false;
    off.lens = {};
    room.projectors.push_back(other);
    room.projectors.push_back(off);
    draws.model = slipModelOf(budgetTablet(), room, draws.view);
    draws.errors = errorsOf(room, budgetTablet(), commandedOf(draws.view, budgetTablet()), draws.lab);
    for (const std::size_t projector : {0U, 1U})
        EXPECT_GT(std::ranges::count(draws.model.points, projector, &SlipPoint::projector), 30) << "both light it";
    const auto light = [&](const RoomErrors& errors) {
        return budgetOf(budgetTablet(), draws.model, errors).itemOf(BudgetPart::projector);
    };
    compare("both", light(draws.errors).metres, draws.measured({.light = true}, 30'000));
    EXPECT_EQ(light(draws.errors).source, ErrorSource::told) << "one that is off needs no measurement";
    Draws alone = draws;
    alone.errors.lights[1].metres = 0.0;
    compare("one", light(alone.errors).metres, alone.measured({.light = true}, 30'000));
    RoomErrors without = draws.errors;
    without.lights[2].metres = 1.0;
    EXPECT_EQ(light(without).metres, light(draws.errors).metres);
    room.projectors[1].lens = {};
    const RoomErrors half = errorsOf(room, budgetTablet(), commandedOf(draws.view, budgetTablet()), draws.lab);
    EXPECT_EQ(half.sourceOf(BudgetPart::projector), ErrorSource::assumed);
    const RoomErrors again = measuredAgain(half, budgetTablet(), BudgetPart::projector);
    EXPECT_EQ(again.lights[0].metres, half.lights[0].metres) << "it was measured";
    EXPECT_LT(again.lights[1].metres, 0.2 * half.lights[1].metres);
}

TEST(ErrorBudget, WithoutPredictionTheWholeDelayIsAnError) {
    const Draws draws = drawsOf(1.0, Judge::planes);
    const auto delayOf = [&](double prediction, double age, const Origin& origin) {
        Installation room = draws.believed;
        room.predictionSeconds = prediction;
        room.trackerSeconds = age;
        room.origins.delays = origin;
        RoomErrors errors = errorsOf(room, budgetTablet(), commandedOf(draws.view, budgetTablet()), draws.lab);
        EXPECT_EQ(errors.ahead, prediction > 0.0 ? prediction + age : 0.0);
        return errors.delay;
    };
    const double light = draws.lab.lightSeconds, age = draws.lab.trackerSeconds;
    // Uniform within 30 % and 40 % of their means, as the lab draws them.
    const double spread = std::sqrt((std::pow(0.3 * light, 2) + std::pow(0.4 * age, 2)) / 3.0);
    EXPECT_NEAR(delayOf(0.0, 0.0, {}), std::hypot(light + age, spread), 1e-9);
    EXPECT_NEAR(delayOf(0.0, 0.02, {}), std::hypot(light + age, spread), 1e-9) << "nothing compensates these 20 ms";
    EXPECT_NEAR(delayOf(light, age, {}), spread, 1e-9);
    const double measured = delayOf(0.0, 0.02, touchedWith({0.0, 0.0, 0.001}));
    EXPECT_NEAR(measured, std::sqrt(std::pow(light + 0.02, 2) + std::pow(0.3 * light, 2) / 3.0 + 1e-6), 1e-9)
        << "an age that was measured is there whether it is compensated or not";
    EXPECT_NEAR(delayOf(light, 0.02, touchedWith({0.0, 0.0, 0.001})), 0.001, 1e-6);
}

TEST(ErrorBudget, WhatLiesBeyondTheFarthestPredictionIsCountedAndSaid) {
    const Draws draws = drawsOf(1.0, Judge::planes);
    const auto budgetFor = [&](double prediction, double age) {
        Installation room = draws.believed;
        room.predictionSeconds = prediction;
        room.trackerSeconds = age;
        RoomErrors errors = errorsOf(room, budgetTablet(), commandedOf(draws.view, budgetTablet()), draws.lab);
        EXPECT_NEAR(errors.ahead, prediction + age, 1e-12);
        errors.noise = {};
        return budgetOf(budgetTablet(), draws.model, errors, CarryingHand{kSpeed});
    };
    const ErrorBudget within = budgetFor(0.1, 0.02), cut = budgetFor(0.12, 0.08);
    EXPECT_EQ(within.cutSeconds, 0.0);
    // A pose is half a sample old when a frame asks for it, in the mean.
    EXPECT_NEAR(cut.cutSeconds, 0.05 + 0.5 / 60.0, 1e-9);
    EXPECT_NEAR(cut.cutMetres, kSpeed * cut.cutSeconds, 1e-12);
    // A literal circle, followed without noise: from where the device is 0.15 s after the newest sample to where it is
    // when the light falls.
    constexpr double kRadius = 0.12, kStep = 1.0 / 60.0;
    const double turn = kSpeed / kRadius * (0.2 + 0.5 * kStep - 0.15);
    const double squares = std::pow(2.0 * kRadius * std::sin(0.5 * turn), 2);
    const double level = 0.5 * (draws.model.deviceShift(0, 0) + draws.model.deviceShift(2, 2));
    const double told = cut.itemOf(BudgetPart::prediction).metres;
    std::printf("  cut %.1f mm, prediction leaves %.2f mm of it on the device (%.2f mm where it suffices)\n",
                1e3 * cut.cutMetres, 1e3 * told, 1e3 * within.itemOf(BudgetPart::prediction).metres);
    EXPECT_NEAR(told, std::sqrt(level * squares), 0.15 * told) << "the rest is the filter's";
    EXPECT_LT(within.itemOf(BudgetPart::prediction).metres, 0.4 * told);
}

TEST(ErrorBudget, PredictionLeavesAsMuchForEveryHand) {
    const PoseError noise{0.001, 0.2 * kDegree};
    for (const double speed : {0.0, 0.3, 0.8}) {
        CarryingHand hand;
        hand.speed = speed;
        const double one = std::sqrt(predictionLeaves(hand, noise, 0.08, 1).place.trace());
        for (const std::uint32_t seed : {2U, 3U, 4U}) {
            const double other = std::sqrt(predictionLeaves(hand, noise, 0.08, seed).place.trace());
            EXPECT_NEAR(one, other, 0.15 * one) << speed << " m/s";
        }
        std::printf("  at %.1f m/s prediction leaves %.2f mm, without it the way is %.1f mm\n", speed, 1e3 * one,
                    80.0 * speed);
        if (speed > 0.0) {
            EXPECT_LT(one, 0.5 * 0.08 * speed) << "at most half of what there is without prediction";
        }
    }
    EXPECT_THROW((void)predictionLeaves({-1.0}, noise, 0.08), InvalidInput);
}

TEST(ErrorBudget, TakesWhatMeasurementsSayOfThemselves) {
    const Rig& rig = budgetTablet();
    Installation room = defaultInstallation();
    const std::vector<double> half(rig.actuatorCount(), 0.5);
    const RoomErrors before = errorsOf(room, rig, half);
    EXPECT_EQ(before.sourceOf(BudgetPart::eye), ErrorSource::assumed);
    EXPECT_NEAR(before.eye, 0.025, 1e-9) << "as the lab draws it";
    room.origins.eyeOffset = {Origin::Way::measured, withSigma("alignments, 8", {0.003, 0.0, 0.0}), ""};
    room.origins.deviceBody = {Origin::Way::measured, "by somebody else", ""};
    room.origins.tracker = {Origin::Way::entered, "", ""};
    room.servos.push_back({rig.actuators()[0].name, {}, 0.1}); // of which only the lag is known
    room.origins.servos = {Origin::Way::measured, "", ""};
    const RoomErrors after = errorsOf(room, rig, half);
    EXPECT_EQ(after.sourceOf(BudgetPart::eye), ErrorSource::told);
    EXPECT_NEAR(after.eye * std::sqrt(3.0), 0.003, 1e-6);
    EXPECT_EQ(after.sourceOf(BudgetPart::device), ErrorSource::measured);
    EXPECT_LT(after.device.metres, 0.1 * before.device.metres);
    EXPECT_EQ(after.sourceOf(BudgetPart::tracker), ErrorSource::assumed) << "typed in is not measured";
    EXPECT_TRUE(after.isTrackerPlaced);
    EXPECT_EQ(after.sourceOf(BudgetPart::servos), ErrorSource::assumed);
    const RoomErrors again = measuredAgain(after, rig, BudgetPart::eye);
    EXPECT_NEAR(again.eye, 0.5 * after.eye, 1e-12);
}

TEST(ErrorBudget, WhatTheLabMadeIsSimulatedAndMeasuringItIsNew) {
    const Rig& rig = budgetTablet();
    Installation room = defaultInstallation();
    const std::vector<double> half(rig.actuatorCount(), 0.5);
    room.origins.delays = {Origin::Way::simulated, withSigma("20 flashes", {0.0, 0.0, 0.004}), ""};
    room.projectors.front().lens = {Origin::Way::measured, "structured light, 6 boards", ""};
    EXPECT_EQ(errorsOf(room, rig, half).sourceOf(BudgetPart::projector), ErrorSource::measured);
    room.projectors.front().pose = {Origin::Way::simulated, "check by structured light", ""};
    const RoomErrors errors = errorsOf(room, rig, half);
    EXPECT_EQ(errors.sourceOf(BudgetPart::delay), ErrorSource::simulated);
    EXPECT_NEAR(errors.delay, 0.004, 1e-6) << "as large as in the lab";
    EXPECT_EQ(errors.sourceOf(BudgetPart::projector), ErrorSource::simulated) << "the lab moved it";
    EXPECT_EQ(measuredAgain(errors, rig, BudgetPart::delay).sourceOf(BudgetPart::delay), ErrorSource::measured);
    EXPECT_TRUE(budgetOf(rig, slipModelOf(rig, room), errors).isSimulated);
    EXPECT_FALSE(budgetOf(rig, slipModelOf(rig, room), errorsOf(defaultInstallation(), rig, half)).isSimulated);
    RoomErrors large = errors;
    large.delay = 0.2;
    const ErrorBudget budget = budgetOf(rig, slipModelOf(rig, room), large);
    const auto delay = std::ranges::find(budget.advice, BudgetPart::delay, &BudgetAdvice::part);
    ASSERT_NE(delay, budget.advice.end());
    EXPECT_TRUE(delay->isFirst) << "nobody measured it in the room";
}

TEST(ErrorBudget, AdvisesThePartThatCountsMost) {
    const Draws draws = drawsOf(1.0, Judge::planes);
    RoomErrors errors = draws.errors;
    errors.isTrackerPlaced = true;
    errors.device = {0.0001, 0.0001};
    errors.tracker = {0.0001, 0.0001};
    errors.strokes.assign(errors.strokes.size(), 0.0);
    for (BeamError& light : errors.lights) light.metres = 0.0001;
    errors.eye = 0.1;
    const ErrorBudget budget = budgetOf(budgetTablet(), draws.model, errors, CarryingHand{0.0});
    ASSERT_FALSE(budget.advice.empty());
    EXPECT_EQ(budget.advice.front().part, BudgetPart::eye);
    EXPECT_LT(budget.advice.front().after, 0.2 * budget.total);
    SlipView onSurface = draws.view;
    onSurface.floats = 0.0;
    const ErrorBudget flat =
        budgetOf(budgetTablet(), slipModelOf(budgetTablet(), draws.believed, onSurface), errors, CarryingHand{0.0});
    EXPECT_LT(flat.itemOf(BudgetPart::eye).metres, 1e-9) << "what lies on the surface needs no eye";
}

TEST(MeasuredSigma, IsReadBackFromTheMethod) {
    const MeasuredSigma sigma{0.000212, 0.0009, 0.0013, 0.0001};
    const std::string method = withSigma("touched dots, 12", sigma);
    const MeasuredSigma read = sigmaOf({Origin::Way::measured, method, ""});
    EXPECT_NEAR(read.metres, sigma.metres, 0.01 * sigma.metres) << method;
    EXPECT_NEAR(read.radians, sigma.radians, 0.01 * sigma.radians) << method;
    EXPECT_NEAR(read.seconds, sigma.seconds, 0.01 * sigma.seconds) << method;
    EXPECT_NEAR(read.tipMetres, sigma.tipMetres, 0.01 * sigma.tipMetres) << method;
    const double open = std::numeric_limits<double>::infinity();
    EXPECT_EQ(withSigma("seen", {open, 0.0, 0.0}), "seen");
    for (const char* text :
         {"", "touched dots, 12", "\u00B1", "\u00B1 mm", "\u00B1-3 mm", "\u00B1nan mm", "\u00B13 km"})
        EXPECT_EQ(sigmaOf({Origin::Way::measured, text, ""}), MeasuredSigma{}) << text;
}

} // namespace
} // namespace lumorph
