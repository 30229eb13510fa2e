#include "app/workspaces/rig/actuator_form.h"

#include <algorithm>
#include <numbers>
#include <string>

#include <QStyle>
#include <QVBoxLayout>

#include "app/studio/document/rig_edit.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/rig/rig_facts.h"

namespace lumorph::studio {

namespace {

using Motion = ActuatorRange::Motion;

constexpr double kFastestStroke = 0.02, kSlowestStroke = 60.0; // seconds
constexpr double kFullTurn = 2.0 * std::numbers::pi;

void showRow(ValueField* field, bool shown) { field->parentWidget()->setVisible(shown); }

} // namespace

ActuatorForm::ActuatorForm(StudioDocument& document, QWidget* parent)
    : QWidget(parent), document_(document), preview_(document), name_(new QLineEdit), servo_(new QComboBox),
      load_(new QLabel) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    name_->setObjectName("rig.edit.name");
    name_->setToolTip("The actuator's name, of its own in this rig");
    connect(name_, &QLineEdit::editingFinished, this, &ActuatorForm::rename);
    layout->addWidget(makeRow("&Name", name_, this));
    addRange();
    stroke_ = addField({"rig.edit.stroke", "Full &stroke", "Time from rest to full stroke at its velocity limit",
                        "Change the velocity of %1"},
                       {Quantity::seconds, kFastestStroke, kSlowestStroke, 1.0},
                       [](Actuator& actuator, double seconds) { actuator.maxVelocity = 1.0 / seconds; });
    damping_ = addField({"rig.edit.damping", "&Damping", "1 arrives soonest without passing its place; more is softer",
                         "Change the damping of %1"},
                        {Quantity::plain, 1.0, 20.0, 1.0},
                        [](Actuator& actuator, double ratio) { actuator.dampingRatio = ratio; });
    damping_->setStep(0.1);
    addServo();
    show(std::nullopt);
}

void ActuatorForm::addServo() {
    servo_->setObjectName("rig.edit.servo");
    servo_->addItem("not said");
    for (const ServoType& type : servoTypes()) {
        servo_->addItem(shownText(type.name));
        servo_->setItemData(servo_->count() - 1, servoTypeText(type), Qt::ToolTipRole);
    }
    load_->setObjectName("rig.edit.load");
    load_->setWordWrap(true);
    layout()->addWidget(makeRow("Ser&vo", servo_, this));
    layout()->addWidget(load_);
    connect(servo_, &QComboBox::activated, this, &ActuatorForm::chooseServo);
}

void ActuatorForm::addRange() {
    const auto from = [](Actuator& actuator, double value) { setRange(actuator, value, rangeOf(actuator).max); };
    const auto to = [](Actuator& actuator, double value) { setRange(actuator, rangeOf(actuator).min, value); };
    const QString step = "Change the range of %1";
    const QString atRest = "Where it stands at rest", atEnd = "Where it stands at full stroke";
    const Limits turn{Quantity::angle, -kFullTurn, kFullTurn, 0.0}, way{Quantity::length, -1.0, 1.0, 0.0};
    from_ = addField({"rig.edit.from", "&From", atRest, step}, turn, from);
    to_ = addField({"rig.edit.to", "&To", atEnd, step}, {turn.quantity, turn.low, turn.high, kFullTurn / 8.0}, to);
    fromLength_ = addField({"rig.edit.fromLength", "&From", atRest, step}, way, from);
    toLength_ = addField({"rig.edit.toLength", "&To", atEnd, step}, {way.quantity, way.low, way.high, 0.02}, to);
}

ValueField* ActuatorForm::addField(const Words& words, const Limits& limits, const Edit& edit) {
    auto* field = new ValueField(limits.quantity, limits.low, limits.high, limits.reset);
    field->setObjectName(words.name);
    field->setToolTip(words.hint + ".\n" + field->toolTip());
    layout()->addWidget(makeRow(words.label, field, this));
    connect(field, &ValueField::previewed, this, [this, edit](double value) { preview(edit, value); });
    connect(field, &ValueField::committed, this, [this, edit, step = words.step](double value) {
        if (!shown()) return;
        const QString name = QString::fromStdString(shown()->name);
        preview(edit, value);
        document_.commitPreview(step.arg(name));
        emit motionChanged();
    });
    connect(field, &ValueField::reverted, this, [this] { document_.cancelPreview(); });
    return field;
}

void ActuatorForm::preview(const Edit& edit, double value) {
    if (actuator_) preview_.show(*actuator_, [&](Actuator& actuator) { edit(actuator, value); });
}

const Actuator* ActuatorForm::shown() const {
    const auto& parts = document_.state().rig.parts;
    return parts && actuator_ && *actuator_ < parts->actuators.size() ? &parts->actuators[*actuator_] : nullptr;
}

