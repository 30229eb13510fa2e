#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/applications/navigation/city_json.h"
#include "app/applications/navigation/import_gdal.h"
#include "app/applications/navigation/import_polygons.h"
#include "app/applications/navigation/import_state.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph::navigation {
namespace {

/// A building as it lies on the map.
struct Standing {
    Geometry ground; ///< null: it has no shape of its own
    BuildingShape shape;
    bool taken = false;
};

std::vector<std::vector<glm::dvec3>*> ringsOf(CityFace& face) {
    std::vector<std::vector<glm::dvec3>*> rings{&face.ring};
    for (auto& hole : face.holes) rings.push_back(&hole);
    return rings;
}

std::vector<glm::dvec2> fromAbove(const std::vector<glm::dvec3>& ring) { return {ring.begin(), ring.end()}; }

Geometry covered(const std::vector<const CityFace*>& faces) {
    std::vector<Geometry> flat;
    for (const CityFace* face : faces) {
        std::vector<std::vector<glm::dvec2>> holes;
        for (const auto& hole : face->holes) holes.push_back(fromAbove(hole));
        if (Geometry geometry = faceOf(fromAbove(face->ring), holes)) flat.push_back(std::move(geometry));
    }
    return unionOf(flat);
}

/// What walls alone enclose: each of their sides seen from above once.
Geometry enclosed(const std::vector<CityFace>& faces) {
    using Point = std::pair<double, double>;
    std::set<std::pair<Point, Point>> sides;
    for (const CityFace& face : faces)
        for (std::size_t k = 0; k < face.ring.size(); ++k) {
            const glm::dvec3 &a = face.ring[k], &b = face.ring[(k + 1) % face.ring.size()];
            const Point one(a.x, a.y), other(b.x, b.y);
            const auto& [from, to] = std::minmax(one, other);
            if (from != to) sides.emplace(from, to);
        }
    OGRMultiLineString lines;
    for (const auto& [from, to] : sides) {
        OGRLineString line;
        line.addPoint(from.first, from.second);
        line.addPoint(to.first, to.second);
        (void)lines.addGeometry(&line);
    }
    Geometry areas(lines.Polygonize());
    return areas && areaOf(*areas) > 0.0 ? std::move(areas) : nullptr;
}

std::pair<double, double> heightsOf(const std::vector<CityFace>& faces) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const CityFace& face : faces)
        for (const glm::dvec3& p : face.ring) {
            low = std::min(low, p.z);
            high = std::max(high, p.z);
        }
    return {low, high};
}

/// The ground that a building covers: its ground surfaces where they are named, else its faces at the bottom; where it
/// has none, its roof's outline; of walls alone what they enclose.
Geometry footprintOf(const std::vector<CityFace>& faces) {
    constexpr double kBottom = 0.3;  ///< share of the height in which ground is
    constexpr double kFewest = 0.35; ///< of all faces seen from above; a closed solid has half of them below
    std::vector<const CityFace*> named, roof, bottom, all;
    const auto [low, high] = heightsOf(faces);
    for (const CityFace& face : faces) {
        all.push_back(&face);
        if (face.means == CityFace::Means::ground) named.push_back(&face);
        if (face.means == CityFace::Means::roof) roof.push_back(&face);
        const double top = std::ranges::max(face.ring, {}, &glm::dvec3::z).z;
        if (top <= low + kBottom * std::max(high - low, 1.0)) bottom.push_back(&face);
    }
    if (Geometry ground = covered(named)) return ground;
    if (Geometry ground = covered(roof)) return ground;
    const auto seen = [](const std::vector<const CityFace*>& some) {
        double area = 0.0;
        for (const CityFace* face : some)
            if (const Geometry flat = faceOf(fromAbove(face->ring), {})) area += areaOf(*flat);
        return area;
    };
    if (seen(bottom) >= kFewest * seen(all))
        if (Geometry ground = covered(bottom)) return ground;
    if (Geometry ground = covered(all)) return ground;
    return enclosed(faces);
}

std::optional<OGRSpatialReference> systemSaid(const std::string& text) {
    if (text.empty()) return std::nullopt;
    OGRSpatialReference system = systemOf(text);
    if (system.IsEmpty()) { // by its number alone, however it is written
        const std::size_t digits = text.find_last_not_of("0123456789") + 1;
        const bool isEpsg = lowerCase(text).find("epsg") != std::string::npos;
        if (isEpsg && digits < text.size() && text.size() - digits < 7)
            system = systemOf(std::stoi(text.substr(digits)));
    }
    return system.IsEmpty() ? std::nullopt : std::optional(system);
}

/// Metres of a unit of height: of its vertical system, else as its metres across.
double heightUnitOf(const OGRSpatialReference& system) {
    if (system.IsCompound()) return system.GetTargetLinearUnits("VERT_CS", nullptr);
    return system.IsProjected() ? system.GetLinearUnits() : 1.0;
}

