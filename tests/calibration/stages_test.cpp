#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <span>
#include <string_view>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "calibration/capture/boards_at_table.h"
#include "calibration/lab/boards_lab.h"
#include "calibration/lab/moved_room.h"
#include "calibration/lab/true_room.h"
#include "calibration/light/camera_light.h"
#include "calibration/patterns/capture_order.h"
#include "calibration/stages/lab_bench.h"
#include "calibration/stages/stage.h"
#include "core/base/error.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/cut_tablet.h"

// What a stage recorded is written, read and solved again to the same figures; what is damaged, cut short or of
// something else is refused by its name.

namespace lumorph {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A room with a projector of few pixels, and its truth; all that a stage builds on is known.
struct StageRoom {
    StageSite site{std::make_shared<const Rig>(test::cutTablet()), withLabCamera(defaultInstallation())};
    Installation truth;

    explicit StageRoom(const std::string& stage, std::uint32_t seed) {
        CalibratedCamera& lamp = site.room.projectors.front().camera;
        lamp = withSize(lamp, {480, 270});
        if (stage == "room") {
            site.room.projectors.push_back(site.room.projectors.front());
            site.room.projectors.back().name = "Side";
        }
        truth = stage == "verify"   ? pushed(site.room, *site.rig, {"projector", 3e-3, 0.0}, seed)
                : stage == "device" ? site.room // its servos do what they are told
                                    : trueRoom(site.room, site.rig->actuators(), seed);
        site.room.pointerTip = truth.pointerTip;
        site.room.worldFromTracker = truth.worldFromTracker;
    }
};

struct Kept {
    MeasuredStage measured;
    std::unique_ptr<TemporaryFolder> folder = std::make_unique<TemporaryFolder>();
    [[nodiscard]] std::filesystem::path place() const { return *folder / "recording"; }
};

/// Each is recorded once for all tests.
const Kept& keptOf(const std::string& stage) {
    static std::map<std::string, Kept> all;
    if (const auto found = all.find(stage); found != all.end()) return found->second;
    constexpr std::uint32_t kSeed = 11;
    const StageRoom room(stage, kSeed);
    LabBenchOptions options;
    options.checkPattern = "phase:16x3+1x3";
    options.boards.poses = 5;
    LabBench bench(*room.site.rig, room.truth, kSeed, options);
    Kept& kept = all[stage];
    kept.measured = measureStage(calibrationStage(stage), room.site, bench);
    writeStageRecording(kept.measured.recording, kept.place());
    return kept;
}

/// All numbers of a result that are no dates.
std::vector<double> numbersOf(const StageResult& result) {
    std::vector<double> numbers;
    const auto add = [&numbers](std::initializer_list<double> more) { numbers.insert(numbers.end(), more); };
    if (const auto* of = std::get_if<Registration>(&result)) {
        add({of->rms, of->turnSigma, of->shiftSigma, of->fresh.rms, of->fresh.worst});
        for (const PointError& point : of->points) add({point.metres});
        for (const PointError& point : of->fresh.points) add({point.metres});
    } else if (const auto* places = std::get_if<PlacedDevices>(&result)) {
        add({places->rms, places->heldOut.median, places->heldOut.most});
        for (const PlacedDevices::Device& device : places->devices)
            add({device.rms, device.focalSigma, device.shiftSigma, device.heldOut.medianPixels});
    } else if (const auto* light = std::get_if<LightCalibration>(&result)) {
        add({light->fresh.median, light->fresh.most, light->before.median, light->responseRms, light->ambient,
             double(light->photographs)});
    } else if (const auto* servos = std::get_if<ServoMeasurement>(&result)) {
        add({servos->seconds, servos->measured.rms, servos->measured.freshDegrees, servos->measured.freshWorst});
        for (const ServoFinding& servo : servos->measured.servos)
            add({servo.backlashDegrees, servo.backlashSigma, servo.curveSigma});
    } else if (const auto* delays = std::get_if<MeasuredDelays>(&result)) {
        add({delays->light.seconds, delays->light.sigma, delays->tracker.seconds, delays->mark.seconds, delays->seconds,
             delays->gain.value().with.always});
        for (const MeasuredDelays::Servo& servo : delays->servos) add({servo.step.lag.seconds, servo.step.play});
    } else {
        const auto& check = std::get<VerifiedRoom>(result);
        add({check.check.now.median, check.check.now.worst, check.check.corrected.median, check.fresh.median,
             double(check.photographs), double(check.check.map.size())});
    }
    return numbers;
}

class StagesTest : public ::testing::TestWithParam<const char*> {};

TEST_P(StagesTest, AreSolvedFromWhatWasWrittenToTheSameFigures) {
    const std::string key = GetParam();
    const Kept& kept = keptOf(key);
    const StageRoom room(key, 11);
    EXPECT_TRUE(isGood(kept.measured.result) || key == "verify");
    const StageRecording read = readStageRecording(kept.place());
    EXPECT_EQ(read.source, kept.measured.recording.source);
    for (const auto& [name, table] : kept.measured.recording.tables) // as text: what is no number equals nothing
        EXPECT_EQ(tableText(read.tables.at(name)), tableText(table)) << name;
    const StageResult again = solveStage(calibrationStage(key), read, room.site);
    EXPECT_EQ(again.index(), kept.measured.result.index());
    EXPECT_EQ(numbersOf(again), numbersOf(kept.measured.result)) << "bit for bit";
    EXPECT_EQ(figuresOf(roomOf(again)), figuresOf(roomOf(kept.measured.result)));
    EXPECT_NE(figuresOf(roomOf(again)), figuresOf(room.site.room)) << "something was measured";
    // What the lab made stays so, whoever solves it.
    Installation applied = room.site.room;
    calibrationStage(key).apply(roomOf(again), applied);
    EXPECT_TRUE(realParts(applied).empty()) << realParts(applied).front();
}

TEST_P(StagesTest, RefuseWhatIsDamagedCutShortOrOfSomethingElseByItsName) {
    const std::string key = GetParam();
    const Kept& kept = keptOf(key);
    const StageRoom room(key, 11);
    const auto refusalOf = [&](const std::function<void(const std::filesystem::path&)>& spoil) {
        const TemporaryFolder folder;
        std::filesystem::copy(kept.place(), folder / "spoilt", std::filesystem::copy_options::recursive);
        spoil(folder / "spoilt");
        try {
            (void)solveStage(calibrationStage(key), readStageRecording(folder / "spoilt"), room.site);
        } catch (const DataError& error) {
            return std::string(error.what());
        }
        return std::string("nothing was refused");
    };
    const std::string table = kept.measured.recording.tables.begin()->first + ".csv";
    EXPECT_THAT(refusalOf([&](const auto& at) {
                    std::fstream file(at / table, std::ios::in | std::ios::out);
                    file.seekp(-2, std::ios::end);
                    file.put('7').put('7');
                }),
                ::testing::AllOf(HasSubstr(table), HasSubstr("damaged")));
    EXPECT_THAT(refusalOf([&](const auto& at) {
                    std::filesystem::resize_file(at / table, std::filesystem::file_size(at / table) / 2);
                }),
                ::testing::AllOf(HasSubstr(table), HasSubstr("cut short")));
    EXPECT_THAT(refusalOf([&](const auto& at) { std::filesystem::remove(at / table); }), HasSubstr(table));
    EXPECT_THAT(refusalOf([](const auto& at) { std::ofstream(at / kRecordingFile) << "{}"; }),
                HasSubstr("no recording of a calibration"));
    // Of another stage, of another device.
    StageRecording foreign = kept.measured.recording;
    foreign.device = "flower";
    EXPECT_THROW((void)solveStage(calibrationStage(key), foreign, room.site), DataError);
    foreign = kept.measured.recording;
    foreign.stage = key == "light" ? "delays" : "light";
    EXPECT_THROW((void)solveStage(calibrationStage(key), foreign, room.site), DataError);
    // Sound files in which a part is missing.
    foreign = kept.measured.recording;
    foreign.tables.clear();
    EXPECT_THROW((void)solveStage(calibrationStage(key), foreign, room.site), DataError);
}

TEST(StageRefusals, OfBoardsWithPointsThatAreNoneOrTooFew) {
    const StageRecording& sound = keptOf("room").measured.recording;
    const StageRoom room("room", 11);
    const auto solve = [&](const std::function<void(RecordedTable&)>& spoil, const char* table) {
        StageRecording spoilt = sound;
        spoil(spoilt.tables.at(table));
        (void)solveStage(calibrationStage("room"), spoilt, room.site);
    };
    const auto spoilNumber = [](RecordedTable& table) { table.numbers.back() = NAN; };
    EXPECT_THROW(solve(spoilNumber, "corners"), DataError);
    EXPECT_THROW(solve(spoilNumber, "light"), DataError);
    EXPECT_THROW(solve([](RecordedTable& table) { table.numbers.resize(3 * table.columns.size()); }, "corners"),
                 DataError);
    EXPECT_THROW(solve([](RecordedTable& table) { table.numbers.front() = 99.0; }, "corners"), DataError);
}

/// As if a camera had given its pictures turned left for right.
StageRecording withTurnedPictures(StageRecording recording) {
    const double last = recording.tables.at("devices").row(0)[1] - 1.0; // of the camera, which comes first
    for (const char* name : {"corners", "light"}) {
        RecordedTable& table = recording.tables.at(name);
        const auto column =
            static_cast<std::size_t>(std::ranges::find(table.columns, "camera_column") - table.columns.begin());
        for (std::size_t i = column; i < table.numbers.size(); i += table.columns.size())
            table.numbers[i] = last - table.numbers[i];
    }
    return recording;
}

// Without a mirror it is the camera that mirrors; before a mirror, what is no mirror image was seen past it.
TEST(StageRefusals, OfBoardsWhosePicturesAreTurnedLeftForRight) {
    for (const auto& [key, words] :
         {std::pair("room", "mirror images of each other"), {"mirror", "not seen in a mirror"}}) {
        const StageRoom room(key, 11);
        const StageRecording& sound = keptOf(key).measured.recording;
        const auto refusal = refusalOf(solveStage(calibrationStage(key), withTurnedPictures(sound), room.site));
        ASSERT_TRUE(refusal) << key;
        EXPECT_EQ(refusal->cause, Cause::mirrored) << key;
        EXPECT_NE(refusal->why.find(words), std::string::npos) << refusal->why;
    }
}

INSTANTIATE_TEST_SUITE_P(All, StagesTest,
                         ::testing::Values("room", "mirror", "device", "light", "pointer", "tracker", "body", "eye",
                                           "servos", "delays", "verify"),
                         [](const auto& of) { return std::string(of.param); });

/// Millimetres by which light that is meant for points of table and device falls beside them.
double worstLight(const CalibratedCamera& found, const CalibratedCamera& truth) {
    double worst = 0.0;
    for (const double x : {-0.1, 0.0, 0.1})
        for (const double z : {-0.1, 0.0, 0.1})
            for (const double y : {0.0, 0.1}) {
                const glm::dvec3 point(x, y, z);
                const auto meant = pixelOf(found, point);
                if (!meant) return HUGE_VAL;
                // Where that pixel's ray truly passes the point.
                const glm::dvec3 from = positionOf(truth), way = directionOf(truth, *meant);
                worst = std::max(worst, glm::length(glm::cross(point - from, way)));
            }
    return 1e3 * worst;
}

TEST(StagePlaces, TwoProjectorsAndTheMirrorAreFoundWhereTheyTrulyStand) {
    for (const auto& [key, most] : {std::pair("room", 0.5), {"mirror", 1.0}, {"device", 0.5}}) {
        const MeasuredStage& measured = keptOf(key).measured;
        const auto& places = std::get<PlacedDevices>(measured.result);
        ASSERT_TRUE(places.good()) << sentenceOf(*places.refusal);
        const Installation& truth = measured.recording.truth.value();
        for (std::size_t k = 0; k < truth.projectors.size(); ++k) {
            const double beside = worstLight(places.room.projectors[k].camera, truth.projectors[k].camera);
            std::printf("%s, projector %zu: %.2f mm beside at worst; held out %.2f mm (median), %.2f px\n", key, k + 1,
                        beside, 1e3 * places.heldOut.median, places.heldOut.medianPixels);
            EXPECT_LT(beside, most) << key;
        }
        EXPECT_GE(places.heldOut.points, 3U);
        const StageRoom room(key, 11);
        if (std::string(key) == "device") continue; // it stands as believed; only the stage does not know
        EXPECT_GT(worstLight(room.site.room.projectors.back().camera, truth.projectors.back().camera), 5.0)
            << "what was believed is far from it";
    }
}

TEST(StageRefusals, AreTheSameOnceTheyAreSolvedFromTheRecording) {
    constexpr std::pair<const char*, const char*> kFaults[] = {{"light", "saturated"}, {"light", "dark"},
                                                               {"light", "ambient"},   {"delays", "covered"},
                                                               {"delays", "still"},    {"room", "pushed"}};
    for (const auto& [key, fault] : kFaults) {
        const StageRoom room(key, 7);
        LabBench bench(*room.site.rig, room.truth, 7, labWithFault(key, fault));
        const CalibrationStage& stage = calibrationStage(key);
        const MeasuredStage measured = measureStage(stage, room.site, bench);
        ASSERT_TRUE(refusalOf(measured.result)) << key << " " << fault;
        const TemporaryFolder folder;
        writeStageRecording(measured.recording, folder / "refused");
        const StageResult again = solveStage(stage, readStageRecording(folder / "refused"), room.site);
        EXPECT_EQ(refusalOf(again), refusalOf(measured.result)) << key << " " << fault;
        EXPECT_EQ(figuresOf(roomOf(again)), figuresOf(room.site.room)) << "nothing of it is used";
    }
}

/// Devices that are not the lab's, as far as anybody can tell.
class TouchTable final : public Bench {
public:
    explicit TouchTable(LabBench& lab) : lab_(lab) {}
    [[nodiscard]] RecordingSource source() const override {
        return {RecordingSource::Kind::table, "a tracked pointer", "2026-11-20T10:00:00Z", 0};
    }
    [[nodiscard]] PointerCapture recordPointer(const StageSite& site, const Progress& progress) override {
        return lab_.recordPointer(site, progress);
    }

private:
    LabBench& lab_;
};

TEST(StageSources, AreMeasuredAtTheTableAndRecordedOnceTheyAreSolvedAgain) {
    const StageRoom room("pointer", 4);
    LabBench lab(*room.site.rig, room.truth, 4);
    TouchTable table(lab);
    const CalibrationStage& stage = calibrationStage("pointer");
    const MeasuredStage measured = measureStage(stage, room.site, table);
    EXPECT_EQ(roomOf(measured.result).origins.pointer.way, Origin::Way::measured);
    const Origin again = roomOf(solveStage(stage, measured.recording, room.site)).origins.pointer;
    EXPECT_EQ(again.way, Origin::Way::recorded);
    EXPECT_EQ(again.date, "2026-11-20T10:00:00Z") << "when it was recorded, not when it was solved";
    EXPECT_THAT(again.method, HasSubstr("recorded by a tracked pointer: "));
    EXPECT_FALSE(measured.recording.truth);
}

TEST(StageSources, ABenchThatLacksSomethingSaysWhatAndNothingTakesItsPlace) {
    const StageRoom room("pointer", 4);
    LabBench lab(*room.site.rig, room.truth, 4);
    TouchTable table(lab);
    for (const CalibrationStage& stage : calibrationStages()) {
        if (stage.hasSequence() || stage.key == std::string_view("pointer")) continue;
        try {
            (void)measureStage(stage, room.site, table);
            ADD_FAILURE() << stage.key;
        } catch (const DeviceError& error) {
            const bool touches = std::ranges::find(stage.needs, "pointer") != stage.needs.end();
            EXPECT_EQ(error.subject(), touches ? "tracker" : "camera") << stage.key;
        }
    }
}

TEST(StageRecordings, TablesKeepEachNumberAndName) {
    RecordedTable table{{"a", "b"}, {}, {}};
    table.add("one, \"two\"", {0.1, -1e-300});
    table.add("", {1.0 / 3.0, 12345678901234567.0});
    EXPECT_EQ(parseTable(tableText(table), "table"), table);
    for (const char* text : {"", "name\n", "a,b\n1\n", "a,b\n1,2,3\n", "a,b\n1,x\n", "a,,b\n", "name,a\nx\n"})
        EXPECT_THROW((void)parseTable(text, "table"), DataError) << text;
}

/// As PNG and gzip have it (ISO 3309).
std::uint32_t checksumOf(std::string_view bytes) {
    std::uint32_t sum = 0xFFFFFFFFU;
    for (const unsigned char byte : bytes) {
        sum ^= byte;
        for (int bit = 0; bit < 8; ++bit) sum = sum >> 1U ^ ((sum & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    return ~sum;
}

// Kept as it was broken: the checksum of the file is right.
TEST(StageRecordings, APictureThatCannotBeUnpackedIsRefused) {
    std::vector<uchar> png;
    cv::imencode(".png", cv::Mat(6, 8, CV_8UC3, cv::Scalar::all(200)), png);
    const std::string sound(png.begin(), png.end());
    const auto read = [](const std::string& file) {
        const std::string description =
            R"({"lumorph": "calibration recording", "version": 2, "stage": "light", "method": "", "device": "",
                "source": {"kind": "lab", "who": "", "date": "", "seed": 1}, "files": [{"name": "a.png", "bytes": )" +
            std::to_string(file.size()) + R"(, "crc32": )" + std::to_string(checksumOf(file)) + "}]}";
        return parseStageRecording(description, "recording", [&](const std::string&) {
            const auto bytes = std::as_bytes(std::span(file));
            return std::vector<std::byte>(bytes.begin(), bytes.end());
        });
    };
    EXPECT_EQ(read(sound).pictures.at("a").size(), cv::Size(8, 6));
    for (std::size_t i = 24; i < sound.size(); ++i)
        for (const unsigned bit : {1U, 16U, 128U}) {
            std::string broken = sound;
            broken[i] = static_cast<char>(static_cast<unsigned char>(broken[i]) ^ bit);
            try {
                EXPECT_FALSE(read(broken).pictures.at("a").empty()) << "byte " << i;
            } catch (const DataError&) {
            }
        }
}

TEST(StageRecordings, LargeTablesArePackedAndComeBackBitForBit) {
    StageRecording recording;
    recording.stage = "servos";
    RecordedTable& light = recording.tables["light"];
    light.columns = {"look", "column"};
    for (int i = 0; i < 200'000; ++i) light.add({double(i / 1000), std::sin(0.1 * i)});
    recording.tables["looks"] = {{"count"}, {}, {200.0}};
    const TemporaryFolder folder;
    writeStageRecording(recording, folder / "large");
    const auto sizeOf = [&](const char* name) { return std::filesystem::file_size(folder / "large" / name); };
    EXPECT_LT(sizeOf("light.csv.gz"), tableText(light).size() / 2);
    EXPECT_EQ(sizeOf("looks.csv"), 10U) << "what is small can be read as it is";
    EXPECT_EQ(readStageRecording(folder / "large").tables, recording.tables);
    // Other programs unpack it.
    const std::string place = (folder / "large").string();
    ASSERT_EQ(std::system(("gzip -t '" + place + "/light.csv.gz'").c_str()), 0);
    std::filesystem::resize_file(folder / "large" / "light.csv.gz", 1000);
    EXPECT_THROW((void)readStageRecording(folder / "large"), DataError);
}

/// A camera and a projector's window before the lab's light, and somebody who covers the lens when asked.
struct LightTable {
    LightLab& lab;
    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>();
    glm::ivec3 shown{0};
    bool isCovered = false, isGrey = false;
    double seconds = 1.0 / 60.0;
};

class LightCamera final : public CaptureCamera {
public:
    explicit LightCamera(LightTable& table) : table_(table) {}
    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        progress.throwIfCancelled();
        table_.clock->advance(Microseconds{33'000});
        cv::Mat picture =
            table_.lab.photograph({table_.isCovered ? std::nullopt : std::optional(table_.shown)}, table_.seconds);
        cv::Mat bgr;
        cv::cvtColor(picture, bgr, cv::COLOR_RGB2BGR);
        if (table_.isGrey) cv::extractChannel(picture, bgr, 0);
        return bgr;
    }
    [[nodiscard]] std::string name() const override { return "/dev/video9"; }
    [[nodiscard]] cv::Size size() const override { return {}; }
    [[nodiscard]] std::optional<Exposures> exposures() const override { return Exposures{1.0 / 8000.0, 0.5}; }
    void setExposure(double seconds) override { table_.seconds = seconds; }

private:
    LightTable& table_;
};

class LightScreen final : public PatternDisplay {
public:
    explicit LightScreen(LightTable& table) : table_(table) {}
    [[nodiscard]] cv::Size size() const override { return {480, 270}; }
    void show(const cv::Mat& picture, const Progress&) override {
        const cv::Scalar mean = cv::mean(picture);
        table_.shown = picture.channels() == 1 ? glm::ivec3(int(mean[0])) : glm::ivec3(mean[2], mean[1], mean[0]);
    }
    void clear() override { table_.shown = glm::ivec3(0); }

private:
    LightTable& table_;
};

class ConnectedLight final : public Bench {
public:
    explicit ConnectedLight(LightTable& table) : table_(table), camera_(table), screen_(table) {}
    [[nodiscard]] RecordingSource source() const override { return {RecordingSource::Kind::table, "camera 9", "", 0}; }
    [[nodiscard]] LightBench& light(const StageSite&, const std::optional<WhiteSheet>&, const Progress&) override {
        const Progress hands([this](double, std::string_view stage) {
            if (stage.starts_with("cover the lens of Projector")) table_.isCovered = true;
            if (stage.starts_with("uncover the lens of Projector")) table_.isCovered = false;
        });
        return light_.emplace(camera_, std::vector<PatternDisplay*>{&screen_}, std::vector<std::string>{"Projector"},
                              hands, table_.clock);
    }

private:
    LightTable& table_;
    LightCamera camera_;
    LightScreen screen_;
    std::optional<CameraLight> light_;
};

TEST(StageAtTheTable, LightIsMeasuredByAConnectedCameraWhileSomebodyCoversTheLens) {
    const StageRoom room("light", 23);
    LightLabOptions options;
    options.laysSheet = false;
    LightLab lab(room.truth, *room.site.rig, lightLabCamera(room.truth, options), std::nullopt, options, 23);
    LightTable table{lab};
    ConnectedLight bench(table);
    const MeasuredStage measured = measureStage(calibrationStage("light"), room.site, bench);
    const auto& light = std::get<LightCalibration>(measured.result);
    ASSERT_TRUE(light.good()) << sentenceOf(*light.refusal);
    const InstalledProjector &found = light.room.projectors.front(), &truth = room.truth.projectors.front();
    std::printf("light at the table: fresh greys %.2f %%, black %.4f of %.4f\n", 100.0 * light.fresh.median,
                double(found.black.g), double(truth.black.g));
    EXPECT_LT(light.fresh.median, 0.01);
    EXPECT_NEAR(found.black.g, truth.black.g, 0.001F);
    EXPECT_EQ(found.response.way, Origin::Way::measured);
    EXPECT_EQ(numbersOf(solveStage(calibrationStage("light"), measured.recording, room.site)),
              numbersOf(measured.result));
}

/// A board before the lab's light, and somebody who lays it elsewhere when asked, and once pushes it too early.
class ConnectedBoards final : public Bench {
public:
    explicit ConnectedBoards(BoardLab& lab)
        : lab_(lab), camera_(openLabCamera(lab)), screen_(openLabDisplay(lab)), places_(lab.possiblePoses(20)),
          eyes_(*this), wall_(*this) {}
    [[nodiscard]] RecordingSource source() const override { return {RecordingSource::Kind::table, "camera 9", "", 0}; }
    [[nodiscard]] BoardsCapture recordBoards(const StageSite& site, const Progress&) override {
        std::string asked;
        const Progress hands([&](double, std::string_view words) {
            const bool isAsked = words.starts_with("lay the board") || words.starts_with("place ");
            if (isAsked && words != asked) lay(); // also where a pose is asked for again
            asked = isAsked ? words : std::string_view();
            isAsked_ = isAsked;
        });
        BoardsAtTable table;
        table.camera = &eyes_;
        table.projectors = {{site.room.projectors.front().name, &wall_}};
        table.pattern = kFourStepPattern;
        table.poses = 5;
        table.clock = clock_;
        return captureBoards(table, hands);
    }
    std::size_t laid = 0;

private:
    struct Eyes final : CaptureCamera {
        explicit Eyes(ConnectedBoards& of) : bench(of) {}
        [[nodiscard]] cv::Mat grab(const Progress& progress) override {
            bench.clock_->advance(Microseconds{100'000});
            // Where nothing comes of it, one lays it elsewhere.
            if (bench.isAsked_ && ++bench.waited_ % 6 == 0) bench.lay();
            return bench.camera_->grab(progress);
        }
        [[nodiscard]] std::string name() const override { return "/dev/video9"; }
        [[nodiscard]] cv::Size size() const override { return bench.camera_->size(); }
        ConnectedBoards& bench;
    };
    struct Wall final : PatternDisplay {
        explicit Wall(ConnectedBoards& of) : bench(of) {}
        [[nodiscard]] cv::Size size() const override { return bench.screen_->size(); }
        void show(const cv::Mat& picture, const Progress& progress) override {
            bench.screen_->show(picture, progress);
            // In the middle of the third place's patterns somebody comes too near.
            if (bench.isAsked_ || bench.laid < 3 || bench.isPushed_ || ++bench.shown_ < 10) return;
            bench.isPushed_ = true;
            bench.lab_.lay(glm::translate(bench.places_[bench.laid - 1], {0.01, 0.0, 0.0}));
        }
        void clear() override { bench.screen_->clear(); }
        ConnectedBoards& bench;
    };
    void lay() {
        lab_.lay(places_.at(laid++));
        waited_ = 0;
    }

    BoardLab& lab_;
    std::unique_ptr<CaptureCamera> camera_;
    std::unique_ptr<PatternDisplay> screen_;
    std::vector<glm::dmat4> places_;
    std::shared_ptr<ManualClock> clock_ = std::make_shared<ManualClock>();
    Eyes eyes_;
    Wall wall_;
    int shown_ = 0, waited_ = 0;
    bool isAsked_ = false, isPushed_ = false;
};

TEST(StageAtTheTable, BoardsAreNoticedAsTheyAreLaidAndAPushedOneIsTakenAgain) {
    const StageRoom room("room", 41);
    Installation truth = labRoomTruth(room.site.room);
    truth.projectors.resize(1);
    StageSite site = room.site;
    site.room.projectors.resize(1);
    BoardLab lab(truth, parseCalibrationBoard("chess:9x7:25"), {}, 41);
    ConnectedBoards bench(lab);
    const MeasuredStage measured = measureStage(calibrationStage("room"), site, bench);
    const auto& places = std::get<PlacedDevices>(measured.result);
    ASSERT_TRUE(places.good()) << sentenceOf(*places.refusal);
    EXPECT_GE(bench.laid, 6U) << "five places, and another in place of the one that was pushed";
    const double beside = worstLight(places.room.projectors.front().camera, truth.projectors.front().camera);
    std::printf("boards at the table: %.2f mm beside at worst, held out %.2f px\n", beside,
                places.heldOut.medianPixels);
    EXPECT_LT(beside, 0.5);
    EXPECT_EQ(places.room.projectors.front().pose.way, Origin::Way::measured);
}

TEST(StageAtTheTable, ALensThatIsUncoveredIsSeenAtAnyExposure) {
    const StageRoom room("light", 23);
    LightLabOptions options;
    options.laysSheet = false;
    LightLab lab(room.truth, *room.site.rig, lightLabCamera(room.truth, options), std::nullopt, options, 23);
    LightTable table{lab};
    LightCamera camera(table);
    LightScreen screen(table);
    std::string asked;
    const Progress hands([&](double, std::string_view stage) {
        if (stage.starts_with("cover")) table.isCovered = true;
        if (stage.starts_with("uncover")) table.isCovered = false;
        asked = stage;
    });
    CameraLight light(camera, {&screen}, {"Projector"}, hands, table.clock);
    const LightShow white{glm::ivec3(255)};
    (void)light.photograph(white, 1.0 / 60.0);
    EXPECT_EQ(asked.find("cover"), std::string::npos) << asked;
    (void)light.photograph({std::nullopt}, 0.25);
    EXPECT_TRUE(asked.starts_with("cover the lens")) << asked;
    EXPECT_TRUE(table.isCovered);
    (void)light.photograph(white, 1.0 / 500.0);
    EXPECT_TRUE(asked.starts_with("uncover the lens")) << asked;
    EXPECT_EQ(table.seconds, 1.0 / 500.0);
    (void)light.photograph({std::nullopt}, 1.0 / 250.0);
    EXPECT_TRUE(table.isCovered);
}

TEST(StageAtTheTable, LightIsMeasuredByACameraWithoutColour) {
    const StageRoom room("light", 31);
    LightLabOptions options;
    options.laysSheet = false;
    options.mixing = 1.0 / 3.0; // each channel sees all light alike: one of them is a grey camera
    LightLab lab(room.truth, *room.site.rig, lightLabCamera(room.truth, options), std::nullopt, options, 31);
    LightTable table{lab};
    table.isGrey = true;
    ConnectedLight bench(table);
    const MeasuredStage measured = measureStage(calibrationStage("light"), room.site, bench);
    const auto& light = std::get<LightCalibration>(measured.result);
    ASSERT_TRUE(light.good()) << sentenceOf(*light.refusal);
    const InstalledProjector &found = light.room.projectors.front(), &truth = room.truth.projectors.front();
    // What it sees of all channels together is what it can tell.
    const glm::vec3 whites = truth.gain * (1.0F - truth.black);
    const float black = glm::dot(truth.gain, truth.black) / (whites.r + whites.g + whites.b);
    const float share = black / (1.0F + black);
    std::printf("light by a grey camera: fresh greys %.2f %%, black %.4f of %.4f\n", 100.0 * light.fresh.median,
                double(found.black.g), double(share));
    EXPECT_LT(light.fresh.median, 0.01);
    EXPECT_NEAR(found.black.g, share, 0.0005F);
    EXPECT_NEAR(found.gain.r, 1.0F, 1e-5F) << "one projector has no tint beside others";
    EXPECT_THAT(light.assumption, HasSubstr("sees no colour"));
    EXPECT_EQ(numbersOf(solveStage(calibrationStage("light"), measured.recording, room.site)),
              numbersOf(measured.result));
}

} // namespace
} // namespace lumorph
