#include "core/rig/sheet/sheet_solver.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/rig/sheet/shell_element.h"

namespace lumorph {
namespace {

using Cholesky = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>;

/// A step so short ends Newton's method: the next error is its square by the radius of curvature.
constexpr double kConverged = 1e-6;
/// A step is at most so many times as long as the one before: longer ones are of a Hessian that is nearly singular.
constexpr double kMostGrowth = 2.0;

Vector3 toEigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 toGlm(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

double principalStrain(const Vector3& green) {
    const double middle = 0.5 * (green[0] + green[1]);
    const double radius = std::hypot(0.5 * (green[0] - green[1]), 0.5 * green[2]);
    const double largest = std::abs(middle + radius) > std::abs(middle - radius) ? middle + radius : middle - radius;
    return std::sqrt(std::max(0.0, 1.0 + 2.0 * largest)) - 1.0;
}

} // namespace

SheetState flatState(const SheetMesh& mesh) {
    SheetState state;
    for (const glm::dvec2& p : mesh.points) state.positions.emplace_back(p.x, 0.0, p.y);
    state.directors.assign(mesh.edges.size(), glm::dvec3(0.0, 1.0, 0.0));
    return state;
}

SheetState mirrored(const SheetMesh& mesh, const MeshMirror& mirror, const SheetState& state) {
    const int axis = mirror.axis == 0 ? 0 : 2;
    const double twiceMiddle = mesh.points[0][mirror.axis] + mesh.points[mirror.nodes[0]][mirror.axis];
    SheetState image = state;
    for (std::size_t k = 0; k < state.positions.size(); ++k) {
        glm::dvec3& p = image.positions[mirror.nodes[k]];
        p = state.positions[k];
        p[axis] = twiceMiddle - p[axis];
    }
    for (std::size_t k = 0; k < state.directors.size(); ++k) {
        glm::dvec3& director = image.directors[mirror.edges[k]];
        director = state.directors[k];
        director[axis] = -director[axis];
    }
    return image;
}

SheetSupports noSupports(const SheetMesh& mesh) {
    return {std::vector<std::uint8_t>(mesh.points.size(), 0), std::vector<std::uint8_t>(mesh.edges.size(), 0),
            std::vector<glm::dvec3>(mesh.points.size(), glm::dvec3(0.0)), -std::numeric_limits<double>::infinity()};
}

struct SheetSolver::Impl {
    Impl(const SheetMesh& sheet, std::span<const SheetLayer> layers, SheetSupports held)
        : mesh(sheet), supports(std::move(held)) {
        checkLayers(layers);
        if (supports.heldAxes.size() != mesh.points.size() || supports.loads.size() != mesh.points.size() ||
            supports.heldDirectors.size() != mesh.edges.size())
            throw InvalidInput("sheet supports", "their sizes are not those of the mesh",
                               "give one a node, and one an edge");
        double bending = 0.0;
        for (const auto& [material, thickness, loose] : layers)
            bending += material.youngsModulus * thickness * thickness * thickness / 12.0;
        const glm::dvec2 edge = mesh.points[mesh.edges[0][1]] - mesh.points[mesh.edges[0][0]];
        edgeSquared = glm::dot(edge, edge);
        leastShift = 1e-3 * bending / edgeSquared;
        for (const SheetLayer& layer : layers)
            if (!layer.loose) faceDistance = std::max(faceDistance, 0.5 * layer.thickness);
        numberUnknowns();
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) elements.push_back(elementOf(t, layers));
        stress.resize(elements.size());
        layOutHessian();
    }

    void numberUnknowns() {
        for (const std::uint8_t axes : supports.heldAxes)
            for (int axis = 0; axis < 3; ++axis) unknowns.push_back((axes >> axis & 1) != 0 ? -1 : unknownCount++);
        for (const std::uint8_t held : supports.heldDirectors) unknowns.push_back(held != 0 ? -1 : unknownCount++);
    }

    [[nodiscard]] ShellElement elementOf(std::size_t t, std::span<const SheetLayer> layers) const {
        std::array<Eigen::Vector2d, 3> corners;
        Vector3 sign;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec2& p = mesh.points[mesh.triangles[t][k]];
            corners[k] = {p.x, p.y};
            sign[k] = mesh.edges[mesh.triangleEdges[t][k]][0] == mesh.triangles[t][(k + 1) % 3] ? 1.0 : -1.0;
        }
        const Eigen::Vector2d a = corners[1] - corners[0];
        const Eigen::Vector2d b = corners[2] - corners[0];
        if (std::abs(a.x() * b.y() - a.y() * b.x()) < 1e-9 * (a.squaredNorm() + b.squaredNorm()))
            throw InvalidInput("sheet mesh", "triangle " + std::to_string(t) + " has no area", "move one of its nodes");
        return shellElement(corners, sign, layers);
    }

