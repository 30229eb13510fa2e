#include "calibration/servos/stroke_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "calibration/registration/nearest_surface.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr int kPlaceUnknowns = 6;
constexpr int kMostIterations = 25;
constexpr double kSettled = 2e-5;      // strokes
constexpr double kProbe = 2e-3;        // strokes by which the surface is moved to see where it goes
constexpr double kLongestStep = 0.12;  // strokes an iteration
constexpr double kPointSigma = 2e-4;   // metres: what the points tremble by at least
constexpr double kStrokeSigma = 0.3;   // of the guess: keeps what no point tells where it is
constexpr double kBesideDevice = 0.02; // metres around all that the rig reaches
constexpr double kAboveTable = 0.0012; // metres: what is lower may be the table
constexpr double kFar = 0.015;         // metres: no point counts for more when start values are compared
constexpr double kWideGate = 0.012;    // metres: points that are farther away do not count, at first
constexpr double kNarrowGate = 0.0015; // and at last
constexpr double kFits = 0.0012;       // metres: mean distance above which a fit is not believed
constexpr int kSearchPoints = 350;
constexpr int kSearchSteps = 7;

Eigen::Vector3d eigenOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

} // namespace

struct StrokeSolver::Data {
    using Strokes = std::vector<double>;

    Rig rig;
    glm::dmat4 worldFromDevice, deviceFromWorld;
    NearestSurface surface;
    std::vector<glm::vec3> positions;
    std::vector<std::vector<glm::vec3>> moved; ///< by each actuator, moved by kProbe
    std::vector<double> probes;                ///< its size and direction
    std::vector<MeasuredPoint> points;         ///< on the device, in its frame

    Data(const Rig& r, const glm::dmat4& place)
        : rig(r), worldFromDevice(place), deviceFromWorld(glm::inverse(place)), surface(r.restMesh()),
          positions(r.restMesh().positions.size()), moved(r.actuatorCount(), positions), probes(r.actuatorCount()) {}

    void take(std::span<const MeasuredPoint> seen);
    void standAt(const Strokes& strokes);
    void probe(const Strokes& strokes);
    [[nodiscard]] double misfit(const Strokes& strokes, const DeviceNudge& place, std::size_t stride);
    [[nodiscard]] Strokes search(Strokes strokes, const DeviceNudge& place);
    struct System {
        Eigen::MatrixXd normal;
        Eigen::VectorXd right;
        double squares = 0.0, weight = 0.0;
        int inliers = 0;
    };
    [[nodiscard]] System build(const Strokes& strokes, const DeviceNudge& place, const DeviceNudge& prior, double gate);
    [[nodiscard]] double addPoint(const MeasuredPoint& point, const DeviceNudge& place, double gate, System& system,
                                  Eigen::VectorXd& row) const;
    [[nodiscard]] StrokeEstimate refine(Strokes strokes, const DeviceNudge& prior, double misfitNow);
    [[nodiscard]] static glm::dvec3 nudged(const glm::dvec3& point, const DeviceNudge& place) {
        return point + glm::cross(place.turn, point) + place.shift;
    }
};

/// Keeps what can be the device's: the table is seen too, and what lies about.
void StrokeSolver::Data::take(std::span<const MeasuredPoint> seen) {
    points.clear();
    const glm::dvec3 low = glm::dvec3(rig.reach().min) - kBesideDevice;
    const glm::dvec3 high = glm::dvec3(rig.reach().max) + kBesideDevice;
    for (const MeasuredPoint& one : seen) {
        if (!isFinite(one.place) || !(one.weight > 0.0) || one.place.y < kAboveTable) continue;
        const glm::dvec3 local(deviceFromWorld * glm::dvec4(one.place, 1.0));
        const bool inside = glm::all(glm::greaterThan(local, low)) && glm::all(glm::lessThan(local, high));
        if (inside) points.push_back({local, one.weight});
    }
}

void StrokeSolver::Data::standAt(const Strokes& strokes) {
    rig.deform(strokes, positions);
    surface.move(positions);
}

/// Where each actuator alone would move the surface.
void StrokeSolver::Data::probe(const Strokes& strokes) {
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        Strokes other = strokes;
        probes[i] = strokes[i] > 0.5 ? -kProbe : kProbe;
        other[i] += probes[i];
        rig.deform(other, moved[i]);
    }
}

