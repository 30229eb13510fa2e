#include "core/loop/pose_stream.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/loop/pose_filter.h"

namespace lumorph {

glm::dmat4 matrixOf(const Pose& pose) {
    glm::dmat4 matrix = glm::mat4_cast(pose.rotation);
    matrix[3] = glm::dvec4(pose.position, 1.0);
    return matrix;
}

Pose operator*(const Pose& aFromB, const Pose& bFromC) {
    return {aFromB * bFromC.position, glm::normalize(aFromB.rotation * bFromC.rotation)};
}

glm::dvec3 operator*(const Pose& aFromB, const glm::dvec3& inB) { return aFromB.rotation * inB + aFromB.position; }

Pose inverseOf(const Pose& pose) {
    const glm::dquat back = glm::conjugate(pose.rotation);
    return {-(back * pose.position), back};
}

namespace {

constexpr double kFarthest = 1000.0; // metres; what lies beyond is no room
constexpr double kBehind = -0.05;    // seconds

double inSeconds(Microseconds time) { return 1e-6 * static_cast<double>(time.count()); }

bool isSound(const PoseSample& sample) {
    if (!sample.valid) return true;
    const glm::dvec3 p = glm::abs(sample.pose.position);
    const double length = glm::length(sample.pose.rotation);
    return p.x <= kFarthest && p.y <= kFarthest && p.z <= kFarthest && length > 0.1 && length < 10.0;
}

} // namespace

struct PoseStream::Filter {
    std::optional<PoseSample> newest;
    bool tracked = false; ///< the newest sample is valid
    bool found = false;   ///< there was a valid one
    Microseconds measured{0};
    PoseFilter poses;
};

PoseStream::PoseStream(Microseconds staleAfter) : staleAfter_(staleAfter), filter_(std::make_shared<Filter>()) {}

bool PoseStream::push(const PoseSample& sample) {
    const std::scoped_lock lock(mutex_);
    if (!isSound(sample)) return false;
    if (filter_->newest && sample.time <= filter_->newest->time) return false;
    take(sample);
    return true;
}

bool PoseStream::restart(const PoseSample& sample) {
    const std::scoped_lock lock(mutex_);
    if (!isSound(sample)) return false;
    filter_->found = false;
    take(sample);
    return true;
}

void PoseStream::take(const PoseSample& sample) {
    Filter& filter = *filter_;
    filter.newest = sample;
    filter.tracked = sample.valid;
    if (!sample.valid) return;
    const Pose pose{sample.pose.position, glm::normalize(sample.pose.rotation)};
    const Microseconds gap = sample.time - filter.measured;
    if (filter.found && gap <= staleAfter_)
        filter.poses.add(pose, inSeconds(gap));
    else
        filter.poses.restart(pose);
    filter.found = true;
    filter.measured = sample.time;
}

bool PoseStream::isStale(Microseconds now) const {
    const std::scoped_lock lock(mutex_);
    return !filter_->found || now - filter_->measured > staleAfter_;
}

std::optional<PoseSample> PoseStream::latest() const {
    const std::scoped_lock lock(mutex_);
    return filter_->newest;
}

std::optional<Pose> PoseStream::at(Microseconds time, Microseconds now) const {
    const std::scoped_lock lock(mutex_);
    const Filter& filter = *filter_;
    if (!filter.tracked || now - filter.measured > staleAfter_) return std::nullopt;
    return filter.poses.at(std::clamp(inSeconds(time - filter.measured), kBehind, kFarthestAhead));
}

std::shared_ptr<PoseStream> PoseBoard::stream(const std::string& name, PoseRole role) {
    const std::scoped_lock lock(mutex_);
    const auto found = std::ranges::find(entries_, name, &Entry::name);
    if (found != entries_.end()) {
        found->role = role;
        return found->stream;
    }
    entries_.push_back({name, role, std::make_shared<PoseStream>()});
    return entries_.back().stream;
}

void PoseBoard::remove(const std::string& name) {
    const std::scoped_lock lock(mutex_);
    std::erase_if(entries_, [&](const Entry& entry) { return entry.name == name; });
}

std::vector<PoseBoard::Entry> PoseBoard::entries() const {
    const std::scoped_lock lock(mutex_);
    return entries_;
}

} // namespace lumorph
