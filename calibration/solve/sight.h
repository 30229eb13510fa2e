#pragma once

#include <Eigen/Core>

#include "calibration/solve/installation_bundle.h"
#include "calibration/solve/projection.h"

namespace lumorph {

/// What an error of one camera's sight of one body depends on, side by side; a point's ends before the projector.
enum SightColumn {
    kLensColumn = 0,
    kCameraColumn = kLensColumn + kLensParameters,
    kBodyColumn = kCameraColumn + 6,
    kBoardColumn = kBodyColumn + 6,
    kStretchColumn = kBoardColumn + kBoardStretch,
    kMirrorColumn = kBoardColumn + kBoardParameters,
    kProjectorLensColumn = kMirrorColumn + 3,
    kProjectorColumn = kProjectorLensColumn + kLensParameters,
    kSightColumns = kProjectorColumn + 6,
};
using SightSlopes = Eigen::Matrix<double, 2, kSightColumns>;

/// One camera, one body and, for light, one projector, where they are believed to be.
struct Sight {
    Lens lens{}, projectorLens{};
    PoseMatrix camera, body, projector; ///< the body's is `worldFromBody`, the others' `fromWorld`
    BoardShape board;
    Eigen::Vector3d mirror;

    /// Where the point or the light is put, less where it was seen, pixels, and if wanted the slopes. Returns whether
    /// it can be seen at all.
    bool error(const SeenPoint& seen, Eigen::Vector2d& error, SightSlopes* slopes) const;
    bool error(const SeenLight& seen, Eigen::Vector2d& error, SightSlopes* slopes) const;

private:
    [[nodiscard]] Eigen::Vector3d mirrored(const Eigen::Vector3d& place) const;
    [[nodiscard]] Eigen::Matrix3d reflection() const;
    [[nodiscard]] Eigen::Matrix3d mirroredByMirror(const Eigen::Vector3d& place) const;
};

} // namespace lumorph
