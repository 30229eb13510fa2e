#include <cmath>
#include <memory>

#include <epoxy/gl.h>

#include "core/base/resources.h"
#include "core/render/headless_context.h"
#include "core/render/spatial_renderer.h"
#include "core/rig/rig_file.h"
#include "core/scene/posed_scene.h"
#include "core/scene/techniques.h"
#include "tests/bench/bench_groups.h"
#include "tests/bench/bench_timing.h"

namespace lumorph::bench {

namespace {

constexpr glm::ivec2 kSize(1280, 800);
constexpr int kWarmUp = 5;
constexpr int kFrames = 20;

/// The tablet with its flaps half up, moving, in a scene with one projector and one shadow map; the viewer sways.
class Show {
public:
    explicit Show(Scene scene) : rig_(std::make_shared<const Rig>(readRig(resourceFile("models/tablet.glb")))) {
        scene.projectors.resize(1);
        CalibratedCamera& camera = scene.projectors.front().camera;
        // As many pixels as the bar speaks of, over the same part of the table.
        const glm::dvec2 share = glm::dvec2(kSize) / glm::dvec2(camera.size);
        camera.focal *= share;
        camera.principal = (camera.principal + 0.5) * share - 0.5;
        camera.size = kSize;
        frame_.assets = loadSceneAssets(scene, {});
        frame_.scene = std::make_shared<const Scene>(std::move(scene));
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
        frame_.eye = frame_.scene->eye + 0.05F * glm::vec3(std::sin(2.0 * seconds), 0.0, std::cos(2.0 * seconds));
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

void measure(const std::string& name, const std::string& what, Scene scene, Report& report) {
    const HeadlessContext context;
    SpatialRenderer renderer;
    renderer.setEyeSize(kSize);
    Show show(std::move(scene));
    std::vector<double> pose, upload, shadow, eye, projectors, whole, processor;
    for (int number = 0; number < kWarmUp + kFrames; ++number) {
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
    for (int number = kWarmUp; number < kWarmUp + kFrames; ++number) {
        renderer.draw(show.at(number));
        const SpatialTimes times = renderer.times();
        upload.push_back(times.upload);
        shadow.push_back(times.shadow);
        eye.push_back(times.eye);
        projectors.push_back(times.projectors);
    }
    const double median = medianOf(whole);
    report.add({name,
                what,
                1e3 / median,
                "frames/s",
                atLeast(15.0),
                {},
                {"median frame " + fixed(median, 1) + " ms; ms of its parts, each by itself: pose and deform " +
                     fixed(medianOf(pose), 2) + ", upload " + fixed(medianOf(upload), 2) + ", shadow " +
                     fixed(medianOf(shadow), 2) + ", eye " + fixed(medianOf(eye), 2) + ", projector " +
                     fixed(medianOf(projectors), 2),
                 "processor time of the drawing, all threads together: " + fixed(medianOf(processor), 1) +
                     " ms; so two cores make " + fixed(2e3 / medianOf(processor), 1) + " frames/s at the very best",
                 "1280 x 800 pixels each for eye and projector, one shadow map, " + std::to_string(kFrames) +
                     " frames, whatever OpenGL there is"}});
    for (const std::string& warning : renderer.warnings()) report.fail(name, warning);
}

} // namespace

void benchFrame(const Filter& filter, Report& report) {
    if (filter.wants("frame-tablet"))
        measure("frame-tablet", "eye and projector pass of the tablet on its table, floating cubes", techniqueScene(5),
                report);
    if (filter.wants("frame-water"))
        measure("frame-water", "the same for the bundled sea: waves, reflection, refraction", waterScene(), report);
}

} // namespace lumorph::bench
