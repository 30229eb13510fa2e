#include "core/mdf/volume_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/mdf/rig_bodies.h"
#include "core/rig/motion_box.h"

namespace lumorph {
namespace {

constexpr float kGuard = 1e-3F;    ///< voxels: covers rounding of heights, and of places before snapping
constexpr double kFlat = 1e-3;     ///< voxels squared: a triangle of less area seen from above has no plane
constexpr double kSteepest = 64.0; ///< slopes beyond it bound nothing
constexpr int kMostPathIntervals = 16;
constexpr int kNone = -1;

/// A vertex over a box, in voxels with the centres at whole numbers.
struct GridBound {
    glm::vec3 at{0.0F};
    glm::vec3 rest{0.0F};
    glm::vec3 radius{0.0F}; ///< rest and slopes together
};

/// One triangle that may pass a column.
struct Passing {
    int next = kNone; ///< of the same column
    bool leaving = false;
    float from = 0.0F, to = 0.0F;    ///< heights at which it can
    float plane = 0.0F, rest = 0.0F; ///< height = plane + slopes . x, and so much around it; rest < 0: not known
    float outside = 0.0F;            ///< how far the column is from the triangle, about
};

struct BodyBounds {
    RigBody body;
    std::vector<glm::uvec3> moving; ///< triangles, into the listed vertices
    std::vector<glm::uvec3> still;  ///< likewise
    std::optional<MotionBounds> motion;
    std::vector<Box> reach;                    ///< of each vertex that moves, over all states
    std::vector<std::uint64_t> stillParity;    ///< of all columns
    std::vector<std::uint64_t> stillCrossings; ///< a bit where a triangle that stays passes
    std::vector<std::int16_t> stillSigned;     ///< of each column how often they enter, less how often they leave
};

} // namespace

struct VolumeBounds::Workspace {
    MotionBox motion;
    glm::vec3 snapping{0.0F}; ///< voxels: guards of a vertex
    std::vector<GridBound> vertices;
    std::vector<glm::vec3> slopes; ///< [vertex * axes + axis], voxels
    std::vector<GridVertex> snapped;
    std::vector<int> head; ///< of each column its first passing triangle
    std::vector<std::uint32_t> touched;
    std::vector<Passing> passing;
    std::vector<float> passingSlopes;
    std::vector<std::uint64_t> parity, open, always, possible;
};

void VolumeBounds::DeleteWorkspace::operator()(Workspace* workspace) const noexcept { delete workspace; }
VolumeBounds::WorkspacePointer VolumeBounds::makeWorkspace() { return WorkspacePointer(new Workspace); }

struct VolumeBounds::Data {
    const Coverage& coverage;
    std::vector<std::uint16_t> actuators;
    std::vector<std::uint8_t> columns;
    GridSnap snap;
    float voxelsPerMetre;
    glm::vec3 origin;
    int width, height, depth;
    std::size_t words;
    std::vector<BodyBounds> bodies;
    std::vector<std::uint8_t> bodiesOfColumn; ///< how many of them reach it

    Data(const Coverage& of, std::vector<std::uint16_t> axes, std::vector<std::uint8_t> where);
    [[nodiscard]] static Box reachWithFrame(const Coverage& of) {
        Box box = of.rig().reach();
        box.include(of.frame().box());
        return box;
    }
    [[nodiscard]] std::size_t axes() const noexcept { return actuators.size(); }

    void addBody(const RigBody& body);
    void enclose(const BodyBounds& of, std::span<const double> low, std::span<const double> high,
                 Workspace& workspace) const;
    void boundVertices(const BodyBounds& of, std::span<const double> low, std::span<const double> high,
                       Workspace& workspace) const;
    void passTriangle(const glm::uvec3& triangle, Workspace& workspace) const;
    void parityAtCentre(const BodyBounds& of, Workspace& workspace) const;
    void openVoxels(const BodyBounds& of, Workspace& workspace, VolumeEnclosure* heights) const;
    bool addHeight(const BodyBounds& of, std::uint32_t column, const Workspace& workspace, VolumeEnclosure& out) const;
    void unite(Workspace& workspace, bool alwaysSampled) const;
    void sweep(const BodyBounds& of, std::span<const double> low, std::span<const double> high,
               Workspace& workspace) const;
    [[nodiscard]] int stepsOf(const BodyBounds& of, std::span<const double> strokes) const;
    void openBetween(std::uint32_t column, float from, float to, std::vector<std::uint64_t>& bits) const;
    [[nodiscard]] int levelOf(float y) const noexcept {
        return ceilToInt(std::min(std::max(y, 0.0F), static_cast<float>(height)));
    }
    [[nodiscard]] ColumnRange all() const noexcept { return {0, width - 1, 0, depth - 1}; }

