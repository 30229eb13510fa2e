#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "calibration/decode/refusal.h"
#include "calibration/light/light_bench.h"
#include "calibration/light/light_patches.h"
#include "core/base/progress.h"
#include "core/scene/installation.h"

namespace lumorph {

/// How far light that no fit saw is from what a room says of it, as shares of the light.
struct FreshLight {
    double median = 0.0, most = 0.0; ///< most: in 95 of 100 places and channels
    std::size_t places = 0;
};

/// What a measurement of light says.
struct LightCalibration {
    Installation room; ///< as believed, with the measured light of its projectors and the colours of device and table
    FreshLight fresh;  ///< by `room`
    FreshLight before; ///< the same photographs by what was believed
    double responseRms = 0.0;         ///< by which exposures contradict the camera's curve, as a share of the light
    double ambient = 0.0;             ///< light of the room and all blacks, as a share of white
    bool hasWhiteSheet = false;       ///< what is white was told by a sheet of paper
    std::string assumption;           ///< what a camera cannot tell apart, and how it was decided: a sentence or two
    std::vector<std::string> figures; ///< sentences
    std::vector<Finding> warnings;
    std::optional<Finding> refusal; ///< nothing may be used
    int photographs = 0;
    [[nodiscard]] bool good() const noexcept { return !refusal; }
};

/// Measures, by photographs of flat light at several exposures, the camera's own response; of each projector that is on
/// the response of each channel, its black and its gains, relative to all the others; and the colours of device and
/// table. `patches` are where `believed` has them, a sheet of white paper among them if one lies there. Fresh greys,
/// which the fit never saw, judge the result.
///
/// What cannot be told: how bright the light is as a whole (the geometric mean of all gains is taken to be 1), the
/// camera's own colours (what it shows with three equal bytes is taken to be neutral; of a camera without colour the
/// tint that all projectors share), and without a white sheet the
/// tint of a projector's white from that of the paper it falls on (the lighter of device and table is taken to be
/// white). What is projected comes out right in either case: only products of the two are used.
///
/// A capture that cannot be trusted becomes a `refusal`, with `room` as it was believed. Throws Cancelled, and
/// InvalidInput for a room without a projector that is on.
[[nodiscard]] LightCalibration measureLight(const Installation& believed, const std::vector<LightPatch>& patches,
                                            LightBench& bench, const Progress& progress = {});

} // namespace lumorph
