#include "calibration/verify/room_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr double kShare95 = 0.95;
constexpr double kLeastCosine = 0.15;     // of a beam with the surface: else its light is smeared
constexpr double kMostUnexplained = 2e-3; // metres
constexpr double kFewestFitting = 0.5;    // of the points
constexpr std::size_t kFewestLitPoints = 60;
constexpr const char* kMethod = "check by structured light";

std::string millimetres(double metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f mm", 1e3 * metres);
    return text;
}

/// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& words, const char* last) {
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i)
        all += (i == 0 ? "" : i + 1 == words.size() ? std::string(" ") + last + " " : std::string(", ")) + words[i];
    return all;
}

/// Of what a show is about: the device, as long as it is seen.
const ErrorSummary& shownOn(const RoomCheck& check) {
    constexpr std::size_t kFewestOnDevice = 40;
    return check.device.places >= kFewestOnDevice ? check.device : check.now;
}

std::string lightWords(const RoomCheck& check) {
    const ErrorSummary& light = shownOn(check);
    return "light on the " + std::string(&light == &check.device ? "device" : "table") + " lies " +
           millimetres(light.median) + " beside where it is meant to be, " + millimetres(light.most) +
           " in the worst of 20 places.";
}

std::string sentenceOf(const RoomCheck& check) {
    if (check.verdict == RoomCheck::Verdict::good) return "Still good: " + lightWords(check);
    const std::string remedy = ": recalibrate, or take the correction from this check. Now " + lightWords(check);
    const std::string farthest = " by " + millimetres(check.found.parts.front().beside);
    if (!check.couldAlsoBe.empty()) {
        std::vector<std::string> any = check.names;
        any.insert(any.end(), check.couldAlsoBe.begin(), check.couldAlsoBe.end());
        return "Something has moved" + farthest + ": the " + listed(any, "or the") +
               ", which this capture does not tell apart; raise flaps, and check again.";
    }
    if (check.names.size() == 1) return "The " + check.names.front() + " has moved" + farthest + remedy;
    std::vector<std::string> moved;
    for (std::size_t i = 0; i < check.names.size(); ++i)
        moved.push_back(check.names[i] + " by " + millimetres(check.found.parts[i].beside));
    return "Several things have moved, the " + listed(moved, "and the") + remedy;
}

