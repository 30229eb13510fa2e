#include "core/loop/viewer_choice.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace lumorph {

namespace {

constexpr double kGlideSeconds = 0.4;
constexpr double kClearlyNearer = 0.8; ///< of the followed one's distance
constexpr double kRivalSeconds = 0.5;  ///< for which a rival has to stay clearly nearer

bool isFinite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

const TrackedHead* named(std::span<const TrackedHead> heads, const std::string& name) {
    const auto found = std::ranges::find(heads, name, &TrackedHead::name);
    return found == heads.end() ? nullptr : &*found;
}

const TrackedHead& nearestOf(std::span<const TrackedHead> heads, const glm::dvec3& centre) {
    return *std::ranges::min_element(heads, {}, [&](const TrackedHead& h) { return glm::distance(h.eye, centre); });
}

} // namespace

std::optional<ViewerDirector::View> ViewerDirector::step(std::span<const TrackedHead> heads, const glm::dvec3& centre,
                                                         ViewerChoice choice, double sinceLast) {
    std::vector<TrackedHead> present;
    std::ranges::copy_if(heads, std::back_inserter(present), [](const TrackedHead& h) { return isFinite(h.eye); });
    if (present.empty() || choice == ViewerChoice::none) {
        *this = {};
        return std::nullopt;
    }
    const double seconds = std::isfinite(sinceLast) ? std::max(sinceLast, 0.0) : 0.0;
    const TrackedHead& head = chosen(present, centre, choice, seconds);
    if (last_ && head.name != followed_) {
        from_ = last_->eye;
        glide_ = 0.0;
    }
    followed_ = head.name;
    last_ = glided(head, seconds);
    return last_;
}

const TrackedHead& ViewerDirector::chosen(std::span<const TrackedHead> heads, const glm::dvec3& centre,
                                          ViewerChoice choice, double seconds) {
    if (choice == ViewerChoice::first) return heads.front();
    const TrackedHead& nearest = nearestOf(heads, centre);
    const TrackedHead* followed = named(heads, followed_);
    if (choice == ViewerChoice::nearest || !followed) return nearest;
    if (glm::distance(nearest.eye, centre) > kClearlyNearer * glm::distance(followed->eye, centre)) {
        rival_.clear();
        return *followed;
    }
    rivalSeconds_ = nearest.name == rival_ ? rivalSeconds_ + seconds : 0.0;
    rival_ = nearest.name;
    if (rivalSeconds_ < kRivalSeconds) return *followed;
    rival_.clear();
    return nearest;
}

ViewerDirector::View ViewerDirector::glided(const TrackedHead& head, double seconds) {
    if (!from_) return {head.name, head.eye, false};
    glide_ += seconds / kGlideSeconds;
    if (glide_ >= 1.0) {
        from_.reset();
        return {head.name, head.eye, false};
    }
    return {head.name, glm::mix(*from_, head.eye, glide_ * glide_ * (3.0 - 2.0 * glide_)), true};
}

} // namespace lumorph
