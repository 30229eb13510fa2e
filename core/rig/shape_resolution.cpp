#include "core/rig/shape_resolution.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rig/shape_report.h"

namespace lumorph {
namespace {

constexpr int kSectionPoints = 64;     ///< on the longer side of the top
constexpr int kStrokeSteps = 16;       ///< states of an actuator that are looked at for lever and weight
constexpr std::size_t kAllCorners = 6; ///< actuators up to which all joint states of rest and full stroke are seen
constexpr double kFlat = 0.5 * std::numbers::pi / 180.0; ///< turns below count as none
constexpr double kGravity = 9.80665;

/// A rectangle of cells over the (x, z) plane.
struct PlaneGrid {
    glm::dvec2 origin{0.0};
    double pitch = 0.0;
    int columns = 0;
    int rows = 0;

    PlaneGrid(const Box& box, int longest) {
        const glm::dvec3 size(box.size());
        pitch = std::max({size.x, size.z, 1e-9}) / longest;
        columns = std::max(1, static_cast<int>(std::round(size.x / pitch)));
        rows = std::max(1, static_cast<int>(std::round(size.z / pitch)));
        const glm::dvec3 centre(box.centre());
        origin = {centre.x - 0.5 * pitch * columns, centre.z - 0.5 * pitch * rows};
    }
    [[nodiscard]] std::size_t size() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    [[nodiscard]] std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
    }

    /// Calls visit(cell, shares of the corners) for each cell whose centre lies in the triangle, seen from above.
    template <typename Visit>
    void eachCell(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, Visit&& visit) const {
        const glm::dvec2 p(a.x, a.z);
        const glm::dvec2 q(b.x, b.z);
        const glm::dvec2 r(c.x, c.z);
        const auto turn = [](const glm::dvec2& u, const glm::dvec2& v) { return u.x * v.y - u.y * v.x; };
        const double area = turn(q - p, r - p);
        if (area == 0.0) return;
        const glm::dvec2 low = (glm::min(glm::min(p, q), r) - origin) / pitch - 0.5;
        const glm::dvec2 high = (glm::max(glm::max(p, q), r) - origin) / pitch - 0.5;
        for (int j = std::max(0, static_cast<int>(std::ceil(low.y))); j <= std::min(rows - 1.0, std::floor(high.y));
             ++j)
            for (int i = std::max(0, static_cast<int>(std::ceil(low.x)));
                 i <= std::min(columns - 1.0, std::floor(high.x)); ++i) {
                const glm::dvec2 at = origin + pitch * (glm::dvec2(i, j) + 0.5);
                const glm::dvec3 shares(turn(q - at, r - at) / area, turn(r - at, p - at) / area,
                                        turn(p - at, q - at) / area);
                if (shares.x >= 0.0 && shares.y >= 0.0 && shares.z >= 0.0) visit(index(i, j), shares);
            }
    }
};

/// Share of the silhouette, seen from above, that one can look through: cells that nothing covers and that the outside
/// does not reach.
double openShare(const PlaneGrid& grid, const TriangleMesh& mesh) {
    std::vector<char> state(grid.size(), 0); // 0 open, 1 covered, 2 outside
    for (const glm::uvec3& t : mesh.triangles)
        grid.eachCell(mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z],
                      [&](std::size_t cell, const glm::dvec3&) { state[cell] = 1; });
    std::vector<glm::ivec2> reached;
    const auto reach = [&](int i, int j) {
        if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows || state[grid.index(i, j)] != 0) return;
        state[grid.index(i, j)] = 2;
        reached.emplace_back(i, j);
    };
    for (int i = 0; i < grid.columns; ++i) reach(i, 0), reach(i, grid.rows - 1);
    for (int j = 0; j < grid.rows; ++j) reach(0, j), reach(grid.columns - 1, j);
    while (!reached.empty()) {
        const glm::ivec2 at = reached.back();
        reached.pop_back();
        reach(at.x + 1, at.y), reach(at.x - 1, at.y), reach(at.x, at.y + 1), reach(at.x, at.y - 1);
    }
    const auto open = static_cast<double>(std::ranges::count(state, 0));
    const auto covered = static_cast<double>(std::ranges::count(state, 1));
    return open > 0.0 ? open / (open + covered) : 0.0;
}

