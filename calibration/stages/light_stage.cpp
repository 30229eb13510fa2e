#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "calibration/stages/stage_rows.h"
#include "core/base/error.h"

// Light: each photograph of flat light, with what the projectors showed and how long it was exposed.

namespace lumorph {

namespace {

constexpr double kCovered = std::numeric_limits<double>::quiet_NaN(); // of a projector whose lens is covered
const std::vector<std::string> kSheetColumns{"x", "y", "z"};
const std::vector<std::string> kRangeColumns{"shortest", "longest", "found", "photographs_before"};

/// Seconds of exposure, then red, green and blue of each projector.
std::vector<std::string> photographColumns(std::size_t projectors) {
    std::vector<std::string> columns{"seconds"};
    for (std::size_t p = 1; p <= projectors; ++p)
        for (const char* channel : {"red_", "green_", "blue_"}) columns.push_back(channel + std::to_string(p));
    return columns;
}

std::vector<double> rowOf(const LightShow& show, double seconds) {
    std::vector<double> row{seconds};
    for (const auto& color : show)
        for (int channel = 0; channel < 3; ++channel)
            row.push_back(color ? static_cast<double>((*color)[channel]) : kCovered);
    return row;
}

std::string lightPictureName(std::size_t index) {
    std::string number = std::to_string(index + 1);
    if (number.size() < 4) number.insert(0, 4 - number.size(), '0');
    return "photograph_" + number;
}

/// A bench that keeps what it photographs.
class KeptLight final : public LightBench {
public:
    KeptLight(LightBench& bench, std::size_t projectors, const glm::ivec2& size, StageRecording& recording)
        : bench_(bench), size_(size), recording_(recording), table_(recording.tables["photographs"]) {
        table_.columns = photographColumns(projectors);
        KeptLight::exposureFound({}); // also of a measurement that is refused before
    }
    [[nodiscard]] cv::Mat photograph(const LightShow& show, double seconds) override {
        cv::Mat picture = bench_.photograph(show, seconds);
        fitPicture(picture, size_, size_); // of another shape than the camera's the patches would lie elsewhere
        const std::vector<double> row = rowOf(show, seconds);
        recording_.pictures[lightPictureName(table_.rows())] = picture;
        table_.numbers.insert(table_.numbers.end(), row.begin(), row.end());
        return picture;
    }
    [[nodiscard]] double shortestExposure() const override { return bench_.shortestExposure(); }
    [[nodiscard]] double longestExposure() const override { return bench_.longestExposure(); }
    void exposureFound(const FoundExposure& found) override {
        recording_.tables["exposures"] = {
            kRangeColumns,
            {},
            {shortestExposure(), longestExposure(), found.seconds, static_cast<double>(found.photographs)}};
    }

private:
    LightBench& bench_;
    glm::ivec2 size_;
    StageRecording& recording_;
    RecordedTable& table_;
};

/// A recording as a bench: what is asked for again is the next photograph of its kind.
class RecordedLight final : public LightBench {
public:
    RecordedLight(const StageRecording& recording, std::size_t projectors)
        : recording_(recording), table_(tableOf(recording, "photographs", photographColumns(projectors))) {
        for (std::size_t i = 0; i < table_.rows(); ++i) {
            const auto row = table_.row(i);
            places_[keyOf({row.begin(), row.end()})].push_back(i);
        }
        const RecordedTable& range = tableOf(recording, "exposures", kRangeColumns);
        if (range.rows() != 1) lacks("the exposures");
        shortest_ = range.row(0)[0];
        longest_ = range.row(0)[1];
        found_ = {range.row(0)[2], static_cast<int>(stages::indexIn(range.row(0)[3], 100'000, "photographs"))};
    }

    [[nodiscard]] cv::Mat photograph(const LightShow& show, double seconds) override {
        const auto place = places_.find(keyOf(rowOf(show, seconds)));
        if (place == places_.end()) lacks("a photograph of " + std::to_string(1e3 * seconds) + " ms");
        std::vector<std::size_t>& left = place->second;
        const std::size_t index = left.front();
        if (left.size() > 1) left.erase(left.begin());
        const auto picture = recording_.pictures.find(lightPictureName(index));
        if (picture == recording_.pictures.end()) lacks(lightPictureName(index) + ".png");
        return picture->second;
    }
    [[nodiscard]] double shortestExposure() const override { return shortest_; }
    [[nodiscard]] double longestExposure() const override { return longest_; }
    [[nodiscard]] std::optional<FoundExposure> foundExposure() const override {
        // Where it was refused before, the exposure is looked for again, to the same refusal.
        return found_.seconds > 0.0 ? std::optional(found_) : std::nullopt;
    }

private:
    /// Numbers as text: a covered lens is no number, and equals nothing.
    static std::string keyOf(const std::vector<double>& row) {
        RecordedTable table;
        table.columns.assign(row.size(), "c");
        table.numbers = row;
        return tableText(table);
    }
    [[noreturn]] static void lacks(const std::string& what) {
        throw DataError("recording of light", "it has not " + what, "record the stage again");
    }

    const StageRecording& recording_;
    const RecordedTable& table_;
    std::map<std::string, std::vector<std::size_t>> places_;
    double shortest_ = 0.0, longest_ = 0.0;
    FoundExposure found_;
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
        corners.columns = kSheetColumns;
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
    RecordedLight bench(recording, room.projectors.size());
    if (recording.pictures.empty())
        throw DataError("recording of light", "it has no photographs", "record the stage again");
    const cv::Size size = recording.pictures.begin()->second.size();
    CalibratedCamera camera = lightCamera(room.cameras.front().camera, size.width);
    if (camera.size != glm::ivec2(size.width, size.height))
        throw DataError("recording of light",
                        "its photographs are " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                            " pixels, and the room's camera has another shape",
                        "solve it in the room in which it was recorded");
    std::optional<WhiteSheet> sheet;
    if (recording.tables.contains("sheet")) {
        const RecordedTable& corners = tableOf(recording, "sheet", kSheetColumns);
        if (corners.rows() != 0 && corners.rows() != 4)
            throw DataError("recording of light", "its sheet has not four corners", "record again");
        if (corners.rows() == 4) sheet.emplace();
        for (std::size_t i = 0; i < corners.rows(); ++i)
            (*sheet)[i] = glm::vec3(glm::dvec3(corners.row(i)[0], corners.row(i)[1], corners.row(i)[2]));
    }
    const std::vector<LightPatch> patches = lightPatches(room, *site.rig, camera, sheet);
    LightCalibration result = measureLight(site.room, patches, bench, progress);
    if (recording.tables.contains("sheet") && !sheet) result.warnings.push_back(noRoomForSheet());
    result.photographs =
        static_cast<int>(tableOf(recording, "photographs", photographColumns(room.projectors.size())).rows());
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
