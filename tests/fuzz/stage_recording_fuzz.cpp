#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "calibration/stages/recording.h"
#include "core/base/error.h"

// A recording of a calibration's stage is read, or refused with a DataError. The input's first byte chooses between a
// table, which is written and read again, and a whole recording: its description, then the files that it names, each
// ended by a byte 0x1e.

namespace {

std::string_view nextPart(std::string_view& left) {
    const std::size_t end = left.find('\x1e');
    const std::string_view part = left.substr(0, end);
    left.remove_prefix(end == std::string_view::npos ? left.size() : end + 1);
    return part;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    try {
        if (data[0] % 2 == 0) {
            const lumorph::RecordedTable table = lumorph::parseTable(text, "fuzz");
            const lumorph::RecordedTable again = lumorph::parseTable(lumorph::tableText(table), "again");
            if (again.columns != table.columns || again.names != table.names || again.rows() != table.rows())
                __builtin_trap();
        } else {
            const std::string_view description = nextPart(text);
            (void)lumorph::parseStageRecording(description, "fuzz", [&text](const std::string&) {
                const std::string_view part = nextPart(text);
                const auto* bytes = reinterpret_cast<const std::byte*>(part.data());
                return std::vector<std::byte>(bytes, bytes + part.size());
            });
        }
    } catch (const lumorph::DataError&) {
    }
    return 0;
}
