#include <algorithm>

#include <QObject>

#include "app/studio/calibration/chain.h"
#include "calibration/lab/registration_lab.h"

// The links themselves: what each is for, what happens, what it builds on, and how it is measured in the lab.

namespace lumorph::studio {
namespace {

QString millimetres(double metres) { return QString("%1 mm").arg(1e3 * metres, 0, 'f', 2); }

LinkOutcome outcomeOf(const Registration& measured) {
    LinkOutcome outcome;
    outcome.isGood = measured.good();
    outcome.summary = QString::fromStdString(measured.summary);
    for (const Finding& warning : measured.warnings) outcome.findings.push_back(wordsOf(warning));
    if (measured.refusal) {
        outcome.findings.insert(outcome.findings.begin(), wordsOf(*measured.refusal));
        outcome.summary = outcome.findings.front().title;
        return outcome;
    }
    outcome.installation = measured.installation;
    const FreshCheck& fresh = measured.fresh;
    outcome.figures = {
        {QObject::tr("%1 points that the fit never saw: root mean square").arg(fresh.points.size()),
         millimetres(fresh.rms), fresh.rms <= fresh.allowed},
        {QObject::tr("The worst of them"), millimetres(fresh.worst), fresh.worst <= 2.5 * fresh.allowed},
        {QObject::tr("Residual of the fit"), millimetres(measured.rms)},
        {QObject::tr("Uncertainty of the place"), QString("± %1").arg(millimetres(measured.shiftSigma))}};
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

template <auto Measure> LinkOutcome registered(const LinkTask& task, const Progress& progress) {
    return outcomeOf(Measure(*task.rig, task.believed, task.truth, task.seed, progress, {}));
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
    link.origin = [](const Installation& room) {
        return room.projectors.empty() ? nullptr : &room.projectors.front().lens;
    };
    return link;
}

ChainLink pointerLink() {
    ChainLink link;
    link.id = LinkId::pointer;
    link.key = "pointer";
    link.title = QObject::tr("Pointer tip");
    link.purpose = QObject::tr("Where the tip of the tracked pointer is: it touches everything else.");
    link.how = {
        QObject::tr("Set the tip into a dimple and swing the pointer to all sides for 15 seconds."),
        QObject::tr("Then hold it in three other dimples, twice each, as differently as you can: these points the fit "
                    "does not see.")};
    link.origin = [](const Installation& room) { return &room.origins.pointer; };
    link.apply = [](const Installation& measured, Installation& room) {
        room.pointerTip = measured.pointerTip;
        room.origins.pointer = measured.origins.pointer;
    };
    link.inLab = registered<measurePointerInLab>;
    return link;
}

ChainLink trackerLink() {
    ChainLink link;
    link.id = LinkId::tracker;
    link.key = "tracker";
    link.title = QObject::tr("Tracker and projector in one world");
    link.purpose = QObject::tr("So that a tracked thing is lit where it is.");
    link.how = {QObject::tr("The projector shows twelve dots on the table, one after the other."),
                QObject::tr("Touch each with the pointer's tip for a second."),
                QObject::tr("Four more dots check the result.")};
    link.needs = {LinkId::projector, LinkId::pointer};
    link.origin = [](const Installation& room) { return &room.origins.tracker; };
    link.apply = [](const Installation& measured, Installation& room) {
        room.worldFromTracker = measured.worldFromTracker;
        room.origins.tracker = measured.origins.tracker;
    };
    link.inLab = registered<measureTrackerInLab>;
    return link;
}

ChainLink deviceLink() {
    ChainLink link;
    link.id = LinkId::device;
    link.key = "device";
    link.title = QObject::tr("Device on its body");
    link.purpose =
        QObject::tr("Where the device's model lies under its markers: pictures stick to it when it is carried.");
    link.how = {QObject::tr("Corners of the device are named one after the other, as the model has them."),
                QObject::tr("Touch each with the pointer's tip; the device may be moved meanwhile."),
                QObject::tr("Four more corners check the result.")};
    link.needs = {LinkId::pointer};
    link.origin = [](const Installation& room) { return &room.origins.deviceBody; };
    link.apply = [](const Installation& measured, Installation& room) {
        room.bodyFromDevice = measured.bodyFromDevice;
        room.origins.deviceBody = measured.origins.deviceBody;
    };
    link.inLab = registered<measureDeviceInLab>;
    return link;
}

ChainLink eyeLink() {
    ChainLink link;
    link.id = LinkId::eye;
    link.key = "eye";
    link.title = QObject::tr("Eye");
    link.purpose = QObject::tr("Where the eye is in the tracked glasses or cap: what floats, floats where it should.");
    link.how = {
        QObject::tr("A mark is projected. Close one eye, and hold the pointer so that its tip covers the mark."),
        QObject::tr("Eight marks, from other places and with the head turned otherwise."),
        QObject::tr("Four more check the result.")};
    link.needs = {LinkId::pointer, LinkId::tracker};
    link.origin = [](const Installation& room) { return &room.origins.eyeOffset; };
    link.apply = [](const Installation& measured, Installation& room) {
        room.eyeFromHead = measured.eyeFromHead;
        room.origins.eyeOffset = measured.origins.eyeOffset;
    };
    link.inLab = registered<measureEyeInLab>;
    return link;
}

} // namespace

const std::vector<ChainLink>& chainLinks() {
    static const std::vector<ChainLink> links{projectorLink(), pointerLink(), trackerLink(), deviceLink(), eyeLink()};
    return links;
}

} // namespace lumorph::studio
