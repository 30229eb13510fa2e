#include "calibration/registration/touch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "calibration/registration/refusing.h"
#include "core/base/statistics.h"

namespace lumorph {

namespace {

using registration::number;

constexpr std::size_t kFewestMoments = 15;
constexpr double kStraysFrom = 3.0; ///< times the usual distance from the middle
constexpr double kSlides = 0.8;     ///< of the distance that a tip at rest may be from its middle

/// Pointer and body at the same moments.
struct Moment {
    Pose pointer; ///< in the body's frame
    Pose body;
};

std::vector<Moment> momentsOf(const PoseTrack& pointer, const std::optional<PoseTrack>& body) {
    std::vector<Moment> moments;
    for (const TimedPose& at : pointer.poses) {
        if (!body)
            moments.push_back({at.pose, {}});
        else if (const auto held = poseAt(*body, at.seconds))
            moments.push_back({inverseOf(*held) * at.pose, *held});
    }
    return moments;
}

glm::dvec3 middleOfTips(const std::vector<Moment>& moments, const glm::dvec3& tip) {
    glm::dvec3 middle;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        values.reserve(moments.size());
        for (const Moment& m : moments) values.push_back((m.pointer * tip)[axis]);
        middle[axis] = median(std::move(values));
    }
    return middle;
}

/// How far the tip is in the last third of a touch from where it was in the first, metres.
double slideOf(const std::vector<Moment>& moments, const glm::dvec3& tip) {
    const auto third = static_cast<std::ptrdiff_t>(moments.size() / 3);
    return glm::distance(middleOfTips({moments.begin(), moments.begin() + third}, tip),
                         middleOfTips({moments.end() - third, moments.end()}, tip));
}

void checkMoments(std::size_t shared, const PoseTrack& pointer, const std::string& name) {
    if (pointer.poses.size() < kFewestMoments)
        registration::refuse(Cause::trackerLost, name.c_str(),
                             "the tracker saw the pointer in " + std::to_string(pointer.poses.size()) + " poses only",
                             "hold it in sight of the tracker for a second");
    if (shared < kFewestMoments)
        registration::refuse(Cause::clockJumps, name.c_str(),
                             "pointer and body share " + std::to_string(shared) + " moments only",
                             "record both at the same time and by one clock");
}

} // namespace

Pose meanPose(std::span<const Pose> poses) {
    glm::dvec3 place(0.0);
    glm::dquat sum(0.0, 0.0, 0.0, 0.0);
    for (const Pose& pose : poses) {
        place += pose.position;
        sum = sum + (glm::dot(pose.rotation, poses.front().rotation) < 0.0 ? -pose.rotation : pose.rotation);
    }
    return {place / double(std::max<std::size_t>(1, poses.size())), glm::normalize(sum)};
}

Rest restOf(const Touch& touch, const glm::dvec3& tip, double wander) {
    const PoseTrack pointer = soundTrack(touch.pointer, touch.name + ": pointer");
    std::optional<PoseTrack> body;
    if (touch.body) body = soundTrack(*touch.body, touch.name + ": body");
    std::vector<Moment> moments = momentsOf(pointer, body);
    checkMoments(moments.size(), pointer, touch.name);

    const glm::dvec3 middle = middleOfTips(moments, tip);
    const auto from = [&](const Moment& m) { return glm::distance(m.pointer * tip, middle); };
    std::vector<double> away;
    away.reserve(moments.size());
    for (const Moment& m : moments) away.push_back(from(m));
    const double usual = median(away);
    if (usual > wander)
        registration::refuse(Cause::tipSlipped, touch.name.c_str(),
                             "the tip moved by " + number(1000.0 * usual, 1) + " mm",
                             "hold it still on its point for a second");
    Rest rest;
    if (const double slide = slideOf(moments, tip); slide > kSlides * wander)
        rest.warnings.push_back({Cause::tipSlipped,
                                 touch.name,
                                 {},
                                 "the tip slid by " + number(1000.0 * slide, 1) + " mm while it was held",
                                 "the middle of it counts; hold it still, and fix what it touches"});
    std::erase_if(moments, [&](const Moment& m) { return from(m) > kStraysFrom * usual; });
    std::vector<Pose> pointers, bodies;
    glm::dvec3 place(0.0);
    for (const Moment& m : moments) {
        pointers.push_back(m.pointer);
        bodies.push_back(m.body);
        place += m.pointer * tip / double(moments.size());
        rest.rms += from(m) * from(m) / double(moments.size());
    }
    rest.rms = std::sqrt(rest.rms);
    rest.poses = moments.size();
    rest.body = meanPose(bodies);
    rest.pointer.rotation = meanPose(pointers).rotation;
    rest.pointer.position = place - rest.pointer.rotation * tip;
    rest.warnings.insert(rest.warnings.end(), pointer.warnings.begin(), pointer.warnings.end());
    if (body) rest.warnings.insert(rest.warnings.end(), body->warnings.begin(), body->warnings.end());
    return rest;
}

double noiseOf(const Rest& rest) {
    constexpr double kAlike = 5.0, kAxes = 3.0;
    return rest.rms * std::sqrt(kAlike / (kAxes * double(std::max<std::size_t>(1, rest.poses))));
}

Touch withoutFault(const Touch& touch, const CaptureFault* fault) {
    if (!fault) return touch;
    Touch right{touch.name, withoutFault(touch.pointer, *fault), std::nullopt};
    if (touch.body) right.body = withoutFault(*touch.body, *fault);
    if (right.body && fault->exchanged) std::swap(right.pointer, *right.body);
    return right;
}

glm::dvec3 withoutFault(const glm::dvec3& tip, const CaptureFault* fault) { return fault ? fault->point(tip) : tip; }

} // namespace lumorph
