#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <random>
#include <stop_token>
#include <thread>

#include "app/studio/calibration/table_bench.h"
#include "calibration/lab/check_lab.h"
#include "calibration/lab/moved_room.h"
#include "calibration/verify/room_verification.h"
#include "calibration/verify/verify_lab.h"
#include "core/base/error.h"
#include "tests/ui/devices_window.h"

// A check with the device on the table: a simulated board drives its servos, and what the camera sees is worked out by
// the lab's rays from where the board's servos stand and from what the projector's screen was told to show.

namespace lumorph::test {
namespace {

using namespace std::chrono_literals;

/// A room with one projector of few pixels and a camera of this machine.
Installation tableRoom() {
    Installation room = defaultInstallation();
    room.projectors.resize(1);
    room.projectors.front().camera = withSize(room.projectors.front().camera, {960, 540});
    room = withLabCamera(room);
    room.cameras.front().address = "/dev/video9";
    return room;
}

constexpr double kUsualExposure = 1.0 / 60.0; // seconds, in which the lab's camera sees enough

/// What screen and camera of a test share.
struct Table {
    Table(const Rig& shownRig, Installation really) : rig(shownRig), truth(std::move(really)) {}

    const Rig& rig;
    Installation truth; ///< as it really is
    std::function<std::vector<double>()> strokes;
    std::mutex mutex;
    cv::Mat shown;
    std::vector<std::vector<double>> photographed; ///< strokes, one a bend
    std::optional<CheckLab> lab;
    /// Somebody knocks against the camera in looks at patterns from .. to.
    int patterns = 0, bumpFrom = 0, bumpTo = 0;
    double exposed = 0.001; ///< seconds: a camera that was switched on just now sees hardly anything
    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>();

