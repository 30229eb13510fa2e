#include "tests/app/literal_eq1.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace lumorph::test {

namespace {

constexpr int kUnchangedByActuator = 255;

double rampAtLevel(int v0, int v1, int level) {
    if (level < v0) return 0.0;
    if (level >= v1) return 1.0;
    return static_cast<double>(level - v0 + 1) / static_cast<double>(v1 - v0 + 1);
}

/// V~(i,j) of one voxel, in [0, 1].
double expectation(const LiteralField& field, const LiteralField::Actuator& actuator, std::size_t voxel, int level) {
    const int v0 = actuator.v0.values[voxel];
    if (v0 == kUnchangedByActuator) return field.background.values[voxel] / 255.0;
    const double base = actuator.base.values[voxel];
    const double top = actuator.top.values[voxel];
    return (base + (top - base) * rampAtLevel(v0, actuator.v1.values[voxel], level)) / 255.0;
}

} // namespace

LiteralGrid readLiteralGrid(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::size_t end = text.find("\n\n");
    if (end == std::string::npos) throw std::runtime_error(file.string() + " is no NRRD file");
    LiteralGrid grid;
    grid.header = text.substr(0, end + 2);
    std::istringstream lines(grid.header);
    bool raw = false;
    bool bytes = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("sizes:"))
            std::istringstream(line.substr(6)) >> grid.size[0] >> grid.size[1] >> grid.size[2];
        if (line == "encoding: raw") raw = true;
        if (line == "type: uint8" || line == "type: unsigned char") bytes = true;
    }
    grid.values.assign(text.begin() + static_cast<std::ptrdiff_t>(end) + 2, text.end());
    const auto voxels = static_cast<std::size_t>(grid.size[0] * grid.size[1] * grid.size[2]);
    if (!raw || !bytes || voxels == 0 || grid.values.size() != voxels)
        throw std::runtime_error(file.string() + " is not a raw grid of bytes");
    return grid;
}

LiteralField readLiteralField(const std::filesystem::path& folder, std::size_t actuators, int levels) {
    LiteralField field;
    field.levels = levels;
    field.body = readLiteralGrid(folder / "body.nrrd");
    field.background = readLiteralGrid(folder / "background.nrrd");
    for (std::size_t i = 0; i < actuators; ++i) {
        const auto part = [&](const std::string& name) {
            return readLiteralGrid(folder / ("actuator-" + std::to_string(i) + "-" + name + ".nrrd"));
        };
        field.actuators.push_back({part("v0"), part("v1"), part("base"), part("top")});
    }
    return field;
}

LiteralVote evaluateEq1(const LiteralField& field, std::size_t actuator, const LiteralGrid& target) {
    const LiteralField::Actuator& of = field.actuators[actuator];
    LiteralVote vote;
    std::size_t changeable = 0; // target voxels that this actuator can change
    for (std::size_t v = 0; v < target.values.size(); ++v)
        if (field.body.values[v] == 0 && target.values[v] != 0 && of.v0.values[v] != kUnchangedByActuator) ++changeable;
    for (int level = 0; level < field.levels; ++level) {
        double error = 0.0;
        double intersection = 0.0;
        for (std::size_t v = 0; v < target.values.size(); ++v) {
            if (field.body.values[v] != 0) continue;
            const double covered = expectation(field, of, v, level);
            const double wanted = target.values[v];
            error += std::abs(covered - wanted);
            intersection += covered * wanted;
        }
        vote.errors.push_back(error);
        vote.intersections.push_back(intersection);
    }
    if (changeable == 0) return vote;

    const double least = std::max(1.0, 0.01 * static_cast<double>(changeable));
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < vote.errors.size(); ++j)
        if (vote.intersections[j] >= least) best = std::min(best, vote.errors[j] / vote.intersections[j]);
    for (std::size_t j = 0; j < vote.errors.size() && !vote.reached; ++j) {
        if (vote.intersections[j] < least || vote.errors[j] / vote.intersections[j] > best * (1.0 + 1e-9)) continue;
        vote.level = static_cast<int>(j);
        vote.reached = true;
    }
    return vote;
}

} // namespace lumorph::test
