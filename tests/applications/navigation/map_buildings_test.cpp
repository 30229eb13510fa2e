#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/applications/navigation/building_tags.h"
#include "app/applications/navigation/map_import.h"
#include "app/applications/navigation/shapes.h"
#include "core/base/error.h"
#include "tests/applications/navigation/map_files.h"

// Buildings of other people's files: their ground, courtyards, parts and heights.

namespace lumorph::navigation {
namespace {

namespace fs = std::filesystem;

using MapBuildings = MapFiles;

TEST(BuildingTags, LengthsAreReadInTheUnitTheyAreWrittenIn) {
    const struct {
        const char* text;
        std::optional<double> metres;
    } rows[] = {{"21.9", 21.9},
                {"21.9 m", 21.9},
                {"21,9m", 21.9},
                {" 12 metres ", 12.0},
                {"72 ft", 21.9456},
                {"72ft", 21.9456},
                {"72'", 21.9456},
                {"72'2\"", 21.9964},
                {"72' 2\"", 21.9964},
                {"72'2", 21.9964},
                {"72\u20322\u2033", 21.9964},
                {"72 ft 2 in", 21.9964},
                {"0.02 km", 20.0},
                {"~20", 20.0},
                {"2 floors", std::nullopt},
                {"high", std::nullopt},
                {"", std::nullopt},
                {"20-25", std::nullopt},
                {"72'high", std::nullopt}};
    for (const auto& row : rows) {
        const std::optional<double> metres = metresIn(row.text);
        ASSERT_EQ(metres.has_value(), row.metres.has_value()) << row.text;
        if (metres) {
            EXPECT_NEAR(*metres, *row.metres, 1e-9) << row.text;
        }
    }
}

TEST(BuildingTags, StoreysAndRoofsAddUp) {
    using Tags = std::vector<std::pair<std::string, std::string>>;
    const struct {
        Tags tags;
        std::optional<double> height;
        double from, roof;
        Building::Roof form;
    } rows[] = {
        {{{"building:levels", "3"}}, 10.0, 0.0, 0.0, Building::Roof::flat},
        {{{"building:levels", "3"}, {"roof:levels", "2"}}, 16.0, 0.0, 7.0, Building::Roof::gable},
        {{{"building:levels", "3"}, {"roof:height", "4"}, {"roof:shape", "hipped"}},
         13.0,
         0.0,
         4.0,
         Building::Roof::hip},
        {{{"building:levels", "2;4"}}, 13.0, 0.0, 0.0, Building::Roof::flat},
        {{{"height", "20"}, {"building:levels", "3"}, {"roof:levels", "1"}}, 20.0, 0.0, 4.0, Building::Roof::gable},
        {{{"height", "30"}, {"min_height", "12"}}, 30.0, 12.0, 0.0, Building::Roof::flat},
        {{{"building:levels", "6"}, {"building:min_level", "2"}}, 19.0, 6.0, 0.0, Building::Roof::flat},
        {{{"height", "tall"}, {"building:levels", "2"}}, 7.0, 0.0, 0.0, Building::Roof::flat},
        {{{"roof:shape", "skillion"}, {"roof:height", "2"}, {"height", "5"}}, 5.0, 0.0, 0.0, Building::Roof::flat},
        {{{"height", "-3"}}, std::nullopt, 0.0, 0.0, Building::Roof::flat}};
    for (const auto& row : rows) {
        const BuildingShape shape = buildingShape([&](const char* name) {
            const auto found = std::ranges::find(row.tags, name, &Tags::value_type::first);
            return found == row.tags.end() ? std::string() : found->second;
        });
        SCOPED_TRACE(row.tags.front().first + "=" + row.tags.front().second);
        EXPECT_EQ(shape.height, row.height);
        EXPECT_EQ(shape.from, row.from);
        EXPECT_EQ(shape.roof, row.roof);
        EXPECT_EQ(shape.form, row.form);
    }
}

double areaOfAll(const std::vector<std::vector<glm::dvec2>>& parts) {
    double sum = 0.0;
    for (const auto& part : parts) sum += 0.5 * doubleArea(part);
    return sum;
}

bool holds(const std::vector<std::vector<glm::dvec2>>& parts, const glm::dvec2& p) {
    return std::ranges::any_of(parts, [&](const auto& part) {
        for (std::size_t k = 0; k < part.size(); ++k) {
            const glm::dvec2 a = part[k], b = part[(k + 1) % part.size()];
            if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < 0.0) return false;
        }
        return true;
    });
}

TEST(ConvexParts, HolesStayOpenHoweverManyThereAre) {
    const std::vector<glm::dvec2> outline = rectangle({50.0, 50.0}, {1.0, 0.0}, 100.0, 100.0);
    std::vector<std::vector<glm::dvec2>> holes;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) holes.push_back(roundOutline({14.0 + 24.0 * x, 14.0 + 24.0 * y}, 9.0, 6 + x + y));
    const auto parts = convexParts(outline, holes);
    double open = 0.0;
    for (const auto& hole : holes) open += 0.5 * std::abs(doubleArea(hole));
    EXPECT_NEAR(areaOfAll(parts), 10000.0 - open, 1.0);
    for (int y = 1; y < 100; y += 3)
        for (int x = 1; x < 100; x += 3) {
            const glm::dvec2 p(x + 0.13, y + 0.29);
            const bool inside = std::ranges::any_of(holes, [&](const auto& hole) { return holds({hole}, p); });
            EXPECT_EQ(holds(parts, p), !inside) << p.x << " " << p.y;
        }
    for (const auto& part : parts) EXPECT_TRUE(isConvex(part));
}

