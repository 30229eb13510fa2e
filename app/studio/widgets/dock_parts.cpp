#include "app/studio/widgets/dock_parts.h"

#include <algorithm>
#include <cmath>

namespace lumorph::studio {

QPushButton* makeCommandButton(QAction* command, const QString& name, QWidget* parent, bool primary) {
    auto* button = new QPushButton(parent);
    button->setObjectName(name);
    button->setEnabled(false);
    if (primary) button->setProperty("look", "primary");
    if (!command) return button;
    const auto follow = [button, command, primary] {
        button->setText(command->iconText());
        if (!primary) button->setIcon(command->icon());
        button->setToolTip(command->toolTip());
        button->setEnabled(command->isEnabled());
        button->setCheckable(command->isCheckable());
        button->setChecked(command->isChecked());
    };
    follow();
    QObject::connect(command, &QAction::changed, button, follow);
    QObject::connect(button, &QPushButton::clicked, command, [command, follow] {
        command->trigger();
        follow(); // a click on what is on already, such as the chosen one of two, changes nothing
    });
    return button;
}

QToolButton* makeCommandIcon(QAction* command, const QString& name, QWidget* parent) {
    auto* button = new QToolButton(parent);
    button->setObjectName(name);
    button->setToolButtonStyle(Qt::ToolButtonIconOnly);
    button->setIconSize({20, 20});
    button->setFocusPolicy(Qt::StrongFocus);
    if (command)
        button->setDefaultAction(command);
    else
        button->setEnabled(false);
    return button;
}

QLabel* makeNumber(const QString& name, const QString& widest, QWidget* parent) {
    auto* label = new QLabel(parent);
    label->setObjectName(name);
    label->setTextFormat(Qt::PlainText);
    label->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    label->setMinimumWidth(label->fontMetrics().horizontalAdvance(widest));
    return label;
}

void makeLarge(QLabel* label, int pixels, const QString& widest) {
    QFont large = label->font();
    large.setPixelSize(pixels);
    large.setWeight(QFont::DemiBold);
    label->setFont(large);
    label->setMinimumWidth(QFontMetrics(large).horizontalAdvance(widest) + 2);
}

QString volumeText(double cubicMetres) {
    const double cubicCentimetres = cubicMetres * 1e6;
    return QString("%1 cm³").arg(cubicCentimetres, 0, 'f', cubicCentimetres < 9.95 ? 1 : 0);
}

QString sizeText(double x, double y, double z) {
    return QString("%1 × %2 × %3 cm").arg(100.0 * x, 0, 'f', 1).arg(100.0 * y, 0, 'f', 1).arg(100.0 * z, 0, 'f', 1);
}

QString shareText(double share) { return QString("%1 %").arg(std::round(100.0 * share), 0, 'f', 0); }

} // namespace lumorph::studio
