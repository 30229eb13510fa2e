#include "core/rig/templates/flap_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/plane_mesh.h"

namespace lumorph {
namespace {

// Millimetres.
constexpr double kStill = 3.5;      ///< of still sheet behind each bend line
constexpr double kLeastDepth = 0.6; ///< a flap is nowhere shorter, but where it runs out at the sheet's edge
constexpr double kLeastReach = 6.0; ///< a flap that nowhere reaches so far is none
constexpr double kLeastWidth = 6.0;
constexpr double kTiny = 0.25;  ///< features of a rim that are smaller are smoothed away
constexpr double kSlope = 0.25; ///< a rim that runs out flatter than this is cut
constexpr double kSame = 1e-6;

/// A piece of a rim or of what limits it, in a line's frame, from left to right.
struct Piece {
    glm::dvec2 from;
    glm::dvec2 to;
    std::size_t owner = 0; ///< the line it belongs to; the number of lines stands for the sheet's edge

    [[nodiscard]] double at(double w) const { return from.y + (to.y - from.y) * (w - from.x) / (to.x - from.x); }
};

using Pieces = std::vector<Piece>;

/// Where the nearest (or farthest) piece may change: ends and crossings within (low, high).
std::vector<double> breaks(const Pieces& pieces, double low, double high) {
    std::vector<double> places{low, high};
    const auto add = [&](double w) {
        if (w > low && w < high) places.push_back(w);
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        add(pieces[i].from.x);
        add(pieces[i].to.x);
        for (std::size_t j = 0; j < i; ++j) {
            const double left = std::max({pieces[i].from.x, pieces[j].from.x, low});
            const double right = std::min({pieces[i].to.x, pieces[j].to.x, high});
            if (!(left < right)) continue;
            const double before = pieces[i].at(left) - pieces[j].at(left);
            const double after = pieces[i].at(right) - pieces[j].at(right);
            if (before * after < 0.0) add(left + (right - left) * before / (before - after));
        }
    }
    std::ranges::sort(places);
    return places;
}

/// The nearest piece (sign 1) or the farthest (sign -1), from `low` to `high`, as pieces side by side.
Pieces envelope(const Pieces& pieces, double low, double high, double sign) {
    const std::vector<double> places = breaks(pieces, low, high);
    Pieces result;
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
        const double left = places[k];
        const double right = places[k + 1];
        if (right - left < kSame) continue;
        const double middle = 0.5 * (left + right);
        const Piece* best = nullptr;
        for (const Piece& piece : pieces)
            if (piece.from.x < middle && piece.to.x > middle &&
                (best == nullptr || sign * piece.at(middle) < sign * best->at(middle)))
                best = &piece;
        if (best == nullptr) continue;
        result.push_back({{left, best->at(left)}, {right, best->at(right)}, best->owner});
    }
    return result;
}

struct Obstacle {
    std::vector<glm::dvec2> polygon; ///< on the page
    std::size_t owner = 0;
};

/// Everything ahead of a line that can limit its flap.
Pieces piecesAhead(const LineFrame& frame, const std::vector<Obstacle>& obstacles, std::size_t self) {
    Pieces pieces;
    for (const Obstacle& obstacle : obstacles) {
        if (obstacle.owner == self) continue;
        for (std::size_t k = 0; k < obstacle.polygon.size(); ++k) {
            Piece piece{frame.local(obstacle.polygon[k]),
                        frame.local(obstacle.polygon[(k + 1) % obstacle.polygon.size()]), obstacle.owner};
            if (piece.from.x > piece.to.x) std::swap(piece.from, piece.to);
            if (piece.to.x - piece.from.x < kSame) continue;
            if (piece.from.y <= kSame && piece.to.y <= kSame) continue;
            if (piece.from.y < 0.0 || piece.to.y < 0.0) { // starts at the line
                const double w =
                    piece.from.x - piece.from.y * (piece.to.x - piece.from.x) / (piece.to.y - piece.from.y);
                (piece.from.y < 0.0 ? piece.from : piece.to) = {w, 0.0};
                if (piece.to.x - piece.from.x < kSame) continue;
            }
            pieces.push_back(piece);
        }
    }
    return pieces;
}

double areaOf(const Pieces& pieces) {
    double area = 0.0;
    for (const Piece& piece : pieces) area += 0.5 * (piece.from.y + piece.to.y) * (piece.to.x - piece.from.x);
    return area;
}

/// A stretch of a bend line, in its frame.
struct Stretch {
    double low = 0.0;
    double high = 0.0;
    bool lowAtEdge = false; ///< ends at the sheet's edge
    bool highAtEdge = false;
};

/// What is cut away around a flap: its rim grown by `gap` to all sides but behind the line, and `behind` there.
std::vector<glm::dvec2> grown(const LineFrame& frame, const std::vector<glm::dvec2>& rim, double gap, double behind) {
    Pieces pieces;
    for (std::size_t k = 0; k < rim.size(); ++k) {
        const glm::dvec2& a = rim[k];
        pieces.push_back({a + glm::dvec2(-gap, gap), a + glm::dvec2(gap, gap)});
        if (k + 1 == rim.size() || rim[k + 1].x - a.x < kSame) continue;
        for (const double side : {-gap, gap})
            pieces.push_back({a + glm::dvec2(side, gap), rim[k + 1] + glm::dvec2(side, gap)});
    }
    const double low = rim.front().x - gap;
    const double high = rim.back().x + gap;
    std::vector<glm::dvec2> polygon{{high, -behind}, {low, -behind}};
    for (const Piece& piece : envelope(pieces, low, high, -1.0))
        for (const glm::dvec2& p : {piece.from, piece.to})
            if (glm::distance(p, polygon.back()) > 1e-3) polygon.push_back(p);
    for (glm::dvec2& p : polygon) p = frame.page(p);
    return polygon;
}

class Layout {
public:
    Layout(const std::vector<glm::dvec2>& outline, const std::vector<BendLine>& bends, const FlapClearance& clearance)
        : outline_(outline), bends_(bends), clearance_(clearance) {}

