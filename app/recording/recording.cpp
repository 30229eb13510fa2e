#include "app/recording/recording.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <glm/gtc/type_ptr.hpp>

#include "app/recording/database.h"
#include "app/recording/session_tables.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/project_assets.h"

namespace lumorph {
namespace {

using namespace session_tables;

constexpr std::size_t kMostNumbers = 100'000; // of one row
constexpr std::size_t kRowsBetweenLooks = 1024;

/// Reads one table; knows where it is, for its errors.
class Reader {
public:
    Reader(Database& database, const std::filesystem::path& file, std::string table, const char* columns)
        : statement_(database.prepare("SELECT " + std::string(columns) + " FROM " + table + " ORDER BY id")),
          file_(file.string()), table_(std::move(table)) {}

    bool next() {
        ++row_;
        return statement_.step();
    }
    [[nodiscard]] const Statement& row() const noexcept { return statement_; }
    [[nodiscard]] Microseconds time() const { return Microseconds{statement_.integer(0)}; }

    template <class T> [[nodiscard]] std::vector<T> numbers(int column) const {
        const std::vector<std::uint8_t> bytes = statement_.bytes(column);
        if (bytes.size() % sizeof(T) != 0 || bytes.size() / sizeof(T) > kMostNumbers) refuse();
        std::vector<T> values(bytes.size() / sizeof(T));
        if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }
    template <class T, std::size_t N> [[nodiscard]] std::array<T, N> exactly(int column) const {
        const std::vector<T> values = numbers<T>(column);
        if (values.size() != N) refuse();
        std::array<T, N> result{};
        std::copy(values.begin(), values.end(), result.begin());
        return result;
    }
    [[noreturn]] void refuse() const {
        throw DataError(file_, "row " + std::to_string(row_) + " of its table '" + table_ + "' is damaged",
                        "choose another recording");
    }

private:
    Statement statement_;
    std::string file_;
    std::string table_;
    std::size_t row_ = 0;
};

FrameRow frameRow(const Reader& reader) {
    const Statement& at = reader.row();
    FrameRow row;
    row.time = reader.time();
    row.number = static_cast<std::uint64_t>(at.integer(1));
    row.seconds = at.real(2);
    row.turned = at.real(3);
    row.sceneSeconds = at.real(4);
    row.levels = reader.numbers<int>(5);
    row.wanted = reader.numbers<double>(6);
    row.estimated = reader.numbers<double>(7);
    if (row.wanted.size() != row.estimated.size()) reader.refuse();
    row.worldFromDevice = glm::make_mat4(reader.exactly<float, 16>(8).data());
    row.deviceFromTarget = glm::make_mat4(reader.exactly<float, 16>(9).data());
    if (!at.isNothing(10)) row.eye = glm::make_vec3(reader.exactly<float, 3>(10).data());
    row.viewer = at.text(11);
    row.handingOver = at.integer(12) != 0;
    row.iou = at.real(13);
    row.milliseconds = at.real(14);
    row.latency = at.real(15);
    return row;
}

PoseRow poseRow(const Reader& reader) {
    const Statement& at = reader.row();
    const auto numbers = reader.exactly<double, 7>(6);
    PoseRow row;
    row.time = reader.time();
    row.measured = Microseconds{at.integer(1)};
    row.source = at.text(2);
    row.name = at.text(3);
    row.id = static_cast<std::int32_t>(at.integer(4));
    row.valid = at.integer(5) != 0;
    row.pose = {{numbers[0], numbers[1], numbers[2]}, glm::dquat(numbers[6], numbers[3], numbers[4], numbers[5])};
    return row;
}

EventRow eventRow(const Reader& reader) {
    return {reader.time(), reader.row().text(1), reader.row().text(2), reader.row().text(3)};
}

InputRow inputRow(const Reader& reader) { return {reader.time(), reader.row().text(1), reader.row().real(2)}; }

ServoRow servoRow(const Reader& reader) { return {reader.time(), reader.row().text(1), reader.row().bytes(2)}; }

/// How far the reading of all tables is.
class Share {
public:
    Share(Database& database, const Progress& progress) : progress_(progress) {
        for (const char* table : {"frame", "pose", "event", "servo"}) {
            // As good as a count, and found at once.
            Statement last = database.prepare("SELECT max(id) FROM " + std::string(table));
            if (last.step()) all_ += static_cast<double>(last.integer(0));
        }
    }
    void step() {
        if (++done_ % kRowsBetweenLooks != 0) return;
        progress_.throwIfCancelled();
        progress_.report(std::min(1.0, static_cast<double>(done_) / std::max(1.0, all_)), "reading");
    }

private:
    const Progress& progress_;
    double all_ = 0.0;
    std::size_t done_ = 0;
};

template <class Row> void readAll(Reader reader, Row (*rowOf)(const Reader&), std::vector<Row>& rows, Share& share) {
    for (; reader.next(); share.step()) rows.push_back(rowOf(reader));
}

/// Rows of several threads come nearly in order.
template <class Row> void sortByTime(std::vector<Row>& rows) {
    if (!std::ranges::is_sorted(rows, {}, &Row::time)) std::ranges::stable_sort(rows, {}, &Row::time);
}

std::string logName(const std::filesystem::path& file) { return inQuotes(file.filename().string() + "-wal"); }

void sayHowItWasLeft(Database::Left left, const std::filesystem::path& file, Recording& recording) {
    recording.closed = left == Database::Left::closed;
    if (left == Database::Left::open)
        recording.warnings.emplace_back("It is still being recorded; what has reached the disk is read.");
    if (left == Database::Left::notClosed)
        recording.warnings.emplace_back("It was not closed, so its recorder ended abruptly; all that reached the disk "
                                        "is read, the last half second "
                                        "may be missing.");
    if (left == Database::Left::withoutLog)
        recording.warnings.push_back("It was not closed, and its log " + logName(file) +
                                     " is not beside it; what is in the file itself is read, its end may be missing.");
}

/// Gives the version.
std::int64_t checkVersion(Database& database, const std::filesystem::path& file) {
    Statement version = database.prepare("PRAGMA user_version");
    const std::int64_t found = version.step() ? version.integer(0) : 0;
    if (found >= 1 && found <= kVersion) return found;
    if (found > kVersion)
        throw DataError(file.string(), "a newer Lumorph recorded it", "open it with that version, or update this one");
    if (database.left() == Database::Left::withoutLog)
        throw DataError(file.string(),
                        "it was not closed, and its log " + logName(file) +
                            ", in which all lies that was recorded, is not beside it",
                        "copy that file too, from where it was recorded");
    throw DataError(file.string(), "it is a database, but no recording", "choose a file that Lumorph recorded");
}

} // namespace

Recording readRecording(const std::filesystem::path& file, const Progress& progress) {
    Database database(file, Database::Mode::readOnly);
    const std::int64_t version = checkVersion(database, file);
    Recording recording;
    sayHowItWasLeft(database.left(), file, recording);
    Statement facts = database.prepare("SELECT name, value FROM fact");
    while (facts.step()) recording.facts[facts.text(0)] = facts.text(1);
    Share share(database, progress);
    readAll(Reader(database, file, "frame",
                   "time_us, number, seconds, turned, scene_seconds, levels, wanted, estimated, world_from_device, "
                   "device_from_target, eye, viewer, handing_over, iou, milliseconds, latency"),
            &frameRow, recording.frames, share);
    readAll(Reader(database, file, "pose", "time_us, measured_us, source, name, body, valid, pose"), &poseRow,
            recording.poses, share);
    readAll(Reader(database, file, "event", "time_us, kind, text, remedy"), &eventRow, recording.events, share);
    if (version >= 3)
        readAll(Reader(database, file, "input", "time_us, name, value"), &inputRow, recording.inputs, share);
    readAll(Reader(database, file, "servo", "time_us, kind, bytes"), &servoRow, recording.servo, share);
    progress.throwIfCancelled();
    sortByTime(recording.frames);
    sortByTime(recording.poses);
    sortByTime(recording.events);
    sortByTime(recording.inputs);
    return recording;
}

std::vector<FileRow> readFiles(const std::filesystem::path& file) {
    Database database(file, Database::Mode::readOnly);
    if (checkVersion(database, file) < 2) return {};
    std::vector<FileRow> files;
    Statement rows = database.prepare("SELECT name, bytes FROM file ORDER BY name");
    while (rows.step()) {
        files.push_back({rows.text(0), rows.bytes(1)});
        const std::string& name = files.back().name;
        if (!isAssetName(name) || name.find(':') != std::string::npos)
            throw DataError(file.string(), "a file in it has the name '" + name + "', which leaves its folder",
                            "choose another recording");
    }
    return files;
}

double secondsOf(const Recording& recording) {
    Microseconds last{0};
    if (!recording.frames.empty()) last = recording.frames.back().time;
    if (!recording.events.empty()) last = std::max(last, recording.events.back().time);
    return static_cast<double>(last.count()) / 1e6;
}

const FrameRow* frameAt(const Recording& recording, double seconds) {
    if (recording.frames.empty()) return nullptr;
    const auto after =
        std::upper_bound(recording.frames.begin(), recording.frames.end(), seconds, [](double at, const FrameRow& row) {
            return at < 1e-6 * static_cast<double>(row.time.count());
        });
    return after == recording.frames.begin() ? &recording.frames.front() : &*(after - 1);
}

} // namespace lumorph
