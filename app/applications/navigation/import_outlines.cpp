#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <cpl_conv.h>
#include <cpl_error.h>
#include <ogrsf_frmts.h>

#include "app/applications/navigation/building_tags.h"
#include "app/applications/navigation/import_gdal.h"
#include "app/applications/navigation/import_polygons.h"
#include "app/applications/navigation/import_state.h"

namespace lumorph::navigation {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFeatures = 2'000'000;
constexpr const char* kUnordered = "OSM_USE_CUSTOM_INDEXING"; ///< a setting of GDAL, and in the error that asks for it
constexpr std::size_t kSampled = 5000;                        ///< points by which a file's coordinates are judged

std::string fieldOf(const OGRFeature& feature, const char* name) {
    const int index = feature.GetFieldIndex(name);
    return index >= 0 && feature.IsFieldSetAndNotNull(index) != 0 ? feature.GetFieldAsString(index) : "";
}

/// Also of OpenStreetMap's data in another format, where a field holds what has no field of its own:
/// `"name"=>"value"`, quotes in it as \".
std::string tagOf(const OGRFeature& feature, const char* name) {
    std::string value = fieldOf(feature, name);
    if (!value.empty() || feature.GetFieldIndex("other_tags") < 0) return value;
    const std::string tags = fieldOf(feature, "other_tags"), key = "\"" + std::string(name) + "\"=>\"";
    const std::size_t at = tags.find(key);
    if (at == std::string::npos) return {};
    for (std::size_t k = at + key.size(); k < tags.size() && tags[k] != '"'; ++k) {
        if (tags[k] == '\\' && k + 1 < tags.size()) ++k;
        value.push_back(tags[k]);
    }
    return value;
}

bool says(const std::string& tag) { return !tag.empty() && tag != "no"; }

/// As people there say it, but where the map knows it in the reader's own language.
Words nameOf(const OGRFeature& feature) {
    const std::string local = tagOf(feature, "name");
    const auto in = [&](const char* tag) {
        std::string name = tagOf(feature, tag);
        return name.empty() ? local : name;
    };
    Words name(in("name:en"), in("name:de"));
    if (name.english.empty()) name.english = name.german;
    if (name.german == name.english) name.german.clear();
    return name;
}

double widthOf(const std::string& highway) {
    for (const auto& [name, width] : {std::pair{"motorway", 14.0},
                                      {"trunk", 11.0},
                                      {"primary", 9.0},
                                      {"secondary", 8.0},
                                      {"tertiary", 7.0},
                                      {"footway", 2.0},
                                      {"path", 1.5}})
        if (highway.starts_with(name)) return width;
    return 5.0;
}

/// A building or a part of one: its area in metres of the map.
struct Area {
    Geometry geometry;
    BuildingShape shape;
    Words name;
    OGREnvelope box;
    bool gone = false; ///< what it has is elsewhere
};

/// Parts stand in place of their building where they are: of an outline that they cover by half or more nothing is
/// left, of another one what they do not cover. A part without a height of its own has its building's.
class PartsOfBuildings {
public:
    PartsOfBuildings(std::vector<Area>& buildings, std::vector<Area>& parts) : buildings_(buildings), parts_(parts) {
        std::ranges::sort(parts_, {}, [](const Area& part) { return part.box.MinX; });
        for (const Area& part : parts_) widest_ = std::max(widest_, part.box.MaxX - part.box.MinX);
    }

