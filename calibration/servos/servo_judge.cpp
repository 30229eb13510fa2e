#include "calibration/servos/servo_judge.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "calibration/registration/refusing.h"

namespace lumorph::servos {

namespace {

using registration::number;

constexpr double kTooUnsure = 0.03; // strokes: what is less sure is no point of a curve
constexpr double kMoved = 0.06;     // strokes: less is no motion
constexpr double kFromTheEnd = 0.6; // real stroke at rest from which on a servo runs from the wrong end
constexpr double kStalled = 0.25;   // of the usual way a level: less is a stop
constexpr int kStalledLevels = 2;
constexpr double kFloor = 2e-4;      // strokes: nobody is surer
constexpr double kOffTheStop = 0.02; // strokes: at rest both ways meet, and that says nothing of the gears

std::vector<LevelSeen> sure(const std::vector<LevelSeen>& seen) {
    std::vector<LevelSeen> kept;
    std::ranges::copy_if(seen, std::back_inserter(kept), [](const LevelSeen& s) { return s.sigma < kTooUnsure; });
    return kept;
}

/// Both ways at the same levels. Who was not seen there, or came from the other side, has no weight.
struct Ladder {
    std::vector<double> commanded;
    Eigen::VectorXd up, down, upWeight, downWeight;
};

double weightOf(const LevelSeen& seen) { return 1.0 / (seen.sigma * seen.sigma + kFloor * kFloor); }

/// At rest a servo has come from above, and at its end from below.
Ladder ladderOf(const BothWays& seen) {
    Ladder ladder;
    for (const auto* way : {&seen.up, &seen.down})
        for (const LevelSeen& one : *way) ladder.commanded.push_back(one.commanded);
    std::ranges::sort(ladder.commanded);
    const auto same = [](double a, double b) { return b - a < 1e-9; };
    ladder.commanded.erase(std::unique(ladder.commanded.begin(), ladder.commanded.end(), same), ladder.commanded.end());
    const auto count = static_cast<Eigen::Index>(ladder.commanded.size());
    ladder.up = ladder.down = ladder.upWeight = ladder.downWeight = Eigen::VectorXd::Zero(count);
    const auto fill = [&](const std::vector<LevelSeen>& way, Eigen::VectorXd& real, Eigen::VectorXd& weight) {
        for (const LevelSeen& one : way) {
            const auto at = std::ranges::lower_bound(ladder.commanded, one.commanded - 1e-9);
            const auto k = static_cast<Eigen::Index>(at - ladder.commanded.begin());
            real[k] = one.real;
            weight[k] = weightOf(one);
        }
    };
    fill(seen.up, ladder.up, ladder.upWeight);
    fill(seen.down, ladder.down, ladder.downWeight);
    ladder.upWeight[0] = 0.0;
    ladder.downWeight[count - 1] = 0.0;
    return ladder;
}

/// How a curve may turn from one level to the next, and how play may change, strokes: where a step is a sixteenth of
/// the range. Over longer steps a curve turns more, by their square, and play changes more.
struct Stiffness {
    double bend = 0.006;
    double play = 0.001;

    [[nodiscard]] Stiffness over(double step) const {
        const double longer = 16.0 * step;
        return {bend * longer * longer, play * longer};
    }
};
/// A stop is a corner that is meant, and against it both ways meet.
constexpr Stiffness kWithStop{0.05, 0.05};

/// Levels made as smooth as servos' curves are, as far as they are unsure: who is seen well stays where it is, who is
/// hidden takes what its neighbours and the other way say (Whittaker, "On a new method of graduation", 1923).
void smooth(Ladder& ladder, const Stiffness& stiffness) {
    const auto count = static_cast<Eigen::Index>(ladder.commanded.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(2 * count, 2 * count);
    Eigen::VectorXd right(2 * count);
    normal.diagonal() << ladder.upWeight, ladder.downWeight;
    right << ladder.upWeight.cwiseProduct(ladder.up), ladder.downWeight.cwiseProduct(ladder.down);
    Eigen::VectorXd row(2 * count);
    const auto add = [&](double sigma) { normal += row * row.transpose() / (sigma * sigma); };
    for (Eigen::Index way = 0; way < 2; ++way)
        for (Eigen::Index k = 1; k + 1 < count; ++k) {
            row.setZero();
            row.segment<3>(way * count + k - 1) << 1.0, -2.0, 1.0;
            add(stiffness.bend);
        }
    for (Eigen::Index k = 1; k < count; ++k) {
        row.setZero();
        row.segment<2>(k - 1) << 1.0, -1.0;
        row.segment<2>(count + k - 1) << -1.0, 1.0;
        add(stiffness.play);
    }
    const Eigen::VectorXd found = normal.ldlt().solve(right);
    ladder.up = found.head(count);
    ladder.down = found.tail(count);
}

/// Mean play of the levels at which both ways were seen and nothing stops the servo, and how sure that is.
void measurePlay(const Ladder& ladder, ServoFinding& servo) {
    double sum = 0.0, weights = 0.0, squares = 0.0;
    int count = 0;
    const auto eachPlay = [&](const auto& use) {
        for (Eigen::Index k = 0; k < ladder.up.size(); ++k) {
            const double commanded = ladder.commanded[static_cast<std::size_t>(k)];
            if (servo.stopsAt && commanded > *servo.stopsAt - 1e-6) continue;
            if (ladder.upWeight[k] <= 0.0 || ladder.downWeight[k] <= 0.0 || ladder.up[k] < kOffTheStop) continue;
            use(ladder.down[k] - ladder.up[k], 1.0 / (1.0 / ladder.upWeight[k] + 1.0 / ladder.downWeight[k]));
        }
    };
    eachPlay([&](double play, double weight) {
        sum += weight * play;
        weights += weight;
        ++count;
    });
    if (count < 2) return;
    const double mean = sum / weights;
    eachPlay([&](double play, double weight) { squares += weight * (play - mean) * (play - mean); });
    servo.backlashDegrees = servo.degrees * std::max(0.0, mean);
    servo.backlashSigma = servo.degrees * std::sqrt(std::max(squares / (count - 1), 1.0) / weights);
}

std::string quoted(const Rig& rig, std::size_t actuator) { return "\"" + rig.actuators()[actuator].name + "\""; }

} // namespace

void drawCurve(const BothWays& seen, ServoFinding& servo) {
    if (sure(seen.up).size() < 3 || sure(seen.down).size() < 3) return;
    Ladder ladder = ladderOf(seen);
    measurePlay(ladder, servo);
    const double step = 1.0 / static_cast<double>(ladder.commanded.size() - 1);
    smooth(ladder, servo.stopsAt ? kWithStop : Stiffness{}.over(step));
    std::vector<double> sigmas;
    for (const LevelSeen& level : seen.up) sigmas.push_back(level.sigma);
    std::ranges::nth_element(sigmas, sigmas.begin() + static_cast<std::ptrdiff_t>(sigmas.size() / 2));
    servo.curveSigma = servo.degrees * sigmas[sigmas.size() / 2];
    for (std::size_t k = 0; k < ladder.commanded.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        servo.curve.points.push_back({ladder.commanded[k], ladder.up[at], ladder.down[at]});
    }
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
        if (std::abs(movers[i].by) < kMoved && !movers[i].isOwnSeen) {
            findings.push_back(
                {Cause::tooFewPoints, name, "",
                 "too little of the part of servo " + quoted(rig, i) + " is seen to tell whether it moves",
                 "move camera or projector so that both see it, then measure again"});
        } else if (std::abs(movers[i].by) < kMoved) {
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
