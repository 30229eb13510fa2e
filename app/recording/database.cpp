#include "app/recording/database.h"

#include <array>
#include <fstream>
#include <system_error>

#include <sqlite3.h>
#include <sys/stat.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

[[noreturn]] void fail(sqlite3* database, const std::string& file) {
    const int code = database == nullptr ? SQLITE_NOMEM : sqlite3_errcode(database);
    const std::string why = database == nullptr ? "no memory is left" : sqlite3_errmsg(database);
    if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB || code == SQLITE_ERROR || code == SQLITE_MISMATCH)
        throw DataError(file, "it is no recording, or damaged (" + why + ")", "choose a file that Lumorph recorded");
    throw DeviceError(file, why, "check that the disk has room and that you may write there");
}

namespace fs = std::filesystem;

fs::path logOf(const fs::path& file) { return file.string() + "-wal"; }

/// Whether a connection holds the file's shared index: its writer runs. Opening the index to ask would let go of the
/// locks that this process has on it.
bool isInUse(const fs::path& file) {
    struct stat index {};
    if (::stat((file.string() + "-shm").c_str(), &index) != 0) return false;
    const std::string inode = ":" + std::to_string(index.st_ino) + " ";
    std::ifstream locks("/proc/locks");
    for (std::string line; std::getline(locks, line);)
        if (line.find(inode) != std::string::npos) return true;
    return false;
}

/// Whether the file says that a log belongs to it, as it does until its writer closes it.
bool namesLog(const fs::path& file) {
    std::array<char, 20> head{};
    std::ifstream(file, std::ios::binary).read(head.data(), head.size());
    constexpr char kWriteAheadLog = 2;
    return head[18] == kWriteAheadLog && head[19] == kWriteAheadLog; // format of the file, section 1.3.3
}

std::string uriOf(const fs::path& file) {
    std::string uri = "file:";
    for (const char c : fs::absolute(file).string()) {
        constexpr std::string_view kDigits = "0123456789ABCDEF";
        const auto byte = static_cast<unsigned char>(c);
        if (c != '%' && c != '?' && c != '#')
            uri += c;
        else
            uri += {'%', kDigits[byte / 16], kDigits[byte % 16]};
    }
    return uri;
}

} // namespace

void Statement::Finish::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(sqlite3& database, std::string_view sql, std::string file)
    : database_(database), file_(std::move(file)) {
    sqlite3_stmt* made = nullptr;
    if (sqlite3_prepare_v2(&database, sql.data(), static_cast<int>(sql.size()), &made, nullptr) != SQLITE_OK)
        fail(&database, file_);
    statement_.reset(made);
}

void Statement::bind(int parameter, std::int64_t value) { sqlite3_bind_int64(statement_.get(), parameter + 1, value); }
void Statement::bind(int parameter, double value) { sqlite3_bind_double(statement_.get(), parameter + 1, value); }

void Statement::bind(int parameter, const std::string& value) {
    sqlite3_bind_text(statement_.get(), parameter + 1, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
}

void Statement::bind(int parameter, std::span<const std::uint8_t> value) {
    // Without an address SQLite would store nothing instead of no bytes.
    sqlite3_bind_blob(statement_.get(), parameter + 1, value.empty() ? "" : static_cast<const void*>(value.data()),
                      static_cast<int>(value.size()), SQLITE_TRANSIENT);
}

void Statement::bindNothing(int parameter) { sqlite3_bind_null(statement_.get(), parameter + 1); }

bool Statement::step() {
    const int result = sqlite3_step(statement_.get());
    if (result == SQLITE_ROW) return true;
    if (result != SQLITE_DONE) fail(&database_, file_);
    return false;
}

void Statement::reset() {
    sqlite3_reset(statement_.get());
    sqlite3_clear_bindings(statement_.get());
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string Statement::text(int column) const {
    const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
    return text == nullptr ? std::string() : std::string(text, size);
}

std::vector<std::uint8_t> Statement::bytes(int column) const {
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column));
    return data == nullptr ? std::vector<std::uint8_t>() : std::vector<std::uint8_t>(data, data + size);
}

bool Statement::isNothing(int column) const { return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL; }

void Database::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

Database::Database(const std::filesystem::path& file, Mode mode) : file_(file.string()) {
    if (mode == Mode::create && std::filesystem::exists(file))
        throw DeviceError(file_, "there is a file of this name", "choose another name, or move that file away");
    if (mode == Mode::readOnly && !std::filesystem::is_regular_file(file))
        throw DataError(file_, "there is no such file", "check the name");
    if (mode == Mode::readOnly) {
        openToRead(file);
        return;
    }
    sqlite3* opened = nullptr;
    constexpr int kFlags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
    const int result = sqlite3_open_v2(file_.c_str(), &opened, kFlags, nullptr);
    database_.reset(opened);
    if (result != SQLITE_OK) fail(opened, file_);
    sqlite3_busy_timeout(opened, 2000);
}

void Database::openToRead(const std::filesystem::path& file) {
    std::error_code failed;
    const bool inUse = isInUse(file);
    const std::uintmax_t log = fs::file_size(logOf(file), failed);
    const bool hasLog = !failed && log > 0;
    if (inUse)
        left_ = Left::open;
    else if (hasLog)
        left_ = Left::notClosed;
    else if (namesLog(file))
        left_ = Left::withoutLog;
    // A writer that runs has made what is shared with it. Where none does, SQLite would make it: an empty log and an
    // index. A log is then read without locks, its index in memory; without a log the file alone counts.
    const std::string name = uriOf(file) + (left_ == Left::withoutLog ? "?immutable=1" : "");
    sqlite3* opened = nullptr;
    constexpr int kFlags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX;
    const int result = sqlite3_open_v2(name.c_str(), &opened, kFlags, left_ == Left::notClosed ? "unix-none" : nullptr);
    database_.reset(opened);
    if (result != SQLITE_OK) fail(opened, file_);
    sqlite3_busy_timeout(opened, 2000);
    if (left_ != Left::notClosed) return;
    sqlite3_db_config(opened, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, static_cast<int*>(nullptr));
    run("PRAGMA locking_mode = EXCLUSIVE");
}

void Database::run(const char* sql) {
    if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(database_.get(), file_);
}

Statement Database::prepare(std::string_view sql) { return {*database_, sql, file_}; }

} // namespace lumorph