/// A node, way or relation of OpenStreetMap on the equator, where 0.0001 degrees are 11.132 m by 11.057 m.
class Osm {
public:
    /// A rectangle by its corner and size, in 0.0001 degrees; its nodes are numbered from 10 * id on.
    Osm& box(int id, double x, double y, double width, double height, const std::string& tags, bool closed = true) {
        const double corners[4][2] = {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
        std::string refs;
        for (int k = 0; k < 4; ++k) {
            nodes_ += "<node id=\"" + std::to_string(10 * id + k) + "\" lat=\"" + std::to_string(1e-4 * corners[k][1]) +
                      "\" lon=\"" + std::to_string(9.0 + 1e-4 * corners[k][0]) + "\"/>";
            refs += "<nd ref=\"" + std::to_string(10 * id + k) + "\"/>";
        }
        if (closed) refs += "<nd ref=\"" + std::to_string(10 * id) + "\"/>";
        return way(id, refs, tags);
    }
    Osm& way(int id, const std::string& refs, const std::string& tags) {
        ways_ += "<way id=\"" + std::to_string(id) + "\">" + refs + tagsOf(tags) + "</way>";
        return *this;
    }
    Osm& node(int id, double x, double y, const std::string& tags) {
        nodes_ += "<node id=\"" + std::to_string(id) + "\" lat=\"" + std::to_string(y) + "\" lon=\"" +
                  std::to_string(x) + "\">" + tagsOf(tags) + "</node>";
        return *this;
    }
    Osm& relation(int id, const std::string& members, const std::string& tags) {
        relations_ += "<relation id=\"" + std::to_string(id) + "\">" + members + tagsOf(tags) + "</relation>";
        return *this;
    }
    [[nodiscard]] std::string text() const {
        return R"(<?xml version="1.0"?><osm version="0.6">)" + nodes_ + ways_ + relations_ + "</osm>";
    }

private:
    /// "a=b;c=d"
    static std::string tagsOf(const std::string& text) {
        std::string tags;
        for (std::size_t from = 0; from < text.size();) {
            const std::size_t end = std::min(text.find(';', from), text.size()), is = text.find('=', from);
            std::string value = text.substr(is + 1, end - is - 1);
            for (std::size_t at = value.find('"'); at != std::string::npos; at = value.find('"', at + 6))
                value.replace(at, 1, "&quot;");
            tags += "<tag k=\"" + text.substr(from, is - from) + "\" v=\"" + value + "\"/>";
            from = end + 1;
        }
        return tags;
    }
    std::string nodes_, ways_, relations_;
};

/// Square metres of 0.0001 by 0.0001 degrees at the equator (WGS 84), as UTM shrinks its middle.
constexpr double kCell = 11.131949 * 11.057428 * 0.9996 * 0.9996;

TEST_F(MapBuildings, ACourtyardOfOpenStreetMapStaysOpen) {
    const ImportedMap imported = importMap(
        write("castle.osm",
              Osm()
                  .box(1, 0, 0, 8, 6, "")
                  .box(2, 2, 2, 3, 2, "")
                  .relation(7, R"(<member type="way" ref="1" role="outer"/><member type="way" ref="2" role="inner"/>)",
                            "type=multipolygon;building=castle;height=72'2\"")
                  .text()));
    EXPECT_EQ(imported.report.buildings, 1U) << all(imported.report);
    EXPECT_NEAR(measured(imported).area, (48.0 - 6.0) * kCell, 3.0);
    EXPECT_NEAR(measured(imported).height, 21.9964, 1e-3);
    ASSERT_FALSE(imported.map.buildings.empty());
    for (const Building& piece : imported.map.buildings) {
        ASSERT_TRUE(piece.whole) << "all pieces grow about one middle";
        EXPECT_EQ(*piece.whole, *imported.map.buildings[0].whole);
    }
}

TEST_F(MapBuildings, PartsCountInsteadOfTheirOutline) {
    // A nave and a tower cover their church; a house has a small part of its own; a part stands without an outline.
    const ImportedMap imported =
        importMap(write("church.osm", Osm()
                                          .box(1, 0, 0, 8, 4, "building=church;height=50;name=Dom")
                                          .box(2, 0, 0, 6, 4, "building:part=yes;building:levels=4")
                                          .box(3, 6, 0, 2, 4, "building:part=tower;height=50")
                                          .box(4, 20, 0, 6, 4, "building=yes;building:levels=2")
                                          .box(5, 20, 0, 2, 2, "building:part=yes;height=30;min_height=10")
                                          .box(6, 40, 0, 2, 2, "building:part=yes;height=5")
                                          .text()));
    EXPECT_EQ(imported.report.buildings, 5U) << all(imported.report);
    EXPECT_NEAR(measured(imported).area, (24.0 + 8.0 + 20.0 + 4.0 + 4.0) * kCell, 5.0);
    EXPECT_NEAR(measured(imported).height, 50.0, 1e-6);
    EXPECT_EQ(imported.report.heightMissing, 0U);
    EXPECT_TRUE(std::ranges::any_of(imported.map.places, [](const Place& p) { return p.name.english == "Dom"; }))
        << "its name stays";
    std::vector<double> tops;
    for (const Building& building : imported.map.buildings) tops.push_back(building.ridge - building.base);
    for (const double top : {13.0, 50.0, 7.0, 30.0, 5.0})
        EXPECT_TRUE(std::ranges::any_of(tops, [&](double t) { return std::abs(t - top) < 1e-6; })) << top;
    EXPECT_TRUE(std::ranges::any_of(imported.map.buildings, [](const Building& b) { return b.over == 10.0; }));
}

TEST_F(MapBuildings, OneBrokenThingOfOpenStreetMapCostsItselfAlone) {
    const ImportedMap imported = importMap(write(
        "town.osm", Osm()
                        .box(1, 0, 0, 4, 4, "building=yes;height=9")
                        .way(2, R"(<nd ref="900"/><nd ref="901"/><nd ref="900"/>)", "building=yes")
                        .way(3, R"(<nd ref="10"/>)", "building=yes")
                        .box(4, 10, 0, 4, 4, "building=yes;height=12", false)
                        .node(990, 0.0, 0.0, "name=Null Island;place=town")
                        .relation(7, R"(<member type="way" ref="555" role="outer"/>)", "type=multipolygon;building=yes")
                        .box(5, 20, 0, 4, 4, "building=yes;height=15")
                        .box(6, 30, 0, 4, 4, "building=yes;height=18")
                        .text()));
    EXPECT_EQ(imported.report.buildings, 4U) << all(imported.report);
    EXPECT_EQ(imported.report.closed, 1U);
    EXPECT_TRUE(tells(imported.report, "1 ring was not closed")) << all(imported.report);
    EXPECT_NEAR(measured(imported).height, 18.0, 1e-6);
    EXPECT_NEAR(measured(imported).area, 64.0 * kCell, 5.0);
    EXPECT_LT(std::max(imported.map.heights.size().x, imported.map.heights.size().y), 1000.0)
        << "a name at 0 degrees makes no map of a continent";
}

std::string feature(const std::string& geometry, const std::string& properties = R"({"height":9})") {
    return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":)" + geometry + "}";
}
std::string polygon(const std::string& rings) { return R"({"type":"Polygon","coordinates":)" + rings + "}"; }
std::string collection(const std::vector<std::string>& features, const std::string& crs = {}) {
    std::string text = R"({"type":"FeatureCollection",)" + crs + R"("features":[)";
    for (std::size_t k = 0; k < features.size(); ++k) text += (k > 0 ? "," : "") + features[k];
    return text + "]}";
}

TEST_F(MapBuildings, OneBrokenFeatureOfGeoJsonCostsItselfAlone) {
    const std::string good = polygon("[[[9,0],[9.0004,0],[9.0004,0.0004],[9,0.0004],[9,0]]]");
    const std::string second = polygon("[[[9.001,0],[9.0014,0],[9.0014,0.0004],[9.001,0.0004],[9.001,0]]]");
    const struct {
        const char* name;
        std::string broken;
        std::size_t buildings;
    } rows[] = {{"text for numbers", feature(polygon(R"([[["a","b"],[9,0],[9,1],["a","b"]]])")), 2},
                {"null for a number", feature(polygon("[[[null,0],[9.1,0],[9.1,0.1],[9,0]]]")), 2},
                {"no number", feature(polygon("[[[NaN,0],[9.1,0],[9.1,0.1],[NaN,0]]]")), 2},
                {"far beyond the Earth", feature(polygon("[[[1e300,0],[9.1,0],[9.1,0.1],[1e300,0]]]")), 2},
                {"two corners", feature(polygon("[[[9.1,0],[9.1,0.1]]]")), 2},
                {"an unknown type", feature(R"({"type":"Polygone","coordinates":[[[9,0],[9,1],[8,1],[9,0]]]})"), 2},
                {"no coordinates", feature(R"({"type":"Polygon"})"), 2},
                {"no feature", "17", 2},
                {"not closed", feature(polygon("[[[9.002,0],[9.0024,0],[9.0024,0.0004],[9.002,0.0004]]]")), 3},
                {"a courtyard",
                 feature(polygon("[[[9.002,0],[9.0024,0],[9.0024,0.0004],[9.002,0.0004],[9.002,0]],"
                                 "[[9.0021,0.0001],[9.0023,0.0001],[9.0023,0.0003],[9.0021,0.0001]]]")),
                 3}};
    for (const auto& row : rows)
        for (const bool first : {true, false}) {
            SCOPED_TRACE(row.name);
            std::vector<std::string> features{feature(good), feature(second)};
            features.insert(first ? features.begin() : features.end(), row.broken);
            const ImportedMap imported = importMap(write("houses.geojson", collection(features)));
            EXPECT_EQ(imported.report.buildings, row.buildings) << all(imported.report);
            EXPECT_EQ(imported.report.closed, std::string(row.name) == "not closed" ? 1U : 0U);
            EXPECT_FALSE(tells(imported.report, "what comes after")) << all(imported.report);
        }
}

TEST_F(MapBuildings, MetresWithoutASystemLieOnTheGroundBesideThem) {
    const std::string house =
        feature(polygon("[[[500100,5199900],[500140,5199900],[500140,5199880],[500100,5199880],[500100,5199900]]]"));
    for (const int epsg : {32632, 25832, 0}) {
        Tiff tiff;
        tiff.epsg = epsg;
        tiff.value = [](int x, int y, int) { return 600.0 + x + y; };
        write("ground.tif", tiff.bytes());
        const fs::path houses = write("houses.geojson", collection({house}));
        const ImportedMap imported = importMap(houses.parent_path());
        EXPECT_TRUE(tells(imported.report, "no reference system")) << all(imported.report);
        ASSERT_EQ(imported.map.buildings.size(), 1U) << epsg << " " << all(imported.report);
        // 100 m to the east and to the south of the raster's corner; its first sample is 5 m from there.
        glm::dvec2 corner(1e9);
        for (const glm::dvec2& p : imported.map.buildings[0].outline) corner = glm::min(corner, p);
        EXPECT_NEAR(corner.x, 95.0, 0.01) << epsg;
        EXPECT_NEAR(corner.y, 95.0, 0.01) << epsg;
    }
    // Elsewhere they do not lie on it.
    write("houses.geojson",
          collection({feature(polygon("[[[700100,5199900],[700140,5199900],[700140,5199880],[700100,5199900]]]"))}));
    const ImportedMap elsewhere = importMap(folder_.path());
    EXPECT_EQ(elsewhere.report.passedOver, std::vector<std::string>{"houses.geojson"}) << all(elsewhere.report);
    // Alone they are plain metres, and have an area.
    const ImportedMap alone = importMap(write("alone.geojson", collection({house})));
    EXPECT_NEAR(measured(alone).area, 800.0, 0.1) << all(alone.report);
}

/// A box of CityJSON: eight vertices from `first` on.
std::string boxVertices(double x, double y, double width, double depth, double height) {
    std::string text;
    const auto vertex = [&](double a, double b, double c) {
        text +=
            (text.empty() ? "[" : ",[") + std::to_string(a) + "," + std::to_string(b) + "," + std::to_string(c) + "]";
    };
    for (const double z : {0.0, height}) {
        vertex(x, y, z);
        vertex(x + width, y, z);
        vertex(x + width, y + depth, z);
        vertex(x, y + depth, z);
    }
    return text;
}
std::string indexed(const std::string& faces, int first) {
    std::string text;
    for (const char c : faces) text += c >= '0' && c <= '7' ? std::to_string(first + (c - '0')) : std::string(1, c);
    return text;
}
std::string solid(const std::string& lod, int first) {
    return R"({"type":"Solid","lod":")" + lod + R"(","boundaries":[)" +
           indexed("[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]", first) + "]}";
}
std::string surfaces(const std::string& lod, const std::string& faces, int first, const std::string& semantics = {}) {
    return R"({"type":"MultiSurface","lod":")" + lod + R"(","boundaries":)" + indexed(faces, first) + semantics + "}";
}
std::string city(const std::string& objects, const std::string& vertices, const std::string& system = "32632") {
    return R"({"version":"2.0","CityObjects":{)" + objects +
           R"(},"transform":{"scale":[1,1,1],"translate":[500000,5200000,600]},"vertices":[)" + vertices + "]" +
           (system.empty()
                ? ""
                : R"(,"metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/)" + system + "\"}") +
           R"(,"type":"CityJSON"})";
}
std::string building(const std::string& id, const std::string& geometries, const std::string& more = {}) {
    return "\"" + id + R"(":{"type":"Building","geometry":[)" + geometries + "]" + more + "}";
}

