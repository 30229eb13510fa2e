#include "calibration/lab/device_lab.h"

#include <cstdio>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "calibration/doctor/device_capture.h"
#include "calibration/lab/board_lab.h"
#include "calibration/lab/lab.h"
#include "calibration/lab/lab_folder.h"
#include "calibration/lab/lab_photograph.h"
#include "calibration/lab/lab_truth.h"
#include "calibration/lab/lab_world.h"
#include "calibration/patterns/capture_order.h"
#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kRaised = 0.5; // of a stroke: upright flaps show light only their edge

/// A row a shot: the device at rest, then with each actuator raised.
std::vector<std::vector<double>> statesOf(const Rig& rig) {
    std::vector<std::vector<double>> states(rig.actuatorCount() + 1, std::vector<double>(rig.actuatorCount(), 0.0));
    for (std::size_t i = 0; i < rig.actuatorCount(); ++i) states[i + 1][i] = kRaised;
    return states;
}

std::string numbered(const char* word, std::size_t number) {
    char text[32];
    std::snprintf(text, sizeof(text), "%s_%03zu", word, number);
    return text;
}

/// The installation's world around the device in one state.
LabWorld worldOf(const Installation& room, const Rig& rig, const std::vector<double>& strokes, double ambient) {
    LabWorld world = roomWorld(room, rig, strokes);
    InstalledProjector projector = linearProjector(room.projectors.front());
    projector.enabled = true;
    world.ambient = glm::vec3(static_cast<float>(ambient * projector.peak));
    world.projectors = {{projector, {}}};
    return world;
}

nlohmann::json truthOf(const CalibratedCamera& camera, const Installation& room) {
    const glm::dmat4 fromDevice = camera.cameraFromWorld * glm::dmat4(room.worldFromDevice);
    nlohmann::json truth = jsonOf(camera);
    truth["R"] = rotationJson(fromDevice);
    truth["T"] = shiftJson(fromDevice, 1.0);
    return truth;
}

std::string truthText(const DeviceLabCapture& capture, const Rig& rig, const BoardLabOptions& options) {
    return nlohmann::json{{"lumorph", "lab capture of the device"},
                          {"rig", rig.name()},
                          {"seed", capture.seed},
                          {"pattern", capture.pattern},
                          {"camera", truthOf(capture.room.cameras.front().camera, capture.room)},
                          {"projector", truthOf(capture.room.projectors.front().camera, capture.room)},
                          {"pictures",
                           {{"whiteLevel", options.whiteLevel},
                            {"ambient", options.ambient},
                            {"blur", options.blur},
                            {"noise", options.noise},
                            {"shotNoise", options.shotNoise}}}}
               .dump(1) +
           "\n";
}

} // namespace

void writeDeviceLabCapture(const DeviceLabCapture& capture, const Rig& rig, const std::filesystem::path& folder,
                           const Progress& progress) {
    if (capture.room.projectors.empty() || capture.room.cameras.empty())
        throw InvalidInput("capture in the lab", "its room has no projector or no camera", "add one in the studio");
    const BoardLabOptions options;
    const CalibratedCamera& camera = capture.room.cameras.front().camera;
    const glm::ivec2 panel = capture.room.projectors.front().camera.size;
    const CaptureOrder order = parsePattern(capture.pattern, {panel.x, panel.y});
    LabFolder making(folder);
    const auto states = statesOf(rig);
    std::string table = "shot";
    for (const Actuator& actuator : rig.actuators()) table += ',' + actuator.name;
    double exposure = 0.0;
    std::uint32_t pictures = 0;
    for (std::size_t s = 0; s < states.size(); ++s) {
        const Progress part = progress.part(static_cast<double>(s) / static_cast<double>(states.size()),
                                            static_cast<double>(s + 1) / static_cast<double>(states.size()));
        Lab lab(worldOf(capture.room, rig, states[s], options.ambient));
        const LabSight sight = lab.look(camera, options.samples);
        if (s == 0) exposure = exposureOf(lab, sight, options.whiteLevel, "capture in the lab");
        std::vector<LabShot> shots;
        for (std::size_t i = 0; i < order.images.size(); ++i) {
            part.throwIfCancelled();
            part.report(static_cast<double>(i) / static_cast<double>(order.images.size()), "photographing");
            lab.show(0, pictureOf(drawPattern(order.images[i], order.projector)));
            cv::Mat light = exposure * lightIn(lab, sight);
            cv::GaussianBlur(light, light, {}, options.blur);
            shots.push_back({numbered("shot", s), numbered("image", i) + ".png",
                             withNoise(light, options, capture.seed * 65537U + pictures++)});
        }
        making.write(shots, part);
        table += '\n' + numbered("shot", s);
        for (const double stroke : states[s]) table += ',' + std::to_string(stroke);
    }
    making.write(kStatesFile, table + '\n');
    making.write("truth.json", truthText(capture, rig, options));
    making.finish();
}

} // namespace lumorph
