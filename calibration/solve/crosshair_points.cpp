#include "calibration/solve/crosshair_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "calibration/solve/crosshair_calibration.h"
#include "core/base/error.h"
#include "core/geometry/calibrated_camera.h"

namespace lumorph {

namespace {

constexpr std::size_t kFewest = 6;
constexpr double kSharpEdge = 0.77; // cosine of 40 degrees between the faces of an edge that one sees as such
constexpr double kStraight = -0.9;  // cosine between two edges that go on in one line
constexpr double kApart = 0.012;    // metres between two points that are not taken for one another
constexpr double kFacing = 0.2;     // cosine of the slant up to which light on a face is seen
constexpr double kMoved = 0.002;    // metres
constexpr int kUsualWidth = 1280;
constexpr int kUsualHeight = 800; // of the projector that the choice is made for
constexpr double kThrow = 1.8;    // focal length by width

/// A corner of the device in its raised state.
struct Corner {
    std::uint32_t vertex = 0;
    glm::dvec3 place{0.0};
};

class CornerFinder {
public:
    CornerFinder(const TriangleMesh& mesh, const glm::dvec3& projector) : mesh_(mesh), projector_(projector) {
        for (const glm::uvec3& t : mesh.triangles) {
            const glm::dvec3 a = at(t.x);
            const glm::dvec3 n = glm::cross(at(t.y) - a, at(t.z) - a);
            const double length = glm::length(n);
            normals_.push_back(length > 0.0 ? n / length : glm::dvec3(0.0));
        }
    }

    /// Ends of sharp edges that turn there, that face the projector and are not in shadow.
    [[nodiscard]] std::vector<Corner> corners() const {
        std::vector<Corner> found;
        for (const auto& [vertex, ways] : sharpEdges())
            if (turns(ways) && facesLight(vertex) && !shadowed(vertex)) found.push_back({vertex, at(vertex)});
        return found;
    }

private:
    [[nodiscard]] glm::dvec3 at(std::uint32_t vertex) const { return glm::dvec3(mesh_.positions[vertex]); }

    [[nodiscard]] std::map<std::uint32_t, std::vector<glm::dvec3>> sharpEdges() const {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> first;
        std::map<std::uint32_t, std::vector<glm::dvec3>> edges;
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t a = mesh_.triangles[i][k];
                const std::uint32_t b = mesh_.triangles[i][(k + 1) % 3];
                const auto [place, isNew] = first.try_emplace(std::minmax(a, b), i);
                if (isNew || glm::dot(normals_[i], normals_[place->second]) > kSharpEdge) continue;
                const glm::dvec3 way = glm::normalize(at(b) - at(a));
                edges[a].push_back(way);
                edges[b].push_back(-way);
            }
        return edges;
    }

    [[nodiscard]] static bool turns(const std::vector<glm::dvec3>& ways) {
        for (std::size_t i = 0; i < ways.size(); ++i)
            for (std::size_t k = i + 1; k < ways.size(); ++k)
                if (glm::dot(ways[i], ways[k]) > kStraight) return true;
        return false;
    }

    [[nodiscard]] bool facesLight(std::uint32_t vertex) const {
        const glm::dvec3 light = glm::normalize(projector_ - at(vertex));
        for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
            const glm::uvec3& t = mesh_.triangles[i];
            if ((t.x == vertex || t.y == vertex || t.z == vertex) && glm::dot(normals_[i], light) > kFacing)
                return true;
        }
        return false;
    }

    [[nodiscard]] bool shadowed(std::uint32_t vertex) const {
        constexpr double kOff = 1e-4; // metres, so that faces right at the corner are none before it
        const glm::dvec3 way = projector_ - at(vertex);
        const glm::dvec3 from = at(vertex) + kOff * glm::normalize(way);
        for (const glm::uvec3& t : mesh_.triangles) {
            if (t.x == vertex || t.y == vertex || t.z == vertex) continue;
            const glm::dvec3 a = at(t.x);
            const glm::dvec3 ab = at(t.y) - a;
            const glm::dvec3 ac = at(t.z) - a;
            const glm::dvec3 p = glm::cross(way, ac);
            const double determinant = glm::dot(ab, p);
            if (std::abs(determinant) < 1e-15) continue;
            const glm::dvec3 s = from - a;
            const double u = glm::dot(s, p) / determinant;
            const glm::dvec3 q = glm::cross(s, ab);
            const double v = glm::dot(way, q) / determinant;
            if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && glm::dot(ac, q) / determinant > 0.0) return true;
        }
        return false;
    }

    const TriangleMesh& mesh_;
    glm::dvec3 projector_;
    std::vector<glm::dvec3> normals_;
};

/// A projector as many are, that looks at the device's middle; for the choice alone.
PoseVector poseLookingAt(const glm::dvec3& from, const glm::dvec3& middle) {
    const glm::dmat4 matrix = cameraLookingAt(from, middle, {kUsualWidth, kUsualHeight}, 1.0).cameraFromWorld;
    return (Rigid(matrix) * Rigid(glm::dmat3(1.0), middle)).log();
}