    std::vector<Flap> layOut() {
        for (std::size_t k = 0; k < bends_.size(); ++k) check(k);
        obstacles_.push_back({outline_, bends_.size()});
        for (std::size_t k = 0; k < bends_.size(); ++k) addStrip(k);
        std::vector<Flap> flaps;
        for (std::size_t k = 0; k < bends_.size(); ++k) {
            flaps.push_back(flapOf(k));
            // Takes the place of the line's own strip.
            obstacles_[k + 1].polygon =
                grown(flaps.back().frame, flaps.back().rim, clearance_.between(), kStill + clearance_.between());
        }
        return flaps;
    }

private:
    [[nodiscard]] std::string subject(std::size_t k) const { return "bend line " + inQuotes(bends_[k].name); }
    [[nodiscard]] std::string ownerName(std::size_t owner) const {
        return owner < bends_.size() ? "bend line " + inQuotes(bends_[owner].name) : "the sheet's edge";
    }

    void check(std::size_t k) {
        const BendLine& bend = bends_[k];
        const auto finite = [](const glm::dvec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); };
        if (!finite(bend.from) || !finite(bend.to))
            throw InvalidInput(subject(k), "an end is no finite number", "give two finite points");
        const double degrees = bend.angle.inDegrees();
        if (!(degrees > 0.0 && degrees <= 90.0 + 1e-9))
            throw InvalidInput(subject(k), "the angle is not within 0 and 90 degrees",
                               "a flap that bends further would lean over the rest; choose at most 90");
        const glm::dvec2 a = pageOf(bend.from);
        const glm::dvec2 b = pageOf(bend.to);
        if (glm::distance(a, b) < kLeastWidth)
            throw InvalidInput(subject(k), "it is shorter than 6 mm", "draw it across the sheet");
        for (std::size_t j = 0; j < k; ++j) {
            if (bends_[j].name == bend.name)
                throw InvalidInput(subject(k), "two bend lines have this name", "give each a name of its own");
        }
        for (std::size_t j = 0; j < k; ++j) endBefore(k, j);
    }

