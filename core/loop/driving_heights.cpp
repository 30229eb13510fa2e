#include "core/loop/driving_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/matrix.hpp>

namespace lumorph {

namespace {

constexpr std::size_t kMostKept = 256;
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// An item with the groups around it, all visible.
Scene aloneIn(const Scene& scene, int id) {
    Scene alone;
    for (const SceneItem* item = findItem(scene, id); item && alone.items.size() < scene.items.size();
         item = findItem(scene, item->parent)) {
        alone.items.insert(alone.items.begin(), *item);
        alone.items.front().visible = true;
        alone.items.front().material = {};
    }
    return alone;
}

bool sameTarget(const DrivingHeights::Source& a, const DrivingHeights::Source& b) {
    return a.target == b.target && a.placement == b.placement && a.targetSeconds == b.targetSeconds &&
           a.playing == b.playing && a.spin == b.spin;
}

} // namespace

DrivingHeights::DrivingHeights(std::span<const glm::vec2> points)
    : points_(points.begin(), points.end()), reader_(points), read_(points.size()) {}

void DrivingHeights::use(const Source& source) {
    const bool sameScene = source.scene == source_.scene && source.item == source_.item;
    Scene alone = sameScene ? alone_ : aloneIn(*source.scene, source.item);
    const bool rides = !alone.items.empty() && alone.items.front().anchor == Anchor::device;
    const bool samePlace = rides || source.worldFromDevice == source_.worldFromDevice;
    if (!(alone == alone_) || source.assets != source_.assets || !samePlace || !sameTarget(source, source_))
        kept_.clear();
    alone_ = std::move(alone);
    source_ = source;
}

void DrivingHeights::at(double seconds, std::span<float> heights) {
    auto found = kept_.find(seconds);
    if (found == kept_.end()) {
        while (kept_.size() >= kMostKept) kept_.erase(seconds > kept_.begin()->first ? kept_.begin() : --kept_.end());
        std::vector<float> fresh(heights.begin(), heights.end());
        workOut(seconds, fresh);
        found = kept_.emplace(seconds, std::move(fresh)).first;
    }
    std::ranges::copy(found->second, heights.begin());
}

void DrivingHeights::workOut(double seconds, std::span<float> heights) {
    if (alone_.items.empty()) return;
    const SceneItem& item = alone_.items.back();
    if (const auto* field = std::get_if<HeightItem>(&item.kind))
        ofHeightField(*field, seconds, heights);
    else if (std::holds_alternative<TargetItem>(item.kind))
        ofTarget(seconds, heights);
    else
        ofSurfaces(seconds, heights);
}

const Image* DrivingHeights::pictureOf(const HeightItem& item) const {
    if (!source_.assets) return nullptr;
    const auto found = source_.assets->images.find(item.image);
    return found == source_.assets->images.end() ? nullptr : found->second.get();
}

void DrivingHeights::ofHeightField(const HeightItem& item, double seconds, std::span<float> heights) const {
    glm::dmat4 deviceFromItem(anchorFromItem(alone_, alone_.items.back(), seconds));
    if (alone_.items.front().anchor == Anchor::world)
        deviceFromItem = glm::inverse(glm::dmat4(source_.worldFromDevice)) * deviceFromItem;
    const glm::dmat4 itemFromDevice = glm::inverse(deviceFromItem);
    const glm::dvec3 up(itemFromDevice[1]);
    std::vector<glm::vec2> places;
    for (const glm::vec2& p : points_) {
        // Where the upright line through the point meets the item's plane.
        const glm::dvec3 foot(itemFromDevice * glm::dvec4(p.x, 0.0, p.y, 1.0));
        const glm::dvec3 met = foot - up * (foot.y / up.y);
        places.emplace_back(met.x, met.z);
    }
    std::vector<float> lifts(points_.size(), 0.0F);
    sampleHeights(item, pictureOf(item), seconds, places, lifts);
    for (std::size_t k = 0; k < heights.size(); ++k) {
        const glm::vec2 inset = 0.5F * item.size - glm::abs(places[k]);
        if (!(inset.x >= 0.0F && inset.y >= 0.0F)) continue;
        heights[k] = static_cast<float>((deviceFromItem * glm::dvec4(places[k].x, lifts[k], places[k].y, 1.0)).y);
    }
}

void DrivingHeights::raise(std::span<const glm::vec3> positions, const glm::mat4& deviceFromSurface,
                           std::span<const glm::uvec3> triangles, std::span<float> highest) {
    placePoints(positions, deviceFromSurface, placed_);
    std::ranges::fill(read_, kNothing);
    reader_.read(placed_, triangles, read_);
    for (std::size_t k = 0; k < highest.size(); ++k)
        if (!std::isnan(read_[k]) && !(highest[k] >= read_[k])) highest[k] = read_[k];
}

void DrivingHeights::ofSurfaces(double seconds, std::span<float> heights) {
    if (!source_.assets) return;
    PoseInput input;
    input.seconds = seconds;
    input.worldFromDevice = source_.worldFromDevice;
    const PosedScene posed = poser_.pose(alone_, *source_.assets, input);
    const glm::mat4 deviceFromWorld = glm::inverse(source_.worldFromDevice);
    std::vector<float> highest(points_.size(), kNothing);
    for (const PosedSurface& surface : posed.surfaces)
        raise(*surface.positions, deviceFromWorld * surface.worldFromSurface, surface.topology->triangles, highest);
    for (std::size_t k = 0; k < heights.size(); ++k)
        if (!std::isnan(highest[k])) heights[k] = highest[k];
}

void DrivingHeights::ofTarget(double seconds, std::span<float> heights) {
    if (!source_.target) return;
    Placement placement = source_.placement;
    placement.yaw = Angle::radians(placement.yaw.inRadians() + seconds * source_.spin);
    const TriangleMesh mesh = meshAt(*source_.target, source_.targetSeconds + (source_.playing ? seconds : 0.0));
    placePoints(mesh.positions, placement.deviceFromTarget(), placed_);
    reader_.read(placed_, mesh.triangles, heights);
}

} // namespace lumorph
