#include "app/workspaces/rig/target_tiles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <QElapsedTimer>
#include <QGridLayout>
#include <QPainter>
#include <QTimer>

#include "app/studio/widgets/dock_parts.h"

namespace lumorph::studio {
namespace {

constexpr int kNarrowest = 92;
constexpr int kHeight = 104;
constexpr int kGap = 6;
constexpr int kMargin = 6;
constexpr int kWordsHeight = 18;
constexpr int kBarHeight = 4;

} // namespace

TargetTile::TargetTile(const QString& name, QWidget* parent) : QAbstractButton(parent) {
    setText(name);
    setCheckable(true);
    setFocusPolicy(Qt::StrongFocus);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
}

void TargetTile::setFit(const TargetFit& fit, FitRelief relief) {
    relief_ = std::move(relief);
    picture_ = {};
    percent_ = static_cast<int>(std::lround(100.0 * fit.iou));
    setAccessibleName(QString("%1, %2 fit").arg(text(), shareText(fit.iou)));
    setToolTip(targetText(fit) + "\nClick to see the device take on this shape in the view");
    update();
}

void TargetTile::setStale(bool stale) {
    if (std::exchange(stale_, stale) != stale) update();
}

QSize TargetTile::sizeHint() const { return {kNarrowest, kHeight}; }

void TargetTile::changeEvent(QEvent* event) {
    if (event->type() == QEvent::StyleChange || event->type() == QEvent::PaletteChange) picture_ = {};
    QAbstractButton::changeEvent(event);
}

void TargetTile::enterEvent(QEnterEvent* event) {
    update();
    QAbstractButton::enterEvent(event);
}

void TargetTile::leaveEvent(QEvent* event) {
    update();
    QAbstractButton::leaveEvent(event);
}

/// All of a library at once would hold the window up for a tenth of a second.
void TargetTile::makePicture(const QSize& pixels) {
    constexpr int kApart = 8; // milliseconds
    static QElapsedTimer last;
    if (last.isValid() && last.elapsed() < kApart) {
        QTimer::singleShot(2 * kApart, this, qOverload<>(&QWidget::update));
        return;
    }
    picture_ = pictureOf(relief_, pixels, currentPalette());
    last.start();
}

void TargetTile::paintEvent(QPaintEvent* /*event*/) {
    const Palette& colors = currentPalette();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF frame = QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5);
    painter.setPen(isChecked() ? QPen(colors.accent, 1.5) : QPen(underMouse() ? colors.border : colors.line, 1.0));
    painter.setBrush(isChecked() ? selectedColor(colors) : underMouse() ? colors.hovered : colors.sunken);
    painter.drawRoundedRect(frame, 4, 4);
    if (stale_) painter.setOpacity(0.4);
    const QRect inner = rect().adjusted(kMargin, kMargin, -kMargin, -kMargin);
    const QRect bar(inner.left(), inner.bottom() - kBarHeight + 1, inner.width(), kBarHeight);
    const QRect words(inner.left(), bar.top() - kWordsHeight, inner.width(), kWordsHeight);
    const QSize room(inner.width(), words.top() - inner.top());
    const QSize pixels = room * devicePixelRatioF();
    if (picture_.size() != pixels) makePicture(pixels);
    if (!picture_.isNull()) painter.drawImage(QRect(inner.topLeft(), room), picture_);
    const QString percent = QString("%1 %").arg(percent_);
    const int wide = painter.fontMetrics().horizontalAdvance("100 %") + 4;
    painter.setPen(colors.text);
    painter.drawText(words, Qt::AlignRight | Qt::AlignVCenter, percent);
    painter.setPen(colors.textMuted);
    const QString name = painter.fontMetrics().elidedText(text(), Qt::ElideRight, words.width() - wide);
    painter.drawText(words, Qt::AlignLeft | Qt::AlignVCenter, name);
    painter.setPen(Qt::NoPen);
    painter.setBrush(colors.line);
    painter.drawRoundedRect(bar, 2, 2);
    painter.setBrush(colors.success);
    painter.drawRoundedRect(QRectF(bar.left(), bar.top(), 0.01 * percent_ * bar.width(), bar.height()), 2, 2);
}

TargetTiles::TargetTiles(QWidget* parent) : QWidget(parent) {
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setSpacing(kGap);
    setMinimumWidth(2 * kNarrowest + kGap);
}

void TargetTiles::setFit(const DeviceFit& fit) {
    makeTiles(fit.fit);
    for (std::size_t t = 0; t < tiles_.size(); ++t) tiles_[t]->setFit(fit.fit.targets[t], fit.reliefs[t]);
}

void TargetTiles::makeTiles(const LibraryFit& fit) {
    std::vector<std::string> names;
    for (const TargetFit& target : fit.targets) names.push_back(target.name);
    if (names == names_) return;
    names_ = std::move(names);
    for (TargetTile* tile : tiles_) delete tile;
    tiles_.clear();
    chosen_.reset();
    for (std::size_t t = 0; t < names_.size(); ++t) {
        auto* tile = new TargetTile(targetTitle(names_[t]), this);
        tile->setObjectName("rig.fit.target." + QString::fromStdString(names_[t]));
        connect(tile, &TargetTile::clicked, this, [this, t] { toggle(t); });
        tiles_.push_back(tile);
    }
    columns_ = 0;
    arrange();
}

void TargetTiles::setStale(bool stale) {
    for (TargetTile* tile : tiles_) tile->setStale(stale);
}

void TargetTiles::choose(std::optional<std::size_t> target) {
    chosen_ = target;
    for (std::size_t t = 0; t < tiles_.size(); ++t) tiles_[t]->setChecked(target == t);
}

void TargetTiles::toggle(std::size_t target) {
    choose(chosen_ == target ? std::nullopt : std::optional(target));
    emit chosenChanged();
}

void TargetTiles::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    arrange();
}

void TargetTiles::arrange() {
    const int columns = std::max(2, (width() + kGap) / (kNarrowest + kGap));
    if (columns == columns_ || tiles_.empty()) return;
    auto* grid = static_cast<QGridLayout*>(layout());
    for (int c = 0; c < std::max(columns, columns_); ++c) grid->setColumnStretch(c, c < columns ? 1 : 0);
    columns_ = columns;
    for (int i = 0; TargetTile * tile : tiles_) {
        grid->addWidget(tile, i / columns, i % columns);
        tile->show();
        ++i;
    }
}

} // namespace lumorph::studio
