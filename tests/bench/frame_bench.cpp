#include <cmath>
#include <memory>

#include <epoxy/gl.h>

#include "app/applications/techniques/techniques.h"
#include "app/applications/water/water.h"
#include "core/base/resources.h"
#include "core/base/statistics.h"
#include "core/render/gl/gl_driver.h"
#include "core/render/gl/headless_context.h"
#include "core/render/spatial_renderer.h"
#include "core/rig/rig_file.h"
#include "core/scene/posed_scene.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {

namespace {

constexpr glm::ivec2 kSize(1280, 800);
constexpr glm::ivec2 kFullHd(1920, 1080);
constexpr int kWarmUp = 5;
constexpr int kFramesDrawn = 20;

/// The tablet with its flaps half up, moving, in a scene with one projector and one shadow map; the viewer sways.
class Show {
public:
    Show(const Scene& scene, glm::ivec2 size)
        : rig_(std::make_shared<const Rig>(readRig(resourceFile("models/tablet.glb")))) {
        Installation installation = defaultInstallation();
        CalibratedCamera& camera = installation.projectors.front().camera;
        // So many pixels over the same part of the table.
        const glm::dvec2 share = glm::dvec2(size) / glm::dvec2(camera.size);
        camera.focal *= share;
        camera.principal = (camera.principal + 0.5) * share - 0.5;
        camera.size = size;
        frame_.assets = loadSceneAssets(scene, {});
        frame_.scene = std::make_shared<const Scene>(scene);
        frame_.installation = std::make_shared<const Installation>(std::move(installation));
        frame_.rig = rig_;
    }

    const ShowFrame& at(int number) {
        const double seconds = number / 30.0;
        std::vector<double> strokes(rig_->actuatorCount());
        for (std::size_t i = 0; i < strokes.size(); ++i)
            strokes[i] = 0.5 + 0.4 * std::sin(seconds + static_cast<double>(i));
        auto positions = std::make_shared<std::vector<glm::vec3>>(rig_->restMesh().positions.size());
        rig_->deform(strokes, *positions);
        frame_.devicePositions = std::move(positions);
        PoseInput input;
        input.seconds = seconds;
        frame_.eye =
            frame_.installation->eye + 0.05F * glm::vec3(std::sin(2.0 * seconds), 0.0, std::cos(2.0 * seconds));
        frame_.posed = poser_.pose(*frame_.scene, *frame_.assets, input);
        return frame_;
    }

private:
    std::shared_ptr<const Rig> rig_;
    ScenePoser poser_;
    ShowFrame frame_;
};

/// Of all threads: software OpenGL has several. On a machine with other work it tells more than the clock.
double processSeconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Medians over the frames of one scene, milliseconds.
struct FrameTimes {
    double whole = 0.0, processor = 0.0;
    double pose = 0.0, upload = 0.0, shadow = 0.0, eye = 0.0, projectors = 0.0;
    double mixedShare = 0.0; ///< of the projector pass, median of the frames' shares
    GlDriver driver;
    std::vector<std::string> warnings;

    [[nodiscard]] std::string parts() const {
        return "median frame " + fixed(whole, 1) + " ms; ms of its parts, each by itself: pose and deform " +
               fixed(pose, 2) + ", upload " + fixed(upload, 2) + ", shadow " + fixed(shadow, 2) + ", eye " +
               fixed(eye, 2) + ", projector " + fixed(projectors, 2);
    }
};

FrameTimes measure(const Scene& scene, glm::ivec2 size) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    renderer.setEyeSize(size);
    Show show(scene, size);
    std::vector<double> pose, upload, shadow, eye, projectors, mixed, whole, processor;
    for (int number = 0; number < kWarmUp + kFramesDrawn; ++number) {
        const ShowFrame* frame = nullptr;
        const double posing = 1e3 * secondsOf([&] { frame = &show.at(number); });
        const double busy = processSeconds();
        const double drawing = 1e3 * secondsOf([&] {
                                   renderer.draw(*frame);
                                   glFinish();
                               });
        if (number < kWarmUp) continue;
        processor.push_back(1e3 * (processSeconds() - busy));
        pose.push_back(posing);
        whole.push_back(posing + drawing);
    }
    // Waiting for each pass by itself takes a little longer, so the frames above do not.
    renderer.setMeasuring(true);
    for (int number = kWarmUp; number < kWarmUp + kFramesDrawn; ++number) {
        renderer.draw(show.at(number));
        const SpatialTimes times = renderer.times();
        upload.push_back(times.upload);
        shadow.push_back(times.shadow);
        eye.push_back(times.eye);
        projectors.push_back(times.projectors);
        mixed.push_back(times.mixed / times.projectors);
    }
    return {median(whole), median(processor),  median(pose),  median(upload),  median(shadow),
            median(eye),   median(projectors), median(mixed), currentDriver(), renderer.warnings()};
}

