#include "app/applications/navigation/rain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/noise.h"
#include "app/applications/navigation/shapes.h"

namespace lumorph::navigation {
namespace {

constexpr double kRate = 340.0;              ///< drops a second
constexpr double kCloudRadius = 0.032;       ///< radius of the rain, device metres
constexpr double kRunSpeed = 0.032;          ///< of running water, device metres a second
constexpr double kFall = 0.42;               ///< seconds in the air
constexpr double kPatience = 1.5;            ///< seconds in a hollow
constexpr double kRunsOff = 3.2;             ///< seconds in which depth falls by e
constexpr float kDry = 0.06F;                ///< depth
constexpr double kDeepest = 60.0;            ///< depth that is drawn brightest: only where water gathers
constexpr double kStreamCell = 0.0011;       ///< device metres
constexpr double kOver = 0.00035;            ///< of light over the ground, metres
constexpr double kSplash = 0.55;             ///< seconds until a ring has gone
constexpr double kRing = 0.0021;             ///< radius of a ring then, device metres
constexpr int kWetCells = 256;               ///< along the map's longer side
constexpr double kSoaks = 1.6, kDries = 4.0; ///< seconds in which wetness comes and goes by e
constexpr float kSeenWet = 0.02F, kLeastWet = 0.002F;
constexpr double kSwellDrop = 0.002, kSwellFalls = 6.0; ///< metres a drop; seconds in which it falls by e
constexpr double kSwellStep = 0.15;                     ///< metres

/// The picture: two bands of colour, and the phases of a ring.
constexpr glm::ivec2 kPicture{256, 64};
constexpr int kBand = 16, kRingCell = 32, kRings = kPicture.x / kRingCell;
constexpr float kWaterBand = 0.5F * kBand / 64.0F, kWetBand = 1.5F * kBand / 64.0F; // v

void addQuad(Model::Primitive& primitive, const std::array<glm::vec3, 4>& corners, float depth) {
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    for (const glm::vec3& corner : corners) {
        primitive.positions.push_back(corner);
        primitive.normals.emplace_back(0.0F, 1.0F, 0.0F);
        primitive.texcoords.emplace_back(depth, kWaterBand);
    }
    primitive.triangles.emplace_back(first, first + 1, first + 2);
    primitive.triangles.emplace_back(first, first + 2, first + 3);
}

bool overSheet(const glm::dvec2& point) {
    const glm::dvec2 inside = kHalf - glm::abs(point);
    return std::min(inside.x, inside.y) > 0.0005;
}

/// Where light lies: on the ground, or on the water over it.
class Surface {
public:
    Surface(const Map& map, const ViewGround& ground) : map_(map), ground_(ground) {}
    [[nodiscard]] double over(const glm::dvec2& point) const {
        const double land = ground_.surfaceAt(point), water = map_.waterAt(ground_.view().placeAt(point));
        return (std::isnan(water) ? land : std::max(land, ground_.lift(water))) + kOver;
    }

private:
    const Map& map_;
    const ViewGround& ground_;
};

void addRing(Model::Primitive& primitive, const Surface& surface, const glm::dvec2& point, double share) {
    const auto phase = static_cast<float>(std::min(static_cast<int>(share * kRings), kRings - 1));
    const double radius = kRing * (0.25 + 0.75 * std::sqrt(share));
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    for (const glm::vec2& way : {glm::vec2(-1, -1), {-1, 1}, {1, 1}, {1, -1}}) {
        const glm::dvec2 corner = glm::clamp(point + radius * glm::dvec2(way), -kHalf, kHalf);
        primitive.positions.emplace_back(glm::dvec3(corner.x, surface.over(corner), corner.y));
        primitive.normals.emplace_back(0.0F, 1.0F, 0.0F);
        primitive.texcoords.emplace_back((phase + 0.5F + 0.5F * way.x) / static_cast<float>(kRings),
                                         0.75F + 0.25F * way.y);
    }
    primitive.triangles.emplace_back(first, first + 1, first + 2);
    primitive.triangles.emplace_back(first, first + 2, first + 3);
}

/// The wet part of the drawn ground, a little over it.
void addWetGround(Model::Primitive& primitive, const Rain& rain, const ViewGround& ground) {
    constexpr int kAcross = ViewGround::kColumns, kDown = ViewGround::kRows;
    constexpr double kFilm = 0.00018; // metres
    std::array<std::uint32_t, kAcross * kDown> corners{};
    std::array<float, kAcross * kDown> wet{};
    for (int k = 0; k < kAcross * kDown; ++k)
        wet[static_cast<std::size_t>(k)] =
            rain.wetnessAt(ground.view().placeAt(ViewGround::pointAt(k % kAcross, k / kAcross)));
    const auto corner = [&](int i, int j) {
        std::uint32_t& known = corners[static_cast<std::size_t>(j * kAcross + i)];
        if (known > 0) return known - 1;
        const glm::dvec2 point = ViewGround::pointAt(i, j);
        const double y = ground.lift(static_cast<double>(ground.height(i, j))) + kFilm;
        primitive.positions.emplace_back(glm::dvec3(point.x, y, point.y));
        primitive.normals.emplace_back(0.0F, 1.0F, 0.0F);
        primitive.texcoords.emplace_back(std::clamp(wet[static_cast<std::size_t>(j * kAcross + i)], 0.01F, 0.99F),
                                         kWetBand);
        known = static_cast<std::uint32_t>(primitive.positions.size());
        return known - 1;
    };
    for (int j = 0; j + 1 < kDown; ++j)
        for (int i = 0; i + 1 < kAcross; ++i) {
            const auto k = static_cast<std::size_t>(j * kAcross + i);
            if (std::max(std::max(wet[k], wet[k + 1]), std::max(wet[k + kAcross], wet[k + kAcross + 1])) < kSeenWet)
                continue;
            const std::uint32_t a = corner(i, j), b = corner(i, j + 1), c = corner(i + 1, j + 1), d = corner(i + 1, j);
            primitive.triangles.emplace_back(a, b, d);
            primitive.triangles.emplace_back(d, b, c);
        }
}

/// A falling drop, drawn out: two sheets across each other, so that it is seen from all sides.
void addStreak(Model::Primitive& primitive, const glm::dvec2& point, double low, double tall, double half) {
    const auto at = [](const glm::dvec2& p, double y) { return glm::vec3(glm::dvec3(p.x, y, p.y)); };
    for (const glm::dvec2& side : {glm::dvec2(half, 0.0), glm::dvec2(0.0, half)})
        addQuad(
            primitive,
            {at(point - side, low), at(point + side, low), at(point + side, low + tall), at(point - side, low + tall)},
            0.9F);
}

} // namespace

std::optional<glm::ivec2> steepestDescent(const HeightMap& heights, glm::ivec2 sample) noexcept {
    const float here = heights.at(sample);
    std::optional<glm::ivec2> lowest;
    float steepest = 0.0F;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::ivec2 to = sample + glm::ivec2(dx, dy);
            if (to.x < 0 || to.y < 0 || to.x >= heights.samples().x || to.y >= heights.samples().y) continue;
            const float fall =
                (here - heights.at(to)) * (dx != 0 && dy != 0 ? std::numbers::sqrt2_v<float> / 2.0F : 1.0F);
            if (fall <= steepest) continue;
            steepest = fall;
            lowest = to;
        }
    return lowest;
}