/// What the angles along one section of the surface say.
struct SectionReading {
    int crossings = 0;      ///< changes of the angles' sign
    double turned = 0.0;    ///< the largest angle that a piece of it turns in all, radians
    double curvature = 0.0; ///< the largest angle for its way, radians a metre
};

SectionReading readSection(const std::vector<glm::dvec3>& points, const glm::dvec3& side) {
    SectionReading reading;
    double up = 0.0;
    double down = 0.0;
    int last = 0;
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
        const glm::dvec3 in = points[k] - points[k - 1];
        const glm::dvec3 out = points[k + 1] - points[k];
        const glm::dvec3 turn = glm::cross(in, out);
        const double size = std::atan2(glm::length(turn), glm::dot(in, out));
        const double angle = glm::dot(turn, side) < 0.0 ? -size : size;
        up = std::max(0.0, up + angle);
        down = std::max(0.0, down - angle);
        reading.turned = std::max({reading.turned, up, down});
        const double way = 0.5 * (glm::length(in) + glm::length(out));
        if (size < kFlat || way <= 0.0) continue;
        reading.curvature = std::max(reading.curvature, size / way);
        const int sign = angle > 0.0 ? 1 : -1;
        if (last != 0 && sign != last) ++reading.crossings;
        last = sign;
    }
    return reading;
}

double topAreaOf(const TriangleMesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a(mesh.positions[t.x]);
    return 0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a));
}

/// What of the top hangs on each vertex, kilograms.
std::vector<double> topMasses(const TriangleMesh& mesh, double arealDensity) {
    std::vector<double> masses(mesh.positions.size(), 0.0);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (!facesUp(mesh, t)) continue;
        const double third = arealDensity * topAreaOf(mesh, mesh.triangles[t]) / 3.0;
        for (int k = 0; k < 3; ++k) masses[mesh.triangles[t][k]] += third;
    }
    return masses;
}

/// What an actuator alone does where it is fastest and where it lifts most.
struct StrokeWork {
    double way = 0.0;  ///< metres a stroke of the fastest point
    double lift = 0.0; ///< joules a stroke against weight
};

StrokeWork workOf(const Rig& rig, std::size_t index, const std::vector<double>& masses) {
    StrokeWork most;
    const auto vertices = rig.verticesOf(index);
    const Rig::Subset subset = rig.subset(vertices);
    std::vector<double> strokes(rig.actuatorCount(), 0.0);
    std::vector<glm::vec3> before(vertices.size());
    std::vector<glm::vec3> now(vertices.size());
    subset.deform(strokes, before);
    for (int step = 1; step <= kStrokeSteps; ++step) {
        strokes[index] = static_cast<double>(step) / kStrokeSteps;
        subset.deform(strokes, now);
        double work = 0.0;
        for (std::size_t v = 0; v < now.size(); ++v) {
            most.way = std::max(most.way, kStrokeSteps * static_cast<double>(glm::distance(now[v], before[v])));
            work += masses[vertices[v]] * kGravity * static_cast<double>(now[v].y - before[v].y);
        }
        most.lift = std::max(most.lift, kStrokeSteps * work);
        before.swap(now);
    }
    return most;
}

/// Its own, as far as the rig names it and the table has it.
const ServoType& servoOf(const Actuator& actuator, const ServoType* otherwise) {
    if (const ServoType* own = findServo(actuator.drive.servo)) return *own;
    return otherwise != nullptr ? *otherwise : servoTypes().front();
}

ServoLoad loadOf(const Actuator& actuator, const StrokeWork& work, const ServoType& servo, const DeviceLoad& device) {
    const double angle = servoAngle(actuator, servo).inRadians();
    ServoLoad load;
    load.actuator = actuator.name;
    load.servo = &servo;
    load.lever = work.way / angle;
    load.torque = work.lift / angle + device.push * load.lever;
    if (const auto* lift = std::get_if<SheetLift>(&actuator.deformer)) load.torque += lift->torque; // the sheet's
    load.force = load.lever > 0.0 ? servo.stallTorque / load.lever : 0.0;
    load.weak = load.torque > servo.usableTorque();
    if (const ServoType* stronger = cheapestServo(load.torque)) load.stronger = stronger->name;
    return load;
}

