#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "core/base/progress.h"
#include "core/scene/installation.h"

/// What devices said while a stage of the calibration was measured, as a value and as a folder: so that it can be
/// solved again, elsewhere and in a test. It holds no figure that was fitted.
namespace lumorph {

/// Who said what a recording holds.
struct RecordingSource {
    enum class Kind {
        table,    ///< devices of hardware
        lab,      ///< the virtual lab
        rehearsal ///< simulated devices in place of those of hardware
    };
    Kind kind = Kind::table;
    std::string who;        ///< in a few words: "virtual lab, seed 5"
    std::string date;       ///< ISO 8601 in UTC
    std::uint32_t seed = 0; ///< of a lab
    /// What it says stays simulated, whoever solves it.
    [[nodiscard]] bool isSimulated() const noexcept { return kind != Kind::table; }
    bool operator==(const RecordingSource&) const = default;
};
/// "table", "lab", "rehearsal".
[[nodiscard]] const char* keyOf(RecordingSource::Kind kind) noexcept;

/// Numbers in named columns; a row may have a name.
struct RecordedTable {
    std::vector<std::string> columns;
    std::vector<std::string> names; ///< one a row, or none at all
    std::vector<double> numbers;    ///< row by row

    [[nodiscard]] std::size_t rows() const noexcept { return columns.empty() ? 0 : numbers.size() / columns.size(); }
    [[nodiscard]] std::span<const double> row(std::size_t i) const {
        return std::span(numbers).subspan(i * columns.size(), columns.size());
    }
    void add(std::initializer_list<double> row) { numbers.insert(numbers.end(), row); }
    void add(const std::string& name, std::initializer_list<double> row) {
        names.push_back(name);
        add(row);
    }
    bool operator==(const RecordedTable&) const = default;
};

/// One stage as it was recorded. A plain value.
struct StageRecording {
    std::string stage;  ///< key of the stage
    std::string method; ///< what was chosen within the stage, such as its pattern; may be empty
    std::string device; ///< name of the rig
    RecordingSource source;
    std::map<std::string, RecordedTable> tables;
    std::map<std::string, cv::Mat> pictures; ///< 8 bits, grey, or red, green and blue
    std::optional<Installation> truth;       ///< of a lab: the room as it truly is, by which a result can be judged
};

/// Version of the folder's format that this program writes; newer ones are refused.
inline constexpr int kRecordingVersion = 2; ///< 2: large tables are packed
inline constexpr const char* kRecordingFile = "recording.json";

/// A table that a stage needs, with exactly these columns. Throws DataError that names the recording's part.
[[nodiscard]] const RecordedTable& tableOf(const StageRecording& recording, const std::string& name,
                                           const std::vector<std::string>& columns);

/// Writes the folder as resources/guide/formats.md describes it, whole or not at all. Throws InvalidInput for a place
/// that holds something, DeviceError where the disk refuses, Cancelled.
void writeStageRecording(const StageRecording& recording, const std::filesystem::path& folder,
                         const Progress& progress = {});

/// Reads it back. Throws DataError naming file and cause: no recording, of a newer program, a file that is missing, cut
/// short, changed, or no table or picture; Cancelled.
[[nodiscard]] StageRecording readStageRecording(const std::filesystem::path& folder, const Progress& progress = {});

/// The bytes of a file of the folder by its name. Throws DataError where there is none.
using RecordedFiles = std::function<std::vector<std::byte>(const std::string& name)>;
/// The same of files that are somewhere else; `place` stands in messages.
[[nodiscard]] StageRecording parseStageRecording(std::string_view description, const std::string& place,
                                                 const RecordedFiles& files, const Progress& progress = {});

/// A table as comma separated values (RFC 4180) with a row of column names, each number as short as it can be read
/// back exactly; and back. Throws DataError with the line.
[[nodiscard]] std::string tableText(const RecordedTable& table);
[[nodiscard]] RecordedTable parseTable(std::string_view text, const std::string& place);

} // namespace lumorph
