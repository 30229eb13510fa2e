#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/rig/rig.h"

namespace lumorph {

/// Vertices whose rows take the same levers into account at the same share of their strokes: one set of mode
/// coefficients serves all of them.
struct SheetPath {
    float share = 1.0F;
    std::uint32_t axes = 0; ///< bit a: axis a of the grid
    bool operator==(const SheetPath&) const = default;
};

/// The mode coefficients of a path at a joint state.
struct PathCoefficients {
    bool still = true;                                ///< nothing moves; `values` are unset
    std::array<float, SheetModes::kMostModes> values; ///< 0 beyond the last mode up to a whole vector register
};

/// A rig's sheet with what deformation needs looked up.
class CompiledSheet {
public:
    static constexpr std::uint16_t kNoPath = 0xFFFF;

    /// `motion` is kept by reference; it and the levers have passed `validate`.
    CompiledSheet(const SheetMotion& motion, std::span<const Actuator> actuators);

    [[nodiscard]] const SheetMotion& motion() const noexcept { return motion_; }
    [[nodiscard]] std::span<const SheetPath> paths() const noexcept { return paths_; }
    /// Index of a vertex' path; kNoPath where it stays at rest.
    [[nodiscard]] std::uint16_t pathOf(std::uint32_t vertex) const noexcept { return pathOf_[vertex]; }
    [[nodiscard]] std::uint16_t actuatorOf(std::size_t axis) const noexcept { return actuatorOfAxis_[axis]; }

    /// `strokes` has one entry an actuator of the rig.
    void evaluate(std::uint16_t path, std::span<const double> strokes, PathCoefficients& out) const noexcept;
    /// The displacement of a row, metres. Always summed in the same order: equal bit for bit wherever it is called.
    [[nodiscard]] glm::vec3 displacement(std::uint32_t row, const float* coefficients) const noexcept;

private:
    [[nodiscard]] std::uint32_t axesThatMove(std::uint32_t row) const;

    const SheetMotion& motion_;
    std::vector<std::uint16_t> actuatorOfAxis_;
    std::size_t padded_ = 0;   ///< modes in whole vector registers
    std::vector<float> modes_; ///< of each row x of all modes, y of all, z of all
    std::vector<SheetPath> paths_;
    std::vector<std::uint16_t> pathOf_; ///< one a vertex
};

} // namespace lumorph
