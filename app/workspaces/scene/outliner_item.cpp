#include "app/workspaces/scene/outliner_item.h"

#include <QMouseEvent>
#include <QPainter>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/workspaces/scene/outliner_model.h"

namespace lumorph::studio {

namespace {

constexpr int kOutlinerHeight = 28;
constexpr int kIcon = 18;
constexpr int kOutlinerGap = 8;
constexpr int kSwatch = 12;
constexpr int kEye = 24;

QRectF middleLeft(const QRect& row, double left, double side) {
    return {left, row.center().y() - side / 2 + 0.5, side, side};
}

/// A badge that ends at `right`; gives where it begins.
int drawBadge(QPainter& painter, const QRect& row, int right, const QString& text, const QFont& font) {
    QFont small = font;
    small.setPixelSize(11);
    const int width = QFontMetrics(small).horizontalAdvance(text) + 12;
    const QRectF box(right - width, row.center().y() - 8.5, width, 18);
    const Palette& colors = currentPalette();
    painter.setPen(QPen(colors.accentText, 1.0));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(box.adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
    painter.setFont(small);
    painter.drawText(box, Qt::AlignCenter, text);
    return right - width - kOutlinerGap;
}

void drawHeading(QPainter& painter, const QStyleOptionViewItem& option, const QString& text) {
    QFont bold = option.font;
    bold.setWeight(QFont::DemiBold);
    painter.setFont(bold);
    painter.setPen(currentPalette().text);
    painter.drawText(option.rect.adjusted(2, 0, 0, 0), Qt::AlignLeft | Qt::AlignVCenter, text);
}

} // namespace

QRect OutlinerItem::eyeBox(const QRect& row) { return {row.right() - kEye, row.top(), kEye, row.height()}; }

QSize OutlinerItem::sizeHint(const QStyleOptionViewItem& /*option*/, const QModelIndex& /*index*/) const {
    return {160, kOutlinerHeight};
}

void OutlinerItem::paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const {
    const Palette& colors = currentPalette();
    const QRect row = option.rect;
    const auto text = [&index](int role) { return index.data(role).toString(); };
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    if (index.data(OutlinerModel::headingRole).toBool()) {
        drawHeading(*painter, option, text(Qt::DisplayRole));
        painter->restore();
        return;
    }
    const bool chosen = option.state & QStyle::State_Selected;
    const bool selectable = index.flags() & Qt::ItemIsSelectable;
    if (selectable && (chosen || option.state & QStyle::State_MouseOver)) {
        painter->setPen(Qt::NoPen);
        painter->setBrush(chosen ? selectedColor(colors) : colors.hovered);
        painter->drawRoundedRect(QRectF(row).adjusted(0, 1, -1, -1), 4, 4);
    }
    const bool muted = index.data(OutlinerModel::mutedRole).toBool();
    int left = row.left() + 4;
    if (const QString name = text(OutlinerModel::iconRole); !name.isEmpty()) {
        paintIcon(*painter, middleLeft(row, left, kIcon), name, chosen ? colors.accentText : colors.textMuted);
        left += kIcon + kOutlinerGap;
    }
    int right = row.right() - kOutlinerGap;
    if (index.data(OutlinerModel::canHideRole).toBool()) {
        const bool visible = index.data(OutlinerModel::visibleRole).toBool();
        paintIcon(*painter, middleLeft(row, row.right() - kEye + 3, kIcon), visible ? "eye" : "eye-off",
                  visible ? colors.textMuted : disabledText(colors));
        right = row.right() - kEye - kOutlinerGap / 2;
    }
    if (const QString badge = text(OutlinerModel::badgeRole); !badge.isEmpty())
        right = drawBadge(*painter, row, right, badge, option.font);
    if (const QVariant swatch = index.data(OutlinerModel::swatchRole); swatch.isValid()) {
        painter->setPen(colors.border);
        painter->setBrush(swatch.value<QColor>());
        painter->drawEllipse(middleLeft(row, right - kSwatch, kSwatch).adjusted(0.5, 0.5, -0.5, -0.5));
        right -= kSwatch + kOutlinerGap;
    }
    painter->setFont(option.font);
    painter->setPen(muted ? colors.textMuted : colors.text);
    const QRect words(left, row.top(), right - left, row.height());
    painter->drawText(words, Qt::AlignLeft | Qt::AlignVCenter,
                      QFontMetrics(option.font).elidedText(text(Qt::DisplayRole), Qt::ElideRight, words.width()));
    painter->restore();
}

void OutlinerItem::updateEditorGeometry(QWidget* editor, const QStyleOptionViewItem& option,
                                        const QModelIndex& /*index*/) const {
    editor->setGeometry(option.rect.adjusted(kIcon + kOutlinerGap, 0, -kEye, 0));
}

bool OutlinerItem::editorEvent(QEvent* event, QAbstractItemModel* model, const QStyleOptionViewItem& option,
                               const QModelIndex& index) {
    const bool press = event->type() == QEvent::MouseButtonPress;
    const bool onEye =
        (press || event->type() == QEvent::MouseButtonDblClick || event->type() == QEvent::MouseButtonRelease) &&
        index.data(OutlinerModel::canHideRole).toBool() &&
        eyeBox(option.rect).contains(static_cast<QMouseEvent*>(event)->position().toPoint());
    if (!onEye) return QStyledItemDelegate::editorEvent(event, model, option, index);
    if (event->type() != QEvent::MouseButtonRelease) emit eyePressed(index);
    return true;
}

} // namespace lumorph::studio