class ResolutionMeter {
public:
    ResolutionMeter(const Rig& rig, const ShapeResolutionOptions& options, const Progress& progress)
        : rig_(rig), options_(options), progress_(progress), mesh_(rig.restMesh()),
          outer_(rig.reach(), 2 * kSectionPoints), masses_(topMasses(mesh_, options.load.arealDensity)) {
        findTop();
    }

    ShapeResolution measure() {
        for (std::size_t a = 0; a < rig_.actuatorCount(); ++a) {
            progress_.throwIfCancelled();
            progress_.report(0.5 * static_cast<double>(a) / static_cast<double>(rig_.actuatorCount()),
                             "moving each actuator");
            moveAlone(a);
        }
        const std::vector<std::vector<double>> states = cornerStates();
        for (std::size_t s = 0; s < states.size(); ++s) {
            progress_.throwIfCancelled();
            progress_.report(0.5 + 0.5 * static_cast<double>(s) / static_cast<double>(states.size()),
                             "following sections of the surface");
            readState(states[s]);
        }
        out_.name = rig_.name();
        addMetrics();
        return std::move(out_);
    }

private:
    struct TopPoint {
        glm::uvec3 corners{0};
        glm::dvec3 shares{0.0};
        double height = -INFINITY; ///< at rest; none: nothing of the top is there
    };