    cv::Mat look() {
        const std::scoped_lock lock(mutex);
        const std::vector<double> now = strokes();
        const auto differs = [](double a, double b) { return std::abs(a - b) > 0.01; };
        if (!lab || !std::ranges::equal(photographed.back(), now, std::not_fn(differs))) {
            photographed.push_back(now);
            lab.emplace(truth, rig, now, CheckLabOptions{}, 7);
        }
        const glm::ivec2 size = truth.projectors.front().camera.size;
        cv::Mat picture = lab->photograph(0, shown.empty() ? cv::Mat::zeros(size.y, size.x, CV_8U) : shown);
        picture.convertTo(picture, -1, exposed / kUsualExposure);
        double darkest = 0.0, lightest = 0.0;
        if (!shown.empty()) cv::minMaxLoc(shown.reshape(1), &darkest, &lightest);
        patterns += darkest < lightest ? 1 : 0;
        if (patterns < bumpFrom || patterns >= bumpTo) return picture;
        constexpr int kRight = 9, kDown = 5; // pixels
        const cv::Size kept(picture.cols - kRight, picture.rows - kDown);
        cv::Mat knocked = picture.clone();
        picture(cv::Rect({0, 0}, kept)).copyTo(knocked(cv::Rect({kRight, kDown}, kept)));
        return knocked;
    }
};

class TableCamera final : public CaptureCamera {
public:
    explicit TableCamera(Table& table) : table_(table) {}
    [[nodiscard]] cv::Mat grab(const Progress& progress) override {
        progress.throwIfCancelled();
        cv::Mat picture = table_.look();
        table_.clock->advance(Microseconds{33'000}); // however long it took to work it out
        return picture;
    }
    [[nodiscard]] std::string name() const override { return "table"; }
    [[nodiscard]] cv::Size size() const override { return {}; }
    [[nodiscard]] std::optional<Exposures> exposures() const override { return Exposures{1e-4, 0.1}; }
    void setExposure(double seconds) override { table_.exposed = seconds; }

private:
    Table& table_;
};

class TableScreen final : public PatternDisplay {
public:
    explicit TableScreen(Table& table) : table_(table) {}
    [[nodiscard]] cv::Size size() const override {
        const glm::ivec2 size = table_.truth.projectors.front().camera.size;
        return {size.x, size.y};
    }
    void show(const cv::Mat& picture, const Progress& progress) override {
        progress.throwIfCancelled();
        const std::scoped_lock lock(table_.mutex);
        table_.shown = picture.clone();
    }
    void clear() override {
        const std::scoped_lock lock(table_.mutex);
        table_.shown.release();
    }

private:
    Table& table_;
};

class TableBenchTest : public DevicesWindow {
protected:
    /// Where the horns of the board's servos are.
    [[nodiscard]] std::vector<double> standing() {
        std::vector<double> strokes;
        const DeviceProfile profile = window.studio().devices.profile();
        for (std::size_t i = 0; i < profile.servos.size(); ++i) {
            const ServoSetup& servo = profile.servos[i];
            const double stroke =
                (servoOf(i).position - servo.pulseMin - servo.trim) / (servo.pulseMax - servo.pulseMin);
            strokes.push_back(std::clamp(servo.reversed ? 1.0 - stroke : stroke, 0.0, 1.0));
        }
        return strokes;
    }
    /// The bench and its check in a thread of their own, as a job has them; the window goes on meanwhile.
    [[nodiscard]] std::optional<VerifiedRoom> check(
        Table& table, const Installation& believed, std::string& trouble,
        const std::function<void()>& meanwhile = [] {}) {
        // The board's servos are asked in the window's thread, as the profile is the window's.
        std::mutex mutex;
        std::vector<double> now = standing();
        table.strokes = [&] {
            const std::scoped_lock lock(mutex);
            return now;
        };
        auto bench = studio::openTable({&window.studio().devices,
                                        [&](std::size_t) { return std::make_unique<TableScreen>(table); },
                                        [&](const std::string& address) {
                                            opened = address;
                                            return std::make_unique<TableCamera>(table);
                                        },
                                        table.clock},
                                       believed);
        EXPECT_TRUE(bench->source().isSimulated()) << "the board is no real one";
        std::optional<VerifiedRoom> found;
        std::atomic<bool> isDone = false;
        std::thread job([&, bench = std::move(bench)]() mutable {
            try {
                VerifyOptions options;
                options.pattern = "phase:16x3+1x3";
                options.cameraWidth = 480;
                options.isJudged = false;
                found = verifyRoom(table.rig, believed, bench->device({}), {}, options);
            } catch (const std::exception& error) {
                trouble = error.what();
            }
            bench.reset();
            isDone = true;
        });
        EXPECT_TRUE(eventually(
            [&] {
                const std::scoped_lock lock(mutex);
                now = standing();
                meanwhile();
                return isDone.load();
            },
            120s));
        job.join();
        return found;
    }

    std::string opened;
};

TEST_F(TableBenchTest, ACheckStandsTheServosInBendsAndTellsWhatHasMoved) {
    goLive();
    const Installation believed = tableRoom();
    const Rig& rig = *window.state().rig.rig;
    Table table(rig, pushed(believed, rig, parseLabPush("projector:3mm", rig), 1));
    table.bumpFrom = 6;
    table.bumpTo = 10;
    std::string trouble;
    const auto found = check(table, believed, trouble);
    ASSERT_TRUE(found) << "what was disturbed once is photographed again; " << trouble;
    EXPECT_EQ(opened, "/dev/video9");
    EXPECT_EQ(found->check.verdict, RoomCheck::Verdict::moved) << found->check.sentence;
    ASSERT_EQ(found->check.names.size(), 1U);
    EXPECT_EQ(found->check.names.front(), "projector");
    // Where the horns were when the pictures were taken is what the bends say.
    const auto bends = checkBends(rig);
    for (const std::vector<double>& bend : bends)
        EXPECT_TRUE(std::ranges::any_of(table.photographed, [&](const std::vector<double>& seen) {
            return std::ranges::equal(seen, bend, [](double a, double b) { return std::abs(a - b) < 0.03; });
        })) << "a bend was not photographed";
    EXPECT_LE(table.photographed.size(), bends.size() + 1) << "nothing moved while it was photographed";
    EXPECT_TRUE(eventually([&] { return !window.studio().devices.testing(); }, 20s)) << "back to the show";
}

TEST_F(TableBenchTest, StopEndsItWithWhatToDo) {
    goLive();
    const Installation believed = tableRoom();
    Table table(*window.state().rig.rig, believed);
    std::string trouble;
    bool isStopped = false;
    const auto found = check(table, believed, trouble, [&] {
        if (isStopped || !window.studio().devices.testing()) return;
        isStopped = true;
        window.studio().devices.stopNow();
    });
    EXPECT_FALSE(found);
    EXPECT_NE(trouble.find("not driven any more"), std::string::npos) << trouble;
    EXPECT_TRUE(allLimp());
}

/// A device that is put down, in a tracker's own frame: it slides for the first second, and trembles by 0.2 mm.
TEST(RestingDevice, IsWhereItLiesOnceItLies) {
    PoseBoard board;
    const auto stream = board.stream("tablet", PoseRole::device);
    Installation room = defaultInstallation();
    room.worldFromTracker[3] = glm::vec4(0.0F, 0.5F, 0.0F, 1.0F);
    room.bodyFromDevice[3] = glm::vec4(0.0F, -0.02F, 0.0F, 1.0F);
    EXPECT_THROW(static_cast<void>(studio::withRestingDevice(room, PoseBoard{}, {})), DeviceError);
    std::atomic<bool> ends = false;
    std::thread tracker([&] {
        std::mt19937 dice(12);
        std::normal_distribution<double> tremble(0.0, 2e-4);
        const glm::dquat turn = glm::angleAxis(0.4, glm::dvec3(0.0, 1.0, 0.0));
        for (int k = 0; !ends; ++k) {
            const glm::dvec3 place(0.1 - 0.002 * std::min(k, 50), -0.48, 0.03);
            const glm::dvec3 off(tremble(dice), tremble(dice), tremble(dice));
            stream->push({Microseconds{20'000 * (k + 1)}, true, {place + off, turn}});
            std::this_thread::sleep_for(20ms);
        }
    });
    const Installation found = studio::withRestingDevice(room, board, {});
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW(static_cast<void>(studio::withRestingDevice(room, board, Progress({}, stop.get_token()))), Cancelled);
    ends = true;
    tracker.join();
    EXPECT_LT(glm::distance(glm::vec3(found.worldFromDevice[3]), glm::vec3(0.0F, 0.0F, 0.03F)), 5e-4F);
    EXPECT_NEAR(std::atan2(-found.worldFromDevice[0].z, found.worldFromDevice[0].x), 0.4, 1e-4);
}

TEST_F(TableBenchTest, WhatIsMissingIsToldInTheChain) {
    window.window().showWorkspace("calibrate");
    window.click("calibrate.whole");
    window.click("chain.link.check");
    window.click("chain.way.live");
    EXPECT_TRUE(window.text("chain.live.seen").contains("no camera of this machine"));
    const auto room = window.state().installation;
    window.click("chain.card.next");
    EXPECT_TRUE(eventually([&] { return window.text("chain.card.text").contains("Calibrate projector and camera"); }))
        << window.text("chain.card.text").toStdString();
    EXPECT_EQ(window.state().installation, room);
    window.studio().document.change("A camera", [](studio::StudioState& state) {
        state.installation = std::make_shared<const Installation>(tableRoom());
    });
    EXPECT_TRUE(eventually([&] { return window.text("chain.live.seen").contains("start them in Devices"); }));
    window.screenshot("check_on_table");
}

} // namespace
} // namespace lumorph::test
