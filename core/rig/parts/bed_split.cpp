#include "core/rig/parts/bed_split.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {
namespace {

// Millimetres.
constexpr double kTongue = 8.0;
constexpr double kRoot = 4.0; ///< half the width of a tongue where it begins
constexpr double kTip = 6.0;
constexpr double kSpacing = 45.0; ///< between tongues
constexpr double kEnd = 14.0;     ///< from a tongue's middle to the border
constexpr double kStrip = 3.0;    ///< beside a seam
constexpr double kFar = 1e4;

/// Whether convex polygons, counter-clockwise, share more than a sliver.
bool meets(PlanePolygon a, const PlanePolygon& b) {
    for (std::size_t k = 0; k < b.size() && a.size() > 2; ++k) {
        const glm::dvec2 way = b[(k + 1) % b.size()] - b[k];
        a = leftOf(a, b[k], glm::normalize(way), 1.0);
    }
    return a.size() > 2;
}

/// Along the axis first.
glm::dvec2 turned(double along, double across, int axis) {
    return axis == 0 ? glm::dvec2(along, across) : glm::dvec2(across, along);
}

} // namespace

BedSplit::BedSplit(const PlanePolygon& area, double bed, double clearance, const glm::dvec2& shift)
    : area_(area), low_(area.front()), high_(area.front()), clearance_(clearance) {
    for (const glm::dvec2& p : area) {
        low_ = glm::min(low_, p);
        high_ = glm::max(high_, p);
    }
    seamsX_ = seamsAlong(0, bed, shift.x);
    seamsY_ = seamsAlong(1, bed, shift.y);
}

std::vector<BedSplit::Seam> BedSplit::seamsAlong(int axis, double bed, double shift) const {
    const double length = high_[axis] - low_[axis];
    if (length <= bed) return {};
    const double room = bed - kTongue - clearance_;
    if (room < 3.0 * kTongue)
        throw InvalidInput("print bed", "no piece with its dovetails would fit", "choose a larger bed");
    const int count = static_cast<int>(std::ceil(length / room));
    const double slack = 0.95 * shift * (room - length / count);
    std::vector<Seam> seams;
    for (int k = 1; k < count; ++k) {
        Seam seam{low_[axis] + length * k / count + slack, {}};
        double from = -kFar;
        double to = kFar;
        for (const double at : {seam.at, seam.at + kTongue}) {
            double first = kFar;
            double last = -kFar;
            for (std::size_t i = 0; i < area_.size(); ++i) {
                const glm::dvec2& a = area_[i];
                const glm::dvec2& b = area_[(i + 1) % area_.size()];
                if ((a[axis] > at) == (b[axis] > at)) continue;
                const double crossing =
                    a[1 - axis] + (b[1 - axis] - a[1 - axis]) * (at - a[axis]) / (b[axis] - a[axis]);
                first = std::min(first, crossing);
                last = std::max(last, crossing);
            }
            from = std::max(from, first + kEnd);
            to = std::min(to, last - kEnd);
        }
        const int tongues = to < from ? 0 : 1 + static_cast<int>((to - from) / kSpacing);
        for (int i = 0; i < tongues; ++i) seam.tongues.push_back(from + (to - from) * (i + 0.5) / tongues);
        seams.push_back(std::move(seam));
    }
    return seams;
}

std::vector<PlanePolygon> BedSplit::strips() const {
    std::vector<PlanePolygon> strips;
    for (const auto& [seams, axis] : {std::pair(&seamsX_, 0), std::pair(&seamsY_, 1)})
        for (const Seam& seam : *seams)
            strips.push_back(rectangle(turned(seam.at - kStrip, low_[1 - axis] - kStrip, axis),
                                       turned(seam.at + kTongue + kStrip, high_[1 - axis] + kStrip, axis)));
    return strips;
}

PlanePolygon BedSplit::sideOf(const Seam& seam, int axis, bool below) const {
    const double grown = below ? 0.0 : clearance_;
    PlanePolygon side{turned(seam.at + grown, -kFar, axis)};
    for (const double middle : seam.tongues)
        for (const auto& [way, half] : {std::pair(0.0, -kRoot - grown), std::pair(kTongue, -kTip - grown),
                                        std::pair(kTongue, kTip + grown), std::pair(0.0, kRoot + grown)})
            side.push_back(turned(seam.at + grown + way, middle + half, axis));
    side.push_back(turned(seam.at + grown, kFar, axis));
    const double end = below ? -kFar : kFar;
    side.push_back(turned(end, kFar, axis));
    side.push_back(turned(end, -kFar, axis));
    return side;
}

std::vector<LayeredDrawing> BedSplit::pieces(const LayeredDrawing& drawing) const {
    std::vector<LayeredDrawing> pieces;
    for (std::size_t row = 0; row <= seamsY_.size(); ++row)
        for (std::size_t column = 0; column <= seamsX_.size(); ++column) {
            const glm::dvec2 low(column > 0 ? seamsX_[column - 1].at : -kFar, row > 0 ? seamsY_[row - 1].at : -kFar);
            const glm::dvec2 high(column < seamsX_.size() ? seamsX_[column].at : kFar,
                                  row < seamsY_.size() ? seamsY_[row].at : kFar);
            if (!meets(area_, rectangle(low, high))) continue;
            LayeredDrawing piece = drawing;
            if (column > 0) piece.keep(sideOf(seamsX_[column - 1], 0, false));
            if (column < seamsX_.size()) piece.keep(sideOf(seamsX_[column], 0, true));
            if (row > 0) piece.keep(sideOf(seamsY_[row - 1], 1, false));
            if (row < seamsY_.size()) piece.keep(sideOf(seamsY_[row], 1, true));
            pieces.push_back(std::move(piece));
        }
    return pieces;
}

} // namespace lumorph
