#include "core/rig/sheet/levered_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

/// St. Venant-Kirchhoff's law says nothing useful beyond.
constexpr double kMostStretch = 0.3;
constexpr int kMostHalvings = 5;
constexpr int kMostIterations = 40;

/// The pad clamps its nodes and the edges between them; each lever holds the height of its line; the housing carries
/// what would sink below rest.
SheetSupports supportsOf(const SheetMesh& mesh) {
    SheetSupports supports = noSupports(mesh);
    for (const auto& line : mesh.lineNodes)
        for (const std::uint32_t node : line) supports.heldAxes[node] = SheetSupports::y;
    for (const std::uint32_t node : mesh.padNodes) supports.heldAxes[node] = SheetSupports::all;
    for (std::size_t k = 0; k < mesh.edges.size(); ++k)
        supports.heldDirectors[k] = supports.heldAxes[mesh.edges[k][0]] == SheetSupports::all &&
                                    supports.heldAxes[mesh.edges[k][1]] == SheetSupports::all;
    supports.ground = 0.0;
    return supports;
}

/// The shortest distance on the flat sheet between nodes of two sets.
double distanceBetween(const SheetMesh& mesh, std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : a)
        for (const std::uint32_t j : b) least = std::min(least, glm::distance(mesh.points[i], mesh.points[j]));
    return least;
}

} // namespace

LeveredSheet::LeveredSheet(const ElasticSheet& sheet, const SheetMesh& mesh)
    : levers_((checkSheet(sheet), sheet.levers)), mesh_(mesh), solver_(mesh, sheet.layers, supportsOf(mesh)) {}

SheetPose LeveredSheet::rest() const {
    SheetPose pose;
    pose.strokes.assign(levers_.size(), 0.0);
    pose.state = flatState(mesh_);
    pose.loads.resize(levers_.size());
    return pose;
}

SheetPose LeveredSheet::moved(const SheetPose& from, std::span<const double> strokes) {
    checkStrokes(strokes);
    auto pose = continued(from, strokes, kMostHalvings);
    if (!pose)
        throw InvalidInput("sheet", "no equilibrium was found on the way to " + namesAndStrokes(strokes),
                           "let these lift less, or choose a thicker sheet");
    if (std::abs(pose->strain.middle) > kMostStretch)
        throw InvalidInput(strongestLevers(*pose),
                           "they pull against each other: the sheet would stretch by " +
                               std::to_string(std::lround(100.0 * std::abs(pose->strain.middle))) + " %",
                           "let one lift less, or move their lines apart");
    return *std::move(pose);
}

std::optional<SheetPose> LeveredSheet::polished(const SheetState& guess, std::span<const double> strokes) {
    checkStrokes(strokes);
    return solved(guess, strokes);
}

SheetPose LeveredSheet::followed(std::span<const double> strokes, int steps) {
    checkStrokes(strokes);
    SheetPose pose = rest();
    std::vector<double> next(strokes.size());
    int iterations = 0;
    for (int step = 1; step <= steps; ++step) {
        for (std::size_t l = 0; l < next.size(); ++l) next[l] = strokes[l] * step / steps;
        pose = moved(pose, next);
        iterations += pose.iterations;
    }
    pose.iterations = iterations;
    return pose;
}

std::vector<glm::dvec3> LeveredSheet::heldAt(std::span<const double> strokes) const {
    std::vector<glm::dvec3> held = flatState(mesh_).positions;
    for (std::size_t l = 0; l < levers_.size(); ++l)
        for (const std::uint32_t node : mesh_.lineNodes[l]) held[node].y = levers_[l].heightAt(strokes[l]);
    return held;
}

std::optional<SheetPose> LeveredSheet::solved(const SheetState& start, std::span<const double> strokes) {
    SheetEquilibrium equilibrium = solver_.solve(start, heldAt(strokes), kMostIterations);
    if (!equilibrium.converged || !equilibrium.stable) return std::nullopt;
    SheetPose pose;
    pose.strokes.assign(strokes.begin(), strokes.end());
    pose.energy = equilibrium.energy;
    pose.iterations = equilibrium.iterations;
    for (std::size_t l = 0; l < levers_.size(); ++l) {
        LeverLoad load;
        for (const std::uint32_t node : mesh_.lineNodes[l]) load.force += equilibrium.reactions[node].y;
        load.torque = load.force * levers_[l].arm * std::cos(levers_[l].angleAt(strokes[l]));
        pose.loads.push_back(load);
    }
    pose.strain = solver_.strain(equilibrium.state);
    pose.state = std::move(equilibrium.state);
    return pose;
}

std::optional<SheetPose> LeveredSheet::continued(const SheetPose& from, std::span<const double> strokes, int halvings) {
    if (auto pose = solved(from.state, strokes)) return pose;
    if (halvings == 0) return std::nullopt;
    std::vector<double> half(strokes.size());
    for (std::size_t l = 0; l < half.size(); ++l) half[l] = 0.5 * (from.strokes[l] + strokes[l]);
    const auto middle = continued(from, half, halvings - 1);
    if (!middle) return std::nullopt;
    auto pose = continued(*middle, strokes, halvings - 1);
    if (pose) pose->iterations += middle->iterations;
    return pose;
}

void LeveredSheet::checkStrokes(std::span<const double> strokes) const {
    if (strokes.size() != levers_.size() ||
        !std::ranges::all_of(strokes, [](double stroke) { return stroke >= 0.0 && stroke <= 1.0; }))
        throw InvalidInput("sheet", "the strokes are not one a lever, each from 0 to 1",
                           "give as many as it has levers");
    // Lines may slide together, but no nearer than they differ in height.
    const auto tears = [](double rise, double distance) { return std::abs(rise) > (1.0 + kMostStretch) * distance; };
    for (std::size_t l = 0; l < levers_.size(); ++l) {
        const double height = levers_[l].heightAt(strokes[l]);
        if (tears(height, distanceBetween(mesh_, mesh_.lineNodes[l], mesh_.padNodes)))
            throw InvalidInput("lever " + inQuotes(levers_[l].name),
                               "it lifts more than the sheet reaches from the pad",
                               "let it lift less, or move its line outwards");
        for (std::size_t m = 0; m < l; ++m)
            if (tears(height - levers_[m].heightAt(strokes[m]),
                      distanceBetween(mesh_, mesh_.lineNodes[l], mesh_.lineNodes[m])))
                throw InvalidInput("levers " + inQuotes(levers_[m].name) + " and " + inQuotes(levers_[l].name),
                                   "they pull against each other: the sheet between them is too short",
                                   "let one lift less, or move their lines apart");
    }
}

std::string LeveredSheet::namesAndStrokes(std::span<const double> strokes) const {
    std::string text;
    for (std::size_t l = 0; l < levers_.size(); ++l)
        if (strokes[l] > 0.0)
            text += (text.empty() ? "" : ", ") + inQuotes(levers_[l].name) + " at " +
                    std::to_string(std::lround(100.0 * strokes[l])) + " %";
    return text.empty() ? "rest" : text;
}

std::string LeveredSheet::strongestLevers(const SheetPose& pose) const {
    std::size_t up = 0;
    std::size_t down = 0;
    for (std::size_t l = 0; l < levers_.size(); ++l) {
        if (pose.loads[l].force > pose.loads[up].force) up = l;
        if (pose.loads[l].force < pose.loads[down].force) down = l;
    }
    return "levers " + inQuotes(levers_[up].name) + " and " + inQuotes(levers_[down].name);
}

} // namespace lumorph
