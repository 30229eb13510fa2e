#include <string>
#include <utility>

#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// A recording of the device alone has the commanded strokes of each shot and the light that was decoded in it. The last
// shot is held out.

namespace lumorph::stages {

std::vector<std::string> shotColumns(std::size_t actuators) {
    std::vector<std::string> columns{"check"};
    for (std::size_t i = 1; i <= actuators; ++i) columns.push_back("stroke_" + std::to_string(i));
    return columns;
}

RecordedShots shotsOf(const StageRecording& recording, std::size_t actuators) {
    RecordedShots read;
    const std::string place = "recording of device";
    auto [cameras, projectors] = namedDevicesOf(tableOf(recording, "devices", kDeviceColumns), place);
    const RecordedTable& shots = tableOf(recording, "shots", shotColumns(actuators));
    if (cameras.size() != 1 || shots.rows() == 0)
        throw DataError(place, "it has more than one camera, or no shot", "record the stage again");
    read.camera = std::move(cameras.front());
    read.projectors = std::move(projectors);
    const std::size_t lamps = read.projectors.size();
    const auto light = lightOf(tableOf(recording, "light", kLightColumns), shots.rows() * lamps);
    for (std::size_t i = 0; i < shots.rows(); ++i) {
        const auto row = shots.row(i);
        DeviceShot shot;
        shot.name = "shot " + std::to_string(i + 1);
        shot.strokes.assign(row.begin() + 1, row.end());
        for (const double stroke : shot.strokes)
            if (!(stroke >= 0.0 && stroke <= 1.0))
                throw DataError(place, "a stroke is none from 0 to 1", "record the stage again");
        shot.light.resize(1);
        for (std::size_t p = 0; p < lamps; ++p) shot.light.front().push_back(light[i * lamps + p]);
        read.shots.push_back(std::move(shot));
    }
    read.hasCheck = shots.row(shots.rows() - 1)[0] != 0.0;
    return read;
}

} // namespace lumorph::stages
