#include "core/motion/stroke_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace lumorph {

namespace {

constexpr double kLiftNoise = 1e-7; // metres; less is rounding
constexpr int kMostRounds = 60;
constexpr double kSmallestGain = 1e-5; // strokes

/// Triangles that an actuator moves, or those that it leaves alone and that reach over a box in x and z.
std::vector<glm::uvec3> trianglesOf(const Rig& rig, const std::vector<bool>& moved, bool wanted, const Box& box) {
    const std::vector<glm::vec3>& positions = rig.restMesh().positions;
    std::vector<glm::uvec3> triangles;
    for (const glm::uvec3& t : rig.restMesh().triangles) {
        if ((moved[t.x] || moved[t.y] || moved[t.z]) != wanted) continue;
        const glm::vec3 low = glm::min(positions[t.x], glm::min(positions[t.y], positions[t.z]));
        const glm::vec3 high = glm::max(positions[t.x], glm::max(positions[t.y], positions[t.z]));
        if (wanted || (low.x <= box.max.x && high.x >= box.min.x && low.z <= box.max.z && high.z >= box.min.z))
            triangles.push_back(t);
    }
    return triangles;
}

/// An actuator's vertices, and the box over all that they pass.
struct Part {
    std::vector<bool> moved;
    Box box;
};

Part partOf(const Rig& rig, std::size_t actuator) {
    Part part;
    part.moved.assign(rig.restMesh().positions.size(), false);
    for (const std::uint32_t v : rig.verticesOf(actuator)) {
        part.moved[v] = true;
        part.box.include(rig.reachOf(v));
    }
    // Triangles at its border reach from its vertices to unmoved ones.
    for (const glm::uvec3& t : rig.restMesh().triangles)
        if (part.moved[t.x] || part.moved[t.y] || part.moved[t.z])
            for (int k = 0; k < 3; ++k) part.box.include(rig.restMesh().positions[t[k]]);
    return part;
}

} // namespace

TopSurface::TopSurface(const Rig& rig, std::span<const glm::vec2> points) : rig_(rig) {
    const float nothing = std::numeric_limits<float>::quiet_NaN();
    floor_ = boundingBox(rig.restMesh().positions).min.y;
    std::vector<float> heights(points.size(), nothing);
    heightsOfMesh(rig.restMesh(), points, heights);
    for (std::size_t k = 0; k < points.size(); ++k)
        if (!std::isnan(heights[k])) {
            points_.push_back(points[k]);
            rest_.push_back(heights[k]);
        }
}

void TopSurface::heights(std::span<const double> strokes, std::span<float> out) const {
    std::ranges::fill(out, floor_);
    heightsOfMesh(deformed(rig_, strokes), points_, out);
}

StrokeFit::StrokeFit(const TopSurface& surface) {
    for (std::size_t i = 0; i < surface.rig().actuatorCount(); ++i) responses_.push_back(responseOf(surface, i));
}