TEST_F(MapBuildings, TheGroundOfACityModelIsWhatItCovers) {
    const std::string box = boxVertices(0, 0, 40, 30, 15);
    const std::string ground = "[[3,2,1]],[[3,1,0]]", walls = "[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]",
                      roof = "[[4,5,6]],[[4,6,7]]";
    const struct {
        const char* name;
        std::string geometry;
    } rows[] = {
        {"ground in triangles", surfaces("2", "[" + ground + "," + walls + "," + roof + "]", 0)},
        {"no ground", surfaces("2", "[" + walls + "," + roof + "]", 0)},
        {"walls alone", surfaces("2", "[" + walls + "]", 0)},
        {"named ground",
         surfaces(
             "2", "[" + roof + "," + walls + "," + ground + "]", 0,
             R"(,"semantics":{"surfaces":[{"type":"RoofSurface"},{"type":"WallSurface"},{"type":"GroundSurface"}],"values":[0,0,1,1,1,1,2,2]})")}};
    for (const auto& row : rows) {
        SCOPED_TRACE(row.name);
        const ImportedMap imported = importMap(write("model.city.json", city(building("a", row.geometry), box)));
        EXPECT_EQ(imported.report.buildings, 1U) << all(imported.report);
        EXPECT_NEAR(measured(imported).area, 1200.0, 1.0);
        EXPECT_NEAR(measured(imported).height, 15.0, 1e-6);
    }
}

