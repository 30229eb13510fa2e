#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/render/gl/program.h"

namespace lumorph {

/// What a surface needs of the eye pass's shaders; bits that add up. A program holds only what its surface needs,
/// because in software every operation counts.
namespace eye_feature {
enum Bit : std::uint32_t {
    skin = 1U << 0U,
    holes = 1U << 1U,     ///< some of those below
    projected = 1U << 2U, ///< sent by a projector
    holeMask = 1U << 3U,
    cutout = 1U << 4U,
    colorTexture = 1U << 5U,
    normalA = 1U << 6U,
    normalB = 1U << 7U,
    specular = 1U << 8U,
    reflection = 1U << 9U,
    refraction = 1U << 10U,
    unlit = 1U << 11U,
    shadow = 1U << 12U,
    lamp = 1U << 13U, ///< the shadow's light
    fog = 1U << 14U,
    blend = 1U << 15U,
    twoSided = 1U << 16U,
    table = 1U << 17U, ///< it lies in y = 0
    dither = 1U << 18U,
    holesBelow = 1U << 19U, ///< the table under a device with holes
    secondFog = 1U << 20U,
    shared = 1U << 21U,   ///< by several projectors
    gamma = 1U << 22U,    ///< of the projector
    response = 1U << 23U, ///< of the projector, measured
    lightShift = 24U,     ///< the number of lights stands above this bit, in three bits
    holeShift = 27U       ///< the number of the skin's round holes
};
} // namespace eye_feature

inline constexpr std::uint32_t kMostEyeLights = 4;
inline constexpr std::uint32_t kMostRoundHoles = 31;

/// The programs of the eye pass, built when first used. One that the driver refuses is named once, and a plain one
/// stands in for it.
class EyePrograms {
public:
    enum class Stage { surface, depth, crease };

    /// Makes the program current. Throws DataError when the plain one is refused too.
    Program& use(Stage stage, std::uint32_t features);
    [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }
    [[nodiscard]] std::size_t objectCount() const noexcept;

private:
    struct Entry {
        Program program;
        bool tried = false;
    };
    std::map<std::pair<Stage, std::uint32_t>, Entry> programs_;
    std::vector<std::string> warnings_;
};

} // namespace lumorph
