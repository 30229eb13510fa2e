#include "calibration/servos/servo_judge.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "calibration/registration/refusing.h"

namespace lumorph::servos {

namespace {

using registration::number;

constexpr double kTooUnsure = 0.03; // strokes: what is less sure is no point of a curve
constexpr double kMoved = 0.06;     // strokes: less is no motion
constexpr double kFromTheEnd = 0.6; // real stroke at rest from which on a servo runs from the wrong end
constexpr double kStalled = 0.25;   // of the usual way a level: less is a stop
constexpr int kStalledLevels = 2;
constexpr double kFloor = 2e-4; // strokes: nobody is surer
constexpr double kBend = 0.006; // strokes: by how much a curve turns from one level to the next

/// Values at a command between those that were seen.
std::optional<double> at(const std::vector<LevelSeen>& seen, double commanded) {
    if (seen.empty()) return std::nullopt;
    const auto above = std::ranges::lower_bound(seen, commanded - 1e-9, {}, &LevelSeen::commanded);
    if (above == seen.end()) return seen.back().real;
    if (above == seen.begin() || std::abs(above->commanded - commanded) < 1e-9) return above->real;
    const LevelSeen &low = *(above - 1), &high = *above;
    return low.real + (high.real - low.real) * (commanded - low.commanded) / (high.commanded - low.commanded);
}

std::vector<LevelSeen> sure(const std::vector<LevelSeen>& seen) {
    std::vector<LevelSeen> kept;
    std::ranges::copy_if(seen, std::back_inserter(kept), [](const LevelSeen& s) { return s.sigma < kTooUnsure; });
    return kept;
}

/// Levels made as smooth as servos' curves are, as far as they are unsure: who is seen well stays where it is, who is
/// hidden takes what its neighbours say (Whittaker, "On a new method of graduation", 1923).
std::vector<LevelSeen> smoothed(std::vector<LevelSeen> seen) {
    const auto count = static_cast<Eigen::Index>(seen.size());
    if (count < 4) return seen;
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (Eigen::Index k = 0; k < count; ++k) {
        const LevelSeen& one = seen[static_cast<std::size_t>(k)];
        const double weight = 1.0 / (one.sigma * one.sigma + kFloor * kFloor);
        normal(k, k) += weight;
        right[k] += weight * one.real;
    }
    for (Eigen::Index k = 1; k + 1 < count; ++k) {
        const Eigen::Vector3d bend(1.0, -2.0, 1.0);
        normal.block<3, 3>(k - 1, k - 1) += bend * bend.transpose() / (kBend * kBend);
    }
    const Eigen::VectorXd smooth = normal.ldlt().solve(right);
    for (Eigen::Index k = 0; k < count; ++k) seen[static_cast<std::size_t>(k)].real = smooth[k];
    return seen;
}

std::string quoted(const Rig& rig, std::size_t actuator) { return "\"" + rig.actuators()[actuator].name + "\""; }

} // namespace

/// At rest a servo has come from above, at its end from below: how it would stand there after the other way follows
/// from its play.
void drawCurve(const BothWays& seen, ServoFinding& servo) {
    std::vector<LevelSeen> up = sure(seen.up), down = sure(seen.down);
    if (up.size() < 3 || down.size() < 3) return;
    // A stop is a corner that is meant.
    if (!servo.stopsAt) {
        up = smoothed(up);
        down = smoothed(down);
    }
    std::vector<double> plays;
    for (const LevelSeen& one : up) {
        const bool inside = one.commanded > 1e-6 && one.commanded < 1.0 - 1e-6;
        // Against a stop both ways meet, and that says nothing of the gears.
        const bool free = one.real > 0.02 && (!servo.stopsAt || one.commanded < *servo.stopsAt - 1e-6);
        if (inside && free) plays.push_back(at(down, one.commanded).value() - one.real);
    }
    double mean = 0.0, squares = 0.0;
    for (const double play : plays) mean += play / static_cast<double>(plays.size());
    for (const double play : plays) squares += (play - mean) * (play - mean);
    const auto count = static_cast<double>(plays.size());
    mean = std::max(0.0, mean);
    servo.backlashDegrees = servo.degrees * mean;
    servo.backlashSigma = count > 1.0 ? servo.degrees * std::sqrt(squares / (count - 1.0) / count) : servo.degrees;
    std::vector<double> sigmas;
    for (const LevelSeen& level : seen.up) {
        const double u = level.commanded;
        MeasuredServo::Point point{u, at(up, u).value(), at(down, u).value()};
        if (u < 1e-6) point.rising = point.falling - mean; // below rest, where the stop holds it
        if (u > 1.0 - 1e-6) point.falling = point.rising + mean;
        servo.curve.points.push_back(point);
        sigmas.push_back(level.sigma);
    }
    std::ranges::nth_element(sigmas, sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2));
    servo.curveSigma = servo.degrees * sigmas[sigmas.size() / 2];
}

std::optional<double> stopOf(const BothWays& seen) {
    const std::vector<LevelSeen> up = sure(seen.up);
    if (up.size() < 4 || up.back().real > 0.93) return std::nullopt;
    std::size_t last = up.size() - 1;
    while (last > 0) {
        const double usual = up[last].commanded - up[last - 1].commanded;
        if (up[last].real - up[last - 1].real > kStalled * usual) break;
        --last;
    }
    if (up.size() - 1 - last < kStalledLevels) return std::nullopt;
    return up[last].commanded;
}

bool judgeWiring(const Rig& rig, const std::vector<Mover>& movers, const StrokeEstimate& rest,
                 std::vector<Finding>& findings) {
    const std::size_t before = findings.size();
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const std::string name = rig.actuators()[i].name;
        if (std::abs(movers[i].by) < kMoved) {
            findings.push_back({Cause::servoDead, name, "", "servo " + quoted(rig, i) + " does not move",
                                "look at its plug, its power and its channel, then measure again"});
        } else if (movers[i].part != i) {
            findings.push_back({Cause::servoSwapped, name, "",
                                "servo " + quoted(rig, i) + " moves the part of " + quoted(rig, movers[i].part),
                                "exchange their plugs, or their channels in the Devices workspace"});
        } else if (movers[i].by < 0.0 || rest.strokes[i] > kFromTheEnd) {
            findings.push_back({Cause::servoReversed, name, "",
                                "servo " + quoted(rig, i) + " runs from the end of its range to its rest",
                                "exchange its pulses at rest and at full stroke in the Devices workspace"});
        }
    }
    return findings.size() == before;
}

Finding jammedFinding(const Rig& rig, std::size_t actuator, double commanded, double real, double degrees) {
    return {Cause::servoJammed, rig.actuators()[actuator].name, "",
            "servo " + quoted(rig, actuator) + " stops at " + number(degrees * real, 0) + " of " + number(degrees, 0) +
                " degrees, from " + number(100.0 * commanded, 0) + " % of its command on",
            "free what it meets, or limit its range, then measure again"};
}

} // namespace lumorph::servos
