#include "app/workspaces/rig/rig_facts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QGridLayout>
#include <QLabel>

#include "app/studio/widgets/dock_parts.h"
#include "app/workspaces/common/field_summary.h"

namespace lumorph::studio {

namespace {

using Motion = ActuatorRange::Motion;

struct RangeOf {
    ActuatorRange operator()(const Hinge& d) const { return {Motion::turning, d.min.inRadians(), d.max.inRadians()}; }
    ActuatorRange operator()(const Bend& d) const { return {Motion::turning, d.min.inRadians(), d.max.inRadians()}; }
    ActuatorRange operator()(const Slide& d) const { return {Motion::moving, d.min, d.max}; }
    ActuatorRange operator()(const MorphTarget&) const { return {Motion::blending, 0.0, 1.0}; }
    ActuatorRange operator()(const SkinJoint& d) const {
        return {d.motion == SkinJoint::Motion::rotate ? Motion::turning : Motion::moving, d.min, d.max};
    }
    ActuatorRange operator()(const SheetLift& d) const {
        return {Motion::turning, d.min.inRadians(), d.max.inRadians()};
    }
};

struct SetRange {
    double min, max;
    void operator()(Hinge& d) const { d.min = Angle::radians(min), d.max = Angle::radians(max); }
    void operator()(Bend& d) const { d.min = Angle::radians(min), d.max = Angle::radians(max); }
    void operator()(Slide& d) const { d.min = min, d.max = max; }
    void operator()(MorphTarget&) const {}
    void operator()(SkinJoint& d) const { d.min = min, d.max = max; }
    void operator()(SheetLift&) const {} // the sheet's shapes were computed for the angles that it has
};

/// A number with at most one decimal.
QString shortNumber(double value) {
    QString text = QString::number(value, 'f', 1);
    if (text.endsWith(".0")) text.chop(2);
    return text == "-0" ? "0" : text;
}

QString percentText(double share) { return shortNumber(100.0 * share) + " %"; }

double halfWay(const ActuatorDrive& drive) {
    return std::lerp(drive.pulseMin, drive.pulseMax, turnedAt(drive.curve, 0.5));
}

QString statesText(int count, int of) {
    return count == 0 ? QString("none of %1").arg(of) : QString("%1 of %2").arg(count).arg(of);
}

} // namespace

QString deformerText(const Actuator& actuator) {
    constexpr std::array kNames = {"Hinge", "Bend", "Slide", "Morph target", "Joint", "Lever of the sheet"};
    return kNames.at(actuator.deformer.index());
}

ActuatorRange rangeOf(const Actuator& actuator) { return std::visit(RangeOf{}, actuator.deformer); }

void setRange(Actuator& actuator, double min, double max) {
    const ActuatorRange before = rangeOf(actuator);
    if (std::holds_alternative<SheetLift>(actuator.deformer)) return;
    std::visit(SetRange{min, max}, actuator.deformer);
    if (!(before.max > before.min && max > min)) return;
    const double longer = (max - min) / (before.max - before.min);
    actuator.maxVelocity /= longer;
    ActuatorDrive& drive = actuator.drive;
    const double full = std::lerp(drive.pulseMin, drive.pulseMax, turnedAt(drive.curve, longer));
    if (full < profile_limits::kPulse.least || full > profile_limits::kPulse.most) return;
    drive.curve = upTo(drive.curve, longer);
    drive.pulseMax = full;
}

QString lengthText(double metres) { return shortNumber(1000.0 * metres) + " mm"; }

QString rangeText(const Actuator& actuator) {
    const ActuatorRange range = rangeOf(actuator);
    switch (range.motion) {
    case Motion::turning:
        return QString("%1° to %2°")
            .arg(shortNumber(Angle::radians(range.min).inDegrees()),
                 shortNumber(Angle::radians(range.max).inDegrees()));
    case Motion::moving:
        return shortNumber(1000.0 * range.min) + " to " + lengthText(range.max);
    case Motion::blending:
        break;
    }
    return shortNumber(range.min) + " to " + shortNumber(range.max);
}

QString torqueText(double newtonMetres) { return QString::number(newtonMetres, 'g', 2) + "\u00A0N\u00A0m"; }

QString servoTypeText(const ServoType& type) {
    return QString("Holds %1, half of what stalls it\n%2 s for 60° without load\n%3 to %4 µs for %5°\n"
                   "%6 x %7 x %8 mm, %9 g")
               .arg(torqueText(type.usableTorque()),
                    QString::number(Angle::degrees(60.0).inRadians() / type.speed, 'f', 2), shortNumber(type.pulseMin),
                    shortNumber(type.pulseMax), shortNumber(type.travel.inDegrees()), shortNumber(1e3 * type.size.x),
                    shortNumber(1e3 * type.size.y), shortNumber(1e3 * type.size.z), shortNumber(1e3 * type.mass)) +
           QString("\nAbout %1 EUR").arg(type.price, 0, 'f', 2);
}

QString servoLoadText(const ServoLoad& load) {
    if (load.lever == 0.0) return "It moves nothing.";
    const QString needed = QString("%1 for a lever of %2").arg(torqueText(load.torque), lengthText(load.lever));
    const QString name = shownText(load.servo->name), can = torqueText(load.servo->usableTorque());
    if (!load.weak) return QString("Needs %1; the %2 can hold %3.").arg(needed, name, can);
    return QString("Too weak: it needs %1, and the %2 can hold %3. ").arg(needed, name, can) +
           (load.stronger.empty() ? QString("No servo of the table can: shorten the lever, or split the flap.")
                                  : QString("The %1 can.").arg(shownText(load.stronger)));
}

double fastestStroke(const Actuator& actuator, const ServoType& servo) {
    return servoAngle(actuator, servo).inRadians() / servo.speed;
}

std::vector<RigFact> factsOf(const Rig& rig, std::size_t index, double amplitude, const ServoSetup* setup) {
    const Actuator& actuator = rig.actuators()[index];
    ActuatorDrive drive = actuator.drive;
    if (setup) {
        drive.pulseMin = setup->reversed ? setup->pulseMax : setup->pulseMin;
        drive.pulseMax = setup->reversed ? setup->pulseMin : setup->pulseMax;
        drive.curve = setup->curve;
    }
    std::vector<RigFact> facts{
        {"Moves by", deformerText(actuator), "How its part changes shape"},
        {"Amplitude", lengthText(amplitude), "The farthest that a point of the surface gets from where it rests"},
        {"Levels", QString::number(actuator.levels), "Steps that the rig suggests for a field"},
        {"Moves", countText(rig.verticesOf(index).size()) + " vertices", "How much of the mesh follows it"},
        {"Channel", drive.channel < 0 ? QString("none") : QString::number(drive.channel),
         "The number of its servo in the rig's file and in the wiring table of its parts; the first is 0"},
        {"Pulse",
         shortNumber(drive.pulseMin) + " to " + shortNumber(drive.pulseMax) + " µs" +
             (drive.curve.empty() ? "" : QString(", half-way %1 µs").arg(shortNumber(halfWay(drive)))),
         "What the servo is sent at rest and at full stroke; where a lever is between the two, half-way, too"},
    };
    if (setup)
        facts.push_back({"At the board", QString::number(setup->channel),
                         "The pin or channel to which Devices sends, in the board's own numbers"});
    return facts;
}

std::vector<RigFact> meshFacts(const ShapeReport& report) {
    const MeshReport& mesh = report.rest;
    return {
        {"Triangles", countText(mesh.triangles), "Of the device's surface"},
        {"Pieces", countText(mesh.components), "Parts of the mesh that are not connected"},
        {"Open edges", countText(mesh.boundaryEdges), "Edges of holes; a solid has none"},
        {"Edges shared wrongly", countText(mesh.nonManifoldEdges),
         "Edges with more than two triangles, or two that disagree"},
        {"Flat triangles", countText(mesh.degenerateTriangles), "Triangles without area"},
        {"Crossings", countText(mesh.selfIntersections), "Pairs of triangles that cross each other"},
        {"Pieces turned inwards", countText(mesh.inwardComponents), "Closed pieces whose surface looks inside"},
        {"Volume", volumeText(mesh.volume), "Enclosed at rest"},
    };
}

std::vector<RigFact> shapeFacts(const ShapeReport& report) {
    const glm::vec3 size = report.reach.size();
    const int states = report.sampledStates;
    std::vector<RigFact> facts{
        {"Size", sizeText(size.x, size.y, size.z), "Over all states"},
        {"Moving surface", shortNumber(1e4 * report.area) + " cm²", "Surface at rest that any actuator moves"},
        {"Granularity", shortNumber(1e-2 * report.granularity) + " per dm²",
         "Actuators for each square decimetre of that"},
        {"Most stretch", percentText(report.maxStretch), "Largest change of an edge of the upper surface"},
        {"Volume range", volumeText(report.volumeMin) + " to " + volumeText(report.volumeMax),
         "Over the states looked at"},
        {"Open states", statesText(report.openStates, states), "Joint states in which the mesh is not closed"},
        {"Crossing states", statesText(report.intersectingStates, states),
         "Joint states in which the mesh crosses itself"},
        {"Inverted states", statesText(report.invertedStates, states), "Joint states with triangles turned inside out"},
        {"Holds its path",
         report.pathInside ? QString("yes") : QString("no, %1 outside").arg(percentText(report.pathOutsideShare)),
         "Whether the solid at a state holds all that it passed on its way"},
    };
    if (report.seconds)
        facts.push_back({"Second shapes",
                         report.seconds->states == 0 ? QString("none of %1").arg(report.seconds->of)
                                                     : QString("%1 of %2, up to %3 away")
                                                           .arg(report.seconds->states)
                                                           .arg(report.seconds->of)
                                                           .arg(lengthText(report.seconds->distance)),
                         "Joint states in which the sheet can also rest otherwise than it is shown. A second shape is "
                         "reached by a push, or by another way there"});
    return facts;
}

QWidget* makeFacts(const std::vector<RigFact>& facts, const QString& prefix, QWidget* parent) {
    auto* widget = new QWidget(parent);
    auto* grid = new QGridLayout(widget);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(16);
    grid->setVerticalSpacing(4);
    grid->setColumnStretch(1, 1);
    for (int row = 0; const RigFact& fact : facts) {
        auto* name = new QLabel(fact.name, widget);
        name->setProperty("look", "muted");
        auto* value = new QLabel(fact.value, widget);
        value->setObjectName(prefix + fact.name.toLower().replace(' ', '-'));
        value->setTextInteractionFlags(Qt::TextSelectableByMouse);
        value->setWordWrap(true);
        name->setToolTip(fact.why);
        value->setToolTip(fact.why);
        grid->addWidget(name, row, 0, Qt::AlignTop);
        grid->addWidget(value, row++, 1);
    }
    return widget;
}

} // namespace lumorph::studio
