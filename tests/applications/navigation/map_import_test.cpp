#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/navigation/map_import.h"
#include "core/base/error.h"
#include "tests/applications/navigation/map_files.h"

// Maps of one's own. Files are written here byte by byte, so that what is read is held against known places and
// heights.

namespace lumorph::navigation {
namespace {

namespace fs = std::filesystem;

using MapImport = MapFiles;

struct Georeference {
    double west = 0.0, north = 0.0, step = 10.0;
    int epsg = 32632; ///< 0: none is named
};

/// Of floats.
template <typename Height> std::string geoTiff(int columns, int rows, const Georeference& geo, const Height& height) {
    Tiff tiff;
    tiff.columns = columns;
    tiff.rows = rows;
    tiff.west = geo.west;
    tiff.north = geo.north;
    tiff.step = geo.step;
    tiff.epsg = geo.epsg;
    tiff.value = [&](int x, int y, int) { return height(x, y); };
    return tiff.bytes();
}

/// A slope: 100 m at its western edge, 2 m more for each sample, and 1 m a row to the south.
double slope(int x, int y) { return 100.0 + 2.0 * x + y; }

TEST_F(MapImport, AGeoTiffInMetresIsWhereItSays) {
    write("ground.tif", geoTiff(101, 81, {500000.0, 5200000.0, 10.0}, slope));
    const ImportedMap imported = importMap(folder_.path());
    const HeightMap& heights = imported.map.heights;
    EXPECT_EQ(imported.projection, "EPSG:32632");
    EXPECT_NEAR(heights.spacing(), 10.0, 1e-6);
    EXPECT_EQ(heights.samples(), glm::ivec2(101, 81));
    EXPECT_NEAR(imported.origin.x, 500005.0, 0.01) << "the middle of its first pixel";
    EXPECT_NEAR(imported.origin.y, 5199995.0, 0.01);
    for (const glm::ivec2 at : {glm::ivec2(0, 0), {50, 40}, {99, 3}, {7, 80}})
        EXPECT_NEAR(static_cast<double>(heights.at(at)), slope(at.x, at.y), 0.01) << at.x << " " << at.y;
}

// A degree of longitude at the equator is 111319.49 m (WGS 84, 6378137 m), and UTM shrinks the zone's middle by 0.9996.
TEST_F(MapImport, DegreesBecomeMetres) {
    write("ground.tif", geoTiff(101, 101, {8.95, 0.06, 0.001, 4326}, slope));
    const ImportedMap imported = importMap(folder_.path());
    const glm::dvec2 size = imported.map.heights.size();
    EXPECT_EQ(imported.projection, "EPSG:32632");
    EXPECT_NEAR(size.x, 0.101 * 111319.49 * 0.9996, 260.0);
    // Ten thousandths of a degree east of the zone's middle meridian, on the equator.
    const glm::dvec2 place(500000.0 + 0.01 * 111319.49 * 0.9996 - imported.origin.x, imported.origin.y - 0.0);
    EXPECT_NEAR(imported.map.heights.at(place, 0.0), slope(0, 0) + 2.0 * 59.5 + 59.5, 1.0);
}

TEST_F(MapImport, AnSrtmTileIsRead) {
    std::string bytes;
    for (int y = 0; y < 1201; ++y)
        for (int x = 0; x < 1201; ++x) {
            const int height = x == 600 && y == 600 ? -32768 : 300 + x / 2;
            bytes.push_back(static_cast<char>(height >> 8));
            bytes.push_back(static_cast<char>(height & 255));
        }
    const auto begun = std::chrono::steady_clock::now();
    const ImportedMap imported = importMap(write("N46E007.hgt", bytes));
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(), 10.0);
    EXPECT_GT(imported.report.filled, 0.0) << "a void, and corners beyond the tile";
    EXPECT_NEAR(imported.map.heights.highest(), 900.0, 3.0);
    EXPECT_NEAR(imported.map.heights.at(0.5 * imported.map.heights.size(), 0.0), 600.0, 6.0);
}

TEST_F(MapImport, APictureWithoutAPlaceIsTakenAsMetres) {
    const ImportedMap imported = importMap(
        write("heights.png", Png{80, 60, 1, 16, [](int x, int y, int) { return 1000 + 10 * x + y; }}.bytes()));
    EXPECT_TRUE(tells(imported.report, "where it lies")) << all(imported.report);
    EXPECT_EQ(imported.map.heights.samples(), glm::ivec2(80, 60));
    EXPECT_NEAR(static_cast<double>(imported.map.heights.at({70, 50})), 1750.0, 0.5);
}

TEST_F(MapImport, AWrongProjectionIsSeenThrough) {
    write("ground.tif", geoTiff(60, 60, {8.95, 0.05, 0.001, 32632}, slope)); // degrees that say they are metres
    const ImportedMap imported = importMap(folder_.path());
    EXPECT_TRUE(tells(imported.report, "look like degrees")) << all(imported.report);
    EXPECT_NEAR(imported.map.heights.size().x, 0.06 * 111319.49, 300.0);
}

/// 0.0001 degrees are 11.13 m at the equator.
constexpr const char* kHouses = R"({"type":"FeatureCollection","features":[
 {"type":"Feature","properties":{"height":12.5,"name":"Mill"},"geometry":{"type":"Polygon","coordinates":[[[9.0,0.0],[9.0002,0.0],[9.0002,0.0001],[9.0,0.0001],[9.0,0.0]]]}},
 {"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[9.001,0.0],[9.0012,0.0],[9.0012,0.0001],[9.001,0.0001],[9.001,0.0]]]}},
 {"type":"Feature","properties":{"height":9},"geometry":{"type":"Polygon","coordinates":[[[9.002,0.0],[9.0023,0.0003],[9.0023,0.0],[9.002,0.0003],[9.002,0.0]]]}},
 {"type":"Feature","properties":{"height":9},"geometry":{"type":"Polygon","coordinates":[[[9.003,0.0],[9.0033,0.0],[9.0033,0.0003],[9.0032,0.0003],[9.0032,0.0001],[9.003,0.0001],[9.003,0.0]]]}},
 {"type":"Feature","properties":{"name":"Square"},"geometry":{"type":"Point","coordinates":[9.0001,0.0005]}},
 {"type":"Feature","properties":{"height":9},"geometry":null},
 {"type":"Feature","properties":{"height":5},"geometry":{"type":"Polygon","coordinates":[[[29.0,0.0],[29.0002,0.0],[29.0002,0.0001],[29.0,0.0]]]}}]})";

