#include "app/applications/navigation/import_polygons.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lumorph::navigation {
namespace {

constexpr double kSeam = 0.02;      ///< metres between faces that are one: files round their corners
constexpr double kSmoothing = 0.15; ///< metres by which an outline with very many corners may change
constexpr int kManyCorners = 200;

std::vector<glm::dvec2> cornersOf(const OGRLinearRing& line) {
    std::vector<glm::dvec2> ring;
    for (int k = 0; k + 1 < line.getNumPoints(); ++k) ring.emplace_back(line.getX(k), line.getY(k));
    return ring;
}

void addCorners(OGRPolygon& polygon, const std::vector<glm::dvec2>& corners) {
    auto ring = std::make_unique<OGRLinearRing>();
    for (const glm::dvec2& p : corners) ring->addPoint(p.x, p.y);
    ring->closeRings();
    polygon.addRingDirectly(ring.release());
}

bool isClosed(const OGRLinearRing& ring) {
    const int last = ring.getNumPoints() - 1;
    return last < 1 || (ring.getX(0) == ring.getX(last) && ring.getY(0) == ring.getY(last));
}

} // namespace

bool isFinite(const OGRGeometry& geometry) {
    OGREnvelope box; // which passes over what is no number
    geometry.getEnvelope(&box);
    if (!std::isfinite(box.MinX + box.MaxX + box.MinY + box.MaxY)) return false;
    for (const OGRPolygon* polygon : polygonsOf(geometry))
        for (const OGRLinearRing* ring : *polygon)
            for (int k = 0; k < ring->getNumPoints(); ++k)
                if (!std::isfinite(ring->getX(k)) || !std::isfinite(ring->getY(k))) return false;
    return true;
}

std::size_t closeRings(OGRGeometry& geometry) {
    std::size_t open = 0;
    for (const OGRPolygon* polygon : polygonsOf(geometry))
        for (const OGRLinearRing* ring : *polygon) open += isClosed(*ring) ? 0 : 1;
    if (open > 0) geometry.closeRings();
    return open;
}

std::vector<const OGRPolygon*> polygonsOf(const OGRGeometry& geometry) {
    const OGRwkbGeometryType kind = wkbFlatten(geometry.getGeometryType());
    if (kind == wkbPolygon) return {geometry.toPolygon()};
    std::vector<const OGRPolygon*> polygons;
    if (OGR_GT_IsSubClassOf(kind, wkbGeometryCollection) != 0)
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) {
            const std::vector<const OGRPolygon*> of = polygonsOf(*part);
            polygons.insert(polygons.end(), of.begin(), of.end());
        }
    return polygons;
}

double areaOf(const OGRGeometry& geometry) {
    double area = 0.0;
    for (const OGRPolygon* polygon : polygonsOf(geometry)) area += polygon->get_Area();
    return area;
}

Geometry faceOf(const std::vector<glm::dvec2>& corners, const std::vector<std::vector<glm::dvec2>>& holes) {
    auto polygon = std::make_unique<OGRPolygon>();
    addCorners(*polygon, corners);
    for (const auto& hole : holes) addCorners(*polygon, hole);
    if (!(polygon->get_Area() > 0.0)) return nullptr;
    if (polygon->IsValid()) return polygon;
    return Geometry(polygon->MakeValid());
}

Geometry unionOf(const std::vector<Geometry>& faces) {
    OGRMultiPolygon all;
    for (const Geometry& face : faces)
        for (const OGRPolygon* polygon : polygonsOf(*face)) (void)all.addGeometry(polygon);
    if (all.getNumGeometries() == 0) return nullptr;
    Geometry one(all.UnionCascaded());
    if (!one || all.getNumGeometries() == 1) return one;
    // Out and in again, with square corners kept as they are: closes seams and changes nothing else.
    Geometry closed(one->Buffer(kSeam, 4));
    if (closed) closed.reset(closed->Buffer(-kSeam, 4));
    if (closed && !closed->IsEmpty() && polygonsOf(*closed).size() < polygonsOf(*one).size())
        one.reset(closed->SimplifyPreserveTopology(kSeam));
    return one;
}

std::size_t addOutlines(MapSources& sources, const OGRGeometry& geometry, const BuildingShape& shape,
                        const Words& name) {
    std::size_t count = 0;
    for (const OGRPolygon* polygon : polygonsOf(geometry)) {
        if (polygon->getExteriorRing() == nullptr || polygon->getExteriorRing()->getNumPoints() < 4) continue;
        Geometry simple;
        int corners = 0;
        for (const OGRLinearRing* ring : *polygon) corners += ring->getNumPoints();
        if (corners > kManyCorners) simple.reset(polygon->SimplifyPreserveTopology(kSmoothing));
        const OGRPolygon& kept =
            simple && wkbFlatten(simple->getGeometryType()) == wkbPolygon ? *simple->toPolygon() : *polygon;
        MapSources::Outline outline;
        outline.ring = cornersOf(*kept.getExteriorRing());
        for (int k = 0; k < kept.getNumInteriorRings(); ++k)
            outline.holes.push_back(cornersOf(*kept.getInteriorRing(k)));
        outline.shape = shape;
        outline.name = count == 0 ? name : Words();
        sources.outlines.push_back(std::move(outline));
        ++count;
    }
    return count;
}

} // namespace lumorph::navigation