void Rain::fall(const Map& map, const MapView& view, const glm::dvec2& cloud, double seconds) {
    due_ += kRate * seconds;
    for (; due_ >= 1.0; due_ -= 1.0) {
        ++fallen_;
        if (drops_.size() >= kMostDrops) continue;
        const double angle = 2.0 * std::numbers::pi * chanceOf({fallen_, 1}, seed_);
        const double far = kCloudRadius * std::sqrt(chanceOf({fallen_, 2}, seed_));
        const glm::dvec2 point = cloud + far * glm::dvec2(std::cos(angle), std::sin(angle));
        if (!overSheet(point) || !map.holds(view.placeAt(point))) continue;
        Drop drop;
        drop.to = map.sampleAt(view.placeAt(point));
        drop.at = map.heights.spacing() * glm::dvec2(drop.to);
        drop.falls = kFall;
        drops_.push_back(drop);
    }
}

/// Cells of streams are about as large on the device at every zoom.
void Rain::wet(const Map& map, const MapView& view, glm::ivec2 from, glm::ivec2 to) {
    const double samples = std::max(1.0, kStreamCell * view.scale() / map.heights.spacing());
    const int octave = static_cast<int>(std::lround(std::log2(samples)));
    const glm::ivec2 here = from >> octave, there = to >> octave;
    Stream& stream = streams_[{octave, {here.x, here.y}}];
    const glm::dvec2 place = map.heights.spacing() * glm::dvec2(from);
    if (stream.depth == 0.0F) stream.from = place;
    stream.to = map.heights.spacing() * glm::dvec2(to);
    if (here == there) return;
    stream.depth += 1.0F;
    Stream& next = streams_[{octave, {there.x, there.y}}];
    if (next.depth == 0.0F) next.to = stream.to;
    next.from = stream.to;
}

