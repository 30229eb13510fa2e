#include "calibration/lab/lab_truth.h"

namespace lumorph {

using Json = nlohmann::json;

Json jsonOf(const glm::dmat4& matrix) {
    Json rows = Json::array();
    for (int row = 0; row < 4; ++row) rows.push_back({matrix[0][row], matrix[1][row], matrix[2][row], matrix[3][row]});
    return rows;
}

Json rotationJson(const glm::dmat4& matrix) {
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) rows.push_back({matrix[0][row], matrix[1][row], matrix[2][row]});
    return rows;
}

Json shiftJson(const glm::dmat4& matrix, double metresPerUnit) {
    return {matrix[3][0] / metresPerUnit, matrix[3][1] / metresPerUnit, matrix[3][2] / metresPerUnit};
}

Json jsonOf(const CalibratedCamera& camera) {
    return {
        {"K", {{camera.focal.x, 0.0, camera.principal.x}, {0.0, camera.focal.y, camera.principal.y}, {0.0, 0.0, 1.0}}},
        {"distortion", camera.distortion},
        {"size", {camera.size.x, camera.size.y}},
        {"fromWorld", jsonOf(camera.cameraFromWorld)}};
}

} // namespace lumorph
