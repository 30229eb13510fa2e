#include "core/rig/shape_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include <glm/geometric.hpp>

#include "core/rig/servo_types.h"
#include "core/voxels/solid.h"
#include "core/voxels/voxel_frame.h"

namespace lumorph {
namespace {

constexpr int kPathSteps = 16; ///< states looked at between rest and a joint state
constexpr std::size_t kPathVoxels = 200'000;
constexpr double kPathTolerance = 0.005; ///< facets and voxels leave this much open on a sound rig

double areaOf(const TriangleMesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a(mesh.positions[t.x]);
    return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
}

glm::dvec3 normalOf(const std::vector<glm::vec3>& positions, const glm::uvec3& t) {
    const glm::dvec3 a(positions[t.x]);
    const glm::dvec3 normal = glm::cross(glm::dvec3(positions[t.y]) - a, glm::dvec3(positions[t.z]) - a);
    const double length = glm::length(normal);
    return length > 0.0 ? normal / length : glm::dvec3(0.0);
}

/// Every edge once, with its one or two triangles.
struct Edge {
    std::uint32_t from;
    std::uint32_t to;
    std::vector<std::uint32_t> triangles;
    bool shown = false; ///< borders the surface that looks up at rest
};

std::vector<Edge> edgesOf(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> found;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[t][k];
            const std::uint32_t b = mesh.triangles[t][(k + 1) % 3];
            found[std::minmax(a, b)].push_back(t);
        }
    std::vector<Edge> edges;
    for (auto& [ends, triangles] : found) {
        const bool shown = std::ranges::any_of(triangles, [&](auto t) { return facesUp(mesh, t); });
        edges.push_back({ends.first, ends.second, std::move(triangles), shown});
    }
    return edges;
}

struct Description {
    ShapeReport::PerActuator& out;
    void operator()(const Hinge& hinge) const { turn("hinge", hinge.min.inRadians(), hinge.max.inRadians()); }
    void operator()(const Bend& bend) const {
        turn("bend", bend.min.inRadians(), bend.max.inRadians());
        out.maxCurvature = out.rangeMax / bend.length;
    }
    void operator()(const Slide& slide) const { set("slide", slide.min, slide.max, "m"); }
    void operator()(const MorphTarget&) const { set("morph", 0.0, 1.0, ""); }
    void operator()(const SkinJoint& joint) const {
        set("joint", joint.min, joint.max, joint.motion == SkinJoint::Motion::rotate ? "rad" : "m");
    }
    void operator()(const SheetLift& lift) const {
        turn("lever", lift.min.inRadians(), lift.max.inRadians());
        out.torque = lift.torque;
    }

private:
    void turn(const char* deformer, double min, double max) const { set(deformer, min, max, "rad"); }
    void set(const char* deformer, double min, double max, const char* unit) const {
        out.deformer = deformer;
        out.rangeMin = min;
        out.rangeMax = max;
        out.unit = unit;
    }
};

class Reporter {
public:
    Reporter(const Rig& rig, const Progress& progress)
        : rig_(rig), progress_(progress), edges_(edgesOf(rig.restMesh())) {}

    ShapeReport report(int states, std::uint64_t seed) {
        progress_.report(0.0, "checking the rest shape");
        report_.rest = checkMesh(rig_.restMesh());
        report_.reach = rig_.reach();
        report_.pathInside = rig_.pathInside();
        report_.volumeMin = report_.volumeMax = report_.rest.volume;
        for (std::size_t a = 0; a < rig_.actuatorCount(); ++a) {
            progress_.throwIfCancelled();
            progress_.report(0.1 * static_cast<double>(a) / static_cast<double>(rig_.actuatorCount()),
                             "moving each actuator");
            report_.actuators.push_back(describe(a));
        }
        measureArea();
        chooseFrame();
        sample(states, seed);
        warn();
        return std::move(report_);
    }

private:
    ShapeReport::PerActuator describe(std::size_t index) const {
        const Actuator& actuator = rig_.actuators()[index];
        ShapeReport::PerActuator out;
        out.name = actuator.name;
        std::visit(Description{out}, actuator.deformer);
        out.fullStrokeSeconds = 1.0 / actuator.maxVelocity;
        out.servo = actuator.drive.servo;
        const auto vertices = rig_.verticesOf(index);
        out.vertices = vertices.size();
        std::vector<double> strokes(rig_.actuatorCount(), 0.0);
        strokes[index] = 1.0;
        out.amplitude = amplitudeOf(rig_, index);
        std::vector<bool> moved(rig_.restMesh().positions.size(), false);
        for (const std::uint32_t v : vertices) moved[v] = true;
        for (const glm::uvec3& t : rig_.restMesh().triangles)
            out.sweptArea += areaOf(rig_.restMesh(), t) * (moved[t.x] + moved[t.y] + moved[t.z]) / 3.0;
        if (std::holds_alternative<MorphTarget>(actuator.deformer) ||
            std::holds_alternative<SkinJoint>(actuator.deformer) ||
            std::holds_alternative<SheetLift>(actuator.deformer))
            out.maxCurvature = curvatureGained(strokes, moved);
        return out;
    }

