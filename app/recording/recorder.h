#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "app/recording/session_rows.h"

namespace lumorph {

/// Writes a session into an SQLite file (write-ahead log, so that others may read it meanwhile and a crash costs at
/// most the last half second). Rows are handed over from any thread and return at once; a thread of its own writes
/// them.
class Recorder {
public:
    /// `facts` are kept beside the rows: "project" (JSON), "profile" (JSON), "program", whatever helps to run the
    /// session again. Throws DeviceError where the file cannot be made.
    Recorder(const std::filesystem::path& file, const std::map<std::string, std::string>& facts);
    /// Finishes.
    ~Recorder();

    void add(FrameRow row);
    void add(PoseRow row);
    void add(EventRow row);
    void add(InputRow row);
    void add(ServoRow row);
    void add(FileRow row);

    /// Writes what is left and closes the file; may take as long as the disk. Rows that come later are dropped.
    void finish();

    [[nodiscard]] const std::filesystem::path& file() const noexcept;
    [[nodiscard]] std::uint64_t rows() const noexcept; ///< handed over so far
    /// What went wrong with the disk; empty while all is well. After that rows are dropped, what was written stays.
    [[nodiscard]] std::string trouble() const;

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace lumorph
