#include "tests/fuzz/stage_recording_seeds.h"

#include <functional>
#include <stdexcept>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include "calibration/stages/stage_tables.h"
#include "core/scene/installation_store.h"
#include "tests/core/scene/scenes.h"
#include "tests/fuzz/stage_recording_input.h"

namespace {

using namespace lumorph;

/// A picture whose file has no byte that ends a part.
cv::Mat picture(int type) { return {6, 8, type, cv::Scalar::all(200)}; }

std::string fileOf(const cv::Mat& image) {
    std::vector<uchar> bytes;
    cv::imencode(".png", image, bytes);
    return {bytes.begin(), bytes.end()};
}

std::string inputOf(const StageRecording& recording) {
    std::string input = "2";
    const auto add = [&input](const std::string& part) {
        if (part.find(kPartEnd) != std::string::npos) throw std::logic_error("a part of a seed ends early");
        input += part + kPartEnd;
    };
    add(recording.stage);
    add(recording.method);
    for (const auto& [name, table] : recording.tables) {
        add(name + ".csv");
        add(tableText(table));
    }
    for (const auto& [name, image] : recording.pictures) {
        add(name + ".png");
        add(fileOf(image));
    }
    if (recording.truth) {
        add("truth.json");
        add(installationText(*recording.truth));
    }
    return input;
}

StageRecording named(const char* stage) {
    StageRecording recording;
    recording.stage = stage;
    return recording;
}

const std::vector<ProjectorPoint> kSeedLight{{{1.0, 2.5}, {3.0, 4.25}}, {{2.0, 0.5}, {-1e-3, 700.0}}};
const BoardPoints kSeedBoard{{{0.0, 0.0, 0.0}, {25.0, 0.0, 0.0}, {0.0, 25.0, 0.0}, {25.0, 25.0, 0.0}},
                             {{10.0, 10.0}, {20.5, 10.0}, {10.0, 21.0}, {20.0, 20.25}}};

StageRecording roomSeed() {
    BoardsCapture capture =
        emptyBoardsCapture("chess:9x7:25", {{"left", {64, 48}}}, {{"one", {80, 60}}, {"two", {80, 60}}},
                           {"pose_1", "pose_2", "pose_3", "pose_4"});
    for (InstallationView& view : capture.views) {
        view.corners.front() = kSeedBoard;
        for (auto& light : view.light.front()) light = kSeedLight;
    }
    StageRecording recording = stages::recordingOf(capture, named("room"));
    recording.truth = test::fullInstallation();
    return recording;
}

StageRecording mirrorSeed() {
    MirrorCapture capture{"chess:9x7:25", {64, 48}, {80, 60}, {}, {}};
    for (const char* name : {"pose_1", "pose_2", "pose_3", "pose_4"})
        capture.views.push_back({name, kSeedBoard, kSeedLight, kSeedBoard});
    return stages::recordingOf(capture, named("mirror"));
}

StageRecording deviceSeed() {
    StageRecording recording = named("device");
    auto& tables = recording.tables;
    tables["devices"].columns = stages::kDeviceColumns;
    tables["devices"].add("Camera", {0.0, 64.0, 48.0});
    tables["devices"].add("Projector", {1.0, 80.0, 60.0});
    tables["shots"] = {stages::shotColumns(kFuzzActuators), {}, {0.0, 0.0, 0.5, 1.0, 0.25, 0.0}};
    tables["light"].columns = stages::kLightColumns;
    for (std::size_t look = 0; look < 2; ++look) stages::addLight(tables["light"], look, kSeedLight);
    return recording;
}

PoseTrack track() {
    PoseTrack poses;
    poses.poses = {{0.0, {{0.1, 0.2, 0.3}, {1.0, 0.0, 0.0, 0.0}}}, {0.01, {{0.1, 0.25, 0.3}, {0.8, 0.6, 0.0, 0.0}}}};
    return poses;
}

StageRecording pointerSeed() {
    return stages::recordingOf(PointerCapture{track(), {{{"a", track(), {}}}, {{"b", track(), {}}}}}, named("pointer"));
}

StageRecording trackerSeed() {
    const TouchedDot dot{1, {40.5, 30.0}, {"dot", track(), {}}};
    return stages::recordingOf(DotCapture{{dot, dot}, {dot}}, named("tracker"));
}

StageRecording bodySeed() {
    const TouchedLandmark corner{{0.1, 0.0, 0.2}, std::nullopt, {"corner", track(), track()}},
        side{{0.1, 0.0, 0.0}, glm::dvec3(0.0, 1.0, 0.0), {"side, upper", track(), track()}};
    return stages::recordingOf(
        stages::DeviceTouches{{{corner, side}, {corner}}, LitDeviceCapture{kSeedLight, track(), {side}}},
        named("body"));
}

StageRecording eyeSeed() {
    const Alignment mark{{0.1, 0.0, 0.2}, {"mark", track(), track()}};
    return stages::recordingOf(EyeCapture{{mark, mark}, {mark}}, named("eye"));
}

StageRecording servosSeed() {
    ServoPlan plan;
    plan.groups = {{0}, {1}};
    plan.steps = {{ServoStep::Kind::rest, {}, {0.0, 0.0}}, {ServoStep::Kind::level, {0, 1}, {0.5, 0.25}}};
    StageRecording recording = stages::recordingOf(plan, kFuzzActuators, {}, named("servos"));
    for (std::size_t look = 0; look < 2; ++look) stages::addLight(recording.tables["light"], look, kSeedLight);
    recording.tables["looks"] = {{"count"}, {}, {2.0}};
    return recording;
}

StageRecording delaysSeed() {
    DelaysCapture capture;
    capture.seconds = 2.0;
    capture.flashes.flashes = {{0.5, 0.625}};
    capture.flashes.pictures = {{0.1, 12.0}, {0.6, 90.0}};
    capture.mark.pictures = {{0.1, {0.1, 0.2, 0.3}, {0.1, 0.0, 0.3}}};
    capture.tracked = capture.seen = track();
    capture.steps = {{"flap 1", {{0.0, 0.5}}, {{0.1, 0.25}, {0.2, 0.5}}}};
    return stages::recordingOf(capture, named("delays"));
}

StageRecording lightSeed() {
    StageRecording recording = named("light");
    const auto photographed = [&](const LightShow& show, double seconds) {
        RecordedTable& table = recording.tables["photographs"];
        recording.pictures[stages::lightPictureName(table.rows())] = picture(CV_8UC3);
        const std::vector<double> row = stages::rowOf(show, seconds);
        table.numbers.insert(table.numbers.end(), row.begin(), row.end());
    };
    recording.tables["photographs"].columns = stages::photographColumns(kFuzzProjectors);
    photographed({glm::ivec3(255), std::nullopt}, 0.01);
    photographed({std::nullopt, glm::ivec3(0, 128, 0)}, 0.01);
    recording.tables["exposures"] = {stages::kRangeColumns, {}, {0.001, 0.1, 0.01, 5.0}};
    recording.tables["sheet"] = {stages::kSheetColumns, {}, {0, 0, 0, 0.1, 0, 0, 0.1, 0, 0.1, 0, 0, 0.1}};
    return recording;
}

StageRecording checkSeed() {
    StageRecording recording = named("verify");
    recording.method = "graycode";
    recording.tables["stands"] = {stages::standColumns(kFuzzActuators), {}, {0.0, 0.0, 0.5, 0.5}};
    recording.tables["passes"] = {stages::kPassColumns, {}, {0, 0, 2, 1, 0, 2}};
    for (std::size_t pass = 0; pass < 2; ++pass)
        for (std::size_t index = 0; index < 2; ++index)
            recording.pictures[stages::checkPictureName(pass, index)] = picture(CV_8UC1);
    return recording;
}

} // namespace

std::vector<StageRecordingSeed> stageRecordingSeeds() {
    std::vector<StageRecordingSeed> seeds;
    for (const auto& make : {roomSeed, mirrorSeed, deviceSeed, pointerSeed, trackerSeed, bodySeed, eyeSeed, servosSeed,
                             delaysSeed, lightSeed, checkSeed}) {
        const StageRecording recording = make();
        seeds.push_back({recording.stage, inputOf(recording)});
    }
    return seeds;
}
