#pragma once

#include <QWidget>

#include "app/studio/look/icons.h"

namespace lumorph::studio {

/// An icon as a widget; follows the theme.
class IconLabel : public QWidget {
    Q_OBJECT
public:
    IconLabel(const QString& name, IconRole role, int side, QWidget* parent = nullptr);
    void setIcon(const QString& name, IconRole role);

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    QIcon icon_;
};

} // namespace lumorph::studio