    void put(MapSources& sources, const Progress& progress) {
        if (parts_.empty()) return;
        for (Area& building : buildings_) {
            progress.throwIfCancelled();
            cutOut(building, sources);
        }
    }

private:
    void cutOut(Area& building, MapSources& sources) {
        constexpr double kMostLeft = 0.5, kLeast = 0.5; ///< shares of the outline, and of the part
        Geometry left;
        for (Area* part : partsNear(building)) {
            const Geometry common(building.geometry->Intersection(part->geometry.get()));
            if (!common || areaOf(*common) < kLeast * areaOf(*part->geometry)) continue;
            if (!part->shape.height) part->shape.height = building.shape.height;
            if (BuildingShape& shape = part->shape; shape.height) {
                if (shape.from >= *shape.height) shape.from = 0.0;
                shape.roof = std::min(shape.roof, *shape.height - shape.from);
            }
            const OGRGeometry& before = left ? *left : *building.geometry;
            if (Geometry rest(before.Difference(part->geometry.get())); rest) left = std::move(rest);
        }
        if (!left) return;
        if (areaOf(*left) > kMostLeft * areaOf(*building.geometry)) {
            building.geometry = std::move(left);
            return;
        }
        building.gone = true;
        OGRPoint middle;
        if (!building.name.empty() && building.geometry->Centroid(&middle) == OGRERR_NONE)
            sources.names.push_back({building.name, {middle.getX(), middle.getY()}, 500.0, 4});
    }
    [[nodiscard]] std::vector<Area*> partsNear(const Area& building) {
        std::vector<Area*> near;
        auto part =
            std::ranges::lower_bound(parts_, building.box.MinX - widest_, {}, [](const Area& a) { return a.box.MinX; });
        for (; part != parts_.end() && part->box.MinX <= building.box.MaxX; ++part)
            if (part->box.Intersects(building.box) != 0) near.push_back(&*part);
        return near;
    }

    std::vector<Area>&buildings_, &parts_;
    double widest_ = 0.0;
};

/// One file of features, read as a whole before anything is placed: where it lies is judged by many of its points, and
/// buildings by their parts.
class OutlineFile {
public:
    OutlineFile(const fs::path& file, GDALDataset& data, ImportState& state, const Progress& progress)
        : file_(file), data_(data), state_(state), progress_(progress),
          osm_(data.GetDriver() != nullptr && std::string_view(data.GetDriver()->GetDescription()) == "OSM") {}

    /// False for one of OpenStreetMap whose things are in no order, which has to be opened in another way.
    [[nodiscard]] bool gather();
    void read() {
        const std::size_t leftOut = state_.report.leftOut;
        for (System& system : systems_) {
            const std::optional<WayToMap> way = wayToMap(state_, file_, system.said, system.points);
            if (!way) continue;
            for (Feature& feature : system.features) {
                progress_.throwIfCancelled();
                place(feature, *way);
            }
        }
        PartsOfBuildings(buildings_, parts_).put(state_.sources, progress_);
        for (const std::vector<Area>* areas : {&buildings_, &parts_})
            for (const Area& area : *areas)
                if (!area.gone && addOutlines(state_.sources, *area.geometry, area.shape, area.name) == 0)
                    ++state_.report.leftOut;
        state_.any = state_.any || placed_ > state_.report.leftOut - leftOut;
    }

private:
    enum class Kind { building, part, line, point };
    struct Feature {
        OGRFeatureUniquePtr feature;
        Geometry geometry;
        Kind kind = Kind::point;
    };
    /// What has its coordinates in one reference system.
    struct System {
        const OGRSpatialReference* said = nullptr;
        std::vector<glm::dvec2> points; ///< some of its features
        std::vector<Feature> features;
    };

    void take(OGRFeatureUniquePtr feature, OGRLayer* layer);
    [[nodiscard]] System& systemOf(OGRLayer* layer);
    [[nodiscard]] std::optional<Kind> kindOf(const OGRFeature& feature, const OGRGeometry& geometry) const;
    void place(Feature& feature, const WayToMap& way);
    void placeArea(Feature& feature);
    void placeLine(const OGRFeature& feature, const OGRGeometry& geometry);
    void placeName(const OGRFeature& feature, const OGRGeometry& geometry);

