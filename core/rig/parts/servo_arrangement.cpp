#include "core/rig/parts/servo_arrangement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/plane_mesh.h"

namespace lumorph {
namespace {

// Millimetres.
constexpr double kApart = 0.6;      ///< between neighbours under the lid
constexpr double kBeside = 0.8;     ///< of a lever on either side
constexpr double kStep = 3.0;       ///< between places that are tried along a bend line
constexpr double kPostInside = 4.2; ///< of its middle, from the border: it stands in the wall
constexpr double kPostsApart = 70.0;
constexpr std::size_t kMostPosts = 12;
constexpr glm::dvec2 kBoard{33.0, 18.0}; ///< of an Arduino Pro Mini
constexpr double kCable = 10.0;
constexpr double kWireHole = 3.0;
constexpr std::size_t kMostTries = 100'000;
constexpr std::size_t kCandidates = 96; ///< a flap

/// Whether a line along a side of the first parts the convex polygons by `apart`.
bool partedBySide(const PlanePolygon& a, const PlanePolygon& b, double apart) {
    const double way = turnOf(a[1] - a[0], a[2] - a[1]) > 0.0 ? 1.0 : -1.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const glm::dvec2 side = a[(k + 1) % a.size()] - a[k];
        const double length = glm::length(side);
        if (length < 1e-9) continue;
        if (std::ranges::all_of(b,
                                [&](const glm::dvec2& p) { return -way * turnOf(side, p - a[k]) >= apart * length; }))
            return true;
    }
    return false;
}

bool apart(const PlanePolygon& a, const PlanePolygon& b, double distance = kApart) {
    return partedBySide(a, b, distance) || partedBySide(b, a, distance);
}

bool within(const PlanePolygon& convex, const PlanePolygon& polygon) {
    return convex.size() > 2 && std::ranges::all_of(polygon, [&](const auto& p) { return insidePolygon(convex, p); });
}

/// A place for one servo, and how good it is.
struct Candidate {
    PlacedServo servo;
    std::vector<PlanePolygon> areas;
    double score = 0.0; ///< less is better
};

class Arranger {
public:
    Arranger(const SheetLayout& sheet, const std::vector<std::string>& names, const PartOptions& options,
             const HousingHeights& heights, const BedSplit& split)
        : sheet_(sheet), names_(names), options_(options), heights_(heights), seat_(options.servo, options.tolerance),
          taken_(split.strips()), room_(shrunk(sheet.housing, HousingHeights::kWall + 0.4)),
          lid_(shrunk(sheet.housing, 1.2)) {}

    HousingArrangement arrange() {
        for (std::size_t f = 0; f < sheet_.flaps.size(); ++f) candidates_.push_back(candidatesOf(f));
        std::vector<bool> searched(candidates_.size(), false);
        const auto lookElsewhere = [&](std::size_t f) {
            std::vector<Candidate> more = candidatesElsewhere(f);
            candidates_[f].insert(candidates_[f].end(), more.begin(), more.end());
            searched[f] = true;
        };
        for (std::size_t f = 0; f < candidates_.size(); ++f)
            if (candidates_[f].empty()) lookElsewhere(f);
        if (!placeAll()) {
            for (std::size_t f = 0; f < candidates_.size(); ++f)
                if (!searched[f]) lookElsewhere(f);
            if (!placeAll())
                throw InvalidInput(names_[order_[std::min(deepest_, order_.size() - 1)]],
                                   "its servo has no room in the housing beside the others",
                                   "choose a smaller servo, a larger device or fewer actuators");
        }
        HousingArrangement result;
        for (std::size_t f = 0; f < candidates_.size(); ++f) result.servos.push_back(candidates_[f][chosen_[f]].servo);
        for (const PlacedServo& servo : result.servos) result.leverless += servo.lever ? 0 : 1;
        placeBoard(result);
        for (const PlacedServo& servo : result.servos) taken_.push_back(servo.slot); // of no concern to seats and board
        placePosts(result);
        return result;
    }

private:
    [[nodiscard]] std::vector<Candidate> candidatesOf(std::size_t index) const {
        const SheetFlap& flap = sheet_.flaps[index];
        std::vector<Candidate> candidates;
        if (flap.captive) {
            const auto lever = captiveLever(*flap.captive, heights_.below);
            for (const double side : {1.0, -1.0})
                for (const double out : {1.0, -1.0})
                    if (lever) addCandidate(index, 0.0, *lever, side, out, candidates);
            return candidates;
        }
        const double middle = 0.5 * (flap.low + flap.high);
        for (double along = middle; along < flap.high - kStep; along += kStep)
            for (const double w : {along, 2.0 * middle - along}) {
                const double depth = std::min({flap.depthAt(w), flap.depthAt(w - kStep), flap.depthAt(w + kStep)});
                const auto lever = leverFor(flap, sheet_.top - sheet_.underside, depth, heights_.below, options_.servo,
                                            options_.tolerance);
                if (!lever) continue;
                for (const double side : {1.0, -1.0})
                    for (const double out : {1.0, -1.0}) addCandidate(index, w, *lever, side, out, candidates);
            }
        keepBest(candidates);
        return candidates;
    }

