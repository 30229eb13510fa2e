#include "app/applications/ice/bending.h"

#include <algorithm>
#include <cmath>

#include "core/motion/surface_heights.h"

namespace lumorph::ice {
namespace {

constexpr int kSamplesX = 36, kSamplesZ = 26;
constexpr double kSmallStroke = 0.25; ///< flaps turn: more of a stroke lifts them less
constexpr double kBendArm = 0.014;    ///< over which bends are measured, metres

std::vector<float> heightsOf(const Rig& rig, std::span<const double> strokes, std::span<const glm::vec2> places) {
    std::vector<float> heights(places.size(), NAN);
    heightsOfMesh(deformed(rig, strokes), places, heights);
    return heights;
}

} // namespace

Bending::Bending(const Rig& rig) {
    const Box box = boundingBox(rig.restMesh().positions);
    now_ = {{box.min.x, box.min.z}, {box.max.x, box.max.z}, kSamplesX, kSamplesZ, {}};
    std::vector<glm::vec2> places;
    for (int j = 0; j < kSamplesZ; ++j)
        for (int i = 0; i < kSamplesX; ++i)
            places.emplace_back(std::lerp(now_.min.x, now_.max.x, static_cast<double>(i) / (kSamplesX - 1)),
                                std::lerp(now_.min.y, now_.max.y, static_cast<double>(j) / (kSamplesZ - 1)));
    now_.heights.assign(places.size(), 0.0F);
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    const std::vector<float> rest = heightsOf(rig, strokes, places);
    for (double& stroke : strokes) {
        stroke = kSmallStroke;
        std::vector<float> rise = heightsOf(rig, strokes, places);
        stroke = 0.0;
        for (std::size_t k = 0; k < rise.size(); ++k) {
            rise[k] = (rise[k] - rest[k]) / static_cast<float>(kSmallStroke);
            if (!std::isfinite(rise[k])) rise[k] = 0.0F;
        }
        rises_.push_back(std::move(rise));
    }
    set(std::vector(rig.actuatorCount(), 1.0));
    room_ = now_;
    const float most = std::max(1e-6F, std::ranges::max(room_.heights));
    for (float& room : room_.heights) room = std::max(0.0F, room / most);
    std::ranges::fill(now_.heights, 0.0F);
}

void Bending::set(std::span<const double> strokes) {
    std::ranges::fill(now_.heights, 0.0F);
    if (strokes.size() != rises_.size()) return;
    for (std::size_t actuator = 0; actuator < rises_.size(); ++actuator) {
        if (!std::isfinite(strokes[actuator]) || strokes[actuator] == 0.0) continue;
        const auto stroke = static_cast<float>(std::clamp(strokes[actuator], 0.0, 1.0));
        for (std::size_t k = 0; k < now_.heights.size(); ++k) now_.heights[k] += stroke * rises_[actuator][k];
    }
}

double Bending::heightAt(const glm::dvec2& place) const noexcept {
    const double height = lumorph::heightAt(now_, place);
    return std::isfinite(height) ? height : 0.0;
}

double Bending::roomAt(const glm::dvec2& place) const noexcept {
    const double room = lumorph::heightAt(room_, place);
    return std::isfinite(room) ? room : 0.0;
}

double Bending::curvatureAt(const glm::dvec2& place, const glm::dvec2& direction) const noexcept {
    const glm::dvec2 arm = kBendArm * direction;
    return (heightAt(place - arm) + heightAt(place + arm) - 2.0 * heightAt(place)) / (kBendArm * kBendArm);
}

} // namespace lumorph::ice
