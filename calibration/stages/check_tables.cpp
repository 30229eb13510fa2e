#include <algorithm>
#include <string>
#include <utility>

#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// A recording of a check: the strokes that were commanded, and each projector's patterns as photographed in that stand.

namespace lumorph {

namespace {

std::string numbered(std::size_t number) {
    std::string text = std::to_string(number);
    if (text.size() < 3) text.insert(0, 3 - text.size(), '0');
    return text;
}

/// A recording as a bench: each pass is the one that was photographed of that projector after that stand.
class RecordedDevice final : public DeviceBench {
public:
    RecordedDevice(const StageRecording& recording, std::size_t actuators)
        : recording_(recording), stands_(tableOf(recording, "stands", stages::standColumns(actuators))),
          passes_(tableOf(recording, "passes", stages::kPassColumns)) {}

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
                if (const auto kept = recording_.pictures.find(stages::checkPictureName(pass, i));
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

} // namespace

namespace stages {

std::vector<std::string> standColumns(std::size_t actuators) {
    std::vector<std::string> columns;
    for (std::size_t i = 1; i <= actuators; ++i) columns.push_back("commanded_" + std::to_string(i));
    return columns;
}

std::string checkPictureName(std::size_t pass, std::size_t index) {
    return "pass_" + numbered(pass + 1) + "_" + numbered(index);
}

std::unique_ptr<DeviceBench> recordedDevice(const StageRecording& recording, std::size_t actuators) {
    return std::make_unique<RecordedDevice>(recording, actuators);
}

} // namespace stages

} // namespace lumorph