bool Rain::run(const Map& map, const MapView& view, Drop& drop, double seconds) {
    if (drop.falls > 0.0) {
        drop.falls -= seconds;
        if (drop.falls <= 0.0) splashes_.push_back({drop.at, 0.0});
        return true;
    }
    double way = kRunSpeed * view.scale() * seconds;
    while (way > 0.0) {
        const glm::dvec2 goal = map.heights.spacing() * glm::dvec2(drop.to);
        const double left = glm::distance(drop.at, goal);
        if (left > way) {
            drop.at += way / left * (goal - drop.at);
            return true;
        }
        drop.at = goal;
        way -= left;
        if (map.isWater(drop.to)) {
            ++reached_;
            return false;
        }
        const std::optional<glm::ivec2> next = steepestDescent(map.heights, drop.to);
        if (!next) return (drop.rests += seconds) < kPatience;
        wet(map, view, drop.to, *next);
        drop.to = *next;
    }
    return true;
}

/// The ground under the cloud takes up water.
void Rain::soak(const Map& map, const MapView& view, const glm::dvec2& cloud, double seconds) {
    const glm::dvec2 size = map.heights.size();
    if (wetness_.empty()) {
        wetness_.assign(static_cast<std::size_t>(kWetCells) * kWetCells, 0.0F);
        wetCell_ = std::max(size.x, size.y) / kWetCells;
    }
    const glm::dvec2 middle = view.placeAt(cloud);
    const double radius = std::max(1.15 * kCloudRadius * view.scale(), 1.5 * wetCell_);
    const glm::ivec2 last(kWetCells - 1);
    const glm::ivec2 from = glm::clamp(glm::ivec2(glm::floor((middle - radius) / wetCell_)), glm::ivec2(0), last);
    const glm::ivec2 to = glm::clamp(glm::ivec2(glm::ceil((middle + radius) / wetCell_)), glm::ivec2(0), last);
    for (int j = from.y; j <= to.y; ++j)
        for (int i = from.x; i <= to.x; ++i) {
            const double far = glm::distance(wetCell_ * (glm::dvec2(i, j) + 0.5), middle) / radius;
            const double rate = smoothStep(0.0, 0.45, 1.0 - far) * seconds / kSoaks;
            float& wetness = wetness_[static_cast<std::size_t>(j * kWetCells + i)];
            wetness = std::min(1.0F, wetness + static_cast<float>(rate));
        }
    wettest_ = 1.0F;
}

void Rain::age(double seconds) {
    const auto kept = static_cast<float>(std::exp(-seconds / kRunsOff));
    for (auto& [key, stream] : streams_) stream.depth *= kept;
    std::erase_if(streams_, [](const auto& entry) { return entry.second.depth < kDry; });
    for (Splash& splash : splashes_) splash.age += seconds;
    std::erase_if(splashes_, [](const Splash& splash) { return splash.age >= kSplash; });
    swell_ *= std::exp(-seconds / kSwellFalls);
    if (wettest_ == 0.0F) return;
    const auto left = static_cast<float>(std::exp(-seconds / kDries));
    wettest_ = 0.0F;
    for (float& wetness : wetness_) {
        wetness *= left;
        wettest_ = std::max(wettest_, wetness);
    }
    if (wettest_ >= kLeastWet) return;
    std::ranges::fill(wetness_, 0.0F);
    wettest_ = 0.0F;
}

void Rain::advance(const Map& map, const MapView& view, const std::optional<glm::dvec2>& cloud, double seconds) {
    age(seconds);
    if (cloud) {
        fall(map, view, *cloud, seconds);
        soak(map, view, *cloud, seconds);
    }
    const std::size_t before = reached_;
    std::erase_if(drops_,
                  [&](Drop& drop) { return !run(map, view, drop, seconds) || !overSheet(view.pointAt(drop.at)); });
    swell_ = std::min(kMostSwell, swell_ + kSwellDrop * static_cast<double>(reached_ - before));
}

float Rain::wetnessAt(const glm::dvec2& place) const noexcept {
    if (wettest_ == 0.0F) return 0.0F;
    const glm::dvec2 cell = glm::clamp(place / wetCell_ - 0.5, glm::dvec2(0.0), glm::dvec2(kWetCells - 1.001));
    const glm::ivec2 at(cell);
    const glm::vec2 t(cell - glm::dvec2(at));
    const float* w = wetness_.data() + at.y * kWetCells + at.x;
    return std::lerp(std::lerp(w[0], w[1], t.x), std::lerp(w[kWetCells], w[kWetCells + 1], t.x), t.y);
}

