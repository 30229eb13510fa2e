#include "calibration/stages/stage_tables.h"

#include <cmath>
#include <string>

#include "core/base/error.h"

namespace lumorph::stages {

std::vector<ProjectorPoint> asRecorded(std::vector<ProjectorPoint> light) {
    constexpr double kSteps = 100.0; // in a pixel
    const auto round = [](double& number) { number = std::round(number * kSteps) / kSteps; };
    for (ProjectorPoint& point : light)
        for (cv::Point2d* pixel : {&point.camera, &point.projector}) {
            round(pixel->x);
            round(pixel->y);
        }
    return light;
}

void addLight(RecordedTable& table, std::size_t look, const std::vector<ProjectorPoint>& light) {
    for (const ProjectorPoint& point : asRecorded(light))
        table.add({static_cast<double>(look), point.camera.x, point.camera.y, point.projector.x, point.projector.y});
}

std::vector<std::vector<ProjectorPoint>> lightOf(const RecordedTable& table, std::size_t looks) {
    std::vector<std::vector<ProjectorPoint>> light(looks);
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const auto row = table.row(i);
        light[indexIn(row[0], looks, "a look")].push_back({{row[1], row[2]}, {row[3], row[4]}});
    }
    return light;
}

std::size_t indexIn(double number, std::size_t end, const char* what) {
    if (!(number >= 0.0) || number >= static_cast<double>(end) || number != std::floor(number))
        throw DataError("recording", "the number of " + std::string(what) + " is none",
                        "record the stage again, or take another copy of the folder");
    return static_cast<std::size_t>(number);
}

NamedDevices namedDevicesOf(const RecordedTable& table, const std::string& place) {
    constexpr std::size_t kMostPixels = 100'000, kMostDevices = 64;
    const char* remedy = "record the stage again";
    if (table.names.size() != table.rows()) throw DataError(place, "its cameras and projectors have no names", remedy);
    if (table.rows() > kMostDevices)
        throw DataError(place, "it has more than " + std::to_string(kMostDevices) + " cameras and projectors", remedy);
    NamedDevices devices;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const auto row = table.row(i);
        const cv::Size size(static_cast<int>(indexIn(row[1], kMostPixels, "pixels")),
                            static_cast<int>(indexIn(row[2], kMostPixels, "pixels")));
        if (size.empty()) throw DataError(place, table.names[i] + " has no pixels", remedy);
        (row[0] != 0.0 ? devices.projectors : devices.cameras).push_back({table.names[i], size});
    }
    if (devices.cameras.empty() || devices.projectors.empty())
        throw DataError(place, "it has no camera or no projector", remedy);
    return devices;
}

} // namespace lumorph::stages
