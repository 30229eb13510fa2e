#include <cstdio>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "calibration/capture/genicam_camera.h"
#include "calibration/tracking/camera_source.h"

namespace lumorph::cli {

namespace {

void listAll(bool asJson) {
    std::vector<CameraInfo> cameras = listCameras();
    for (CameraInfo& found : listGenicamCameras()) cameras.push_back(std::move(found));
    if (asJson) {
        nlohmann::json list = nlohmann::json::array();
        for (const CameraInfo& camera : cameras) list.push_back({{"address", camera.path}, {"name", camera.name}});
        std::printf("%s\n", list.dump(2).c_str());
        return;
    }
    for (const CameraInfo& camera : cameras) std::printf("%-32s %s\n", camera.path.c_str(), camera.name.c_str());
    if (cameras.empty())
        std::printf("no camera answers; one that sends MJPEG is given by its address, http://HOST:PORT/PATH\n");
}

} // namespace

void addCamerasCommand(CLI::App& app) {
    auto json = std::make_shared<bool>(false);
    CLI::App* command =
        app.add_subcommand("cameras", "List cameras of this machine and industrial ones on its networks");
    command->add_flag("--json", *json, "Print one JSON value");
    command->callback([json] { listAll(*json); });
}

} // namespace lumorph::cli
