#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/applications/navigation/map_import.h"
#include "core/base/error.h"
#include "tests/applications/navigation/map_files.h"

// What the samples of a raster mean: metres, feet, tenths, colours, or no heights at all.

namespace lumorph::navigation {
namespace {

namespace fs = std::filesystem;

using MapHeights = MapFiles;

/// A cone of 1100 m on a plain of 600 m.
double cone(int x, int y, int) { return std::max(600.0, 1100.0 - 30.0 * std::hypot(x - 20, y - 15)); }

Tiff coneTiff() {
    Tiff tiff;
    tiff.value = cone;
    return tiff;
}

/// Bright and dark fields, as roofs and meadows are.
double photo(int x, int y, int band) {
    return 90 + (x / 4 % 2) * 60 + (y / 3 % 3) * 20 + 5 * band + (x * 7 + y * 3) % 5;
}

Tiff photoTiff() {
    Tiff tiff;
    tiff.bands = 3;
    tiff.sample = Tiff::Sample::byte;
    tiff.value = photo;
    return tiff;
}

void expectCone(const ImportedMap& imported, double tolerance = 0.5) {
    EXPECT_NEAR(imported.map.heights.highest(), 1100.0, tolerance) << all(imported.report);
    EXPECT_NEAR(imported.map.heights.lowest(), 600.0, tolerance) << all(imported.report);
}

TEST_F(MapHeights, ScaleAndOffsetOfTheBandAreApplied) {
    Tiff tiff = coneTiff();
    tiff.sample = Tiff::Sample::int16;
    tiff.metadata = R"(<Item name="SCALE" sample="0" role="scale">0.1</Item>)"
                    R"(<Item name="OFFSET" sample="0" role="offset">500</Item>)";
    tiff.missing = "-999";
    tiff.value = [](int x, int y, int) { return x == 0 && y == 0 ? -999.0 : 10.0 * (cone(x, y, 0) - 500.0); };
    const ImportedMap imported = importMap(write("scaled.tif", tiff.bytes()));
    expectCone(imported);
    EXPECT_TRUE(tells(imported.report, "scaled by 0.1")) << all(imported.report);
    EXPECT_NEAR(imported.report.filled, 1.0 / (40 * 30), 1e-9) << "what is missing is told before it is scaled";
    EXPECT_TRUE(isInGermanToo(imported.report));
}

TEST_F(MapHeights, FeetOfTheBandOrOfTheVerticalSystemBecomeMetres) {
    const struct {
        const char* name;
        std::string unit;
        int vertical, verticalUnit;
        double metres;
    } rows[] = {{"unit.tif", "ft", 0, 0, 0.3048},
                {"survey.tif", "US survey foot", 0, 0, 1200.0 / 3937.0},
                {"survey system.tif", "", 6360, 9003, 1200.0 / 3937.0},
                {"foot system.tif", "", 8228, 9002, 0.3048},
                {"metre system.tif", "", 5703, 9001, 1.0},
                {"both.tif", "ft", 8228, 9002, 0.3048}};
    for (const auto& row : rows) {
        Tiff tiff = coneTiff();
        tiff.vertical = row.vertical;
        tiff.verticalUnit = row.verticalUnit;
        if (!row.unit.empty())
            tiff.metadata = "<Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">" + row.unit + "</Item>";
        tiff.value = [&](int x, int y, int) { return cone(x, y, 0) / row.metres; };
        SCOPED_TRACE(row.name);
        const ImportedMap imported = importMap(write(row.name, tiff.bytes()));
        expectCone(imported, 0.01);
        EXPECT_EQ(tells(imported.report, "in units of"), row.metres != 1.0) << all(imported.report);
    }
}

TEST_F(MapHeights, AnotherQuantityIsNoHeight) {
    Tiff tiff = coneTiff();
    tiff.metadata = R"(<Item name="UNITTYPE" sample="0" role="unittype">degC</Item>)";
    try {
        (void)importMap(write("warmth.tif", tiff.bytes()));
        ADD_FAILURE() << "temperatures became land";
    } catch (const DataError& error) {
        EXPECT_NE(error.why().find("'degC'"), std::string::npos) << error.why();
    }
}

TEST_F(MapHeights, ColoursOfTerrainTilesAreHeights) {
    const auto coded = [&](bool terrarium, int channels) {
        return Png{60, 50, channels, 8, [=](int x, int y, int channel) {
                       if (channel == 3) return x == 0 ? 0 : 255; // transparent: missing
                       const double metres = 655.3 + 7.37 * x - 3.11 * y;
                       const auto code = static_cast<int>(terrarium ? std::floor(256.0 * (metres + 32768.0))
                                                                    : std::round(10.0 * (metres + 10000.0)));
                       return code >> (16 - 8 * channel) & 255;
                   }};
    };
    for (const bool terrarium : {true, false})
        for (const int channels : {3, 4}) {
            const ImportedMap imported = importMap(write("tile.png", coded(terrarium, channels).bytes()));
            EXPECT_TRUE(tells(imported.report, terrarium ? "Terrarium" : "Terrain-RGB")) << all(imported.report);
            for (const glm::ivec2 at : {glm::ivec2(1, 0), {59, 0}, {30, 49}, {17, 23}})
                EXPECT_NEAR(static_cast<double>(imported.map.heights.at(at)), 655.3 + 7.37 * at.x - 3.11 * at.y, 0.06)
                    << at.x << " " << at.y;
            EXPECT_NEAR(imported.report.filled, channels == 4 ? 1.0 / 60.0 : 0.0, 1e-9);
        }
}

TEST_F(MapHeights, PicturesAloneAreRefusedAsWhatTheyAre) {
    Tiff hillshade = photoTiff();
    hillshade.bands = 1;
    hillshade.missing = "0"; // as gdaldem writes it
    Tiff infrared = photoTiff();
    infrared.bands = 4;
    infrared.sample = Tiff::Sample::uint16;
    const struct {
        const char* name;
        std::string bytes;
        const char* why;
    } rows[] = {
        {"photo.tif", photoTiff().bytes(), "picture of colours (3 bands)"},
        {"hillshade.tif", hillshade.bytes(), "grey picture of 8 bits"},
        {"infrared.tif", infrared.bytes(), "picture of colours (4 bands)"},
        {"grey.png", Png{40, 30, 1, 8, [](int x, int y, int) { return x + y; }}.bytes(), "grey picture of 8 bits"},
        {"photo.png", Png{40, 30, 3, 8, [](int x, int y, int c) { return static_cast<int>(photo(x, y, c)); }}.bytes(),
         "picture of colours"},
        {"blue sea.png", Png{40, 30, 3, 8, [](int, int, int c) { return 60 * c; }}.bytes(), "picture of colours"},
        {"meadow.jpg", "\xFF\xD8\xFF", "a photo"}};
    for (const auto& row : rows) {
        try {
            (void)importMap(write(row.name, row.bytes));
            ADD_FAILURE() << row.name << " became land";
        } catch (const DataError& error) {
            EXPECT_NE(error.why().find(row.why), std::string::npos) << row.name << ": " << error.why();
        }
    }
}

TEST_F(MapHeights, EightBitsThatSayTheirUnitAreHeights) {
    Tiff tiff = photoTiff();
    tiff.bands = 1;
    tiff.metadata = R"(<Item name="UNITTYPE" sample="0" role="unittype">m</Item>)";
    tiff.value = [](int x, int y, int) { return 3.0 * x + y; };
    const ImportedMap imported = importMap(write("polder.tif", tiff.bytes()));
    EXPECT_NEAR(imported.map.heights.highest(), 3.0 * 39 + 29, 0.01);
}

TEST_F(MapHeights, PicturesBesideHeightsArePassedOverAndNamed) {
    write("a photo.tif", photoTiff().bytes());
    write("dem.tif", coneTiff().bytes());
    write("dem.tfw", "10\n");
    write("read me.txt", "hello");
    write("view.jpg", "\xFF\xD8\xFF");
    const ImportedMap imported = importMap(folder_.path());
    expectCone(imported);
    EXPECT_EQ(imported.report.passedOver, (std::vector<std::string>{"a photo.tif", "read me.txt", "view.jpg"}));
    for (const char* name : {"a photo.tif: ", "view.jpg: "}) EXPECT_TRUE(tells(imported.report, name)) << name;
    EXPECT_TRUE(isInGermanToo(imported.report)) << all(imported.report);
    const auto figures = nlohmann::json::parse(figuresOf(imported));
    EXPECT_NEAR(figures.at("highest").get<double>(), 1100.0, 0.5);
    EXPECT_NEAR(figures.at("lowest").get<double>(), 600.0, 0.5);
    EXPECT_EQ(figures.at("buildings"), 0);
    EXPECT_EQ(figures.at("tallest"), 0.0);
    EXPECT_EQ(figures.at("passedOver"), nlohmann::json({"a photo.tif", "read me.txt", "view.jpg"}));
}

// A tile that is turned leaves corners of the map without heights: they are no holes in it.
TEST_F(MapHeights, TheRimOfATurnedTileIsNoHole) {
    Tiff tiff;
    tiff.columns = tiff.rows = 100;
    tiff.turn = std::numbers::pi / 6.0;
    tiff.missing = "-1000";
    tiff.value = [](int, int, int) { return 700.0; };
    const ImportedMap whole = importMap(write("turned.tif", tiff.bytes()));
    EXPECT_EQ(whole.report.filled, 0.0) << all(whole.report);
    EXPECT_FALSE(tells(whole.report, "missing"));
    EXPECT_NEAR(whole.map.heights.size().x, 1000.0 * (std::cos(tiff.turn) + std::sin(tiff.turn)), 25.0);
    tiff.value = [](int x, int y, int) { return x >= 40 && x < 60 && y >= 40 && y < 60 ? -1000.0 : 700.0; };
    const ImportedMap holed = importMap(write("turned.tif", tiff.bytes()));
    EXPECT_NEAR(holed.report.filled, 0.04, 0.001) << "20 x 20 of 100 x 100";
    EXPECT_NEAR(holed.map.heights.lowest(), 700.0, 0.01);
}

TEST_F(MapHeights, NumbersThatAreNoHeightsCountAsMissing) {
    Tiff tiff = coneTiff();
    tiff.value = [](int x, int y, int) { return y == 3 && x < 12 ? -9999.0 : cone(x, y, 0); }; // not declared
    const ImportedMap imported = importMap(write("undeclared.tif", tiff.bytes()));
    expectCone(imported);
    EXPECT_NEAR(imported.report.filled, 12.0 / 1200.0, 1e-9);
    EXPECT_TRUE(tells(imported.report, "1.00 % of the heights were missing")) << all(imported.report);
}

std::string virtualOf(const std::string& source) {
    return R"(<VRTDataset rasterXSize="40" rasterYSize="30"><SRS>EPSG:32632</SRS>)"
           R"(<GeoTransform>500000, 10, 0, 5200000, 0, -10</GeoTransform><VRTRasterBand dataType="Float32" band="1">)"
           R"(<SimpleSource><SourceFilename relativeToVRT="0">)" +
           source + R"(</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>)";
}

TEST_F(MapHeights, AVirtualRasterUnderAnotherEndingIsRefused) {
    write("dem.tif", coneTiff().bytes());
    const std::string local = virtualOf((folder_ / "dem.tif").string());
    for (const char* name : {"evil.png", "evil.tif", "evil.hgt"}) {
        try {
            (void)importMap(write(name, local));
            ADD_FAILURE() << name << " was followed";
        } catch (const DataError& error) {
            EXPECT_NE(error.why().find("virtual raster"), std::string::npos) << error.why();
        }
    }
    expectCone(importMap(write("mosaic.vrt", local))); // as gdalbuildvrt writes them
}

/// A server on this machine that answers nothing and knows whether it was called.
class Listener {
public:
    Listener() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) == 0 && ::listen(socket_, 8) == 0 &&
            ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0)
            port_ = ntohs(address.sin_port);
    }
    ~Listener() { ::close(socket_); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    [[nodiscard]] std::string address() const { return "http://127.0.0.1:" + std::to_string(port_) + "/dem.tif"; }
    [[nodiscard]] bool wasCalled() const {
        pollfd waiting{socket_, POLLIN, 0};
        return ::poll(&waiting, 1, 0) > 0;
    }
    /// That `wasCalled` can be true.
    [[nodiscard]] bool hears() const {
        const int caller = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(port_);
        const bool connected = ::connect(caller, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
        ::close(caller);
        return connected && wasCalled();
    }

private:
    int socket_;
    std::uint16_t port_ = 0;
};

TEST_F(MapHeights, NoFileReachesTheNetwork) {
    ::setenv("GDAL_HTTP_TIMEOUT", "1", 1); // were it called, it would wait for an answer
    const Listener listener;
    const std::string address = listener.address();
    const std::string service = "&lt;GDAL_WMS&gt;&lt;Service name=&quot;TMS&quot;&gt;&lt;ServerUrl&gt;" + address +
                                "&lt;/ServerUrl&gt;&lt;/Service&gt;&lt;/GDAL_WMS&gt;";
    for (const std::string& source : {"/vsicurl/" + address, "/vsicurl_streaming/" + address, address, service,
                                      "/vsicurl?url=" + address, "WMS:" + address})
        for (const char* name : {"mosaic.vrt", "evil.png"})
            EXPECT_THROW((void)importMap(write(name, virtualOf(source))), DataError) << name << " " << source;
    // Overviews of a huge file that lie elsewhere by its own word.
    fs::remove_all(folder_.path());
    fs::create_directories(folder_.path());
    const fs::path file = write("dem.tif", coneTiff().bytes());
    write("dem.tif.aux.xml", R"(<PAMDataset><Metadata domain="OVERVIEWS"><MDI key="OVERVIEW_FILE">/vsicurl/)" +
                                 address + "</MDI></Metadata></PAMDataset>");
    write("houses.geojson", R"({"type":"FeatureCollection","crs":{"type":"link","properties":{"href":")" + address +
                                R"("}},"features":[{"type":"Feature","properties":{"name":"A"},"geometry":)"
                                R"({"type":"Point","coordinates":[9,46.95]}}]})");
    expectCone(importMap(file.parent_path()));
    EXPECT_FALSE(listener.wasCalled());
    EXPECT_TRUE(listener.hears());
}

