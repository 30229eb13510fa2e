#include <string>
#include <utility>

#include "calibration/stages/stage_rows.h"
#include "core/base/error.h"

// The check: how the device was told to stand, and the photographs of each projector's patterns then.

namespace lumorph {

namespace {

const std::vector<std::string> kPassColumns{"stand", "projector", "pictures"};

std::vector<std::string> standColumns(std::size_t actuators) {
    std::vector<std::string> columns;
    for (std::size_t i = 1; i <= actuators; ++i) columns.push_back("commanded_" + std::to_string(i));
    return columns;
}

std::string numbered(std::size_t number) {
    std::string text = std::to_string(number);
    if (text.size() < 3) text.insert(0, 3 - text.size(), '0');
    return text;
}

std::string checkPictureName(std::size_t pass, std::size_t index) {
    return "pass_" + numbered(pass + 1) + "_" + numbered(index);
}

/// A bench that keeps stands and photographs, as large as a check reads them.
class KeptDevice final : public DeviceBench {
public:
    KeptDevice(DeviceBench& bench, const StageSite& site, const Installation& seen, StageRecording& recording)
        : bench_(bench), recording_(recording), camera_(seen.cameras.front().camera.size),
          kept_(photographedRoom(seen, VerifyOptions().cameraWidth).cameras.front().camera.size) {
        recording.tables["stands"].columns = standColumns(site.rig->actuatorCount());
        recording.tables["passes"].columns = kPassColumns;
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
            if (!pictures[i].empty()) recording_.pictures[checkPictureName(pass, i)] = pictures[i];
        }
        return pictures;
    }

private:
    DeviceBench& bench_;
    StageRecording& recording_;
    glm::ivec2 camera_, kept_;
};

/// A recording as a bench: each pass is the one that was photographed of that projector after that stand.
class RecordedDevice final : public DeviceBench {
public:
    RecordedDevice(const StageRecording& recording, const Rig& rig)
        : recording_(recording), stands_(tableOf(recording, "stands", standColumns(rig.actuatorCount()))),
          passes_(tableOf(recording, "passes", kPassColumns)) {}

    void stand(std::span<const double> commanded, const Progress&) override {
        if (next_ >= stands_.rows() || !std::ranges::equal(stands_.row(next_), commanded))
            throw DataError("recording of check", "the device stood otherwise than a check asks now",
                            "record the stage again");
        ++next_;
    }
    [[nodiscard]] std::vector<cv::Mat> photograph(std::size_t projector, const CaptureOrder&,
                                                  const Progress& progress) override {
        progress.throwIfCancelled();
        for (std::size_t pass = 0; pass < passes_.rows(); ++pass) {
            const auto row = passes_.row(pass);
            if (row[0] != static_cast<double>(next_) - 1.0 || row[1] != static_cast<double>(projector)) continue;
            std::vector<cv::Mat> pictures(stages::indexIn(row[2], 10'000, "pictures"));
            for (std::size_t i = 0; i < pictures.size(); ++i)
                if (const auto kept = recording_.pictures.find(checkPictureName(pass, i));
                    kept != recording_.pictures.end())
                    pictures[i] = kept->second.clone();
            return pictures;
        }
        throw DataError("recording of check",
                        "it has no photographs of projector " + std::to_string(projector + 1) + " in this stand",
                        "record the stage again");
    }

private:
    const StageRecording& recording_;
    const RecordedTable &stands_, &passes_;
    std::size_t next_ = 0;
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
    RecordedDevice bench(recording, *site.rig);
    VerifyOptions options;
    options.pattern = recording.method;
    return verifyRoom(*site.rig, room, bench, progress, options);
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