/// Chooses the corners whose crosshairs leave the light of no corner uncertain.
class CornerChoice {
public:
    CornerChoice(std::vector<Corner> corners, const glm::dvec3& projector) : corners_(std::move(corners)) {
        glm::dvec3 middle(0.0);
        for (const Corner& corner : corners_) middle += corner.place / static_cast<double>(corners_.size());
        const PoseVector pose = poseLookingAt(projector, middle);
        const Lens lens{kThrow * kUsualWidth, 1.0, 0.5 * kUsualWidth, 0.5 * kUsualHeight, 0, 0, 0, 0, 0};
        LensMask free{};
        free[kFocalLength] = free[kPrincipalX] = free[kPrincipalY] = true;
        for (const Corner& corner : corners_) {
            const glm::dvec3 from = corner.place - middle;
            rows_.push_back(
                crosshairJacobian(lens, free, cv::Size(kUsualWidth, kUsualHeight), pose, {from.x, from.y, from.z}));
        }
    }

    /// One after another, then each exchanged for another while that helps.
    [[nodiscard]] std::vector<Corner> best(std::size_t most) const {
        std::vector<std::size_t> chosen;
        while (chosen.size() < most && improve(chosen, chosen.size())) {
        }
        constexpr int kRounds = 4;
        for (int round = 0; round < kRounds; ++round) {
            bool better = false;
            for (std::size_t i = 0; i < chosen.size(); ++i) better = improve(chosen, i) || better;
            if (!better) break;
        }
        std::vector<Corner> corners;
        for (const std::size_t i : chosen) corners.push_back(corners_[i]);
        return corners;
    }

private:
    /// Puts the best corner in a place of the choice, or at its end; whether that is another than before.
    bool improve(std::vector<std::size_t>& chosen, std::size_t place) const {
        Eigen::Matrix<double, 15, 15> normal = Eigen::Matrix<double, 15, 15>::Identity();
        for (int i = 0; i < 3; ++i) normal(12 + i, 12 + i) = 0.1; // metres: hardly anything is known of the pose
        for (std::size_t k = 0; k < chosen.size(); ++k)
            if (k != place) normal += rows_[chosen[k]].transpose() * rows_[chosen[k]];
        const std::size_t before = place < chosen.size() ? chosen[place] : corners_.size();
        std::size_t best = before;
        double least = before < corners_.size() ? 0.999 * uncertaintyWith(normal, before)
                                                : std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            if (i == before || isTaken(chosen, place, i)) continue;
            const double uncertainty = uncertaintyWith(normal, i);
            if (uncertainty >= least) continue;
            least = uncertainty;
            best = i;
        }
        if (best == before) return false;
        if (place < chosen.size())
            chosen[place] = best;
        else
            chosen.push_back(best);
        return true;
    }

    [[nodiscard]] bool isTaken(const std::vector<std::size_t>& chosen, std::size_t place, std::size_t i) const {
        for (std::size_t k = 0; k < chosen.size(); ++k)
            if (k != place && glm::distance(corners_[chosen[k]].place, corners_[i].place) < kApart) return true;
        return false;
    }

    /// Of the light at all corners: the mean, and the worst.
    [[nodiscard]] double uncertaintyWith(const Eigen::Matrix<double, 15, 15>& normal, std::size_t more) const {
        const Eigen::Matrix<double, 15, 15> covariance =
            (normal + rows_[more].transpose() * rows_[more]).ldlt().solve(Eigen::Matrix<double, 15, 15>::Identity());
        double sum = 0.0;
        double worst = 0.0;
        for (const auto& row : rows_) {
            const double variance = (row * covariance).cwiseProduct(row).sum();
            sum += variance;
            worst = std::max(worst, variance);
        }
        return sum / static_cast<double>(rows_.size()) + worst;
    }

    std::vector<Corner> corners_;
    std::vector<Eigen::Matrix<double, 2, 15>> rows_;
};

/// The actuator that moved a vertex most, or the side of the body where it lies.
std::string nameOf(const Rig& rig, const Corner& corner) {
    const glm::dvec3 rest(rig.restMesh().positions[corner.vertex]);
    const auto movers = rig.actuatorsOf(corner.vertex);
    if (!movers.empty() && glm::distance(rest, corner.place) > kMoved)
        return rig.actuators()[movers.front()].name + ", raised";
    const glm::vec3 middle = boundingBox(rig.restMesh().positions).centre();
    const std::string side = corner.place.z > middle.z ? "front" : "back";
    return "body, " + side + (corner.place.x > middle.x ? " right" : " left");
}

} // namespace

DevicePoints proposeDevicePoints(const Rig& rig, const cv::Point3d& projector, int most) {
    const glm::dvec3 from(projector.x, projector.y, projector.z);
    const Box box = boundingBox(rig.restMesh().positions);
    const double away = glm::distance(from, glm::dvec3(box.centre()));
    if (!std::isfinite(away) || !(away > glm::length(box.size())))
        throw InvalidInput("projector", "it stands within the device",
                           "give its place in the device's frame, in metres");
    DevicePoints proposal;
    proposal.strokes.assign(rig.actuatorCount(), 1.0);
    const TriangleMesh raised = deformed(rig, proposal.strokes);
    const std::vector<Corner> corners = CornerFinder(raised, from).corners();
    std::vector<Corner> chosen;
    if (corners.size() >= kFewest)
        chosen = CornerChoice(corners, from).best(static_cast<std::size_t>(std::max(most, 0)));
    if (chosen.size() < kFewest)
        throw InvalidInput("device", "fewer than six of its corners are lit from there",
                           "name points of it yourself, or put marks on it");
    std::map<std::string, int> times;
    for (const Corner& corner : chosen) {
        std::string name = nameOf(rig, corner);
        const int time = ++times[name];
        if (time > 1) name += " (" + std::to_string(time) + ")";
        proposal.points.push_back({name, {corner.place.x, corner.place.y, corner.place.z}});
    }
    return proposal;
}

} // namespace lumorph