StrokeFit::Response StrokeFit::responseOf(const TopSurface& surface, std::size_t actuator) {
    const Rig& rig = surface.rig();
    const Part part = partOf(rig, actuator);
    std::vector<std::uint32_t> near;
    std::vector<glm::vec2> places;
    for (std::uint32_t k = 0; k < surface.points().size(); ++k) {
        const glm::vec2& p = surface.points()[k];
        if (p.x < part.box.min.x || p.x > part.box.max.x || p.y < part.box.min.z || p.y > part.box.max.z) continue;
        near.push_back(k);
        places.push_back(p);
    }
    SurfaceHeights heights(places);
    std::vector<float> unmoved(places.size(), surface.floor());
    heights.read(rig.restMesh().positions, trianglesOf(rig, part.moved, false, part.box), unmoved);
    const std::vector<glm::uvec3> moving = trianglesOf(rig, part.moved, true, part.box);

    std::vector<float> now(places.size());
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    std::vector<glm::vec3> positions = rig.restMesh().positions;
    std::vector<glm::vec3> moved(rig.verticesOf(actuator).size());
    std::vector<double> curve;
    for (int step = 0; step <= kSteps; ++step) {
        strokes[actuator] = static_cast<double>(step) / kSteps;
        rig.deform(strokes, rig.verticesOf(actuator), moved);
        for (std::size_t k = 0; k < moved.size(); ++k) positions[rig.verticesOf(actuator)[k]] = moved[k];
        std::ranges::fill(now, std::numeric_limits<float>::lowest());
        heights.read(positions, moving, now);
        for (std::size_t k = 0; k < now.size(); ++k) {
            const double lift =
                static_cast<double>(std::max(now[k], unmoved[k])) - static_cast<double>(surface.restHeights()[near[k]]);
            curve.push_back(step == 0 ? 0.0 : lift);
        }
    }
    Response response;
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < near.size(); ++k) {
        double most = 0.0;
        for (std::size_t at = k; at < curve.size(); at += near.size()) most = std::max(most, std::abs(curve[at]));
        if (most > kLiftNoise) kept.push_back(k);
    }
    for (const std::size_t k : kept) response.points.push_back(near[k]);
    for (std::size_t row = 0; row < curve.size(); row += near.size())
        for (const std::size_t k : kept) response.curve.push_back(curve[row + k]);
    return response;
}

void StrokeFit::addLift(const Response& response, double stroke, double factor, std::span<double> lifts) {
    const double at = std::clamp(stroke, 0.0, 1.0) * kSteps;
    const int step = std::min(static_cast<int>(at), kSteps - 1);
    const double share = at - step;
    const std::size_t count = response.points.size();
    const double* low = response.curve.data() + static_cast<std::size_t>(step) * count;
    const double* high = low + count;
    for (std::size_t p = 0; p < count; ++p) lifts[response.points[p]] += factor * (low[p] + share * (high[p] - low[p]));
}

double StrokeFit::best(const Response& response, std::span<const double> wanted) {
    const std::size_t count = response.points.size();
    double best = 0.0;
    double least = std::numeric_limits<double>::max();
    for (int step = 0; step < kSteps; ++step) {
        const double* low = response.curve.data() + static_cast<std::size_t>(step) * count;
        const double* high = low + count;
        double error = 0.0; // squared, at the low end
        double slope = 0.0;
        double bend = 0.0;
        for (std::size_t p = 0; p < count; ++p) {
            const double left = wanted[response.points[p]] - low[p];
            const double way = high[p] - low[p];
            error += left * left;
            slope += left * way;
            bend += way * way;
        }
        const double share = bend > 0.0 ? std::clamp(slope / bend, 0.0, 1.0) : 0.0;
        error += share * (share * bend - 2.0 * slope);
        if (error >= least) continue;
        least = error;
        best = (step + share) / kSteps;
    }
    return best;
}

void StrokeFit::improve(std::span<const double> lifts, std::span<double> strokes) const {
    std::vector<double> left(lifts.begin(), lifts.end());
    for (std::size_t i = 0; i < responses_.size(); ++i) addLift(responses_[i], strokes[i], -1.0, left);
    double gain = 1.0;
    for (int round = 0; round < kMostRounds && gain > kSmallestGain; ++round) {
        gain = 0.0;
        for (std::size_t i = 0; i < responses_.size(); ++i) {
            if (responses_[i].points.empty()) continue;
            addLift(responses_[i], strokes[i], 1.0, left);
            const double found = best(responses_[i], left);
            addLift(responses_[i], found, -1.0, left);
            gain = std::max(gain, std::abs(found - strokes[i]));
            strokes[i] = found;
        }
    }
}

void StrokeFit::lifts(std::span<const double> strokes, std::span<double> out) const {
    std::ranges::fill(out, 0.0);
    for (std::size_t i = 0; i < responses_.size(); ++i) addLift(responses_[i], strokes[i], 1.0, out);
}

} // namespace lumorph
