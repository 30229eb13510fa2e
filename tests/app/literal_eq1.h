#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lumorph::test {

/// A grid of bytes as a NRRD file holds it, x fastest. Read with nothing of Lumorph's.
struct LiteralGrid {
    std::string header; ///< as it stands in the file, its empty last line included
    std::array<int, 3> size{};
    std::vector<std::uint8_t> values;

    [[nodiscard]] std::size_t index(int x, int y, int z) const {
        return static_cast<std::size_t>((z * size[1] + y) * size[0] + x);
    }
};
[[nodiscard]] LiteralGrid readLiteralGrid(const std::filesystem::path& file);

/// The exported grids of a field.
struct LiteralField {
    struct Actuator {
        LiteralGrid v0;
        LiteralGrid v1;
        LiteralGrid base;
        LiteralGrid top;
    };
    int levels = 0;
    LiteralGrid body;
    LiteralGrid background;
    std::vector<Actuator> actuators;
};
[[nodiscard]] LiteralField readLiteralField(const std::filesystem::path& folder, std::size_t actuators, int levels);

struct LiteralVote {
    int level = 0;
    bool reached = false;
    std::vector<double> errors;        ///< |V~(i,j) - V_T| for each level
    std::vector<double> intersections; ///< V~(i,j) . V_T for each level
};

/// Eq. 1 of the paper for one actuator, by looping over every voxel for every level. `target` is 0 or 1.
[[nodiscard]] LiteralVote evaluateEq1(const LiteralField& field, std::size_t actuator, const LiteralGrid& target);

} // namespace lumorph::test
