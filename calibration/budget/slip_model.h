#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "calibration/verify/room_surface.h"
#include "core/base/progress.h"
#include "core/rig/rig.h"
#include "core/scene/installation.h"

namespace lumorph {

/// What is looked at when errors are added up.
struct SlipView {
    std::vector<double> commanded; ///< strokes of the device, one an actuator; empty: all half raised
    /// How far before the surface a thing that is shown floats, along the sight, metres. On the surface itself (0) an
    /// eye that is elsewhere changes nothing.
    double floats = 0.02;
    std::size_t tries = 3000; ///< places that are spread over the device; those that are lit and seen count
};

/// A place of the device that a projector lights and the eye sees.
struct SlipPoint {
    SurfacePoint at;
    std::size_t projector = 0;
};

/// How far what is shown slips beside where the eye should see it, on the device and across the sight, to first order:
/// mean squares over its places, for an error of one unit along each axis (in the world's axes, as forms of its
/// covariance). A plain value.
struct SlipModel {
    std::vector<SlipPoint> points;
    /// One a projector of the room: of its light alone that falls one metre beside, in any direction across the beam. A
    /// projector that lights nothing of the device has none.
    std::vector<double> lights;
    Eigen::Matrix3d trackerShift = Eigen::Matrix3d::Zero(), trackerTurn = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d deviceShift = Eigen::Matrix3d::Zero(), deviceTurn = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d eye = Eigen::Matrix3d::Zero();
    /// Mean products of the slips by a shift of one and the same of the other, the axes added up.
    double trackerWithDevice = 0.0, trackerWithEye = 0.0, deviceWithEye = 0.0;
    std::vector<double> strokes; ///< one an actuator: of a whole stroke
};

/// The device lies where the room has it, the viewer is the room's. Throws InvalidInput where no place of the device is
/// both lit and seen, for strokes that do not fit the rig, or for a floating height that is not from 0 to 0.2 m;
/// Cancelled. Rigs with more than `RoomSurface::kMostServos` actuators have no strokes.
[[nodiscard]] SlipModel slipModelOf(const Rig& rig, const Installation& room, const SlipView& view = {},
                                    const Progress& progress = {});

/// The view's strokes as they are for this rig.
[[nodiscard]] std::vector<double> commandedOf(const SlipView& view, const Rig& rig);

} // namespace lumorph
