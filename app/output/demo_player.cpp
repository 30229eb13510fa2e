#include "app/output/demo_player.h"

#include <chrono>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <optional>
#include <ostream>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/applications/program_start.h"
#include "app/output/picture_pair.h"
#include "app/output/video_writer.h"
#include "app/sound/sound_mixer.h"
#include "core/base/error.h"
#include "core/base/statistics.h"
#include "core/loop/bend_comparison.h"
#include "core/loop/show_program.h"
#include "core/mdf/builder.h"
#include "core/render/gl/headless_context.h"
#include "core/render/spatial_renderer.h"
#include "core/show/show_player.h"

namespace lumorph {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kStepsAPicture = 2; ///< 30 pictures a second
constexpr double kMaxSeconds = 600.0;
constexpr double kWalk = 0.35; ///< radians to either side
constexpr double kWalkPeriod = 8.0;
constexpr double kBareLower = 0.3; ///< radians by which the bare device is seen from lower
constexpr double kStoop = 0.34;    ///< radians by which he goes down to see what the bend is for

double since(Clock::time_point begun) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

/// The viewer sways around the device, so that one sees that the picture follows him.
glm::vec3 walkedEye(const glm::vec3& eye, double seconds) {
    const double turn = kWalk * std::sin(2.0 * std::numbers::pi * seconds / kWalkPeriod);
    const double c = std::cos(turn), s = std::sin(turn);
    return glm::vec3(glm::dvec3(c * eye.x + s * eye.z, eye.y, c * eye.z - s * eye.x));
}

/// The same view in half as large pixels.
CalibratedCamera finer(CalibratedCamera camera) {
    camera.size *= 2;
    camera.focal *= 2.0;
    camera.principal = 2.0 * camera.principal + 0.5;
    return camera;
}

/// A show that nobody watches waits for its field.
MatchWish completeWish(const ProjectContents& contents, const std::shared_ptr<ShowProgram>& program, Language language,
                       const Progress& progress) {
    MatchWish wish = wishOf(contents);
    wish.language = language;
    wish.showTint = false;
    if (program) {
        wish.program = program;
        wish.inputs = std::make_shared<ShowInputs>();
        wish.driver = Driver::program;
    }
    if (wish.target && !wish.field)
        wish.field = std::make_shared<const MatchField>(buildField(*wish.rig, {}, progress));
    return wish;
}

/// What a show lets be heard, for a film of it.
class FilmSound {
public:
    FilmSound() { mixer_.setBoard(std::make_shared<const SoundBoard>(SoundBoard::synthesised())); }

    /// That of one step of the show.
    [[nodiscard]] std::span<const std::int16_t> step(std::span<const ShowSound> sounds) {
        mixer_.play(sounds);
        mixer_.mix(samples_);
        return samples_;
    }

private:
    SoundMixer mixer_;
    std::vector<std::int16_t> samples_ =
        std::vector<std::int16_t>(2 * static_cast<std::size_t>(std::lround(ShowPlayer::kStep * kSoundRate)));
};

/// A show, drawn and measured step by step.
class Recorder {
public:
    Recorder(const ProjectContents& contents, const std::string& name, const ShowPictures& show,
             const ShowScript& script, const Progress& progress)
        : name_(name), show_(show), room_(contents.project.installation), inputs_(script.inputs),
          player_(clock_, completeWish(contents, script.program, script.language, progress)) {
        renderer_.setMeasuring(true);
        renderer_.setEyeSize(show.video);
    }

    void step() {
        const double seconds = player_.frame() ? player_.seconds() + ShowPlayer::kStep : 0.0;
        Installation room = room_;
        const bool compares = player_.frame() && player_.frame()->comparesBend;
        room.eye = walkedEye(compares ? loweredEye(room_.eye, kStoop) : room_.eye, seconds);
        MatchWish wish = player_.wish();
        wish.installation = std::make_shared<const Installation>(std::move(room));
        player_.setWish(std::move(wish));
        if (player_.wish().inputs) giveInputs(seconds);
        const auto begun = Clock::now();
        const MatchFrame& frame = *player_.step();
        sounds_ = frame.sounds;
        if (!frame.programError.empty()) programError_ = frame.programError;
        if (frame.keepsake) keepsake_ = frame.keepsake;
        loopTimes_.push_back(since(begun));
    }

    /// What the viewer sees of the lit device; `kept`: for a film or picture, else to be measured alone.
    [[nodiscard]] Image lab(bool kept) {
        const auto begun = Clock::now();
        const ShowFrame frame = player_.shown();
        if (player_.frame()->comparesBend) return comparedBends(frame, begun, kept);
        renderer_.draw(frame);
        passTimes_.push_back(renderer_.times().total);
        Image picture = labFrom(viewOf(frame, show_.video), kept);
        finishFrame(begun);
        return picture;
    }

