#include "app/table/table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/quaternion.hpp>

namespace lumorph::table {

namespace {

constexpr double kReach = 0.6; // seconds of a hand from one place to the next

double secondsBetween(Microseconds from, Microseconds to) { return 1e-6 * static_cast<double>((to - from).count()); }

Pose poseOf(const glm::dmat4& matrix) {
    return {glm::dvec3(matrix[3]), glm::normalize(glm::quat_cast(glm::dmat3(matrix)))};
}

/// Turns that differ as much as a wrist can.
glm::dquat wristTurn(int turn) {
    const double k = turn;
    return glm::angleAxis(0.5 * std::sin(2.4 * k), glm::dvec3(1.0, 0.0, 0.0)) *
           glm::angleAxis(0.7 * std::sin(1.3 * k + 0.5), glm::dvec3(0.0, 1.0, 0.0)) *
           glm::angleAxis(0.5 * std::cos(1.9 * k), glm::dvec3(0.0, 0.0, 1.0));
}

/// `share` of the swing, so that it begins without a jump.
glm::dquat swingTurn(double t, double share) {
    const glm::dvec3 turn =
        share * glm::dvec3(0.7 * std::sin(2.1 * t), 0.9 * std::sin(0.9 * t), 0.7 * std::cos(1.7 * t));
    const double angle = glm::length(turn);
    return angle > 0.0 ? glm::angleAxis(angle, turn / angle) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

} // namespace

Table::Table(TableTruth truth) : truth_(std::move(truth)) {
    const Pose lies = poseOf(glm::dmat4(truth_.room.worldFromDevice));
    ways_[static_cast<std::size_t>(TableBody::device)] = Way{lies, lies, clock_.now(), 0.0, false};
    standing_.strokes.assign(truth_.rig->actuatorCount(), 0.0);
    look(glm::dvec3(truth_.room.eye), 0);
}

/// Of a pointer, the place of its tip; else the body's own.
Pose Table::along(const Way& way, Microseconds time) const {
    const double t = std::max(0.0, secondsBetween(way.begins, time));
    const double share = way.seconds > 0.0 ? std::clamp(t / way.seconds, 0.0, 1.0) : 1.0;
    const double eased = share * share * (3.0 - 2.0 * share);
    Pose pose{glm::mix(way.from.position, way.to.position, eased),
              glm::slerp(way.from.rotation, way.to.rotation, eased)};
    if (way.swings) pose.rotation = pose.rotation * swingTurn(t, eased);
    return pose;
}

Standing Table::at(Microseconds time) const {
    const std::scoped_lock lock(mutex_);
    Standing now = standing_;
    now.device = along(*ways_[static_cast<std::size_t>(TableBody::device)], time);
    return now;
}

std::optional<Pose> Table::body(TableBody body, Microseconds time) const {
    std::optional<Pose> place;
    {
        const std::scoped_lock lock(mutex_);
        const auto& way = ways_[static_cast<std::size_t>(body)];
        if (!way) return std::nullopt;
        place = along(*way, time);
    }
    const Installation& room = truth_.room;
    switch (body) {
    case TableBody::device:
        return *place * inverseOf(poseOf(glm::dmat4(room.bodyFromDevice)));
    case TableBody::pointer:
        place->position -= place->rotation * glm::dvec3(room.pointerTip);
        return place;
    case TableBody::head:
        place->position -= place->rotation * glm::dvec3(room.eyeFromHead);
        return place;
    }
    return std::nullopt;
}

void Table::go(TableBody body, const Pose& to, double seconds, bool swings) {
    const std::scoped_lock lock(mutex_);
    auto& way = ways_[static_cast<std::size_t>(body)];
    const Microseconds now = clock_.now();
    way = Way{way ? along(*way, now) : to, to, now, seconds, swings};
}

void Table::carry(const glm::dvec3& place, double turn, double seconds) {
    go(TableBody::device, {place, glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0))}, seconds);
}

void Table::touch(const glm::dvec3& place, int turn) { go(TableBody::pointer, {place, wristTurn(turn)}, kReach); }

void Table::swing(const glm::dvec3& place) {
    go(TableBody::pointer, {place, glm::dquat(1.0, 0.0, 0.0, 0.0)}, kReach, true);
}

void Table::look(const glm::dvec3& eye, int turn) { go(TableBody::head, {eye, wristTurn(turn)}, kReach); }

void Table::layBoard(const std::optional<glm::dmat4>& worldFromBoard) {
    const std::scoped_lock lock(mutex_);
    standing_.worldFromBoard = worldFromBoard;
}

void Table::holdHand(const std::optional<glm::dvec3>& place) {
    const std::scoped_lock lock(mutex_);
    standing_.hand = place;
}

void Table::cover(bool covered) {
    const std::scoped_lock lock(mutex_);
    standing_.isCovered = covered;
}

void Table::setStrokes(std::vector<double> strokes) {
    const std::scoped_lock lock(mutex_);
    standing_.strokes = std::move(strokes);
}

} // namespace lumorph::table
