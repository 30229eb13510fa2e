#include "app/recording/recorder.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <glm/gtc/type_ptr.hpp>

#include "app/recording/database.h"
#include "app/recording/session_tables.h"
#include "core/base/error.h"

namespace lumorph {
namespace {

using namespace session_tables;
using Row = std::variant<FrameRow, PoseRow, EventRow, InputRow, ServoRow, FileRow>;

constexpr std::chrono::milliseconds kPause{200}; // what a crash may cost
constexpr std::size_t kMostWaiting = 1'000'000;  // minutes of a disk that stands still

std::int64_t us(Microseconds time) { return time.count(); }

std::span<const float> numbers(const glm::mat4& matrix) { return {glm::value_ptr(matrix), 16}; }

/// The statements of a file that is being written.
class Writer {
public:
    Writer(const std::filesystem::path& file, const std::map<std::string, std::string>& facts)
        : database_(file, Database::Mode::create) {
        database_.run("PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;");
        database_.run(kSchema);
        database_.run(("PRAGMA user_version = " + std::to_string(kVersion)).c_str());
        Statement fact = database_.prepare("INSERT INTO fact VALUES (?, ?)");
        for (const auto& [name, value] : facts) {
            fact.bind(0, name);
            fact.bind(1, value);
            fact.step();
            fact.reset();
        }
        frame_.emplace(
            database_.prepare("INSERT INTO frame VALUES (NULL, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"));
        pose_.emplace(database_.prepare("INSERT INTO pose VALUES (NULL, ?, ?, ?, ?, ?, ?, ?)"));
        event_.emplace(database_.prepare("INSERT INTO event VALUES (NULL, ?, ?, ?, ?)"));
        input_.emplace(database_.prepare("INSERT INTO input VALUES (NULL, ?, ?, ?)"));
        servo_.emplace(database_.prepare("INSERT INTO servo VALUES (NULL, ?, ?, ?)"));
        file_.emplace(database_.prepare("INSERT OR REPLACE INTO file VALUES (?, ?)"));
    }

    void write(const std::vector<Row>& rows) {
        database_.run("BEGIN");
        for (const Row& row : rows) std::visit([this](const auto& one) { write(one); }, row);
        database_.run("COMMIT");
    }

    /// One file without companions, which can be read where nothing may be written. While somebody reads it, it stays
    /// as it is: whole too.
    void close() {
        for (std::optional<Statement>* statement : {&frame_, &pose_, &event_, &input_, &servo_, &file_})
            statement->reset();
        try {
            database_.run("PRAGMA busy_timeout = 0; PRAGMA journal_mode = DELETE");
        } catch (const std::exception&) { // a reader
        }
    }

private:
    void write(const FrameRow& row);
    void write(const PoseRow& row);
    void write(const EventRow& row);
    void write(const InputRow& row);
    void write(const ServoRow& row);
    void write(const FileRow& row);

    static void run(Statement& statement) {
        statement.step();
        statement.reset();
    }

