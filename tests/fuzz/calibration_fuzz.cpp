#include <cmath>
#include <cstddef>
#include <cstdint>

#include "calibration/report/calibration_file.h"
#include "core/base/error.h"

// A calibration as JSON or YAML is read, or refused with a DataError; what was read is finite, and can be written in
// both forms and read again.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const bool yaml = data[0] % 2 != 0;
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    try {
        const lumorph::CalibrationRecord record =
            yaml ? lumorph::parseCalibrationYaml(text, "fuzz", {{640, 480}, {800, 600}})
                 : lumorph::parseCalibration(text, "fuzz");
        for (const double number : record.result.camera.lens)
            if (!std::isfinite(number)) __builtin_trap();
        try {
            (void)lumorph::parseCalibration(lumorph::calibrationText(record), "again");
            (void)lumorph::parseCalibrationYaml(lumorph::calibrationYaml(record), "again");
        } catch (const lumorph::InvalidInput&) { // names that are not UTF-8
        }
    } catch (const lumorph::DataError&) {
    }
    return 0;
}
