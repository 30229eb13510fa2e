#include "app/recording/recording.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <glm/gtc/type_ptr.hpp>

#include "app/recording/database.h"
#include "app/recording/session_tables.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

using namespace session_tables;

constexpr std::size_t kMostNumbers = 100'000; // of one row

/// Reads one table; knows where it is, for its errors.
class Reader {
public:
    Reader(Database& database, const std::filesystem::path& file, std::string table, const char* columns)
        : statement_(database.prepare("SELECT " + std::string(columns) + " FROM " + table + " ORDER BY time_us, id")),
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

ServoRow servoRow(const Reader& reader) { return {reader.time(), reader.row().text(1), reader.row().bytes(2)}; }

void checkVersion(Database& database, const std::filesystem::path& file) {
    Statement version = database.prepare("PRAGMA user_version");
    const std::int64_t found = version.step() ? version.integer(0) : 0;
    if (found == kVersion) return;
    if (found > kVersion)
        throw DataError(file.string(), "a newer Lumorph recorded it", "open it with that version, or update this one");
    throw DataError(file.string(), "it is a database, but no recording", "choose a file that Lumorph recorded");
}

} // namespace

Recording readRecording(const std::filesystem::path& file) {
    Database database(file, Database::Mode::readOnly);
    checkVersion(database, file);
    Recording recording;
    Statement facts = database.prepare("SELECT name, value FROM fact");
    while (facts.step()) recording.facts[facts.text(0)] = facts.text(1);
    Reader frames(database, file, "frame",
                  "time_us, number, seconds, turned, scene_seconds, levels, wanted, estimated, world_from_device, "
                  "device_from_target, eye, viewer, handing_over, iou, milliseconds, latency");
    while (frames.next()) recording.frames.push_back(frameRow(frames));
    Reader poses(database, file, "pose", "time_us, measured_us, source, name, body, valid, pose");
    while (poses.next()) recording.poses.push_back(poseRow(poses));
    Reader events(database, file, "event", "time_us, kind, text, remedy");
    while (events.next()) recording.events.push_back(eventRow(events));
    Reader servo(database, file, "servo", "time_us, kind, bytes");
    while (servo.next()) recording.servo.push_back(servoRow(servo));
    return recording;
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
