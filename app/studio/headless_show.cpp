#include "app/studio/headless_show.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <span>
#include <system_error>

#include "app/applications/registry/demos.h"
#include "app/output/demo_player.h"
#include "app/output/video_writer.h"
#include "app/workspaces/common/field_colors.h"
#include "app/workspaces/common/field_scene.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/mdf/builder.h"
#include "core/mdf/clip.h"
#include "core/render/gl/frame_target.h"
#include "core/render/gl/headless_context.h"
#include "core/render/viewport/viewport_renderer.h"
#include "core/show/show_player.h"

namespace lumorph::studio {
namespace {

namespace fs = std::filesystem;
using Frame = std::shared_ptr<const MatchFrame>;

constexpr int kStepsAShowPicture = 2; ///< 30 pictures a second
constexpr glm::ivec2 kPictureSize{1600, 1000};
constexpr glm::ivec2 kVideoSize{960, 600};
constexpr double kMaxShowSeconds = 600.0;

/// The demonstration of matching: the one that the Field workspace shows.
MatchWish matchedWish(std::ostream& out) {
    const auto matched = std::ranges::find(demos(), "field", &Demo::workspace);
    MatchWish wish = wishOf(matched->open({}));
    out << "Building the field of the " << wish.rig->name() << "..." << std::endl;
    wish.field = std::make_shared<MatchField>(buildField(*wish.rig, BuildOptions{}));
    wish.scene = nullptr; // the device as it is, without light
    return wish;
}

/// All frames of the show, one a picture of the video.
std::vector<Frame> playedFrames(const MatchWish& wish, double seconds) {
    ManualClock clock;
    ShowPlayer player(clock, wish);
    std::vector<Frame> frames;
    const int steps = std::max(kStepsAShowPicture, static_cast<int>(std::lround(seconds / ShowPlayer::kStep)));
    for (int k = 0; k < steps; ++k)
        if (const Frame frame = player.step(); k % kStepsAShowPicture == 0) frames.push_back(frame);
    return frames;
}

/// Scenes as the Field workspace shows them, drawn without a window.
class FieldPictures {
public:
    explicit FieldPictures(const Box& box) { // everything seen from the front right and above
        builder_.setColors(fieldSceneColors(Theme::dark));
        camera_.yaw = Angle::degrees(32.0);
        camera_.pitch = Angle::degrees(28.0);
        camera_ = framed(camera_, box, static_cast<float>(kVideoSize.x) / static_cast<float>(kVideoSize.y), 0.85F);
    }

    void savePicture(const MatchFrame& frame, const FieldDisplay& display, const fs::path& file) {
        writePng(renderViewport(renderer_, *builder_.build(frame, display, false), camera_, kPictureSize), file);
    }

