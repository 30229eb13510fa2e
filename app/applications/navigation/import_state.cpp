#include "app/applications/navigation/import_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumorph::navigation {
namespace {

constexpr double kFar = 50'000.0; ///< metres that outlines may lie from those of another file

int utmAt(const glm::dvec2& lonLat) {
    const int zone = std::clamp(static_cast<int>(std::floor((lonLat.x + 180.0) / 6.0)) + 1, 1, 60);
    return (lonLat.y < 0.0 ? 32700 : 32600) + zone;
}

/// Median of both coordinates: a few broken points do not move it.
glm::dvec2 medianPoint(const std::vector<glm::dvec2>& points) {
    std::vector<double> x, y;
    for (const glm::dvec2& p : points)
        if (std::isfinite(p.x) && std::isfinite(p.y)) {
            x.push_back(p.x);
            y.push_back(p.y);
        }
    if (x.empty()) return glm::dvec2(0.0);
    const auto half = static_cast<std::ptrdiff_t>(x.size() / 2);
    std::ranges::nth_element(x, x.begin() + half);
    std::ranges::nth_element(y, y.begin() + half);
    return {x[x.size() / 2], y[y.size() / 2]};
}

bool canBeDegrees(const glm::dvec2& p) { return std::abs(p.x) <= 360.0 && std::abs(p.y) <= 90.0; }

/// Whether a point in metres of the map lies on its heights, or near what other files have where there are none.
bool fits(const MapSources& sources, const glm::dvec2& p) {
    if (!sources.heights.empty()) {
        const glm::dvec2 size = sources.spacing * glm::dvec2(sources.samples - 1);
        const glm::dvec2 at(p.x - sources.origin.x, sources.origin.y - p.y);
        const double rim = sources.spacing; // the outermost samples have land around them
        return at.x >= -rim && at.y >= -rim && at.x <= size.x + rim && at.y <= size.y + rim;
    }
    const auto near = [&](const glm::dvec2& q) { return std::max(std::abs(p.x - q.x), std::abs(p.y - q.y)) < kFar; };
    if (!sources.outlines.empty()) return near(sources.outlines.front().ring.front());
    if (!sources.lines.empty()) return near(sources.lines.front().points.front());
    return sources.names.empty() || near(sources.names.front().at);
}

/// Metres of a file that names no system.
std::optional<WayToMap> wayOfMetres(ImportState& state, const std::filesystem::path& file, const glm::dvec2& middle) {
    if (!state.any) {
        state.metresOnly = true;
        state.note(file, {"it names no reference system that its coordinates could be of: they are taken as metres.",
                          "sie nennt kein Bezugssystem, zu dem ihre Koordinaten passen: Sie gelten als Meter."});
        return WayToMap{};
    }
    const auto noteBeside = [&] {
        state.note(file, {"it names no reference system that its coordinates could be of: they are metres of the "
                          "files beside it, on which they lie.",
                          "sie nennt kein Bezugssystem, zu dem ihre Koordinaten passen: Es sind Meter der Dateien "
                          "daneben, auf denen sie liegen."});
    };
    if (!state.metresOnly) {
        const OGRSpatialReference map = systemOf(state.projection);
        std::vector<std::string> systems = state.systems;
        systems.push_back(state.projection);
        for (const std::string& projection : systems) {
            const OGRSpatialReference system = systemOf(projection);
            WayToMap way{system, transformation(system, map)};
            glm::dvec2 at = middle;
            if (!way.transformation || !way.transformation->Transform(1, &at.x, &at.y) || !fits(state.sources, at))
                continue;
            noteBeside();
            return way;
        }
    } else if (fits(state.sources, middle)) {
        noteBeside();
        return WayToMap{};
    }
    state.passOver(
        file, {"its coordinates are metres of a system that it does not name, and do not lie on the land beside it",
               "ihre Koordinaten sind Meter eines Systems, das sie nicht nennt, und liegen nicht auf dem Land "
               "daneben"});
    return std::nullopt;
}

} // namespace

void ImportState::note(const std::filesystem::path& file, const Words& text) {
    const std::string name = file.filename().string() + ": ";
    report.notes.emplace_back(name + text.english, name + text.german);
}

void ImportState::passOver(const std::filesystem::path& file, const Words& why) {
    note(file, {why.english + "; it is passed over.", why.german + "; sie ist übergangen."});
    report.passedOver.push_back(file.filename().string());
    if (problem.empty()) problem = why;
}

void ImportState::chooseSystem(const glm::dvec2& lonLat) {
    if (projection.empty() && !metresOnly) projection = "EPSG:" + std::to_string(utmAt(lonLat));
}

std::optional<WayToMap> wayToMap(ImportState& state, const std::filesystem::path& file, const OGRSpatialReference* said,
                                 const std::vector<glm::dvec2>& points, Unsaid unsaid) {
    const glm::dvec2 middle = medianPoint(points);
    const bool isLocal = said != nullptr && said->IsLocal();
    const bool degrees = !isLocal && canBeDegrees(middle) && (said != nullptr || unsaid == Unsaid::degrees);
    const bool none = said == nullptr || said->IsEmpty() || said->IsLocal();
    if (none ? !degrees : said->IsGeographic() && !degrees) return wayOfMetres(state, file, middle);
    WayToMap way{none ? systemOf(4326) : levelSystem(*said), nullptr};
    if (state.metresOnly) {
        if (none && fits(state.sources, middle)) return WayToMap{};
        state.passOver(file, {"the heights do not say where they lie, so its outlines cannot be put on them",
                              "die Höhen sagen nicht, wo sie liegen: Ihre Umrisse passen auf nichts"});
        return std::nullopt;
    }
    if (const auto lonLat = lonLatOf(way.from, middle)) state.chooseSystem(*lonLat);
    if (!state.projection.empty()) way.transformation = transformation(way.from, systemOf(state.projection));
    if (way.transformation) return way;
    state.passOver(file, {"its reference system cannot be understood", "ihr Bezugssystem ist nicht zu verstehen"});
    return std::nullopt;
}

} // namespace lumorph::navigation