TEST_F(MapImport, OutlinesStandWhereAndAsHighAsTheySay) {
    write("ground.tif", geoTiff(101, 101, {8.95, 0.06, 0.001, 4326}, [](int, int) { return 50.0; }));
    write("houses.geojson", kHouses);
    const ImportedMap imported = importMap(folder_.path());
    const MapReport& report = imported.report;
    EXPECT_EQ(report.heightMissing, 1U) << all(report);
    EXPECT_EQ(report.mended, 1U);
    EXPECT_GE(report.leftOut, 2U) << "without geometry, and beyond the ground";
    EXPECT_TRUE(tells(report, "no height")) << all(report);
    EXPECT_TRUE(tells(report, "1 outline crossed itself"));
    EXPECT_TRUE(isInGermanToo(report)) << all(report);
    const auto mill = std::ranges::find_if(imported.map.buildings,
                                           [](const Building& b) { return std::abs(b.eaves - b.base - 12.5) < 1e-6; });
    ASSERT_NE(mill, imported.map.buildings.end());
    EXPECT_NEAR(mill->base, 50.0, 0.1);
    const glm::dvec2 corner(500000.0 - imported.origin.x, imported.origin.y - 0.0); // 9 degrees east, on the equator
    double nearest = 1e9;
    for (const glm::dvec2& p : mill->outline) nearest = std::min(nearest, glm::distance(p, corner));
    EXPECT_LT(nearest, 0.05) << "metres";
    EXPECT_TRUE(std::ranges::any_of(imported.map.places, [](const Place& p) { return p.name.english == "Square"; }));
}

