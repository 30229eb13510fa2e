#include "core/mdf/box_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace lumorph {
namespace {

constexpr double kBin = 0.2; ///< voxels: heights of a block are looked at in steps of this
constexpr std::size_t kMostBins = 64;
constexpr int kMostCuts = 40;
constexpr int kMostPivots = 200;
constexpr double kTiny = 1e-9;

/// Solves the square system `rows` x = b in place by elimination with row pivots; false where it is singular.
bool solve(std::vector<std::vector<double>> rows, std::vector<double>& b) {
    const std::size_t size = b.size();
    for (std::size_t column = 0; column < size; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column; row < size; ++row)
            if (std::abs(rows[row][column]) > std::abs(rows[pivot][column])) pivot = row;
        if (std::abs(rows[pivot][column]) < 1e-12) return false;
        std::swap(rows[pivot], rows[column]);
        std::swap(b[pivot], b[column]);
        for (std::size_t row = 0; row < size; ++row) {
            if (row == column) continue;
            const double factor = rows[row][column] / rows[column][column];
            if (factor == 0.0) continue;
            for (std::size_t k = column; k < size; ++k) rows[row][k] -= factor * rows[column][k];
            b[row] -= factor * b[column];
        }
    }
    for (std::size_t row = 0; row < size; ++row) b[row] /= rows[row][row];
    return true;
}

} // namespace

void BoxBound::set(const VolumeEnclosure& enclosure, const BitColumns& target, const BitColumns& domain) {
    enclosure_ = &enclosure;
    target_ = &target;
    domain_ = &domain;
    axes_ = enclosure.spread.size();
    both_ = enclosure.always.countAnd(target);
    overfill_ = enclosure.always.count() - both_;
    BitColumns open = enclosure.possible;
    open -= enclosure.always;
    const auto words = static_cast<std::size_t>(open.wordsPerColumn());
    double width = 0.0;
    for (std::size_t h = 0; h < enclosure.heights.size(); ++h) {
        std::fill_n(open.words().begin() + static_cast<std::ptrdiff_t>(enclosure.heights[h].column * words), words, 0);
        for (std::size_t i = 0; i < axes_; ++i) width += std::abs(static_cast<double>(enclosure.slopes[h * axes_ + i]));
    }
    openWanted_ = open.countAnd(target);
    // Side by side columns average out that heights count in whole voxels, but follow one height only in small boxes.
    width /= static_cast<double>(std::max<std::size_t>(1, enclosure.heights.size()));
    makeBlocks(width > 4.0 ? 1 : width > 1.5 ? 2 : width > 0.5 ? 3 : 4);
}

void BoxBound::makeBlocks(int side) {
    const auto& heights = enclosure_->heights;
    const auto across = static_cast<std::uint32_t>(target_->dimensions().x);
    const auto edge = static_cast<std::uint32_t>(side);
    const auto blockOf = [&](std::size_t h) {
        return std::pair(heights[h].column / across / edge, heights[h].column % across / edge);
    };
    ordered_.resize(heights.size());
    std::iota(ordered_.begin(), ordered_.end(), std::size_t{0});
    std::ranges::sort(ordered_, {}, [&](std::size_t h) { return std::pair(blockOf(h), h); });
    blocks_.clear();
    blockSlopes_.clear();
    slack_.assign(ordered_.size(), 0.0F);
    for (std::size_t first = 0; first < ordered_.size();) {
        std::size_t last = first;
        while (last < ordered_.size() && blockOf(ordered_[last]) == blockOf(ordered_[first])) ++last;
        Block& block = blocks_.emplace_back(Block{first, last - first});
        for (std::size_t i = 0; i < axes_; ++i) {
            double sum = 0.0;
            for (std::size_t k = first; k < last; ++k)
                sum += static_cast<double>(enclosure_->slopes[ordered_[k] * axes_ + i]);
            blockSlopes_.push_back(sum / static_cast<double>(last - first));
            block.reach += std::abs(blockSlopes_.back());
            for (std::size_t k = first; k < last; ++k)
                slack_[k] +=
                    std::abs(enclosure_->slopes[ordered_[k] * axes_ + i] - static_cast<float>(blockSlopes_.back()));
        }
        first = last;
    }
}

