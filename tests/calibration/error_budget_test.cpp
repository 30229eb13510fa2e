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
#include "calibration/lab/registration_lab.h"
#include "calibration/lab/true_room.h"
#include "calibration/servos/servo_lab.h"
#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/rig/rig_file.h"
#include "core/scene/measured_sigma.h"

// The budget against the lab: true rooms are drawn with the same errors, and rays say how far what is shown slips.

namespace lumorph {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kSpeed = 0.3; // of the hand, m/s

const Rig& budgetTablet() {
    static const Rig rig = readRig(resourceFile("models/tablet.glb"));
    return rig;
}

/// Errors that a draw may have.
struct Drawn {
    bool light = false, tracker = false, device = false, eye = false, servos = false, delay = false;
};

/// One true room beside the believed one, judged by rays.
class TrueShow {
public:
    TrueShow(const Installation& believed, const RoomErrors& errors, const SlipView& view, const Drawn& drawn,
             std::uint32_t seed)
        : believed_(believed), view_(view), engine_(seed) {
        const Rig& rig = budgetTablet();
        LabErrors lab;
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
        glm::dmat4 carried(1.0);
        if (drawn.delay) {
            const double late = truth.predictionSeconds + truth.trackerSeconds - believed.predictionSeconds -
                                believed.trackerSeconds;
            const double way = std::uniform_real_distribution<double>(0.0, 6.283185307179586)(engine_);
            carried =
                glm::translate(glm::dmat4(1.0), kSpeed * late * glm::dvec3(std::cos(way), 0.0, std::sin(way)));
        }
        const glm::dmat4 body = glm::dmat4(believed.worldFromDevice) * glm::inverse(glm::dmat4(believed.bodyFromDevice));
        worldFromDevice_ = carried * tracker * body * glm::dmat4(truth.bodyFromDevice);
        const glm::dvec3 head = glm::dvec3(believed.eye) - glm::dvec3(believed.eyeFromHead);
        eye_ = glm::dvec3(tracker * glm::dvec4(head + glm::dvec3(truth.eyeFromHead), 1.0));
        projectors_ = believed.projectors;
        if (drawn.light)
            for (InstalledProjector& projector : projectors_) tilt(projector.camera, errors.light);
        TriangleMesh mesh = deformed(rig, trueStrokes_);
        for (glm::vec3& vertex : mesh.positions) vertex = glm::vec3(worldFromDevice_ * glm::dvec4(vertex, 1.0));
        LabWorld world;
        world.surfaces = {{std::move(mesh), glm::vec3(1.0F)}};
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
        const glm::dvec3 beam = glm::normalize(
            glm::dvec3(camera.cameraFromWorld * glm::dvec4(device, 1.0)));
        turn -= beam * glm::dot(beam, turn);
        camera.cameraFromWorld =
            glm::rotate(glm::dmat4(1.0), glm::length(turn), glm::normalize(turn)) * camera.cameraFromWorld;
    }
    /// Where the light of what belongs to a place lands, less where the eye should see it, across the sight.
    [[nodiscard]] std::optional<double> slipAt(const SlipPoint& point) const {
        const glm::dvec3 believedEye(believed_.eye);
        const glm::dvec3 shown =
            point.at.point + view_.floats * glm::normalize(believedEye - point.at.point);
        const glm::dvec3 onDevice(glm::inverse(glm::dmat4(believed_.worldFromDevice)) * glm::dvec4(shown, 1.0));
        const glm::dvec3 real(worldFromDevice_ * glm::dvec4(onDevice, 1.0));
        const auto wanted = lab_->trace(eye_, glm::normalize(real - eye_));
        const auto pixel = pixelOf(believed_.projectors[point.projector].camera, point.at.point);
        if (!wanted || !pixel) return std::nullopt;
        const CalibratedCamera& projector = projectors_[point.projector].camera;
        const auto lands = lab_->trace(positionOf(projector), directionOf(projector, *pixel));
        if (!lands) return std::nullopt;
        const glm::dvec3 off = lands->point - wanted->point, sight = glm::normalize(real - eye_);
        return glm::length(off - sight * glm::dot(sight, off));
    }

    Installation believed_;
    SlipView view_;
    std::mt19937 engine_;
    std::vector<double> commanded_, trueStrokes_;
    glm::dmat4 worldFromDevice_{1.0};
    glm::dvec3 eye_{0.0};
    std::vector<InstalledProjector> projectors_;
    std::optional<Lab> lab_;
};

struct Measured {
    double metres = 0.0, lost = 0.0;
};

Measured measured(const Installation& believed, const RoomErrors& errors, const SlipView& view,
                  const SlipModel& model, const Drawn& drawn, int draws) {
    double squares = 0.0, count = 0.0, lost = 0.0;
    for (int k = 0; k < draws; ++k)
        TrueShow(believed, errors, view, drawn, 100U + static_cast<std::uint32_t>(k))
            .judge(model.points, squares, count, lost);
    return {std::sqrt(squares / count), lost / (count + lost)};
}

TEST(ErrorBudget, IsWhatTheLabMeasuresWithTheSameErrors) {
    const int draws = std::getenv("LUMORPH_LONG_TESTS") != nullptr ? 1000 : 160;
    const Rig& rig = budgetTablet();
    Installation believed = defaultInstallation();
    SlipView view;
    view.tries = 800;
    const SlipModel model = slipModelOf(rig, believed, view);
    RoomErrors errors = errorsOf(believed, rig, commandedOf(view, rig));
    errors.noise = {}; // of the prediction another test tells
    CarryingHand hand{kSpeed};
    errors.ahead = 0.0;
    const ErrorBudget budget = budgetOf(rig, model, errors, hand);
    ASSERT_GT(model.points.size(), 100U);
    struct Row {
        BudgetPart part;
        Drawn drawn;
    };
    const std::array<Row, 6> rows{Row{BudgetPart::projector, {.light = true}}, Row{BudgetPart::tracker, {.tracker = true}},
                                  Row{BudgetPart::device, {.device = true}},   Row{BudgetPart::eye, {.eye = true}},
                                  Row{BudgetPart::servos, {.servos = true}},   Row{BudgetPart::delay, {.delay = true}}};
    double squares = 0.0;
    for (const Row& row : rows) {
        const Measured lab = measured(believed, errors, view, model, row.drawn, draws);
        const double told = budget.itemOf(row.part).metres;
        squares += told * told;
        std::printf("%-10s budget %6.3f mm, lab %6.3f mm (%.1f %% of the places lost)\n", keyOf(row.part), 1e3 * told,
                    1e3 * lab.metres, 100.0 * lab.lost);
        EXPECT_NEAR(told, lab.metres, 0.15 * lab.metres) << keyOf(row.part);
        EXPECT_LT(lab.lost, 0.25) << keyOf(row.part);
    }
    const Measured all = measured(believed, errors, view, model, {true, true, true, true, true, true}, draws);
    std::printf("%-10s budget %6.3f mm, lab %6.3f mm\n", "all", 1e3 * std::sqrt(squares), 1e3 * all.metres);
    EXPECT_NEAR(std::sqrt(squares), all.metres, 0.15 * all.metres);
}

} // namespace
} // namespace lumorph
