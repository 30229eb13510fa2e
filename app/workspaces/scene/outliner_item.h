#pragma once

#include <QStyledItemDelegate>

namespace lumorph::studio {

/// Draws a row of the outliner: icon, name, a patch of its colour, its role as a badge, and an eye that hides it.
class OutlinerItem : public QStyledItemDelegate {
    Q_OBJECT
public:
    using QStyledItemDelegate::QStyledItemDelegate;
    void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override;
    [[nodiscard]] QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override;
    void updateEditorGeometry(QWidget* editor, const QStyleOptionViewItem& option,
                              const QModelIndex& index) const override;
    bool editorEvent(QEvent* event, QAbstractItemModel* model, const QStyleOptionViewItem& option,
                     const QModelIndex& index) override;
    /// Where a row's eye is.
    [[nodiscard]] static QRect eyeBox(const QRect& row);

signals:
    void eyePressed(const QModelIndex& index);
};

} // namespace lumorph::studio
