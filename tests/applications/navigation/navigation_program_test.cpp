#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include <unistd.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "app/applications/navigation/import_caption.h"
#include "app/applications/navigation/navigation.h"
#include "app/applications/navigation/valley.h"
#include "core/base/error.h"
#include "core/motion/causal_split.h"
#include "core/motion/surface_heights.h"
#include "tests/support/long_tests.h"
#include "tests/support/program_visit.h"

// R36: the map as visitors meet it: where one flies, what is seen, read and felt, and what a frame costs.

namespace lumorph::navigation {
namespace {

using test::kFrame;
using test::tabletRig;
using Visit = test::ProgramVisit;

constexpr double kLongFrame = 0.05; ///< seconds: where only the end of a flight is looked at

const std::shared_ptr<const Map>& valley() {
    static const auto map = std::make_shared<const Map>(bundledValley());
    return map;
}

const Place& placeNamed(const std::string& name) {
    return *std::ranges::find_if(valley()->places, [&](const Place& place) { return place.name.english == name; });
}

void land(NavigationProgram& program, Visit& visit, const std::string& name) {
    visit.frame({{"key.left", 1.0}}); // somebody is there
    visit.frame({{"key.left", 0.0}});
    program.flyTo(name);
    for (int k = 0; k < 12 * 60 && program.flies(); ++k) visit.frame();
    visit.frames(1.0);
    ASSERT_FALSE(program.flies());
}

TEST(NavigationProgram, FliesByItselfFromPlaceToPlace) {
    NavigationProgram program(1, valley());
    Visit visit(program);
    std::set<std::pair<int, int>> seen; // by hundreds of metres
    const glm::dvec2 size = valley()->heights.size();
    for (int k = 0; k < 60 * 45; ++k) {
        visit.frame();
        if (k % 60 == 0) {
            ASSERT_NO_THROW(checkScene(*visit.content().scene)) << k;
        }
        for (const glm::dvec2& way : {glm::dvec2(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
            const glm::dvec2 corner = program.view().placeAt(way * kHalf);
            if (program.view().width > widestView(size)) continue; // all of it is seen, and the board around
            ASSERT_GE(std::min(corner.x, corner.y), -0.01) << "beyond the map";
            ASSERT_LE(std::max(corner.x - size.x, corner.y - size.y), 0.01) << "beyond the map";
        }
        if (!program.flies())
            seen.insert(
                {static_cast<int>(program.view().centre.x / 100), static_cast<int>(program.view().centre.y / 100)});
    }
    EXPECT_TRUE(program.playsItself());
    EXPECT_GE(seen.size(), 4U) << "in three quarters of a minute";
}

TEST(NavigationProgram, WhoComesPansZoomsAndTurnsAtOnce) {
    const struct {
        const char* key;
        glm::dvec2 way; ///< of the view, on the device
        double zoom, turn;
    } rows[] = {
        {"key.right", {1.0, 0.0}, 0.0, 0.0}, {"key.up", {0.0, -1.0}, 0.0, 0.0}, {"pointer.x", {1.0, 0.0}, 0.0, 0.0},
        {"pad.y", {0.0, 1.0}, 0.0, 0.0},     {"key.in", {}, -1.0, 0.0},         {"key.turnRight", {}, 0.0, 1.0},
        {"key.turnLeft", {}, 0.0, -1.0},
    };
    for (const auto& row : rows) {
        NavigationProgram program(1, valley());
        Visit visit(program);
        visit.frame({{"key.in", 1.0}}); // there is room to pan
        visit.frames(1.0);
        visit.frame({{"key.in", 0.0}});
        const MapView from = program.view();
        visit.frame({{row.key, 1.0}});
        visit.frames(0.5);
        EXPECT_FALSE(program.playsItself()) << row.key;
        const MapView& to = program.view();
        const glm::dvec2 moved = from.pointAt(to.centre);
        EXPECT_NEAR(moved.x, 0.025 * row.way.x, 0.02 * std::abs(row.way.x) + 1e-6) << row.key;
        EXPECT_NEAR(moved.y, 0.025 * row.way.y, 0.02 * std::abs(row.way.y) + 1e-6) << row.key;
        EXPECT_NEAR(std::log(to.width / from.width), 0.45 * row.zoom, 0.06) << row.key;
        EXPECT_NEAR(to.turn - from.turn, 0.35 * row.turn, 0.06) << row.key;
    }
}

TEST(NavigationProgram, FliesOnlyWhileThePointerMovesOrIsHeld) {
    for (const bool held : {false, true}) {
        NavigationProgram program(1, valley());
        Visit visit(program);
        visit.frame({{"wheel", 8.0}}); // there is room to pan
        visit.frame({{"pointer.x", 0.5}, {"pointer.held", held ? 1.0 : 0.0}});
        visit.frames(1.5);
        const glm::dvec2 from = program.view().centre;
        visit.frames(1.5);
        EXPECT_EQ(glm::distance(program.view().centre, from) > 10.0, held) << "metres";
        EXPECT_FALSE(program.playsItself());
    }
}

TEST(NavigationProgram, TheWheelZoomsAndWhoStaysIdleIsBroughtBackToTheLastPlace) {
    NavigationProgram program(1, valley());
    Visit visit(program, kLongFrame);
    visit.frame({{"key.next", 1.0}});
    visit.frames(10.0);
    const MapView place = program.view();
    visit.frame({{"wheel", 2.0}});
    EXPECT_LT(program.view().width, 0.8 * place.width);
    visit.frame({{"wheel", -6.0}, {"pointer.y", -1.0}});
    visit.frames(1.0);
    EXPECT_GT(program.view().width, 1.2 * place.width);
    visit.frames(26.0);
    EXPECT_FALSE(program.playsItself());
    EXPECT_LT(glm::distance(program.view().centre, place.centre), 1.0);
    EXPECT_NEAR(program.view().width, place.width, 1.0);
}

TEST(NavigationProgram, TheLeaningDevicePans) {
    NavigationProgram program(1, valley());
    Visit visit(program);
    visit.frame({{"key.in", 1.0}});
    visit.frames(1.0);
    visit.frame({{"key.in", 0.0}});
    const MapView from = program.view();
    visit.lean(0.0F, -0.2F); // its right side down
    visit.frames(0.5);
    EXPECT_GT(from.pointAt(program.view().centre).x, 0.01);
}

TEST(NavigationProgram, NextRestartAndGoToFlyThere) {
    NavigationProgram program(1, valley());
    Visit visit(program, kLongFrame);
    land(program, visit, "castle harow"); // a slip of the fingers
    EXPECT_LT(glm::distance(program.view().centre, placeNamed("Castle Harrow").at), 1.0);
    visit.frame({{"key.restart", 1.0}});
    visit.frames(10.0);
    EXPECT_LT(glm::distance(program.view().centre, program.home().centre), 1.0);
    EXPECT_NEAR(program.view().width, program.home().width, 1.0);
    visit.frame({{"key.next", 1.0}});
    EXPECT_TRUE(program.flies());
    visit.frames(10.0);
    EXPECT_FALSE(program.flies());
    EXPECT_THROW(program.flyTo("Atlantis"), InvalidInput);
    visit.frames(Visitor::kSilence);
    EXPECT_TRUE(program.playsItself());
}

// A picture of its own, at most twice as wide as the view, and not that of all the land.
TEST(NavigationProgram, WhoArrivesSeesTheGroundSharply) {
    NavigationProgram program(1, valley());
    Visit first(program, kLongFrame);
    land(program, first, "Merinhaven");
    Visit visit(program);
    program.flyTo("Saint Alba's church"); // the shortest way
    visit.frame();
    while (program.flies()) visit.frame();
    for (const auto& primitive : visit.content().assets->models.at("navigation land")->model.meshes[0].primitives) {
        if (primitive.material != 0) continue;
        const glm::vec2 west = primitive.texcoords.front(), east = primitive.texcoords[105];
        EXPECT_GT(glm::distance(west, east), 0.45F);
    }
}

TEST(NavigationProgram, TheSameInputsGiveTheSameShow) {
    const auto play = [] {
        NavigationProgram program(7, valley());
        Visit visit(program);
        visit.frames(3.0);
        visit.frame({{"key.rain", 1.0}, {"pointer.x", 0.6}});
        visit.frames(2.0);
        return std::pair(program.view(), std::get<HeightGrid>(visit.content().target).heights);
    };
    EXPECT_EQ(play(), play());
}

/// A label's text runs along the item's x, and it faces along z.
TEST(NavigationProgram, LabelsAreReadFromAllFourSides) {
    NavigationProgram program(1, valley());
    Visit visit(program, kLongFrame);
    land(program, visit, "Merinhaven");
    int read = 0;
    for (int side = 0; side < 4; ++side) {
        const double angle = 1.5707963 * side;
        const glm::dvec3 eye(0.55 * std::sin(angle), 0.45, 0.55 * std::cos(angle));
        visit.look(glm::vec3(eye));
        visit.frames(1.0);
        for (const SceneItem& item : visit.content().scene->items) {
            if (item.name != "Label" || item.opacity < 0.9F) continue;
            ++read;
            const glm::dvec3 way = glm::normalize(eye - glm::dvec3(item.position));
            const glm::dvec3 faces = glm::dvec3(item.rotation * glm::vec3(0.0F, 0.0F, 1.0F));
            const glm::dvec3 text = glm::dvec3(item.rotation * glm::vec3(1.0F, 0.0F, 0.0F));
            const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), way)); // the viewer's
            EXPECT_GT(glm::dot(faces, way), std::cos(0.2)) << side;
            EXPECT_GT(glm::dot(text, right), std::cos(0.785)) << side << ": within 45 degrees of level";
        }
    }
    EXPECT_GE(read, 4 * 3);
}

/// Where the eye sees a point of the air on a level.
glm::dvec3 seenOn(double level, const glm::dvec3& point, const glm::dvec3& eye) {
    return eye + (eye.y - level) / (eye.y - point.y) * (point - eye);
}

const SceneItem* itemNamed(const Scene& scene, const std::string& name, std::size_t which = 0) {
    for (const SceneItem& item : scene.items)
        if (item.name == name && which-- == 0) return &item;
    return nullptr;
}

TEST(NavigationProgram, NamesDoNotReachOverTheRim) {
    NavigationProgram program(1, valley());
    Visit visit(program, kLongFrame);
    land(program, visit, "Lake Merin");
    int read = 0;
    for (const glm::dvec3& eye : {glm::dvec3(0.0, 0.45, 0.55), {0.5, 0.4, 0.3}, {-0.45, 0.5, -0.4}}) {
        visit.look(glm::vec3(eye));
        for (int stop = 0; stop < 3; ++stop) {
            visit.frame({{"key.right", 1.0}});
            visit.frames(0.4);
            visit.frame({{"key.right", 0.0}});
            visit.frames(2.5);
            const auto& items = visit.content().scene->items;
            for (std::size_t k = 0; k < items.size(); ++k) {
                if (items[k].name != "Label" || items[k].opacity < 0.99F) continue;
                ++read;
                const SceneItem& pole = items[k + 1];
                ASSERT_EQ(pole.name, "Pole");
                const double foot = static_cast<double>(pole.position.y) - 0.5 * static_cast<double>(pole.scale.y);
                const auto& model = visit.content().assets->models.at(std::get<MeshItem>(items[k].kind).model);
                for (const glm::vec3& corner : model->model.meshes[0].primitives[0].positions) {
                    const glm::vec3 at = items[k].position + items[k].rotation * (items[k].scale * corner);
                    const glm::dvec3 seen = seenOn(foot, glm::dvec3(at), eye);
                    EXPECT_LE(std::abs(seen.x), 0.105 + 1e-4);
                    EXPECT_LE(std::abs(seen.z), 0.075 + 1e-4);
                }
            }
        }
    }
    EXPECT_GE(read, 12);
}

TEST(NavigationProgram, AllOfTheLandIsSeenFromFarAndASmallMapShowsWhereOneIs) {
    NavigationProgram program(1, valley());
    Visit visit(program, kLongFrame);
    visit.look({0.0F, 0.45F, 0.55F});
    visit.frame({{"key.out", 1.0}});
    visit.frames(6.0);
    visit.frame({{"key.out", 0.0}});
    for (const glm::dvec2& corner : {glm::dvec2(0.0), {8192.0, 0.0}, {0.0, 8192.0}, {8192.0, 8192.0}}) {
        const glm::dvec2 point = glm::abs(program.view().pointAt(corner));
        EXPECT_LT(point.x, 0.105);
        EXPECT_LT(point.y, 0.075);
    }
    EXPECT_FALSE(itemNamed(*visit.content().scene, "Inset"));
    land(program, visit, "River Orra");
    const Scene& scene = *visit.content().scene;
    const SceneItem* sheet = itemNamed(scene, "Inset");
    ASSERT_TRUE(sheet);
    glm::dvec3 middle(0.0);
    double around = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const SceneItem* side = itemNamed(scene, "Inset frame", k);
        ASSERT_TRUE(side);
        middle += 0.25 * glm::dvec3(side->position);
        around += static_cast<double>(side->scale.x / sheet->scale.x) - 0.0007;
    }
    const auto& shape = visit.content().assets->models.at(std::get<MeshItem>(sheet->kind).model);
    const double side = 2.0 * static_cast<double>(shape->model.meshes[0].primitives[0].positions[2].x) * 0.92;
    const glm::dvec3 off = (middle - glm::dvec3(sheet->position)) / static_cast<double>(sheet->scale.x);
    EXPECT_NEAR(off.x / side + 0.5, placeNamed("River Orra").at.x / 8192.0, 0.01);
    EXPECT_NEAR(off.z / side + 0.5, placeNamed("River Orra").at.y / 8192.0, 0.01);
    EXPECT_NEAR(around, 2.0 * (1.0 + 15.0 / 21.0) * program.view().width / 8192.0 * side, 1e-3);
}