    /// Of the newest step.
    [[nodiscard]] const std::vector<ShowSound>& sounds() const noexcept { return sounds_; }

    void savePictures(const fs::path& folder) {
        const ShowFrame frame = player_.shown();
        renderer_.setEyeSize(show_.picture);
        renderer_.draw(frame);
        writePng(renderer_.readEye(), folder / (name_ + "-eye.png"));
        for (std::size_t i = 0; i < frame.installation->projectors.size(); ++i) {
            if (!frame.installation->projectors[i].enabled) continue;
            const std::string number = i == 0 ? "" : std::to_string(i + 1);
            writePng(renderer_.readProjector(i), folder / (name_ + "-projector" + number + ".png"));
        }
        writePng(halved(renderer_.readLab(finer(viewOf(frame, show_.picture)), kDimRoom)),
                 folder / (name_ + "-lab.png"));
        renderer_.setEyeSize(show_.video);
    }

    [[nodiscard]] ShowRates rates() const {
        ShowRates rates;
        rates.frames = static_cast<int>(frameTimes_.size());
        const double frame = frameTimes_.empty() ? 0.0 : median(frameTimes_);
        rates.framesPerSecond = frame > 0.0 ? 1000.0 / frame : 0.0;
        rates.loopMilliseconds = loopTimes_.empty() ? 0.0 : median(loopTimes_);
        rates.passMilliseconds = passTimes_.empty() ? 0.0 : median(passTimes_);
        rates.warnings = renderer_.warnings();
        rates.keepsake = keepsake_;
        if (!programError_.empty()) rates.warnings.push_back("The application has ended: " + programError_);
        return rates;
    }

private:
    /// As it is drawn live, by which it is measured; what is kept has smooth edges, beside that time.
    Image labFrom(const CalibratedCamera& camera, bool kept) {
        Image live = renderer_.readLab(camera, kDimRoom);
        if (!kept) return live;
        const auto begun = Clock::now();
        Image smooth = halved(renderer_.readLab(finer(camera), kDimRoom));
        if (const ShowFrame& frame = player_.shown(); !player_.frame()->comparesBend)
            putInlay(smooth, halved(renderer_.readBare(finer(bareView(frame, inlaySize(smooth.size()))))));
        beside_ += since(begun);
        return smooth;
    }

    void finishFrame(Clock::time_point begun) { frameTimes_.push_back(since(begun) - std::exchange(beside_, 0.0)); }

    /// Both halves through one camera, which holds the device that bends.
    Image comparedBends(const ShowFrame& frame, Clock::time_point begun, bool kept) {
        const MatchFrame& match = *player_.frame();
        const ShowFrame with = comparison_.half(match, frame, BendComparison::Half::with);
        const ShowFrame without = comparison_.half(match, frame, BendComparison::Half::without);
        const CalibratedCamera camera = viewOf(with, {show_.video.x / 2, show_.video.y});
        std::vector<Image> halves;
        for (const ShowFrame* half : {&without, &with}) {
            renderer_.draw(*half);
            passTimes_.push_back(renderer_.times().total);
            halves.push_back(labFrom(camera, kept));
        }
        finishFrame(begun);
        return besideEachOther(halves[0], halves[1], bendCaptions(), player_.wish().language);
    }

    void giveInputs(double seconds) {
        for (; given_ < inputs_.size() && inputs_[given_].seconds <= seconds; ++given_)
            player_.wish().inputs->push(inputs_[given_].input);
    }
    static CalibratedCamera bareView(const ShowFrame& frame, glm::ivec2 size) {
        return deviceView(frame, loweredEye(frame.eye.value_or(frame.installation->eye), kBareLower), size);
    }
    static CalibratedCamera viewOf(const ShowFrame& frame, glm::ivec2 size) {
        return deviceView(frame, frame.eye.value_or(frame.installation->eye), size);
    }

    const std::string& name_;
    const ShowPictures& show_;
    const Installation room_;
    const InputScript& inputs_;
    std::size_t given_ = 0;
    std::string programError_;
    std::vector<ShowSound> sounds_;
    std::function<std::string()> keepsake_;
    ManualClock clock_;
    ShowPlayer player_;
    BendComparison comparison_;
    HeadlessContext context_;
    SpatialRenderer renderer_;
    std::vector<double> loopTimes_, passTimes_, frameTimes_;
    double beside_ = 0.0; ///< milliseconds of the frame that are not of the show
};

} // namespace

