#include "calibration/registration/layout_check.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

#include "calibration/registration/refusing.h"

namespace lumorph::registration {

void checkLayout(std::span<const glm::dvec3> places, const char* what, double shortest) {
    constexpr double kNarrowest = 0.1; // of the spread across to that along
    double apart = 0.0;
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& a : places) {
        mean += a / double(places.size());
        for (const glm::dvec3& b : places) apart = std::max(apart, glm::distance(a, b));
    }
    if (apart < shortest)
        refuse(Cause::pointsDegenerate, what,
               "they lie too close together, within " + number(1000.0 * apart, 0) + " mm",
               "touch points farther apart, at the edges of what can be reached");
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const glm::dvec3& a : places) spread += eigen(a - mean) * eigen(a - mean).transpose();
    const Eigen::Vector3d along = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
    if (std::sqrt(std::max(0.0, along[1])) < kNarrowest * std::sqrt(along[2]))
        refuse(Cause::pointsDegenerate, what, "they all lie on one line: a turn about it stays open",
               "also touch points beside that line");
}

} // namespace lumorph::registration