TEST_F(MapImport, AnOsmExtractHasHousesRoadsAndNames) {
    const ImportedMap imported = importMap(write("town.osm", R"(<?xml version="1.0"?><osm version="0.6">
 <node id="1" lat="0.0" lon="9.0"/><node id="2" lat="0.0" lon="9.0002"/><node id="3" lat="0.0002" lon="9.0002"/><node id="4" lat="0.0002" lon="9.0"/>
 <node id="5" lat="0.001" lon="8.999"/><node id="6" lat="0.001" lon="9.003"/>
 <node id="7" lat="0.0005" lon="9.001"><tag k="place" v="town"/><tag k="name" v="Nowhere"/><tag k="name:de" v="Nirgends"/></node>
 <way id="10"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/><tag k="building" v="yes"/><tag k="building:levels" v="3"/></way>
 <way id="11"><nd ref="5"/><nd ref="6"/><tag k="highway" v="primary"/></way></osm>)"));
    EXPECT_EQ(imported.report.buildings, 1U) << all(imported.report);
    EXPECT_EQ(imported.report.roads, 1U);
    ASSERT_FALSE(imported.map.buildings.empty());
    EXPECT_NEAR(imported.map.buildings[0].eaves - imported.map.buildings[0].base, 10.0, 1e-6)
        << "three storeys and a roof";
    ASSERT_FALSE(imported.map.places.empty());
    EXPECT_EQ(imported.map.places[0].name, Words("Nowhere", "Nirgends"));
    EXPECT_TRUE(tells(imported.report, "level")) << "no heights";
}

/// A message of Protocol Buffers, field by field as their encoding says.
class Message {
public:
    Message& number(int field, std::uint64_t value) {
        varint(static_cast<std::uint64_t>(field) << 3U);
        varint(value);
        return *this;
    }
    Message& signedNumber(int field, std::int64_t value) { return number(field, zigzag(value)); }
    Message& text(int field, const std::string& value) {
        varint((static_cast<std::uint64_t>(field) << 3U) | 2U);
        varint(value.size());
        bytes_ += value;
        return *this;
    }
    Message& packed(int field, const std::vector<std::uint64_t>& values) {
        Message list;
        for (const std::uint64_t value : values) list.varint(value);
        return text(field, list.bytes_);
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }
    [[nodiscard]] static std::uint64_t zigzag(std::int64_t value) {
        return (static_cast<std::uint64_t>(value) << 1U) ^ static_cast<std::uint64_t>(value >> 63U);
    }

private:
    void varint(std::uint64_t value) {
        for (; value > 127U; value >>= 7U) bytes_ += static_cast<char>((value & 127U) | 128U);
        bytes_ += static_cast<char>(value);
    }
    std::string bytes_;
};

/// One block of an OSM extract, not compressed: the length of its head (big endian), its head, its blob.
std::string osmBlock(const std::string& type, const std::string& content) {
    const std::string blob = Message().text(1, content).number(2, content.size()).bytes();
    const std::string head = Message().text(1, type).number(3, blob.size()).bytes();
    std::string bytes;
    for (const int shift : {24, 16, 8, 0})
        bytes += static_cast<char>((head.size() >> static_cast<unsigned>(shift)) & 255U);
    return bytes + head + blob;
}

/// The town of the .osm file above as .pbf (fileformat.proto and osmformat.proto of OpenStreetMap).
std::string osmTown() {
    const std::vector<std::string> words{"",      "building", "yes",  "building:levels", "3", "highway", "primary",
                                         "place", "town",     "name", "Nowhere"};
    Message table, group;
    for (const std::string& word : words) table.text(1, word);
    const auto node = [&](int id, double latitude, double longitude, const Message& tags = {}) {
        const auto units = [](double degrees) { return static_cast<std::int64_t>(std::llround(1e7 * degrees)); };
        Message made = tags; // its fields may come in any order
        group.text(1,
                   made.signedNumber(1, id).signedNumber(8, units(latitude)).signedNumber(9, units(longitude)).bytes());
    };
    const auto way = [&](int id, const std::vector<std::int64_t>& nodes, const Message& tags) {
        std::vector<std::uint64_t> steps;
        std::int64_t before = 0;
        for (const std::int64_t next : nodes) steps.push_back(Message::zigzag(next - std::exchange(before, next)));
        Message made = tags;
        group.text(3, made.number(1, static_cast<std::uint64_t>(id)).packed(8, steps).bytes());
    };
    node(1, 0.0, 9.0);
    node(2, 0.0, 9.0002);
    node(3, 0.0002, 9.0002);
    node(4, 0.0002, 9.0);
    node(5, 0.001, 8.999);
    node(6, 0.001, 9.003);
    node(7, 0.0005, 9.001, Message().packed(2, {7, 9}).packed(3, {8, 10}));
    way(10, {1, 2, 3, 4, 1}, Message().packed(2, {1, 3}).packed(3, {2, 4}));
    way(11, {5, 6}, Message().packed(2, {5}).packed(3, {6}));
    return osmBlock("OSMHeader", Message().text(4, "OsmSchema-V0.6").bytes()) +
           osmBlock("OSMData", Message().text(1, table.bytes()).text(2, group.bytes()).bytes());
}

TEST_F(MapImport, AnOsmExtractInPbfHasTheSame) {
    const std::string bytes = osmTown();
    const ImportedMap imported = importMap(write("town.osm.pbf", bytes));
    EXPECT_EQ(imported.report.buildings, 1U) << all(imported.report);
    EXPECT_EQ(imported.report.roads, 1U);
    ASSERT_FALSE(imported.map.buildings.empty());
    const Building& house = imported.map.buildings[0];
    EXPECT_NEAR(house.eaves - house.base, 10.0, 1e-6) << "three storeys and a roof";
    // 0.0002 degrees of longitude and latitude at the equator; WGS 84 has 111,320 and 110,574 m a degree there.
    const double a = glm::distance(house.outline[0], house.outline[1]);
    const double b = glm::distance(house.outline[1], house.outline[2]);
    EXPECT_NEAR(std::max(a, b), 0.0002 * 111320.0, 0.05);
    EXPECT_NEAR(std::min(a, b), 0.0002 * 110574.0, 0.05);
    ASSERT_FALSE(imported.map.places.empty());
    EXPECT_EQ(imported.map.places[0].name.english, "Nowhere");
    for (const std::size_t length : {std::size_t{3}, std::size_t{20}, bytes.size() / 2, bytes.size() - 1})
        EXPECT_THROW(importMap(write("cut.osm.pbf", bytes.substr(0, length))), DataError) << length;
}

TEST_F(MapImport, ACityJsonHasHousesWithTheirHeights) {
    const std::string city =
        R"({"type":"CityJSON","version":"1.1","metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/32632"},
 "transform":{"scale":[0.01,0.01,0.01],"translate":[500000,5200000,100]},
 "vertices":[[0,0,0],[1000,0,0],[1000,800,0],[0,800,0],[0,0,700],[1000,0,700],[1000,800,700],[0,800,700]],
 "CityObjects":{"a":{"type":"Building","geometry":[{"type":"Solid","lod":"1","boundaries":[[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]]}]},
 "b":{"type":"Building","geometry":[]}}})";
    const ImportedMap imported = importMap(write("city.json", city));
    ASSERT_EQ(imported.map.buildings.size(), 1U) << all(imported.report);
    EXPECT_NEAR(imported.map.buildings[0].eaves - imported.map.buildings[0].base, 7.0, 1e-6);
    const auto& outline = imported.map.buildings[0].outline;
    EXPECT_NEAR(std::max(glm::distance(outline[0], outline[1]), glm::distance(outline[1], outline[2])), 10.0, 0.01);
    EXPECT_NEAR(std::min(glm::distance(outline[0], outline[1]), glm::distance(outline[1], outline[2])), 8.0, 0.01);
    EXPECT_GE(imported.report.leftOut, 1U) << "one without a shape";
    const std::string broken =
        city.substr(0, city.find("[[[[0,3,2,1]]")) + "[[[[0,3,2,99]]" + city.substr(city.find("[[[[0,3,2,1]]") + 13);
    EXPECT_THROW((void)importMap(write("city.json", broken)), DataError);
}

