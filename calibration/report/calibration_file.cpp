#include "calibration/report/calibration_file.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/plain_text.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr std::size_t kMostFileBytes = std::size_t{16} << 20;

std::string endingOf(const std::filesystem::path& file) { return lowerCase(file.extension().string()); }

bool isYaml(const std::string& ending) { return ending == ".yaml" || ending == ".yml"; }

} // namespace

void requireCalibrationName(const std::filesystem::path& file) {
    const std::string ending = endingOf(file);
    if (!isYaml(ending) && ending != ".json")
        throw InvalidInput("calibration file " + inQuotes(file.filename().string()), "is neither .json nor .yaml",
                           "name it so: .json is Lumorph's own, .yaml OpenCV's");
}

void writeCalibration(const CalibrationRecord& record, const std::filesystem::path& file) {
    requireCalibrationName(file);
    const std::string text = isYaml(endingOf(file)) ? calibrationYaml(record) : calibrationText(record);
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

CalibrationRecord readCalibration(const std::filesystem::path& file, const KnownSizes& sizes) {
    const std::string ending = endingOf(file);
    if (!isYaml(ending) && ending != ".json" && ending != ".xml" && ending != ".txt")
        throw InvalidInput("calibration file " + inQuotes(file.filename().string()),
                           "is none of .json, .yaml, .yml, .xml and .txt", "choose another file, or name it so");
    const std::vector<std::byte> bytes = readFile(file, kMostFileBytes);
    const PlainText plain(bytes);
    const std::string_view text = plain.view();
    // Ours says so; other programs write JSON too, and some put XML into a file of that name.
    const bool isObject = text.find('{') != std::string_view::npos && text.find('{') < text.find('<');
    const bool isForeign =
        text.find("\"lumorph\"") == std::string_view::npos && (isObject || text.find('<') != std::string_view::npos);
    const bool isOurs = ending == ".json" && !isForeign;
    return isOurs ? parseCalibration(text, file.string()) : parseForeignCalibration(text, file.string(), sizes);
}

} // namespace lumorph
