#include "app/workspaces/field/dock_parts.h"

#include <algorithm>
#include <cmath>

#include <QLocale>

namespace lumorph::studio {

QToolButton* makeActionButton(QAction* action, bool withText, QWidget* parent) {
    auto* button = new QToolButton(parent);
    button->setToolButtonStyle(withText ? Qt::ToolButtonTextBesideIcon : Qt::ToolButtonIconOnly);
    button->setSizePolicy(withText ? QSizePolicy::Expanding : QSizePolicy::Fixed, QSizePolicy::Fixed);
    button->setFocusPolicy(Qt::StrongFocus);
    if (action)
        button->setDefaultAction(action);
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

QString volumeText(double cubicMetres) {
    const double cubicCentimetres = cubicMetres * 1e6;
    return QString("%1 cm³").arg(cubicCentimetres, 0, 'f', cubicCentimetres < 9.95 ? 1 : 0);
}

QString sizeText(double x, double y, double z) {
    return QString("%1 × %2 × %3 cm").arg(100.0 * x, 0, 'f', 1).arg(100.0 * y, 0, 'f', 1).arg(100.0 * z, 0, 'f', 1);
}

QString shareText(double share) { return QString("%1 %").arg(std::round(100.0 * share), 0, 'f', 0); }

QString countText(std::size_t count) {
    return QLocale(QLocale::English).toString(static_cast<qulonglong>(count));
}

} // namespace lumorph::studio
