#include <cmath>

#include <QObject>

#include "app/studio/calibration/chain.h"
#include "app/studio/calibration/chain_files.h"
#include "app/studio/calibration/chain_live.h"

// The links themselves: what each is for, what happens, and how what came of it is read.

namespace lumorph::studio {
namespace {

QString millimetres(double metres) { return QString("%1 mm").arg(1e3 * metres, 0, 'f', 2); }

/// What is to be known of a measurement, whatever it is of; of one that was refused there is nothing else.
template <class Measured> LinkWords judged(const Measured& measured) {
    LinkWords words;
    if (measured.refusal) {
        words.findings.push_back(wordsOf(*measured.refusal));
        words.summary = words.findings.front().title + ". " + words.findings.front().remedy;
    }
    for (const Finding& warning : measured.warnings) words.findings.push_back(wordsOf(warning));
    return words;
}

LinkWords readOf(const Registration& measured) {
    LinkWords words = judged(measured);
    if (measured.refusal) return words;
    words.summary = QString::fromStdString(measured.summary);
    const FreshCheck& fresh = measured.fresh;
    words.figures = {
        {QObject::tr("%1 check points, which the fit never saw: root mean square").arg(fresh.points.size()),
         millimetres(fresh.rms), fresh.rms <= fresh.allowed},
        {QObject::tr("The worst of them"), millimetres(fresh.worst), fresh.worst <= 2.5 * fresh.allowed},
        {QObject::tr("Residual of the fit"), millimetres(measured.rms)}};
    if (measured.shiftSigma > 0.0)
        words.figures.push_back(
            {QObject::tr("Uncertainty of the place"), QString("± %1").arg(millimetres(measured.shiftSigma))});
    if (measured.turnSigma > 0.0)
        words.figures.push_back({QObject::tr("Uncertainty of the direction"),
                                 QString("± %1°").arg(57.29577951308232 * measured.turnSigma, 0, 'f', 2)});
    const auto add = [&words](const std::vector<PointError>& points, bool isFresh) {
        for (const PointError& point : points)
            words.points.push_back({QString::fromStdString(point.name), 1e3 * point.metres, isFresh});
    };
    add(fresh.points, true);
    add(measured.points, false);
    return words;
}

/// A recording that is refused before anything is fitted is a refusal as any other.
template <auto Read> StageResult recorded(const FileTask& task, const Progress& progress) {
    Registration refusal;
    try {
        return Read(task, progress);
    } catch (const CaptureRefused& refused) {
        refusal.refusal = refused.finding();
    }
    return refusal;
}

/// `key`: of names of widgets, where that of the stage is another.
ChainLink linkOf(LinkId id, const char* key, const char* stage) {
    ChainLink link;
    link.id = id;
    link.key = key;
    link.stage = &calibrationStage(stage);
    link.title = QObject::tr(link.stage->title);
    return link;
}

ChainLink projectorLink() {
    ChainLink link = linkOf(LinkId::projector, "projector", "projector");
    link.purpose = QObject::tr("Where the light falls: without it nothing else can be measured.");
    link.how = {
        QObject::tr("A board is laid into the light, some poses one after the other, and photographed under patterns."),
        QObject::tr("It has a sequence of its own, which says at each step what to do.")};
    return link;
}

LinkWords readOf(const PlacedDevices& measured) {
    LinkWords words = judged(measured);
    if (measured.refusal) return words;
    words.summary = QString::fromStdString(measured.summary);
    const auto pixels = [](double number) { return QString("%1 px").arg(number, 0, 'f', 2); };
    const HeldOutLight& all = measured.heldOut;
    if (all.points > 0)
        words.figures = {{QObject::tr("Light that the fit never saw lies beside: median"), millimetres(all.median)},
                         {QObject::tr("In 95 of 100 places at most"), millimetres(all.most)}};
    for (const PlacedDevices::Device& device : measured.devices) {
        const QString name = QString::fromStdString(device.name);
        words.figures.push_back({QObject::tr("%1: residual of the fit").arg(name), pixels(device.rms)});
        if (device.heldOut.points > 0)
            words.figures.push_back({QObject::tr("%1: held out").arg(name), pixels(device.heldOut.medianPixels)});
        if (device.shiftSigma > 0.0)
            words.figures.push_back({QObject::tr("%1: uncertainty of its place").arg(name),
                                     QString("± %1").arg(millimetres(device.shiftSigma))});
    }
    return words;
}

ChainLink roomLink() {
    ChainLink link = linkOf(LinkId::room, "room", "room");
    link.purpose = QObject::tr("Several projectors in one world: where their pictures overlap, they meet.");
    link.how = {QObject::tr("Lay the board flat on the table, where all projectors light it."),
                QObject::tr("Each projector lights it in turn, and the camera looks."),
                QObject::tr("Lay it otherwise, tilted to another side, six times; each new place is noticed by "
                            "itself. The last one checks the others.")};
    link.isOnTable = true;
    link.onTable = QObject::tr("It looks for the printed board that is chosen in Projector and camera.");
    return link;
}

ChainLink mirrorLink() {
    ChainLink link = linkOf(LinkId::mirror, "mirror", "mirror");
    link.purpose = QObject::tr("In place of Projector and camera, where the camera sees the light in a mirror alone.");
    link.how = {QObject::tr("Lay the board flat on the table, and cover it from the camera: only the mirror shows it."),
                QObject::tr("Patterns are projected and photographed in the mirror."),
                QObject::tr("Then the mirror is covered, and the board itself is photographed where it lies."),
                QObject::tr("Six more times, tilted to other sides; the last one checks the others.")};
    link.notConnected =
        QObject::tr("This version does not guide covering a mirror at the table: measure in the virtual "
                    "lab, from a recording, or from a folder of pictures on the command line.");
    return link;
}

ChainLink deviceAloneLink() {
    ChainLink link = linkOf(LinkId::deviceAlone, "device-alone", "device");
    link.purpose = QObject::tr("In place of Projector and camera, without a board: the device's own shape tells.");
    link.warning = QObject::tr("Hands off: the servos move");
    link.how = {QObject::tr("The device stays where it lies. Its servos were measured before."),
                QObject::tr("One actuator after the other rises; patterns are projected and photographed each time."),
                QObject::tr("At last all rise a little: that checks the others. STOP ends it at any time.")};
    link.isOnTable = true;
    link.isMoved = true;
    return link;
}

QString percent(double share) { return QString("%1 %").arg(100.0 * share, 0, 'f', 1); }

LinkWords readOf(const LightCalibration& measured) {
    LinkWords words = judged(measured);
    if (measured.refusal) return words;
    words.summary =
        QObject::tr("Greys that the fit never saw are met to %1 (before: %2). %3")
            .arg(percent(measured.fresh.median), percent(measured.before.median),
                 measured.hasWhiteSheet ? QObject::tr("White is what the sheet of paper is.")
                                        : QObject::tr("Without a white sheet the lighter of device and table counts as "
                                                      "white: its tint is among the projectors'."));
    words.figures = {{QObject::tr("Fresh greys: median"), percent(measured.fresh.median)},
                     {QObject::tr("In 95 of 100 places at most"), percent(measured.fresh.most)},
                     {QObject::tr("By what was believed before"), percent(measured.before.median)},
                     {QObject::tr("Exposures against the camera's curve"), percent(measured.responseRms)}};
    for (const InstalledProjector& projector : measured.room.projectors) {
        if (!projector.enabled) continue;
        const QString name = QString::fromStdString(projector.name);
        const glm::dvec3 gain(projector.gain);
        words.figures.push_back(
            {QObject::tr("%1: red, green, blue").arg(name),
             QString("%1 %2 %3").arg(gain.r, 0, 'f', 3).arg(gain.g, 0, 'f', 3).arg(gain.b, 0, 'f', 3)});
        words.figures.push_back({QObject::tr("%1: black, of white").arg(name),
                                 QString("%1 %").arg(100.0 * static_cast<double>(projector.black.g), 0, 'f', 2)});
    }
    return words;
}

ChainLink lightLink() {
    ChainLink link = linkOf(LinkId::light, "light", "light");
    link.isOnTable = true;
    link.onTable = QObject::tr("Where a sheet lies nobody knows here, so the lighter of device and table counts as "
                               "white.");
    link.purpose = QObject::tr("How much light each value makes, and on what it falls: colours come out as they are "
                               "meant, and where projectors overlap nothing shows.");
    link.how = {
        QObject::tr("Lay a sheet of white paper beside the device, into the light, and leave the room's light as it "
                    "is."),
        QObject::tr("Flat colours are projected and photographed at several exposures: a few minutes."),
        QObject::tr("Once for each projector you are asked to cover its lens for a moment.")};
    return link;
}

ChainLink pointerLink() {
    ChainLink link = linkOf(LinkId::pointer, "pointer", "pointer");
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
    ChainLink link = linkOf(LinkId::tracker, "tracker", "tracker");
    link.purpose = QObject::tr("So that a tracked thing is lit where it is.");
    link.how = {QObject::tr("The projector shows twelve dots on the table, one after the other."),
                QObject::tr("Touch each with the pointer's tip for a second."),
                QObject::tr("Four more dots check the result.")};
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
    ChainLink link = linkOf(LinkId::device, "device", "body");
    link.purpose =
        QObject::tr("Where the device's model lies under its markers: pictures stick to it when it is carried.");
    link.how = {QObject::tr("Corners of the device are named one after the other, as the model has them."),
                QObject::tr("Touch each with the pointer's tip; the device may be moved meanwhile."),
                QObject::tr("Four more corners check the result.")};
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
    ChainLink link = linkOf(LinkId::eye, "eye", "eye");
    link.purpose = QObject::tr("Where the eye is in the tracked glasses or cap: what floats, floats where it should.");
    link.how = {
        QObject::tr("A mark is projected. Close one eye, and hold the pointer so that its tip covers the mark."),
        QObject::tr("Eight marks, from other places and with the head turned otherwise."),
        QObject::tr("Four more check the result.")};
    link.liveRoles = {PoseRole::pointer, PoseRole::head};
    link.liveSteps = eyeSteps;
    return link;
}

QString degrees(double value) { return QString("%1°").arg(value, 0, 'f', 2); }

LinkWords readOf(const ServoMeasurement& measured) {
    LinkWords words;
    for (const Finding& finding : measured.measured.findings) words.findings.push_back(wordsOf(finding));
    words.summary =
        measured.measured.usable
            ? QObject::tr("Fresh states are met to %1; it took %2 of the device's time.")
                  .arg(degrees(measured.measured.freshDegrees), QObject::tr("%1 s").arg(std::lround(measured.seconds)))
        : words.findings.empty() ? QObject::tr("The curves do not tell fresh states.")
                                 : words.findings.front().title;
    words.figures = {{QObject::tr("Fresh states: median"), degrees(measured.measured.freshDegrees)},
                     {QObject::tr("The worst of them"), degrees(measured.measured.freshWorst)},
                     {QObject::tr("Points off the surface"), millimetres(measured.measured.rms)}};
    for (const ServoFinding& servo : measured.measured.servos) {
        if (servo.curve.points.empty()) continue;
        words.figures.push_back({QObject::tr("%1: play").arg(QString::fromStdString(servo.curve.actuator)),
                                 QString("%1 ± %2").arg(degrees(servo.backlashDegrees), degrees(servo.backlashSigma))});
    }
    return words;
}

ChainLink servosLink() {
    ChainLink link = linkOf(LinkId::servos, "servos", "servos");
    link.purpose = QObject::tr("Where each servo really goes, with its play: pictures fit the surface as it stands.");
    link.isMoved = true;
    link.warning = QObject::tr("Hands off: the servos move");
    link.how = {QObject::tr("Each servo goes slowly through its levels, up and down."),
                QObject::tr("At each of them patterns are projected and photographed: seven minutes or more in all."),
                QObject::tr("STOP ends it at any time, and nothing of it is kept.")};
    link.isOnTable = true;
    return link;
}

QString milliseconds(const MeasuredDelay& delay) {
    return QString("%1 ± %2 ms").arg(1e3 * delay.seconds, 0, 'f', 1).arg(1e3 * delay.sigma, 0, 'f', 1);
}

LinkWords readOf(const MeasuredDelays& measured) {
    LinkWords words = judged(measured);
    if (measured.refusal) return words;
    words.summary = QString::fromStdString(measured.summary);
    words.figures = {{QObject::tr("From a frame to its light"), milliseconds(measured.light)}};
    if (measured.isOfLightAlone()) return words;
    words.figures.push_back({QObject::tr("Age of poses when they arrive"), milliseconds(measured.tracker)});
    words.figures.push_back({QObject::tr("Both together, by a mark that follows a hand"), milliseconds(measured.mark)});
    if (measured.gain) {
        const auto& [with, without] = *measured.gain;
        words.summary = QObject::tr("Carried at 30 cm/s the device is lit %1 beside instead of %2.")
                            .arg(millimetres(with.atSpeed), millimetres(without.atSpeed));
        words.figures.push_back({QObject::tr("Beside the whole way, looking ahead"), millimetres(with.always)});
        words.figures.push_back({QObject::tr("Beside the whole way, without"), millimetres(without.always)});
    }
    for (const MeasuredDelays::Servo& servo : measured.servos)
        words.figures.push_back(
            {QObject::tr("%1: lag").arg(QString::fromStdString(servo.name)), milliseconds(servo.step.lag)});
    return words;
}

ChainLink delaysLink() {
    ChainLink link = linkOf(LinkId::delays, "delays", "delays");
    link.isOnTable = true;
    link.onTable = QObject::tr("Here flashes alone are timed, in half a minute: how late the light is. How late poses "
                               "and servos are stays as it was.");
    link.purpose =
        QObject::tr("How late light, poses and servos are: what moves is lit where it will be, not where it was.");
    link.warning = QObject::tr("Hands off at the end: the servos move");
    link.how = {
        QObject::tr("The projector flashes, and the camera sees when."),
        QObject::tr("Carry a tracked body that a projected mark follows, then turn a board before tracker and camera."),
        QObject::tr("At last each servo makes some steps: about three minutes in all. STOP ends it at any time.")};
    return link;
}

LinkWords readOf(const VerifiedRoom& verified) {
    const RoomCheck& check = verified.check;
    LinkWords words;
    words.summary = QString::fromStdString(check.sentence);
    const bool isGood = check.verdict == RoomCheck::Verdict::good;
    words.figures = {{QObject::tr("Light lies beside: median"), millimetres(check.now.median), isGood},
                     {QObject::tr("In 95 of 100 places at most"), millimetres(check.now.most), isGood}};
    if (verified.fresh.places > 0)
        words.figures.push_back(
            {QObject::tr("On a bend that the check did not see"), millimetres(verified.fresh.median)});
    return words;
}

ChainLink checkLink() {
    ChainLink link = linkOf(LinkId::check, "check", "verify");
    link.purpose = QObject::tr("One minute before a show: is all still where it was?");
    link.isMoved = true;
    link.warning = QObject::tr("Hands off: the servos move");
    link.how = {QObject::tr("The device takes two bends; patterns are projected on it and photographed."),
                QObject::tr("Where the light lies beside, it is told what has moved, and one button puts it right.")};
    link.isOnTable = true;
    return link;
}

} // namespace

LinkWords wordsOf(const StageOutcome& outcome) {
    return std::visit([](const auto& measured) { return readOf(measured); }, outcome.result);
}

const std::vector<ChainLink>& chainLinks() {
    static const std::vector<ChainLink> links{projectorLink(), roomLink(),   lightLink(),  pointerLink(),
                                              trackerLink(),   deviceLink(), eyeLink(),    servosLink(),
                                              delaysLink(),    checkLink(),  mirrorLink(), deviceAloneLink()};
    return links;
}

} // namespace lumorph::studio
