#include "core/scene/installation.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace lumorph {
namespace {

bool sameLens(const CalibratedCamera& a, const CalibratedCamera& b) {
    return a.size == b.size && a.focal == b.focal && a.principal == b.principal && a.distortion == b.distortion;
}

bool sameResponse(const InstalledProjector& a, const InstalledProjector& b) {
    return a.referenceDistance == b.referenceDistance && a.peak == b.peak && a.gain == b.gain && a.gamma == b.gamma &&
           a.black == b.black && a.responseCurve == b.responseCurve;
}

/// An edit that comes with an origin of its own, as a calibration does, keeps it.
void mark(bool same, const Origin& before, Origin& edited, const Origin& origin) {
    if (!same && edited == before) edited = origin;
}

/// What a part was before an edit. Parts are known by their names, since one may have been added or taken away before
/// others; of several that are called the same, the one that has not changed is meant.
template <class Part> const Part* partBefore(const std::vector<Part>& parts, const Part& wanted, std::size_t index) {
    const Part* named = nullptr;
    for (const Part& part : parts) {
        if (part.name != wanted.name) continue;
        if (part == wanted) return &part;
        if (!named) named = &part;
    }
    if (index < parts.size() && (!named || parts[index].name == wanted.name)) return &parts[index];
    return named;
}

/// A servo has two figures of two measurements: its curve, and its lag, which is one of the delays.
std::vector<MeasuredServo> curvesOf(std::vector<MeasuredServo> servos) {
    std::erase_if(servos, [](const MeasuredServo& servo) { return servo.points.empty(); });
    for (MeasuredServo& servo : servos) servo.lagSeconds = 0.0;
    return servos;
}

std::vector<MeasuredServo> lagsOf(std::vector<MeasuredServo> servos) {
    std::erase_if(servos, [](const MeasuredServo& servo) { return servo.lagSeconds == 0.0; });
    for (MeasuredServo& servo : servos) servo.points.clear();
    return servos;
}

} // namespace

Installation figuresOf(Installation installation) {
    installation.origins = {};
    installation.eye = {};
    for (InstalledProjector& projector : installation.projectors)
        projector.lens = projector.pose = projector.response = {};
    for (InstalledCamera& camera : installation.cameras) camera.lens = camera.pose = {};
    return installation;
}

bool isSameRoom(const Installation& a, const Installation& b) { return figuresOf(a) == figuresOf(b); }

void markOrigins(const Installation& before, Installation& edited, const Origin& origin) {
    for (std::size_t i = 0; i < edited.projectors.size(); ++i) {
        InstalledProjector& now = edited.projectors[i];
        const InstalledProjector* then = partBefore(before.projectors, now, i);
        if (!then) continue; // a new one says itself where it came from
        mark(sameLens(then->camera, now.camera), then->lens, now.lens, origin);
        mark(then->camera.cameraFromWorld == now.camera.cameraFromWorld, then->pose, now.pose, origin);
        mark(sameResponse(*then, now), then->response, now.response, origin);
    }
    for (std::size_t i = 0; i < edited.cameras.size(); ++i) {
        InstalledCamera& now = edited.cameras[i];
        const InstalledCamera* then = partBefore(before.cameras, now, i);
        if (!then) continue;
        mark(sameLens(then->camera, now.camera), then->lens, now.lens, origin);
        mark(then->camera.cameraFromWorld == now.camera.cameraFromWorld, then->pose, now.pose, origin);
    }
    const Installation::Origins& then = before.origins;
    Installation::Origins& now = edited.origins;
    mark(before.tableSize == edited.tableSize, then.table, now.table, origin);
    mark(before.worldFromDevice == edited.worldFromDevice, then.devicePlace, now.devicePlace, origin);
    mark(before.deviceColor == edited.deviceColor && before.tableColor == edited.tableColor, then.colors, now.colors,
         origin);
    mark(before.eyeFromHead == edited.eyeFromHead, then.eyeOffset, now.eyeOffset, origin);
    mark(before.predictionSeconds == edited.predictionSeconds && before.trackerSeconds == edited.trackerSeconds &&
             lagsOf(before.servos) == lagsOf(edited.servos),
         then.delays, now.delays, origin);
    mark(before.worldFromTracker == edited.worldFromTracker, then.tracker, now.tracker, origin);
    mark(before.bodyFromDevice == edited.bodyFromDevice, then.deviceBody, now.deviceBody, origin);
    mark(before.pointerTip == edited.pointerTip, then.pointer, now.pointer, origin);
    mark(curvesOf(before.servos) == curvesOf(edited.servos), then.servos, now.servos, origin);
}

namespace {

/// Each origin that an installation has, with the part it is of.
template <class Room, class Use> void eachOrigin(Room& room, const Use& use) {
    for (auto& projector : room.projectors) {
        use("lens of " + projector.name, projector.lens);
        use("place of " + projector.name, projector.pose);
        use("light of " + projector.name, projector.response);
    }
    for (auto& camera : room.cameras) {
        use("lens of " + camera.name, camera.lens);
        use("place of " + camera.name, camera.pose);
    }
    auto& origins = room.origins;
    use("table", origins.table);
    use("place of the device", origins.devicePlace);
    use("colours", origins.colors);
    use("eye", origins.eyeOffset);
    use("delays", origins.delays);
    use("tracker", origins.tracker);
    use("device on its body", origins.deviceBody);
    use("pointer", origins.pointer);
    use("servos", origins.servos);
}

} // namespace

namespace {

/// Calls `use` with each origin of `made` that says measured and was not in `before`.
template <class Use> void eachMeasured(const Installation& before, Installation& made, const Use& use) {
    std::vector<Origin> known;
    eachOrigin(before, [&known](const std::string&, const Origin& origin) { known.push_back(origin); });
    eachOrigin(made, [&](const std::string&, Origin& origin) {
        if (origin.way == Origin::Way::measured && std::ranges::find(known, origin) == known.end()) use(origin);
    });
}

} // namespace

void markSimulated(const Installation& before, Installation& made) {
    eachMeasured(before, made, [](Origin& origin) { origin.way = Origin::Way::simulated; });
}

void markRecorded(const Installation& before, Installation& made, const std::string& who, const std::string& date) {
    eachMeasured(before, made, [&](Origin& origin) {
        origin.way = Origin::Way::recorded;
        if (!who.empty()) origin.method = "recorded by " + who + ": " + origin.method; // sigmas stay at the end
        origin.date = date;
    });
}

std::vector<std::string> realParts(const Installation& room) {
    std::vector<std::string> parts;
    eachOrigin(room, [&parts](const std::string& part, const Origin& origin) {
        if (origin.way != Origin::Way::assumed && origin.way != Origin::Way::simulated) parts.push_back(part);
    });
    return parts;
}

std::string utcDate() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
    gmtime_r(&now, &parts);
    char text[32];
    const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return {text, length};
}

} // namespace lumorph
