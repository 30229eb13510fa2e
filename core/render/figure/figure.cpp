#include "core/render/figure/figure.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/render/figure/text.h"
#include "core/render/gl/frame_target.h"

namespace lumorph {
namespace {

constexpr int kSamples = 4;
const glm::vec3 kFromFrontRightAbove(0.55F, 0.52F, 0.85F);

struct Ink {
    glm::vec3 caption, footer;
};

Ink inkOf(Theme theme) {
    if (theme == Theme::light) return {{0.13F, 0.15F, 0.18F}, {0.29F, 0.32F, 0.37F}};
    return {{0.93F, 0.94F, 0.96F}, {0.66F, 0.70F, 0.76F}};
}

// Squares of 1, 10 or 100 times a power of ten of metres, so that a scene spans some dozens of them.
struct GridScale {
    float step; // metres
    std::string square;
    int barSquares; // five, or one where the scene is narrow
    std::string bar;
};

GridScale gridScaleOf(const Box& scene) {
    const float longest = std::max({scene.size().x, scene.size().y, scene.size().z});
    const int power = std::clamp(static_cast<int>(std::ceil(std::log10(longest / 0.5F))) - 2, -6, 3);
    const auto named = [&](int count) -> std::string {
        if (power >= 0) return std::to_string(count * static_cast<int>(std::lround(std::pow(10, power)))) + " m";
        if (power >= -2) return std::to_string(count * (power == -1 ? 10 : 1)) + " cm";
        if (power == -3) return std::to_string(count) + " mm";
        return std::to_string(count * static_cast<int>(std::lround(std::pow(10, power + 6)))) + " µm";
    };
    const auto step = static_cast<float>(std::pow(10.0, power));
    const int squares = 5.0F * step <= 0.6F * scene.size().x ? 5 : 1;
    return {step, named(1), squares, named(squares)};
}

Box boxOf(const Figure& figure) {
    Box box;
    for (const FigurePanel& panel : figure.panels)
        for (const FigureItem& item : panel.items)
            if (!item.mesh.empty()) box.include(boundingBox(item.mesh.positions));
    return box;
}

StudioGround groundOf(const Box& scene, const GridScale& scale) {
    StudioGround ground;
    ground.height = scene.min.y;
    ground.centre = {scene.centre().x, scene.centre().z};
    ground.radius = 0.5F * glm::length(glm::vec2(scene.size().x, scene.size().z));
    ground.radius = std::max(ground.radius, 0.25F * scene.size().y);
    ground.gridStep = scale.step;
    // On the grid, in front of everything, near the left.
    const float left = scene.min.x + 0.12F * scene.size().x;
    const float front = scene.max.z + 0.04F * ground.radius;
    ground.barStart = glm::ceil(glm::vec2(left, front) / scale.step) * scale.step;
    return ground;
}

void requireDrawable(const Figure& figure) {
    for (const FigurePanel& panel : figure.panels)
        for (const FigureItem& item : panel.items)
            if (!(item.opacity >= 0.0F && item.opacity <= 1.0F))
                throw InvalidInput("opacity " + std::to_string(item.opacity), "no share of 1", "use 0 to 1");
}

void requireNoError() {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    throw DeviceError("OpenGL",
                      error == GL_OUT_OF_MEMORY ? "the driver has no memory for this figure"
                                                : "the driver refused to draw (error " + std::to_string(error) + ")",
                      "use a smaller size or smaller meshes, or update the graphics driver");
}

void writeCentred(Image& image, const Font& font, const std::string& text, const FigureRect& strip, float em,
                  const glm::vec3& color) {
    const std::string fitted = font.fitted(text, em, static_cast<float>(strip.size.x) - em);
    const glm::vec2 origin(strip.origin);
    const glm::vec2 size(strip.size);
    const float left = origin.x + 0.5F * (size.x - font.width(fitted, em));
    font.write(image, fitted, {left, origin.y + 0.5F * size.y + 0.36F * em}, em, color);
}

} // namespace

FigureLayout layoutOf(const Figure& figure, glm::ivec2 size) {
    const int count = static_cast<int>(figure.panels.size());
    FigureLayout layout;
    layout.em = std::clamp(static_cast<float>(size.y) / 26.0F, 10.0F, 44.0F);
    const int captionHeight = static_cast<int>(std::lround(2.2F * layout.em));
    const int footerHeight = static_cast<int>(std::lround(1.9F * layout.em));
    const int viewHeight = size.y - captionHeight - footerHeight;
    if (count < 1) throw InvalidInput("figure", "it has no panels", "add one");
    if (size.x / count < 16 || viewHeight < 16)
        throw InvalidInput("figure size " + std::to_string(size.x) + "x" + std::to_string(size.y),
                           "there is no room for " + std::to_string(count) + " panels", "use a larger size");
    for (int i = 0; i < count; ++i) {
        const int left = size.x * i / count;
        const int width = size.x * (i + 1) / count - left;
        layout.views.push_back({{left, 0}, {width, viewHeight}});
        layout.captions.push_back({{left, viewHeight}, {width, captionHeight}});
    }
    layout.footer = {{0, size.y - footerHeight}, {size.x, footerHeight}};
    return layout;
}

// Panels may differ by one pixel in width; the narrowest decides.
Camera cameraOf(const Figure& figure, const FigureLayout& layout) {
    glm::ivec2 size = layout.views.front().size;
    for (const FigureRect& view : layout.views) size = glm::min(size, view.size);
    return frameBox(boxOf(figure), kFromFrontRightAbove, static_cast<float>(size.x) / static_cast<float>(size.y),
                    0.86F);
}

struct FigureRenderer::Data {
    StudioPass studio;
    Font font{resourceFile("fonts/Inter-Regular.otf")};

