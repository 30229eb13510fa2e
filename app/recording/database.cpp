#include "app/recording/database.h"

#include <sqlite3.h>

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
    sqlite3* opened = nullptr;
    const int flags = mode == Mode::create ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
    const int result = sqlite3_open_v2(file_.c_str(), &opened, flags | SQLITE_OPEN_NOMUTEX, nullptr);
    database_.reset(opened);
    if (result != SQLITE_OK) fail(opened, file_);
    sqlite3_busy_timeout(opened, 2000);
}

void Database::run(const char* sql) {
    if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail(database_.get(), file_);
}

Statement Database::prepare(std::string_view sql) { return {*database_, sql, file_}; }

} // namespace lumorph
