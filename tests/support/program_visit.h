#pragma once

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include "app/applications/demo.h"
#include "core/loop/show_program.h"
#include "core/show/show_player.h"
#include "tests/support/cut_tablet.h"

/// An application asked frame by frame, as the loop asks it, and visited for long, in the loop itself.
namespace lumorph::test {

constexpr double kFrame = 1.0 / 60.0;

inline const std::shared_ptr<const Rig>& tabletRig() {
    static const auto rig = std::make_shared<const Rig>(test::cutTablet());
    return rig;
}

class ProgramVisit {
public:
    /// A frame every `step` seconds: long ones where only what comes in the end counts.
    explicit ProgramVisit(ShowProgram& program, double step = kFrame) : program_(program), step_(step) {
        moment_.rig = tabletRig();
        moment_.installation = std::make_shared<const Installation>(defaultInstallation());
    }

    const ShowContent& frame(std::vector<ShowInput> inputs = {}) {
        moment_.inputs = inputs;
        moment_.bodies = bodies_;
        content_ = program_.frame(moment_);
        moment_.inputs = {};
        moment_.step = step_;
        moment_.seconds += step_;
        for (const ShowSound& sound : content_.sounds) ++heard_[sound.name];
        return content_;
    }
    void frames(double seconds) {
        for (int k = 0; k < std::lround(seconds / step_); ++k) frame();
    }
    /// The tracked device leans so far about the world's axes, radians.
    void lean(float aboutX, float aboutZ) {
        bodies_ = {ShowBody{"Tablet", PoseRole::device, {}}};
        moment_.worldFromDevice = glm::mat4_cast(glm::angleAxis(aboutX, glm::vec3(1.0F, 0.0F, 0.0F)) *
                                                 glm::angleAxis(aboutZ, glm::vec3(0.0F, 0.0F, 1.0F)));
    }
    /// The viewer's eye is here from now on, world metres.
    void look(const glm::vec3& eye) { moment_.eye = eye; }
    void setLanguage(Language language) { moment_.language = language; }
    /// These bodies are tracked from now on.
    void see(std::vector<ShowBody> bodies) { bodies_ = std::move(bodies); }
    [[nodiscard]] const SceneItem& item(int id) const { return *findItem(*content_.scene, id); }
    [[nodiscard]] int heard(const std::string& sound) const {
        const auto found = heard_.find(sound);
        return found == heard_.end() ? 0 : found->second;
    }
    [[nodiscard]] const ShowContent& content() const { return content_; }

private:
    ShowProgram& program_;
    double step_;
    ShowMoment moment_;
    std::vector<ShowBody> bodies_;
    ShowContent content_;
    std::map<std::string, int> heard_;
};

/// Of one core, what this thread has used.
inline double threadSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of a vector that is not empty.
inline double shareOf(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// What a long visit found.
struct LongVisit {
    /// Megabytes of this process.
    struct Memory {
        double seconds = 0.0;
        double heap = 0.0;     ///< in use
        double resident = 0.0; ///< with the heap's holes
    };
    std::vector<Memory> memory;         ///< once a second
    std::vector<double> milliseconds;   ///< of one core, for each answer of the program
    double fastest = 0.0, wished = 0.0; ///< share of the velocity limit that servos reached, and were asked for
    std::vector<double> least, most;    ///< strokes of each servo
    std::string problem;                ///< where it ended early

    [[nodiscard]] double median() const { return shareOf(milliseconds, 0.5); }
    [[nodiscard]] double percentile99() const { return shareOf(milliseconds, 0.99); }
    /// The most in a span of the visit, seconds.
    [[nodiscard]] double mostOf(double Memory::*of, double from, double to) const {
        double found = 0.0;
        for (const Memory& one : memory)
            if (one.seconds >= from && one.seconds <= to) found = std::max(found, one.*of);
        return found;
    }
    /// What it held at most after a moment, over what it held then.
    [[nodiscard]] double grown(double Memory::*of, double since) const {
        const auto then = std::ranges::find_if(memory, [&](const Memory& one) { return one.seconds >= since; });
        return then == memory.end() ? 0.0 : mostOf(of, since, memory.back().seconds) - (*then).*of;
    }
};

inline LongVisit::Memory memoryNow(double seconds) {
    const struct mallinfo2 heap = ::mallinfo2();
    std::ifstream statm("/proc/self/statm");
    double size = 0.0, resident = 0.0;
    statm >> size >> resident;
    return {seconds, static_cast<double>(heap.uordblks + heap.hblkhd) / 1e6,
            resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6};
}

/// Notes what each answer of a program takes; the player's own clock stands still meanwhile.
class TimedProgram final : public ShowProgram {
public:
    TimedProgram(ShowProgram& program, std::vector<double>& milliseconds)
        : program_(program), milliseconds_(milliseconds) {}
    ShowContent frame(const ShowMoment& moment) override {
        const double begun = threadSeconds();
        ShowContent content = program_.frame(moment);
        milliseconds_.push_back(1e3 * (threadSeconds() - begun));
        return content;
    }

private:
    ShowProgram& program_;
    std::vector<double>& milliseconds_;
};

/// What visitors do in a frame: its number and time, seconds.
using VisitorsDo = std::function<void(int frame, double seconds, ShowInputs& inputs)>;

/// Lets visitors come and go for so many seconds, by the real loop in steps of `step`. Strokes beyond their range, and
/// a program that ends, are failures of the test that calls it.
inline LongVisit visitForLong(ShowProgram& program, double seconds, double step, const VisitorsDo& visitors) {
    const int frames = static_cast<int>(std::lround(seconds / step));
    const int perSecond = std::max(1, static_cast<int>(std::lround(1.0 / step)));
    LongVisit visit;
    visit.milliseconds.reserve(static_cast<std::size_t>(frames)); // so that the notes do not count as growth
    visit.memory.reserve(static_cast<std::size_t>(frames / perSecond + 1));
    MatchWish wish = wishOf(bundledTablet({}));
    wish.showTint = false;
    wish.program = std::make_shared<TimedProgram>(program, visit.milliseconds);
    wish.inputs = std::make_shared<ShowInputs>();
    wish.driver = Driver::program;
    const std::shared_ptr<const Rig> rig = wish.rig;
    ManualClock clock;
    ShowPlayer player(clock, wish);
    visit.least.assign(rig->actuatorCount(), 1.0);
    visit.most.assign(rig->actuatorCount(), 0.0);
    std::vector<double> before, wishedBefore;
    for (int k = 0; k < frames; ++k) {
        visitors(k, k * step, *wish.inputs);
        const MatchFrame& frame = *player.step(step);
        if (!frame.programError.empty()) visit.problem = frame.programError;
        for (std::size_t i = 0; i < rig->actuatorCount(); ++i) {
            const double stroke = frame.estimatedStrokes[i], limit = rig->actuators()[i].maxVelocity;
            if (!(stroke >= 0.0 && stroke <= 1.0))
                visit.problem = "servo " + std::to_string(i) + " at " + std::to_string(stroke);
            visit.least[i] = std::min(visit.least[i], stroke);
            visit.most[i] = std::max(visit.most[i], stroke);
            if (!before.empty()) visit.fastest = std::max(visit.fastest, std::abs(stroke - before[i]) / step / limit);
            if (!wishedBefore.empty() && !frame.splitStrokes.empty())
                visit.wished = std::max(visit.wished, std::abs(frame.splitStrokes[i] - wishedBefore[i]) / step / limit);
        }
        before = frame.estimatedStrokes;
        wishedBefore = frame.splitStrokes;
        if (!visit.problem.empty()) {
            ADD_FAILURE() << visit.problem << " after " << k * step << " s";
            return visit;
        }
        if (k % perSecond == 0) visit.memory.push_back(memoryNow(k * step));
    }
    ::testing::Test::RecordProperty("medianMilliseconds", std::to_string(visit.median()));
    ::testing::Test::RecordProperty("percentile99Milliseconds", std::to_string(visit.percentile99()));
    ::testing::Test::RecordProperty("shareOfVelocityLimit", std::to_string(visit.fastest));
    ::testing::Test::RecordProperty("heapGrowthMegabytes", std::to_string(visit.grown(&LongVisit::Memory::heap, 60.0)));
    return visit;
}

/// What holds for each of them: memory that stays, servos that move within their limits. What a frame takes is judged
/// by the bench (application-*).
inline void expectSteady(const LongVisit& visit) {
    EXPECT_LE(visit.fastest, 1.0 + 1e-9) << "of the velocity limit";
    EXPECT_GT(visit.fastest, 0.02) << "they do move";
    EXPECT_LT(visit.grown(&LongVisit::Memory::heap, 60.0), 5.0) << "megabytes after the first minute";
}

} // namespace lumorph::test
