#include "core/rig/state_judge.h"

#include <algorithm>
#include <map>

#include <glm/geometric.hpp>

#include "core/geometry/mesh_check.h"
#include "core/geometry/mesh_topology.h"
#include "core/geometry/triangle_area.h"
#include "core/rig/shape_report.h"

namespace lumorph {
namespace {

using Kind = RigFinding::Kind;

constexpr double kGap = 1e-6; ///< metres; a seam may gape by so much, from rounding
constexpr std::size_t kMostCrossings = 4096;
constexpr double kSpeedStep = 1.0 / 1024.0; ///< strokes to both sides, over which a speed is measured

std::pair<std::uint32_t, std::uint32_t> pairOf(const TriangleCrossing& crossing) {
    return std::minmax(crossing.first, crossing.second);
}

glm::vec3 centreOf(const TriangleMesh& mesh, std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    return (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0F;
}

/// Six times the volume between a triangle and the origin.
double sixVolumes(const std::vector<glm::vec3>& positions, const glm::uvec3& t) {
    return glm::dot(glm::dvec3(positions[t.x]), glm::cross(glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z])));
}

double diagonalOf(const Box& box) { return static_cast<double>(glm::length(box.size())); }

} // namespace

bool meet(const Box& a, const Box& b) {
    for (int k = 0; k < 3; ++k)
        if (a.min[k] > b.max[k] || b.min[k] > a.max[k]) return false;
    return !a.empty() && !b.empty();
}

RestShape::RestShape(const Rig& rig, const RigCheckOptions& options) : rig_(rig), options_(options) {
    const TriangleMesh& mesh = rig_.restMesh();
    findEdges();
    findSeams();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) flat_.push_back(isFlat(mesh, t));
    std::vector<std::uint32_t> all(mesh.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    for (const TriangleCrossing& crossing : findCrossings(mesh, all, {}, kMostCrossings)) {
        crossing_.insert(pairOf(crossing));
        crossingBox_.include(crossing.where);
        if (pieceOf_[crossing.first] != pieceOf_[crossing.second])
            overlapping_.insert(std::minmax(pieceOf_[crossing.first], pieceOf_[crossing.second]));
    }
}

void RestShape::findEdges() {
    const TriangleMesh& mesh = rig_.restMesh();
    std::set<std::pair<std::uint32_t, std::uint32_t>> ends;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        // Skirts and bellows stretch by design; what counts is the sheet that is looked at.
        if (!facesUp(mesh, t)) continue;
        for (int k = 0; k < 3; ++k) ends.insert(std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]));
    }
    for (const auto& [from, to] : ends) {
        const double length = glm::distance(glm::dvec3(mesh.positions[from]), glm::dvec3(mesh.positions[to]));
        if (length > 0.0) shown_.push_back({from, to, length});
    }
}

void RestShape::findSeams() {
    const TriangleMesh& mesh = rig_.restMesh();
    const MeshTopology topology = meshTopology(mesh);
    std::set<std::pair<std::uint32_t, std::uint32_t>> seams;
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
        if (a != b) seams.insert(std::minmax(a, b));
    };
    for (std::uint32_t h = 0; h < topology.partner.size(); ++h) {
        const std::uint32_t across = topology.partner[h];
        if (across == MeshTopology::kNone) continue;
        const std::uint32_t ends[] = {vertexAt(mesh, across), vertexAt(mesh, nextInTriangle(across))};
        for (const std::uint32_t mine : {vertexAt(mesh, h), vertexAt(mesh, nextInTriangle(h))})
            for (const std::uint32_t other : ends)
                if (topology.places[mine] == topology.places[other]) join(mine, other);
    }
    seams_.assign(seams.begin(), seams.end());
    for (const std::uint32_t h : topology.boundary)
        holes_.emplace_back(vertexAt(mesh, h), vertexAt(mesh, nextInTriangle(h)));
    pieceOf_.assign(mesh.triangles.size(), MeshTopology::kNone);
    const std::vector<MeshComponent> components = meshComponents(mesh, topology);
    for (const MeshComponent& component : components) {
        for (const std::uint32_t t : component.triangles) pieceOf_[t] = static_cast<std::uint32_t>(pieces_.size());
        pieces_.push_back({component.closed && component.coherent, component.volume});
    }
    inward_ = inwardComponents(mesh, components);
}