double Rain::swell() const noexcept { return kSwellStep * std::floor(swell_ / kSwellStep); }

SceneModel Rain::model(const Map& map, const ViewGround& ground, double cloudHeight) const {
    Model::Primitive primitive;
    const Surface surface(map, ground);
    const auto over = [&](const glm::dvec2& point) { return surface.over(point); };
    const auto at = [](const glm::dvec2& point, double y) { return glm::vec3(glm::dvec3(point.x, y, point.y)); };
    if (wettest_ > 0.0F) addWetGround(primitive, *this, ground);
    for (const auto& [key, stream] : streams_) {
        const glm::dvec2 from = ground.view().pointAt(stream.from), to = ground.view().pointAt(stream.to);
        if (!overSheet(from) || !overSheet(to) || glm::distance(from, to) < 1e-6) continue;
        const auto depth = static_cast<double>(stream.depth);
        const glm::dvec2 along = glm::normalize(to - from);
        const glm::dvec2 side = (0.00012 + 0.00011 * std::min(std::sqrt(depth), 9.0)) * glm::dvec2(-along.y, along.x);
        const glm::dvec2 ahead = 0.0003 * along; // pieces meet in bends, too
        const double low = over(from), high = over(to);
        addQuad(primitive,
                {at(from - side - ahead, low), at(from + side - ahead, low), at(to + side + ahead, high),
                 at(to - side + ahead, high)},
                static_cast<float>(std::clamp(std::pow(depth / kDeepest, 0.65), 0.03, 0.95)));
    }
    for (const Splash& splash : splashes_) {
        const glm::dvec2 point = ground.view().pointAt(splash.at);
        if (overSheet(point)) addRing(primitive, surface, point, splash.age / kSplash);
    }
    for (const Drop& drop : drops_) {
        const glm::dvec2 point = ground.view().pointAt(drop.at);
        const double share = std::clamp(drop.falls / kFall, 0.0, 1.0);
        if (share > 0.0)
            addStreak(primitive, point, std::lerp(over(point), cloudHeight, share), 0.0075, 0.0003);
        else
            addStreak(primitive, point, over(point), 0.0008, 0.00016);
    }
    SceneModel made;
    Model::Mesh mesh;
    if (!primitive.triangles.empty()) mesh.primitives.push_back(std::move(primitive));
    made.model.meshes.push_back(std::move(mesh));
    Model::Node node;
    node.mesh = 0;
    made.model.nodes.push_back(std::move(node));
    made.model.roots = {0};
    return made;
}

std::shared_ptr<const Image> rainImage() {
    auto image = std::make_shared<Image>(kPicture);
    const auto put = [&](int x, int y, const glm::vec3& color, float opacity) {
        const glm::vec3 bytes = 255.0F * color;
        image->at(x, y) = {static_cast<std::uint8_t>(bytes.r), static_cast<std::uint8_t>(bytes.g),
                           static_cast<std::uint8_t>(bytes.b), static_cast<std::uint8_t>(255.0F * opacity)};
    };
    const glm::vec3 shallow(0.24F, 0.46F, 0.66F), deep(0.72F, 0.90F, 1.0F), wet(0.05F, 0.07F, 0.09F);
    for (int x = 0; x < kPicture.x; ++x) {
        const float share = static_cast<float>(x) / static_cast<float>(kPicture.x - 1);
        for (int y = 0; y < kBand; ++y) {
            put(x, y, glm::mix(shallow, deep, share), glm::mix(0.03F, 0.95F, share));
            put(x, y + kBand, wet, 0.72F * share);
        }
    }
    for (int y = 0; y < kRingCell; ++y)
        for (int x = 0; x < kPicture.x; ++x) {
            const float gone = static_cast<float>(x / kRingCell) / static_cast<float>(kRings);
            const glm::vec2 off = glm::vec2(x % kRingCell, y) + 0.5F - 0.5F * kRingCell;
            const float line = 1.0F - std::abs(glm::length(off) - 0.40F * kRingCell) / 2.6F;
            put(x, kPicture.y - kRingCell + y, {0.90F, 0.97F, 1.0F}, 0.95F * (1.0F - gone) * std::max(0.0F, line));
        }
    return image;
}

} // namespace lumorph::navigation
