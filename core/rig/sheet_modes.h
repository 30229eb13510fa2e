#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace lumorph {

/// Metres by which a lever must move a row in some state of the grid to count as moving it.
inline constexpr float kSheetStill = 1e-6F;

/// Shapes of a sheet over a grid of joint states, reduced to modes (a truncated singular value decomposition). Row r is
/// displaced from rest by sum_k c_k(s) mode_k(r). The c_k interpolate the grid's states by tensor-product Lagrange
/// polynomials in the strokes s of the levers, one axis of the grid each.
struct SheetModes {
    static constexpr std::size_t kMostActuators = 8;
    static constexpr std::size_t kMostLevels = 5; ///< strokes of an axis
    static constexpr std::size_t kMostModes = 64;
    static constexpr std::size_t kMostCoefficients = 65'536;

    /// Of each axis the strokes of its nodes: 2 to kMostLevels, ascending from 0 to 1, at least 0.01 apart.
    std::vector<std::vector<float>> strokes;
    std::size_t modeCount = 0;
    /// [state * modeCount + mode]; of the states the last axis varies fastest. All 0 at state 0, which is rest.
    std::vector<float> coefficients;
    /// [row * modeCount + mode]; coefficient x mode is in metres.
    std::vector<glm::vec3> modes;
    /// Of so many states of the grid an equilibrium besides the one that is kept is known, and so far apart are the two
    /// at most, metres. It only describes the sheet.
    std::uint32_t secondStates = 0;
    float secondDistance = 0.0F;

    [[nodiscard]] std::size_t stateCount() const noexcept;
    [[nodiscard]] std::size_t rowCount() const noexcept { return modeCount == 0 ? 0 : modes.size() / modeCount; }
    bool operator==(const SheetModes&) const = default;
};

/// c_k(s) of all modes. `strokes` has one entry in [0, 1] an axis, `out` one a mode. Exactly the grid's coefficients at
/// its nodes. Allocates nothing.
void modeCoefficients(const SheetModes& modes, std::span<const double> strokes, std::span<float> out) noexcept;

/// Where one row is displaced to at these strokes, metres. For many rows at the same strokes work out their
/// coefficients once.
[[nodiscard]] glm::vec3 rowDisplacement(const SheetModes& modes, std::size_t row,
                                        std::span<const double> strokes) noexcept;

/// What of a rig's mesh follows its sheet.
struct SheetMotion {
    static constexpr std::uint32_t kNoRow = ~std::uint32_t{0};
    static constexpr std::size_t kMostShares = 64; ///< different ones
    /// A vertex is displaced as its row is at strokes share x s. Rows of a skirt below the sheet's rim have shares
    /// below 1, so that the solid holds what the rim passed on its way from rest (RigParts::pathInside).
    struct Follower {
        std::uint32_t row = kNoRow; ///< of the modes; kNoRow: the vertex stays where it rests
        float share = 1.0F;         ///< of the path, in (0, 1]
        bool operator==(const Follower&) const = default;
    };
    SheetModes modes;
    std::vector<Follower> followers; ///< one a vertex of the rest mesh; each row has at least one
    bool operator==(const SheetMotion&) const = default;
};

} // namespace lumorph