    Database database_;
    std::optional<Statement> frame_, pose_, event_, input_, servo_, file_;
};

void Writer::write(const FrameRow& row) {
    Statement& to = *frame_;
    to.bind(0, us(row.time));
    to.bind(1, static_cast<std::int64_t>(row.number));
    to.bind(2, row.seconds);
    to.bind(3, row.turned);
    to.bind(4, row.sceneSeconds);
    to.bind(5, packed(std::span<const int>(row.levels)));
    to.bind(6, packed(std::span<const double>(row.wanted)));
    to.bind(7, packed(std::span<const double>(row.estimated)));
    to.bind(8, packed(numbers(row.worldFromDevice)));
    to.bind(9, packed(numbers(row.deviceFromTarget)));
    if (row.eye)
        to.bind(10, packed(std::span<const float>(glm::value_ptr(*row.eye), 3)));
    else
        to.bindNothing(10);
    to.bind(11, row.viewer);
    to.bind(12, std::int64_t{row.handingOver});
    to.bind(13, row.iou);
    to.bind(14, row.milliseconds);
    to.bind(15, row.latency);
    run(to);
}

void Writer::write(const PoseRow& row) {
    Statement& to = *pose_;
    const auto& [position, turn] = row.pose;
    const std::array<double, 7> numbers{position.x, position.y, position.z, turn.x, turn.y, turn.z, turn.w};
    to.bind(0, us(row.time));
    to.bind(1, us(row.measured));
    to.bind(2, row.source);
    to.bind(3, row.name);
    to.bind(4, std::int64_t{row.id});
    to.bind(5, std::int64_t{row.valid});
    to.bind(6, packed(std::span<const double>(numbers)));
    run(to);
}

void Writer::write(const EventRow& row) {
    event_->bind(0, us(row.time));
    event_->bind(1, row.kind);
    event_->bind(2, row.text);
    event_->bind(3, row.remedy);
    run(*event_);
}

void Writer::write(const InputRow& row) {
    input_->bind(0, us(row.time));
    input_->bind(1, row.name);
    input_->bind(2, row.value);
    run(*input_);
}

void Writer::write(const ServoRow& row) {
    servo_->bind(0, us(row.time));
    servo_->bind(1, row.kind);
    servo_->bind(2, std::span<const std::uint8_t>(row.bytes));
    run(*servo_);
}

void Writer::write(const FileRow& row) {
    file_->bind(0, row.name);
    file_->bind(1, std::span<const std::uint8_t>(row.bytes));
    run(*file_);
}

} // namespace

struct Recorder::Data {
    Data(const std::filesystem::path& where, const std::map<std::string, std::string>& facts)
        : file(where), writer(std::make_unique<Writer>(where, facts)) {}

    void add(Row row);
    void run(const std::stop_token& stop);

    std::filesystem::path file;
    std::unique_ptr<Writer> writer; ///< until it is finished
    mutable std::mutex mutex;
    std::condition_variable_any changed;
    std::vector<Row> waiting;
    std::string trouble;
    bool ended = false;
    std::atomic<std::uint64_t> rows = 0;
    std::jthread thread; ///< last, so that it ends before what it uses
};

void Recorder::Data::add(Row row) {
    const std::scoped_lock lock(mutex);
    if (!trouble.empty() || ended) return;
    if (waiting.size() >= kMostWaiting) {
        trouble = DeviceError(file.string(), "the disk does not keep up", "record to a faster one").what();
        return;
    }
    waiting.push_back(std::move(row));
    ++rows;
}

// Rows are gathered for a while: a transaction costs more than a row.
void Recorder::Data::run(const std::stop_token& stop) {
    for (bool last = false; !last;) {
        std::vector<Row> due;
        {
            std::unique_lock lock(mutex);
            changed.wait_for(lock, stop, kPause, [] { return false; });
            last = stop.stop_requested();
            due.swap(waiting);
        }
        if (due.empty()) continue;
        try {
            writer->write(due);
        } catch (const std::exception& error) {
            const std::scoped_lock lock(mutex);
            trouble = error.what();
            return;
        }
    }
}

Recorder::Recorder(const std::filesystem::path& file, const std::map<std::string, std::string>& facts)
    : data_(std::make_unique<Data>(file, facts)) {
    data_->thread = std::jthread([data = data_.get()](const std::stop_token& stop) { data->run(stop); });
}

Recorder::~Recorder() { finish(); }

void Recorder::finish() {
    if (!data_->thread.joinable()) return;
    {
        const std::scoped_lock lock(data_->mutex);
        data_->ended = true;
    }
    data_->thread.request_stop();
    data_->thread.join();
    if (data_->writer) data_->writer->close();
    data_->writer.reset();
}

void Recorder::add(FrameRow row) { data_->add(std::move(row)); }
void Recorder::add(PoseRow row) { data_->add(std::move(row)); }
void Recorder::add(EventRow row) { data_->add(std::move(row)); }
void Recorder::add(InputRow row) { data_->add(std::move(row)); }
void Recorder::add(ServoRow row) { data_->add(std::move(row)); }
void Recorder::add(FileRow row) { data_->add(std::move(row)); }

const std::filesystem::path& Recorder::file() const noexcept { return data_->file; }
std::uint64_t Recorder::rows() const noexcept { return data_->rows; }

std::string Recorder::trouble() const {
    const std::scoped_lock lock(data_->mutex);
    return data_->trouble;
}

} // namespace lumorph
