#include "calibration/registration/landmark_match.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "calibration/registration/pose_track.h"

namespace lumorph {

namespace {

constexpr double kLeastArea = 1e-5;      ///< square metres of a triple: 4 mm x 4 mm
constexpr std::size_t kMostTriples = 12; ///< of the model: some points may not have been touched
constexpr double kAlike = 0.0005;        ///< metres of RMS by which two choices count as equal

using Triple = std::array<std::size_t, 3>;

double areaOf(std::span<const glm::dvec3> points, const Triple& t) {
    return 0.5 * glm::length(glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
}

/// The largest triangles: they say most of where everything lies.
std::vector<Triple> largestTriples(std::span<const glm::dvec3> points) {
    std::vector<Triple> triples;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j)
            for (std::size_t k = j + 1; k < points.size(); ++k)
                if (areaOf(points, {i, j, k}) > kLeastArea) triples.push_back({i, j, k});
    std::ranges::sort(triples, std::greater(), [&](const Triple& t) { return areaOf(points, t); });
    if (triples.size() > kMostTriples) triples.resize(kMostTriples);
    return triples;
}

bool rises(const LandmarkMatch& match) {
    std::optional<std::size_t> last;
    for (const auto& place : match.placeOf) {
        if (place && last && *place < *last) return false;
        if (place) last = place;
    }
    return true;
}

class Matcher {
public:
    Matcher(std::span<const glm::dvec3> places, std::span<const glm::dvec3> model, double radius)
        : places_(places), model_(model), radius_(radius) {}

    std::optional<LandmarkMatch> best() {
        for (const Triple& triple : largestTriples(model_)) tryTriple(triple);
        return best_;
    }

private:
    bool asFar(std::size_t p, std::size_t q, std::size_t m, std::size_t n) const {
        const double apart = glm::distance(places_[p], places_[q]), wanted = glm::distance(model_[m], model_[n]);
        return std::abs(apart - wanted) < radius_;
    }

    void tryTriple(const Triple& m) {
        for (std::size_t p = 0; p < places_.size(); ++p)
            for (std::size_t q = 0; q < places_.size(); ++q) {
                if (p == q || !asFar(p, q, m[0], m[1])) continue;
                for (std::size_t r = 0; r < places_.size(); ++r)
                    if (r != p && r != q && asFar(p, r, m[0], m[2]) && asFar(q, r, m[1], m[2])) tryPlaces(m, {p, q, r});
            }
    }

    void tryPlaces(const Triple& m, const Triple& p) {
        const std::array from{places_[p[0]], places_[p[1]], places_[p[2]]};
        const std::array to{model_[m[0]], model_[m[1]], model_[m[2]]};
        if (areaOf(places_, p) < 0.3 * kLeastArea) return;
        LandmarkMatch match = assigned(fitRigid(from, to).toFromFrom);
        // The whole says better where the rest is than three points do.
        for (int round = 0; round < 3 && match.count >= 3; ++round) {
            if (!refit(match)) return;
            match = assigned(match.fit.toFromFrom);
        }
        if (match.count < 3 || !refit(match)) return;
        match.inOrder = rises(match);
        keep(std::move(match));
    }

    LandmarkMatch assigned(const Pose& modelFromPlaces) const {
        LandmarkMatch match;
        match.placeOf.resize(model_.size());
        std::vector<bool> taken(places_.size(), false);
        for (std::size_t m = 0; m < model_.size(); ++m) {
            double nearest = radius_;
            for (std::size_t p = 0; p < places_.size(); ++p)
                if (const double d = glm::distance(modelFromPlaces * places_[p], model_[m]); !taken[p] && d < nearest) {
                    nearest = d;
                    match.placeOf[m] = p;
                }
            if (!match.placeOf[m]) continue;
            taken[*match.placeOf[m]] = true;
            ++match.count;
        }
        return match;
    }

    bool refit(LandmarkMatch& match) const {
        std::vector<glm::dvec3> from, to;
        for (std::size_t m = 0; m < model_.size(); ++m)
            if (match.placeOf[m]) {
                from.push_back(places_[*match.placeOf[m]]);
                to.push_back(model_[m]);
            }
        try {
            match.fit = fitRigid(from, to);
        } catch (const InvalidInput&) { // on a line
            return false;
        }
        return true;
    }

    void keep(LandmarkMatch match) {
        if (!best_ || match.count > best_->count) {
            best_ = std::move(match);
            return;
        }
        if (match.count < best_->count || match.placeOf == best_->placeOf) return;
        const double better = best_->fit.rms - match.fit.rms;
        const bool alike = std::abs(better) < kAlike;
        if (alike ? match.inOrder && !best_->inOrder : better > 0.0)
            best_ = std::move(match);
        else if (alike && !best_->inOrder)
            best_->ambiguous = true;
    }

    std::span<const glm::dvec3> places_, model_;
    double radius_;
    std::optional<LandmarkMatch> best_;
};

} // namespace

std::optional<LandmarkMatch> matchLandmarks(std::span<const glm::dvec3> places, std::span<const glm::dvec3> model,
                                            double radius) {
    return Matcher(places, model, radius).best();
}

} // namespace lumorph
