#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"

// A recording of light has each photograph of flat light, with what the projectors showed and how long it was exposed.

namespace lumorph {

namespace {

constexpr double kCovered = std::numeric_limits<double>::quiet_NaN(); // of a projector whose lens is covered

/// A recording as a bench: what is asked for again is the next photograph of its kind.
class RecordedLight final : public LightBench {
public:
    RecordedLight(const StageRecording& recording, std::size_t projectors)
        : recording_(recording), table_(tableOf(recording, "photographs", stages::photographColumns(projectors))) {
        for (std::size_t i = 0; i < table_.rows(); ++i) {
            const auto row = table_.row(i);
            places_[keyOf({row.begin(), row.end()})].push_back(i);
        }
        const RecordedTable& range = tableOf(recording, "exposures", stages::kRangeColumns);
        if (range.rows() != 1) lacks("the exposures");
        shortest_ = range.row(0)[0];
        longest_ = range.row(0)[1];
        found_ = {range.row(0)[2], static_cast<int>(stages::indexIn(range.row(0)[3], 100'000, "photographs"))};
    }

    [[nodiscard]] cv::Mat photograph(const LightShow& show, double seconds) override {
        const auto place = places_.find(keyOf(stages::rowOf(show, seconds)));
        if (place == places_.end()) lacks("a photograph of " + std::to_string(1e3 * seconds) + " ms");
        std::vector<std::size_t>& left = place->second;
        const std::size_t index = left.front();
        if (left.size() > 1) left.erase(left.begin());
        const auto picture = recording_.pictures.find(stages::lightPictureName(index));
        if (picture == recording_.pictures.end()) lacks(stages::lightPictureName(index) + ".png");
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

} // namespace

namespace stages {

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

std::unique_ptr<LightBench> recordedLight(const StageRecording& recording, std::size_t projectors) {
    return std::make_unique<RecordedLight>(recording, projectors);
}

cv::Size photographSize(const StageRecording& recording) {
    if (recording.pictures.empty())
        throw DataError("recording of light", "it has no photographs", "record the stage again");
    const cv::Mat& first = recording.pictures.begin()->second;
    for (const auto& [name, picture] : recording.pictures)
        if (picture.size() != first.size() || picture.type() != first.type())
            throw DataError("recording of light", name + ".png is of another kind or size than the photographs before",
                            "record the stage again");
    return first.size();
}

std::optional<WhiteSheet> sheetOf(const StageRecording& recording) {
    if (!recording.tables.contains("sheet")) return std::nullopt;
    const RecordedTable& corners = tableOf(recording, "sheet", kSheetColumns);
    if (corners.rows() == 0) return std::nullopt; // there was no room for it
    WhiteSheet sheet;
    if (corners.rows() != sheet.size())
        throw DataError("recording of light", "its sheet has not four corners", "record again");
    for (std::size_t i = 0; i < sheet.size(); ++i)
        sheet[i] = glm::vec3(glm::dvec3(corners.row(i)[0], corners.row(i)[1], corners.row(i)[2]));
    return sheet;
}

} // namespace stages

} // namespace lumorph