TEST_F(MapImport, DamagedEmptyAndForeignFilesAreRefusedWithWords) {
    const std::string tiff = geoTiff(50, 50, {500000.0, 5200000.0, 10.0}, slope);
    const struct {
        const char* name;
        std::string bytes;
    } rows[] = {{"empty.tif", ""},
                {"noise.tif", "II*_this is no picture at all"},
                {"empty.geojson", ""},
                {"cut.geojson", std::string(kHouses).substr(0, 150)},
                {"none.geojson", R"({"type":"FeatureCollection","features":[]})"},
                {"note.txt", "hello"},
                {"N46E007.hgt", "short"}};
    for (const auto& row : rows) {
        try {
            (void)importMap(write(row.name, row.bytes));
            ADD_FAILURE() << row.name << " was read";
        } catch (const DataError& error) {
            EXPECT_FALSE(error.why().empty()) << row.name;
            EXPECT_FALSE(error.remedy().empty()) << row.name;
        }
    }
    EXPECT_THROW((void)importMap(folder_ / "nothing.tif"), DataError);
    // What is sound beside it is shown anyway.
    fs::remove_all(folder_.path());
    fs::create_directories(folder_.path());
    write("ground.tif", tiff);
    write("broken.tif", "II*_this is no picture at all");
    write("cut.geojson", std::string(kHouses).substr(0, 150));
    const ImportedMap imported = importMap(folder_.path());
    EXPECT_TRUE(tells(imported.report, "broken.tif")) << all(imported.report);
    EXPECT_TRUE(tells(imported.report, "cut.geojson")) << all(imported.report);
    EXPECT_TRUE(isInGermanToo(imported.report)) << all(imported.report);
}

