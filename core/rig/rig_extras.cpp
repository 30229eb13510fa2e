#include "core/rig/rig_extras.h"

#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/error.h"

namespace lumorph {

using nlohmann::json;

void EntryPlace::fail(const std::string& why, const std::string& remedy) const {
    throw DataError(entry.empty() ? file : file + ", " + entry, why, remedy);
}

namespace {

/// Reads the members of one entry, naming the key in every error.
class Members {
public:
    Members(const json& object, const EntryPlace& place) : object_(object), place_(place) {}

    [[nodiscard]] bool has(const char* key) const { return object_.contains(key) && !object_[key].is_null(); }

    [[nodiscard]] std::string text(const char* key, const char* remedy) const {
        if (!has(key)) place_.fail(std::string("\"") + key + "\" is missing", remedy);
        if (!object_[key].is_string()) place_.fail(std::string("\"") + key + "\" is not a text", remedy);
        return object_[key].get<std::string>();
    }
    [[nodiscard]] double number(const char* key, double otherwise) const {
        if (!has(key)) return otherwise;
        return finite(object_[key], key, "give a finite number");
    }
    [[nodiscard]] double number(const char* key, const char* remedy) const {
        if (!has(key)) place_.fail(std::string("\"") + key + "\" is missing", remedy);
        return finite(object_[key], key, remedy);
    }
    [[nodiscard]] int integer(const char* key, int otherwise) const {
        const double value = number(key, otherwise);
        if (value != std::floor(value) || std::abs(value) > 1e9)
            place_.fail(std::string("\"") + key + "\" is not a whole number", "give a whole number");
        return static_cast<int>(value);
    }
    template <std::size_t N> [[nodiscard]] std::array<double, N> numbers(const char* key, const char* remedy) const {
        if (!has(key)) place_.fail(std::string("\"") + key + "\" is missing", remedy);
        const json& list = object_[key];
        if (!list.is_array() || list.size() != N)
            place_.fail(std::string("\"") + key + "\" is not a list of " + std::to_string(N) + " numbers", remedy);
        std::array<double, N> values{};
        for (std::size_t k = 0; k < N; ++k) values[k] = finite(list[k], key, remedy);
        return values;
    }
    [[nodiscard]] PulseCurve curve(const char* key) const {
        constexpr const char* kRemedy = "give 2 to 65 numbers that rise from 0 to 1";
        PulseCurve curve;
        for (const json& value : object_[key]) {
            curve.push_back(finite(value, key, kRemedy));
            if (curve.size() > kMostCurvePoints) break;
        }
        if (curve.empty() || !isPulseCurve(curve))
            place_.fail(std::string("\"") + key + "\" does not rise from 0 to 1", kRemedy);
        return curve;
    }
    [[nodiscard]] glm::vec3 direction(const char* key) const {
        const auto v = numbers<3>(key, "give three numbers in the node's frame, for example [1, 0, 0]");
        const glm::vec3 vector(v[0], v[1], v[2]);
        if (!(glm::length(vector) > 1e-6F) || !std::isfinite(glm::length(vector)))
            place_.fail(std::string("\"") + key + "\" has no direction", "give three finite numbers, not all zero");
        return vector;
    }
    [[nodiscard]] std::array<double, 2> range(const char* remedy) const {
        const auto range = numbers<2>("range", remedy);
        if (!(range[0] < range[1]))
            place_.fail("\"range\" is empty or runs backwards",
                        "put the smaller number first; to move the other way turn the axis round");
        return range;
    }
    [[nodiscard]] const json& raw(const char* key) const { return object_[key]; }

private:
    [[nodiscard]] double finite(const json& value, const char* key, const char* remedy) const {
        if (!value.is_number() || !std::isfinite(value.get<double>()))
            place_.fail(std::string("\"") + key + "\" is not a finite number", remedy);
        return value.get<double>();
    }