std::vector<StateFault> RestShape::faults() const {
    const TriangleMesh& mesh = rig_.restMesh();
    std::vector<StateFault> faults;
    if (!holes_.empty()) {
        StateFault open{Kind::open, {}, 0.0, mesh.positions[holes_.front().first]};
        for (const auto& [from, to] : holes_)
            open.amount += static_cast<double>(glm::distance(mesh.positions[from], mesh.positions[to]));
        faults.push_back(std::move(open));
    }
    StateFault inverted{Kind::inverted, {}, 0.0, {}};
    for (std::uint32_t t = 0; t < flat_.size(); ++t) {
        if (!flat_[t] && !std::ranges::count(inward_, pieceOf_[t])) continue;
        if (inverted.amount++ == 0.0) inverted.place = centreOf(mesh, t);
    }
    if (inverted.amount > 0.0) faults.push_back(std::move(inverted));
    if (!crossing_.empty()) faults.push_back({Kind::crossing, {}, diagonalOf(crossingBox_), crossingBox_.centre()});
    return faults;
}

bool RestShape::crossesAtRest(const std::pair<std::uint32_t, std::uint32_t>& triangles) const {
    return crossing_.contains(triangles) ||
           overlapping_.contains(std::minmax(pieceOf_[triangles.first], pieceOf_[triangles.second]));
}

/// Faults of one state: of each kind and set of actuators the worst.
class StateJudge::Gathered {
public:
    void add(Kind kind, std::vector<std::size_t> actuators, double amount, const glm::vec3& place) {
        const auto [at, isNew] = faults_.try_emplace({kind, std::move(actuators)}, amount, place);
        if (!isNew && amount > at->second.first) at->second = {amount, place};
    }
    [[nodiscard]] std::vector<StateFault> take() const {
        std::vector<StateFault> all;
        for (const auto& [key, fault] : faults_) all.push_back({key.first, key.second, fault.first, fault.second});
        return all;
    }

private:
    std::map<std::pair<Kind, std::vector<std::size_t>>, std::pair<double, glm::vec3>> faults_;
};

namespace {

std::vector<std::uint32_t> verticesOfAll(const Rig& rig, std::span<const std::size_t> actuators) {
    std::vector<std::uint32_t> vertices;
    for (const std::size_t a : actuators) {
        const auto own = rig.verticesOf(a);
        vertices.insert(vertices.end(), own.begin(), own.end());
    }
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

} // namespace

StateJudge::StateJudge(const RestShape& rest, std::span<const std::size_t> actuators)
    : rest_(&rest), vertices_(verticesOfAll(rest.rig(), actuators)), subset_(rest.rig().subset(vertices_)),
      moved_(vertices_.size()), mesh_(rest.rig().restMesh()) {
    std::vector<bool> moves(mesh_.positions.size(), false);
    Box reach;
    for (const std::uint32_t v : vertices_) {
        moves[v] = true;
        reach.include(rest.rig().reachOf(v));
    }
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        const glm::uvec3& corners = mesh_.triangles[t];
        if (!(moves[corners.x] || moves[corners.y] || moves[corners.z])) continue;
        triangles_.push_back(t);
        for (int k = 0; k < 3; ++k) reach.include(mesh_.positions[corners[k]]);
    }
    for (std::uint32_t t = 0, next = 0; t < mesh_.triangles.size(); ++t) {
        if (next < triangles_.size() && triangles_[next] == t) {
            ++next;
            continue;
        }
        Box box;
        for (int k = 0; k < 3; ++k) box.include(mesh_.positions[mesh_.triangles[t][k]]);
        if (meet(box, reach)) near_.push_back(t);
    }
    for (std::size_t e = 0; e < rest.shown_.size(); ++e)
        if (moves[rest.shown_[e].from] || moves[rest.shown_[e].to]) edges_.push_back(e);
    for (std::size_t s = 0; s < rest.seams_.size(); ++s)
        if (moves[rest.seams_[s].first] || moves[rest.seams_[s].second]) seams_.push_back(s);
}

void StateJudge::move(std::span<const double> strokes) {
    subset_.deform(strokes, moved_);
    for (std::size_t k = 0; k < vertices_.size(); ++k) mesh_.positions[vertices_[k]] = moved_[k];
}

std::vector<std::size_t> StateJudge::moving(std::span<const std::uint32_t> vertices,
                                            std::span<const double> strokes) const {
    std::vector<std::size_t> actuators;
    for (const std::uint32_t v : vertices)
        for (const std::uint16_t a : rest_->rig().actuatorsOf(v))
            if (strokes[a] > 0.0) actuators.push_back(a);
    std::ranges::sort(actuators);
    actuators.erase(std::unique(actuators.begin(), actuators.end()), actuators.end());
    return actuators;
}

std::vector<std::size_t> StateJudge::movingTriangle(std::uint32_t triangle, std::span<const double> strokes) const {
    const glm::uvec3& t = mesh_.triangles[triangle];
    const std::uint32_t corners[] = {t.x, t.y, t.z};
    return moving(corners, strokes);
}

std::vector<StateFault> StateJudge::faultsAt(std::span<const double> strokes) {
    move(strokes);
    Gathered faults;
    findOpen(strokes, faults);
    findInverted(strokes, faults);
    findStretched(strokes, faults);
    findCrossing(strokes, faults);
    return faults.take();
}

