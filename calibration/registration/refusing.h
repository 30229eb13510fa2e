#pragma once

#include <cstdio>
#include <string>

#include <Eigen/Core>

#include "calibration/registration/pose_track.h"

/// What all registrations share: private to them.
namespace lumorph::registration {

inline constexpr double kDegree = 0.017453292519943295;

[[nodiscard]] inline Eigen::Vector3d eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// With so many digits behind the point.
[[nodiscard]] inline std::string number(double value, int digits) {
    char text[40];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

[[noreturn]] inline void refuse(Cause cause, const char* what, std::string why, std::string remedy) {
    throw CaptureRefused({cause, what, {}, std::move(why), std::move(remedy)});
}

} // namespace lumorph::registration