void ActuatorForm::show(std::optional<std::size_t> actuator) {
    const bool other = actuator_ != actuator;
    actuator_ = actuator;
    const Actuator* now = shown();
    setVisible(now != nullptr);
    if (!now) return;
    if (other) name_->setModified(false);
    if (!(name_->hasFocus() && name_->isModified())) name_->setText(QString::fromStdString(now->name));
    showRange(*now);
    showServo(*now);
    damping_->setValue(now->dampingRatio);
}

void ActuatorForm::showRange(const Actuator& actuator) {
    const ActuatorRange range = rangeOf(actuator);
    const bool lifts = std::holds_alternative<SheetLift>(actuator.deformer);       // what the sheet was computed for
    from_->setEnabled(!lifts && !std::holds_alternative<Bend>(actuator.deformer)); // a bend begins flat, at 0
    to_->setEnabled(!lifts);
    showRow(from_, range.motion == Motion::turning);
    showRow(to_, range.motion == Motion::turning);
    showRow(fromLength_, range.motion == Motion::moving);
    showRow(toLength_, range.motion == Motion::moving);
    const bool turns = range.motion == Motion::turning;
    (turns ? from_ : fromLength_)->setValue(range.min);
    (turns ? to_ : toLength_)->setValue(range.max);
}

/// Another kind of servo; a velocity that it does not reach comes down to what it does.
void ActuatorForm::chooseServo(int row) {
    if (!shown()) return;
    const ServoType* type = row > 0 && row <= static_cast<int>(servoTypes().size()) ? &servoTypes()[row - 1] : nullptr;
    if (row > 0 && !type) return;
    editRig(document_, tr("Change the servo of %1").arg(QString::fromStdString(shown()->name)),
            [this, type](RigParts& parts) {
                Actuator& actuator = parts.actuators[*actuator_];
                actuator.drive.servo = type ? std::string(type->name) : std::string();
                if (type) actuator.maxVelocity = std::min(actuator.maxVelocity, 1.0 / fastestStroke(actuator, *type));
            });
}

void ActuatorForm::showServo(const Actuator& actuator) {
    const ServoType* type = findServo(actuator.drive.servo);
    while (servo_->count() > static_cast<int>(servoTypes().size()) + 1) servo_->removeItem(servo_->count() - 1);
    const QString other = QString::fromStdString(actuator.drive.servo);
    if (!type && !other.isEmpty()) servo_->addItem(other); // of a later version's table
    servo_->setCurrentIndex(type              ? static_cast<int>(type - servoTypes().data()) + 1
                            : other.isEmpty() ? 0
                                              : servo_->count() - 1);
    servo_->setToolTip("What kind of servo moves it: its strength and speed follow from that" +
                       (type ? "\n\n" + servoTypeText(*type) : QString()));
    stroke_->setRange(type ? std::max(kFastestStroke, fastestStroke(actuator, *type)) : kFastestStroke, kSlowestStroke);
    stroke_->setValue(1.0 / actuator.maxVelocity);
    const QString hint = "Time from rest to full stroke at its velocity limit.\n";
    stroke_->setToolTip(type ? hint + QString("The %1 turns it in %2 s at best, without load.")
                                          .arg(shownText(type->name))
                                          .arg(fastestStroke(actuator, *type), 0, 'f', 2)
                             : hint + "Drag sideways, type, or press the arrow keys.");
}

void ActuatorForm::showLoad(const ServoLoad& load) {
    const Actuator* now = shown();
    if (!now) return load_->hide();
    const ServoType* type = findServo(now->drive.servo);
    const bool weak = type && load.weak;
    if (type)
        load_->setText(servoLoadText(load));
    else
        load_->setText(load.lever == 0.0 ? servoLoadText(load)
                       : load.stronger.empty()
                           ? QString("Needs %1: no servo of the table can hold that.").arg(torqueText(load.torque))
                           : QString("Needs %1: the cheapest that can hold that is the %2.")
                                 .arg(torqueText(load.torque), shownText(load.stronger)));
    load_->setProperty("look", weak ? "warning" : "muted");
    load_->style()->unpolish(load_);
    load_->style()->polish(load_);
    load_->show();
}

void ActuatorForm::rename() {
    if (!name_->isModified()) return;
    name_->setModified(false);
    const QString name = name_->text().trimmed();
    if (shown() && !name.isEmpty())
        editRig(document_, tr("Rename to %1").arg(name),
                [this, &name](RigParts& parts) { parts.actuators[*actuator_].name = name.toStdString(); });
    show(actuator_);
}

} // namespace lumorph::studio