/// Parts and wholes, each bit of a building once: of a whole and its parts those that have the higher level of detail,
/// of the same level the parts, and the whole as far as it lies beside them.
class Once {
public:
    Once(const CityModel& city, std::vector<Standing>& standing)
        : city_(city), standing_(standing), parts_(standing.size()) {
        for (std::size_t k = 0; k < standing_.size(); ++k)
            if (const auto whole = city_.buildings[k].wholeIndex; whole && standing_[k].ground)
                parts_[*whole].push_back(k);
    }

    void choose() {
        for (std::size_t whole = 0; whole < standing_.size(); ++whole) chooseFor(whole);
    }

private:
    void chooseFor(std::size_t whole) {
        const std::vector<std::size_t>& parts = parts_[whole];
        Standing& own = standing_[whole];
        if (parts.empty() || !own.ground) return;
        double detail = -1.0;
        for (const std::size_t part : parts) detail = std::max(detail, city_.buildings[part].detail);
        if (city_.buildings[whole].detail > detail) {
            for (const std::size_t part : parts) standing_[part].taken = true;
            return;
        }
        if (city_.buildings[whole].detail < detail) {
            own.taken = true;
            return;
        }
        for (const std::size_t part : parts)
            if (Geometry rest(own.ground->Difference(standing_[part].ground.get())); rest) own.ground = std::move(rest);
        if (areaOf(*own.ground) < 1.0) own.taken = true;
    }

    const CityModel& city_;
    std::vector<Standing>& standing_;
    std::vector<std::vector<std::size_t>> parts_; ///< of each building
};

} // namespace

void readCity(const std::filesystem::path& file, ImportState& state) {
    CityModel city;
    try {
        city = readCityJson(file);
    } catch (const DataError& problem) {
        return state.passOver(file, problem.why());
    }
    if (!city.broken.empty()) {
        const std::string count = std::to_string(city.broken.size());
        const auto& [id, why] = city.broken.front();
        state.note(file, {count + " of its buildings cannot be read and are left out, first " + inQuotes(id, 60) +
                              ": " + inQuotes(why, 120) + ".",
                          count + " ihrer Gebäude sind nicht zu lesen und fehlen, zuerst " + inQuotes(id, 60) + ": " +
                              inQuotes(why, 120) + "."});
        state.report.leftOut += city.broken.size();
    }
    std::vector<glm::dvec2> points;
    for (const CityBuilding& building : city.buildings)
        if (!building.faces.empty()) points.emplace_back(building.faces.front().ring.front());
    if (points.empty()) {
        state.report.leftOut += city.buildings.size();
        return state.passOver(file, {"none of its buildings has a shape", "keines ihrer Gebäude hat eine Form"});
    }
    const std::optional<OGRSpatialReference> said = systemSaid(city.system);
    if (!city.system.empty() && !said)
        state.note(file, {"its reference system " + inQuotes(city.system, 60) + " is unknown.",
                          "ihr Bezugssystem " + inQuotes(city.system, 60) + " ist unbekannt."});
    const std::optional<WayToMap> way = wayToMap(state, file, said ? &*said : nullptr, points, Unsaid::metres);
    if (!way) return;
    const double unit = said ? heightUnitOf(*said) : 1.0;
    if (std::abs(unit - 1.0) > 1e-6)
        state.note(file, {"its heights are in the unit of its reference system, " + std::to_string(unit) + " m.",
                          "ihre Höhen sind in der Einheit ihres Bezugssystems, " + std::to_string(unit) + " m."});
    std::vector<Standing> standing(city.buildings.size());
    for (std::size_t k = 0; k < standing.size(); ++k) {
        CityBuilding& building = city.buildings[k];
        bool placed = true;
        for (CityFace& face : building.faces)
            for (auto* ring : ringsOf(face))
                for (glm::dvec3& p : *ring)
                    placed = (!way->transformation || way->transformation->Transform(1, &p.x, &p.y) != 0) && placed;
        if (!building.faces.empty() && placed) standing[k].ground = footprintOf(building.faces);
        if (!standing[k].ground) continue;
        const auto [low, high] = heightsOf(building.faces);
        const double height = unit * (high - low);
        standing[k].shape.height = height > 0.1 ? std::optional(height) : building.height;
        if (!standing[k].shape.height && building.wholeIndex)
            standing[k].shape.height = city.buildings[*building.wholeIndex].height;
    }
    Once(city, standing).choose();
    std::vector<bool> shown(standing.size(), false);
    for (std::size_t k = 0; k < standing.size(); ++k) {
        if (standing[k].taken || !standing[k].ground) continue;
        const std::size_t whole = city.buildings[k].wholeIndex.value_or(k);
        const std::string& name =
            city.buildings[k].name.empty() && !shown[whole] ? city.buildings[whole].name : city.buildings[k].name;
        if (addOutlines(state.sources, *standing[k].ground, standing[k].shape, name) == 0) continue;
        shown[k] = shown[whole] = true;
        state.any = true;
    }
    // One without a shape counts unless its parts or its whole have it.
    for (std::size_t k = 0; k < standing.size(); ++k)
        if (!shown[k] && !standing[k].taken && !shown[city.buildings[k].wholeIndex.value_or(k)]) ++state.report.leftOut;
}

} // namespace lumorph::navigation
