#include "calibration/report/calibration_file.h"

#include <algorithm>
#include <cctype>
#include <span>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr std::size_t kMostFileBytes = std::size_t{16} << 20;

/// Throws InvalidInput for a file of neither kind.
bool isYaml(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
    if (ending == ".yaml" || ending == ".yml") return true;
    if (ending == ".json") return false;
    throw InvalidInput("calibration file " + inQuotes(file.filename().string()), "is neither .json nor .yaml",
                       "name it so: .json is Lumorph's own, .yaml OpenCV's");
}

} // namespace

void requireCalibrationName(const std::filesystem::path& file) { (void)isYaml(file); }

void writeCalibration(const CalibrationRecord& record, const std::filesystem::path& file) {
    const std::string text = isYaml(file) ? calibrationYaml(record) : calibrationText(record);
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

CalibrationRecord readCalibration(const std::filesystem::path& file, const KnownSizes& sizes) {
    const bool yaml = isYaml(file);
    const std::vector<std::byte> bytes = readFile(file, kMostFileBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return yaml ? parseCalibrationYaml(text, file.string(), sizes) : parseCalibration(text, file.string());
}

} // namespace lumorph