void StateJudge::findOpen(std::span<const double> strokes, Gathered& out) const {
    for (const std::size_t s : seams_) {
        const auto& [a, b] = rest_->seams_[s];
        const double gap = static_cast<double>(glm::distance(mesh_.positions[a], mesh_.positions[b]));
        if (gap <= kGap) continue;
        const std::uint32_t both[] = {a, b};
        out.add(Kind::open, moving(both, strokes), gap, mesh_.positions[a]);
    }
}

/// A piece that is turned has the other sign of volume; only what moves can change it.
void StateJudge::findInverted(std::span<const double> strokes, Gathered& out) const {
    const std::vector<glm::vec3>& before = rest_->rig().restMesh().positions;
    std::map<std::uint32_t, double> gained;
    std::map<std::vector<std::size_t>, std::vector<std::uint32_t>> flat;
    for (const std::uint32_t t : triangles_) {
        const std::uint32_t piece = rest_->pieceOf_[t];
        if (piece != MeshTopology::kNone)
            gained[piece] +=
                (sixVolumes(mesh_.positions, mesh_.triangles[t]) - sixVolumes(before, mesh_.triangles[t])) / 6.0;
        if (!rest_->flat_[t] && isFlat(mesh_, t)) flat[movingTriangle(t, strokes)].push_back(t);
    }
    for (const auto& [actuators, triangles] : flat)
        out.add(Kind::inverted, actuators, static_cast<double>(triangles.size()), centreOf(mesh_, triangles.front()));
    for (const auto& [piece, more] : gained) {
        const RestShape::Piece& rest = rest_->pieces_[piece];
        if (!rest.closed || rest.volume * (rest.volume + more) > 0.0) continue;
        std::vector<std::uint32_t> corners;
        Box box;
        double count = 0.0;
        for (const std::uint32_t t : triangles_) {
            if (rest_->pieceOf_[t] != piece) continue;
            ++count;
            for (int k = 0; k < 3; ++k) corners.push_back(mesh_.triangles[t][k]);
            box.include(centreOf(mesh_, t));
        }
        out.add(Kind::inverted, moving(corners, strokes), count, box.centre());
    }
}

void StateJudge::findStretched(std::span<const double> strokes, Gathered& out) const {
    for (const std::size_t e : edges_) {
        const RestShape::Edge& edge = rest_->shown_[e];
        const glm::dvec3 from(mesh_.positions[edge.from]);
        const glm::dvec3 to(mesh_.positions[edge.to]);
        const double stretch = glm::distance(from, to) / edge.length - 1.0;
        if (stretch <= rest_->options_.maxStretch) continue;
        const std::uint32_t ends[] = {edge.from, edge.to};
        out.add(Kind::stretch, moving(ends, strokes), stretch, glm::vec3(0.5 * (from + to)));
    }
}

void StateJudge::findCrossing(std::span<const double> strokes, Gathered& out) const {
    std::map<std::pair<Kind, std::vector<std::size_t>>, Box> zones;
    for (const TriangleCrossing& crossing : findCrossings(mesh_, triangles_, near_, kMostCrossings)) {
        if (rest_->crossesAtRest(pairOf(crossing))) continue;
        const std::vector<std::size_t> one = movingTriangle(crossing.first, strokes);
        const std::vector<std::size_t> other = movingTriangle(crossing.second, strokes);
        std::vector<std::size_t> both;
        std::ranges::set_union(one, other, std::back_inserter(both));
        if (both.empty()) continue;
        zones[{one == other ? Kind::crossing : Kind::collision, both}].include(crossing.where);
    }
    for (const auto& [key, zone] : zones) out.add(key.first, key.second, diagonalOf(zone), zone.centre());
}

StateFault StateJudge::fastestAt(std::span<const double> strokes, std::size_t actuator) {
    const double from = std::max(0.0, strokes[actuator] - kSpeedStep);
    const double to = std::min(1.0, strokes[actuator] + kSpeedStep);
    std::vector<double> beside(strokes.begin(), strokes.end());
    beside[actuator] = from;
    subset_.deform(beside, moved_);
    const std::vector<glm::vec3> before = moved_;
    beside[actuator] = to;
    subset_.deform(beside, moved_);
    StateFault fastest{Kind::speed, {actuator}, 0.0, {}};
    const double seconds = (to - from) / rest_->rig().actuators()[actuator].maxVelocity;
    for (std::size_t k = 0; k < moved_.size(); ++k) {
        const double speed = glm::distance(glm::dvec3(before[k]), glm::dvec3(moved_[k])) / seconds;
        if (speed > fastest.amount) {
            fastest.amount = speed;
            fastest.place = 0.5F * (before[k] + moved_[k]);
        }
    }
    return fastest;
}

} // namespace lumorph