    /// Indices into `unknowns` of a triangle's twelve coordinates.
    [[nodiscard]] std::array<std::size_t, 12> coordinatesOf(std::size_t t) const {
        std::array<std::size_t, 12> coordinates{};
        for (int k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis)
                coordinates[3 * k + axis] = 3 * std::size_t{mesh.triangles[t][k]} + axis;
            coordinates[9 + k] = 3 * mesh.points.size() + mesh.triangleEdges[t][k];
        }
        return coordinates;
    }

    /// Finds the pattern of the Hessian's lower half, and where each triangle adds to it.
    void layOutHessian() {
        std::vector<Eigen::Triplet<double>> entries;
        const auto visit = [&](auto&& use) {
            for (std::size_t t = 0; t < elements.size(); ++t) {
                const auto coordinates = coordinatesOf(t);
                for (int a = 0; a < 12; ++a)
                    for (int b = 0; b <= a; ++b) {
                        const int i = unknowns[coordinates[a]];
                        const int j = unknowns[coordinates[b]];
                        use(i >= 0 && j >= 0, std::max(i, j), std::min(i, j));
                    }
            }
        };
        visit([&](bool free, int row, int column) {
            if (free) entries.emplace_back(row, column, 0.0);
        });
        hessian.resize(unknownCount, unknownCount);
        hessian.setFromTriplets(entries.begin(), entries.end());
        hessian.makeCompressed();
        visit([&](bool free, int row, int column) {
            places.push_back(free ? static_cast<int>(&hessian.coeffRef(row, column) - hessian.valuePtr()) : -1);
        });
        cholesky.analyzePattern(hessian);
    }

    [[nodiscard]] ShellCorners cornersOf(std::size_t t, const SheetState& state) const {
        ShellCorners corners;
        for (int k = 0; k < 3; ++k) {
            corners.x[k] = toEigen(state.positions[mesh.triangles[t][k]]);
            corners.director[k] = toEigen(state.directors[mesh.triangleEdges[t][k]]);
        }
        return corners;
    }

    [[nodiscard]] double elasticEnergy(const SheetState& state) const {
        double sum = 0.0;
        for (std::size_t t = 0; t < elements.size(); ++t) sum += shellEnergy(elements[t], cornersOf(t, state));
        return sum;
    }

    /// Derivative of the elastic energy by all coordinates.
    [[nodiscard]] Eigen::VectorXd elasticGradient(const SheetState& state) const {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns.size()));
        for (std::size_t t = 0; t < elements.size(); ++t) {
            const Vector12 gradient = shellGradient(elements[t], cornersOf(t, state));
            const auto coordinates = coordinatesOf(t);
            for (int a = 0; a < 12; ++a) sum[static_cast<Eigen::Index>(coordinates[a])] += gradient[a];
        }
        return sum;
    }

    /// Fills `hessian`, and `residual` with the forces on the unknowns once held coordinates have moved by `moves`.
    void assemble(const SheetState& state, const Eigen::VectorXd& moves) {
        std::fill_n(hessian.valuePtr(), hessian.nonZeros(), 0.0);
        residual.setZero(unknownCount);
        for (std::size_t k = 0; k < 3 * mesh.points.size(); ++k) {
            const int axis = static_cast<int>(k % 3);
            if (unknowns[k] < 0) continue;
            residual[unknowns[k]] += supports.loads[k / 3][axis];
        }
        for (std::size_t node = 0; node < mesh.points.size(); ++node) {
            const int up = unknowns[3 * node + 1];
            const double sunk = supports.ground - state.positions[node].y;
            if (up < 0 || !(sunk > 0.0)) continue;
            residual[up] += kGroundStiffness * sunk;
            hessian.valuePtr()[hessian.outerIndexPtr()[up]] += kGroundStiffness;
        }
        Matrix12 local;
        Vector12 moved;
        const int* place = places.data();
        for (std::size_t t = 0; t < elements.size(); ++t) {
            Vector12 gradient = shellGradient(elements[t], cornersOf(t, state), stress[t], local);
            const auto coordinates = coordinatesOf(t);
            for (int a = 0; a < 12; ++a) moved[a] = moves[static_cast<Eigen::Index>(coordinates[a])];
            gradient += local * moved;
            for (int a = 0; a < 12; ++a) {
                const int i = unknowns[coordinates[a]];
                if (i >= 0) residual[i] -= gradient[a];
                for (int b = 0; b <= a; ++b, ++place)
                    if (*place >= 0) hessian.valuePtr()[*place] += local(a, b);
            }
        }
    }

    /// Whether the factorised Hessian is positive definite.
    bool factorise() {
        cholesky.factorize(hessian);
        return cholesky.info() == Eigen::Success && cholesky.vectorD().minCoeff() > 0.0;
    }

    /// Adds to the Hessian's diagonal: a stiffness of each position, and what that is for directors an edge apart.
    void stiffen(double stiffness) {
        for (std::size_t k = 0; k < unknowns.size(); ++k) // the diagonal comes first in a column
            if (unknowns[k] >= 0)
                hessian.valuePtr()[hessian.outerIndexPtr()[unknowns[k]]] +=
                    k < 3 * mesh.points.size() ? stiffness : stiffness * edgeSquared;
    }

    /// The step to the minimum of the quadratic model, over all coordinates. Where the Hessian is indefinite, `shift`
    /// is raised until that added to its diagonal makes it definite; elsewhere it falls to 0 again.
    Eigen::VectorXd step(const SheetState& state, const Eigen::VectorXd& moves, double& shift) {
        assemble(state, moves);
        shift = shift > leastShift ? shift / 8.0 : 0.0;
        stiffen(shift);
        while (!factorise()) {
            if (!std::isfinite(residual.norm())) break;
            const double more = std::max(leastShift, 3.0 * shift);
            if (more > 1e9 * leastShift)
                throw InvalidInput("sheet supports", "they leave a rigid motion of the sheet", "clamp a part of it");
            stiffen(more);
            shift += more;
        }
        const Eigen::VectorXd solution = cholesky.solve(residual);
        Eigen::VectorXd whole = moves;
        for (std::size_t k = 0; k < unknowns.size(); ++k)
            if (unknowns[k] >= 0) whole[static_cast<Eigen::Index>(k)] = solution[unknowns[k]];
        return whole;
    }

    /// Extrapolates the stress of the geometric stiffness.
    void extrapolateStress(const SheetState& state, const Eigen::VectorXd& way) {
        for (std::size_t t = 0; t < elements.size(); ++t) {
            const auto coordinates = coordinatesOf(t);
            Vector12 local;
            for (int a = 0; a < 12; ++a) local[a] = way[static_cast<Eigen::Index>(coordinates[a])];
            stress[t] = stressAfter(elements[t], cornersOf(t, state), local);
        }
    }

    [[nodiscard]] SheetState moved(const SheetState& state, const Eigen::VectorXd& step) const {
        SheetState next = state;
        for (std::size_t k = 0; k < next.positions.size(); ++k)
            next.positions[k] += toGlm(step.segment<3>(static_cast<Eigen::Index>(3 * k)));
        const auto angles = static_cast<Eigen::Index>(3 * mesh.points.size());
        for (std::size_t k = 0; k < next.directors.size(); ++k) {
            const auto [a, b] = mesh.edges[k];
            const glm::dvec3 before = state.positions[b] - state.positions[a];
            const glm::dvec3 conormal = glm::normalize(glm::cross(state.directors[k], before));
            const double angle = step[angles + static_cast<Eigen::Index>(k)];
            next.directors[k] = glm::normalize(
                glm::cross(next.positions[b] - next.positions[a], conormal + angle * state.directors[k]));
        }
        return next;
    }

    [[nodiscard]] Eigen::VectorXd movesTo(std::span<const glm::dvec3> held, const SheetState& state) const {
        Eigen::VectorXd moves = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(unknowns.size()));
        for (std::size_t k = 0; k < 3 * mesh.points.size(); ++k) {
            const int axis = static_cast<int>(k % 3);
            if (unknowns[k] < 0) moves[static_cast<Eigen::Index>(k)] = held[k / 3][axis] - state.positions[k / 3][axis];
        }
        return moves;
    }

    /// The longest move of a node along an axis.
    [[nodiscard]] double longest(const Eigen::VectorXd& step) const {
        return step.head(static_cast<Eigen::Index>(3 * mesh.points.size())).cwiseAbs().maxCoeff();
    }

    SheetEquilibrium solve(const SheetState& start, std::span<const glm::dvec3> held, int mostIterations) {
        SheetEquilibrium result;
        result.state = start;
        for (std::size_t t = 0; t < elements.size(); ++t) stress[t] = stressOf(elements[t], cornersOf(t, start));
        Eigen::VectorXd moves = movesTo(held, start);
        const bool moving = moves.cwiseAbs().maxCoeff() > 0.0;
        double shift = 0.0;
        double before = 0.0;
        for (; result.iterations < mostIterations && !result.converged; ++result.iterations) {
            const bool first = moving && result.iterations == 0;
            Eigen::VectorXd way = step(result.state, moves, shift);
            moves.setZero();
            const double length = longest(way);
            if (!std::isfinite(length)) break;
            const double share = result.iterations == 0 ? 1.0 : std::min(1.0, kMostGrowth * before / length);
            before = share * length;
            way *= share;
            extrapolateStress(result.state, way);
            result.state = moved(result.state, way);
            result.stable = shift == 0.0;
            result.converged = !first && length < kConverged;
        }
        finish(result);
        return result;
    }

    void finish(SheetEquilibrium& result) const {
        result.energy = elasticEnergy(result.state);
        const Eigen::VectorXd gradient = elasticGradient(result.state);
        result.reactions.assign(mesh.points.size(), glm::dvec3(0.0));
        for (std::size_t k = 0; k < 3 * mesh.points.size(); ++k) {
            const int axis = static_cast<int>(k % 3);
            if (unknowns[k] < 0)
                result.reactions[k / 3][axis] = gradient[static_cast<Eigen::Index>(k)] - supports.loads[k / 3][axis];
        }
    }

    SheetMesh mesh;
    SheetSupports supports;
    double faceDistance = 0.0;
    std::vector<int> unknowns; ///< number of each coordinate among the unknowns, -1 where it is held
    int unknownCount = 0;
    std::vector<ShellElement> elements;
    std::vector<ShellStress> stress; ///< of each triangle, for the geometric stiffness
    std::vector<int> places;         ///< in the Hessian's values, of the lower half of each triangle's; -1 where held
    Eigen::SparseMatrix<double> hessian;
    Eigen::VectorXd residual;
    double edgeSquared = 0.0; ///< of an edge at rest
    double leastShift = 0.0;  ///< a small part of the stiffness with which neighbouring nodes resist bending
    Cholesky cholesky;
};