/// Where the loop's own formula puts a point of the device on the map, written out once more.
double trueHeight(const MapView& view, const glm::dvec2& point) {
    const double metres = view.width / 0.21, c = std::cos(view.turn), s = std::sin(view.turn);
    const glm::dvec2 cell = (view.centre + metres * glm::dvec2(c * point.x + s * point.y, c * point.y - s * point.x)) /
                            valley()->heights.spacing();
    const glm::ivec2 at(glm::floor(cell));
    const glm::dvec2 t = cell - glm::dvec2(at);
    const auto h = [&](int x, int y) {
        return static_cast<double>(
            valley()->heights.at(glm::clamp(at + glm::ivec2(x, y), glm::ivec2(0), valley()->heights.samples() - 1)));
    };
    return std::lerp(std::lerp(h(0, 0), h(1, 0), t.x), std::lerp(h(0, 1), h(1, 1), t.x), t.y);
}

std::vector<double> carried(CausalSplit& split, const std::vector<float>& heights) {
    split.restart();
    const std::vector<double> strokes = split.strokes(heights, 0.0);
    std::vector<float> top(split.restHeights().begin(), split.restHeights().end());
    TriangleMesh shape = tabletRig()->restMesh();
    shape.positions = deformed(*tabletRig(), strokes).positions;
    heightsOfMesh(shape, split.points(), top);
    return {top.begin(), top.end()};
}

double meanOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double alike(const std::vector<double>& a, const std::vector<double>& b) {
    const double meanA = meanOf(a), meanB = meanOf(b);
    double ab = 0.0, aa = 0.0, bb = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        ab += (a[k] - meanA) * (b[k] - meanB);
        aa += (a[k] - meanA) * (a[k] - meanA);
        bb += (b[k] - meanB) * (b[k] - meanB);
    }
    return ab / std::sqrt(aa * bb);
}

// What the device takes away of the true heights' energy over rest, against what its rig can take away of it at best.
TEST(NavigationProgram, TheTabletTakesTheShapeOfTheLandAtEveryZoom) {
    CausalSplit split(*tabletRig());
    for (const char* name : {"Merinhaven", "Castle Harrow", "Lake Merin", "Kestrel Horn", "Fennick"}) {
        NavigationProgram program(1, valley());
        Visit visit(program, kLongFrame);
        land(program, visit, name);
        const auto& grid = std::get<HeightGrid>(visit.content().target);
        ASSERT_NO_THROW(checkHeightGrid(grid));
        std::vector<float> truth, target;
        for (const glm::vec2& point : split.points()) {
            truth.push_back(static_cast<float>(program.ground().lift(trueHeight(program.view(), glm::dvec2(point)))));
            target.push_back(static_cast<float>(heightAt(grid, glm::dvec2(point))));
        }
        const std::vector<double> best = carried(split, truth), got = carried(split, target);
        double whole = 0.0, leftBest = 0.0, leftGot = 0.0;
        std::vector<double> wanted;
        for (std::size_t k = 0; k < truth.size(); ++k) {
            const auto rest = static_cast<double>(split.restHeights()[k]);
            wanted.push_back(static_cast<double>(std::isnan(truth[k]) ? split.restHeights()[k] : truth[k]));
            whole += (wanted[k] - rest) * (wanted[k] - rest);
            leftBest += (wanted[k] - best[k]) * (wanted[k] - best[k]);
            leftGot += (wanted[k] - got[k]) * (wanted[k] - got[k]);
        }
        const double share = (whole - leftGot) / (whole - leftBest), correlation = alike(wanted, got);
        std::cout << name << ": " << 100.0 * share
                  << " % of the slow energy that the rig can reach, correlation with light off " << correlation
                  << std::endl;
        EXPECT_GE(share, 0.9) << name;
        EXPECT_GT(correlation, 0.3) << name;
    }
}