    void findTop() {
        Box box;
        for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
            if (!facesUp(mesh_, t)) continue;
            top_.push_back(mesh_.triangles[t]);
            for (int k = 0; k < 3; ++k) box.include(mesh_.positions[mesh_.triangles[t][k]]);
        }
        topBox_ = box;
        for (const glm::uvec3& t : top_) {
            const double area = topAreaOf(mesh_, t);
            int moved = 0;
            for (int k = 0; k < 3; ++k) moved += rig_.actuatorsOf(t[k]).empty() ? 0 : 1;
            topArea_ += area;
            movedArea_ += area * moved / 3.0;
        }
    }

    /// Lever and weight of one actuator, and what it does to amplitude, curvature, strength and speed.
    void moveAlone(std::size_t index) {
        const Actuator& actuator = rig_.actuators()[index];
        const StrokeWork work = workOf(rig_, index, masses_);
        amplitude_ = std::max(amplitude_, amplitudeOf(rig_, index));
        const ServoLoad load = loadOf(actuator, work, servoOf(actuator, options_.servo), options_.load);
        const double angle = servoAngle(actuator, *load.servo).inRadians();
        if (load.lever > 0.0) force_ = force_ > 0.0 ? std::min(force_, load.force) : load.force;
        speed_ = std::max(speed_, work.way * std::min(actuator.maxVelocity, load.servo->speed / angle));
        if (const auto* bend = std::get_if<Bend>(&actuator.deformer))
            bendCurvature_ = std::max(bendCurvature_, angle / bend->length);
        else
            onlyBends_ = false;
        out_.loads.push_back(load);
    }

    [[nodiscard]] std::vector<std::vector<double>> cornerStates() const {
        const std::size_t count = rig_.actuatorCount();
        std::vector<std::vector<double>> states;
        if (count <= kAllCorners) {
            for (std::size_t bits = 0; bits < std::size_t{1} << count; ++bits) {
                states.emplace_back(count, 0.0);
                for (std::size_t a = 0; a < count; ++a) states.back()[a] = (bits >> a & 1U) != 0 ? 1.0 : 0.0;
            }
            return states;
        }
        states.emplace_back(count, 0.0);
        states.emplace_back(count, 1.0);
        states.emplace_back(count, 0.0);
        for (std::size_t a = 0; a < count; a += 2) states.back()[a] = 1.0;
        std::mt19937_64 random(options_.seed);
        while (states.size() < std::size_t{1} << kAllCorners) {
            states.emplace_back(count, 0.0);
            for (double& stroke : states.back()) stroke = (random() >> 63U) != 0 ? 1.0 : 0.0;
        }
        return states;
    }

    void readState(const std::vector<double>& strokes) {
        TriangleMesh moved = deformed(rig_, strokes);
        porosity_ = std::max(porosity_, openShare(outer_, moved));
        if (topBox_.empty()) return;
        for (const glm::uvec3& t : top_)
            for (int k = 0; k < 3; ++k) stretchOf(moved, t[k], t[(k + 1) % 3]);
        if (points_.empty()) layPoints();
        const PlaneGrid& grid = *sections_;
        for (int j = 0; j < grid.rows; ++j)
            readLine(moved, grid.columns, glm::dvec3(0, 0, 1), [&](int i) { return grid.index(i, j); });
        for (int i = 0; i < grid.columns; ++i)
            readLine(moved, grid.rows, glm::dvec3(-1, 0, 0), [&](int j) { return grid.index(i, j); });
    }

    void stretchOf(const TriangleMesh& moved, std::uint32_t a, std::uint32_t b) {
        const double rest = glm::distance(glm::dvec3(mesh_.positions[a]), glm::dvec3(mesh_.positions[b]));
        const double now = glm::distance(glm::dvec3(moved.positions[a]), glm::dvec3(moved.positions[b]));
        if (rest > 0.0) stretch_ = std::max(stretch_, std::abs(now / rest - 1.0));
    }

    /// The points of the sections, on the highest part of the top at rest.
    void layPoints() {
        sections_.emplace(topBox_, kSectionPoints);
        points_.resize(sections_->size());
        for (const glm::uvec3& t : top_)
            sections_->eachCell(mesh_.positions[t.x], mesh_.positions[t.y], mesh_.positions[t.z],
                                [&](std::size_t cell, const glm::dvec3& shares) {
                                    const double height = shares.x * static_cast<double>(mesh_.positions[t.x].y) +
                                                          shares.y * static_cast<double>(mesh_.positions[t.y].y) +
                                                          shares.z * static_cast<double>(mesh_.positions[t.z].y);
                                    if (height > points_[cell].height) points_[cell] = {t, shares, height};
                                });
    }

    /// Reads a line of points in pieces that hang together: a gap, or a step at rest, ends one.
    template <typename CellAt>
    void readLine(const TriangleMesh& moved, int count, const glm::dvec3& side, CellAt&& cellAt) {
        std::vector<glm::dvec3> piece;
        double height = 0.0;
        const auto close = [&] {
            const SectionReading reading = readSection(piece, side);
            crossings_ = std::max(crossings_, reading.crossings);
            turned_ = std::max(turned_, reading.turned);
            sectionCurvature_ = std::max(sectionCurvature_, reading.curvature);
            piece.clear();
        };
        for (int k = 0; k < count; ++k) {
            const TopPoint& point = points_[cellAt(k)];
            const bool there = std::isfinite(point.height);
            if (!piece.empty() && (!there || std::abs(point.height - height) > sections_->pitch)) close();
            if (!there) continue;
            height = point.height;
            piece.push_back(point.shares.x * glm::dvec3(moved.positions[point.corners.x]) +
                            point.shares.y * glm::dvec3(moved.positions[point.corners.y]) +
                            point.shares.z * glm::dvec3(moved.positions[point.corners.z]));
        }
        close();
    }

    void addMetrics() {
        const DeviceLight& light = options_.light;
        const glm::dvec3 size(topBox_.size());
        const double longer = std::max(size.x, size.z);
        const double shorter = std::min(size.x, size.z);
        const double pixels = topArea_ / (light.pixelPitch * light.pixelPitch);
        const auto count = static_cast<double>(rig_.actuatorCount());
        const auto add = [&](std::string_view key, std::string_view name, std::string_view unit,
                             std::string_view meaning, std::string_view withLight, std::optional<double> physical,
                             std::optional<double> lit, std::optional<double> together) {
            out_.metrics.push_back({key, name, unit, meaning, withLight, physical, lit, together});
        };
        add("area", "Area", "m2", "The part of the top that actuators move, at rest.",
            "Light reaches all of the top; it can also make the device look smaller by showing the table on it.",
            movedArea_, topArea_, topArea_);
        add("granularity", "Granularity", "1/m2", "Control points for the area that they move.",
            "A pixel is a control point of what is seen: one for each pixel pitch squared. Together they add up.",
            movedArea_ > 0.0 ? count / movedArea_ : 0.0, 1.0 / (light.pixelPitch * light.pixelPitch),
            topArea_ > 0.0 ? (count + pixels) / topArea_ : 0.0);
        add("porosity", "Porosity", "",
            "Share of the silhouette, seen from above, that one can look through; the largest of the states.",
            "Light draws holes by showing what lies behind, as small as a pixel and up to everything that is lit; a "
            "finger finds none.",
            porosity_, topArea_ > 0.0 ? 1.0 : 0.0, topArea_ > 0.0 ? 1.0 : porosity_);
        const double curvature = onlyBends_ ? bendCurvature_ : std::max(bendCurvature_, sectionCurvature_);
        const double crease = 0.5 * std::numbers::pi / light.pixelPitch;
        add("curvature", "Curvature", "1/m",
            "The tightest bend: angle for its length; of what does not bend along an arc, the angle between "
            "consecutive "
            "points of a section for the way between them.",
            "Shading (a bump map) turns the apparent normal by up to 90 degrees from one pixel to the next, on top of "
            "the real one.",
            curvature, crease, curvature + crease);
        const double apparent = 0.5 * shorter * std::tan(light.elevation.inRadians());
        add("amplitude", "Amplitude", "m", "The farthest that an actuator takes a point of the device from rest.",
            "For a tracked viewer a thing in the middle may seem to stand up to half the shorter side times the "
            "tangent "
            "of his elevation, before the edge crops it; its finest step is a pixel times that tangent. What rises "
            "carries the light with it.",
            amplitude_, apparent, amplitude_ + apparent);
        const double crossings = std::max(0.0, std::floor(longer / light.pixelPitch) - 1.0);
        add("zeroCrossing", "Zero-crossing", "",
            "How often the angles between consecutive points of a section change their sign: waves across the device; "
            "the most of any section and state.",
            "The finest wave that pixels show is two pixels long: a change a pixel across the longer side.",
            static_cast<double>(crossings_), crossings, std::max(static_cast<double>(crossings_), crossings));
        const double closure = turned_ / (2.0 * std::numbers::pi);
        add("closure", "Closure", "",
            "How far a section closes around something: the largest angle that a piece of it turns in all, of a full "
            "turn (1: a tube).",
            "Light encloses nothing: nobody can put a hand into it.", closure, std::nullopt, closure);
        add("stretchability", "Stretchability", "",
            "The largest change of an edge of the top relative to its length at rest.",
            "Light leaves the material as it is.", stretch_, std::nullopt, stretch_);
        add("strength", "Strength", "N",
            "The force of the weakest control point where its lever is longest: the servo's stall torque by its lever.",
            "Light pushes nothing.", force_, std::nullopt, force_);
        add("speed", "Speed", "m/s",
            "Of the fastest control point, within its velocity limit and what its servo turns without load.",
            "Light is anywhere else in the next frame: the longer side for each.", speed_,
            longer * light.framesPerSecond, speed_ + longer * light.framesPerSecond);
        for (const ServoLoad& load : out_.loads) warnOf(load);
    }

    void warnOf(const ServoLoad& load) {
        if (load.lever == 0.0) out_.warnings.push_back("The actuator " + inQuotes(load.actuator) + " moves nothing.");
        if (!load.weak) return;
        char numbers[128];
        std::snprintf(numbers, sizeof numbers, "needs %.3f N m with a lever of %.0f mm, more than the %.3f N m",
                      load.torque, 1e3 * load.lever, load.servo->usableTorque());
        out_.warnings.push_back("The " + std::string(load.servo->name) + " is too weak for " + inQuotes(load.actuator) +
                                ": it " + numbers + " it can hold; " +
                                (load.stronger.empty() ? "no servo in the table does, shorten the lever."
                                                       : "a " + std::string(load.stronger) + " does."));
    }

    const Rig& rig_;
    const ShapeResolutionOptions& options_;
    const Progress& progress_;
    const TriangleMesh& mesh_;
    PlaneGrid outer_;
    std::vector<double> masses_; ///< of the top, one a vertex, kilograms
    std::vector<glm::uvec3> top_;
    Box topBox_;
    std::optional<PlaneGrid> sections_;
    std::vector<TopPoint> points_; ///< one a cell of the sections
    double topArea_ = 0.0;
    double movedArea_ = 0.0;
    double amplitude_ = 0.0;
    double force_ = 0.0;
    double speed_ = 0.0;
    double bendCurvature_ = 0.0;
    double sectionCurvature_ = 0.0;
    double porosity_ = 0.0;
    double stretch_ = 0.0;
    double turned_ = 0.0;
    int crossings_ = 0;
    bool onlyBends_ = true;
    ShapeResolution out_;
};