TEST_F(MapBuildings, ACityModelCountsItsHighestDetailAndEachPartOnce) {
    const std::string vertices =
        boxVertices(0, 0, 40, 30, 15) + "," + boxVertices(0, 0, 20, 30, 12) + "," + boxVertices(20, 0, 20, 30, 25);
    const auto part = [](const std::string& id, const std::string& lod, int first) {
        return "\"" + id + R"(":{"type":"BuildingPart","parents":["a"],"geometry":[)" + solid(lod, first) + "]}";
    };
    const struct {
        const char* name;
        std::string objects;
        std::size_t buildings;
        double height;
    } rows[] = {
        {"lod 0 last", building("a", solid("1.2", 16) + "," + surfaces("0", "[[[0,1,2,3]]]", 0)), 1, 25.0},
        {"parts of higher detail",
         building("a", surfaces("0", "[[[0,1,2,3]]]", 0), R"(,"children":["p","q"])") + "," + part("p", "2.2", 8) +
             "," + part("q", "2.2", 16),
         2, 25.0},
        {"parts of the same detail",
         building("a", solid("2", 0), R"(,"children":["p","q"])") + "," + part("p", "2", 8) + "," + part("q", "2", 16),
         2, 25.0},
        {"parts of lower detail",
         building("a", solid("2", 0), R"(,"children":["p","q"])") + "," + part("p", "1", 8) + "," + part("q", "1", 16),
         1, 15.0},
        {"parts alone",
         building("a", "", R"(,"children":["p","q"])") + "," + part("p", "2", 8) + "," + part("q", "2", 16), 2, 25.0}};
    for (const auto& row : rows) {
        SCOPED_TRACE(row.name);
        const ImportedMap imported = importMap(write("model.city.json", city(row.objects, vertices)));
        EXPECT_EQ(imported.report.buildings, row.buildings) << all(imported.report);
        EXPECT_NEAR(measured(imported).height, row.height, 1e-6);
        EXPECT_NEAR(measured(imported).area, row.name == std::string("lod 0 last") ? 600.0 : 1200.0, 1.0);
        EXPECT_EQ(imported.report.leftOut, 0U) << all(imported.report);
    }
}