ShowRates playShow(const ProjectContents& contents, const std::string& name, const ShowPictures& show,
                   const fs::path& pictures, const fs::path& video, const ShowScript& script,
                   const Progress& progress) {
    if (!(show.seconds > 0.0 && show.seconds <= kMaxSeconds))
        throw InvalidInput("--seconds", "the show lasts more than 0 and at most 600 seconds",
                           "give a number in that range");
    Recorder recorder(contents, name, show, script, progress.part(0.0, 0.2));
    std::optional<VideoWriter> writer;
    std::optional<FilmSound> sound;
    if (!video.empty()) {
        writer.emplace(video, show.video, 1.0 / (ShowPlayer::kStep * kStepsAPicture));
        sound.emplace();
    }
    const int steps = std::max(kStepsAPicture, static_cast<int>(std::lround(show.seconds / ShowPlayer::kStep)));
    const Progress drawing = progress.part(0.2, 1.0);
    for (int k = 0; k < steps; ++k) {
        drawing.throwIfCancelled();
        drawing.report(static_cast<double>(k) / steps, "drawing the show");
        recorder.step();
        if (sound) writer->addSound(sound->step(recorder.sounds()));
        if (k == steps / 2 && !pictures.empty()) recorder.savePictures(pictures);
        if (k % kStepsAPicture != 0) continue;
        const bool last = !show.last.empty() && k + kStepsAPicture >= steps;
        const Image picture = recorder.lab(writer || last);
        if (writer) writer->add(picture);
        if (last) writePng(picture, show.last);
    }
    if (writer) writer->finish();
    ShowRates rates = recorder.rates();
    rates.warnings.insert(rates.warnings.end(), contents.warnings.begin(), contents.warnings.end());
    rates.warnings.insert(rates.warnings.end(), script.notes.begin(), script.notes.end());
    return rates;
}

namespace {

ShowScript scriptOf(const Demo& demo, const DemoPlay& play, std::vector<std::string>& warnings) {
    ShowScript script;
    if (!play.kept.empty() && !demo.keeps)
        throw InvalidInput("--keep", "the demo '" + demo.name + "' keeps nothing", "leave it out");
    if (!play.inputs.empty()) {
        if (!demo.program)
            throw InvalidInput("--input", "the demo '" + demo.name + "' goes by time alone", "leave it out");
        script.inputs = readInputScriptFile(play.inputs);
    }
    BegunProgram begun = beginProgram(demo, {play.seed, play.told, play.kept});
    script.language = play.language;
    script.notes = std::move(begun.notes);
    script.figures = std::move(begun.figures);
    script.program = std::move(begun.program);
    if (!begun.problem.empty())
        warnings.push_back(play.kept.string() + ": " + begun.problem + "; it lies in " + begun.aside.string() + " now");
    return script;
}

} // namespace

void playDemo(const Demo& demo, const DemoPlay& play, std::ostream& out, const Progress& progress) {
    ShowPictures show;
    show.seconds = play.seconds;
    show.last = play.last;
    show.video = play.size;
    std::vector<std::string> warnings;
    const ShowScript script = scriptOf(demo, play, warnings);
    ShowRates rates =
        playShow(demo.open(progress.part(0.0, 0.1)), demo.name, show, {}, play.video, script, progress.part(0.1, 1.0));
    rates.warnings.insert(rates.warnings.begin(), warnings.begin(), warnings.end());
    if (!play.kept.empty() && rates.keepsake) writeKeepsake(play.kept, rates.keepsake());
    if (play.json) {
        nlohmann::json value{{"demo", demo.name},
                             {"seconds", play.seconds},
                             {"frames", rates.frames},
                             {"framesPerSecond", rates.framesPerSecond},
                             {"ms", {{"loop", rates.loopMilliseconds}, {"passes", rates.passMilliseconds}}},
                             {"record", play.video.string()},
                             {"warnings", rates.warnings}};
        for (const auto& [name, json] : script.figures) value[name] = nlohmann::json::parse(json);
        out << value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
        return;
    }
    out << std::fixed << std::setprecision(1) << rates.frames << " frames of " << demo.name << ": loop "
        << rates.loopMilliseconds << " ms, both passes " << rates.passMilliseconds << " ms, with the lab "
        << rates.framesPerSecond << " frames/s" << std::endl;
    for (const std::string& warning : rates.warnings) out << warning << std::endl;
    if (!play.video.empty()) out << "Video: " << fs::absolute(play.video).lexically_normal().string() << std::endl;
}

} // namespace lumorph