    static void keepBest(std::vector<Candidate>& candidates) {
        std::ranges::stable_sort(candidates, {}, &Candidate::score);
        if (candidates.size() > kCandidates) candidates.erase(candidates.begin() + kCandidates, candidates.end());
    }

    /// Without a lever a servo may lie anywhere, the nearer the better.
    [[nodiscard]] std::vector<Candidate> candidatesElsewhere(std::size_t index) const {
        std::vector<Candidate> candidates;
        const SheetFlap& flap = sheet_.flaps[index];
        const double middle = 0.5 * (flap.low + flap.high);
        const glm::dvec2 goal = flap.frame.page({middle, 0.0});
        const glm::dvec2 hole(middle, flap.captive ? 0.0 : 0.5 * flap.depthAt(middle));
        PlanePolygon wire = rectangle(hole - 0.5 * kWireHole, hole + 0.5 * kWireHole);
        for (glm::dvec2& p : wire) p = flap.frame.page(p);
        const auto [low, high] = Region().add(sheet_.housing).bounds();
        for (double x = low.x; x < high.x; x += kStep)
            for (double y = low.y; y < high.y; y += kStep)
                for (const glm::dvec2 side : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
                    for (const double hand : {1.0, -1.0}) {
                        Candidate candidate;
                        PlacedServo& servo = candidate.servo;
                        servo.flap = index;
                        servo.slot = wire;
                        servo.seat = {{x, y}, side, hand * glm::dvec2(-side.y, side.x)};
                        candidate.score = glm::distance(servo.seat.page({0.0, leverPlane(options_.servo)}), goal);
                        const double hub = leverHub(options_.servo, options_.tolerance);
                        candidate.areas = {servo.seat.page(seat_.outline()),
                                           servo.seat.page(rectangle({-hub, options_.servo.height},
                                                                     {hub, options_.servo.hornTop + 1.0}))};
                        if (within(room_, candidate.areas[0]) && within(lid_, candidate.areas[1]) &&
                            fits(candidate.areas, taken_))
                            candidates.push_back(std::move(candidate));
                    }
        keepBest(candidates);
        return candidates;
    }

    void addCandidate(std::size_t index, double w, const Lever& lever, double side, double out,
                      std::vector<Candidate>& candidates) const {
        const SheetFlap& flap = sheet_.flaps[index];
        Candidate candidate;
        PlacedServo& servo = candidate.servo;
        servo.flap = index;
        servo.lever = lever;
        servo.seat.side = side * flap.frame.across;
        servo.seat.out = out * flap.frame.along;
        servo.seat.shaft = flap.frame.page({w, lever.pivot}) - servo.seat.out * leverPlane(options_.servo);
        const double hub = leverHub(options_.servo, options_.tolerance);
        const double half = 0.5 * Lever::kThickness + kBeside;
        const auto box = [&](double from, double to) {
            PlanePolygon polygon = rectangle({w - half, from}, {w + half, to});
            for (glm::dvec2& p : polygon) p = flap.frame.page(p);
            return polygon;
        };
        servo.slot = box(lever.pivot - hub - 0.5, lever.reach() + 0.8);
        const PlanePolygon shaft = rectangle({-hub, options_.servo.height}, {hub, leverPlane(options_.servo)});
        candidate.areas = {servo.seat.page(seat_.outline()), servo.seat.page(shaft), servo.slot};
        if (!within(room_, candidate.areas[0]) || !within(lid_, servo.slot)) return;
        if (!fits(candidate.areas, taken_)) return;
        candidate.score = 90.0 - lever.lifted.inDegrees() + 0.2 * std::abs(w - 0.5 * (flap.low + flap.high));
        candidates.push_back(std::move(candidate));
    }

    static bool fits(const std::vector<PlanePolygon>& areas, const std::vector<PlanePolygon>& taken) {
        for (const PlanePolygon& area : areas)
            for (const PlanePolygon& other : taken)
                if (!apart(area, other)) return false;
        return true;
    }

    /// Those with the fewest places first.
    bool placeAll() {
        order_.resize(candidates_.size());
        std::iota(order_.begin(), order_.end(), 0);
        std::ranges::sort(order_, {}, [&](std::size_t f) { return candidates_[f].size(); });
        chosen_.assign(candidates_.size(), 0);
        deepest_ = tries_ = 0;
        return place(0);
    }

    bool place(std::size_t k) {
        deepest_ = std::max(deepest_, k);
        if (k == order_.size()) return true;
        const std::vector<Candidate>& candidates = candidates_[order_[k]];
        for (std::size_t c = 0; c < candidates.size(); ++c) {
            if (++tries_ > kMostTries) return false;
            if (!fits(candidates[c].areas, taken_)) continue;
            const std::size_t before = taken_.size();
            taken_.insert(taken_.end(), candidates[c].areas.begin(), candidates[c].areas.end());
            chosen_[order_[k]] = c;
            if (place(k + 1)) return true;
            taken_.resize(before);
        }
        return false;
    }

    /// Nearest to the border, so that its cable is short.
    void placeBoard(HousingArrangement& result) {
        const glm::dvec2 half = 0.5 * kBoard + options_.tolerance + HousingArrangement::kBoardRim;
        double best = std::numeric_limits<double>::max();
        for (const bool upright : {false, true}) {
            const glm::dvec2 size = upright ? glm::dvec2(half.y, half.x) : half;
            for (double x = -1000.0; x <= 1000.0; x += 2.5)
                for (double y = -1000.0; y <= 1000.0; y += 2.5) {
                    const glm::dvec2 at(x, y);
                    if (!insidePolygon(room_, at)) continue;
                    const PlanePolygon rim = rectangle(at - size, at + size);
                    const auto [distance, opening] = nearestSide(at);
                    if (distance >= best || !within(room_, rim) || !fits({rim}, taken_)) continue;
                    best = distance;
                    result.board = shrunk(rim, HousingArrangement::kBoardRim);
                    result.cable = opening;
                }
        }
        if (result.board)
            taken_.push_back(rectangle((*result.board)[0] - HousingArrangement::kBoardRim,
                                       (*result.board)[2] + HousingArrangement::kBoardRim));
        else
            result.cable = nearestSide({0.0, 0.0}).second;
        taken_.push_back(result.cable);
    }

    /// The side of the housing whose middle is nearest, and an opening there.
    [[nodiscard]] std::pair<double, PlanePolygon> nearestSide(const glm::dvec2& from) const {
        double best = std::numeric_limits<double>::max();
        PlanePolygon opening;
        const PlanePolygon& border = sheet_.housing;
        double longest = 0.0;
        for (std::size_t k = 0; k < border.size(); ++k)
            longest = std::max(longest, glm::distance(border[k], border[(k + 1) % border.size()]));
        for (std::size_t k = 0; k < border.size(); ++k) {
            const glm::dvec2 side = border[(k + 1) % border.size()] - border[k];
            if (glm::length(side) < std::min(2.0 * kCable, longest)) continue;
            const glm::dvec2 middle = border[k] + 0.5 * side;
            if (glm::distance(middle, from) >= best) continue;
            best = glm::distance(middle, from);
            const glm::dvec2 way = glm::normalize(side);
            const glm::dvec2 in(-way.y, way.x);
            const glm::dvec2 reach = 0.5 * kCable * way;
            opening = {middle - reach - in, middle + reach - in, middle + reach + 4.0 * in, middle - reach + 4.0 * in};
        }
        return {best, opening};
    }

    void placePosts(HousingArrangement& result) {
        std::vector<glm::dvec2> places;
        const PlanePolygon line = shrunk(sheet_.housing, kPostInside);
        for (std::size_t k = 0; k < line.size(); ++k) {
            const glm::dvec2 side = line[(k + 1) % line.size()] - line[k];
            const int steps = 1 + static_cast<int>(glm::length(side) / 4.0);
            for (int s = 0; s < steps; ++s) {
                const glm::dvec2 at = line[k] + side * (static_cast<double>(s) / steps);
                if (fits({rectangle(at - HousingArrangement::kPost, at + HousingArrangement::kPost)}, taken_))
                    places.push_back(at);
            }
        }
        while (!places.empty() && result.posts.size() < kMostPosts) {
            const auto distance = [&](const glm::dvec2& p) {
                double least = std::numeric_limits<double>::max();
                for (const glm::dvec2& post : result.posts) least = std::min(least, glm::distance(p, post));
                return least;
            };
            const auto next = result.posts.empty() ? places.begin() : std::ranges::max_element(places, {}, distance);
            if (result.posts.size() >= 4 && distance(*next) < kPostsApart) break;
            if (!result.posts.empty() && distance(*next) < 4.0 * HousingArrangement::kPost) break;
            result.posts.push_back(*next);
        }
        if (result.posts.size() < 2)
            throw InvalidInput("housing", "there is no room for screws that hold its lid",
                               "choose a smaller servo, a larger device or fewer actuators");
    }

    const SheetLayout& sheet_;
    const std::vector<std::string>& names_;
    const PartOptions& options_;
    const HousingHeights& heights_;
    ServoSeat seat_;
    std::vector<PlanePolygon> taken_;
    PlanePolygon room_; ///< for seats and board
    PlanePolygon lid_;  ///< for levers and their slots
    std::vector<std::vector<Candidate>> candidates_;
    std::vector<std::size_t> order_;
    std::vector<std::size_t> chosen_;
    std::size_t deepest_ = 0;
    std::size_t tries_ = 0;
};

} // namespace

HousingHeights::HousingHeights(const SheetLayout& sheet, const ServoSeat& seat, const ServoBody& body)
    : tray(std::max(sheet.ledge - kLid, kFloor + seat.thickness())),
      plinth(ServoSeat::plinthOf(tray - kFloor - seat.thickness())),
      below(tray + kLid + sheet.underside - sheet.ledge - kFloor - plinth - 0.5 * body.width),
      deeper(tray + kLid - sheet.ledge) {}

HousingArrangement arrangeHousing(const SheetLayout& sheet, const std::vector<std::string>& names,
                                  const PartOptions& options, const HousingHeights& heights, const BedSplit& split) {
    return Arranger(sheet, names, options, heights, split).arrange();
}

} // namespace lumorph