    /// The largest change of the angle between neighbouring triangles, a metre of way between their centres.
    double curvatureGained(const std::vector<double>& strokes, const std::vector<bool>& moved) const {
        const std::vector<glm::vec3>& rest = rig_.restMesh().positions;
        std::vector<glm::vec3> bent(rest.size());
        rig_.deform(strokes, bent);
        double gained = 0.0;
        for (const Edge& edge : edges_) {
            if (edge.triangles.size() != 2 || !(moved[edge.from] || moved[edge.to])) continue;
            const glm::uvec3& a = rig_.restMesh().triangles[edge.triangles[0]];
            const glm::uvec3& b = rig_.restMesh().triangles[edge.triangles[1]];
            const auto angle = [&](const std::vector<glm::vec3>& p) {
                const glm::dvec3 na = normalOf(p, a);
                const glm::dvec3 nb = normalOf(p, b);
                return std::atan2(glm::length(glm::cross(na, nb)), glm::dot(na, nb));
            };
            const glm::dvec3 between =
                glm::dvec3(bent[a.x] + bent[a.y] + bent[a.z] - bent[b.x] - bent[b.y] - bent[b.z]) / 3.0;
            const double distance = glm::length(between);
            if (distance > 0.0) gained = std::max(gained, std::abs(angle(bent) - angle(rest)) / distance);
        }
        return gained;
    }

    void measureArea() {
        const auto moves = [&](std::uint32_t v) { return rig_.actuatorsOf(v).empty() ? 0 : 1; };
        for (const glm::uvec3& t : rig_.restMesh().triangles)
            report_.area += areaOf(rig_.restMesh(), t) * (moves(t.x) + moves(t.y) + moves(t.z)) / 3.0;
        if (report_.area > 0.0) report_.granularity = static_cast<double>(rig_.actuatorCount()) / report_.area;
    }

    /// The finest frame of up to 33 voxels on the smallest side that stays small.
    void chooseFrame() {
        const glm::dvec3 size(rig_.reach().size());
        const double smallest = std::min({size.x, size.y, size.z});
        if (!(smallest > 0.0) || !report_.rest.closed()) return;
        const double cubes = size.x * size.y * size.z / (smallest * smallest * smallest);
        const double resolution = std::cbrt(static_cast<double>(kPathVoxels) / cubes);
        frame_ = frameOf(rig_.reach(), std::clamp(static_cast<int>(resolution), 2, 33));
        if (frame_.voxelCount() > 16 * kPathVoxels) frame_ = {}; // a needle: its path is not measured
    }

    void sample(int states, std::uint64_t seed) {
        std::mt19937_64 random(seed);
        std::vector<double> strokes(rig_.actuatorCount());
        TriangleMesh mesh = rig_.restMesh();
        for (int state = 0; state < states; ++state) {
            progress_.throwIfCancelled();
            progress_.report(0.1 + 0.9 * state / states, "sampling joint states");
            for (double& stroke : strokes) stroke = static_cast<double>(random() >> 11U) * 0x1.0p-53;
            if (state == 0) std::ranges::fill(strokes, 1.0);
            rig_.deform(strokes, mesh.positions);
            judge(mesh);
            if (frame_.voxelCount() > 0) followPath(strokes, mesh);
        }
        report_.sampledStates = states;
        if (const auto& sheet = rig_.parts().sheet)
            report_.seconds = {sheet->modes.secondStates, sheet->modes.stateCount(),
                               static_cast<double>(sheet->modes.secondDistance)};
        if (passed_ > 0) report_.pathOutsideShare = static_cast<double>(lost_) / static_cast<double>(passed_);
    }