    const json& object_;
    const EntryPlace& place_;
};

constexpr const char* kDeformers = "use hinge, bend, slide, morph, joint or lever";
constexpr const char* kDegrees = "give two numbers in degrees, for example [0, 90]";
constexpr const char* kMetres = "give two numbers in metres, for example [0, 0.05]";

/// Directions of an untouched node stay bit for bit what the file says.
glm::vec3 turned(const glm::mat4& worldFromNode, const glm::vec3& vector) {
    const glm::mat3 linear(worldFromNode);
    return linear == glm::mat3(1.0F) ? vector : linear * vector;
}

/// Fills deformer and range; returns how much of the file's velocity unit the full stroke is.
double readDeformer(const std::string& kind, const Members& members, const glm::mat4& world, int joint,
                    ActuatorEntry& entry) {
    const glm::vec3 origin(world[3]);
    if (kind == "hinge") {
        const auto range = members.range(kDegrees);
        entry.actuator.deformer =
            Hinge{origin, turned(world, members.direction("axis")), Angle::degrees(range[0]), Angle::degrees(range[1])};
        return range[1] - range[0];
    }
    if (kind == "bend") {
        const auto range = members.range(kDegrees);
        entry.actuator.deformer = Bend{origin,
                                       turned(world, members.direction("axis")),
                                       turned(world, members.direction("direction")),
                                       members.number("length", "give the length of the arc in metres"),
                                       Angle::degrees(range[0]),
                                       Angle::degrees(range[1])};
        return range[1] - range[0];
    }
    if (kind == "slide") {
        const auto range = members.range(kMetres);
        entry.actuator.deformer = Slide{turned(world, members.direction("direction")), range[0], range[1]};
        return range[1] - range[0];
    }
    if (kind == "joint") {
        if (joint < 0)
            entry.place.fail("it is not a joint of the model's skin", "put the entry on a joint, or use a hinge");
        const std::string motion = members.has("motion") ? members.text("motion", "use rotate or translate") : "rotate";
        if (motion != "rotate" && motion != "translate")
            entry.place.fail("the motion \"" + motion + "\" is not known", "use rotate or translate");
        const bool turns = motion == "rotate";
        const auto range = members.range(turns ? kDegrees : kMetres);
        const auto inside = [&](double value) { return turns ? Angle::degrees(value).inRadians() : value; };
        entry.actuator.deformer = SkinJoint{joint, turns ? SkinJoint::Motion::rotate : SkinJoint::Motion::translate,
                                            members.direction("axis"), inside(range[0]), inside(range[1])};
        return range[1] - range[0];
    }
    if (kind == "lever") {
        const auto range = members.range(kDegrees);
        entry.actuator.deformer =
            SheetLift{members.integer("gridAxis", -1), Angle::degrees(range[0]), Angle::degrees(range[1]),
                      members.has("torque") ? members.number("torque", "give it in newton metres") : 0.0};
        return range[1] - range[0];
    }
    if (kind != "morph") entry.place.fail("the deformer \"" + kind + "\" is not known", kDeformers);
    MorphTarget morph;
    morph.keys = {1.0F};
    if (members.has("targets")) {
        const json& targets = members.raw("targets");
        const json keys = members.has("keys") ? members.raw("keys") : json();
        if (!targets.is_array() || !keys.is_array() || targets.size() != keys.size() || targets.empty())
            entry.place.fail("\"targets\" and \"keys\" are not two lists of the same length",
                             "give each target its stroke");
        morph.keys.clear();
        for (std::size_t k = 0; k < targets.size(); ++k) {
            if (!targets[k].is_string() || !keys[k].is_number())
                entry.place.fail("\"targets\" are not names or \"keys\" not numbers", "give each target its stroke");
            entry.targets.push_back(targets[k].get<std::string>());
            morph.keys.push_back(keys[k].get<float>());
        }
    } else {
        entry.targets = {members.text("target", "name the morph target")};
    }
    morph.target = members.has("target") ? members.text("target", "name the morph target") : entry.targets.back();
    entry.actuator.deformer = std::move(morph);
    if (members.has("range")) {
        const auto range = members.range("give two weights, for example [0, 1]");
        entry.weightMin = range[0];
        entry.weightMax = range[1];
    }
    return entry.weightMax - entry.weightMin;
}

/// The number of degrees that gives back exactly this angle, the shortest where it has few digits. Not every angle has
/// one: then that of the nearest angle which has, so that what is read and written again does not change any more.
double tidyDegrees(double radians) {
    const auto meets = [&radians](double degrees) { return Angle::degrees(degrees).inRadians() == radians; };
    for (int attempt = 0; attempt < 2; ++attempt) {
        const double degrees = Angle::radians(radians).inDegrees();
        const double tidy = std::round(degrees * 1e6) / 1e6;
        if (meets(tidy)) return tidy;
        double below = degrees;
        double above = degrees;
        for (int step = 0; step < 4; ++step) { // rounding moves it by no more
            if (meets(below)) return below;
            if (meets(above)) return above;
            below = std::nextafter(below, -INFINITY);
            above = std::nextafter(above, INFINITY);
        }
        radians = Angle::degrees(degrees).inRadians();
    }
    return Angle::radians(radians).inDegrees();
}

json triple(const glm::vec3& v) { return {v.x, v.y, v.z}; }

/// The velocity in the file's unit that reads back as this many strokes a second.
double tidyVelocity(double strokesPerSecond, double range) {
    const double velocity = strokesPerSecond * range;
    const double tidy = std::round(velocity * 1e9) / 1e9;
    return tidy / range == strokesPerSecond ? tidy : velocity;
}

struct DeformerWriter {
    json& out;