TEST(NavigationProgram, WhoBringsAMapReadsWhatWasTakenOfIt) {
    MapReport report;
    report.buildings = 1;
    report.roads = 2;
    report.leftOut = 1;
    report.filled = 0.25;
    report.notes = {{"No file has heights: the ground is level.", "Keine Datei enthält Höhen: Der Boden ist eben."}};
    const ShowCaption caption = importCaption(report, "town.osm");
    EXPECT_EQ(caption.title, Words("Read: town.osm", "Gelesen: town.osm"));
    EXPECT_EQ(caption.sentence.english, "1 building, 2 roads, 1 thing left out, 25 % of the heights filled in. "
                                        "No file has heights: the ground is level.");
    EXPECT_EQ(caption.sentence.german, "1 Gebäude, 2 Straßen, 1 Ding weggelassen, 25 % der Höhen ergänzt. "
                                       "Keine Datei enthält Höhen: Der Boden ist eben.");
    EXPECT_EQ(importCaption({}, "a").sentence, Words("land alone.", "nur Land."));
    NavigationProgram program(1, valley());
    program.tell(caption);
    Visit visit(program, 0.5);
    visit.frame();
    ASSERT_TRUE(visit.content().caption);
    EXPECT_EQ(visit.content().caption->title, caption.title);
    visit.frames(31.0);
    EXPECT_FALSE(visit.content().caption) << "it is read, and then the show is by itself";
}