TEST_F(MapImport, ATruncatedTiffShowsWhatThereIsOrSaysWhy) {
    const std::string tiff = geoTiff(200, 200, {500000.0, 5200000.0, 10.0}, slope);
    try {
        const ImportedMap imported = importMap(write("cut.tif", tiff.substr(0, tiff.size() / 2)));
        EXPECT_FALSE(imported.report.notes.empty());
    } catch (const DataError& error) {
        EXPECT_FALSE(error.why().empty());
    }
}

TEST_F(MapImport, ATileOfTwentyKilometresTakesLessThanTenSeconds) {
    const fs::path file = write("tile.tif", geoTiff(2200, 2200, {500000.0, 5200000.0, 9.1}, slope));
    int told = 0;
    const auto begun = std::chrono::steady_clock::now();
    const ImportedMap imported = importMap(file, Progress([&](double, std::string_view) { ++told; }));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    std::cout << "a tile of 20 km: " << seconds << " s" << std::endl;
    EXPECT_LT(seconds, 10.0);
    EXPECT_GT(told, 5);
    EXPECT_LE(imported.map.heights.samples().x, kMostSamples);
    EXPECT_NEAR(imported.map.heights.size().x, 2200 * 9.1, 50.0);
}

TEST_F(MapImport, AHugeFileIsReadInParts) {
    // A gigabyte of heights that takes no room on the disk: TIFF's data are a hole in the file.
    const std::string head = geoTiff(1, 1, {500000.0, 5200000.0, 1.0}, [](int, int) { return 0.0; });
    std::string bytes = head;
    constexpr std::uint32_t kSide = 16000, kBytes = 4 * kSide * kSide;
    const auto patch = [&](std::uint16_t tag, std::uint32_t value) {
        for (std::size_t at = 10; at < 10 + 13 * 12; at += 12) {
            std::uint16_t here = 0;
            std::memcpy(&here, bytes.data() + at, 2);
            if (here == tag) std::memcpy(bytes.data() + at + 8, &value, 4);
        }
    };
    patch(256, kSide);
    patch(257, kSide);
    patch(278, kSide);
    patch(279, kBytes);
    const fs::path file = write("huge.tif", bytes);
    fs::resize_file(file, head.size() - 4 + kBytes);
    const auto begun = std::chrono::steady_clock::now();
    const ImportedMap imported = importMap(file);
    std::cout << "a gigabyte: " << std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count()
              << " s" << std::endl;
    EXPECT_TRUE(tells(imported.report, "only some are read")) << all(imported.report);
    EXPECT_LE(imported.map.heights.samples().x, kMostSamples);
    EXPECT_NEAR(imported.map.heights.size().x, 16000.0, 20.0);
}

} // namespace
} // namespace lumorph::navigation
