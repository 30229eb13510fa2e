#pragma once

#include <functional>
#include <optional>

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QWidget>

#include "app/studio/document/studio_document.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/rig/actuator_preview.h"

namespace lumorph::studio {

/// The chosen actuator's name, range, velocity, damping and kind of servo to be edited, each edit by one step of undo;
/// what is dragged shows at once. Fields are named "rig.edit.name", ".from", ".to", ".stroke" and ".damping", and
/// ".fromLength" and ".toLength" of one that moves along a line, ".servo" and below it what that has to hold, ".load".
class ActuatorForm : public QWidget {
    Q_OBJECT
public:
    explicit ActuatorForm(StudioDocument& document, QWidget* parent = nullptr);

    /// Shows one of the document's actuators as it is now; hidden without one.
    void show(std::optional<std::size_t> actuator);
    /// What its servo has to hold, of the newest rig that was compiled; the actuators' order is the document's.
    void showLoad(const Rig& rig);

signals:
    /// How far or how fast it moves was edited.
    void motionChanged();

private:
    using Edit = std::function<void(Actuator&, double)>;
    void addRange();
    struct Words {
        QString name, label, hint;
        QString step; ///< of undo, before the actuator's name
    };
    struct Limits {
        Quantity quantity;
        double low, high, reset;
    };
    ValueField* addField(const Words& words, const Limits& limits, const Edit& edit);
    void addServo();
    void chooseServo(int row);
    void showRange(const Actuator& actuator);
    void showServo(const Actuator& actuator);
    void rename();
    [[nodiscard]] const Actuator* shown() const;
    void preview(const Edit& edit, double value);

    StudioDocument& document_;
    std::optional<std::size_t> actuator_;
    ActuatorPreview preview_;
    QLineEdit* name_;
    ValueField *from_ = nullptr, *to_ = nullptr;             ///< of one that turns
    ValueField *fromLength_ = nullptr, *toLength_ = nullptr; ///< of one that moves along a line
    ValueField *stroke_ = nullptr, *damping_ = nullptr;
    QComboBox* servo_;
    QLabel* load_;
};

} // namespace lumorph::studio