    template <typename Toggle>
    void raster(std::span<const glm::uvec3> triangles, std::span<const GridVertex> vertices, Toggle&& toggle) const {
        for (const glm::uvec3& t : triangles)
            rasterizeTriangle(vertices[t.x], vertices[t.y], vertices[t.z], snap.shift(), all(), toggle);
    }
    void flipAbove(std::vector<std::uint64_t>& bits, std::size_t column, int level) const {
        if (level >= height) return;
        const auto bit = static_cast<unsigned>(std::max(level, 0));
        std::uint64_t* const first = bits.data() + column * words;
        first[bit >> 6U] ^= ~std::uint64_t{0} << (bit & 63U);
        for (std::size_t word = (bit >> 6U) + 1; word < words; ++word) first[word] = ~first[word];
    }
    [[nodiscard]] std::size_t columnAt(int x, int z) const noexcept {
        return static_cast<std::size_t>(z) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

VolumeBounds::Data::Data(const Coverage& of, std::vector<std::uint16_t> axesIn, std::vector<std::uint8_t> where)
    : coverage(of), actuators(std::move(axesIn)), columns(std::move(where)), snap(of.frame(), reachWithFrame(of)),
      voxelsPerMetre(static_cast<float>(1.0 / of.frame().voxelSize)), origin(of.frame().origin),
      width(of.frame().dimensions.x), height(of.frame().dimensions.y), depth(of.frame().dimensions.z),
      words(static_cast<std::size_t>((height + 63) / 64)), bodiesOfColumn(columns.size(), 0) {
    for (const RigBody& body : bodiesOf(of.rig(), of.frame()))
        if (std::ranges::any_of(body.actuators,
                                [&](auto a) { return std::ranges::find(actuators, a) != actuators.end(); }))
            addBody(body);
}

void VolumeBounds::Data::addBody(const RigBody& body) {
    BodyBounds& made = bodies.emplace_back();
    made.body = body;
    const TriangleMesh& mesh = coverage.rig().restMesh();
    // A group's vertices are numbered for itself; here all groups of the body share one list.
    const auto moves = [&](std::uint16_t a) { return std::ranges::find(actuators, a) != actuators.end(); };
    std::vector<std::uint32_t> vertices;
    std::vector<glm::vec3> rest;
    for (const RigGroup& group : body.groups) {
        if (!group.vertices) continue;
        const bool movingGroup = std::ranges::any_of(group.actuators, moves);
        const auto first = static_cast<std::uint32_t>(movingGroup ? vertices.size() : rest.size());
        for (const std::uint32_t vertex : group.listed) {
            if (movingGroup) {
                vertices.push_back(vertex);
                made.reach.push_back(coverage.rig().reachOf(vertex));
            } else
                rest.push_back(mesh.positions[vertex]);
        }
        for (const glm::uvec3& t : group.triangles) (movingGroup ? made.moving : made.still).push_back(t + first);
    }
    made.motion.emplace(coverage.rig(), vertices, actuators);
    made.stillParity.resize(columns.size() * words);
    made.stillCrossings.resize(columns.size() * words);
    made.stillSigned.resize(columns.size());
    std::vector<GridVertex> snapped;
    for (const glm::vec3& position : rest) snapped.push_back(snap(position));
    raster(made.still, snapped, [&](int x, int z, int level, bool entering) {
        const std::size_t column = columnAt(x, z);
        flipAbove(made.stillParity, column, level);
        made.stillSigned[column] = static_cast<std::int16_t>(made.stillSigned[column] + (entering ? 1 : -1));
        if (level > 0 && level < height)
            made.stillCrossings[column * words + (static_cast<std::size_t>(level) >> 6U)] |=
                std::uint64_t{1} << (static_cast<unsigned>(level) & 63U);
    });
    for (int z = body.range.z0; z <= body.range.z1; ++z)
        for (int x = body.range.x0; x <= body.range.x1; ++x)
            if (bodiesOfColumn[columnAt(x, z)] < 2) ++bodiesOfColumn[columnAt(x, z)];
}

void VolumeBounds::Data::boundVertices(const BodyBounds& of, std::span<const double> low, std::span<const double> high,
                                       Workspace& workspace) const {
    of.motion->over(low, high, workspace.motion);
    const MotionBox& motion = workspace.motion;
    const std::size_t count = motion.at.size();
    workspace.vertices.resize(count);
    workspace.snapped.resize(count);
    workspace.slopes.resize(count * axes());
    const float snapping = std::ldexp(4.0F, -snap.shift());
    workspace.snapping = glm::vec3(kGuard + snapping, kGuard, kGuard + snapping);
    for (std::size_t v = 0; v < count; ++v) {
        GridBound& bound = workspace.vertices[v];
        workspace.snapped[v] = snap(motion.at[v]);
        bound.at = (motion.at[v] - origin) * voxelsPerMetre - 0.5F;
        bound.rest = motion.rest[v] * voxelsPerMetre + workspace.snapping;
        bound.radius = bound.rest;
        for (std::size_t i = 0; i < axes(); ++i) {
            const glm::vec3 slope = motion.slopes[v * axes() + i] * voxelsPerMetre;
            workspace.slopes[v * axes() + i] = slope;
            bound.radius += glm::abs(slope);
        }
        // In large boxes the reach over all states is tighter.
        const Box& reach = of.reach[v];
        const glm::vec3 farthest = glm::max(glm::abs(reach.max - motion.at[v]), glm::abs(motion.at[v] - reach.min));
        bound.radius = glm::min(bound.radius, farthest * voxelsPerMetre + workspace.snapping);
    }
}

/// Lists the columns that a triangle can pass in some state of the box, and where. At a state the column's point p is
/// the mean, with weights l >= 0, of the corners at_v + slopes_v . x + r_v. The same mean of the at_v lies in the
/// triangle's plane at the centre, so that the height is the plane's at the column + sum l_v K_v . x + r with
/// K = slope.y - plane slopes . slope.xz; and sum l_v K_v is K, linear over the triangle, at most `radius` away.
void VolumeBounds::Data::passTriangle(const glm::uvec3& triangle, Workspace& workspace) const {
    const std::array<std::size_t, 3> corner{triangle.x, triangle.y, triangle.z};
    std::array<const GridBound*, 3> v{};
    glm::vec3 low(INFINITY), high(-INFINITY), radius(0.0F), rest(0.0F);
    for (std::size_t k = 0; k < 3; ++k) {
        v[k] = &workspace.vertices[corner[k]];
        low = glm::min(low, v[k]->at - v[k]->radius);
        high = glm::max(high, v[k]->at + v[k]->radius);
        radius = glm::max(radius, v[k]->radius);
        rest = glm::max(rest, v[k]->rest);
    }
    const auto columnOf = [](float place, int last) {
        return static_cast<int>(std::min(std::max(place, -1.0F), static_cast<float>(last + 1)));
    };
    const int x0 = columnOf(std::ceil(low.x), width), x1 = std::min(columnOf(std::floor(high.x), width), width - 1);
    const int z0 = columnOf(std::ceil(low.z), depth), z1 = std::min(columnOf(std::floor(high.z), depth), depth - 1);
    if (std::max(x0, 0) > x1 || std::max(z0, 0) > z1) return;

    // In double: of a long and thin triangle the differences of these products decide.
    const glm::dvec3 origin0(v[0]->at);
    const glm::dvec3 d1 = glm::dvec3(v[1]->at) - origin0;
    const glm::dvec3 d2 = glm::dvec3(v[2]->at) - origin0;
    const double area = d1.x * d2.z - d1.z * d2.x;
    // How much an edge can turn: what its ends do differently.
    const MotionBox& motion = workspace.motion;
    const auto turn = [&](std::size_t k) {
        glm::vec3 sum = motion.tail[corner[0]] + motion.tail[corner[k]];
        for (std::size_t p = 0; p < motion.pairs; ++p)
            sum += glm::abs(motion.curvatures[corner[k] * motion.pairs + p] -
                            motion.curvatures[corner[0] * motion.pairs + p]);
        sum = sum * voxelsPerMetre + 2.0F * workspace.snapping;
        for (std::size_t i = 0; i < axes(); ++i)
            sum += glm::abs(workspace.slopes[corner[k] * axes() + i] - workspace.slopes[corner[0] * axes() + i]);
        return glm::dvec3(sum);
    };
    const glm::dvec3 t1 = turn(1), t2 = turn(2);
    const double change = std::abs(d1.x) * t2.z + std::abs(d2.z) * t1.x + std::abs(d1.z) * t2.x +
                          std::abs(d2.x) * t1.z + t1.x * t2.z + t1.z * t2.x;
    const bool leaving = area < -1.001 * change;

    // Any linear function of the corners as one of the place: its slopes along x and z.
    const auto slopesOf = [&](double a, double b, double c) {
        return glm::dvec2((b - a) * d2.z - (c - a) * d1.z, (c - a) * d1.x - (b - a) * d2.x) / area;
    };
    bool hasPlane = std::abs(area) > kFlat;
    glm::dvec2 plane(0.0);
    std::array<double, kMostAxes> along{}, alongX{}, alongZ{};
    double around = 0.0;
    if (hasPlane) {
        plane = slopesOf(origin0.y, static_cast<double>(v[1]->at.y), static_cast<double>(v[2]->at.y));
        hasPlane = std::abs(plane.x) + std::abs(plane.y) < kSteepest;
    }
    if (hasPlane) {
        const glm::dvec3 widest(radius), loosest(rest);
        around =
            loosest.y + std::abs(plane.x) * loosest.x + std::abs(plane.y) * loosest.z + static_cast<double>(kGuard);
        for (std::size_t i = 0; i < axes(); ++i) {
            std::array<double, 3> k{};
            for (std::size_t c = 0; c < 3; ++c) {
                const glm::dvec3 slope(workspace.slopes[corner[c] * axes() + i]);
                k[c] = slope.y - plane.x * slope.x - plane.y * slope.z;
            }
            const glm::dvec2 by = slopesOf(k[0], k[1], k[2]);
            along[i] = k[0];
            alongX[i] = by.x;
            alongZ[i] = by.y;
            around += std::abs(by.x) * widest.x + std::abs(by.y) * widest.z;
        }
    }

    const float side = area < 0.0 ? -1.0F : 1.0F;
    std::array<glm::vec3, 3> edges{}; // side x (normal, offset): at least -reach inside
    std::array<float, 3> reach{};
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 &p = v[k]->at, &q = v[(k + 1) % 3]->at;
        const float dx = q.x - p.x, dz = q.z - p.z;
        edges[k] = side * glm::vec3(-dz, dx, dz * p.x - dx * p.z);
        reach[k] = std::abs(dz) * radius.x + std::abs(dx) * radius.z + kGuard * (std::abs(dx) + std::abs(dz));
    }
    for (int z = std::max(z0, 0); z <= z1; ++z)
        for (int x = std::max(x0, 0); x <= x1; ++x) {
            const std::size_t column = columnAt(x, z);
            if (columns[column] == 0) continue;
            float outside = 0.0F;
            bool away = false;
            for (std::size_t k = 0; k < 3; ++k) {
                const float inside =
                    edges[k].x * static_cast<float>(x) + edges[k].y * static_cast<float>(z) + edges[k].z;
                away = away || inside < -reach[k];
                outside = std::max(outside, -inside);
            }
            if (away) continue;
            Passing pass{workspace.head[column], leaving, low.y - kGuard, high.y + kGuard, 0.0F, -1.0F, outside};
            const std::size_t first = workspace.passingSlopes.size();
            workspace.passingSlopes.resize(first + axes(), 0.0F);
            if (hasPlane) {
                const double dx = x - origin0.x, dz = z - origin0.z;
                pass.plane = static_cast<float>(origin0.y + plane.x * dx + plane.y * dz);
                pass.rest = static_cast<float>(around);
                float all = pass.rest;
                for (std::size_t i = 0; i < axes(); ++i) {
                    const auto slope = static_cast<float>(along[i] + alongX[i] * dx + alongZ[i] * dz);
                    workspace.passingSlopes[first + i] = slope;
                    all += std::abs(slope);
                }
                pass.from = std::max(pass.from, pass.plane - all);
                pass.to = std::min(pass.to, pass.plane + all);
            }
            if (pass.next == kNone) workspace.touched.push_back(static_cast<std::uint32_t>(column));
            workspace.head[column] = static_cast<int>(workspace.passing.size());
            workspace.passing.push_back(pass);
        }
}

void VolumeBounds::Data::enclose(const BodyBounds& of, std::span<const double> low, std::span<const double> high,
                                 Workspace& workspace) const {
    boundVertices(of, low, high, workspace);
    workspace.head.assign(columns.size(), kNone);
    workspace.touched.clear();
    workspace.passing.clear();
    workspace.passingSlopes.clear();
    for (const glm::uvec3& triangle : of.moving) passTriangle(triangle, workspace);
    parityAtCentre(of, workspace);
}

void VolumeBounds::Data::parityAtCentre(const BodyBounds& of, Workspace& workspace) const {
    workspace.parity = of.stillParity;
    raster(of.moving, workspace.snapped,
           [&](int x, int z, int level, bool) { flipAbove(workspace.parity, columnAt(x, z), level); });
}

void VolumeBounds::Data::openBetween(std::uint32_t column, float from, float to,
                                     std::vector<std::uint64_t>& bits) const {
    const int last = levelOf(to);
    for (int level = levelOf(from); level < last; ++level)
        bits[column * words + (static_cast<std::size_t>(level) >> 6U)] |= std::uint64_t{1}
                                                                          << (static_cast<unsigned>(level) & 63U);
}

/// True when the column has one top in every state of the box: what can pass it only leaves the solid, and by the
/// triangles that stay it does so once.
bool VolumeBounds::Data::addHeight(const BodyBounds& of, std::uint32_t column, const Workspace& workspace,
                                   VolumeEnclosure& out) const {
    if (of.stillSigned[column] != 1 || bodiesOfColumn[column] != 1) return false;
    float from = INFINITY, to = -INFINITY;
    int nearest = kNone;
    for (int p = workspace.head[column]; p != kNone; p = workspace.passing[static_cast<std::size_t>(p)].next) {
        const Passing& pass = workspace.passing[static_cast<std::size_t>(p)];
        if (!pass.leaving || pass.rest < 0.0F) return false;
        from = std::min(from, pass.from);
        to = std::max(to, pass.to);
        if (nearest == kNone || pass.outside < workspace.passing[static_cast<std::size_t>(nearest)].outside)
            nearest = p;
    }
    const int first = levelOf(from), last = levelOf(to);
    if (first >= last) return true; // nothing is open
    for (int level = first + 1; level < last; ++level)
        if ((of.stillCrossings[column * words + (static_cast<std::size_t>(level) >> 6U)] >>
                 (static_cast<unsigned>(level) & 63U) &
             1U) != 0)
            return false;
    if ((of.stillParity[column * words + (static_cast<std::size_t>(first) >> 6U)] >>
             (static_cast<unsigned>(first) & 63U) &
         1U) == 0)
        return false;
    ColumnHeight top{column, first, last, INFINITY, -INFINITY};
    const float* const slopes = workspace.passingSlopes.data() + static_cast<std::size_t>(nearest) * axes();
    for (int p = workspace.head[column]; p != kNone; p = workspace.passing[static_cast<std::size_t>(p)].next) {
        const Passing& pass = workspace.passing[static_cast<std::size_t>(p)];
        const float* const own = workspace.passingSlopes.data() + static_cast<std::size_t>(p) * axes();
        float around = pass.rest;
        for (std::size_t i = 0; i < axes(); ++i) around += std::abs(own[i] - slopes[i]);
        top.from = std::min(top.from, pass.plane - around);
        top.to = std::max(top.to, pass.plane + around);
    }
    out.heights.push_back(top);
    out.slopes.insert(out.slopes.end(), slopes, slopes + axes());
    return true;
}

/// Fills workspace.open with the voxels whose state is not the same all over the box.
void VolumeBounds::Data::openVoxels(const BodyBounds& of, Workspace& workspace, VolumeEnclosure* heights) const {
    workspace.open.assign(columns.size() * words, 0);
    for (const std::uint32_t column : workspace.touched) {
        const std::size_t before = heights ? heights->heights.size() : 0;
        if (heights && addHeight(of, column, workspace, *heights)) {
            if (heights->heights.size() > before) {
                const ColumnHeight& added = heights->heights.back();
                openBetween(column, static_cast<float>(added.first), static_cast<float>(added.last), workspace.open);
            }
            continue;
        }
        for (int p = workspace.head[column]; p != kNone; p = workspace.passing[static_cast<std::size_t>(p)].next) {
            const Passing& pass = workspace.passing[static_cast<std::size_t>(p)];
            openBetween(column, pass.from, pass.to, workspace.open);
        }
    }
}

void VolumeBounds::Data::unite(Workspace& workspace, bool alwaysSampled) const {
    for (std::size_t i = 0; i < workspace.parity.size(); ++i) {
        workspace.possible[i] |= workspace.parity[i] | workspace.open[i];
        if (alwaysSampled) workspace.always[i] |= workspace.parity[i] & ~workspace.open[i];
    }
}

int VolumeBounds::Data::stepsOf(const BodyBounds& of, std::span<const double> strokes) const {
    constexpr double kSlack = 1e-6;
    const auto strokeOfActuator = [&](std::uint16_t actuator) {
        const auto at = std::ranges::find(actuators, actuator);
        return at == actuators.end() ? 0.0 : strokes[static_cast<std::size_t>(at - actuators.begin())];
    };
    if (of.body.actuators.size() == 1) {
        const int levels = coverage.levels();
        return static_cast<int>(std::ceil(
            of.body.stepsPerLevel(levels) * strokeOfActuator(of.body.actuators.front()) * (levels - 1) - kSlack));
    }
    double steps = 0.0;
    for (std::size_t i = 0; i < of.body.actuators.size(); ++i)
        steps += of.body.fullStrokeSteps[i] * strokeOfActuator(of.body.actuators[i]);
    return static_cast<int>(std::ceil(steps - kSlack));
}

/// Each interval of t has a sample of every state that takes at least as many steps as there are intervals; t = 1 is a
/// sample of all.
void VolumeBounds::Data::sweep(const BodyBounds& of, std::span<const double> low, std::span<const double> high,
                               Workspace& workspace) const {
    const int fewest = stepsOf(of, low);
    const int intervals = std::clamp(stepsOf(of, high), 1, kMostPathIntervals);
    std::vector<double> from(axes()), to(axes());
    for (int k = 0; k < intervals; ++k) {
        for (std::size_t i = 0; i < axes(); ++i) {
            from[i] = low[i] * (static_cast<double>(k) / intervals);
            to[i] = std::min(1.0, high[i] * (static_cast<double>(k + 1) / intervals) * (1.0 + 1e-9));
        }
        enclose(of, from, to, workspace);
        openVoxels(of, workspace, nullptr);
        unite(workspace, intervals <= fewest);
    }
    enclose(of, low, high, workspace);
    openVoxels(of, workspace, nullptr);
    unite(workspace, true);
}

VolumeBounds::VolumeBounds(const Coverage& coverage, std::vector<std::uint16_t> actuators,
                           std::vector<std::uint8_t> columns) {
    if (actuators.size() > kMostAxes)
        throw InvalidInput(std::to_string(actuators.size()) + " actuators",
                           "volumes are enclosed over at most " + std::to_string(kMostAxes) + " at a time",
                           "enclose fewer");
    data_ = std::make_unique<const Data>(coverage, std::move(actuators), std::move(columns));
}
VolumeBounds::~VolumeBounds() = default;
VolumeBounds::VolumeBounds(VolumeBounds&&) noexcept = default;
VolumeBounds& VolumeBounds::operator=(VolumeBounds&&) noexcept = default;

std::span<const std::uint16_t> VolumeBounds::actuators() const noexcept { return data_->actuators; }

void VolumeBounds::over(std::span<const Level> low, std::span<const Level> high, VolumeEnclosure& out,
                        Workspace& workspace) const {
    const Data& data = *data_;
    std::vector<double> from, to;
    for (std::size_t i = 0; i < data.axes(); ++i) {
        from.push_back(strokeOf(low[i], data.coverage.levels()));
        to.push_back(strokeOf(high[i], data.coverage.levels()));
    }
    out.heights.clear();
    out.slopes.clear();
    out.spread.assign(data.axes(), 0.0);
    workspace.always.assign(data.columns.size() * data.words, 0);
    workspace.possible.assign(workspace.always.size(), 0);
    for (const BodyBounds& of : data.bodies) {
        if (of.body.sweeps()) {
            data.sweep(of, from, to, workspace);
        } else {
            data.enclose(of, from, to, workspace);
            data.openVoxels(of, workspace, &out);
            data.unite(workspace, true);
        }
        for (std::size_t k = 0; k < workspace.slopes.size(); ++k) {
            const glm::vec3 slope = glm::abs(workspace.slopes[k]);
            out.spread[k % data.axes()] += static_cast<double>(slope.x + slope.y + slope.z);
        }
    }
    const BitColumns& domain = data.coverage.domain();
    for (BitColumns* bits : {&out.always, &out.possible})
        if (bits->dimensions() != domain.dimensions()) *bits = BitColumns(domain.dimensions());
    for (std::size_t i = 0; i < workspace.always.size(); ++i) {
        const std::uint64_t in = data.columns[i / data.words] == 0 ? 0 : domain.words()[i];
        out.always.words()[i] = workspace.always[i] & in;
        out.possible.words()[i] = workspace.possible[i] & in;
    }
}

} // namespace lumorph
