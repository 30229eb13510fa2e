#include "core/motion/joint_fit.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace lumorph {

namespace {

constexpr double kSmallestStep = 0.004; // strokes
constexpr int kStates = 6;
constexpr double kSameEnergy = 0.01;

/// A joint state, one of many.
void anyState(std::mt19937& random, std::span<double> strokes) {
    for (double& stroke : strokes) stroke = std::ldexp(static_cast<double>(random()), -32);
}

} // namespace

JointFit::JointFit(const TopSurface& surface)
    : surface_(&surface), reader_(surface.points()), positions_(surface.rig().restMesh().positions.size()),
      heights_(surface.points().size()) {}

void JointFit::read(std::span<const double> strokes) {
    surface_->rig().deform(strokes, positions_);
    std::ranges::fill(heights_, surface_->floor());
    reader_.read(positions_, surface_->rig().restMesh().triangles, heights_);
}

bool JointFit::differsFrom(const StrokeFit& sum) {
    std::mt19937 random(1);
    std::vector<double> strokes(surface_->rig().actuatorCount());
    std::vector<double> lifts(heights_.size());
    double whole = 0.0;
    double off = 0.0;
    for (int state = 0; state < kStates; ++state) {
        anyState(random, strokes);
        read(strokes);
        sum.lifts(strokes, lifts);
        for (std::size_t p = 0; p < lifts.size(); ++p) {
            const double lift = static_cast<double>(heights_[p]) - static_cast<double>(surface_->restHeights()[p]);
            whole += lift * lift;
            off += (lift - lifts[p]) * (lift - lifts[p]);
        }
    }
    return off > kSameEnergy * whole;
}

double JointFit::errorAt(std::span<const double> lifts, std::span<const double> strokes) {
    read(strokes);
    double error = 0.0;
    for (std::size_t p = 0; p < lifts.size(); ++p) {
        const double off =
            lifts[p] + static_cast<double>(surface_->restHeights()[p]) - static_cast<double>(heights_[p]);
        error += off * off;
    }
    return error;
}

void JointFit::scan(std::span<const double> lifts, std::span<double> strokes, int states) {
    std::mt19937 random(2);
    std::vector<double> other(strokes.size());
    double least = errorAt(lifts, strokes);
    for (int state = 0; state < states; ++state) {
        anyState(random, other);
        const double error = errorAt(lifts, other);
        if (error >= least) continue;
        least = error;
        std::ranges::copy(other, strokes.begin());
    }
}

void JointFit::improve(std::span<const double> lifts, std::span<double> strokes, double step, int most) {
    double least = errorAt(lifts, strokes);
    const auto better = [&](std::size_t i, double by) {
        const double before = strokes[i];
        strokes[i] = std::clamp(before + by, 0.0, 1.0);
        if (strokes[i] != before && most-- > 0) {
            const double error = errorAt(lifts, strokes);
            if (error < least) {
                least = error;
                return true;
            }
        }
        strokes[i] = before;
        return false;
    };
    while (step >= kSmallestStep && most > 0) {
        bool moved = false;
        for (std::size_t i = 0; i < strokes.size(); ++i) moved |= better(i, step) || better(i, -step);
        if (!moved) step *= 0.5;
    }
}

} // namespace lumorph
