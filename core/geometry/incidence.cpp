#include "core/geometry/incidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

constexpr int kSamples = 256;

using Corners = std::array<glm::dvec3, 3>; // in the projector's frame

// What a projector sees of a surface, on a grid over the plane at distance 1.
class SampleGrid {
public:
    SampleGrid(const glm::dvec2& low, const glm::dvec2& high)
        : low_(low), step_(std::max({(high.x - low.x) / kSamples, (high.y - low.y) / kSamples, 1e-12})),
          samples_(static_cast<std::size_t>(kSamples) * kSamples) {}

    void add(const Corners& corners) {
        std::array<glm::dvec2, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) at[i] = (glm::dvec2(corners[i]) / corners[i].z - low_) / step_;
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double offset = glm::dot(normal, corners[0]);
        const double length = glm::length(normal);
        if (!(length > 0.0)) return;
        const auto bound = [](double value) { return std::clamp(static_cast<int>(value), 0, kSamples - 1); };
        const glm::dvec2 least = glm::min(glm::min(at[0], at[1]), at[2]);
        const glm::dvec2 most = glm::max(glm::max(at[0], at[1]), at[2]);
        for (int y = bound(least.y - 0.5); y <= bound(most.y + 0.5); ++y)
            for (int x = bound(least.x - 0.5); x <= bound(most.x + 0.5); ++x)
                if (holds(at, glm::dvec2(x, y) + 0.5)) include(x, y, normal / length, offset / length);
    }

    [[nodiscard]] double shareBeyond(const CalibratedCamera& projector, double leastCosine) const {
        const glm::dmat4 worldFromCamera = glm::inverse(projector.cameraFromWorld);
        double all = 0.0;
        double beyond = 0.0;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const Sample& sample = samples_[i];
            if (!(sample.depth < std::numeric_limits<double>::infinity()) || sample.cosine <= 0.0) continue;
            const glm::dvec3 local =
                sample.depth * rayOf(static_cast<int>(i) % kSamples, static_cast<int>(i) / kSamples);
            const auto pixel = pixelOf(projector, glm::dvec3(worldFromCamera * glm::dvec4(local, 1.0)));
            if (!pixel || glm::any(glm::lessThan(*pixel, glm::dvec2(-0.5))) ||
                glm::any(glm::greaterThan(*pixel, glm::dvec2(projector.size) - 0.5)))
                continue;
            const double area = sample.depth * sample.depth / sample.cosine;
            all += area;
            if (sample.cosine < leastCosine) beyond += area;
        }
        return all > 0.0 ? beyond / all : 0.0;
    }

private:
    struct Sample {
        double depth = std::numeric_limits<double>::infinity();
        double cosine = 0.0; ///< of the incidence
    };

    [[nodiscard]] glm::dvec3 rayOf(int x, int y) const { return {low_ + step_ * (glm::dvec2(x, y) + 0.5), 1.0}; }

    static bool holds(const std::array<glm::dvec2, 3>& at, const glm::dvec2& point) {
        bool left = false;
        bool right = false;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec2 edge = at[(i + 1) % 3] - at[i];
            const glm::dvec2 way = point - at[i];
            const double side = edge.x * way.y - edge.y * way.x;
            left = left || side > 0.0;
            right = right || side < 0.0;
        }
        return !(left && right);
    }

    void include(int x, int y, const glm::dvec3& normal, double offset) {
        const glm::dvec3 ray = rayOf(x, y);
        const double facing = glm::dot(normal, ray);
        const double depth = offset / facing;
        Sample& sample = samples_[static_cast<std::size_t>(y) * kSamples + static_cast<std::size_t>(x)];
        if (!(depth > 0.0) || !(depth < sample.depth)) return;
        sample = {depth, -facing / glm::length(ray)};
    }

    glm::dvec2 low_;
    double step_;
    std::vector<Sample> samples_;
};

} // namespace

double shareBeyondIncidence(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                            const glm::mat4& worldFromMesh, const CalibratedCamera& projector, Angle limit) {
    const glm::dmat4 cameraFromMesh = projector.cameraFromWorld * glm::dmat4(worldFromMesh);
    std::vector<glm::dvec3> local;
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    for (const glm::vec3& position : positions) {
        const glm::dvec3& at = local.emplace_back(cameraFromMesh * glm::dvec4(position, 1.0));
        if (!(at.z > 1e-6)) continue;
        low = glm::min(low, glm::dvec2(at) / at.z);
        high = glm::max(high, glm::dvec2(at) / at.z);
    }
    if (!(low.x < high.x)) return 0.0;
    SampleGrid grid(low, high);
    for (const glm::uvec3& triangle : triangles) {
        const Corners corners{local[triangle.x], local[triangle.y], local[triangle.z]};
        if (std::all_of(corners.begin(), corners.end(), [](const glm::dvec3& at) { return at.z > 1e-6; }))
            grid.add(corners);
    }
    return grid.shareBeyond(projector, std::cos(limit.inRadians()));
}

} // namespace lumorph
