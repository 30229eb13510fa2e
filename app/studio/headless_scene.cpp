#include "app/studio/headless_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <optional>
#include <ostream>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/output/video_writer.h"
#include "app/studio/document/match_wish.h"
#include "app/studio/document/project_io.h"
#include "app/studio/rendering/show_frames.h"
#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/base/statistics.h"
#include "core/loop/match_loop.h"
#include "core/loop/show_stage.h"
#include "core/render/gl/headless_context.h"
#include "core/render/spatial_renderer.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kLoopRate = 60.0;
constexpr int kStepsAPicture = 2; ///< 30 pictures a second
constexpr double kMaxSeconds = 600.0;
constexpr double kWalk = 0.35; ///< radians to either side
constexpr double kWalkPeriod = 8.0;

double since(Clock::time_point begun) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

/// The viewer sways around the device, so that one sees that the picture follows him.
glm::vec3 walkedEye(const glm::vec3& eye, double seconds) {
    const double turn = kWalk * std::sin(2.0 * std::numbers::pi * seconds / kWalkPeriod);
    const double c = std::cos(turn), s = std::sin(turn);
    return glm::vec3(glm::dvec3(c * eye.x + s * eye.z, eye.y, c * eye.z - s * eye.x));
}

/// The loop and the passes of one project, step by step.
class Player {
public:
    Player(const SceneShow& show, const LoadedProject& project)
        : show_(show), wish_(wishOf(project.state)), eye_(project.state.scene->eye), loop_(clock_) {
        wish_.showTint = false;
        renderer_.setMeasuring(true);
        renderer_.setEyeSize(show.video);
    }

    void step(double seconds, double sinceLast) {
        auto scene = std::make_shared<Scene>(*wish_.scene);
        scene->eye = walkedEye(eye_, seconds);
        wish_.scene = std::move(scene);
        clock_.advance(Microseconds(static_cast<std::int64_t>(1e6 * sinceLast)));
        const auto begun = Clock::now();
        match_ = loop_.step(wish_, sinceLast);
        loopTimes_.push_back(since(begun));
    }

    /// What the viewer sees of the lit device.
    [[nodiscard]] Image lab() {
        const auto begun = Clock::now();
        const ShowFrame frame = stage_.frame(*match_);
        renderer_.draw(frame);
        passTimes_.push_back(renderer_.times().total);
        Image picture = renderer_.readLab(labCamera(frame, std::nullopt, show_.video));
        frameTimes_.push_back(since(begun));
        return picture;
    }

    void savePictures(const fs::path& folder) {
        const std::string name = show_.project.stem().string();
        const ShowFrame frame = stage_.frame(*match_);
        renderer_.setEyeSize(show_.picture);
        renderer_.draw(frame);
        writePng(renderer_.readEye(), folder / (name + "-eye.png"));
        for (std::size_t i = 0; i < frame.scene->projectors.size(); ++i) {
            if (!frame.scene->projectors[i].enabled) continue;
            const std::string number = i == 0 ? "" : std::to_string(i + 1);
            writePng(renderer_.readProjector(i), folder / (name + "-projector" + number + ".png"));
        }
        writePng(renderer_.readLab(labCamera(frame, std::nullopt, show_.picture)), folder / (name + "-lab.png"));
        renderer_.setEyeSize(show_.video);
    }

    [[nodiscard]] SceneShowReport report() const {
        SceneShowReport report;
        report.frames = static_cast<int>(frameTimes_.size());
        const double frame = median(frameTimes_);
        report.framesPerSecond = frame > 0.0 ? 1000.0 / frame : 0.0;
        report.loopMilliseconds = median(loopTimes_);
        report.passMilliseconds = median(passTimes_);
        report.warnings = renderer_.warnings();
        return report;
    }

private:
    const SceneShow& show_;
    MatchWish wish_;
    glm::vec3 eye_;
    ManualClock clock_;
    MatchLoop loop_;
    HeadlessContext context_;
    SpatialRenderer renderer_;
    ShowStage stage_;
    std::shared_ptr<const MatchFrame> match_;
    std::vector<double> loopTimes_, passTimes_, frameTimes_;
};

} // namespace

SceneShowReport playScene(const SceneShow& show, const fs::path& pictures, const fs::path& video) {
    if (!(show.seconds > 0.0 && show.seconds <= kMaxSeconds))
        throw InvalidInput("--seconds", "the show lasts more than 0 and at most 600 seconds",
                           "give a number in that range");
    const LoadedProject project = loadProject(show.project, {});
    Player player(show, project);
    std::optional<VideoWriter> writer;
    if (!video.empty()) writer.emplace(video, show.video, kLoopRate / kStepsAPicture);
    const int steps = std::max(kStepsAPicture, static_cast<int>(std::lround(show.seconds * kLoopRate)));
    for (int k = 0; k < steps; ++k) {
        player.step(k / kLoopRate, k == 0 ? 0.0 : 1.0 / kLoopRate);
        if (k == steps / 2 && !pictures.empty()) player.savePictures(pictures);
        if (k % kStepsAPicture != 0) continue;
        const Image picture = player.lab();
        if (writer) writer->add(picture);
    }
    if (writer) writer->finish();
    SceneShowReport report = player.report();
    for (const auto& [asset, problem] : project.state.assets->problems) report.warnings.push_back(problem);
    return report;
}

void playDemo(const std::string& name, double seconds, const fs::path& video, bool json, std::ostream& out) {
    SceneShow show;
    show.project = resourcesFolder() / "projects" / (name + ".lumorph");
    show.seconds = seconds;
    if (name.find_first_of("/.") != std::string::npos || !fs::exists(show.project))
        throw InvalidInput("demo '" + name + "'", "there is no scene of that name to play", "try water or techniques");
    const SceneShowReport report = playScene(show, {}, video);
    if (json) {
        const nlohmann::json value{{"demo", name},
                                   {"seconds", seconds},
                                   {"frames", report.frames},
                                   {"framesPerSecond", report.framesPerSecond},
                                   {"ms", {{"loop", report.loopMilliseconds}, {"passes", report.passMilliseconds}}},
                                   {"record", video.string()},
                                   {"warnings", report.warnings}};
        out << value.dump(2) << std::endl;
        return;
    }
    out << std::fixed << std::setprecision(1) << report.frames << " frames of " << name << ": loop "
        << report.loopMilliseconds << " ms, both passes " << report.passMilliseconds << " ms, with the lab "
        << report.framesPerSecond << " frames/s" << std::endl;
    for (const std::string& warning : report.warnings) out << warning << std::endl;
    if (!video.empty()) out << "Video: " << fs::absolute(video).lexically_normal().string() << std::endl;
}

} // namespace lumorph::studio
