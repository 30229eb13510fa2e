#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "app/applications/navigation/map_import.h"
#include "tests/core/temporary_folder.h"

// Map files, written byte by byte from their specifications, so that what is read is held against known places and
// heights.

namespace lumorph::navigation {

/// Writes files into a folder of its own.
class MapFiles : public ::testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) const;
    TemporaryFolder folder_;
};

template <typename T> void put(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value); // little endian, as all machines of ours
}

/// A GeoTIFF (TIFF 6.0, OGC GeoTIFF 1.1), not compressed, one strip.
struct Tiff {
    enum class Sample { byte, int16, uint16, float32 };
    int columns = 40, rows = 30, bands = 1;
    Sample sample = Sample::float32;
    double west = 500000.0, north = 5200000.0, step = 10.0,
           turn = 0.0;                  ///< turn about its north-western corner, radians
    int epsg = 32632;                   ///< 0: none is named
    int vertical = 0, verticalUnit = 0; ///< EPSG codes; 0: none
    std::string missing;                ///< what is declared as missing; empty: nothing
    std::string metadata;               ///< items of GDALMetadata
    std::function<double(int x, int y, int band)> value;

    [[nodiscard]] std::string bytes() const;
};

/// A PNG, stored without compression: 8 bits by 1 (grey), 3 (RGB) or 4 (RGBA) channels, or 16 bits grey.
struct Png {
    int columns = 40, rows = 30, channels = 1, bits = 8;
    std::function<int(int x, int y, int channel)> value;

    [[nodiscard]] std::string bytes() const;
};

[[nodiscard]] bool tells(const MapReport& report, const std::string& words);
[[nodiscard]] bool isInGermanToo(const MapReport& report);
[[nodiscard]] std::string all(const MapReport& report);

/// What a building has of ground, without its courtyards, square metres, and its top over the ground, metres.
struct Measured {
    double area = 0.0, height = 0.0;
};
[[nodiscard]] Measured measured(const ImportedMap& imported);

/// A case of ../shared/data/cases/maps; nothing where that is not there.
[[nodiscard]] std::optional<std::filesystem::path> mapCase(const std::string& name);

} // namespace lumorph::navigation