/// What a block gains at most at a common height u, and the concave hull of that over [-reach, reach].
void BoxBound::hullOf(Block& block, double lambda) {
    const double reach = block.reach * (1.0 + 1e-6) + 1e-6;
    const std::size_t bins =
        std::clamp(static_cast<std::size_t>(std::ceil(2.0 * reach / kBin)), std::size_t{1}, kMostBins);
    const double bin = 2.0 * reach / static_cast<double>(bins);
    sums_.assign(bins, 0.0);
    const auto words = static_cast<std::size_t>(target_->wordsPerColumn());
    for (std::size_t k = block.first; k < block.first + block.count; ++k) {
        const ColumnHeight& height = enclosure_->heights[ordered_[k]];
        gains_.assign(1, 0.0); // up to each level from the first
        for (int y = height.first; y < height.last; ++y) {
            const std::size_t word = height.column * words + (static_cast<std::size_t>(y) >> 6U);
            const std::uint64_t bit = std::uint64_t{1} << (static_cast<unsigned>(y) & 63U);
            const bool wanted = (target_->words()[word] & bit) != 0;
            const bool counts = (domain_->words()[word] & bit) != 0;
            gains_.push_back(gains_.back() + (wanted ? 1.0 : counts ? -lambda : 0.0));
        }
        const double from = static_cast<double>(height.from - slack_[k]) - 1e-4;
        const double to = static_cast<double>(height.to + slack_[k]) + 1e-4;
        const auto levelAt = [&](double y) {
            return static_cast<int>(
                       std::ceil(std::clamp(y, static_cast<double>(height.first), static_cast<double>(height.last)))) -
                   height.first;
        };
        int lastLow = -1, lastHigh = -1;
        double most = 0.0;
        for (std::size_t b = 0; b < bins; ++b) {
            const double u = static_cast<double>(b) * bin - reach;
            const int low = levelAt(from + u), high = levelAt(to + u + bin);
            if (low != lastLow || high != lastHigh) {
                most = *std::max_element(gains_.begin() + low, gains_.begin() + high + 1);
                lastLow = low, lastHigh = high;
            }
            sums_[b] += most;
        }
    }
    block.hullFirst = hulls_.size();
    for (std::size_t edge = 0; edge <= bins; ++edge) {
        const HullPoint point{static_cast<double>(edge) * bin - reach,
                              std::max(sums_[edge == 0 ? 0 : edge - 1], sums_[std::min(edge, bins - 1)])};
        while (hulls_.size() >= block.hullFirst + 2) {
            const HullPoint &a = hulls_[hulls_.size() - 2], &b = hulls_.back();
            if ((b.value - a.value) * (point.u - b.u) > (point.value - b.value) * (b.u - a.u)) break;
            hulls_.pop_back();
        }
        hulls_.push_back(point);
    }
    block.hullCount = hulls_.size() - block.hullFirst;
}

/// The plane that touches the sum of the hulls at a place: no place has more than it says.
BoxBound::Cut BoxBound::cutAt(const std::vector<double>& place, double& value) const {
    Cut cut{0.0, std::vector<double>(axes_, 0.0)};
    value = 0.0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const Block& block = blocks_[b];
        const double* const slopes = blockSlopes_.data() + b * axes_;
        double u = 0.0;
        for (std::size_t i = 0; i < axes_; ++i) u += slopes[i] * place[i];
        const HullPoint* const hull = hulls_.data() + block.hullFirst;
        std::size_t k = 1;
        while (k + 1 < block.hullCount && hull[k].u < u) ++k;
        const double slope = (hull[k].value - hull[k - 1].value) / (hull[k].u - hull[k - 1].u);
        const double atRest = hull[k - 1].value - slope * hull[k - 1].u;
        cut.constant += atRest;
        value += atRest + slope * u;
        for (std::size_t i = 0; i < axes_; ++i) cut.slopes[i] += slope * slopes[i];
    }
    return cut;
}