void requirePositive(double value, bool orZero, const char* what) {
    if (!std::isfinite(value) || value < 0.0 || (value == 0.0 && !orZero))
        throw InvalidInput(what, "it is no positive finite number", "give one");
}

} // namespace

Angle servoAngle(const Actuator& actuator, const ServoType& servo) {
    double angle = servo.travel.inRadians() * (actuator.drive.pulseMax - actuator.drive.pulseMin) /
                   (servo.pulseMax - servo.pulseMin);
    if (!actuator.drive.curve.empty()) return Angle::radians(std::max(std::abs(angle), 1e-3)); // by way of a lever
    if (const auto* hinge = std::get_if<Hinge>(&actuator.deformer))
        angle = hinge->max.inRadians() - hinge->min.inRadians();
    else if (const auto* bend = std::get_if<Bend>(&actuator.deformer))
        angle = bend->max.inRadians() - bend->min.inRadians();
    else if (const auto* joint = std::get_if<SkinJoint>(&actuator.deformer);
             joint != nullptr && joint->motion == SkinJoint::Motion::rotate)
        angle = joint->max - joint->min;
    else if (const auto* lift = std::get_if<SheetLift>(&actuator.deformer))
        angle = lift->max.inRadians() - lift->min.inRadians();
    return Angle::radians(std::max(std::abs(angle), 1e-3));
}

