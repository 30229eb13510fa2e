#pragma once

#include <QStyledItemDelegate>

namespace lumorph::studio {

/// What an item of the list says in its second line.
inline constexpr int kActuatorDetail = Qt::UserRole;
/// Name of its icon; without one that of an actuator.
inline constexpr int kActuatorIcon = Qt::UserRole + 1;

/// Draws an actuator in a list: its icon, its name, and how it moves in a second, muted line.
class ActuatorItem : public QStyledItemDelegate {
    Q_OBJECT
public:
    using QStyledItemDelegate::QStyledItemDelegate;
    void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override;
    [[nodiscard]] QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override;
};

} // namespace lumorph::studio
