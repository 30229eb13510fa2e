#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <opencv2/core.hpp>

namespace lumorph {

/// What the projectors do in a photograph: each fills its picture with one colour, 0 to 255, or its lens is covered, so
/// that not even its black comes out. One entry a projector of the room.
using LightShow = std::vector<std::optional<glm::ivec3>>;

/// What photographs flat light: projectors, and a camera whose exposure is set by hand.
class LightBench {
public:
    virtual ~LightBench() = default;
    /// 8-bit red, green, blue, or grey of a camera without colour; as large as the camera's picture.
    [[nodiscard]] virtual cv::Mat photograph(const LightShow& show, double seconds) = 0;
    [[nodiscard]] virtual double shortestExposure() const = 0; ///< seconds
    [[nodiscard]] virtual double longestExposure() const = 0;
    /// Of a series that was photographed before: the exposure that was found for full white, and after how many
    /// photographs; it is not looked for again.
    struct FoundExposure {
        double seconds = 0.0;
        int photographs = 0;
    };
    [[nodiscard]] virtual std::optional<FoundExposure> foundExposure() const { return std::nullopt; }
    /// Told once it was found.
    virtual void exposureFound(const FoundExposure& /*found*/) {}
};

} // namespace lumorph