    const fs::path& file_;
    GDALDataset& data_;
    ImportState& state_;
    const Progress& progress_;
    bool osm_;
    std::vector<System> systems_;
    std::size_t placed_ = 0;
    std::vector<Area> buildings_, parts_;
};

bool OutlineFile::gather() {
    std::size_t count = 0;
    OGRLayer* layer = nullptr;
    double share = 0.0;
    for (;;) {
        CPLErrorReset(); // what one feature has costs no other
        OGRFeatureUniquePtr feature(data_.GetNextFeature(&layer, &share, nullptr, nullptr));
        if (osm_ && std::string_view(CPLGetLastErrorMsg()).find(kUnordered) != std::string_view::npos) return false;
        if (!feature) break;
        if (++count % 1024 == 0) {
            progress_.throwIfCancelled();
            progress_.report(share, "Reading outlines");
        }
        if (count > kMostFeatures) {
            const std::string most = std::to_string(kMostFeatures);
            state_.note(file_, {"it has more than " + most + " things; the rest is left out.",
                                "sie enthält mehr als " + most + " Dinge; der Rest fehlt."});
            CPLErrorReset();
            break;
        }
        take(std::move(feature), layer);
    }
    if (CPLGetLastErrorType() >= CE_Failure) {
        const Words said = gdalWords();
        state_.note(file_,
                    {said.english + "; what comes after is left out.", said.german + "; was danach kommt, fehlt."});
    }
    if (count == 0) state_.passOver(file_, {"it is empty", "sie ist leer"});
    return true;
}

/// What of a feature is shown; nothing for what a map of this kind does not have.
std::optional<OutlineFile::Kind> OutlineFile::kindOf(const OGRFeature& feature, const OGRGeometry& geometry) const {
    const int dimension = geometry.getDimension();
    const bool osm = osm_ || feature.GetFieldIndex("other_tags") >= 0;
    const bool building = says(tagOf(feature, "building")), part = says(tagOf(feature, "building:part"));
    if (dimension == 2) {
        if (part && !building) return Kind::part;
        if (building) return Kind::building;
        if (osm) return std::nullopt;
        // Other people's files say of an area that it is no building rather than that it is one.
        const bool land = std::ranges::any_of(std::array{"landuse", "natural", "leisure", "boundary", "water"},
                                              [&](const char* tag) { return says(tagOf(feature, tag)); });
        if (land && !buildingShape([&](const char* tag) { return tagOf(feature, tag); }).height) return std::nullopt;
        return Kind::building;
    }
    if (dimension == 1) {
        const bool line = wkbFlatten(geometry.getGeometryType()) == wkbLineString;
        if (osm && line && (building || part)) return building ? Kind::building : Kind::part; // outline not closed
        if (osm && tagOf(feature, "highway").empty()) return std::nullopt;                    // power lines, walls, ...
        return Kind::line;
    }
    return nameOf(feature).empty() ? std::nullopt : std::optional(Kind::point);
}

void OutlineFile::take(OGRFeatureUniquePtr feature, OGRLayer* layer) {
    Geometry geometry(feature->StealGeometry());
    if (!geometry || geometry->IsEmpty() || !isFinite(*geometry)) {
        ++state_.report.leftOut;
        return;
    }
    if (osm_ && layer != nullptr && std::string_view(layer->GetName()) == "other_relations") return;
    const std::optional<Kind> kind = kindOf(*feature, *geometry);
    if (!kind) return;
    OGREnvelope box;
    geometry->getEnvelope(&box);
    System& system = systemOf(layer);
    if (system.points.size() < kSampled)
        system.points.emplace_back(0.5 * (box.MinX + box.MaxX), 0.5 * (box.MinY + box.MaxY));
    system.features.push_back({std::move(feature), std::move(geometry), *kind});
}

OutlineFile::System& OutlineFile::systemOf(OGRLayer* layer) {
    const OGRSpatialReference* said = layer != nullptr ? layer->GetSpatialRef() : nullptr;
    for (System& system : systems_)
        if (system.said == said || (system.said != nullptr && said != nullptr && system.said->IsSame(said) != 0))
            return system;
    return systems_.emplace_back(System{said, {}, {}});
}

void OutlineFile::place(Feature& feature, const WayToMap& way) {
    ++placed_;
    const bool area = feature.kind == Kind::building || feature.kind == Kind::part;
    if (area && feature.geometry->getDimension() == 1) { // an outline of OpenStreetMap that is not closed
        const auto* line = feature.geometry->toLineString();
        auto polygon = std::make_unique<OGRPolygon>();
        auto ring = std::make_unique<OGRLinearRing>();
        ring->addSubLineString(line);
        polygon->addRingDirectly(ring.release());
        feature.geometry = std::move(polygon);
    }
    const std::size_t closed = area ? closeRings(*feature.geometry) : 0;
    const auto hasRing = [](const OGRPolygon* polygon) {
        const OGRLinearRing* ring = polygon->getExteriorRing();
        return ring != nullptr && ring->getNumPoints() >= 4;
    };
    const auto polygons = polygonsOf(*feature.geometry);
    bool sound = !area || polygons.empty() || std::ranges::any_of(polygons, hasRing);
    if (way.transformation) {
        if (way.from.IsGeographic()) {
            OGREnvelope box;
            feature.geometry->getEnvelope(&box);
            sound = sound && std::max(std::abs(box.MinX), std::abs(box.MaxX)) <= 360.0 &&
                    std::max(std::abs(box.MinY), std::abs(box.MaxY)) <= 90.0;
        }
        sound = sound && feature.geometry->transform(way.transformation.get()) == OGRERR_NONE &&
                isFinite(*feature.geometry);
    }
    if (!sound) {
        ++state_.report.leftOut;
        return;
    }
    state_.report.closed += closed;
    if (area)
        placeArea(feature);
    else if (feature.kind == Kind::line)
        placeLine(*feature.feature, *feature.geometry);
    else
        placeName(*feature.feature, *feature.geometry);
    feature.geometry.reset();
}

void OutlineFile::placeArea(Feature& feature) {
    Area area;
    area.geometry = std::move(feature.geometry);
    if (!area.geometry->IsValid()) {
        area.geometry.reset(area.geometry->MakeValid());
        if (!area.geometry || polygonsOf(*area.geometry).empty()) {
            ++state_.report.leftOut;
            return;
        }
        ++state_.report.mended;
    }
    area.shape = buildingShape([&](const char* tag) { return tagOf(*feature.feature, tag); });
    area.name = nameOf(*feature.feature);
    area.geometry->getEnvelope(&area.box);
    (feature.kind == Kind::part ? parts_ : buildings_).push_back(std::move(area));
}

void OutlineFile::placeLine(const OGRFeature& feature, const OGRGeometry& geometry) {
    if (OGR_GT_IsSubClassOf(wkbFlatten(geometry.getGeometryType()), wkbGeometryCollection) != 0) {
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) placeLine(feature, *part);
        return;
    }
    if (wkbFlatten(geometry.getGeometryType()) != wkbLineString) return;
    const std::string highway = tagOf(feature, "highway");
    MapSources::Line line;
    const OGRLineString& points = *geometry.toLineString();
    if (points.getNumPoints() < 2) {
        ++state_.report.leftOut;
        return;
    }
    for (int k = 0; k < points.getNumPoints(); ++k) line.points.emplace_back(points.getX(k), points.getY(k));
    line.width = highway.empty() ? line.width : widthOf(highway);
    state_.sources.lines.push_back(std::move(line));
}