    /// A picture of a video, drawn as the window draws while things move.
    [[nodiscard]] Image videoPicture(const MatchFrame& frame) {
        renderer_.draw(target_.framebuffer(), kVideoSize, *builder_.build(frame, {}, false), camera_,
                       ViewportQuality::moving);
        return target_.read();
    }

private:
    HeadlessContext context_;
    ViewportRenderer renderer_;
    FrameTarget target_{kVideoSize, 0};
    FieldSceneBuilder builder_;
    ViewCamera camera_;
};

FieldDisplay displayOf(FieldDisplay::Show show, bool mismatch) {
    FieldDisplay display;
    display.show = show;
    display.showMismatch = mismatch;
    return display;
}

void savePictures(FieldPictures& pictures, const std::vector<Frame>& frames, const fs::path& folder) {
    const FieldDisplay plain = displayOf(FieldDisplay::Show::nothing, false);
    pictures.savePicture(*frames.front(), plain, folder / "start.png");
    pictures.savePicture(*frames[frames.size() / 2], plain, folder / "middle.png");
    pictures.savePicture(*frames.back(), plain, folder / "end.png");
    pictures.savePicture(*frames.back(), displayOf(FieldDisplay::Show::nothing, true), folder / "unmatched.png");
    FieldDisplay voxels = displayOf(FieldDisplay::Show::voxels, false);
    voxels.showTarget = false;
    voxels.sliceTo.z = frames.back()->field->field.frame.dimensions.z / 2; // cut open, so that the inside shows
    pictures.savePicture(*frames.back(), voxels, folder / "voxels.png");
    FieldDisplay surface = displayOf(FieldDisplay::Show::surface, false);
    surface.showTarget = false;
    surface.surfaceLevel = frames.back()->field->field.levels / 2;
    pictures.savePicture(*frames.back(), surface, folder / "level-surface.png");
}

void saveVideo(FieldPictures& pictures, const std::vector<Frame>& frames, const fs::path& file) {
    VideoWriter video(file, kVideoSize, 1.0 / (ShowPlayer::kStep * kStepsAShowPicture));
    for (const Frame& frame : frames) video.add(pictures.videoPicture(*frame));
    video.finish();
}

void saveTable(const std::vector<Frame>& frames, const fs::path& file) {
    std::vector<ClipFrame> rows;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        ClipFrame& row = rows.emplace_back();
        row.seconds = static_cast<double>(k) * kStepsAShowPicture * ShowPlayer::kStep;
        row.wanted = frames[k]->wanted;
        row.strokes = frames[k]->estimatedStrokes;
        row.iouWanted = frames[k]->iouWanted;
        row.iouReached = frames[k]->iouEstimated;
    }
    const std::string table = clipCsv(frames.front()->field->field, rows);
    writeFileAtomically(file, std::as_bytes(std::span(table)));
}

void tellNumbers(const std::vector<Frame>& frames, std::ostream& out) {
    double wanted = 0.0;
    double reached = 0.0;
    for (const Frame& frame : frames) {
        wanted += frame->iouWanted / static_cast<double>(frames.size());
        reached += frame->iouEstimated / static_cast<double>(frames.size());
    }
    out << std::fixed << std::setprecision(3) << "Mean IoU " << wanted << " wanted, " << reached
        << " reached under the velocity limits" << std::endl;
}

/// The same minutes of the demonstration that is shown first: what eye, projector and lab see.
void paintFirstDemo(const fs::path& folder, double seconds, std::ostream& out) {
    const Demo& demo = demos().front();
    out << "Painting the " << demo.name << " for " << seconds << " s..." << std::endl;
    ShowPictures show;
    show.seconds = seconds;
    show.video = kVideoSize;
    show.picture = kPictureSize;
    const ShowRates rates = playShow(demo.open({}), demo.name, show, folder, folder / (demo.name + ".mp4"));
    out << std::setprecision(1) << "Both passes and the lab: " << rates.framesPerSecond << " frames/s here"
        << std::endl;
    for (const std::string& warning : rates.warnings) out << warning << std::endl;
}

} // namespace

void runHeadlessShow(const fs::path& folder, double seconds, std::ostream& out) {
    if (!(seconds > 0.0 && seconds <= kMaxShowSeconds))
        throw InvalidInput("--seconds", "the show lasts more than 0 and at most 600 seconds",
                           "give a number in that range");
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw DeviceError(folder.string(), "the folder cannot be made (" + error.message() + ")",
                          "choose another place");
    const MatchWish wish = matchedWish(out);
    out << "Matching " << wish.target->name << " for " << seconds << " s..." << std::endl;
    const std::vector<Frame> frames = playedFrames(wish, seconds);
    tellNumbers(frames, out);
    out << "Drawing " << frames.size() << " pictures..." << std::endl;
    FieldPictures pictures(wish.field->field.frame.box());
    savePictures(pictures, frames, folder);
    saveVideo(pictures, frames, folder / (wish.target->name + ".mp4"));
    saveTable(frames, folder / (wish.target->name + ".csv"));
    paintFirstDemo(folder, seconds, out);
    out << "Pictures, video and table are in " << fs::absolute(folder).lexically_normal().string() << std::endl;
}

} // namespace lumorph::studio