    double degrees(double min, double max) const {
        out["range"] = {tidyDegrees(min), tidyDegrees(max)};
        return tidyDegrees(max) - tidyDegrees(min);
    }
    double operator()(const Hinge& hinge) const {
        out["deformer"] = "hinge";
        out["axis"] = triple(hinge.axis);
        return degrees(hinge.min.inRadians(), hinge.max.inRadians());
    }
    double operator()(const Bend& bend) const {
        out["deformer"] = "bend";
        out["axis"] = triple(bend.axis);
        out["direction"] = triple(bend.direction);
        out["length"] = bend.length;
        return degrees(bend.min.inRadians(), bend.max.inRadians());
    }
    double operator()(const Slide& slide) const {
        out["deformer"] = "slide";
        out["direction"] = triple(slide.direction);
        out["range"] = {slide.min, slide.max};
        return slide.max - slide.min;
    }
    double operator()(const MorphTarget&) const {
        out["deformer"] = "morph";
        return 1.0;
    }
    double operator()(const SkinJoint& joint) const {
        out["deformer"] = "joint";
        out["axis"] = triple(joint.axis);
        const bool turns = joint.motion == SkinJoint::Motion::rotate;
        out["motion"] = turns ? "rotate" : "translate";
        if (turns) return degrees(joint.min, joint.max);
        out["range"] = {joint.min, joint.max};
        return joint.max - joint.min;
    }
    double operator()(const SheetLift& lift) const {
        out["deformer"] = "lever";
        out["gridAxis"] = lift.axis;
        if (lift.torque > 0.0) out["torque"] = lift.torque;
        return degrees(lift.min.inRadians(), lift.max.inRadians());
    }
};

} // namespace

ActuatorEntry readActuatorEntry(const json& extras, const EntryPlace& place, const glm::mat4& worldFromNode,
                                int joint) {
    if (!extras.is_object())
        place.fail("\"lumorph\" is not an object", "write it as {\"actuator\": ..., \"deformer\": ...}");
    const Members members(extras, place);
    ActuatorEntry entry;
    entry.place = place;
    Actuator& actuator = entry.actuator;
    actuator.name = members.text("actuator", "give the actuator a name");
    entry.place.entry += (place.entry.empty() ? "actuator \"" : ", actuator \"") + actuator.name + "\"";
    const Members named(extras, entry.place);
    const std::string kind = named.text("deformer", kDeformers);
    const double range = readDeformer(kind, named, worldFromNode, joint, entry);
    entry.order = named.integer("order", -1);
    actuator.levels = named.integer("levels", actuator.levels);
    if (actuator.levels < 2 || actuator.levels > kMaxLevels)
        entry.place.fail("\"levels\" is out of range", "use 2 to 200 levels");
    actuator.maxVelocity = named.number("maxVelocity", range) / range;
    if (!(actuator.maxVelocity > 0.0))
        entry.place.fail("\"maxVelocity\" is not above zero",
                         "give the speed of the servo, as much as the range a second");
    actuator.dampingRatio = named.number("damping", 1.0);
    actuator.drive.channel = named.integer("channel", -1);
    if (named.has("pulse")) {
        const auto pulse = named.numbers<2>("pulse", "give two pulse widths in microseconds, for example [1000, 2000]");
        actuator.drive.pulseMin = pulse[0];
        actuator.drive.pulseMax = pulse[1];
    }
    if (named.has("pulseCurve")) actuator.drive.curve = named.curve("pulseCurve");
    // One that this version's table lacks is kept all the same.
    if (named.has("servo")) actuator.drive.servo = named.text("servo", "name the kind of servo, for example SG90");
    return entry;
}

json actuatorExtras(const Actuator& actuator, std::size_t order) {
    json out{
        {"actuator", actuator.name}, {"order", order}, {"levels", actuator.levels}, {"damping", actuator.dampingRatio}};
    const double range = std::visit(DeformerWriter{out}, actuator.deformer);
    out["maxVelocity"] = tidyVelocity(actuator.maxVelocity, range);
    out["channel"] = actuator.drive.channel;
    out["pulse"] = {actuator.drive.pulseMin, actuator.drive.pulseMax};
    if (!actuator.drive.curve.empty()) out["pulseCurve"] = actuator.drive.curve;
    if (!actuator.drive.servo.empty()) out["servo"] = actuator.drive.servo;
    return out;
}

} // namespace lumorph
