#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "calibration/stages/stage_tables.h"
#include "core/base/error.h"
#include "tests/fuzz/stage_recording_input.h"

// A recording of a calibration's stage is read, or refused with a DataError, and so is what each stage reads from its
// tables. The input's first byte chooses between a table, which is written and read again; a whole recording: its
// description, then the files that it names; and files alone, which a description that fits is made for
// (stage_recording_input.h).

namespace {

using namespace lumorph;

std::string_view nextPart(std::string_view& left) {
    const std::size_t end = left.find(kPartEnd);
    const std::string_view part = left.substr(0, end);
    left.remove_prefix(end == std::string_view::npos ? left.size() : end + 1);
    return part;
}

std::vector<std::byte> bytesOf(std::string_view part) {
    const auto* bytes = reinterpret_cast<const std::byte*>(part.data());
    return {bytes, bytes + part.size()};
}

StageRecording describedRecording(std::string_view text) {
    const std::string_view description = nextPart(text);
    return parseStageRecording(description, "fuzz", [&text](const std::string&) { return bytesOf(nextPart(text)); });
}

StageRecording recordingOfFiles(std::string_view text) {
    nlohmann::json description = {{"lumorph", "calibration recording"},
                                  {"version", kRecordingVersion},
                                  {"stage", nextPart(text)},
                                  {"method", nextPart(text)},
                                  {"device", "tablet"},
                                  {"source", {{"kind", "lab"}, {"who", ""}, {"date", ""}, {"seed", 1}}},
                                  {"files", nlohmann::json::array()}};
    std::map<std::string, std::string_view> files;
    while (!text.empty()) {
        const std::string name(nextPart(text));
        const std::string_view bytes = nextPart(text);
        if (!files.emplace(name, bytes).second) continue;
        const auto checksum = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
        description["files"].push_back({{"name", name}, {"bytes", bytes.size()}, {"crc32", checksum}});
    }
    return parseStageRecording(description.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), "fuzz",
                               [&files](const std::string& name) {
                                   const auto found = files.find(name);
                                   if (found == files.end()) throw DataError(name, "it is not there", "give it");
                                   return bytesOf(found->second);
                               });
}

/// What was photographed is asked for in the order of the table.
void readLight(const StageRecording& recording) {
    const auto bench = stages::recordedLight(recording, kFuzzProjectors);
    const RecordedTable& table = tableOf(recording, "photographs", stages::photographColumns(kFuzzProjectors));
    const cv::Size size = stages::photographSize(recording);
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const auto row = table.row(i);
        LightShow show;
        for (std::size_t p = 0; p < kFuzzProjectors; ++p) {
            const auto color = row.subspan(1 + 3 * p, 3);
            if (!std::ranges::all_of(color, [](double value) { return std::abs(value) < 1e6; }))
                show.emplace_back();
            else
                show.emplace_back(glm::ivec3(color[0], color[1], color[2]));
        }
        if (bench->photograph(show, row[0]).size() != size) __builtin_trap();
    }
}

void readCheck(const StageRecording& recording) {
    const auto bench = stages::recordedDevice(recording, kFuzzActuators);
    const RecordedTable& stands = tableOf(recording, "stands", stages::standColumns(kFuzzActuators));
    for (std::size_t i = 0; i < stands.rows(); ++i) {
        bench->stand(stands.row(i), {});
        for (std::size_t p = 0; p < kFuzzProjectors; ++p) (void)bench->photograph(p, {}, {});
    }
}

/// All that a stage reads from a recording before it solves; by whichever stage, as names of stages are but text.
void readAsStages(const StageRecording& recording) {
    using Read = void (*)(const StageRecording&);
    constexpr Read kReaders[] = {
        [](const StageRecording& from) { (void)stages::boardsOf(from); },
        [](const StageRecording& from) { (void)stages::shotsOf(from, kFuzzActuators); },
        [](const StageRecording& from) { (void)stages::pointerOf(from); },
        [](const StageRecording& from) { (void)stages::dotsOf(from, kFuzzProjectors); },
        [](const StageRecording& from) { (void)stages::deviceTouchesOf(from); },
        [](const StageRecording& from) { (void)stages::eyeOf(from); },
        [](const StageRecording& from) { (void)stages::looksOf(from, stages::planOf(from, kFuzzActuators)); },
        [](const StageRecording& from) { (void)stages::timingOf(from); },
        [](const StageRecording& from) { (void)stages::delaysOf(from); },
        [](const StageRecording& from) { (void)stages::sheetOf(from); },
        readLight,
        readCheck,
    };
    for (const Read read : kReaders) try {
            read(recording);
        } catch (const DataError&) {
        }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    try {
        if (data[0] % 3 == 0) { // '0'
            const RecordedTable table = parseTable(text, "fuzz");
            const RecordedTable again = parseTable(tableText(table), "again");
            if (again.columns != table.columns || again.names != table.names || again.rows() != table.rows())
                __builtin_trap();
        } else {
            readAsStages(data[0] % 3 == 1 ? describedRecording(text) : recordingOfFiles(text));
        }
    } catch (const DataError&) {
    }
    return 0;
}