SheetSolver::SheetSolver(const SheetMesh& mesh, std::span<const SheetLayer> layers, SheetSupports supports)
    : impl_(std::make_unique<Impl>(mesh, layers, std::move(supports))) {}
SheetSolver::~SheetSolver() = default;
SheetSolver::SheetSolver(SheetSolver&&) noexcept = default;
SheetSolver& SheetSolver::operator=(SheetSolver&&) noexcept = default;

double SheetSolver::energy(const SheetState& state) const { return impl_->elasticEnergy(state); }

SheetGradient SheetSolver::gradient(const SheetState& state) const {
    const Eigen::VectorXd all = impl_->elasticGradient(state);
    SheetGradient gradient;
    const auto nodes = static_cast<Eigen::Index>(state.positions.size());
    for (Eigen::Index k = 0; k < nodes; ++k) gradient.forces.push_back(toGlm(all.segment<3>(3 * k)));
    gradient.moments.assign(all.begin() + 3 * nodes, all.end());
    return gradient;
}

SheetStrain SheetSolver::strain(const SheetState& state) const {
    SheetStrain result;
    const auto keepLarger = [](double strain, std::size_t t, double& largest, std::uint32_t& where) {
        if (std::abs(strain) <= std::abs(largest)) return;
        largest = strain;
        where = static_cast<std::uint32_t>(t);
    };
    for (std::size_t t = 0; t < impl_->elements.size(); ++t) {
        const ShellElement& element = impl_->elements[t];
        const ShellCorners corners = impl_->cornersOf(t, state);
        const Vector3 heights = heightsOf(corners);
        const Vector3 middle = element.strainOf * arcLengthsOf(element, corners, heights);
        const Vector3 bent = impl_->faceDistance * element.curvatureOf * heights;
        keepLarger(principalStrain(middle), t, result.middle, result.middleTriangle);
        for (const double side : {-1.0, 1.0})
            keepLarger(principalStrain(middle + side * bent), t, result.face, result.faceTriangle);
    }
    return result;
}

SheetEquilibrium SheetSolver::solve(const SheetState& start, std::span<const glm::dvec3> held, int mostIterations) {
    return impl_->solve(start, held, mostIterations);
}

} // namespace lumorph
