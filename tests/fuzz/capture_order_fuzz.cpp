#include <cstddef>
#include <cstdint>

#include "calibration/patterns/capture_order.h"
#include "core/base/error.h"

// An order file is read, or refused with a DataError; what was read can be written and read again.

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const cv::Size kProjector(1024, 768);
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        const lumorph::CaptureOrder order = lumorph::parseCaptureOrder(text, "fuzz", kProjector);
        std::string again;
        for (const lumorph::PatternImage& image : order.images) again += lumorph::wordsOf(image) + "\n";
        if (lumorph::parseCaptureOrder(again, "again", kProjector) != order) __builtin_trap();
    } catch (const lumorph::DataError&) {
    }
    return 0;
}
