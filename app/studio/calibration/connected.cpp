#include "app/studio/calibration/connected.h"

#include <algorithm>
#include <string>

#include <QObject>
#include <QStringList>

#include "app/studio/calibration/live_service.h"
#include "calibration/capture/capture_camera.h"

namespace lumorph::studio {
namespace {

constexpr double kSeenNow = 1.0; // seconds since a body was seen last

ConnectedPart namedPart(const QString& kind, const QString& title, ConnectedPart::Place place) {
    ConnectedPart part;
    part.kind = kind;
    part.title = title;
    part.place = place;
    return part;
}

QString pixelsWords(const glm::ivec2& size) { return QObject::tr("%1 × %2 pixels").arg(size.x).arg(size.y); }

ConnectedPart projectorPart(const InstalledProjector& projector, const ConnectedFacts::Output& output,
                            std::size_t number) {
    ConnectedPart part = namedPart(QString("projector%1").arg(number + 1), QObject::tr("Projector %1").arg(number + 1),
                                   ConnectedPart::Place::setup);
    const QString pixels = pixelsWords(projector.camera.size);
    const QString remedy = QObject::tr("in Projector and camera choose Camera, then the screen of this projector");
    part.state = output.isShown ? ConnectedPart::State::needsYou : ConnectedPart::State::missing;
    if (!output.isShown)
        part.text = QObject::tr("Its picture of %1 is not shown: %2.").arg(pixels, remedy);
    else if (output.screen.isEmpty())
        part.text = QObject::tr("Its picture of %1 is shown in a window: %2.").arg(pixels, remedy);
    else if (!output.problem.isEmpty())
        part.text = QObject::tr("It is shown on screen %1, but %2.").arg(output.screen, output.problem);
    else {
        part.state = ConnectedPart::State::ready;
        part.text = QObject::tr("Its picture of %1 is shown on screen %2, pixel by pixel.").arg(pixels, output.screen);
    }
    return part;
}

std::vector<ConnectedPart> projectorParts(const ConnectedFacts& facts) {
    std::vector<ConnectedPart> parts;
    for (std::size_t k = 0; k < facts.room.projectors.size(); ++k)
        if (facts.room.projectors[k].enabled)
            parts.push_back(projectorPart(facts.room.projectors[k],
                                          k < facts.outputs.size() ? facts.outputs[k] : ConnectedFacts::Output(), k));
    if (!parts.empty()) return parts;
    parts.push_back(namedPart("projector1", QObject::tr("Projector"), ConnectedPart::Place::scene));
    parts.front().text = facts.room.projectors.empty()
                             ? QObject::tr("The room has no projector: add one in Scene.")
                             : QObject::tr("All projectors of the room are switched off: switch one on in Scene.");
    return parts;
}

QString otherCameras(const std::vector<InstalledCamera>& cameras) {
    QStringList others;
    for (std::size_t k = 1; k < cameras.size(); ++k) {
        const QString name = QString::fromStdString(cameras[k].name);
        others << (cameras[k].address.empty()
                       ? name
                       : QString("%1 (%2)").arg(name, QString::fromStdString(cameras[k].address)));
    }
    return others.isEmpty() ? QString() : ' ' + QObject::tr("Also in the room: %1.").arg(others.join(", "));
}

/// Stages measure with the room's first camera.
ConnectedPart cameraPart(const ConnectedFacts& facts) {
    ConnectedPart part = namedPart("camera", QObject::tr("Camera"), ConnectedPart::Place::setup);
    const auto& cameras = facts.room.cameras;
    const std::string address = cameras.empty() ? std::string() : cameras.front().address;
    const QString shown = QString::fromStdString(address);
    if (address.empty()) {
        part.state = ConnectedPart::State::lab;
        part.isSimulated = true;
        part.text = QObject::tr("None of this machine: the virtual lab has one. For your own, choose Camera in "
                                "Projector and camera, and calibrate with it.");
    } else if (!facts.isCameraPresent) {
        part.text = QObject::tr("There is none at %1: plug it in, or calibrate with another one in Projector and "
                                "camera.")
                        .arg(shown);
    } else {
        part.state = ConnectedPart::State::ready;
        part.isSimulated = isSimulatedCamera(address);
        part.text =
            QObject::tr("%1 at %2, calibrated for %3; it is opened to measure.")
                .arg(QString::fromStdString(cameras.front().name), shown, pixelsWords(cameras.front().camera.size));
    }
    part.text += otherCameras(cameras);
    return part;
}

/// "natnet://192.168.0.5 sends 120 frames a second, 8 ms after the cameras saw them."
QString trackerWords(const TrackerStatus& tracker) {
    const QString address = QString::fromStdString(tracker.address);
    if (!tracker.receiving) {
        QString advice = QString::fromStdString(tracker.advice);
        if (!advice.isEmpty()) advice = ' ' + advice.left(1).toUpper() + advice.mid(1);
        if (!advice.isEmpty() && !advice.back().isPunct()) advice += '.';
        return QObject::tr("Nothing arrives from %1.").arg(address) + advice;
    }
    const QString rate = QString::number(tracker.framesPerSecond, 'f', 0);
    if (!tracker.latencyMilliseconds) return QObject::tr("%1 sends %2 frames a second.").arg(address, rate);
    return QObject::tr("%1 sends %2 frames a second, %3 ms after the cameras saw them.")
        .arg(address, rate, QString::number(*tracker.latencyMilliseconds, 'f', 0));
}

/// All trackers together: each may see another body.
ConnectedPart trackerPart(const ConnectedFacts& facts) {
    ConnectedPart part =
        namedPart("tracker", facts.trackers.size() > 1 ? QObject::tr("Trackers") : QObject::tr("Tracker"),
                  ConnectedPart::Place::devices);
    if (facts.trackers.empty()) {
        part.text = QObject::tr("None is connected: open one in Devices, and say there which bodies are pointer, "
                                "device and head.");
        return part;
    }
    const QString both = QObject::tr(" and ");
    QStringList sentences, seen, unseen, twice, others;
    bool isReceiving = true;
    for (const TrackerStatus& tracker : facts.trackers) {
        sentences << trackerWords(tracker);
        isReceiving = isReceiving && tracker.receiving;
        part.isSimulated = part.isSimulated || isSimulatedTracker(tracker.address, tracker.source);
    }
    for (const PoseRole role : {PoseRole::pointer, PoseRole::device, PoseRole::head}) {
        QStringList names;
        for (const SeenBody& body : facts.bodies)
            if (body.role == role && body.age < kSeenNow) names << QString::fromStdString(body.name);
        if (names.isEmpty())
            unseen << wordOf(role);
        else
            seen << QObject::tr("%1 as %2").arg(names.join(both), wordOf(role));
        if (names.size() > 1) twice << wordOf(role);
    }
    for (const SeenBody& body : facts.bodies)
        if (!body.role && body.age < kSeenNow) others << QString::fromStdString(body.name);
    if (!seen.isEmpty()) sentences << QObject::tr("Seen: %1.").arg(seen.join(", "));
    if (!others.isEmpty()) sentences << QObject::tr("Without a role: %1.").arg(others.join(", "));
    if (!twice.isEmpty())
        sentences << QObject::tr("Two bodies are the %1: give one of them no role in Devices.").arg(twice.join(both));
    if (!unseen.isEmpty())
        sentences << QObject::tr("Not seen: %1. Bring what is missing into sight, or say in Devices which body it is.")
                         .arg(unseen.join(both));
    part.text = sentences.join(' ');
    const bool isReady = isReceiving && unseen.isEmpty() && twice.isEmpty();
    part.state = isReady ? ConnectedPart::State::ready : ConnectedPart::State::needsYou;
    return part;
}

ConnectedPart devicePart(const ConnectedFacts& facts) {
    ConnectedPart part = namedPart("device", QObject::tr("Device"), ConnectedPart::Place::rig);
    if (!facts.rig) {
        part.text = QObject::tr("No rig is open: open that of the device on the table.");
        return part;
    }
    part.state = ConnectedPart::State::ready;
    part.text = QObject::tr("The rig %1 with %2 servos is open.").arg(*facts.rig, QString::number(facts.servos));
    return part;
}

/// What keeps servos from being driven, with what to do.
QString servosObstacle(const LinkStatus& link) {
    switch (link.phase) {
    case LinkPhase::off:
        return QObject::tr("connect their controller in Devices, and start them there");
    case LinkPhase::connecting:
    case LinkPhase::handshake:
        return QObject::tr("their controller has not answered yet; Devices says why");
    case LinkPhase::unidentified:
        return QObject::tr("confirm in Devices that the board is theirs");
    case LinkPhase::disarmed:
        return QObject::tr("start them in Devices");
    case LinkPhase::starting:
    case LinkPhase::live:
        break;
    case LinkPhase::stopped:
        return QObject::tr("they were stopped; start them again in Devices");
    case LinkPhase::lost:
        return QObject::tr("the link to their controller is lost; Devices says why");
    }
    if (!link.controller.answering) return QObject::tr("their controller does not answer; Devices says why");
    return link.waiting.empty() ? QObject::tr("they start one after the other; Devices shows each")
                                : QObject::tr("the others wait in Devices for your consent to start");
}

ConnectedPart servosPart(const ConnectedFacts& facts) {
    ConnectedPart part = namedPart("servos", QObject::tr("Servos"), ConnectedPart::Place::devices);
    if (!facts.rig) {
        part.place = ConnectedPart::Place::rig;
        part.text = QObject::tr("The rig says which servos there are: open one first.");
        return part;
    }
    const LinkStatus& link = facts.link;
    const auto driven = static_cast<std::size_t>(std::ranges::count_if(link.servos, &ServoStatus::attached));
    const QString counts =
        QObject::tr("%1 of %2 are driven").arg(QString::number(driven), QString::number(facts.servos));
    part.isSimulated = link.phase != LinkPhase::off && facts.isControllerSimulated;
    if (link.phase == LinkPhase::live && link.controller.answering && driven >= facts.servos) {
        part.state = ConnectedPart::State::ready;
        part.text = QObject::tr("%1, by %2.").arg(counts, facts.controller);
        if (link.controller.volts)
            part.text +=
                ' ' + QObject::tr("Its battery has %1 V.").arg(QString::number(*link.controller.volts, 'f', 1));
    } else {
        if (link.phase != LinkPhase::off) part.state = ConnectedPart::State::needsYou;
        part.text = QObject::tr("%1: %2.").arg(counts, servosObstacle(link));
    }
    return part;
}

} // namespace

std::vector<ConnectedPart> connectedParts(const ConnectedFacts& facts) {
    std::vector<ConnectedPart> parts = projectorParts(facts);
    parts.push_back(cameraPart(facts));
    parts.push_back(trackerPart(facts));
    parts.push_back(devicePart(facts));
    parts.push_back(servosPart(facts));
    for (ConnectedPart& part : parts)
        if (part.isSimulated && part.state != ConnectedPart::State::lab) part.text += ' ' + QObject::tr("Simulated.");
    return parts;
}

QString wordOf(ConnectedPart::State state) {
    switch (state) {
    case ConnectedPart::State::ready:
        return QObject::tr("Ready");
    case ConnectedPart::State::needsYou:
        return QObject::tr("Needs you");
    case ConnectedPart::State::lab:
        return QObject::tr("Virtual lab");
    case ConnectedPart::State::missing:
        break;
    }
    return QObject::tr("Missing");
}

QString buttonOf(ConnectedPart::Place place) {
    switch (place) {
    case ConnectedPart::Place::setup:
        return QObject::tr("Projector and camera");
    case ConnectedPart::Place::scene:
        return QObject::tr("Open Scene");
    case ConnectedPart::Place::rig:
        return QObject::tr("Open rig...");
    case ConnectedPart::Place::devices:
        break;
    }
    return QObject::tr("Open Devices");
}

ConnectedSummary connectedSummary(const std::vector<ConnectedPart>& parts) {
    const auto next = std::ranges::find_if(parts, [](const ConnectedPart& part) {
        return part.state == ConnectedPart::State::missing || part.state == ConnectedPart::State::needsYou;
    });
    if (next != parts.end())
        return {StepTone::live, QObject::tr("Next: %1").arg(next->title.toLower()), next->text, buttonOf(next->place),
                next->place};
    QStringList simulated;
    for (const ConnectedPart& part : parts)
        if (part.isSimulated) simulated << part.title.toLower();
    return {StepTone::good, QObject::tr("Nothing is missing"),
            simulated.isEmpty() ? QObject::tr("Nothing of it says that it is simulated.")
                                : QObject::tr("Simulated: %1. What is measured with that stays marked as simulated.")
                                      .arg(simulated.join(", ")),
            QObject::tr("Go on with the chain"), std::nullopt};
}

} // namespace lumorph::studio
