#include "core/render/gl/gl_objects.h"

#include "app/studio/rendering/show_drawer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "app/studio/rendering/frame_reader.h"
#include "app/studio/rendering/show_frames.h"
#include "core/loop/bend_comparison.h"
#include "core/loop/show_stage.h"
#include "core/render/gl/color_target.h"
#include "core/render/spatial_renderer.h"

namespace lumorph::studio {
namespace {

using Clock = std::chrono::steady_clock;
using Bend = ShowView::Bend;

// What the eye pass needs so that a projector of usual size has a pixel for each of its own.
constexpr double kExactEyePixels = 1280.0 * 800.0;
constexpr glm::ivec2 kUsualEye{1280, 800};

double since(Clock::time_point begun) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

glm::ivec2 toVec(QSize size) { return {size.width(), size.height()}; }
QSize toSize(glm::ivec2 size) { return {size.x, size.y}; }

glm::ivec2 scaled(glm::ivec2 size, double share) {
    return glm::max(glm::ivec2(glm::round(glm::dvec2(size) * share)), glm::ivec2(1));
}

bool showsEye(const WantedView& wanted) { return wanted.view.kind == ShowView::Kind::eye; }

/// Pixels of the eye pass: its shape is that of its largest view, else of the lab's. A view of the lab that is larger,
/// or a projector that is wanted in all its pixels, needs more of them; the lab can wait until nothing moves.
glm::ivec2 eyeSize(const ShowPace::Work& work) {
    glm::ivec2 size(0);
    double enough = 0.0;
    for (const bool eyes : {true, false})
        for (const WantedView& wanted : work.request.views) {
            if (wanted.view.exact) enough = std::max(enough, kExactEyePixels);
            if (wanted.view.kind == ShowView::Kind::projector || !wanted.view.lit || showsEye(wanted) != eyes) continue;
            const glm::ivec2 pixels = toVec(wanted.pixels);
            if (eyes || size == glm::ivec2(0)) size = glm::max(size, pixels);
            if (work.resolution >= 1.0) enough = std::max(enough, static_cast<double>(pixels.x) * pixels.y);
        }
    if (size == glm::ivec2(0)) size = kUsualEye;
    const double pixels = static_cast<double>(size.x) * size.y;
    return scaled(size, std::max(1.0, std::sqrt(enough / pixels)) * work.resolution);
}

/// How many of its pixels each projector is drawn with.
ShowFrame withProjectorPixels(ShowFrame frame, const ShowPace::Work& work) {
    const auto any = [&](auto holds) {
        return std::any_of(work.request.views.begin(), work.request.views.end(), holds);
    };
    if (any([](const WantedView& wanted) { return wanted.view.exact; })) return frame;
    // In the lab the device fills the view, but only a part of what the projector covers.
    if (any([](const WantedView& wanted) { return wanted.view.kind == ShowView::Kind::lab && wanted.view.lit; }))
        return withProjectorShare(std::move(frame), work.resolution);
    glm::ivec2 room(0);
    for (const WantedView& wanted : work.request.views) room = glm::max(room, toVec(wanted.pixels));
    return withProjectorRoom(std::move(frame), scaled(room, work.resolution));
}

bool needsProjectors(const ShowRequest& request) {
    return std::ranges::any_of(request.views, [](const WantedView& wanted) { return wanted.view.needsProjectors(); });
}

/// What holds OpenGL objects.
struct Objects {
    SpatialRenderer renderer;
    gl::Framebuffer source; ///< a texture is attached to it while it is copied
    std::map<int, FrameReader> readers;
};

} // namespace

struct ShowDrawer::Data {
    Data(ReadBack how, Deliver told) : way(how), deliver(std::move(told)) {}

    void pose(const ShowPace::Work& work);
    void drawBend(const ShowPace::Work& work, Bend bend);
    void drawView(const WantedView& wanted, const ShowFrame& frame, const ShowFrame& framed, double resolution);
    [[nodiscard]] ShowFrame bent(Bend bend);
    void drawProjector(const WantedView& wanted, FrameReader& reader, const ShowFrame& frame);
    void addTimes(const SpatialTimes& times);
    void dropUnwanted(const ShowRequest& request);
    void collect();