TEST(NavigationProgram, RainFromAHeldHandEndsInTheWater) {
    NavigationProgram program(3, valley());
    Visit visit(program);
    land(program, visit, "River Orra");
    visit.see({ShowBody{"Hand", PoseRole::pointer, {{0.03, 0.15, -0.02}, {1.0, 0.0, 0.0, 0.0}}}});
    visit.frames(1.0);
    EXPECT_FALSE(program.rain().drops().empty());
    EXPECT_TRUE(findItem(*visit.content().scene, kFirstCloud));
    visit.frames(5.0);
    EXPECT_GT(program.rain().reachedWater(), 50U);
    visit.see({});
    visit.frames(30.0);
    EXPECT_TRUE(program.rain().dry()) << "it runs off";
    EXPECT_FALSE(findItem(*visit.content().scene, kFirstCloud));
}

std::size_t trianglesOf(const ShowContent& content, int material) {
    std::size_t triangles = 0;
    for (const auto& primitive : content.assets->models.at("navigation land")->model.meshes[0].primitives)
        if (primitive.material == material) triangles += primitive.triangles.size();
    return triangles;
}

TEST(NavigationProgram, RainWetsTheGroundSplashesAndLetsTheRiverRise) {
    constexpr int kWaterMaterial = 2;
    NavigationProgram program(3, valley());
    Visit visit(program, kLongFrame);
    land(program, visit, "River Orra");
    const std::size_t before = trianglesOf(visit.content(), kWaterMaterial);
    const glm::dvec2 under = program.view().placeAt({0.03, -0.02}), elsewhere = program.view().placeAt({-0.09, 0.06});
    visit.see({ShowBody{"Hand", PoseRole::pointer, {{0.03, 0.15, -0.02}, {1.0, 0.0, 0.0, 0.0}}}});
    visit.frames(3.0);
    EXPECT_GT(program.rain().wetnessAt(under), 0.5F);
    EXPECT_EQ(program.rain().wetnessAt(elsewhere), 0.0F);
    EXPECT_GT(program.rain().splashes().size(), 30U);
    visit.frames(5.0);
    EXPECT_GT(program.rain().swell(), 0.5);
    EXPECT_LE(program.rain().swell(), Rain::kMostSwell);
    EXPECT_GT(trianglesOf(visit.content(), kWaterMaterial), before + before / 10);
    visit.see({});
    visit.frames(32.0);
    EXPECT_EQ(program.rain().wetnessAt(under), 0.0F);
    EXPECT_EQ(program.rain().swell(), 0.0);
}

