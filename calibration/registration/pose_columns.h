#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

/// Which columns of a table of poses are what, by their names: private to pose_file.cpp.
namespace lumorph {

struct PoseColumns {
    std::vector<std::size_t> columns;        ///< of time (where one is named), x, y, z, qx, qy, qz, qw
    double timeUnit = 1.0, lengthUnit = 1.0; ///< seconds and metres of one, where the names say so
};

/// By names as TUM (`timestamp tx ty tz qx qy qz qw`), EuRoC (`p_RS_R_x [m]`, `q_RS_w []`) and rostopic
/// (`field.pose.position.x`) have them, and `time_ms` or `x [mm]`. Nothing where one of place and quaternion is not
/// named.
[[nodiscard]] std::optional<PoseColumns> columnsByName(std::span<const std::string_view> names);

} // namespace lumorph
