#include <optional>
#include <string>
#include <utility>

#include "calibration/stages/stage_rows.h"
#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// Light: each photograph of flat light, with what the projectors showed and how long it was exposed.

namespace lumorph {

namespace {

/// A bench that keeps what it photographs.
class KeptLight final : public LightBench {
public:
    KeptLight(LightBench& bench, std::size_t projectors, const glm::ivec2& size, StageRecording& recording)
        : bench_(bench), size_(size), recording_(recording), table_(recording.tables["photographs"]) {
        table_.columns = stages::photographColumns(projectors);
        KeptLight::exposureFound({}); // also of a measurement that is refused before
    }
    [[nodiscard]] cv::Mat photograph(const LightShow& show, double seconds) override {
        cv::Mat picture = bench_.photograph(show, seconds);
        fitPicture(picture, size_, size_); // of another shape than the camera's the patches would lie elsewhere
        const std::vector<double> row = stages::rowOf(show, seconds);
        recording_.pictures[stages::lightPictureName(table_.rows())] = picture;
        table_.numbers.insert(table_.numbers.end(), row.begin(), row.end());
        return picture;
    }
    [[nodiscard]] double shortestExposure() const override { return bench_.shortestExposure(); }
    [[nodiscard]] double longestExposure() const override { return bench_.longestExposure(); }
    void exposureFound(const FoundExposure& found) override {
        recording_.tables["exposures"] = {
            stages::kRangeColumns,
            {},
            {shortestExposure(), longestExposure(), found.seconds, static_cast<double>(found.photographs)}};
    }

private:
    LightBench& bench_;
    glm::ivec2 size_;
    StageRecording& recording_;
    RecordedTable& table_;
};

MeasuredStage measureLight(const StageSite& site, Bench& bench, const Progress& progress) {
    StageRecording recording = stages::emptyRecording("light", site, bench);
    progress.report(0.0, "looking for what the camera sees in the light");
    const Installation room = stages::roomWithCamera(site, recording.source);
    const CalibratedCamera camera = lightCamera(room.cameras.front().camera);
    std::optional<WhiteSheet> sheet;
    if (bench.laysSheet()) {
        sheet = placeForSheet(room, *site.rig, camera);
        RecordedTable& corners = recording.tables["sheet"]; // empty where there is no room for it
        corners.columns = stages::kSheetColumns;
        if (sheet)
            for (const glm::vec3& corner : *sheet) corners.add({corner.x, corner.y, corner.z});
    }
    const std::vector<LightPatch> patches = lightPatches(room, *site.rig, camera, sheet);
    progress.throwIfCancelled();
    KeptLight kept(bench.light(site, sheet, progress), room.projectors.size(), camera.size, recording);
    LightCalibration result = measureLight(site.room, patches, kept, progress.part(0.1, 1.0));
    if (bench.laysSheet() && !sheet) result.warnings.push_back(noRoomForSheet());
    return {std::move(recording), std::move(result)};
}

StageResult solveLight(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    const Installation room = stages::roomWithCamera(site, recording.source);
    const auto bench = stages::recordedLight(recording, room.projectors.size());
    const cv::Size size = stages::photographSize(recording);
    CalibratedCamera camera = lightCamera(room.cameras.front().camera, size.width);
    if (camera.size != glm::ivec2(size.width, size.height))
        throw DataError("recording of light",
                        "its photographs are " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                            " pixels, and the room's camera has another shape",
                        "solve it in the room in which it was recorded");
    const std::optional<WhiteSheet> sheet = stages::sheetOf(recording);
    const std::vector<LightPatch> patches = lightPatches(room, *site.rig, camera, sheet);
    LightCalibration result = measureLight(site.room, patches, *bench, progress);
    if (recording.tables.contains("sheet") && !sheet) result.warnings.push_back(noRoomForSheet());
    result.photographs =
        static_cast<int>(tableOf(recording, "photographs", stages::photographColumns(room.projectors.size())).rows());
    return result;
}

} // namespace

CalibrationStage stages::lightStage() {
    CalibrationStage stage;
    stage.key = "light";
    stage.title = "Light";
    stage.needs = {"projector"};
    stage.measure = measureLight;
    stage.solve = solveLight;
    stage.apply = [](const Installation& measured, Installation& room) {
        for (std::size_t p = 0; p < std::min(room.projectors.size(), measured.projectors.size()); ++p) {
            const InstalledProjector& from = measured.projectors[p];
            InstalledProjector& to = room.projectors[p];
            to.gain = from.gain;
            to.black = from.black;
            to.gamma = from.gamma;
            to.responseCurve = from.responseCurve;
            to.response = from.response;
        }
        room.deviceColor = measured.deviceColor;
        room.tableColor = measured.tableColor;
        room.origins.colors = measured.origins.colors;
    };
    stage.origin = [](const Installation& room) -> const Origin* {
        const auto on = std::ranges::find_if(room.projectors, &InstalledProjector::enabled);
        return on == room.projectors.end() ? nullptr : &on->response;
    };
    return stage;
}

} // namespace lumorph
