#include "calibration/placement/light_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "calibration/lab/lab.h"
#include "core/base/error.h"
#include "core/rig/shape_report.h"

namespace lumorph {
namespace {

constexpr std::uint32_t kSeed = 1;
constexpr double kShare = 0.05;   ///< of the area that may be worse than what a map says
constexpr double kAround = 0.02;  ///< of the picture, kept free around the device
constexpr int kSpread = 160;      ///< places looked at first
constexpr int kStarts = 3;        ///< of them that are improved
constexpr double kFinest = 0.005; ///< metres: nobody hangs a projector more exactly

std::vector<std::vector<double>> statesOf(std::size_t actuators, int random) {
    std::vector<std::vector<double>> states{std::vector<double>(actuators, 0.0)};
    for (std::size_t i = 0; i < actuators; ++i) {
        states.emplace_back(actuators, 0.0);
        states.back()[i] = 1.0;
    }
    if (actuators > 1) states.emplace_back(actuators, 1.0);
    std::mt19937 numbers(kSeed);
    for (int k = 0; k < random && actuators > 0; ++k) {
        states.emplace_back(actuators);
        for (double& stroke : states.back()) stroke = numbers() / 4294967296.0;
    }
    return states;
}

/// A place of the device in one of its states.
struct Spot {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0}; ///< zero where its triangle has no area
};

Spot spotOf(const std::vector<glm::vec3>& positions, const glm::uvec3& t) {
    const glm::dvec3 a(positions[t.x]);
    const glm::dvec3 b(positions[t.y]);
    const glm::dvec3 c(positions[t.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    return {(a + b + c) / 3.0, length > 0.0 ? normal / length : glm::dvec3(0.0)};
}

bool isInPicture(const CalibratedCamera& projector, const glm::dvec2& pixel) {
    return pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x < projector.size.x - 0.5 && pixel.y < projector.size.y - 0.5;
}

/// Pixels a millimetre on a surface, along the direction in which they are farthest apart: the smaller singular value
/// of how pixels follow the surface's points.
double pixelsPerMillimetreAt(const CalibratedCamera& projector, const Spot& spot, const glm::dvec2& pixel) {
    constexpr double kStep = 1e-4; // metres
    const glm::dvec3 other = std::abs(spot.normal.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(spot.normal, other));
    const glm::dvec3 v = glm::cross(spot.normal, u);
    const auto alongU = pixelOf(projector, spot.point + kStep * u);
    const auto alongV = pixelOf(projector, spot.point + kStep * v);
    if (!alongU || !alongV) return 0.0;
    const glm::dvec2 a = (*alongU - pixel) / (1e3 * kStep);
    const glm::dvec2 b = (*alongV - pixel) / (1e3 * kStep);
    const double sum = glm::dot(a, a) + glm::dot(b, b);
    const double area = a.x * b.y - a.y * b.x;
    return std::sqrt(std::max(0.0, 0.5 * (sum - std::sqrt(std::max(0.0, sum * sum - 4.0 * area * area)))));
}

struct Ray {
    double pixelsPerMillimetre = 0.0;
    double incidence = 0.0; ///< radians
    double depth = 0.0;     ///< metres along the projector's axis
};

std::optional<Ray> rayTo(const Spot& spot, const CalibratedCamera& projector, const Lab& shadows,
                         const LightWish& wish) {
    const glm::dvec3 lens = positionOf(projector);
    const double cosine = glm::dot(spot.normal, glm::normalize(lens - spot.point));
    if (!(cosine > std::cos(wish.mostIncidence.inRadians()))) return std::nullopt;
    const auto pixel = pixelOf(projector, spot.point);
    if (!pixel || !isInPicture(projector, *pixel) || !shadows.sees(spot.point, spot.normal, lens)) return std::nullopt;
    return Ray{pixelsPerMillimetreAt(projector, spot, *pixel), std::acos(std::min(1.0, cosine)),
               (projector.cameraFromWorld * glm::dvec4(spot.point, 1.0)).z};
}

double blurAcross(const LensFocus& focus, double depth) {
    return focus.aperture * std::abs(depth / focus.focusDistance - 1.0);
}

/// Depths that something reaches.
struct DepthSpan {
    double near = std::numeric_limits<double>::infinity(), far = 0.0;
    void include(const DepthSpan& other) {
        near = std::min(near, other.near);
        far = std::max(far, other.far);
    }
};

/// The triangles that look up at rest and lie open: not hidden under others, as the folds of a skirt are, nor the
/// bottoms of slits, which only light from straight above finds.
std::vector<std::uint32_t> upperSide(const TriangleMesh& rest, const TriangleMesh& placed, const Lab& lab) {
    constexpr double kFar = 10.0;   // metres
    constexpr int kSlantedRays = 3; // of four
    std::vector<std::uint32_t> upper;
    for (std::uint32_t t = 0; t < rest.triangles.size(); ++t) {
        if (!facesUp(rest, t)) continue;
        const Spot spot = spotOf(placed.positions, placed.triangles[t]);
        const auto isOpenTo = [&](double x, double z) {
            return lab.sees(spot.point, spot.normal, spot.point + kFar * glm::dvec3(x, 1.0, z));
        };
        const int slanted = static_cast<int>(isOpenTo(1, 0)) + static_cast<int>(isOpenTo(-1, 0)) +
                            static_cast<int>(isOpenTo(0, 1)) + static_cast<int>(isOpenTo(0, -1));
        if (isOpenTo(0, 0) && slanted >= kSlantedRays) upper.push_back(t);
    }
    return upper;
}

/// Every `each`-th triangle is a place, and stands for all triangles that are nearest to it. Returns which each of the
/// upper ones is nearest to.
std::vector<int> addPlaces(const TriangleMesh& mesh, const std::vector<std::uint32_t>& upper, std::size_t each,
                           std::vector<LightAt>& places) {
    for (std::size_t k = 0; k < upper.size(); k += each)
        places.push_back({glm::vec3(spotOf(mesh.positions, mesh.triangles[upper[k]]).point), 0.0, 0.0, 0.0, {}});
    std::vector<int> nearest(upper.size());
    tbb::parallel_for(std::size_t{0}, upper.size(), [&](std::size_t k) {
        const glm::vec3 middle(spotOf(mesh.positions, mesh.triangles[upper[k]]).point);
        const auto squaredWay = [&](const LightAt& place) {
            const glm::vec3 way = place.place - middle;
            return glm::dot(way, way);
        };
        nearest[k] = static_cast<int>(std::ranges::min_element(places, {}, squaredWay) - places.begin());
    });
    for (std::size_t k = 0; k < upper.size(); ++k) {
        const glm::uvec3& t = mesh.triangles[upper[k]];
        const glm::dvec3 a(mesh.positions[t.x]);
        places[static_cast<std::size_t>(nearest[k])].area +=
            0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
    }
    return nearest;
}

/// The value that all but `kShare` of the area reach, of pairs of a value and its area, sorted.
double withoutTheWorst(const std::vector<std::pair<double, double>>& sorted) {
    double whole = 0.0;
    for (const auto& [value, area] : sorted) whole += area;
    double passed = 0.0;
    for (const auto& [value, area] : sorted) {
        passed += area;
        if (passed > kShare * whole) return value;
    }
    return 0.0;
}

/// The k-th of evenly spread numbers in [0, 1) (van der Corput).
double spreadNumber(int k, int base) {
    double number = 0.0;
    double digit = 1.0;
    for (; k > 0; k /= base) number += (k % base) * (digit /= base);
    return number;
}

} // namespace

struct LitDevice::Data {
    std::vector<LightAt> places;            ///< without light
    std::vector<std::vector<Spot>> spots;   ///< one list a state, a spot a place
    std::vector<std::unique_ptr<Lab>> labs; ///< one a state
    std::vector<int> placeOfTriangle;
    Box box;
};

LitDevice::LitDevice(const Rig& rig, const glm::mat4& worldFromDevice, int randomStates, std::size_t places,
                     const Progress& progress)
    : data_(std::make_unique<Data>()) {
    const auto states = statesOf(rig.actuatorCount(), randomStates);
    std::vector<std::uint32_t> upper; // every triangle that looks up, and then those that stand for their neighbours
    std::size_t each = 1;
    for (std::size_t s = 0; s < states.size(); ++s) {
        progress.throwIfCancelled();
        progress.report(static_cast<double>(s) / static_cast<double>(states.size()), "preparing states");
        TriangleMesh mesh = deformed(rig, states[s]);
        for (glm::vec3& point : mesh.positions) point = glm::vec3(worldFromDevice * glm::vec4(point, 1.0F));
        const Box box = boundingBox(mesh.positions);
        data_->box = s == 0 ? box : Box{glm::min(data_->box.min, box.min), glm::max(data_->box.max, box.max)};
        LabWorld world;
        world.surfaces.push_back({mesh, glm::vec3(1.0F)});
        data_->labs.push_back(std::make_unique<Lab>(std::move(world)));
        if (s == 0) {
            upper = upperSide(rig.restMesh(), mesh, *data_->labs.front());
            if (upper.empty())
                throw InvalidInput("Rig " + rig.name(), "no part of it looks up, so that no light can fall on it",
                                   "turn it so that +Y is up");
            each = std::max<std::size_t>(1, (upper.size() + places - 1) / std::max<std::size_t>(1, places));
            const std::vector<int> nearest = addPlaces(mesh, upper, each, data_->places);
            data_->placeOfTriangle.assign(mesh.triangles.size(), -1);
            for (std::size_t k = 0; k < upper.size(); ++k) data_->placeOfTriangle[upper[k]] = nearest[k];
        }
        std::vector<Spot> spots;
        spots.reserve(data_->places.size());
        for (std::size_t k = 0; k < upper.size(); k += each)
            spots.push_back(spotOf(mesh.positions, mesh.triangles[upper[k]]));
        data_->spots.push_back(std::move(spots));
    }
}

LitDevice::~LitDevice() = default;
LitDevice::LitDevice(LitDevice&&) noexcept = default;
LitDevice& LitDevice::operator=(LitDevice&&) noexcept = default;

std::size_t LitDevice::states() const noexcept { return data_->spots.size(); }

const std::vector<int>& LitDevice::placeOfTriangle() const noexcept { return data_->placeOfTriangle; }

std::vector<glm::vec3> LitDevice::corners() const {
    std::vector<glm::vec3> corners;
    corners.reserve(8);
    for (int k = 0; k < 8; ++k)
        corners.emplace_back((k & 1) != 0 ? data_->box.max.x : data_->box.min.x,
                             (k & 2) != 0 ? data_->box.max.y : data_->box.min.y,
                             (k & 4) != 0 ? data_->box.max.z : data_->box.min.z);
    return corners;
}

LightMap LitDevice::lightOf(std::span<const CalibratedCamera> projectors, const LightWish& wish,
                            std::span<const LensFocus> focus) const {
    LightMap map;
    map.places = data_->places;
    std::vector<double> worth(map.places.size(), 0.0);
    std::vector<DepthSpan> depths(map.places.size() * projectors.size());
    tbb::parallel_for(std::size_t{0}, map.places.size(), [&](std::size_t k) {
        LightAt& at = map.places[k];
        double least = 0.0;
        double slanted = 0.0;
        int lit = 0;
        for (std::size_t s = 0; s < data_->spots.size(); ++s) {
            std::optional<Ray> best;
            std::size_t from = 0;
            for (std::size_t p = 0; p < projectors.size(); ++p) {
                const auto ray = rayTo(data_->spots[s][k], projectors[p], *data_->labs[s], wish);
                if (!ray) continue;
                depths[k * projectors.size() + p].include({ray->depth, ray->depth});
                if (best && ray->pixelsPerMillimetre <= best->pixelsPerMillimetre) continue;
                best = ray;
                from = p;
            }
            if (!best) continue;
            if (from < focus.size())
                at.blur = std::max(at.blur, blurAcross(focus[from], best->depth) / std::cos(best->incidence));
            least = lit == 0 ? best->pixelsPerMillimetre : std::min(least, best->pixelsPerMillimetre);
            slanted = std::max(slanted, best->incidence);
            worth[k] += std::min(1.0, best->pixelsPerMillimetre / wish.pixelsPerMillimetre);
            ++lit;
        }
        at.lit = static_cast<double>(lit) / static_cast<double>(states());
        at.pixelsPerMillimetre = least;
        at.incidence = Angle::radians(slanted);
    });
    double area = 0.0;
    std::vector<std::pair<double, double>> fine;
    std::vector<std::pair<double, double>> slanted;
    std::vector<std::pair<double, double>> blurred;
    for (std::size_t k = 0; k < map.places.size(); ++k) {
        const LightAt& at = map.places[k];
        area += at.area;
        map.lit += at.area * at.lit;
        map.worth += at.area * worth[k] / static_cast<double>(states());
        if (!(at.lit > 0.0)) continue;
        fine.emplace_back(at.pixelsPerMillimetre, at.area);
        slanted.emplace_back(at.incidence.inRadians(), at.area);
        blurred.emplace_back(at.blur, at.area);
    }
    map.lit /= area;
    map.worth /= area;
    std::ranges::sort(fine);
    std::ranges::sort(slanted, std::greater<>());
    map.pixelsPerMillimetre = withoutTheWorst(fine);
    map.incidence = Angle::radians(withoutTheWorst(slanted));
    std::ranges::sort(blurred, std::greater<>());
    map.blur = withoutTheWorst(blurred);
    map.blurKnown = std::ranges::any_of(focus, [](const LensFocus& lens) { return lens.aperture > 0.0; });
    for (std::size_t p = 0; p < projectors.size(); ++p) {
        DepthSpan lit;
        for (std::size_t k = 0; k < map.places.size(); ++k) lit.include(depths[k * projectors.size() + p]);
        // Of |depth / focus - 1| the largest is least where nearest and farthest are as blurred as each other.
        map.bestFocus.push_back(lit.far > 0.0 ? 0.5 * (lit.near + lit.far) : 0.0);
    }
    return map;
}

LensFocus lensFocusOf(std::span<const MeasuredBlur> measured) {
    const auto refuse = [](const char* why) {
        throw InvalidInput("Measured blur", why, "give at least three distances, before and behind the sharpest one");
    };
    if (measured.size() < 3) refuse("three distances are the least that tell a lens");
    for (const MeasuredBlur& at : measured)
        if (!(at.distance > 0.0) || !(at.blur >= 0.0) || !std::isfinite(at.distance) || !std::isfinite(at.blur))
            refuse("a distance must be above 0 and a blur no less than 0");
    // Before the focus the disk shrinks along a straight line, behind it it grows along the same one: for every way to
    // part the distances, a line by least squares.
    std::vector<MeasuredBlur> sorted(measured.begin(), measured.end());
    std::ranges::sort(sorted, {}, &MeasuredBlur::distance);
    LensFocus best;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t before = 0; before <= sorted.size(); ++before) {
        double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
        for (std::size_t k = 0; k < sorted.size(); ++k) {
            const double signedBlur = k < before ? -sorted[k].blur : sorted[k].blur;
            n += 1.0, x += sorted[k].distance, y += signedBlur;
            xx += sorted[k].distance * sorted[k].distance, xy += sorted[k].distance * signedBlur;
        }
        const double slope = (n * xy - x * y) / (n * xx - x * x);
        const double aperture = -(y - slope * x) / n; // where the line meets distance 0
        if (!(slope > 0.0) || !(aperture > 0.0)) continue;
        double error = 0.0;
        for (const MeasuredBlur& at : sorted) {
            const double off = blurAcross({aperture, aperture / slope}, at.distance) - at.blur;
            error += off * off;
        }
        if (error < least) least = error, best = {aperture, aperture / slope};
    }
    constexpr double kWidest = 0.5, kFarthest = 100.0; // metres: no lens of a projector is wider, or focused beyond
    if (!(best.aperture > 0.0 && best.aperture <= kWidest && best.focusDistance <= kFarthest))
        refuse("it does not change with the distance as a lens has it");
    return best;
}

CalibratedCamera aimedProjector(const ProjectorLens& lens, const glm::dvec3& place, std::span<const glm::vec3> points,
                                bool turned) {
    const glm::dvec3 aim(boundingBox(points).centre());
    const auto zoomed = [&](double throwRatio) {
        const double focal = throwRatio * lens.size.x;
        CalibratedCamera camera = cameraLookingAt(place, aim, lens.size, focal);
        // Rows count downwards: a picture above the axis has its axis below its middle. The projector is tilted the
        // other way, so that the middle of the picture still meets the aim.
        const double below = lens.shift * lens.size.y;
        camera.principal.y += below;
        const double tilt = std::atan2(below, focal);
        const double c = std::cos(tilt);
        const double s = std::sin(tilt);
        glm::dmat4 turn(1.0);
        if (turned) turn = glm::dmat4({0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1});
        const glm::dmat4 tilted({1, 0, 0, 0}, {0, c, s, 0}, {0, -s, c, 0}, {0, 0, 0, 1});
        camera.cameraFromWorld = tilted * turn * camera.cameraFromWorld;
        return camera;
    };
    const auto holdsAll = [&](const CalibratedCamera& camera) {
        const glm::dvec2 margin = kAround * glm::dvec2(camera.size);
        return std::ranges::all_of(points, [&](const glm::vec3& point) {
            const auto pixel = pixelOf(camera, glm::dvec3(point));
            return pixel && isInPicture(camera, *pixel - margin) && isInPicture(camera, *pixel + margin);
        });
    };
    CalibratedCamera best = zoomed(lens.throwMost);
    if (holdsAll(best)) return best;
    double wide = lens.throwLeast;
    double narrow = lens.throwMost;
    best = zoomed(wide);
    if (!holdsAll(best)) return best;
    while (narrow - wide > 1e-3) {
        const double middle = 0.5 * (wide + narrow);
        (holdsAll(zoomed(middle)) ? wide : narrow) = middle;
    }
    return zoomed(wide);
}

ProjectorPlace bestProjectorPlace(const LitDevice& device, const ProjectorLens& lens, const glm::dvec3& boundsLow,
                                  const glm::dvec3& boundsHigh, std::span<const CalibratedCamera> others,
                                  const LightWish& wish, const Progress& progress) {
    if (lens.size.x < 1 || lens.size.y < 1 || !(lens.throwLeast > 0.0) || !(lens.throwMost >= lens.throwLeast) ||
        !std::isfinite(lens.throwMost) || !(std::abs(lens.shift) <= 2.0))
        throw InvalidInput("Projector lens", "its size, throw ratio or shift is none that a lens can have",
                           "give pixels, a throw ratio above 0 and a shift between -2 and 2 picture heights");
    for (int k = 0; k < 3; ++k)
        if (!(boundsLow[k] <= boundsHigh[k]) || !std::isfinite(boundsLow[k]) || !std::isfinite(boundsHigh[k]))
            throw InvalidInput("Bounds of the projector", "they hold no place", "give the lower corner first");
    const std::vector<glm::vec3> corners = device.corners();
    std::vector<CalibratedCamera> all(others.begin(), others.end());
    all.emplace_back();
    const auto at = [&](const glm::dvec3& place, bool turned) -> std::optional<ProjectorPlace> {
        if (glm::length(place - glm::dvec3(boundingBox(corners).centre())) < 1e-3) return std::nullopt;
        ProjectorPlace found;
        found.camera = all.back() = aimedProjector(lens, place, corners, turned);
        found.throwRatio = found.camera.focal.x / lens.size.x;
        found.turned = turned;
        found.light = device.lightOf(all, wish);
        return found;
    };
    const auto isBetter = [](const ProjectorPlace& a, const ProjectorPlace& b) {
        return a.light.worth > b.light.worth;
    };
    std::vector<ProjectorPlace> tried;
    for (int k = 0; k < kSpread; ++k) {
        progress.throwIfCancelled();
        progress.report(0.6 * k / kSpread, "looking at places");
        const glm::dvec3 share(spreadNumber(k, 2), spreadNumber(k, 3), spreadNumber(k, 5));
        for (const bool turned : {false, true})
            if (auto found = at(boundsLow + share * (boundsHigh - boundsLow), turned))
                tried.push_back(std::move(*found));
    }
    if (tried.empty())
        throw InvalidInput("Bounds of the projector", "they lie inside the device", "give bounds above it");
    const auto starts = std::min<std::ptrdiff_t>(kStarts, std::ssize(tried));
    std::partial_sort(tried.begin(), tried.begin() + starts, tried.end(), isBetter);
    tried.erase(tried.begin() + starts, tried.end());
    for (std::size_t k = 0; k < tried.size(); ++k) {
        ProjectorPlace& best = tried[k];
        for (glm::dvec3 step = 0.125 * (boundsHigh - boundsLow); std::max({step.x, step.y, step.z}) > kFinest;) {
            progress.throwIfCancelled();
            progress.report(0.6 + 0.4 * static_cast<double>(k) / static_cast<double>(tried.size()), "improving places");
            bool improved = false;
            for (int axis = 0; axis < 3; ++axis)
                for (const double sign : {-1.0, 1.0}) {
                    glm::dvec3 place = positionOf(best.camera);
                    place[axis] = std::clamp(place[axis] + sign * step[axis], boundsLow[axis], boundsHigh[axis]);
                    auto found = at(place, best.turned);
                    if (!found || !isBetter(*found, best)) continue;
                    best = std::move(*found);
                    improved = true;
                }
            if (!improved) step *= 0.5;
        }
    }
    return *std::ranges::min_element(tried, isBetter);
}

} // namespace lumorph
