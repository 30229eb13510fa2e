#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/calibrate_output.h"
#include "app/cli/commands.h"
#include "app/cli/pattern_arguments.h"
#include "calibration/doctor/device_capture.h"
#include "core/base/error.h"
#include "core/rig/rig_file.h"

namespace lumorph::cli {

namespace {

struct DeviceCaptureArguments {
    std::string rig;
    std::vector<std::string> projectors; ///< "NAME=WIDTHxHEIGHT", or the size alone
    PatternArguments patterns;
};

/// Who has no name is called "projector", or by a number where there are several.
std::vector<NamedOrder> ordersOf(const DeviceCaptureArguments& arguments) {
    std::vector<NamedOrder> orders;
    for (const std::string& text : arguments.projectors) {
        const std::size_t equals = text.find('=');
        std::string name = equals == std::string::npos ? "projector" : text.substr(0, equals);
        if (equals == std::string::npos && arguments.projectors.size() > 1)
            name += "_" + std::to_string(orders.size() + 1);
        if (name.empty() || std::ranges::find(orders, name, &NamedOrder::name) != orders.end())
            throw InvalidInput("--projector " + text, name.empty() ? "its name is empty" : "its name is there twice",
                               "name each as its folders: NAME=1024x768");
        const cv::Size size = parseProjectorSize(equals == std::string::npos ? text : text.substr(equals + 1));
        orders.push_back({name, arguments.patterns.orderFor(size)});
    }
    return orders;
}

nlohmann::json placedJson(const CalibratedDevice& device, const std::string& name, const PoseVector& pose,
                          const PoseVector& sigma) {
    nlohmann::json all = jsonOf(device);
    all["name"] = name;
    all["R"] = rotationOf(pose);
    all["T"] = {pose[3], pose[4], pose[5]};
    all["sigma"].update(poseSigmaOf(sigma));
    return all;
}

void printPlaced(const CalibratedDevice& device, const std::string& name, const PoseVector& pose) {
    printDevice(name.c_str(), device);
    const glm::dvec3 place = Rigid::exp(pose).inverse().translation;
    std::printf("  stands at       (%.3f, %.3f, %.3f) m in the device's frame\n", place.x, place.y, place.z);
}

void calibrateDevice(const DeviceCaptureArguments& arguments, const std::string& folder, bool json,
                     const Session& session) {
    const std::vector<NamedOrder> orders = ordersOf(arguments);
    const Rig rig = readRig(arguments.rig);
    constexpr double kReading = 0.5; // of the whole time
    DeviceCapture capture;
    std::vector<NamedDevice> projectors;
    projectors.reserve(orders.size());
    for (const NamedOrder& order : orders) projectors.push_back({order.name, order.order.projector});
    DeviceCalibration result = orRefused(json, [&] {
        const Progress progress = session.progress();
        capture = readDeviceCapture(folder, rig.actuatorCount(), orders, progress.part(0.0, kReading));
        return calibrateOnDevice(rig, capture.shots, capture.cameras, projectors, {}, progress.part(kReading, 1.0));
    });
    Session::endProgress();
    result.warnings.insert(result.warnings.end(), capture.warnings.begin(), capture.warnings.end());
    const auto each = [&](const auto& use) {
        for (std::size_t i = 0; i < result.cameras.size(); ++i)
            use("cameras", result.cameras[i], capture.cameras[i].name, result.state.cameras[i].fromWorld,
                result.sigma.cameras[i].fromWorld);
        for (std::size_t i = 0; i < result.projectors.size(); ++i)
            use("projectors", result.projectors[i], projectors[i].name, result.state.projectors[i].fromWorld,
                result.sigma.projectors[i].fromWorld);
    };
    if (json) {
        nlohmann::json all = {{"rms", result.rms}, {"onDevice", result.onDevice}};
        all["warnings"] = jsonOf(result.warnings);
        each([&](const char* kind, const auto& device, const auto& name, const auto& pose, const auto& sigma) {
            all[kind].push_back(placedJson(device, name, pose, sigma));
        });
        printJson(all);
        return;
    }
    each([](const char*, const auto& device, const auto& name, const auto& pose, const auto&) {
        printPlaced(device, name, pose);
    });
    std::printf("%.0f %% of the light on the device fits; what is left is %.3f projector pixels\n",
                100.0 * result.onDevice, result.rms);
    printFindings(result.warnings);
}

} // namespace

FolderCommand addDeviceFolder(CLI::App& command, const Session& session) {
    auto arguments = std::make_shared<DeviceCaptureArguments>();
    command.add_option("--rig", arguments->rig, "Of a folder: the device's rig");
    command
        .add_option("--projector", arguments->projectors,
                    "Of a folder: a projector's size in pixels, such as 1024x768; of several, each as NAME=1024x768")
        ->expected(1)
        ->take_all();
    arguments->patterns.addTo(command);
    return [arguments, &session](const std::string& folder, bool json) {
        if (arguments->rig.empty()) throw CLI::RequiredError("--rig");
        if (arguments->projectors.empty()) throw CLI::RequiredError("--projector");
        calibrateDevice(*arguments, folder, json, session);
    };
}

} // namespace lumorph::cli
