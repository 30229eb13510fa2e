#include "app/applications/navigation/ground_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"
#include "app/applications/navigation/view_ground.h"

namespace lumorph::navigation {
namespace {

constexpr double kMargin = 1.5;    ///< side of a window over the width of its view, at least
constexpr double kSideStep = 0.5;  ///< of sides, powers of two
constexpr double kFurrow = 4.5;    ///< metres
constexpr double kThinnest = 0.75; ///< pixels, half the width of a road from afar
constexpr double kGrain = 0.035;
constexpr glm::vec3 kBoard{0.80F, 0.76F, 0.67F}; ///< on which the map lies
constexpr double kFeetTo = 2.2;                  ///< metres a pixel up to which walls darken the ground at their foot
constexpr double kFootReach = 3.4;               ///< metres
constexpr double kFootShade = 0.5;
constexpr glm::vec3 kFoot{0.16F, 0.15F, 0.14F}, kHedge{0.22F, 0.34F, 0.17F};

void lay(Image::Pixel& pixel, const glm::vec3& color, float share) {
    for (int c = 0; c < 3; ++c) {
        auto& channel = pixel[static_cast<std::size_t>(c)];
        const auto value = static_cast<float>(channel);
        channel = static_cast<std::uint8_t>(value + (255.0F * color[c] - value) * share + 0.5F);
    }
}

std::uint8_t byteOf(double share) {
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

/// How far a place lies outside a convex outline; negative in it.
double outsideOf(const std::vector<glm::dvec2>& corners, const glm::dvec2& at) {
    double outside = -1e9;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec2 side = corners[(k + 1) % corners.size()] - corners[k];
        outside = std::max(outside, glm::dot(at - corners[k], glm::normalize(glm::dvec2(side.y, -side.x))));
    }
    return outside;
}

struct PixelBox {
    glm::ivec2 from, to;
    [[nodiscard]] bool empty() const { return from.x > to.x || from.y > to.y; }
    [[nodiscard]] int pixels() const { return empty() ? 0 : (to.x - from.x + 1) * (to.y - from.y + 1); }
};

PixelBox boxAround(const glm::dvec2& min, const glm::dvec2& max, double margin) {
    const double last = GroundPicture::kSide - 1;
    const glm::dvec2 from = glm::clamp(glm::floor(min - margin), glm::dvec2(0.0), glm::dvec2(last + 1.0));
    const glm::dvec2 to = glm::clamp(glm::ceil(max + margin), glm::dvec2(-1.0), glm::dvec2(last));
    return {glm::ivec2(from), glm::ivec2(to)};
}

} // namespace

bool PictureWindow::covers(const MapView& view) const noexcept {
    for (const glm::dvec2& way : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
        const glm::dvec2 inside = view.placeAt(way * kHalf) - corner;
        if (std::min(inside.x, inside.y) < 0.0 || std::max(inside.x, inside.y) > side) return false;
    }
    return true;
}

PictureWindow windowFor(const MapView& view) noexcept {
    PictureWindow window;
    window.side = std::exp2(kSideStep * std::ceil(std::log2(kMargin * view.width) / kSideStep));
    const double grid = window.side / 16.0;
    window.corner = grid * glm::round((view.centre - 0.5 * window.side) / grid);
    return window;
}

PictureWindow wholeWindow(const Map& map) noexcept {
    const glm::dvec2 size = map.heights.size();
    const double side = wholeView(size);
    return {0.5 * (size - side), side};
}

GroundPicture::GroundPicture(const Map& map, const PictureWindow& window)
    : map_(&map), window_(window), color_(std::make_shared<Image>(glm::ivec2(kSide))),
      relief_(std::make_shared<Image>(glm::ivec2(kSide))) {
    measureCoarse();
    for (std::vector<float>* row : {&before_, &at_, &after_}) row->resize(kSide);
    measureRow(0, at_);
    before_ = at_;
}

void GroundPicture::measureCoarse() {
    const double detail = window_.side / kMargin / (ViewGround::kColumns - 1);
    coarse_.reserve(static_cast<std::size_t>(kCoarse) * kCoarse);
    for (int j = 0; j < kCoarse; ++j)
        for (int i = 0; i < kCoarse; ++i)
            coarse_.push_back(static_cast<float>(
                map_->heights.at(window_.corner + window_.side / (kCoarse - 1) * glm::dvec2(i, j), detail)));
}

void GroundPicture::measureRow(int row, std::vector<float>& over) const {
    constexpr double kPixels = static_cast<double>(kSide) / (kCoarse - 1);
    const double v = (row + 0.5) / kPixels;
    const int j = std::min(static_cast<int>(v), kCoarse - 2);
    const float tv = static_cast<float>(v - j);
    const float* north = coarse_.data() + j * kCoarse;
    const float* south = north + kCoarse;
    const double y = window_.corner.y + (row + 0.5) * metresAPixel();
    for (int x = 0; x < kSide; ++x) {
        const double u = (x + 0.5) / kPixels;
        const int i = std::min(static_cast<int>(u), kCoarse - 2);
        const float tu = static_cast<float>(u - i);
        const float coarse =
            std::lerp(std::lerp(north[i], north[i + 1], tu), std::lerp(south[i], south[i + 1], tu), tv);
        const glm::dvec2 place(window_.corner.x + (x + 0.5) * metresAPixel(), y);
        over[static_cast<std::size_t>(x)] =
            map_->holds(place) ? static_cast<float>(map_->heights.at(place, metresAPixel())) - coarse : 0.0F;
    }
}

glm::vec3 GroundPicture::coverAt(const glm::dvec2& place) const noexcept {
    if (!map_->holds(place)) return kBoard;
    const glm::ivec2 samples = map_->heights.samples();
    const glm::dvec2 cell = glm::clamp(place / map_->heights.spacing(), glm::dvec2(0.0), glm::dvec2(samples - 1));
    const glm::ivec2 at = glm::min(glm::ivec2(cell), samples - 2);
    const glm::vec2 t(cell - glm::dvec2(at));
    const glm::vec3* c = map_->cover.data() + map_->index(at);
    return glm::mix(glm::mix(c[0], c[1], t.x), glm::mix(c[samples.x], c[samples.x + 1], t.x), t.y);
}

void GroundPicture::paintRow(int row) {
    measureRow(std::min(row + 1, kSide - 1), after_);
    const double slopes = 0.5 / metresAPixel();
    for (int x = 0; x < kSide; ++x) {
        const glm::dvec2 place = window_.corner + metresAPixel() * (glm::dvec2(x, row) + 0.5);
        const auto k = static_cast<std::size_t>(x);
        const std::size_t west = x > 0 ? k - 1 : k, east = x + 1 < kSide ? k + 1 : k;
        const glm::dvec2 slope = slopes * glm::dvec2(at_[east] - at_[west], after_[k] - before_[k]);
        const glm::dvec3 normal =
            glm::normalize(glm::dvec3(-slope.x, slope.y, 1.0)); // to the right, and up on the page
        relief_->at(x, row) = {byteOf(0.5 + 0.5 * normal.x), byteOf(0.5 + 0.5 * normal.y), byteOf(0.5 + 0.5 * normal.z),
                               255};
        const double grain = 1.0 + kGrain * (2.0 * chanceOf(glm::ivec2(x, row), 5) - 1.0);
        lay(color_->at(x, row), glm::clamp(coverAt(place) * static_cast<float>(grain), 0.0F, 1.0F), 1.0F);
    }
    std::swap(before_, at_);
    std::swap(at_, after_);
}

int GroundPicture::paintParcel(const Parcel& parcel) {
    glm::dvec2 min(std::numeric_limits<double>::infinity()), max = -min;
    std::vector<glm::dvec2> corners;
    for (const glm::dvec2& corner : parcel.outline) {
        corners.push_back(pixelOf(corner));
        min = glm::min(min, corners.back());
        max = glm::max(max, corners.back());
    }
    const PixelBox box = boxAround(min, max, 1.0);
    if (box.empty()) return 1;
    const glm::dvec2 along = glm::normalize(corners[1] - corners[0]);
    const double hedge = parcel.hedge / metresAPixel();
    const double fine = parcel.furrows * (1.0 - smoothStep(0.15, 0.4, metresAPixel() / kFurrow));
    for (int y = box.from.y; y <= box.to.y; ++y)
        for (int x = box.from.x; x <= box.to.x; ++x) {
            const glm::dvec2 at(x, y);
            const double outside = outsideOf(corners, at);
            if (outside >= 0.5) continue;
            const double across = metresAPixel() * glm::dot(at - corners[0], glm::dvec2(-along.y, along.x));
            const double stripe = 1.0 + 0.25 * fine * std::sin(2.0 * std::numbers::pi * across / kFurrow);
            lay(color_->at(x, y), glm::clamp(parcel.color * static_cast<float>(stripe), 0.0F, 1.0F),
                static_cast<float>(0.8 * std::clamp(0.5 - outside, 0.0, 1.0)));
            if (hedge <= 0.0 || outside < -hedge - 0.5) continue;
            const double grown = std::clamp(hedge + 0.5 + outside, 0.0, 1.0) * std::clamp(0.5 - outside, 0.0, 1.0);
            lay(color_->at(x, y), kHedge, static_cast<float>(0.75 * grown * std::min(1.0, hedge)));
        }
    return box.pixels();
}

/// Next to a wall the ground sees less of the sky: the soft shadow at its foot.
int GroundPicture::paintFoot(const Building& building) {
    if (!building.grounded || metresAPixel() > kFeetTo) return 1;
    const double reach = kFootReach / metresAPixel();
    std::vector<glm::dvec2> corners;
    glm::dvec2 min(std::numeric_limits<double>::infinity()), max = -min;
    for (const glm::dvec2& corner : building.outline) {
        corners.push_back(pixelOf(corner));
        min = glm::min(min, corners.back());
        max = glm::max(max, corners.back());
    }
    const PixelBox box = boxAround(min, max, reach);
    if (box.empty()) return 1;
    for (int y = box.from.y; y <= box.to.y; ++y)
        for (int x = box.from.x; x <= box.to.x; ++x) {
            const double open = smoothStep(-0.3 * reach, reach, outsideOf(corners, {x, y}));
            if (open < 1.0) lay(color_->at(x, y), kFoot, static_cast<float>(kFootShade * (1.0 - open)));
        }
    return box.pixels();
}

int GroundPicture::paintRoad(const Road& road, std::size_t piece) {
    const glm::dvec2 a = pixelOf(road.line[piece]), b = pixelOf(road.line[piece + 1]);
    const double half = std::max(0.5 * road.width / metresAPixel(), kThinnest);
    const PixelBox box = boxAround(glm::min(a, b), glm::max(a, b), half + 1.0);
    if (box.empty()) return 1;
    for (int y = box.from.y; y <= box.to.y; ++y)
        for (int x = box.from.x; x <= box.to.x; ++x) {
            const double share = half + 0.5 - distanceTo(a, b, glm::dvec2(x, y));
            if (share > 0.0) lay(color_->at(x, y), road.color, static_cast<float>(std::min(share, 1.0)));
        }
    return box.pixels();
}

bool GroundPicture::paint(int pixels) {
    while (!done_ && pixels > 0) {
        if (row_ < kSide) {
            paintRow(row_++);
            pixels -= kSide;
        } else if (parcel_ < map_->parcels.size()) {
            pixels -= paintParcel(map_->parcels[parcel_++]) / 2 + 30;
        } else if (road_ < map_->roads.size()) {
            const Road& road = map_->roads[road_];
            if (piece_ + 1 < road.line.size()) {
                pixels -= paintRoad(road, piece_++) / 2 + 20;
            } else {
                ++road_;
                piece_ = 0;
            }
        } else if (foot_ < map_->buildings.size()) {
            pixels -= paintFoot(map_->buildings[foot_++]) / 2 + 4;
        } else {
            done_ = true;
        }
    }
    return done_;
}

} // namespace lumorph::navigation