/// Mean distance of the points, far ones counting no more than kFar.
double StrokeSolver::Data::misfit(const Strokes& strokes, const DeviceNudge& place, std::size_t stride) {
    standAt(strokes);
    double sum = 0.0;
    int count = 0;
    for (std::size_t k = 0; k < points.size(); k += stride) {
        const auto found = surface.of(nudged(points[k].place, place), kFar);
        sum += found ? found->distance : kFar;
        ++count;
    }
    return count > 0 ? sum / count : kFar;
}

/// One actuator after the other through all its strokes, twice, since parts stand on parts.
StrokeSolver::Data::Strokes StrokeSolver::Data::search(Strokes strokes, const DeviceNudge& place) {
    const std::size_t stride = std::max<std::size_t>(1, points.size() / kSearchPoints);
    double best = misfit(strokes, place, stride);
    for (int round = 0; round < 2; ++round) {
        const Strokes before = strokes;
        for (std::size_t i = 0; i < strokes.size(); ++i)
            for (int k = 0; k < kSearchSteps; ++k) {
                Strokes other = strokes;
                other[i] = k / (kSearchSteps - 1.0);
                const double now = misfit(other, place, stride);
                if (now >= best - 1e-5) continue;
                best = now;
                strokes = other;
            }
        if (strokes == before) break;
    }
    return strokes;
}

/// Adds what one point says; returns its distance along the normal, or NaN where it does not count.
double StrokeSolver::Data::addPoint(const MeasuredPoint& point, const DeviceNudge& place, double gate, System& system,
                                    Eigen::VectorXd& row) const {
    const glm::dvec3 at = nudged(point.place, place);
    const auto found = surface.of(at, gate);
    if (!found) return std::numeric_limits<double>::quiet_NaN();
    const glm::uvec3& corners = rig.restMesh().triangles[found->triangle];
    glm::dvec3 nearest(0.0);
    for (int c = 0; c < 3; ++c) nearest += found->shares[c] * glm::dvec3(positions[corners[c]]);
    const double off = glm::dot(found->normal, at - nearest);
    const std::size_t count = moved.size();
    int movers = 0;
    for (std::size_t i = 0; i < count; ++i) {
        glm::dvec3 way(0.0);
        for (int c = 0; c < 3; ++c) way += found->shares[c] * glm::dvec3(moved[i][corners[c]] - positions[corners[c]]);
        const double slope = -glm::dot(found->normal, way) / probes[i];
        row[static_cast<Eigen::Index>(i)] = slope;
        movers += std::abs(slope) > 1e-4 ? 1 : 0;
    }
    const auto placeAt = static_cast<Eigen::Index>(count);
    row.segment<3>(placeAt) = eigenOf(glm::cross(point.place, found->normal));
    row.segment<3>(placeAt + 3) = eigenOf(found->normal);
    const double ratio = off / gate;
    const double robust = (1.0 - ratio * ratio) * (1.0 - ratio * ratio); // Tukey's weight
    const double weight = point.weight * robust / (std::max(movers, 1) * kPointSigma * kPointSigma);
    system.normal.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    system.right -= weight * off * row;
    system.squares += robust * off * off;
    system.weight += robust;
    ++system.inliers;
    return off;
}

