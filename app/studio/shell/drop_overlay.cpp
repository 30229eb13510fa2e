#include "app/studio/shell/drop_overlay.h"

#include <QPainter>
#include <QUrl>

#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"

namespace lumorph::studio {

std::vector<std::filesystem::path> localFiles(const QMimeData& dragged) {
    std::vector<std::filesystem::path> files;
    for (const QUrl& url : dragged.urls())
        if (url.isLocalFile()) files.emplace_back(url.toLocalFile().toStdString());
    return files;
}

DropOverlay::DropOverlay(QWidget& window, const QMimeData& dragged)
    : Overlay(window),
      text_(localFiles(dragged).empty()
                ? "Only files on this computer can be opened; save it to a folder first"
                : "Drop a 3D model to make it the target;\na rig, field, project or recording to open it") {
    setObjectName("dropOverlay");
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setFocusPolicy(Qt::NoFocus);
}

void DropOverlay::paintEvent(QPaintEvent* event) {
    Overlay::paintEvent(event);
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    QRectF card(0, 0, std::min(440, width() - 32), 168);
    card.moveCenter(QRectF(rect()).center());
    painter.setPen(QPen(colors.accent, 2, Qt::DashLine));
    painter.setBrush(colors.panel);
    painter.drawRoundedRect(card, 12, 12);
    paintIcon(painter, QRectF(card.center().x() - 20, card.top() + 28, 40, 40), "drop", colors.accentText);
    painter.setPen(colors.text);
    QFont font = this->font();
    font.setPixelSize(15);
    font.setWeight(QFont::Medium);
    painter.setFont(font);
    painter.drawText(card.adjusted(24, 76, -24, -16), Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap, text_);
}

} // namespace lumorph::studio
