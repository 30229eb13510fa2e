#include "app/workspaces/common/driver_hint.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

#include "app/studio/look/icons.h"

namespace lumorph::studio {
namespace {

QString sentenceOf(const DriverControl& control) {
    const Driver driver = control.driver();
    switch (driver) {
    case Driver::hand:
        return QObject::tr("You move the servos by hand. The numbers say how well your pose fits the target.");
    case Driver::dance:
        return QObject::tr("The servos dance, so the target is not matched.");
    case Driver::recording:
        return QObject::tr("The recording '%1' is shown, so the target is not matched.").arg(control.nameOf(driver));
    case Driver::sceneItem:
        return QObject::tr("'%1' of the scene moves the servos, so the target is not matched.")
            .arg(control.nameOf(driver));
    case Driver::program:
        return QObject::tr("The show program moves the servos, so the target is not matched.");
    case Driver::target:
        break;
    }
    return {};
}

} // namespace

QWidget* makeDriverHint(Studio& studio, const QString& name, QWidget* parent) {
    auto* hint = new QWidget(parent);
    hint->setObjectName(name);
    auto* text = new QLabel(hint);
    text->setObjectName(name + ".text");
    text->setWordWrap(true);
    text->setProperty("look", "muted");
    auto* button = new QPushButton(icon("target", IconRole::onAccent), QObject::tr("Match it"), hint);
    button->setObjectName(name + ".remedy");
    button->setProperty("look", "primary");
    button->setToolTip(QObject::tr("The servos follow the target"));
    QObject::connect(button, &QPushButton::clicked, hint, [&studio] { studio.driver.choose(Driver::target); });
    auto* layout = new QHBoxLayout(hint);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    layout->addWidget(text, 1);
    layout->addWidget(button, 0, Qt::AlignTop);
    const auto follow = [&studio, hint, text] {
        const bool target = static_cast<bool>(studio.document.state().target.target);
        hint->setVisible(target && studio.driver.driver() != Driver::target);
        text->setText(sentenceOf(studio.driver));
    };
    QObject::connect(&studio.driver, &DriverControl::changed, hint, follow);
    follow();
    return hint;
}

bool isTargetLeft(const Studio& studio) {
    const Driver driver = studio.driver.driver();
    return driver != Driver::target && driver != Driver::hand;
}

} // namespace lumorph::studio
