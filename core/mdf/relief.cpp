#include "core/mdf/relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/voxels/column_raster.h"

namespace lumorph {

namespace {

constexpr int kNothing = -1'000'000'000;
/// Of the room's height: how far the lowest that is seen stands out of the device, so that the outline can be felt.
constexpr double kPlinth = 0.1;

/// The highest level at which each column meets the mesh: voxels below it are under the surface.
std::vector<int> topsOf(const VoxelFrame& frame, std::span<const glm::vec3> positions,
                        std::span<const glm::uvec3> triangles) {
    Box reach = frame.box();
    for (const glm::vec3& p : positions) reach.include(p);
    const GridSnap snap(frame, reach);
    std::vector<GridVertex> vertices;
    vertices.reserve(positions.size());
    for (const glm::vec3& p : positions) vertices.push_back(snap(p));
    const ColumnRange all = columnsOf(frame);
    std::vector<int> tops(all.size(), kNothing);
    const auto width = static_cast<std::size_t>(all.width());
    for (const glm::uvec3& t : triangles)
        rasterizeTriangle(vertices[t.x], vertices[t.y], vertices[t.z], snap.shift(), all,
                          [&](int x, int z, int level, bool) {
                              int& top = tops[static_cast<std::size_t>(z) * width + static_cast<std::size_t>(x)];
                              top = std::max(top, level);
                          });
    return tops;
}

/// A rising curve from the heights that are seen to [0, 1].
class HeightCurve {
public:
    explicit HeightCurve(const std::vector<int>& tops) {
        int seen = 0;
        for (const int top : tops) {
            if (top == kNothing) continue;
            low_ = seen == 0 ? top : std::min(low_, top);
            high_ = seen == 0 ? top : std::max(high_, top);
            ++seen;
        }
        if (seen == 0 || high_ == low_) return;
        for (const int top : tops)
            if (top != kNothing) below_[binOf(top) + 1] += 1.0 / seen;
        for (std::size_t k = 1; k < below_.size(); ++k) below_[k] += below_[k - 1];
    }
    [[nodiscard]] double operator()(int top) const {
        if (high_ == low_) return 1.0;
        const double linear = static_cast<double>(top - low_) / (high_ - low_);
        const double place = linear * kBins;
        const std::size_t bin = binOf(top);
        const double seen = std::lerp(below_[bin], below_[bin + 1], place - static_cast<double>(bin));
        return 0.5 * (linear + seen);
    }

private:
    static constexpr int kBins = 64;
    [[nodiscard]] std::size_t binOf(int top) const {
        return static_cast<std::size_t>(
            std::min(kBins - 1.0, std::floor(kBins * static_cast<double>(top - low_) / (high_ - low_))));
    }
    int low_ = 0, high_ = 0;
    std::array<double, kBins + 1> below_{}; ///< share of what is seen below each bin
};

} // namespace

std::optional<ReliefRoom> reliefRoom(const Field& field) {
    const BitColumns reachable = reachableVoxels(field);
    const int height = field.frame.dimensions.y;
    ReliefRoom room{field.frame, field.restSurface, 0.0F, {}};
    std::vector<float> tops;
    const auto side = static_cast<float>(field.frame.voxelSize);
    for (int z = 0; z < field.frame.dimensions.z; ++z)
        for (int x = 0; x < field.frame.dimensions.x; ++x)
            for (int y = height - 1; y >= 0; --y) {
                if (!reachable.test(x, y, z)) continue;
                const glm::vec3 corner = field.frame.origin + side * glm::vec3(x, y, z);
                tops.push_back(corner.y + side);
                room.reach.include(corner);
                room.reach.include(corner + side);
                break;
            }
    if (!tops.empty()) {
        const auto place = tops.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(tops.size() - 1));
        std::ranges::nth_element(tops, place);
        room.top = *place;
    }
    if (!(room.top > room.rest + side)) return std::nullopt;
    return room;
}

void voxelizeRelief(const ReliefRoom& room, std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                    BitColumns& out) {
    const VoxelFrame& frame = room.frame;
    if (out.dimensions() != frame.dimensions)
        out = BitColumns(frame.dimensions);
    else
        out.clear();
    const std::vector<int> tops = topsOf(frame, positions, triangles);
    const HeightCurve curve(tops);
    const auto levelOf = [&](double y) {
        return static_cast<int>(std::lround((y - static_cast<double>(frame.origin.y)) / frame.voxelSize));
    };
    const int first = std::max(0, levelOf(static_cast<double>(room.rest)));
    std::size_t column = 0;
    for (int z = 0; z < frame.dimensions.z; ++z)
        for (int x = 0; x < frame.dimensions.x; ++x) {
            const int top = tops[column++];
            if (top == kNothing) continue;
            const double share = kPlinth + (1.0 - kPlinth) * curve(top);
            const int end = levelOf(std::lerp(static_cast<double>(room.rest), static_cast<double>(room.top), share));
            for (int y = first; y < std::min(end, frame.dimensions.y); ++y) out.set(x, y, z);
        }
}

Placement reliefPlacement(const ReliefRoom& room, const TriangleMesh& mesh, int index) {
    constexpr auto kQuarter = static_cast<float>(0.5 * std::numbers::pi);
    const glm::vec3 right(1, 0, 0), up(0, 1, 0), front(0, 0, 1);
    // What is up: front, top, right, left, back, bottom.
    const std::array<glm::quat, 6> faces{glm::angleAxis(-kQuarter, right),
                                         glm::quat(1.0F, 0.0F, 0.0F, 0.0F),
                                         glm::angleAxis(-kQuarter, right) * glm::angleAxis(-kQuarter, up),
                                         glm::angleAxis(-kQuarter, right) * glm::angleAxis(kQuarter, up),
                                         glm::angleAxis(-kQuarter, right) * glm::angleAxis(2.0F * kQuarter, up),
                                         glm::angleAxis(2.0F * kQuarter, front)};
    Placement placement;
    placement.relief = true;
    placement.orientation = glm::normalize(glm::angleAxis(kQuarter * static_cast<float>(index / 6), up) *
                                           faces[static_cast<std::size_t>(index % 6)]);
    Box turned;
    for (const glm::vec3& p : mesh.positions) turned.include(placement.orientation * p);
    const glm::vec3 size = turned.size();
    if (!(std::max({size.x, size.y, size.z}) > 0.0F) || !std::isfinite(size.x + size.y + size.z))
        throw InvalidInput("target", "it has no extent", "give a mesh with a volume");
    const glm::vec3 share = room.reach.size() / glm::max(size, glm::vec3(1e-12F));
    const float scale = std::min(share.x, share.z);
    placement.scale = static_cast<double>(scale);
    // As high as the device rises, so that light, which shows it as it is, falls near where it belongs.
    placement.translation = glm::vec3(room.reach.centre().x, room.top, room.reach.centre().z) -
                            scale * glm::vec3(turned.centre().x, turned.max.y, turned.centre().z);
    return placement;
}

} // namespace lumorph