TEST_F(MapBuildings, ACityModelWithoutASystemIsInMetres) {
    const std::string text = city(building("a", solid("1", 0)), boxVertices(0, 0, 40, 30, 15), "");
    const ImportedMap alone = importMap(write("model.json", text)); // its type stands last
    EXPECT_NEAR(measured(alone).area, 1200.0, 1.0) << all(alone.report);
    EXPECT_NEAR(measured(alone).height, 15.0, 1e-6);
    EXPECT_EQ(alone.projection, "");
    Tiff tiff;
    tiff.west = 499900.0;
    tiff.north = 5200200.0;
    tiff.value = [](int, int, int) { return 600.0; };
    write("ground.tif", tiff.bytes());
    const ImportedMap beside = importMap(folder_.path());
    EXPECT_NEAR(measured(beside).area, 1200.0, 1.0) << all(beside.report);
}

TEST_F(MapBuildings, FeetOfACityModelBecomeMetres) {
    // EPSG 2263: New York, US survey feet, as its open model has it.
    std::string text = city(building("a", solid("1", 0)), boxVertices(0, 0, 100, 100, 100), "2263");
    text.replace(text.find("[500000,5200000,600]"), 20, "[980000,200000,10]");
    const ImportedMap imported = importMap(write("model.json", text));
    EXPECT_NEAR(measured(imported).height, 30.48, 0.01) << all(imported.report);
    EXPECT_NEAR(measured(imported).area, 30.48 * 30.48, 2.0);
}