    ReadBack way;
    Deliver deliver;
    ImagePool pool;
    ShowStage stage;
    BendComparison comparison;
    std::optional<Objects> objects;
    std::optional<ShowPace::Work> under; ///< the work of the frame that is on its way
    DrawnShow drawn;                     ///< that frame, as far as it has come
    glm::ivec2 eyePixels{0};             ///< of its eye pass
    Clock::time_point begun;
    Clock::time_point delivered;
};

ShowDrawer::ShowDrawer(const GlDriver& driver, Deliver deliver)
    : data_(std::make_unique<Data>(driver.software ? ReadBack::direct : ReadBack::buffered, std::move(deliver))) {}
ShowDrawer::~ShowDrawer() = default;

void ShowDrawer::Data::dropUnwanted(const ShowRequest& request) {
    std::erase_if(objects->readers, [&](const auto& entry) {
        return std::none_of(request.views.begin(), request.views.end(),
                            [&](const WantedView& wanted) { return wanted.id == entry.first; });
    });
}

/// Posing costs a millisecond or two. It is done here, by the poses of now, not in the loop: the loop makes more frames
/// than are drawn, and must not wait; the window's thread must wait even less.
void ShowDrawer::Data::pose(const ShowPace::Work& work) {
    const auto from = Clock::now();
    drawn = {};
    drawn.match = work.request.match;
    const NewestView newest = newestView(*work.request.match);
    drawn.ms.latency = newest.latency;
    drawn.frame = std::make_shared<ShowFrame>(stage.frame(*work.request.match, newest));
    drawn.resolution = work.resolution;
    drawn.still = work.still || work.resolution >= 1.0;
    drawn.ms.pose = since(from);
}

void ShowDrawer::Data::drawProjector(const WantedView& wanted, FrameReader& reader, const ShowFrame& frame) {
    const std::size_t number = wanted.view.projector;
    if (number >= frame.installation->projectors.size()) return;
    const glm::ivec2 own = frame.installation->projectors[number].camera.size;
    const glm::ivec2 shown = wanted.view.exact ? own : fittingSize(own, toVec(wanted.pixels));
    const unsigned texture = objects->renderer.projectorTexture(number);
    const unsigned target = reader.framebuffer(toSize(own));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, objects->source.name());
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
    if (texture == 0) {
        // A projector that is switched off sends black.
        constexpr std::array<float, 4> kBlack{0.0F, 0.0F, 0.0F, 1.0F};
        glClearBufferfv(GL_COLOR, 0, kBlack.data());
    } else {
        glBlitFramebuffer(0, 0, own.x, own.y, 0, 0, own.x, own.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    reader.start(toSize(shown));
}

/// `framed` is what a camera of the lab holds.
void ShowDrawer::Data::drawView(const WantedView& wanted, const ShowFrame& frame, const ShowFrame& framed,
                                double resolution) {
    SpatialRenderer& renderer = objects->renderer;
    FrameReader& reader = objects->readers.try_emplace(wanted.id, way, pool).first->second;
    auto from = Clock::now();
    if (wanted.view.kind == ShowView::Kind::lab) {
        const glm::ivec2 size = scaled(toVec(wanted.pixels), resolution);
        const glm::vec3 eye = loweredEye(wanted.view.observer.value_or(viewerOf(framed)), wanted.view.lower);
        const CalibratedCamera camera = labCamera(framed, eye, size);
        const unsigned target = reader.framebuffer(toSize(size));
        if (wanted.view.lit)
            renderer.drawLab(target, camera, kDimRoom);
        else
            renderer.drawBare(target, camera);
        drawn.ms.lab += since(from);
        from = Clock::now();
        reader.start(wanted.pixels);
    } else if (wanted.view.kind == ShowView::Kind::eye) {
        renderer.showEye(reader.framebuffer(toSize(eyePixels)));
        reader.start(wanted.pixels);
    } else {
        drawProjector(wanted, reader, frame);
    }
    drawn.ms.readBack += since(from);
}

void ShowDrawer::Data::addTimes(const SpatialTimes& times) {
    drawn.ms.upload += times.upload;
    drawn.ms.shadow += times.shadow;
    drawn.ms.eye += times.eye;
    drawn.ms.projectors += times.projectors;
}

ShowFrame ShowDrawer::Data::bent(Bend bend) {
    if (bend == Bend::asItIs) return *drawn.frame;
    const auto half = bend == Bend::without ? BendComparison::Half::without : BendComparison::Half::with;
    return comparison.half(*drawn.match, *drawn.frame, half);
}

void ShowDrawer::Data::drawBend(const ShowPace::Work& work, Bend bend) {
    const ShowRequest& request = work.request;
    ShowRequest some;
    for (const WantedView& wanted : request.views)
        if (wanted.view.bend == bend) some.views.push_back(wanted);
    if (some.views.empty()) return;
    const ShowFrame frame = withProjectorPixels(bent(bend), work);
    // What is cut off is seen only where there would be room for it.
    const ShowFrame framed = bend == Bend::without ? bent(Bend::forViewer) : frame;
    if (needsProjectors(some))
        objects->renderer.draw(frame);
    else
        objects->renderer.drawEye(frame);
    addTimes(objects->renderer.times());
    for (const WantedView& wanted : some.views) drawView(wanted, frame, framed, work.resolution);
}

void ShowDrawer::Data::collect() {
    if (!under) return;
    const ShowPace::Work work = *std::exchange(under, std::nullopt);
    const auto from = Clock::now();
    for (const WantedView& wanted : work.request.views) {
        const auto reader = objects->readers.find(wanted.id);
        if (reader == objects->readers.end() || !reader->second.started()) continue;
        drawn.pictures.push_back({wanted.id, wanted.view, reader->second.collect()});
    }
    drawn.ms.readBack += since(from);
    drawn.warnings = objects->renderer.warnings();
    // Frames overlap on a graphics card: what counts is how long this one kept the next from coming.
    drawn.ms.total = since(std::max(begun, delivered));
    delivered = Clock::now();
    deliver(work, std::exchange(drawn, {}));
}

void ShowDrawer::draw(const ShowPace::Work& work) {
    Data& data = *data_;
    data.collect();
    data.begun = Clock::now();
    try {
        if (!data.objects) data.objects.emplace();
        data.dropUnwanted(work.request);
        data.pose(work);
        data.eyePixels = eyeSize(work);
        data.objects->renderer.setMeasuring(work.request.measure);
        data.objects->renderer.setEyeSize(data.eyePixels);
        for (const Bend bend : {Bend::asItIs, Bend::without, Bend::forViewer}) data.drawBend(work, bend);
    } catch (...) {
        clear();
        throw;
    }
    data.under = work;
    if (data.way == ReadBack::direct) data.collect();
}

void ShowDrawer::collect() { data_->collect(); }

void ShowDrawer::clear() {
    data_->under.reset();
    data_->objects.reset();
}

std::size_t ShowDrawer::objectCount() const {
    if (!data_->objects) return 0;
    std::size_t count = data_->objects->renderer.objectCount() + 1;
    for (const auto& [id, reader] : data_->objects->readers) count += reader.objectCount();
    return count;
}

} // namespace lumorph::studio
