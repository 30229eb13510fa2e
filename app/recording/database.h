#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace lumorph {

/// One prepared statement. Columns and parameters count from 0.
class Statement {
public:
    Statement(sqlite3& database, std::string_view sql, std::string file);

    void bind(int parameter, std::int64_t value);
    void bind(int parameter, double value);
    void bind(int parameter, const std::string& value);
    void bind(int parameter, std::span<const std::uint8_t> value);
    void bindNothing(int parameter);
    /// True while there is a row. Throws DeviceError when the disk refuses, DataError when the file is damaged.
    bool step();
    /// Ready to be run again.
    void reset();

    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] double real(int column) const;
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::vector<std::uint8_t> bytes(int column) const;
    [[nodiscard]] bool isNothing(int column) const;

private:
    struct Finish {
        void operator()(sqlite3_stmt* statement) const;
    };
    std::unique_ptr<sqlite3_stmt, Finish> statement_;
    sqlite3& database_;
    std::string file_;
};

/// An SQLite file. Errors name it.
class Database {
public:
    enum class Mode { readOnly, create };
    /// `create` throws DeviceError for a file that is there already. `readOnly` writes nothing, neither into the file
    /// nor beside it.
    Database(const std::filesystem::path& file, Mode mode);

    /// How a file was left that is read.
    enum class Left {
        closed,
        open,       ///< its writer runs still
        notClosed,  ///< its writer ended without closing it; what its log (FILE-wal) holds is read too
        withoutLog, ///< the same, and its log is missing or empty
    };
    [[nodiscard]] Left left() const noexcept { return left_; }

    void run(const char* sql);
    [[nodiscard]] Statement prepare(std::string_view sql);

private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    void openToRead(const std::filesystem::path& file);

    std::unique_ptr<sqlite3, Close> database_;
    std::string file_;
    Left left_ = Left::closed;
};

} // namespace lumorph
