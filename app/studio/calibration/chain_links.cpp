#include <algorithm>
#include <cmath>
#include <utility>

#include <QObject>

#include "app/studio/calibration/chain.h"
#include "app/studio/calibration/chain_files.h"
#include "app/studio/calibration/chain_live.h"

// The links themselves: what each is for, what happens, what it builds on, and how what came of it is read.

namespace lumorph::studio {
namespace {

QString millimetres(double metres) { return QString("%1 mm").arg(1e3 * metres, 0, 'f', 2); }

/// What is to be known of a measurement, whatever it is of; of one that was refused there is nothing else.
template <class Measured> LinkOutcome judged(const Measured& measured) {
    LinkOutcome outcome;
    outcome.isGood = measured.good();
    if (measured.refusal) {
        outcome.findings.push_back(wordsOf(*measured.refusal));
        outcome.summary = outcome.findings.front().title + ". " + outcome.findings.front().remedy;
    }
    for (const Finding& warning : measured.warnings) outcome.findings.push_back(wordsOf(warning));
    return outcome;
}

LinkOutcome outcomeOf(const Registration& measured) {
    LinkOutcome outcome = judged(measured);
    if (measured.refusal) {
        outcome.doubtsTracker =
            measured.refusal->cause == Cause::mirrored || measured.refusal->cause == Cause::wrongUnits;
        return outcome;
    }
    outcome.summary = QString::fromStdString(measured.summary);
    outcome.installation = measured.installation;
    const FreshCheck& fresh = measured.fresh;
    outcome.figures = {
        {QObject::tr("%1 check points, which the fit never saw: root mean square").arg(fresh.points.size()),
         millimetres(fresh.rms), fresh.rms <= fresh.allowed},
        {QObject::tr("The worst of them"), millimetres(fresh.worst), fresh.worst <= 2.5 * fresh.allowed},
        {QObject::tr("Residual of the fit"), millimetres(measured.rms)}};
    if (measured.shiftSigma > 0.0)
        outcome.figures.push_back(
            {QObject::tr("Uncertainty of the place"), QString("± %1").arg(millimetres(measured.shiftSigma))});
    if (measured.turnSigma > 0.0)
        outcome.figures.push_back({QObject::tr("Uncertainty of the direction"),
                                   QString("± %1°").arg(57.29577951308232 * measured.turnSigma, 0, 'f', 2)});
    const auto add = [&outcome](const std::vector<PointError>& points, bool isFresh) {
        for (const PointError& point : points)
            outcome.points.push_back({QString::fromStdString(point.name), 1e3 * point.metres, isFresh});
    };
    add(fresh.points, true);
    add(measured.points, false);
    return outcome;
}

/// A recording that is refused before anything is fitted is a refusal as any other.
template <auto Read> LinkOutcome recorded(const FileTask& task, const Progress& progress) {
    Registration refusal;
    try {
        return outcomeOf(Read(task, progress));
    } catch (const CaptureRefused& refused) {
        refusal.refusal = refused.finding();
    }
    return outcomeOf(refusal);
}

ChainLink projectorLink() {
    ChainLink link;
    link.id = LinkId::projector;
    link.key = "projector";
    link.title = QObject::tr("Projector and camera");
    link.purpose = QObject::tr("Where the light falls: without it nothing else can be measured.");
    link.how = {
        QObject::tr("A board is laid into the light, some poses one after the other, and photographed under patterns."),
        QObject::tr("It has a sequence of its own, which says at each step what to do.")};
    return link;
}

LinkOutcome outcomeOf(const PlacedDevices& measured) {
    LinkOutcome outcome = judged(measured);
    if (measured.refusal) return outcome;
    outcome.installation = measured.room;
    outcome.summary = QString::fromStdString(measured.summary);
    const auto pixels = [](double number) { return QString("%1 px").arg(number, 0, 'f', 2); };
    const HeldOutLight& all = measured.heldOut;
    if (all.points > 0)
        outcome.figures = {{QObject::tr("Light that the fit never saw lies beside: median"), millimetres(all.median)},
                           {QObject::tr("In 95 of 100 places at most"), millimetres(all.most)}};
    for (const PlacedDevices::Device& device : measured.devices) {
        const QString name = QString::fromStdString(device.name);
        outcome.figures.push_back({QObject::tr("%1: residual of the fit").arg(name), pixels(device.rms)});
        if (device.heldOut.points > 0)
            outcome.figures.push_back({QObject::tr("%1: held out").arg(name), pixels(device.heldOut.medianPixels)});
        if (device.shiftSigma > 0.0)
            outcome.figures.push_back({QObject::tr("%1: uncertainty of its place").arg(name),
                                       QString("± %1").arg(millimetres(device.shiftSigma))});
    }
    return outcome;
}

bool hasSeveral(const Installation& room) {
    const auto isOn = [](const InstalledProjector& projector) { return projector.enabled; };
    return std::ranges::count_if(room.projectors, isOn) > 1 || room.cameras.size() > 1;
}

bool isNeverWanted(const Installation&) { return false; }

ChainLink roomLink() {
    ChainLink link;
    link.stage = &calibrationStage("room");
    link.id = LinkId::room;
    link.key = "room";
    link.title = QObject::tr("All projectors and cameras");
    link.purpose = QObject::tr("Several projectors in one world: where their pictures overlap, they meet.");
    link.how = {QObject::tr("Lay the board flat on the table, where all projectors light it."),
                QObject::tr("Each projector lights it in turn, and the camera looks."),
                QObject::tr("Lay it otherwise, tilted to another side, six times; each new place is noticed by "
                            "itself. The last one checks the others.")};
    link.isWanted = hasSeveral;
    link.isOnTable = true;
    link.onTable = QObject::tr("It looks for the printed board that is chosen in Projector and camera.");
    return link;
}

ChainLink mirrorLink() {
    ChainLink link;
    link.stage = &calibrationStage("mirror");
    link.id = LinkId::mirror;
    link.key = "mirror";
    link.title = QObject::tr("Projector in a mirror");
    link.purpose = QObject::tr("In place of Projector and camera, where the camera sees the light in a mirror alone.");
    link.how = {QObject::tr("Lay the board flat on the table, and cover it from the camera: only the mirror shows it."),
                QObject::tr("Patterns are projected and photographed in the mirror."),
                QObject::tr("Then the mirror is covered, and the board itself is photographed where it lies."),
                QObject::tr("Six more times, tilted to other sides; the last one checks the others.")};
    link.isWanted = isNeverWanted;
    link.notConnected =
        QObject::tr("This version does not guide covering a mirror at the table: measure in the virtual "
                    "lab, from a recording, or from a folder of pictures on the command line.");
    return link;
}

ChainLink deviceAloneLink() {
    ChainLink link;
    link.stage = &calibrationStage("device");
    link.id = LinkId::deviceAlone;
    link.key = "device-alone";
    link.title = QObject::tr("Projectors by the device alone");
    link.purpose = QObject::tr("In place of Projector and camera, without a board: the device's own shape tells.");
    link.warning = QObject::tr("Hands off: the servos move");
    link.how = {QObject::tr("The device stays where it lies. Its servos were measured before."),
                QObject::tr("One actuator after the other rises; patterns are projected and photographed each time."),
                QObject::tr("At last all rise a little: that checks the others. STOP ends it at any time.")};
    link.needs = {LinkId::servos};
    link.isWanted = isNeverWanted;
    link.isOnTable = true;
    link.isMoved = true;
    return link;
}

QString percent(double share) { return QString("%1 %").arg(100.0 * share, 0, 'f', 1); }

LinkOutcome outcomeOf(const LightCalibration& measured) {
    LinkOutcome outcome = judged(measured);
    if (measured.refusal) return outcome;
    outcome.installation = measured.room;
    outcome.summary =
        QObject::tr("Greys that the fit never saw are met to %1 (before: %2). %3")
            .arg(percent(measured.fresh.median), percent(measured.before.median),
                 measured.hasWhiteSheet ? QObject::tr("White is what the sheet of paper is.")
                                        : QObject::tr("Without a white sheet the lighter of device and table counts as "
                                                      "white: its tint is among the projectors'."));
    outcome.figures = {{QObject::tr("Fresh greys: median"), percent(measured.fresh.median)},
                       {QObject::tr("In 95 of 100 places at most"), percent(measured.fresh.most)},
                       {QObject::tr("By what was believed before"), percent(measured.before.median)},
                       {QObject::tr("Exposures against the camera's curve"), percent(measured.responseRms)}};
    for (const InstalledProjector& projector : measured.room.projectors) {
        if (!projector.enabled) continue;
        const QString name = QString::fromStdString(projector.name);
        const glm::dvec3 gain(projector.gain);
        outcome.figures.push_back(
            {QObject::tr("%1: red, green, blue").arg(name),
             QString("%1 %2 %3").arg(gain.r, 0, 'f', 3).arg(gain.g, 0, 'f', 3).arg(gain.b, 0, 'f', 3)});
        outcome.figures.push_back({QObject::tr("%1: black, of white").arg(name),
                                   QString("%1 %").arg(100.0 * static_cast<double>(projector.black.g), 0, 'f', 2)});
    }
    return outcome;
}

ChainLink lightLink() {
    ChainLink link;
    link.isOnTable = true;
    link.onTable = QObject::tr("Where a sheet lies nobody knows here, so the lighter of device and table counts as "
                               "white.");
    link.stage = &calibrationStage("light");
    link.id = LinkId::light;
    link.key = "light";
    link.title = QObject::tr("Light");
    link.purpose = QObject::tr("How much light each value makes, and on what it falls: colours come out as they are "
                               "meant, and where projectors overlap nothing shows.");
    link.how = {
        QObject::tr("Lay a sheet of white paper beside the device, into the light, and leave the room's light as it "
                    "is."),
        QObject::tr("Flat colours are projected and photographed at several exposures: a few minutes."),
        QObject::tr("Once for each projector you are asked to cover its lens for a moment.")};
    link.needs = {LinkId::projector};
    return link;
}

ChainLink pointerLink() {
    ChainLink link;
    link.stage = &calibrationStage("pointer");
    link.id = LinkId::pointer;
    link.key = "pointer";
    link.title = QObject::tr("Pointer tip");
    link.purpose = QObject::tr("Where the tip of the tracked pointer is: it touches everything else.");
    link.how = {
        QObject::tr("Set the tip into a dimple and swing the pointer to all sides for 15 seconds."),
        QObject::tr("Then hold it in three other dimples, twice each, as differently as you can: these points the fit "
                    "does not see.")};
    link.files = {
        {"swings", QObject::tr("Swings"), QObject::tr("The pointer swung to all sides, its tip in a dimple.")},
        {"rests", QObject::tr("Other dimples"),
         QObject::tr("Its tip set into three other dimples for a second, each twice and held differently.")}};
    link.fromFiles = recorded<pointerFromFiles>;
    link.liveRoles = {PoseRole::pointer};
    link.liveSteps = pointerSteps;
    return link;
}

ChainLink trackerLink() {
    ChainLink link;
    link.stage = &calibrationStage("tracker");
    link.id = LinkId::tracker;
    link.key = "tracker";
    link.title = QObject::tr("Tracker and projector in one world");
    link.purpose = QObject::tr("So that a tracked thing is lit where it is.");
    link.how = {QObject::tr("The projector shows twelve dots on the table, one after the other."),
                QObject::tr("Touch each with the pointer's tip for a second."),
                QObject::tr("Four more dots check the result.")};
    link.needs = {LinkId::projector, LinkId::pointer};
    link.files = {
        {"tracked", QObject::tr("Tracked body"),
         QObject::tr("A body that is moved and turned about two axes, in the tracker's world.")},
        {"seen", QObject::tr("Seen in the room"),
         QObject::tr("The board or camera that is fixed to it, in the room's world; its clock may be another.")}};
    link.fromFiles = recorded<trackerFromFiles>;
    link.liveRoles = {PoseRole::pointer};
    link.liveSteps = trackerSteps;
    return link;
}

ChainLink deviceLink() {
    ChainLink link;
    link.stage = &calibrationStage("body");
    link.id = LinkId::device;
    link.key = "device";
    link.title = QObject::tr("Device on its body");
    link.purpose =
        QObject::tr("Where the device's model lies under its markers: pictures stick to it when it is carried.");
    link.how = {QObject::tr("Corners of the device are named one after the other, as the model has them."),
                QObject::tr("Touch each with the pointer's tip; the device may be moved meanwhile."),
                QObject::tr("Four more corners check the result.")};
    link.needs = {LinkId::pointer};
    link.files = {{"touches", QObject::tr("Pointer"),
                   QObject::tr("Its tip rests for a second on one point of the device after the other.")},
                  {"body", QObject::tr("Body of the device"), QObject::tr("Tracked at the same time.")},
                  {"model", QObject::tr("Points of the model"),
                   QObject::tr("Rows of name, x, y, z in the device's frame, metres.")}};
    link.fromFiles = recorded<deviceFromFiles>;
    link.liveRoles = {PoseRole::pointer, PoseRole::device};
    link.liveSteps = deviceSteps;
    return link;
}

ChainLink eyeLink() {
    ChainLink link;
    link.stage = &calibrationStage("eye");
    link.id = LinkId::eye;
    link.key = "eye";
    link.title = QObject::tr("Eye");
    link.purpose = QObject::tr("Where the eye is in the tracked glasses or cap: what floats, floats where it should.");
    link.how = {
        QObject::tr("A mark is projected. Close one eye, and hold the pointer so that its tip covers the mark."),
        QObject::tr("Eight marks, from other places and with the head turned otherwise."),
        QObject::tr("Four more check the result.")};
    link.needs = {LinkId::pointer, LinkId::tracker};
    link.liveRoles = {PoseRole::pointer, PoseRole::head};
    link.liveSteps = eyeSteps;
    return link;
}

QString degrees(double value) { return QString("%1°").arg(value, 0, 'f', 2); }

LinkOutcome outcomeOf(const ServoMeasurement& measured, const Rig& rig) {
    LinkOutcome outcome;
    outcome.isGood = measured.measured.usable;
    for (const Finding& finding : measured.measured.findings) outcome.findings.push_back(wordsOf(finding));
    outcome.summary = outcome.isGood ? QObject::tr("Fresh states are met to %1; it took %2 of the device's time.")
                                           .arg(degrees(measured.measured.freshDegrees),
                                                QObject::tr("%1 s").arg(std::lround(measured.seconds)))
                      : outcome.findings.empty() ? QObject::tr("The curves do not tell fresh states.")
                                                 : outcome.findings.front().title;
    if (outcome.isGood) outcome.installation = measured.room;
    outcome.figures = {{QObject::tr("Fresh states: median"), degrees(measured.measured.freshDegrees)},
                       {QObject::tr("The worst of them"), degrees(measured.measured.freshWorst)},
                       {QObject::tr("Points off the surface"), millimetres(measured.measured.rms)}};
    for (std::size_t k = 0; k < measured.measured.servos.size(); ++k) {
        const ServoFinding& servo = measured.measured.servos[k];
        if (servo.curve.points.empty()) continue;
        outcome.figures.push_back(
            {QObject::tr("%1: play").arg(QString::fromStdString(rig.actuators()[k].name)),
             QString("%1 ± %2").arg(degrees(servo.backlashDegrees), degrees(servo.backlashSigma))});
    }
    return outcome;
}

ChainLink servosLink() {
    ChainLink link;
    link.stage = &calibrationStage("servos");
    link.id = LinkId::servos;
    link.key = "servos";
    link.title = QObject::tr("Servos");
    link.purpose = QObject::tr("Where each servo really goes, with its play: pictures fit the surface as it stands.");
    link.isMoved = true;
    link.warning = QObject::tr("Hands off: the servos move");
    link.how = {QObject::tr("Each servo goes slowly through its levels, up and down."),
                QObject::tr("At each of them patterns are projected and photographed: two to three minutes in all."),
                QObject::tr("STOP ends it at any time, and nothing of it is kept.")};
    link.needs = {LinkId::projector};
    link.isOnTable = true;
    return link;
}

QString milliseconds(const MeasuredDelay& delay) {
    return QString("%1 ± %2 ms").arg(1e3 * delay.seconds, 0, 'f', 1).arg(1e3 * delay.sigma, 0, 'f', 1);
}

LinkOutcome outcomeOf(const MeasuredDelays& measured) {
    LinkOutcome outcome = judged(measured);
    if (measured.refusal) return outcome;
    outcome.installation = measured.installation;
    outcome.summary = QString::fromStdString(measured.summary);
    outcome.figures = {{QObject::tr("From a frame to its light"), milliseconds(measured.light)},
                       {QObject::tr("Age of poses when they arrive"), milliseconds(measured.tracker)},
                       {QObject::tr("Both together, by a mark that follows a hand"), milliseconds(measured.mark)}};
    if (measured.gain) {
        const auto& [with, without] = *measured.gain;
        outcome.summary = QObject::tr("Carried at 30 cm/s the device is lit %1 beside instead of %2.")
                              .arg(millimetres(with.atSpeed), millimetres(without.atSpeed));
        outcome.figures.push_back({QObject::tr("Beside the whole way, looking ahead"), millimetres(with.always)});
        outcome.figures.push_back({QObject::tr("Beside the whole way, without"), millimetres(without.always)});
    }
    for (const MeasuredDelays::Servo& servo : measured.servos)
        outcome.figures.push_back(
            {QObject::tr("%1: lag").arg(QString::fromStdString(servo.name)), milliseconds(servo.step.lag)});
    return outcome;
}

ChainLink delaysLink() {
    ChainLink link;
    link.stage = &calibrationStage("delays");
    link.notConnected = QObject::tr("This version cannot time a connected camera and tracker: simulate delays in the "
                                    "virtual lab, or enter them by hand in Scene.");
    link.id = LinkId::delays;
    link.key = "delays";
    link.title = QObject::tr("Delays");
    link.purpose =
        QObject::tr("How late light, poses and servos are: what moves is lit where it will be, not where it was.");
    link.warning = QObject::tr("Hands off at the end: the servos move");
    link.how = {
        QObject::tr("The projector flashes, and the camera sees when."),
        QObject::tr("Carry a tracked body that a projected mark follows, then turn a board before tracker and camera."),
        QObject::tr("At last each servo makes some steps: about three minutes in all. STOP ends it at any time.")};
    link.needs = {LinkId::tracker};
    return link;
}

LinkOutcome outcomeOf(const VerifiedRoom& verified, const Installation& believed) {
    const RoomCheck& check = verified.check;
    LinkOutcome outcome;
    outcome.isGood = check.verdict == RoomCheck::Verdict::good;
    outcome.summary = QString::fromStdString(check.sentence);
    // Where it is not known what has moved there is nothing to be put right.
    Installation with = believed;
    takeCorrections(verified.installation, with);
    if (with != believed) outcome.installation = verified.installation;
    outcome.figures = {{QObject::tr("Light lies beside: median"), millimetres(check.now.median), outcome.isGood},
                       {QObject::tr("In 95 of 100 places at most"), millimetres(check.now.most), outcome.isGood}};
    if (verified.fresh.places > 0)
        outcome.figures.push_back(
            {QObject::tr("On a bend that the check did not see"), millimetres(verified.fresh.median)});
    return outcome;
}

ChainLink checkLink() {
    ChainLink link;
    link.stage = &calibrationStage("verify");
    link.id = LinkId::check;
    link.key = "check";
    link.title = QObject::tr("Check");
    link.purpose = QObject::tr("One minute before a show: is all still where it was?");
    link.isMoved = true;
    link.warning = QObject::tr("Hands off: the servos move");
    link.how = {QObject::tr("The device takes two bends; patterns are projected on it and photographed."),
                QObject::tr("Where the light lies beside, it is told what has moved, and one button puts it right.")};
    link.isOnTable = true;
    return link;
}

LinkOutcome outcomeOf(const StageResult& result, const StageSite& site) {
    if (const auto* servos = std::get_if<ServoMeasurement>(&result)) return outcomeOf(*servos, *site.rig);
    if (const auto* check = std::get_if<VerifiedRoom>(&result)) return outcomeOf(*check, site.room);
    if (const auto* light = std::get_if<LightCalibration>(&result)) return outcomeOf(*light);
    if (const auto* delays = std::get_if<MeasuredDelays>(&result)) return outcomeOf(*delays);
    if (const auto* placed = std::get_if<PlacedDevices>(&result)) return outcomeOf(*placed);
    return outcomeOf(std::get<Registration>(result));
}

} // namespace

LinkOutcome outcomeOf(MeasuredStage measured, const StageSite& site) {
    LinkOutcome outcome = outcomeOf(measured.result, site);
    outcome.isSimulated = measured.recording.source.isSimulated();
    outcome.recording = std::make_shared<const StageRecording>(std::move(measured.recording));
    return outcome;
}

const Origin* originOf(const ChainLink& link, const Installation& room) {
    if (!link.stage) return room.projectors.empty() ? nullptr : &room.projectors.front().lens;
    return link.stage->origin ? link.stage->origin(room) : nullptr;
}

const std::vector<ChainLink>& chainLinks() {
    static const std::vector<ChainLink> links{projectorLink(), roomLink(),   lightLink(),  pointerLink(),
                                              trackerLink(),   deviceLink(), eyeLink(),    servosLink(),
                                              delaysLink(),    checkLink(),  mirrorLink(), deviceAloneLink()};
    return links;
}

} // namespace lumorph::studio