ServoLoad servoLoad(const Rig& rig, std::size_t actuator, const ServoType* servo, const DeviceLoad& load) {
    const Actuator& one = rig.actuators()[actuator];
    const std::vector<double> masses = topMasses(rig.restMesh(), load.arealDensity);
    return loadOf(one, workOf(rig, actuator, masses), servoOf(one, servo), load);
}

ShapeResolution shapeResolution(const Rig& rig, const ShapeResolutionOptions& options, const Progress& progress) {
    requirePositive(options.light.pixelPitch, false, "the light's pixel pitch");
    requirePositive(options.light.framesPerSecond, false, "the light's frame rate");
    requirePositive(options.load.arealDensity, true, "the load's density");
    requirePositive(options.load.push, true, "the load's push");
    const double elevation = options.light.elevation.inDegrees();
    if (!(elevation > 0.0 && elevation < 90.0))
        throw InvalidInput("the viewer's elevation", "it is not between 0 and 90 degrees", "give one in between");
    return ResolutionMeter(rig, options, progress).measure();
}

const ShapeMetric& metricOf(const ShapeResolution& resolution, std::string_view key) {
    for (const ShapeMetric& metric : resolution.metrics)
        if (metric.key == key) return metric;
    throw InvalidInput(inQuotes(key), "there is no such feature of shape resolution", "use a key of the ten");
}

std::string inUsualUnit(const std::optional<double>& value, std::string_view unit) {
    if (!value) return "-";
    double scale = 1.0;
    const char* name = "";
    if (unit == "m2") scale = 1e4, name = " cm2";
    if (unit == "1/m2") scale = 1e-4, name = "/cm2";
    if (unit == "m") scale = 1e3, name = " mm";
    if (unit == "1/m") name = "/m";
    if (unit == "N") name = " N";
    if (unit == "m/s") scale = 1e3, name = " mm/s";
    const double shown = *value * scale;
    char text[48];
    std::snprintf(text, sizeof text, std::abs(shown) >= 100.0 || shown == std::floor(shown) ? "%.0f%s" : "%.3g%s",
                  shown, name);
    return text;
}

} // namespace lumorph