    void judge(const TriangleMesh& mesh) {
        const MeshReport now = checkMesh(mesh);
        report_.openStates += now.closed() ? 0 : 1;
        report_.intersectingStates += now.selfIntersections > 0 ? 1 : 0;
        report_.invertedStates += now.volume <= 0.0 || now.degenerateTriangles > 0 ? 1 : 0;
        report_.volumeMin = std::min(report_.volumeMin, now.volume);
        report_.volumeMax = std::max(report_.volumeMax, now.volume);
        for (const Edge& edge : edges_) {
            // Skirts and bellows stretch by design; what counts is the sheet that is looked at.
            if (!edge.shown) continue;
            const double rest = glm::distance(glm::dvec3(rig_.restMesh().positions[edge.from]),
                                              glm::dvec3(rig_.restMesh().positions[edge.to]));
            const double length =
                glm::distance(glm::dvec3(mesh.positions[edge.from]), glm::dvec3(mesh.positions[edge.to]));
            if (rest > 0.0) report_.maxStretch = std::max(report_.maxStretch, std::abs(length / rest - 1.0));
        }
    }

    void followPath(const std::vector<double>& strokes, const TriangleMesh& mesh) {
        voxelizer_.voxelize(frame_, mesh.positions, mesh.triangles, held_);
        BitColumns passed = held_;
        std::vector<double> between(strokes.size());
        std::vector<glm::vec3> positions(mesh.positions.size());
        BitColumns solid;
        for (int step = 0; step < kPathSteps; ++step) {
            const double share = static_cast<double>(step) / kPathSteps;
            std::ranges::transform(strokes, between.begin(), [share](double s) { return share * s; });
            rig_.deform(between, positions);
            voxelizer_.voxelize(frame_, positions, mesh.triangles, solid);
            passed |= solid;
        }
        passed_ += passed.count();
        passed -= held_;
        lost_ += passed.count();
    }

    void warnOfStates(int count, const char* what) {
        if (count > 0)
            report_.warnings.push_back("In " + std::to_string(count) + " of " + std::to_string(report_.sampledStates) +
                                       " sampled states " + what);
    }

    void warn() {
        for (const std::string& finding : report_.rest.findings()) report_.warnings.push_back("At rest: " + finding);
        for (const auto& actuator : report_.actuators)
            if (actuator.vertices == 0 || actuator.amplitude == 0.0)
                report_.warnings.push_back("The actuator \"" + actuator.name + "\" moves nothing.");
        for (const auto& actuator : report_.actuators)
            if (const ServoType* servo = findServo(actuator.servo); servo && actuator.torque > servo->usableTorque())
                report_.warnings.push_back("The actuator \"" + actuator.name +
                                           "\" needs more than half of what stalls its " + actuator.servo +
                                           "; take a stronger servo or a thinner sheet.");
        warnOfStates(report_.openStates, "the mesh is not closed; what lies inside is a guess there.");
        warnOfStates(report_.intersectingStates, "the surface crosses itself; a real device would collide there.");
        warnOfStates(report_.invertedStates, "parts of the mesh are turned inside out or squeezed flat.");
        if (report_.pathInside && report_.pathOutsideShare > kPathTolerance) {
            char percent[32];
            std::snprintf(percent, sizeof percent, "%.1f", 100.0 * report_.pathOutsideShare);
            report_.warnings.push_back("The rig claims that its solid holds its own path, but " + std::string(percent) +
                                       " % of what it passed lies outside; take the claim out or close the skirt.");
        }
    }

    const Rig& rig_;
    const Progress& progress_;
    std::vector<Edge> edges_;
    ShapeReport report_;
    VoxelFrame frame_;
    SolidVoxelizer voxelizer_;
    BitColumns held_;
    std::size_t passed_ = 0;
    std::size_t lost_ = 0;
};

} // namespace

bool facesUp(const TriangleMesh& mesh, std::uint32_t triangle) {
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::vec3 normal =
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]);
    return normal.y > 0.70F * glm::length(normal);
}

double amplitudeOf(const Rig& rig, std::size_t actuator) {
    const auto vertices = rig.verticesOf(actuator);
    const Rig::Subset subset = rig.subset(vertices);
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    std::vector<glm::vec3> rest(vertices.size()), moved(vertices.size());
    subset.deform(strokes, rest);
    double amplitude = 0.0;
    for (int step = 1; step <= kPathSteps; ++step) {
        strokes.at(actuator) = static_cast<double>(step) / kPathSteps;
        subset.deform(strokes, moved);
        for (std::size_t v = 0; v < moved.size(); ++v)
            amplitude = std::max(amplitude, static_cast<double>(glm::distance(rest[v], moved[v])));
    }
    return amplitude;
}

ShapeReport shapeReport(const Rig& rig, int states, std::uint64_t seed, const Progress& progress) {
    return Reporter(rig, progress).report(states, seed);
}

} // namespace lumorph