TEST(NavigationProgram, TheFarEdgeBendsForWhoLooksWhereHeWants) {
    NavigationProgram program(1, valley());
    Visit visit(program);
    visit.frame();
    EXPECT_FALSE(visit.content().scene->viewDependence.on);
    visit.frame({{"key.bend", 1.0}});
    EXPECT_TRUE(visit.content().scene->viewDependence.on);
    visit.frame({{"key.bend", 0.0}});
    visit.frame({{"key.bend", 1.0}});
    EXPECT_FALSE(visit.content().scene->viewDependence.on);
}

TEST(NavigationProgram, ShowsTheBendBesideTheSameWithoutItWhereAskedOrTold) {
    NavigationProgram program(1, valley());
    Visit visit(program);
    visit.frame();
    EXPECT_FALSE(visit.content().comparesBend);
    visit.frame({{"key.off", 1.0}});
    EXPECT_TRUE(visit.content().comparesBend);
    EXPECT_TRUE(visit.content().scene->viewDependence.on) << "the device itself bends";
    ASSERT_TRUE(visit.content().caption);
    EXPECT_FALSE(visit.content().caption->title.german.empty());
    visit.frame({{"key.off", 1.0}});
    EXPECT_FALSE(visit.content().comparesBend);
    EXPECT_FALSE(visit.content().scene->viewDependence.on);
    EXPECT_FALSE(visit.content().caption);

    const auto told = navigationDemo().program({.seed = 1, .told = {{"bend", "beside"}}}, {});
    Visit always(*told);
    always.frame();
    EXPECT_TRUE(always.content().comparesBend);
    always.frame({{"key.bend", 1.0}});
    EXPECT_FALSE(always.content().comparesBend);
    always.frame({{"key.attract", 1.0}});
    EXPECT_TRUE(always.content().comparesBend) << "whoever has gone leaves it as the host told";
    EXPECT_THROW((void)navigationDemo().program({.seed = 1, .told = {{"bend", "sideways"}}}, {}), InvalidInput);
}

/// Pictures of the names that show, by the ids of their items.
std::map<int, const Image*> namesShown(const ShowContent& content) {
    std::map<int, const Image*> names;
    for (const SceneItem& item : content.scene->items)
        if (item.name == "Label") names[item.id] = content.assets->images.at(item.material.colorTexture.image).get();
    return names;
}

TEST(NavigationProgram, NamesAreInTheLanguageThatIsChosenWhileItPlays) {
    NavigationProgram program(1, valley());
    Visit visit(program);
    land(program, visit, "Castle Harrow");
    const ShowContent english = visit.content();
    visit.setLanguage(Language::german);
    visit.frame();
    const ShowContent german = visit.content();
    visit.setLanguage(Language::english);
    visit.frame();
    int changed = 0;
    const auto inGerman = namesShown(german), inEnglishAgain = namesShown(visit.content());
    for (const auto& [id, picture] : namesShown(english)) {
        const auto other = inGerman.find(id), again = inEnglishAgain.find(id);
        if (other == inGerman.end() || again == inEnglishAgain.end()) continue;
        const Words& name = valley()->places[static_cast<std::size_t>(id - kFirstLabel) / 2].name;
        const bool same = name.in(Language::german) == name.english;
        EXPECT_EQ(*other->second == *picture, same) << name.english;
        EXPECT_TRUE(*again->second == *picture) << name.english;
        changed += same ? 0 : 1;
    }
    EXPECT_GE(changed, 1) << "the castle at least";
}