    /// A line that crosses one before it in the list keeps its longer part.
    void endBefore(std::size_t k, std::size_t j) {
        BendLine& bend = bends_[k];
        const glm::dvec2 a = pageOf(bend.from);
        const glm::dvec2 b = pageOf(bend.to);
        const auto place = crossing(a, b, pageOf(bends_[j].from), pageOf(bends_[j].to));
        if (!place) return;
        if (!insidePolygon(outline_, *place))
            throw InvalidInput(subject(k), "it meets " + ownerName(j) + " outside the sheet",
                               "end both at the sheet's edge");
        const bool first = glm::distance(a, *place) >= glm::distance(b, *place);
        const glm::dvec2 kept = first ? a : b;
        const double left = glm::distance(kept, *place) - kStill;
        if (left < kLeastWidth)
            throw InvalidInput(subject(k), "it crosses " + ownerName(j) + ", and too little of it is left",
                               "end it before the other");
        (first ? bend.to : bend.from) = placeOf(kept + glm::normalize(*place - kept) * left);
    }

    static std::optional<glm::dvec2> crossing(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c,
                                              const glm::dvec2& d) {
        const double turn = crossOf(b - a, d - c);
        if (std::abs(turn) < 1e-9) return std::nullopt; // parallel ones are kept apart by their strips
        const double s = crossOf(c - a, d - c) / turn;
        const double t = crossOf(c - a, b - a) / turn;
        if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return std::nullopt;
        return a + s * (b - a);
    }

    [[nodiscard]] LineFrame frameOf(std::size_t k) const {
        LineFrame frame;
        const glm::dvec2 a = pageOf(bends_[k].from);
        const glm::dvec2 b = pageOf(bends_[k].to);
        frame.origin = 0.5 * (a + b);
        frame.along = glm::normalize(b - a);
        frame.across = {-frame.along.y, frame.along.x};
        return frame;
    }

    [[nodiscard]] double halfLength(std::size_t k) const { return 0.5e3 * glm::distance(bends_[k].from, bends_[k].to); }

    /// A line keeps others at a distance, whichever side it bends to.
    void addStrip(std::size_t k) {
        const LineFrame frame = frameOf(k);
        const double w = halfLength(k) + clearance_.between();
        const double u = kStill + clearance_.between();
        std::vector<glm::dvec2> polygon{{-w, -u}, {w, -u}, {w, u}, {-w, u}};
        for (glm::dvec2& p : polygon) p = frame.page(p);
        obstacles_.push_back({std::move(polygon), k});
    }

    /// The owner of an obstacle at a point: another line's, or the sheet's edge where the point lies outside.
    [[nodiscard]] std::optional<std::size_t> taken(const glm::dvec2& page, std::size_t self) const {
        if (!insidePolygon(outline_, page)) return bends_.size();
        for (const Obstacle& obstacle : obstacles_)
            if (obstacle.owner != self && obstacle.owner < bends_.size() && insidePolygon(obstacle.polygon, page))
                return obstacle.owner;
        return std::nullopt;
    }

    /// The part of the line that crosses free sheet: the longest one of a free line, the one that holds most of a
    /// joined one.
    [[nodiscard]] Stretch stretchOf(std::size_t k, const LineFrame& frame) const {
        const double half = halfLength(k);
        double far = half;
        if (bends_[k].ends == BendLine::Ends::joined)
            for (const glm::dvec2& p : outline_) far = std::max(far, glm::distance(p, frame.origin) + 1.0);
        struct Place {
            double w;
            std::size_t owner;
        };
        std::vector<Place> places{{-far, k}, {far, k}};
        for (const Obstacle& obstacle : obstacles_) {
            if (obstacle.owner == k) continue;
            for (std::size_t i = 0; i < obstacle.polygon.size(); ++i) {
                const glm::dvec2 a = frame.local(obstacle.polygon[i]);
                const glm::dvec2 b = frame.local(obstacle.polygon[(i + 1) % obstacle.polygon.size()]);
                if ((a.y > 0.0) == (b.y > 0.0)) continue;
                const double w = a.x - a.y * (b.x - a.x) / (b.y - a.y);
                if (std::abs(w) < far) places.push_back({w, obstacle.owner});
            }
        }
        std::ranges::sort(places, {}, &Place::w);
        Stretch best;
        double most = 0.0;
        std::optional<std::size_t> blocker;
        for (std::size_t i = 0; i + 1 < places.size(); ++i) {
            const double low = places[i].w;
            const double high = places[i + 1].w;
            const double held = std::min(high, half) - std::max(low, -half);
            if (held <= most && blocker) continue;
            const auto owner = taken(frame.page({0.5 * (low + high), 0.0}), k);
            if (owner) {
                if (held > 0.0 && (!blocker || *blocker == bends_.size())) blocker = owner;
                continue;
            }
            if (held <= most) continue;
            most = held;
            best = {low, high, places[i].owner == bends_.size(), places[i + 1].owner == bends_.size()};
        }
        if (most < kLeastWidth) {
            if (!blocker || *blocker == bends_.size())
                throw InvalidInput(subject(k), "it does not cross the sheet", "draw it across the sheet");
            throw InvalidInput(subject(k), ownerName(*blocker) + " or its flap lies there",
                               "move one of the two, or list the one first that is to have the room");
        }
        return best;
    }