TEST_F(MapHeights, VirtualRastersNameFilesAndNoAddressOfTheProcess) {
    const std::vector<float> own(512 * 512, 100.0F);
    const auto at = reinterpret_cast<std::uintptr_t>(own.data());
    EXPECT_THROW((void)importMap(write("mosaic.vrt", virtualOf("MEM:::DATAPOINTER=" + std::to_string(at) +
                                                               ",PIXELS=512,LINES=512,DATATYPE=Float32"))),
                 DataError);
}

TEST_F(MapHeights, ThingsOfTwoWorldsAreNoMap) {
    const fs::path file = write("far.geojson", R"({"type":"Feature","properties":{},"geometry":{"type":"LineString",)"
                                               R"("coordinates":[[-1e308,0],[1.7e308,1000]]}})");
    EXPECT_THROW((void)importMap(file), Error);
}

TEST_F(MapHeights, CasesOfTheWorldHaveTheirHeights) {
    for (const char* name : {"scale01.tif", "feet-unit.tif", "terrarium.png"}) {
        const auto file = mapCase(name);
        if (!file) GTEST_SKIP() << "without ../shared/data/cases";
        EXPECT_NEAR(importMap(*file).map.heights.highest(), 1100.0, 1.0) << name;
    }
    const ImportedMap beside = importMap(mapCase("dem-and-photo").value());
    EXPECT_NEAR(beside.map.heights.highest(), 1100.0, 1.0);
    EXPECT_EQ(beside.report.passedOver, std::vector<std::string>{"luftbild.tif"}) << all(beside.report);
    try {
        (void)importMap(mapCase("photo-alone.tif").value());
        ADD_FAILURE() << "a photo became land";
    } catch (const DataError& error) {
        EXPECT_NE(error.why().find("no heights"), std::string::npos) << error.why();
    }
}

} // namespace
} // namespace lumorph::navigation