    void drawPanel(const FrameTarget& target, StudioView view, const FigurePanel& panel) {
        std::vector<GpuMesh> meshes;
        std::vector<StudioSurface> surfaces;
        meshes.reserve(panel.items.size());
        for (const FigureItem& item : panel.items) {
            if (item.mesh.empty()) continue;
            meshes.emplace_back(shade(item.mesh, item.crease));
            surfaces.push_back({&meshes.back(), item.color, item.opacity, boundingBox(item.mesh.positions).centre()});
        }
        studio.draw(target.framebuffer(), target.size(), view, surfaces);
    }

    void write(Image& image, const Figure& figure, const FigureLayout& layout, const GridScale& scale) const {
        const Ink ink = inkOf(figure.theme);
        for (std::size_t i = 0; i < figure.panels.size(); ++i)
            writeCentred(image, font, figure.panels[i].caption, layout.captions[i], layout.em, ink.caption);
        const float em = 0.68F * layout.em;
        const float baseline =
            static_cast<float>(layout.footer.origin.y) + 0.5F * static_cast<float>(layout.footer.size.y) + 0.36F * em;
        const std::string grid = "Grid " + scale.square;
        const float right = static_cast<float>(image.size().x) - layout.em;
        const float gridLeft = right - font.width(grid, em);
        font.write(image, grid, {gridLeft, baseline}, em, ink.footer);
        font.write(image, font.fitted(figure.footer, em, gridLeft - 2.0F * layout.em), {layout.em, baseline}, em,
                   ink.footer);
    }

    // Under the bar, in the plane of the picture.
    void labelBar(Image& image, const StudioView& view, const GridScale& scale, float em) const {
        const StudioGround& ground = view.ground;
        const glm::vec2 middle =
            ground.barStart + glm::vec2(0.5F * static_cast<float>(scale.barSquares) * scale.step, 0.0F);
        const glm::vec2 at = glm::vec2(view.viewOrigin) +
                             pixelOf(view.camera, {middle.x, ground.height, middle.y}, glm::vec2(view.viewSize));
        const std::string& text = scale.bar;
        const glm::vec2 origin(at.x - 0.5F * font.width(text, em), at.y + 1.6F * em);
        const glm::vec2 low(view.viewOrigin);
        const glm::vec2 high = low + glm::vec2(view.viewSize) - glm::vec2(0.0F, 0.4F * em);
        font.write(image, text, glm::clamp(origin, low, high), em, inkOf(view.theme).footer);
    }
};

FigureRenderer::FigureRenderer() : data_(std::make_unique<Data>()) {}
FigureRenderer::~FigureRenderer() = default;
FigureRenderer::FigureRenderer(FigureRenderer&&) noexcept = default;
FigureRenderer& FigureRenderer::operator=(FigureRenderer&&) noexcept = default;

Image FigureRenderer::render(const Figure& figure, glm::ivec2 size) {
    requireDrawable(figure);
    const FigureLayout layout = layoutOf(figure, size);
    StudioView view;
    view.camera = cameraOf(figure, layout);
    view.scene = boxOf(figure);
    view.theme = figure.theme;
    view.lighting = figure.lighting;
    const GridScale scale = gridScaleOf(view.scene);
    view.ground = groundOf(view.scene, scale);

    const FrameTarget target(size, kSamples);
    data_->studio.drawBackdrop(target.framebuffer(), size, figure.theme);
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        view.viewOrigin = layout.views[i].origin;
        view.viewSize = layout.views[i].size;
        view.regionOrigin = view.viewOrigin;
        view.regionSize = {view.viewSize.x, size.y};
        view.ground.barSquares = i == 0 ? scale.barSquares : 0;
        data_->drawPanel(target, view, figure.panels[i]);
    }
    requireNoError();
    Image image = target.read();
    view.viewOrigin = layout.views[0].origin;
    view.viewSize = layout.views[0].size;
    data_->labelBar(image, view, scale, 0.68F * layout.em);
    data_->write(image, figure, layout, scale);
    return image;
}

Image renderFigure(const Figure& figure, glm::ivec2 size) { return FigureRenderer().render(figure, size); }

} // namespace lumorph
