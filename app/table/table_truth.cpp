#include "app/table/table_truth.h"

#include <fstream>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "calibration/decode/calibration_board.h"
#include "calibration/lab/board_lab.h"
#include "calibration/lab/true_room.h"
#include "core/base/error.h"
#include "core/scene/installation_store.h"

namespace lumorph::table {

namespace {

constexpr double kShift = 0.02;       // metres, of what somebody has put up
constexpr double kTurn = 0.02;        // radians
constexpr double kZoom = 0.02;        // of the focal length
constexpr double kDeviceAside = 0.03; // metres

/// Turned about its own place and shifted, as a stand is that was put up by eye.
void putUp(CalibratedCamera& camera, std::mt19937& engine) {
    std::normal_distribution<double> dice;
    const auto three = [&](double sigma) {
        const double x = dice(engine), y = dice(engine), z = dice(engine);
        return sigma * glm::dvec3(x, y, z);
    };
    const glm::dvec3 position = positionOf(camera) + three(kShift);
    const glm::dvec3 turn = three(kTurn);
    glm::dmat4 turned = camera.cameraFromWorld;
    if (const double angle = glm::length(turn); angle > 0.0)
        turned = glm::rotate(glm::dmat4(1.0), angle, turn / angle) * turned;
    turned[3] = glm::dvec4(-(glm::dmat3(turned) * position), 1.0);
    camera.cameraFromWorld = turned;
    camera.focal *= 1.0 + kZoom * dice(engine);
}

} // namespace

TableTruth drawTruth(const TableOrder& order, const std::shared_ptr<const Rig>& rig) {
    if (order.screens.empty())
        throw InvalidInput("table", "there is no screen that a projector could show", "name one by --screen");
    if (order.cameras < 1 || static_cast<std::size_t>(order.cameras) > order.screens.size())
        throw InvalidInput("table", "there cannot be " + std::to_string(order.cameras) + " cameras",
                           "each projector has at most one beside it");
    static_cast<void>(parseCalibrationBoard(order.board));
    std::mt19937 engine(order.seed * 9'176'941U + 11U);
    Installation room = defaultInstallation();
    room.projectors.resize(order.screens.size(), room.projectors.front());
    room.cameras.clear();
    for (std::size_t k = 0; k < order.screens.size(); ++k) {
        InstalledProjector& projector = room.projectors[k];
        projector.name = "Projector " + std::to_string(k + 1);
        projector.camera = withSize(projector.camera, order.screens[k]);
        Installation stood = labTruth(room, k);
        projector.camera = stood.projectors.front().camera;
        putUp(projector.camera, engine);
        if (k >= static_cast<std::size_t>(order.cameras)) continue;
        InstalledCamera camera;
        camera.name = "Camera " + std::to_string(k + 1);
        camera.camera = withSize(defaultLabCamera(projector.camera), order.cameraSize);
        putUp(camera.camera, engine);
        room.cameras.push_back(camera);
    }
    std::normal_distribution<double> dice(0.0, kDeviceAside);
    const double x = dice(engine), z = dice(engine), turn = dice(engine);
    room.worldFromDevice =
        glm::mat4(glm::rotate(glm::translate(glm::dmat4(1.0), {x, 0.0, z}), 5.0 * turn, {0.0, 1.0, 0.0}));
    return {order.seed, rig, trueRoom(room, rig->actuators(), order.seed), order.board};
}

void writeTruth(const TableTruth& truth, const std::filesystem::path& file) {
    nlohmann::ordered_json json;
    json["seed"] = truth.seed;
    json["rig"] = truth.rig->name();
    json["board"] = truth.board;
    json["room"] = nlohmann::ordered_json::parse(installationText(truth.room));
    std::ofstream out(file);
    out << json.dump(1) << '\n';
    out.close();
    if (!out) throw DeviceError(file.string(), "the truth cannot be written", "choose a folder that can be written to");
}

} // namespace lumorph::table
