#include <string>
#include <utility>

#include "calibration/stages/stage_rows.h"
#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// The check: how the device was told to stand, and the photographs of each projector's patterns then.

namespace lumorph {

namespace {

/// A bench that keeps stands and photographs, as large as a check reads them.
class KeptDevice final : public DeviceBench {
public:
    KeptDevice(DeviceBench& bench, const StageSite& site, const Installation& seen, StageRecording& recording)
        : bench_(bench), recording_(recording), camera_(seen.cameras.front().camera.size),
          kept_(photographedRoom(seen, VerifyOptions().cameraWidth).cameras.front().camera.size) {
        recording.tables["stands"].columns = stages::standColumns(site.rig->actuatorCount());
        recording.tables["passes"].columns = stages::kPassColumns;
    }
    void stand(std::span<const double> commanded, const Progress& progress) override {
        bench_.stand(commanded, progress);
        std::vector<double>& stands = recording_.tables["stands"].numbers;
        stands.insert(stands.end(), commanded.begin(), commanded.end());
    }
    [[nodiscard]] std::vector<cv::Mat> photograph(std::size_t projector, const CaptureOrder& order,
                                                  const Progress& progress) override {
        std::vector<cv::Mat> pictures = bench_.photograph(projector, order, progress);
        RecordedTable& passes = recording_.tables["passes"];
        const std::size_t pass = passes.rows();
        passes.add({static_cast<double>(recording_.tables["stands"].rows() - 1), static_cast<double>(projector),
                    static_cast<double>(pictures.size())});
        for (std::size_t i = 0; i < pictures.size(); ++i) {
            fitPicture(pictures[i], camera_, kept_);
            if (!pictures[i].empty()) recording_.pictures[stages::checkPictureName(pass, i)] = pictures[i];
        }
        return pictures;
    }

private:
    DeviceBench& bench_;
    StageRecording& recording_;
    glm::ivec2 camera_, kept_;
};

MeasuredStage measureCheck(const StageSite& site, Bench& bench, const Progress& progress) {
    StageRecording recording = stages::emptyRecording("verify", site, bench);
    const Installation room = stages::roomWithCamera(site, recording.source);
    KeptDevice kept(bench.device(site), site, room, recording);
    VerifyOptions options;
    options.pattern = bench.checkPattern();
    recording.method = options.pattern;
    VerifiedRoom result = verifyRoom(*site.rig, room, kept, progress, options);
    return {std::move(recording), std::move(result)};
}

StageResult solveCheck(const StageRecording& recording, const StageSite& site, const Progress& progress) {
    const Installation room = stages::roomWithCamera(site, recording.source);
    const auto bench = stages::recordedDevice(recording, site.rig->actuatorCount());
    VerifyOptions options;
    options.pattern = recording.method;
    return verifyRoom(*site.rig, room, *bench, progress, options);
}

} // namespace

CalibrationStage stages::checkStage() {
    CalibrationStage stage;
    stage.key = "verify";
    stage.title = "Check";
    stage.measure = measureCheck;
    stage.solve = solveCheck;
    stage.apply = takeCorrections;
    return stage;
}

} // namespace lumorph