TEST_F(MapBuildings, OneBrokenBuildingOfACityModelCostsItselfAlone) {
    const std::string vertices = boxVertices(0, 0, 40, 30, 15) + R"(,["x",0,0])";
    const ImportedMap imported =
        importMap(write("model.json", city(building("bad", surfaces("1", "[[[0,1,99]]]", 0)) + "," +
                                               building("worse", R"({"type":"Solid","boundaries":17})") + "," +
                                               building("text", R"({"type":"MultiSurface","boundaries":[[[0,1,8]]]})") +
                                               R"(,"x":17,)" + building("good", solid("1", 0)),
                                           vertices)));
    EXPECT_EQ(imported.report.buildings, 1U) << all(imported.report);
    EXPECT_TRUE(tells(imported.report, "'bad'")) << all(imported.report);
    EXPECT_GE(imported.report.leftOut, 3U);
    EXPECT_TRUE(isInGermanToo(imported.report)) << all(imported.report);
    // A file that is broken as a whole costs nothing beside it.
    write("broken.city.json", R"({"type":"CityJSON","CityObjects":{},"vertices":17})");
    const ImportedMap both = importMap(folder_.path());
    EXPECT_EQ(both.report.buildings, 1U) << all(both.report);
    EXPECT_EQ(both.report.passedOver, std::vector<std::string>{"broken.city.json"});
}

