#include "app/applications/navigation/rain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/noise.h"

namespace lumorph::navigation {
namespace {

constexpr double kRate = 130.0;        ///< drops a second
constexpr double kCloudRadius = 0.017; ///< radius of the rain, device metres
constexpr double kRunSpeed = 0.032;    ///< of running water, device metres a second
constexpr double kFall = 0.35;         ///< seconds in the air
constexpr double kPatience = 1.5;      ///< seconds in a hollow
constexpr double kRunsOff = 2.6;       ///< seconds in which depth falls by e
constexpr float kDry = 0.06F;          ///< depth
constexpr double kStreamCell = 0.0011; ///< device metres
constexpr double kOver = 0.00035;      ///< of light over the ground, metres

void addQuad(Model::Primitive& primitive, const std::array<glm::vec3, 4>& corners, float depth) {
    const auto first = static_cast<std::uint32_t>(primitive.positions.size());
    for (const glm::vec3& corner : corners) {
        primitive.positions.push_back(corner);
        primitive.normals.emplace_back(0.0F, 1.0F, 0.0F);
        primitive.texcoords.emplace_back(depth, 0.5F);
    }
    primitive.triangles.emplace_back(first, first + 1, first + 2);
    primitive.triangles.emplace_back(first, first + 2, first + 3);
}

bool overSheet(const glm::dvec2& point) {
    const glm::dvec2 inside = kHalf - glm::abs(point);
    return std::min(inside.x, inside.y) > 0.0005;
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
        if (!overSheet(point)) continue;
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

void Rain::advance(const Map& map, const MapView& view, const std::optional<glm::dvec2>& cloud, double seconds) {
    const auto kept = static_cast<float>(std::exp(-seconds / kRunsOff));
    for (auto& [key, stream] : streams_) stream.depth *= kept;
    std::erase_if(streams_, [](const auto& entry) { return entry.second.depth < kDry; });
    if (cloud) fall(map, view, *cloud, seconds);
    std::erase_if(drops_,
                  [&](Drop& drop) { return !run(map, view, drop, seconds) || !overSheet(view.pointAt(drop.at)); });
}

SceneModel Rain::model(const ViewGround& ground, double cloudHeight) const {
    Model::Primitive primitive;
    const auto over = [&](const glm::dvec2& point) { return ground.surfaceAt(point) + kOver; };
    const auto at = [](const glm::dvec2& point, double y) { return glm::vec3(glm::dvec3(point.x, y, point.y)); };
    for (const auto& [key, stream] : streams_) {
        const glm::dvec2 from = ground.view().pointAt(stream.from), to = ground.view().pointAt(stream.to);
        if (!overSheet(from) || !overSheet(to) || glm::distance(from, to) < 1e-6) continue;
        const auto depth = static_cast<double>(stream.depth);
        const glm::dvec2 along = glm::normalize(to - from);
        const glm::dvec2 side = (0.00016 + 0.00013 * std::min(std::sqrt(depth), 6.0)) * glm::dvec2(-along.y, along.x);
        const glm::dvec2 ahead = 0.0003 * along; // pieces meet in bends, too
        const double low = over(from), high = over(to);
        addQuad(primitive,
                {at(from - side - ahead, low), at(from + side - ahead, low), at(to + side + ahead, high),
                 at(to - side + ahead, high)},
                static_cast<float>(std::clamp(0.1 + 0.28 * std::log1p(depth), 0.05, 0.95)));
    }
    for (const Drop& drop : drops_) {
        const glm::dvec2 point = ground.view().pointAt(drop.at);
        const double share = std::clamp(drop.falls / kFall, 0.0, 1.0);
        const double low = std::lerp(over(point), cloudHeight, share), tall = share > 0.0 ? 0.004 : 0.0012;
        const glm::dvec2 side(0.00022, 0.0), deep(0.0, 0.00022);
        addQuad(
            primitive,
            {at(point - side, low), at(point + side, low), at(point + side, low + tall), at(point - side, low + tall)},
            0.9F);
        addQuad(
            primitive,
            {at(point - deep, low), at(point + deep, low), at(point + deep, low + tall), at(point - deep, low + tall)},
            0.9F);
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
    constexpr int kWidth = 64;
    auto image = std::make_shared<Image>(glm::ivec2(kWidth, 4));
    const glm::vec3 shallow(0.16F, 0.50F, 0.85F), deep(0.80F, 0.97F, 1.0F);
    for (int x = 0; x < kWidth; ++x) {
        const float share = static_cast<float>(x) / (kWidth - 1);
        const glm::vec3 color = 255.0F * glm::mix(shallow, deep, share);
        for (int y = 0; y < 4; ++y)
            image->at(x, y) = {static_cast<std::uint8_t>(color.r), static_cast<std::uint8_t>(color.g),
                               static_cast<std::uint8_t>(color.b),
                               static_cast<std::uint8_t>(255.0F * glm::mix(0.55F, 0.95F, share))};
    }
    return image;
}

} // namespace lumorph::navigation
