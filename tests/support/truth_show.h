#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/render/spatial_renderer.h"
#include "tests/support/truth.h"
#include "tests/support/truth_cases.h"

namespace lumorph::test {

/// What is shown on the tablet in the truth test. `water`: soft, moving, with reflections. `bricks`: hard edges on the
/// skin. `lines`: three projector pixels wide. `objects`: boxes and balls 3 cm and more above the surface, with their
/// shadows. Each has a ball at the same height, so that the eye's frame is the same for all.
enum class TruthContent { water, bricks, lines, objects };
inline constexpr std::array kTruthContents{TruthContent::water, TruthContent::bricks, TruthContent::lines,
                                           TruthContent::objects};
[[nodiscard]] const char* nameOf(TruthContent content);

/// The frame of a content at a state, seen from an eye.
[[nodiscard]] ShowFrame truthFrame(const TruthDevice& device, const TruthState& state, const glm::vec3& eye,
                                   TruthContent content);
/// White balls of 2 mm radius on black, around the given world points.
[[nodiscard]] ShowFrame ballsFrame(const TruthDevice& device, const TruthState& state, const glm::vec3& eye,
                                   const std::vector<glm::dvec3>& points);

/// Decibels of one picture.
struct TruthFigure {
    double rendered = 0.0; ///< of the renderer's projector picture, in the lab, against the low-passed eye picture
    double ideal = 0.0;    ///< of the ideal projector picture
    /// 36 dB, or 1 dB below what ideal resampling reaches where that is lower.
    [[nodiscard]] double bar() const { return std::min(36.0, ideal - 1.0); }
};
struct TruthFigures {
    TruthFigure all;    ///< over all that is judged
    TruthFigure device; ///< over the device alone
};
[[nodiscard]] TruthFigures judge(TruthBench& bench, const Image& eyePicture, const Image& projected);

/// Shares of what the eye sees that the mask covers.
struct TruthCoverage {
    double device = 0.0;
    double flaps = 1.0;        ///< lifted ones; 1 where the eye sees none
    double disagreement = 0.0; ///< share of device pixels at which mask and lab differ
    double judged = 0.0;       ///< share of device pixels that are judged
    double judgedFlaps = 1.0;
};
[[nodiscard]] TruthCoverage coverageOf(const TruthBench& bench, const TruthDevice& device, const TruthState& state,
                                       const Image& mask);

} // namespace lumorph::test