StrokeSolver::Data::System StrokeSolver::Data::build(const Strokes& strokes, const DeviceNudge& place,
                                                     const DeviceNudge& prior, double gate) {
    standAt(strokes);
    probe(strokes);
    const auto size = static_cast<Eigen::Index>(strokes.size()) + kPlaceUnknowns;
    System system{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
    Eigen::VectorXd row(size);
    for (const MeasuredPoint& point : points) static_cast<void>(addPoint(point, place, gate, system, row));
    system.normal.triangularView<Eigen::Upper>() = system.normal.transpose();
    const auto pull = [&](Eigen::Index at, double off, double sigma) {
        system.normal(at, at) += 1.0 / (sigma * sigma);
        system.right[at] -= off / (sigma * sigma);
    };
    const auto first = static_cast<Eigen::Index>(strokes.size());
    for (Eigen::Index i = 0; i < first; ++i) pull(i, 0.0, kStrokeSigma);
    for (int c = 0; c < 3; ++c) {
        pull(first + c, place.turn[c] - prior.turn[c], prior.turnSigma);
        pull(first + 3 + c, place.shift[c] - prior.shift[c], prior.shiftSigma);
    }
    return system;
}

/// From a start with that misfit: the gate is as wide as that asks for, and narrows as the steps become short.
StrokeEstimate StrokeSolver::Data::refine(Strokes strokes, const DeviceNudge& prior, double misfitNow) {
    StrokeEstimate result;
    DeviceNudge place = prior;
    const std::size_t count = strokes.size();
    double gate = std::clamp(4.0 * misfitNow, 2.0 * kNarrowGate, kWideGate);
    for (int k = 0; k < kMostIterations; ++k) {
        const System system = build(strokes, place, prior, gate);
        const Eigen::LDLT<Eigen::MatrixXd> factors(system.normal);
        const Eigen::VectorXd step = factors.solve(system.right);
        double longest = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const double by = std::clamp(step[static_cast<Eigen::Index>(i)], -kLongestStep, kLongestStep);
            const double next = std::clamp(strokes[i] + by, 0.0, 1.0);
            longest = std::max(longest, std::abs(next - strokes[i]));
            strokes[i] = next;
        }
        for (int c = 0; c < 3; ++c) {
            place.turn[c] += step[static_cast<Eigen::Index>(count) + c];
            place.shift[c] += step[static_cast<Eigen::Index>(count) + 3 + c];
        }
        const bool narrow = gate <= kNarrowGate;
        if (narrow && longest < kSettled) break;
        if (longest < 0.02) gate = std::max(kNarrowGate, 0.5 * gate);
    }
    const System system = build(strokes, place, prior, kNarrowGate);
    const Eigen::MatrixXd spread =
        system.normal.ldlt().solve(Eigen::MatrixXd::Identity(system.normal.rows(), system.normal.cols()));
    result.rms = system.weight > 0.0 ? std::sqrt(system.squares / system.weight) : 0.0;
    const double scale = std::max(1.0, result.rms / kPointSigma);
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        result.sigma.push_back(scale * std::sqrt(std::max(0.0, spread(at, at))));
    }
    result.strokes = std::move(strokes);
    result.place = place;
    result.points = static_cast<int>(points.size());
    result.share = points.empty() ? 0.0 : static_cast<double>(system.inliers) / static_cast<double>(points.size());
    return result;
}

StrokeSolver::StrokeSolver(const Rig& rig, const glm::dmat4& worldFromDevice) {
    if (rig.actuatorCount() == 0) throw InvalidInput("rig", "it has no actuators", "open a rig that moves");
    data_ = std::make_unique<Data>(rig, worldFromDevice);
}

StrokeSolver::~StrokeSolver() = default;
StrokeSolver::StrokeSolver(StrokeSolver&&) noexcept = default;
StrokeSolver& StrokeSolver::operator=(StrokeSolver&&) noexcept = default;

std::optional<StrokeEstimate> StrokeSolver::solve(std::span<const MeasuredPoint> points,
                                                  std::span<const std::vector<double>> guesses,
                                                  const DeviceNudge& place, bool thoroughly) {
    Data& d = *data_;
    const std::size_t count = d.rig.actuatorCount();
    for (const auto& guess : guesses)
        if (guess.size() != count)
            throw InvalidInput("strokes to begin from",
                               std::to_string(guess.size()) + " for " + std::to_string(count) + " actuators",
                               "give one for each actuator");
    d.take(points);
    if (d.points.size() < kFewest) return std::nullopt;
    const std::size_t stride = std::max<std::size_t>(1, d.points.size() / kSearchPoints);
    std::vector<double> start(count, 0.0);
    double best = d.misfit(start, place, stride);
    for (const auto& guess : guesses) {
        const double now = d.misfit(guess, place, stride);
        if (now >= best) continue;
        best = now;
        start = guess;
    }
    if (thoroughly) start = d.search(start, place);
    StrokeEstimate found = d.refine(start, place, thoroughly ? kFar : best);
    if (thoroughly || d.misfit(found.strokes, found.place, stride) < kFits) return found;
    return d.refine(d.search(found.strokes, place), place, kFar);
}

} // namespace lumorph
