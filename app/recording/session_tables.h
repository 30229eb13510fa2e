#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

/// How rows lie in the file. Private to app/recording.
namespace lumorph::session_tables {

inline constexpr int kVersion = 3; ///< 1 knew no files, 2 no inputs
inline constexpr auto kSchema = R"(
    CREATE TABLE fact (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
    CREATE TABLE file (name TEXT PRIMARY KEY, bytes BLOB NOT NULL) WITHOUT ROWID;
    CREATE TABLE frame (id INTEGER PRIMARY KEY, time_us INTEGER NOT NULL, number INTEGER, seconds REAL, turned REAL,
        scene_seconds REAL, levels BLOB, wanted BLOB, estimated BLOB, world_from_device BLOB, device_from_target BLOB,
        eye BLOB, viewer TEXT, handing_over INTEGER, iou REAL, milliseconds REAL, latency REAL);
    CREATE TABLE pose (id INTEGER PRIMARY KEY, time_us INTEGER NOT NULL, measured_us INTEGER, source TEXT, name TEXT,
        body INTEGER, valid INTEGER, pose BLOB);
    CREATE TABLE event (id INTEGER PRIMARY KEY, time_us INTEGER NOT NULL, kind TEXT, text TEXT, remedy TEXT);
    CREATE TABLE input (id INTEGER PRIMARY KEY, time_us INTEGER NOT NULL, name TEXT, value REAL);
    CREATE TABLE servo (id INTEGER PRIMARY KEY, time_us INTEGER NOT NULL, kind TEXT, bytes BLOB);
)";

/// Numbers as they lie in memory (little endian), so that they come back bit for bit.
template <class T> std::span<const std::uint8_t> packed(std::span<const T> values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes()};
}

} // namespace lumorph::session_tables