    /// Smooths what is too small to cut away: steps and pieces below `kTiny`.
    static Pieces smoothed(Pieces pieces) {
        bool changed = true;
        while (changed && pieces.size() > 1) {
            changed = false;
            for (std::size_t k = 0; k < pieces.size() && pieces.size() > 1; ++k) {
                const Piece piece = pieces[k];
                if (piece.to.x - piece.from.x >= kTiny) continue;
                const double lowest = std::min(piece.from.y, piece.to.y);
                // The neighbour that is lower takes the place.
                const bool left = k > 0 && (k + 1 == pieces.size() || pieces[k - 1].to.y <= pieces[k + 1].from.y);
                if (left) {
                    Piece& neighbour = pieces[k - 1];
                    neighbour.to = {piece.to.x, std::min(neighbour.to.y, std::max(lowest, 0.0))};
                } else {
                    Piece& neighbour = pieces[k + 1];
                    neighbour.from = {piece.from.x, std::min(neighbour.from.y, std::max(lowest, 0.0))};
                }
                pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
                changed = true;
                break;
            }
        }
        for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
            double& a = pieces[k].to.y;
            double& b = pieces[k + 1].from.y;
            if (std::abs(a - b) < kTiny) a = b = std::min(a, b);
        }
        return pieces;
    }

    /// The longest run of pieces that are deep enough; pieces that run out are shortened.
    static Pieces deepRun(const Pieces& pieces, const Stretch& stretch) {
        std::vector<Pieces> runs(1);
        const auto closeRun = [&] {
            if (!runs.back().empty()) runs.emplace_back();
        };
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            Piece piece = pieces[k];
            const double width = piece.to.x - piece.from.x;
            const double rise = (piece.to.y - piece.from.y) / width;
            if (k > 0 && piece.from.x - pieces[k - 1].to.x > kSame) closeRun();
            const bool firstRunsOut = k == 0 && stretch.lowAtEdge && piece.from.y < kTiny && rise > kSlope;
            const bool lastRunsOut =
                k + 1 == pieces.size() && stretch.highAtEdge && piece.to.y < kTiny && rise < -kSlope;
            if (firstRunsOut) piece.from.y = 0.0;
            if (lastRunsOut) piece.to.y = 0.0;
            const bool lowFrom = piece.from.y < kLeastDepth && !firstRunsOut;
            const bool lowTo = piece.to.y < kLeastDepth && !lastRunsOut;
            if (std::max(piece.from.y, piece.to.y) < kLeastDepth) {
                closeRun();
                continue;
            }
            if (lowFrom) {
                closeRun();
                piece.from = {piece.from.x + (kLeastDepth - piece.from.y) / rise, kLeastDepth};
            }
            if (lowTo) piece.to = {piece.to.x + (kLeastDepth - piece.to.y) / rise, kLeastDepth};
            if (piece.to.x - piece.from.x > kSame) runs.back().push_back(piece);
            if (lowTo) closeRun();
        }
        return *std::ranges::max_element(runs, {}, areaOf);
    }

    [[nodiscard]] Pieces roomOf(std::size_t k, const LineFrame& frame, const Stretch& stretch) const {
        return envelope(piecesAhead(frame, obstacles_, k), stretch.low, stretch.high, 1.0);
    }

    /// Area of the sheet on one side of a line, as if there were no other.
    [[nodiscard]] double sheetAhead(const LineFrame& frame, const Stretch& stretch) const {
        return areaOf(
            envelope(piecesAhead(frame, {obstacles_.front()}, bends_.size() + 1), stretch.low, stretch.high, 1.0));
    }

    [[nodiscard]] static LineFrame turned(const LineFrame& frame) {
        return {frame.origin, -frame.along, -frame.across};
    }

    static bool enough(const Pieces& pieces) {
        double reach = 0.0;
        for (const Piece& piece : pieces) reach = std::max({reach, piece.from.y, piece.to.y});
        return reach >= kLeastReach && pieces.back().to.x - pieces.front().from.x >= kLeastWidth;
    }

    /// Whose is what stands nearest to the line.
    [[nodiscard]] std::size_t nearestOf(const Pieces& room) const {
        std::size_t nearest = bends_.size();
        double depth = std::numeric_limits<double>::max();
        for (const Piece& piece : room)
            if (piece.to.x - piece.from.x > kTiny && std::min(piece.from.y, piece.to.y) < depth) {
                depth = std::min(piece.from.y, piece.to.y);
                nearest = piece.owner;
            }
        return nearest;
    }

    Flap flapOf(std::size_t k) const {
        LineFrame frame = frameOf(k);
        Stretch stretch = stretchOf(k, frame);
        const Stretch back{-stretch.high, -stretch.low, stretch.highAtEdge, stretch.lowAtEdge};
        const LineFrame other = turned(frame);
        const BendLine::Side side = bends_[k].side;
        Pieces room = roomOf(k, frame, stretch);
        Pieces pieces = deepRun(smoothed(room), stretch);
        if (side != BendLine::Side::left) {
            const Pieces roomBehind = roomOf(k, other, back);
            const Pieces behind = deepRun(smoothed(roomBehind), back);
            // Without other lines, so that one beside another bends away from it.
            const bool smaller = !enough(pieces) || sheetAhead(other, back) < sheetAhead(frame, stretch);
            if (side == BendLine::Side::right || (enough(behind) && smaller)) {
                frame = other;
                room = roomBehind;
                pieces = behind;
            }
        }
        if (!enough(pieces))
            throw InvalidInput(subject(k), "its flap has no room before " + ownerName(nearestOf(room)),
                               "a flap is at least 6 mm wide and deep; move the line, or the other one");
        return finished(k, frame, pieces);
    }

    Flap finished(std::size_t k, const LineFrame& frame, const Pieces& pieces) const {
        Flap flap{bends_[k].name, frame, bends_[k].angle, {}, {}, {}};
        flap.rim.emplace_back(pieces.front().from.x, 0.0);
        const auto add = [&](const glm::dvec2& p) {
            if (glm::distance(p, flap.rim.back()) > 1e-3) flap.rim.push_back(p);
        };
        for (const Piece& piece : pieces) {
            add(piece.from);
            add(piece.to);
        }
        add({pieces.back().to.x, 0.0});
        for (const glm::dvec2& p : flap.rim) flap.outline.push_back(frame.page(p));
        flap.cutout = grown(frame, flap.rim, clearance_.slit(), 0.0);
        return flap;
    }

    const std::vector<glm::dvec2>& outline_;
    std::vector<BendLine> bends_; ///< as drawn, but without what crosses one before
    FlapClearance clearance_;
    std::vector<Obstacle> obstacles_; ///< the sheet's edge, then one a line
};

} // namespace

glm::dvec2 LineFrame::local(const glm::dvec2& page) const noexcept {
    return {glm::dot(page - origin, along), glm::dot(page - origin, across)};
}

glm::dvec2 LineFrame::page(const glm::dvec2& local) const noexcept {
    return origin + local.x * along + local.y * across;
}

std::vector<Flap> layOutFlaps(const std::vector<glm::dvec2>& outline, const std::vector<BendLine>& bends,
                              const FlapClearance& clearance) {
    return Layout(outline, bends, clearance).layOut();
}

} // namespace lumorph