void OutlineFile::placeName(const OGRFeature& feature, const OGRGeometry& geometry) {
    if (OGR_GT_IsSubClassOf(wkbFlatten(geometry.getGeometryType()), wkbGeometryCollection) != 0) {
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) placeName(feature, *part);
        return;
    }
    if (wkbFlatten(geometry.getGeometryType()) != wkbPoint) return;
    const std::string place = tagOf(feature, "place");
    const int rank = place == "city" || place == "town"    ? 0
                     : place == "village"                  ? 1
                     : tagOf(feature, "natural") == "peak" ? 1
                                                           : 2;
    const OGRPoint& point = *geometry.toPoint();
    state_.sources.names.push_back({nameOf(feature), {point.getX(), point.getY()}, rank == 0 ? 2500.0 : 1200.0, rank});
}

} // namespace

void readOutlines(const fs::path& file, ImportState& state, const Progress& progress) {
    // What editors save is not sorted, and may have negative numbers: that takes GDAL's slower way.
    for (const bool ordered : {true, false}) {
        CPLSetThreadLocalConfigOption(kUnordered, ordered ? nullptr : "NO");
        const Dataset data = openOutlines(file);
        if (!data) {
            state.passOver(file, gdalWords());
            break;
        }
        const std::size_t leftOut = state.report.leftOut;
        OutlineFile outlines(file, *data, state, progress);
        if (outlines.gather() || !ordered) {
            outlines.read();
            break;
        }
        state.report.leftOut = leftOut;
    }
    CPLSetThreadLocalConfigOption(kUnordered, nullptr);
}

} // namespace lumorph::navigation
