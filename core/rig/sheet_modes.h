#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

/// The shapes of an elastic sheet over the joint states of its actuators, reduced to modes:
///     positions(s) = rest + sum_k c_k(s) mode_k,
/// where c_k is the tensor product of Lagrange polynomials over a grid of strokes. Immutable.
class SheetModes {
public:
    static constexpr std::size_t kMostActuators = 8;
    static constexpr std::size_t kMostLevels = 5;
    static constexpr std::size_t kMostModes = 64;

    struct Parts {
        std::vector<int> levels;         ///< of each actuator: strokes 0, 1/(levels - 1), .. 1
        std::vector<glm::vec3> rest;     ///< one a vertex, metres
        std::vector<glm::vec3> modes;    ///< [mode][vertex], without unit
        std::vector<float> coefficients; ///< [grid point][mode], metres; the last actuator's level runs fastest
        bool operator==(const Parts&) const = default;
    };
    /// Throws InvalidInput when sizes disagree or are too large.
    explicit SheetModes(Parts parts);

    [[nodiscard]] const Parts& parts() const noexcept { return parts_; }
    [[nodiscard]] std::size_t actuatorCount() const noexcept { return parts_.levels.size(); }
    [[nodiscard]] std::size_t vertexCount() const noexcept { return parts_.rest.size(); }
    [[nodiscard]] std::size_t modeCount() const noexcept { return modeCount_; }

    /// `strokes` has one entry in [0, 1] an actuator, `out` one a mode.
    void coefficientsAt(std::span<const double> strokes, std::span<float> out) const noexcept;
    /// Positions of all vertices; `out` has one a vertex.
    void deform(std::span<const double> strokes, std::span<glm::vec3> out) const noexcept;
    /// Positions of the listed vertices: out[k] is that of vertices[k].
    void deform(std::span<const double> strokes, std::span<const std::uint32_t> vertices,
                std::span<glm::vec3> out) const noexcept;

private:
    Parts parts_;
    std::size_t modeCount_ = 0;
};

} // namespace lumorph