TEST(NavigationProgram, WhatStandsStillKeepsItsIdentity) {
    NavigationProgram program(1, valley());
    Visit visit(program);
    land(program, visit, "Merinhaven");
    visit.frames(6.0);
    const auto assets = visit.content().assets;
    visit.frames(1.0);
    EXPECT_EQ(visit.content().assets, assets);
    visit.frame({{"key.right", 1.0}});
    visit.frames(0.3);
    EXPECT_NE(visit.content().assets, assets);
    EXPECT_EQ(visit.content().assets->images.at("navigation palette"), assets->images.at("navigation palette"));
    EXPECT_EQ(visit.content().assets->images.at("navigation ground"), assets->images.at("navigation ground"));
    EXPECT_LE(assets->images.at("navigation ground")->size().x, 1024);
}

TEST(NavigationProgram, AFrameTakesASmallPartOfItsTime) {
    NavigationProgram program(1, valley());
    Visit visit(program);
    std::vector<double> milliseconds;
    for (int k = 0; k < 60 * 60; ++k) {
        std::vector<ShowInput> inputs;
        if (k == 1800) inputs = {{"pointer.x", 0.4}, {"key.rain", 1.0}};
        if (k == 2400) inputs = {{"pointer.x", 0.0}, {"key.rain", 0.0}, {"key.in", 1.0}};
        if (k == 2500) inputs = {{"key.in", 0.0}, {"key.next", 1.0}};
        const double begun = test::threadSeconds();
        visit.frame(inputs);
        milliseconds.push_back(1e3 * (test::threadSeconds() - begun));
    }
    // A fifth and a half of a frame. Beside other tests processor time grows, too: half of the frames took 2.1 ms then.
    EXPECT_LE(test::shareOf(milliseconds, 0.5), 1000.0 / 60.0 / 5.0);
    EXPECT_LE(test::shareOf(milliseconds, 0.99), 8.0);
}

double residentMegabytes() {
    std::ifstream statm("/proc/self/statm");
    double size = 0.0, resident = 0.0;
    statm >> size >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

TEST(NavigationProgram, HalfAnHourLeavesMemoryFlatAndStrokesInLimits) {
    // Frame by frame it takes minutes; in short steps it is the same half hour.
    const int perSecond = test::longTests() ? 60 : 4;
    const double step = 1.0 / perSecond;
    NavigationProgram program(5, valley());
    CausalSplit split(*tabletRig());
    ShowMoment moment;
    moment.rig = tabletRig();
    moment.installation = std::make_shared<const Installation>(defaultInstallation());
    std::vector<double> before;
    double early = 0.0, late = 0.0; // the most in minutes 2 and 3, and in the last two
    std::vector<float> heights(split.points().size());
    for (int k = 0; k < perSecond * 60 * 30; ++k) {
        std::vector<ShowInput> inputs;
        if (k % (120 * perSecond) == 25 * perSecond) inputs = {{"pointer.x", 0.7}, {"key.rain", 1.0}};
        if (k % (120 * perSecond) == 65 * perSecond / 2) inputs = {{"pointer.x", 0.0}, {"key.rain", 0.0}};
        moment.inputs = inputs;
        const ShowContent content = program.frame(moment);
        moment.step = step;
        if (k % perSecond == 0) {
            const auto& grid = std::get<HeightGrid>(content.target);
            for (std::size_t p = 0; p < heights.size(); ++p)
                heights[p] = static_cast<float>(heightAt(grid, glm::dvec2(split.points()[p])));
            const std::vector<double> strokes = split.strokes(heights, 1.0);
            for (std::size_t a = 0; a < strokes.size(); ++a) {
                ASSERT_GE(strokes[a], 0.0);
                ASSERT_LE(strokes[a], 1.0);
                if (!before.empty()) {
                    ASSERT_LE(std::abs(strokes[a] - before[a]), tabletRig()->actuators()[a].maxVelocity + 1e-9);
                }
            }
            before = strokes;
        }
        if (k >= 60 * perSecond && k < 180 * perSecond) early = std::max(early, residentMegabytes());
        if (k >= perSecond * 60 * 28) late = std::max(late, residentMegabytes());
    }
    const double grown = late - early;
    std::cout << "grown by " << grown << " MB in " << perSecond << " frames a second" << std::endl;
    EXPECT_LT(grown, 5.0);
}

} // namespace
} // namespace lumorph::navigation