TEST_F(MapBuildings, ATypeFarFromTheBeginningIsFound) {
    std::string text = city(building("a", solid("1", 0)), boxVertices(0, 0, 40, 30, 15));
    text.insert(1, R"("extra":{"type":"FeatureCollection","words":")" + std::string(200'000, 'x') + "\"},");
    EXPECT_EQ(importMap(write("model.json", text)).report.buildings, 1U);
    // Features that speak of CityJSON are none.
    const ImportedMap features =
        importMap(write("houses.json", collection({feature(polygon("[[[9,0],[9.0004,0],[9.0004,0.0004],[9,0]]]"),
                                                           R"({"type":"CityJSON","height":8})")})));
    EXPECT_EQ(features.report.buildings, 1U) << all(features.report);
}

TEST_F(MapBuildings, CasesOfTheWorldHaveTheirBuildings) {
    const struct {
        const char* name;
        std::size_t buildings;
        double height, area;
    } rows[] = {{"triangles.city.json", 2, 25.0, 2400.0}, {"no-crs.city.json", 2, 25.0, 2400.0},
                {"lod0-last.city.json", 2, 25.0, 2400.0}, {"h03.osm", 1, 21.9456, 900.0},
                {"courtyard.osm", 1, 20.0, 30000.0},      {"first-unclosed.geojson", 4, 25.0, 6400.0},
                {"metres-beside-dem", 4, 25.0, 6400.0}};
    for (const auto& row : rows) {
        const auto file = mapCase(row.name);
        if (!file) GTEST_SKIP() << "without ../shared/data/cases";
        const ImportedMap imported = importMap(*file);
        EXPECT_EQ(imported.report.buildings, row.buildings) << row.name << all(imported.report);
        EXPECT_NEAR(measured(imported).height, row.height, 1e-3) << row.name;
        EXPECT_NEAR(measured(imported).area, row.area, 0.01 * row.area) << row.name;
    }
    EXPECT_EQ(importMap(mapCase("first-unclosed.geojson").value()).report.closed, 1U);
}

} // namespace
} // namespace lumorph::navigation
