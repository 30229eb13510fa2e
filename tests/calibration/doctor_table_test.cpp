#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "calibration/doctor/alternatives.h"
#include "calibration/doctor/capture_calibration.h"
#include "calibration/doctor/sequence_check.h"
#include "calibration/lab/lab_capture.h"
#include "calibration/lab/lab_lens.h"
#include "calibration/report/calibrated_room.h"
#include "tests/support/long_tests.h"
#include "tests/support/truth.h"

namespace lumorph::test {
namespace {

/// What the doctor says of a capture.
struct Verdict {
    bool refused = false;
    std::vector<Cause> causes;
    std::string sentence;
    double beside = 0.0; ///< as `lightBesidePixels`, of one that is accepted

    [[nodiscard]] bool names(Cause cause) const { return std::ranges::find(causes, cause) != causes.end(); }
    /// Of a cause that is not there. The lab holds some boards where the projector's light is too bright for the
    /// exposure: a warning of that is true.
    [[nodiscard]] bool namesOther(std::optional<Cause> fault) const {
        return std::ranges::any_of(causes,
                                   [&](Cause cause) { return cause != fault && (refused || cause != Cause::clipped); });
    }
};

/// Table's trials have seeds from here on; the doctor's limits were chosen on those below 200.
constexpr std::uint32_t kFirstSeed = 1001;

/// Beyond so many projector pixels an accepted calibration is not good; 0.5 mm on the lab's table.
constexpr double kHarmless = 1.0;

/// The table's trials alone where LUMORPH_DOCTOR_SEED=14 names one, for who wants to look at it: then what each cause
/// that residuals do not tell apart would explain is printed too, here for `keystone`:
///     LUMORPH_DOCTOR_SEED=14 lumorph_calibration_tests --gtest_filter='*OfObservations*/keystone'
std::optional<std::uint32_t> loneSeed() {
    const char* text = std::getenv("LUMORPH_DOCTOR_SEED");
    if (text == nullptr) return std::nullopt;
    return static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}

/// Seeds of a line of the table.
std::vector<std::uint32_t> seedsOf(std::uint32_t first, int count) {
    if (const auto lone = loneSeed()) return {*lone};
    std::vector<std::uint32_t> seeds(static_cast<std::size_t>(count));
    std::iota(seeds.begin(), seeds.end(), first);
    return seeds;
}

/// What each cause would explain of a capture.
void printAlternatives(const ReadCapture& read) {
    SolveOptions unjudged;
    unjudged.judgesFit = false;
    try {
        const ProcamCalibration result = calibrateProcam(read.views, read.camera, read.order.projector, unjudged);
        std::printf("  camera %s %.3f px, projector %s %.3f px, halves %.2f of %.2f\n", result.camera.model.c_str(),
                    result.camera.rms, result.projector.model.c_str(), result.projector.rms,
                    result.halvesDiffer.value_or(0.0), result.halvesAllowed.value_or(0.0));
        for (const Alternative& by : alternativesOf(read.views, result, read.order))
            std::printf("  %-20s amount %8.2f explained %6.3f sigmas %7.1f  %s\n", std::string(keyOf(by.cause)).c_str(),
                        by.amount, by.explained, by.sigmas, by.words.c_str());
    } catch (const CaptureRefused& refused) {
        std::printf("  solver: %s\n", sentenceOf(refused.finding()).c_str());
    }
}

/// How far light that a calibration sends to places on the table, and as high as a device lifts its skin, truly falls
/// beside them: 95 of 100 are nearer. Projector pixels.
double lightBesidePixels(const LabCapturer& capturer, const ProcamCalibration& result) {
    const BoardLab& lab = capturer.lab();
    const Installation room = withCalibration(capturer.capture().room, result, lab.board());
    const LabLens lamp = lensOf(room.projectors.front().camera, "calibrated projector");
    std::vector<double> beside;
    for (const double y : {0.0, 0.05})
        for (int i = -4; i <= 4; ++i)
            for (int k = -4; k <= 4; ++k) {
                const glm::dvec3 place(0.03 * i, y, 0.02 * k);
                const auto sent = imageOf(lamp, place), meets = lab.projectorPixel(place);
                beside.push_back(sent && meets ? glm::distance(*sent, *meets) : HUGE_VAL);
            }
    return quantileOf(beside, 0.95);
}

Verdict verdictOf(const LabCapturer& capturer, const std::function<ProcamCalibration()>& run) {
    Verdict verdict;
    try {
        const ProcamCalibration result = run();
        for (const Finding& warning : result.warnings) {
            verdict.causes.push_back(warning.cause);
            verdict.sentence += sentenceOf(warning) + " ";
        }
        verdict.beside = lightBesidePixels(capturer, result);
    } catch (const CaptureRefused& refused) {
        verdict = {true, {refused.finding().cause}, sentenceOf(refused.finding())};
    }
    return verdict;
}

/// The lab with smaller pictures: projector 480 x 270, camera 640 x 512.
LabCapture smallCapture(std::uint32_t seed, std::optional<Cause> fault) {
    LabCapture capture;
    capture.room = defaultInstallation();
    CalibratedCamera& projector = capture.room.projectors.front().camera;
    capture.room.cameras.push_back({"Camera", "", withSize(defaultLabCamera(projector), {640, 512}), {}, {}});
    projector = withSize(projector, {480, 270});
    capture.poses = 4;
    capture.seed = seed;
    capture.fault = fault;
    return capture;
}

/// Photographs a capture and hands it to the doctor, without a disk in between.
Verdict verdictOfImages(const LabCapture& what) {
    LabCapturer capturer(what);
    const glm::ivec2 size = capturer.lab().projector().camera.size;
    const CaptureOrder order = parsePattern(what.pattern, {size.x, size.y});
    return verdictOf(capturer, [&] {
        ReadCapture read;
        read.order = order;
        for (int pose = 0; pose < what.poses; ++pose) {
            CapturedView view;
            std::vector<cv::Mat> images;
            for (const LabShot& shot : capturer.takeNext()) {
                view.name = shot.view;
                view.files.emplace_back(shot.file);
                images.push_back(shot.grey);
            }
            if (const auto wrong = checkCounts({view}, order)) throw CaptureRefused(*wrong);
            ReadPose got = readPose(view, images, capturer.lab().board(), order);
            read.camera = images.front().size();
            read.views.push_back(std::move(got.observations));
            read.warnings.insert(read.warnings.end(), got.warnings.begin(), got.warnings.end());
        }
        if (loneSeed()) printAlternatives(read);
        return calibrateCapture(read, order.projector);
    });
}

/// What three steps of phase say of a place when the projector shows value^gamma, as a share of a period.
double phaseUnderGamma(double turns, double gamma) {
    constexpr double kTurn = 2.0 * 3.14159265358979323846;
    double sine = 0.0;
    double cosine = 0.0;
    for (int step = 0; step < 3; ++step) {
        const double light = std::pow(0.5 + 0.5 * std::cos(kTurn * (turns - step / 3.0)), gamma);
        sine += light * std::sin(kTurn * step / 3.0);
        cosine += light * std::cos(kTurn * step / 3.0);
    }
    const double seen = std::atan2(sine, cosine) / kTurn;
    return seen + std::round(turns - seen);
}

/// What a good decoder would see of a capture in the lab: points where the lab's truth puts them, with noise.
std::vector<ViewObservations> observationsOf(LabCapturer& capturer, std::uint32_t seed) {
    const LabCapture& capture = capturer.capture();
    BoardLab lab(capture.room, capturer.lab().board(), capture.options, capture.seed);
    const std::vector<cv::Point3d> named = pointsOf(lab.board());
    const glm::dvec2 size = lab.projector().camera.size;
    std::mt19937 random(seed);
    std::normal_distribution<double> grain;
    const bool phases = capture.fault == Cause::projectorGamma;
    const double focus = 1.0 + (random() % 2 == 0 ? 1.0 : -1.0) * std::uniform_real_distribution<>(0.012, 0.03)(random);
    const auto from = static_cast<std::size_t>(1 + random() % static_cast<unsigned>(capture.poses - 1));
    std::vector<ViewObservations> views;
    for (const glm::dmat4& pose : capturer.poses()) {
        if (capture.fault == Cause::cameraRefocused && views.size() == from) {
            CalibratedCamera camera = lab.camera();
            camera.focal *= focus;
            lab.setCamera(camera);
        }
        ViewObservations& view = views.emplace_back();
        view.name = "pose_" + std::to_string(views.size() - 1);
        const auto place = [&](double x, double y) { return glm::dvec3(pose * glm::dvec4(lab.place(x, y), 1.0)); };
        for (const cv::Point3d& point : named) {
            const auto seen = lab.cameraPixel(place(point.x, point.y));
            view.corners.board.push_back(point);
            view.corners.seen.emplace_back(seen->x + 0.07 * grain(random), seen->y + 0.07 * grain(random));
        }
        for (int row = 0; row < 20; ++row)
            for (int column = 0; column < 25; ++column) {
                const glm::dvec3 at = place(named.back().x * column / 24.0, named.back().y * row / 19.0);
                const auto seen = lab.cameraPixel(at);
                glm::dvec2 lit = *lab.projectorPixel(at);
                if (phases)
                    for (int axis = 0; axis < 2; ++axis)
                        lit[axis] =
                            phaseUnderGamma(16.0 * (lit[axis] + 0.5) / size[axis], 2.2) * size[axis] / 16.0 - 0.5;
                view.projector.push_back(
                    {{seen->x, seen->y}, {lit.x + 0.08 * grain(random), lit.y + 0.08 * grain(random)}});
            }
    }
    return views;
}

Verdict verdictOfObservations(const LabCapture& what) {
    LabCapturer capturer(what);
    ReadCapture read;
    read.views = observationsOf(capturer, what.seed);
    const glm::ivec2 camera = capturer.lab().camera().size;
    const glm::ivec2 projector = capturer.lab().projector().camera.size;
    read.camera = {camera.x, camera.y};
    read.order = parsePattern(what.pattern, {projector.x, projector.y});
    if (loneSeed()) printAlternatives(read);
    return verdictOf(capturer, [&] { return calibrateCapture(read, read.order.projector); });
}

Verdict verdictOfObservations(std::uint32_t seed, std::optional<Cause> fault) {
    LabCapture capture;
    capture.room = defaultInstallation();
    capture.seed = seed;
    capture.fault = fault;
    if (fault == Cause::projectorGamma) capture.pattern = "phase:16x3+1x3";
    return verdictOfObservations(capture);
}

/// A line of the table whose aim is missed: how many of 20 have another cause than the right one.
struct Shortfall {
    Cause fault = Cause::lateFrame;
    int wrong = 0;
};

/// One line of the table. A capture with a fault is refused or warned of by its cause, or accepted without a word where
/// it is as good as one without it; nothing else is right. Aim: no wrong cause, none that is harmed in silence, and the
/// cause named in nine of ten.
void expectNamed(Cause fault, int trials, std::span<const Shortfall> missed,
                 const std::function<Verdict(std::uint32_t)>& run) {
    int right = 0, harmless = 0, harmed = 0, wrong = 0;
    std::string others;
    const std::vector<std::uint32_t> seeds = seedsOf(kFirstSeed, trials);
    for (const std::uint32_t seed : seeds) {
        const Verdict verdict = run(seed);
        const bool isOther = verdict.namesOther(fault);
        if (verdict.names(fault) && !isOther) {
            ++right;
            continue;
        }
        ++(isOther ? wrong : verdict.beside <= kHarmless ? harmless : harmed);
        char beside[64] = "";
        if (!verdict.refused) std::snprintf(beside, sizeof(beside), " accepted, %.2f pixels beside", verdict.beside);
        others += "  [" + std::to_string(seed) + "]" + beside + " " + verdict.sentence;
    }
    std::printf("%-22s right %2d of %2d, silent and harmless %d, silent and harmed %d, another cause %d%s\n",
                std::string(keyOf(fault)).c_str(), right, static_cast<int>(seeds.size()), harmless, harmed, wrong,
                others.c_str());
    std::fflush(stdout);
    const auto known = std::ranges::find(missed, fault, &Shortfall::fault);
    EXPECT_LE(wrong, known == missed.end() ? 0 : known->wrong) << keyOf(fault) << others;
    EXPECT_EQ(harmed, 0) << keyOf(fault) << others;
    EXPECT_GE(right + harmless, 0.9 * static_cast<double>(seeds.size())) << keyOf(fault) << others;
}

const auto kKeyOfParam = [](const ::testing::TestParamInfo<Cause>& info) { return std::string(keyOf(info.param)); };

/// What falls short of the aim on these seeds.
const std::vector<Shortfall> kMissedByImages, kMissedByObservations, kMissedByFourPoses;

class DoctorTableOfImages : public ::testing::TestWithParam<Cause> {};

TEST_P(DoctorTableOfImages, NamesTheCause) {
    expectNamed(GetParam(), longTests() ? 20 : 1, kMissedByImages,
                [](std::uint32_t seed) { return verdictOfImages(smallCapture(seed, GetParam())); });
}

INSTANTIATE_TEST_SUITE_P(All, DoctorTableOfImages,
                         ::testing::Values(Cause::lateFrame, Cause::missingImage, Cause::doubledImage,
                                           Cause::blackWhiteSwapped, Cause::inverseSwapped, Cause::mirrored,
                                           Cause::rigMoved, Cause::projectorSize, Cause::widthHeightSwapped,
                                           Cause::clipped, Cause::cameraRefocused),
                         kKeyOfParam);

class DoctorTableOfObservations : public ::testing::TestWithParam<Cause> {};

TEST_P(DoctorTableOfObservations, NamesTheCause) {
    expectNamed(GetParam(), longTests() ? 20 : 1, kMissedByObservations,
                [](std::uint32_t seed) { return verdictOfObservations(seed, GetParam()); });
}

class DoctorTableOfFourPoses : public ::testing::TestWithParam<Cause> {};

// As in the table's photographs: fewer poses, smaller pictures.
TEST_P(DoctorTableOfFourPoses, NamesTheCause) {
    expectNamed(GetParam(), longTests() ? 20 : 1, kMissedByFourPoses,
                [](std::uint32_t seed) { return verdictOfObservations(smallCapture(seed, GetParam())); });
}

INSTANTIATE_TEST_SUITE_P(All, DoctorTableOfFourPoses, ::testing::Values(Cause::boardWarped, Cause::cameraRefocused),
                         kKeyOfParam);

INSTANTIATE_TEST_SUITE_P(All, DoctorTableOfObservations,
                         ::testing::Values(Cause::frontalViews, Cause::keystone, Cause::boardWarped, Cause::squareSize,
                                           Cause::strangeLens, Cause::projectorGamma, Cause::cameraRefocused),
                         kKeyOfParam);

/// One line of sound captures: none may be refused, and only those doubted that are overexposed in places.
void expectSound(const std::vector<std::uint32_t>& seeds, int mostOverexposed,
                 const std::function<Verdict(std::uint32_t)>& run) {
    int refused = 0;
    int overexposed = 0;
    int doubted = 0; // for anything else
    double farthest = 0.0;
    for (const std::uint32_t seed : seeds) {
        const Verdict verdict = run(seed);
        refused += verdict.refused;
        farthest = std::max(farthest, verdict.beside);
        overexposed += !verdict.refused && verdict.names(Cause::clipped);
        doubted += !verdict.refused && verdict.namesOther({});
        if (!verdict.causes.empty()) std::printf("  [%u] %s\n", seed, verdict.sentence.c_str());
    }
    std::printf("%-22s refused %d of %zu, overexposed in places %d, doubted for anything else %d, %.2f pixels beside\n",
                "sound", refused, seeds.size(), overexposed, doubted, farthest);
    std::fflush(stdout);
    EXPECT_EQ(refused, 0);
    EXPECT_EQ(doubted, 0);
    EXPECT_LE(overexposed, mostOverexposed);
    EXPECT_LE(farthest, kHarmless);
}

TEST(DoctorTableOfSound, ImagesAreAccepted) {
    std::vector<std::uint32_t> seeds = seedsOf(kFirstSeed, longTests() ? 8 : 1);
    if (!loneSeed()) seeds.push_back(101); // its board lies between bright light and its own shadow
    expectSound(seeds, 3, [](std::uint32_t seed) { return verdictOfImages(smallCapture(seed, {})); });
}

TEST(DoctorTableOfSound, ObservationsAreAccepted) {
    expectSound(seedsOf(kFirstSeed, longTests() ? 32 : 2), 0,
                [](std::uint32_t seed) { return verdictOfObservations(seed, {}); });
}

} // namespace
} // namespace lumorph::test