/// A servo's curve, shifted by what its actuator stands farther than it was believed to.
void shiftServo(Installation& room, const std::string& actuator, double farther) {
    auto servo = std::ranges::find(room.servos, actuator, &MeasuredServo::actuator);
    if (servo == room.servos.end())
        servo = room.servos.insert(servo, {actuator, {{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, 0.0});
    for (MeasuredServo::Point& point : servo->points) {
        point.rising += farther;
        point.falling += farther;
    }
}

std::vector<std::vector<double>> strokesWith(std::span<const LitShot> shots, const RoomParts& parts,
                                             const Eigen::VectorXd& motion) {
    std::vector<std::vector<double>> all;
    for (const LitShot& shot : shots) all.push_back(movedBy(shot.strokes, parts, motion));
    return all;
}

/// The error map of the show as it runs, and what would be left were it drawn for the room as it is.
void drawMaps(RoomCheck& check, const Rig& rig, const Installation& believed, std::span<const LitShot> shots,
              std::size_t camera) {
    const RoomParts parts = partsOf(believed, rig);
    const Installation is = movedBy(believed, parts, check.found.motion, camera);
    const auto strokes = strokesWith(shots, parts, check.found.motion);
    double most = 3e-3; // metres: beyond three times what parts moved there are strays only
    for (const PartMotion& moved : check.found.parts) most += 3.0 * moved.beside;
    check.map = lightErrors(rig, believed, is, shots, strokes, camera, most);
    std::vector<LightError> onDevice, onTable;
    for (const LightError& error : check.map) (error.isOnDevice ? onDevice : onTable).push_back(error);
    check.now = summaryOf(check.map);
    check.device = summaryOf(onDevice);
    check.table = summaryOf(onTable);
    std::vector<LitShot> redrawn(shots.begin(), shots.end());
    for (std::size_t s = 0; s < redrawn.size(); ++s) redrawn[s].strokes = strokes[s];
    check.corrected = summaryOf(lightErrors(rig, is, is, redrawn, strokes, camera, most));
}

std::size_t countOf(std::span<const LitShot> shots) {
    std::size_t count = 0;
    for (const LitShot& shot : shots) count += shot.points.size();
    return count;
}

} // namespace

const char* wordOf(RoomCheck::Verdict verdict) {
    return verdict == RoomCheck::Verdict::good ? "good" : verdict == RoomCheck::Verdict::moved ? "moved" : "none";
}

ErrorSummary summaryOf(std::span<const LightError> map) {
    ErrorSummary summary;
    if (map.empty()) return summary;
    std::vector<double> lengths;
    for (const LightError& error : map) lengths.push_back(glm::length(error.beside));
    std::ranges::sort(lengths);
    const auto at = [&](double share) {
        return lengths[static_cast<std::size_t>(share * static_cast<double>(lengths.size() - 1))];
    };
    return {at(0.5), at(kShare95), lengths.back(), lengths.size()};
}

std::vector<LightError> lightErrors(const Rig& rig, const Installation& believed, const Installation& is,
                                    std::span<const LitShot> shots, std::span<const std::vector<double>> strokes,
                                    std::size_t camera, double most) {
    std::vector<LightError> map;
    const CalibratedCamera& eye = is.cameras.at(camera).camera;
    for (std::size_t s = 0; s < shots.size(); ++s) {
        const RoomSurface really(is, rig, strokes[s]);
        const RoomSurface meant(believed, rig, shots[s].strokes);
        for (const LitPoint& point : shots[s].points) {
            const auto seen = really.trace(positionOf(eye), directionOf(eye, point.camera));
            if (!seen) continue;
            const SurfacePoint place = meant.counterpart(really, *seen);
            const CalibratedCamera& lamp = believed.projectors.at(point.projector).camera;
            const glm::dvec3 beam = directionOf(lamp, point.panel);
            const double cosine = -glm::dot(beam, place.normal);
            if (cosine < kLeastCosine) continue;
            const glm::dvec3 from = positionOf(lamp);
            const double way = glm::dot(place.normal, place.point - from) / glm::dot(place.normal, beam);
            const glm::dvec3 beside = place.point - (from + way * beam);
            if (!(glm::length(beside) < most)) continue;
            map.push_back({s, point.projector, place.isOnDevice, place.point, beside});
        }
    }
    return map;
}

Installation correctedBy(const Installation& believed, const Rig& rig, const MovedParts& found, std::size_t camera) {
    const RoomParts parts = partsOf(believed, rig);
    Installation room = believed;
    if (found.motion.size() != parts.size()) return room;
    const Installation everything = movedBy(believed, parts, found.motion, camera);
    const Origin origin{Origin::Way::measured, kMethod, utcDate()};
    for (const PartMotion& moved : found.parts) {
        const RoomPart& part = moved.part;
        switch (part.kind) {
        case RoomPart::Kind::projector:
            room.projectors[part.index].camera.cameraFromWorld =
                everything.projectors[part.index].camera.cameraFromWorld;
            room.projectors[part.index].pose = origin;
            break;
        case RoomPart::Kind::camera:
            room.cameras[camera].camera.cameraFromWorld = everything.cameras[camera].camera.cameraFromWorld;
            room.cameras[camera].pose = origin;
            break;
        case RoomPart::Kind::device:
            room.worldFromDevice = everything.worldFromDevice;
            room.origins.devicePlace = origin;
            break;
        case RoomPart::Kind::servo:
            shiftServo(room, rig.actuators()[part.index].name, found.motion[part.first]);
            room.origins.servos = origin;
            break;
        }
    }
    return room;
}

void takeCorrections(const Installation& corrected, Installation& room) {
    // Dates of one form are in the order of their texts.
    const auto isNewer = [](const Origin& found, const Origin& known) {
        return found.isCalibrated() && found.method == kMethod && found.date >= known.date;
    };
    for (std::size_t i = 0; i < std::min(corrected.projectors.size(), room.projectors.size()); ++i) {
        const InstalledProjector& found = corrected.projectors[i];
        if (!isNewer(found.pose, room.projectors[i].pose)) continue;
        room.projectors[i].camera.cameraFromWorld = found.camera.cameraFromWorld;
        room.projectors[i].pose = found.pose;
    }
    for (std::size_t i = 0; i < std::min(corrected.cameras.size(), room.cameras.size()); ++i) {
        const InstalledCamera& found = corrected.cameras[i];
        if (!isNewer(found.pose, room.cameras[i].pose)) continue;
        room.cameras[i].camera.cameraFromWorld = found.camera.cameraFromWorld;
        room.cameras[i].pose = found.pose;
    }
    if (isNewer(corrected.origins.devicePlace, room.origins.devicePlace)) {
        room.worldFromDevice = corrected.worldFromDevice;
        room.origins.devicePlace = corrected.origins.devicePlace;
    }
    if (isNewer(corrected.origins.servos, room.origins.servos)) {
        room.servos = corrected.servos;
        room.origins.servos = corrected.origins.servos;
    }
}

RoomCheck withoutVerdict(const Installation& believed, NoVerdict reason) {
    RoomCheck check;
    check.sentence = "No verdict: " + sentenceOf(reason);
    check.obstacle = std::move(reason);
    check.installation = believed;
    return check;
}

RoomCheck checkRoom(const Rig& rig, const Installation& believed, std::span<const LitShot> shots,
                    const MovedPartOptions& options, const Progress& progress) {
    if (countOf(shots) < kFewestLitPoints)
        return withoutVerdict(believed, {Obstacle::covered, "the camera sees too little of the light",
                                         "clear its sight of device and table, and check again"});
    RoomCheck check;
    check.found = movedParts(rig, believed, shots, options, progress.part(0.0, 0.9));
    if (check.found.unexplained > kMostUnexplained ||
        static_cast<double>(check.found.points) < kFewestFitting * static_cast<double>(check.found.compared))
        return withoutVerdict(
            believed, {Obstacle::unexplained, "what the camera sees fits no motion of projector, camera or device",
                       "look whether the device is bent as said and nothing lies on it, else calibrate the "
                       "room again"});
    for (const PartMotion& moved : check.found.parts) check.names.push_back(nameOf(moved.part, believed, rig));
    for (const RoomPart& part : check.found.couldAlsoBe) check.couldAlsoBe.push_back(nameOf(part, believed, rig));
    check.verdict = check.found.parts.empty() ? RoomCheck::Verdict::good : RoomCheck::Verdict::moved;
    check.installation = check.couldAlsoBe.empty() ? correctedBy(believed, rig, check.found, options.camera) : believed;
    drawMaps(check, rig, believed, shots, options.camera);
    check.sentence = sentenceOf(check);
    progress.report(1.0, "checked");
    return check;
}

} // namespace lumorph
