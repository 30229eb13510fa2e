#include "calibration/stages/recording.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <utility>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <zlib.h>

#include "calibration/lab/lab_folder.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/base/text.h"
#include "core/scene/installation_store.h"

namespace lumorph {

namespace {

constexpr std::array<const char*, 3> kKinds = {"table", "lab", "rehearsal"};
constexpr std::size_t kMostBytes = 512'000'000; // of one file
constexpr std::size_t kMostFiles = 100'000;
constexpr int kMostPixels = 16'384; // of a picture's side
constexpr std::size_t kMostColumns = 256;
constexpr const char* kTruthFile = "truth.json";
constexpr std::size_t kPackedFrom = 1'000'000; // bytes of a table: what people read as it is stays as it is
constexpr int kGzip = 15 + 16;                 // zlib's windowBits: the widest window, in gzip's format
constexpr const char* kNameColumn = "name";

[[noreturn]] void broken(const std::string& place, const std::string& why,
                         const std::string& remedy = "record the stage again, or take another copy of the folder") {
    throw DataError(place, why, remedy);
}

std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

unsigned long checksumOf(std::string_view bytes) {
    return crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

using Packing = std::unique_ptr<z_stream, int (*)(z_stream*)>;

void setInput(z_stream& stream, std::string_view bytes) {
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
}

/// As gzip packs it.
std::string packed(std::string_view text) {
    z_stream stream{};
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::bad_alloc();
    const Packing end(&stream, deflateEnd);
    std::string bytes(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
    setInput(stream, text);
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(bytes.size());
    deflate(&stream, Z_FINISH); // into so much room it ends at once
    bytes.resize(stream.total_out);
    return bytes;
}

std::string unpacked(std::string_view bytes, const std::string& place) {
    z_stream stream{};
    if (inflateInit2(&stream, kGzip) != Z_OK) throw std::bad_alloc();
    const Packing end(&stream, inflateEnd);
    setInput(stream, bytes);
    std::string text;
    for (int state = Z_OK; state != Z_STREAM_END;) {
        constexpr std::size_t kPiece = 1U << 20U;
        const std::size_t before = text.size();
        if (before > kMostBytes) broken(place, "it unpacks to more than a table ever has");
        text.resize(before + kPiece);
        stream.next_out = reinterpret_cast<Bytef*>(text.data() + before);
        stream.avail_out = kPiece;
        state = inflate(&stream, Z_NO_FLUSH);
        text.resize(before + kPiece - stream.avail_out);
        if (state != Z_OK && state != Z_STREAM_END) broken(place, "it does not unpack");
    }
    return text;
}

std::string pngOf(const cv::Mat& picture) {
    cv::Mat stored = picture;
    if (picture.channels() == 3) cv::cvtColor(picture, stored, cv::COLOR_RGB2BGR);
    std::vector<uchar> bytes; // packed for speed: noise hardly packs
    cv::imencode(".png", stored, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
    return {bytes.begin(), bytes.end()};
}

/// Width and height as a PNG file says them itself, before anything is unpacked.
bool isSmallPng(std::string_view bytes) {
    constexpr std::string_view kBegin("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    if (!bytes.starts_with(kBegin) || bytes.size() < 24) return false;
    const auto number = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
        return value;
    };
    const std::uint32_t width = number(16), height = number(20);
    return width > 0 && height > 0 && width <= kMostPixels && height <= kMostPixels;
}

cv::Mat parsePicture(std::string_view bytes, const std::string& place) {
    if (!isSmallPng(bytes)) broken(place, "it is no PNG picture, or of an absurd size");
    cv::Mat picture;
    try {
        const cv::Mat packed(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
        picture = cv::imdecode(packed, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
        picture.release();
    }
    if (picture.empty() || (picture.type() != CV_8UC1 && picture.type() != CV_8UC3))
        broken(place, "it is broken, or no picture of 8 bits in grey or colour");
    if (picture.channels() == 3) cv::cvtColor(picture, picture, cv::COLOR_BGR2RGB);
    return picture;
}

/// A plain name, so that no recording reads or writes beside its folder.
bool isPlainName(std::string_view name) {
    return !name.empty() && name.size() <= 100 && name.front() != '.' && std::ranges::all_of(name, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
    });
}

/// Fields of one row; RFC 4180 without line breaks in fields.
std::vector<std::string> fieldsOf(std::string_view line, const std::string& place, std::size_t number) {
    std::vector<std::string> fields(1);
    bool isQuoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (isQuoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"')
            fields.back() += line[++i];
        else if (c == '"')
            isQuoted = !isQuoted;
        else if (c == ',' && !isQuoted)
            fields.emplace_back();
        else
            fields.back() += c;
        if (fields.size() > kMostColumns) break;
    }
    if (isQuoted) broken(place + ", line " + std::to_string(number), "a quotation mark is not closed");
    return fields;
}

template <class Value> Value valueOf(const nlohmann::json& object, const char* key, const std::string& place) {
    const auto found = object.find(key);
    if (found == object.end()) broken(place, "it has no \"" + std::string(key) + "\"");
    try {
        return found->template get<Value>();
    } catch (const nlohmann::json::exception&) {
        broken(place, "\"" + std::string(key) + "\" is of another kind than it should be");
    }
}

} // namespace

const char* keyOf(RecordingSource::Kind kind) noexcept { return kKinds.at(static_cast<std::size_t>(kind)); }

const RecordedTable& tableOf(const StageRecording& recording, const std::string& name,
                             const std::vector<std::string>& columns) {
    const std::string place = "recording of " + recording.stage;
    const auto found = recording.tables.find(name);
    if (found == recording.tables.end()) broken(place, "it has no " + name + ".csv");
    if (found->second.columns != columns) broken(place, name + ".csv has other columns than it should");
    return found->second;
}

std::string tableText(const RecordedTable& table) {
    std::string text;
    const bool isNamed = !table.names.empty();
    if (isNamed) text = kNameColumn;
    for (const std::string& column : table.columns) text += (text.empty() ? "" : ",") + csvField(column);
    text += '\n';
    std::array<char, 32> number{};
    for (std::size_t row = 0; row < table.rows(); ++row) {
        if (isNamed) text += csvField(table.names[row]) + ',';
        for (const double value : table.row(row)) {
            const auto end = std::to_chars(number.data(), number.data() + number.size(), value).ptr;
            text.append(number.data(), end);
            text += ',';
        }
        text.back() = '\n';
    }
    return text;
}

RecordedTable parseTable(std::string_view text, const std::string& place) {
    RecordedTable table;
    bool isNamed = false;
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        if (number == 1) {
            table.columns = fieldsOf(line, place, number);
            isNamed = table.columns.front() == kNameColumn;
            if (isNamed) table.columns.erase(table.columns.begin());
            if (table.columns.empty() || table.columns.size() >= kMostColumns ||
                std::ranges::any_of(table.columns, &std::string::empty))
                broken(place + ", line 1", "it does not name its columns");
            continue;
        }
        const std::string at = place + ", line " + std::to_string(number);
        if (isNamed) {
            const std::size_t comma = line.starts_with('"') ? line.find("\",") + 1 : line.find(',');
            if (comma >= line.size()) broken(at, "it has too few fields");
            table.names.push_back(fieldsOf(line.substr(0, comma), place, number).front());
            line.remove_prefix(comma + 1);
        }
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            double value = 0.0;
            const auto [read, error] = std::from_chars(line.data(), line.data() + line.size(), value);
            if (error != std::errc()) broken(at, table.columns[column] + " is no number");
            table.numbers.push_back(value);
            line.remove_prefix(static_cast<std::size_t>(read - line.data()));
            const bool isLast = column + 1 == table.columns.size();
            if (isLast ? !line.empty() : !line.starts_with(',')) broken(at, "it has too few or too many fields");
            if (!isLast) line.remove_prefix(1);
        }
    }
    if (number == 0) broken(place, "it is empty");
    return table;
}

void writeStageRecording(const StageRecording& recording, const std::filesystem::path& folder,
                         const Progress& progress) {
    LabFolder making(folder);
    nlohmann::json files = nlohmann::json::array();
    const std::size_t count = recording.tables.size() + recording.pictures.size();
    const auto write = [&](const std::string& name, const std::string& bytes) {
        progress.throwIfCancelled();
        if (count > 0)
            progress.report(static_cast<double>(files.size()) / static_cast<double>(count), "writing the recording");
        making.write(name, bytes);
        files.push_back({{"name", name}, {"bytes", bytes.size()}, {"crc32", checksumOf(bytes)}});
    };
    for (const auto& [name, table] : recording.tables) {
        const std::string text = tableText(table);
        if (text.size() < kPackedFrom)
            write(name + ".csv", text);
        else
            write(name + ".csv.gz", packed(text));
    }
    for (const auto& [name, picture] : recording.pictures) write(name + ".png", pngOf(picture));
    if (recording.truth) write(kTruthFile, installationText(*recording.truth));
    const nlohmann::json description = {{"lumorph", "calibration recording"},
                                        {"version", kRecordingVersion},
                                        {"stage", recording.stage},
                                        {"method", recording.method},
                                        {"device", recording.device},
                                        {"source",
                                         {{"kind", keyOf(recording.source.kind)},
                                          {"who", recording.source.who},
                                          {"date", recording.source.date},
                                          {"seed", recording.source.seed}}},
                                        {"files", std::move(files)}};
    making.write(kRecordingFile, description.dump(1) + "\n");
    making.finish();
}

StageRecording parseStageRecording(std::string_view description, const std::string& place, const RecordedFiles& files,
                                   const Progress& progress) {
    if (const std::string problem = jsonProblem(description); !problem.empty()) broken(place, problem);
    const nlohmann::json root = nlohmann::json::parse(description, nullptr, false);
    if (!root.is_object() || root.value("lumorph", nlohmann::json()) != "calibration recording")
        broken(place, "it is no recording of a calibration", "choose the folder of one");
    const auto version = valueOf<int>(root, "version", place);
    if (version > kRecordingVersion || version < 1)
        broken(place,
               "it has format version " + std::to_string(version) + ", and this program reads up to " +
                   std::to_string(kRecordingVersion),
               "open it with a newer Lumorph");
    StageRecording recording;
    recording.stage = valueOf<std::string>(root, "stage", place);
    recording.method = valueOf<std::string>(root, "method", place);
    recording.device = valueOf<std::string>(root, "device", place);
    const auto source = valueOf<nlohmann::json>(root, "source", place);
    if (!source.is_object()) broken(place, "\"source\" is of another kind than it should be");
    const auto kind = std::ranges::find(kKinds, valueOf<std::string>(source, "kind", place));
    // What nobody can tell to be measured is not called so.
    if (kind == kKinds.end()) broken(place, "its source is of no known kind");
    recording.source = {static_cast<RecordingSource::Kind>(kind - kKinds.begin()),
                        valueOf<std::string>(source, "who", place), valueOf<std::string>(source, "date", place),
                        valueOf<std::uint32_t>(source, "seed", place)};
    const auto listed = valueOf<nlohmann::json>(root, "files", place);
    if (!listed.is_array() || listed.size() > kMostFiles) broken(place, "\"files\" is no list, or too long");
    for (std::size_t i = 0; i < listed.size(); ++i) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(i) / static_cast<double>(listed.size()), "reading the recording");
        if (!listed[i].is_object()) broken(place, "\"files\" does not list files");
        const auto name = valueOf<std::string>(listed[i], "name", place);
        if (!isPlainName(name)) broken(place, "it names a file " + inQuotes(name) + " that is none of its folder");
        const std::vector<std::byte> bytes = files(name);
        const std::string file = std::string(place).append(", ").append(name);
        const auto length = valueOf<std::uint64_t>(listed[i], "bytes", place);
        if (bytes.size() < length)
            broken(file, "it is cut short: " + std::to_string(bytes.size()) + " of " + std::to_string(length) +
                             " bytes are there");
        if (bytes.size() > length || checksumOf(textOf(bytes)) != valueOf<std::uint64_t>(listed[i], "crc32", place))
            broken(file, "it is damaged: its bytes are not those that were recorded");
        const bool isPacked = name.ends_with(".csv.gz");
        const std::string stem = name.substr(0, isPacked ? name.size() - 7 : name.rfind('.'));
        if (name == kTruthFile)
            recording.truth = parseInstallation(textOf(bytes), file);
        else if (name.ends_with(".csv"))
            recording.tables[stem] = parseTable(textOf(bytes), file);
        else if (isPacked)
            recording.tables[stem] = parseTable(unpacked(textOf(bytes), file), file);
        else if (name.ends_with(".png"))
            recording.pictures[stem] = parsePicture(textOf(bytes), file);
        else
            broken(file, "it is neither a table nor a picture");
    }
    return recording;
}

StageRecording readStageRecording(const std::filesystem::path& folder, const Progress& progress) {
    const auto read = [&](const std::string& name) {
        try {
            return readFile(folder / name, kMostBytes);
        } catch (const Error& error) {
            throw DataError((folder / name).string(), error.why(),
                            name == kRecordingFile ? "choose the folder of a recording"
                                                   : "take another copy of the folder, or record the stage again");
        }
    };
    const std::vector<std::byte> description = read(kRecordingFile);
    return parseStageRecording(
        textOf(description), folder.filename().empty() ? folder.string() : folder.filename().string(), read, progress);
}

} // namespace lumorph