void fail(const std::string& name, const FrameTimes& times, Report& report) {
    for (const std::string& warning : times.warnings) report.fail(name, warning);
}

/// With what software on two cores is held to in one scene, and aims at in the others.
void addSoftwareRow(Row row, const Scene& scene, Report& report) {
    const FrameTimes times = measure(scene, kSize);
    row.figure = 1e3 / times.whole;
    row.unit = "frames/s";
    row.notes = {times.parts(),
                 "processor time of the drawing, all threads together: " + fixed(times.processor, 1) +
                     " ms; so two cores make " + fixed(2e3 / times.processor, 1) + " frames/s at the very best",
                 "1280 x 800 pixels each for eye and projector, one shadow map, " + std::to_string(kFramesDrawn) +
                     " frames, " + times.driver.renderer};
    fail(row.name, times, report);
    report.add(std::move(row));
}

/// What it costs that pixels on several surfaces get the best value for all of them.
void addMixedRow(const std::string& name, Report& report) {
    const FrameTimes times = measure(waterScene(), kSize);
    Row row{name, "share of the projector pass for pixels on folds and outlines", 100.0 * times.mixedShare, "%"};
    row.bar = atMost(5.0);
    row.notes = {"of " + fixed(times.projectors, 2) + " ms, in the bundled sea with its flaps half up, " +
                 std::to_string(kFramesDrawn) + " frames, " + times.driver.renderer};
    fail(name, times, report);
    report.add(std::move(row));
}

/// What a graphics card is aimed at; software has no chance there, so its figure stands without the aim.
void addFullHdRow(const std::string& name, Report& report) {
    const FrameTimes times = measure(techniqueScene(5), kFullHd);
    const double passes = times.shadow + times.eye + times.projectors;
    Row row{name, "the tablet in full HD: shadow, eye and projector pass", passes, "ms", {}, {}, {times.parts()}};
    if (!times.driver.software) row.aim = atMost(2.0);
    row.notes.push_back("1920 x 1080 pixels each for eye and projector, " + std::to_string(kFramesDrawn) + " frames, " +
                        times.driver.renderer +
                        (times.driver.software ? "; the aim of 2 ms is a graphics card's" : ""));
    report.add(std::move(row));
    fail(name, times, report);
}

} // namespace

void benchFrame(const Filter& filter, Report& report) {
    if (filter.wants("frame-tablet"))
        addSoftwareRow({.name = "frame-tablet",
                        .what = "eye and projector pass of the tablet on its table, floating cubes",
                        .bar = atLeast(15.0)},
                       techniqueScene(5), report);
    if (filter.wants("frame-water"))
        addSoftwareRow({.name = "frame-water",
                        .what = "the same for the bundled sea: waves, reflection, refraction",
                        .aim = atLeast(15.0)},
                       waterScene(), report);
    if (filter.wants("frame-mixed-pixels")) addMixedRow("frame-mixed-pixels", report);
    if (filter.wants("frame-full-hd")) addFullHdRow("frame-full-hd", report);
}

} // namespace lumorph::bench