/// The least, over weights of the cuts that add up to 1, of the weighted cut's maximum over the box: a linear program
/// solved by column generation, each pivot of which gives a bound.
double BoxBound::maximum(double enough) {
    if (blocks_.empty()) return 0.0;
    std::vector<double> place(axes_, 0.0);
    double reached = -std::numeric_limits<double>::infinity();
    std::vector<Cut> cuts;
    const auto addCut = [&] {
        double value = 0.0;
        cuts.push_back(cutAt(place, value));
        reached = std::max(reached, value);
        return value;
    };
    addCut();
    // Columns 0 .. 2 axes - 1 take up the weighted slopes, positive or negative; then the cuts.
    const std::size_t rows = axes_ + 1;
    const auto entry = [&](std::size_t column, std::size_t row) {
        if (column >= 2 * axes_) return row == axes_ ? 1.0 : cuts[column - 2 * axes_].slopes[row];
        return column / 2 != row ? 0.0 : column % 2 == 0 ? -1.0 : 1.0;
    };
    const auto cost = [&](std::size_t column) { return column < 2 * axes_ ? 1.0 : cuts[column - 2 * axes_].constant; };
    std::vector<std::size_t> basis;
    for (std::size_t i = 0; i < axes_; ++i) basis.push_back(2 * i + (cuts.front().slopes[i] < 0.0 ? 1 : 0));
    basis.push_back(2 * axes_);
    const auto matrix = [&](bool transposed) {
        std::vector<std::vector<double>> m(rows, std::vector<double>(rows));
        for (std::size_t r = 0; r < rows; ++r)
            for (std::size_t c = 0; c < rows; ++c) (transposed ? m[c][r] : m[r][c]) = entry(basis[c], r);
        return m;
    };
    /// Of these weights, whatever made them.
    const auto boundOf = [&](const std::vector<double>& amounts) {
        double total = 0.0;
        double constant = 0.0;
        std::vector<double> slopes(axes_, 0.0);
        for (std::size_t r = 0; r < rows; ++r) {
            if (basis[r] < 2 * axes_) continue;
            const double weight = std::max(0.0, amounts[r]);
            const Cut& cut = cuts[basis[r] - 2 * axes_];
            total += weight;
            constant += weight * cut.constant;
            for (std::size_t i = 0; i < axes_; ++i) slopes[i] += weight * cut.slopes[i];
        }
        if (total <= 0.5) return std::numeric_limits<double>::infinity();
        for (const double slope : slopes) constant += std::abs(slope);
        return constant / total;
    };
    double best = std::numeric_limits<double>::infinity();
    for (int pivot = 0; pivot < kMostPivots; ++pivot) {
        std::vector<double> amounts(rows, 0.0);
        amounts[axes_] = 1.0;
        if (!solve(matrix(false), amounts)) break;
        best = std::min(best, boundOf(amounts));
        if (best <= enough || best - reached < 1e-3 * std::abs(best) + 0.02) break;
        std::vector<double> prices;
        for (const std::size_t column : basis) prices.push_back(cost(column));
        if (!solve(matrix(true), prices)) break;
        const auto reducedCost = [&](std::size_t column) {
            double sum = cost(column);
            for (std::size_t r = 0; r < rows; ++r) sum -= prices[r] * entry(column, r);
            return sum;
        };
        std::size_t entering = 0;
        double least = -kTiny * (1.0 + std::abs(best));
        bool found = false;
        for (std::size_t column = 0; column < 2 * axes_ + cuts.size(); ++column)
            if (const double reduced = reducedCost(column); reduced < least) {
                least = reduced;
                entering = column;
                found = true;
            }
        if (!found) {
            if (static_cast<int>(cuts.size()) >= kMostCuts) break;
            for (std::size_t i = 0; i < axes_; ++i) place[i] = std::clamp(-prices[i], -1.0, 1.0);
            addCut();
            entering = 2 * axes_ + cuts.size() - 1;
            if (reducedCost(entering) > -kTiny * (1.0 + std::abs(best))) break;
        }
        std::vector<double> direction(rows);
        for (std::size_t r = 0; r < rows; ++r) direction[r] = entry(entering, r);
        if (!solve(matrix(false), direction)) break;
        std::size_t leaving = rows;
        double step = std::numeric_limits<double>::infinity();
        for (std::size_t r = 0; r < rows; ++r)
            if (direction[r] > kTiny && std::max(0.0, amounts[r]) / direction[r] < step) {
                step = std::max(0.0, amounts[r]) / direction[r];
                leaving = r;
            }
        if (leaving == rows) break;
        basis[leaving] = entering;
    }
    return best;
}

double BoxBound::at(double lambda, double enough) {
    const double fixed = static_cast<double>(both_ + openWanted_) - lambda * static_cast<double>(overfill_);
    hulls_.clear();
    for (Block& block : blocks_) hullOf(block, lambda);
    return fixed + maximum(enough - fixed) + 1e-6;
}

} // namespace lumorph
