#include "app/workspaces/common/style_form.h"

#include <cmath>

#include <QGuiApplication>
#include <QPointer>
#include <QScreen>
#include <QShowEvent>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"

namespace lumorph::studio {
namespace {

/// Smaller on a small screen, so that the buttons below stay on it.
QSize previewBox() {
    constexpr QSize kUsual(384, 240);
    constexpr int kSmallScreen = 680;
    const bool small = QGuiApplication::primaryScreen()->availableSize().height() < kSmallScreen;
    return small ? kUsual * 0.38 : kUsual;
}
constexpr double kMinSide = 64.0;
constexpr double kMaxSide = 8192.0;

ValueField* sideField(const QString& id, int value, const QString& name) {
    auto* field = new ValueField(Quantity::level, kMinSide, kMaxSide, value);
    field->setObjectName(id);
    field->setAccessibleName(name);
    field->setStep(2.0);
    field->setValue(value);
    return field;
}

/// The largest size of this shape inside the preview.
QSize previewSize(const QSize& size) {
    return size.scaled(previewBox(), Qt::KeepAspectRatio).expandedTo(QSize(16, 16));
}

} // namespace

StyleForm::StyleForm(const QString& id, const PictureStyle& start, const std::vector<Size>& sizes,
                     PreviewPainter preview, QWidget* parent)
    : QWidget(parent), preview_(std::move(preview)), picture_(new QLabel), sizes_(new QComboBox),
      width_(sideField(id + ".width", start.size.width(), tr("Width in pixels"))),
      height_(sideField(id + ".height", start.size.height(), tr("Height in pixels"))), theme_(new QComboBox),
      grid_(new QCheckBox(tr("&Grid on the ground"))), label_(new QCheckBox(tr("Write how &large its squares are"))) {
    picture_->setObjectName(id + ".preview");
    picture_->setFixedSize(previewBox());
    picture_->setAlignment(Qt::AlignCenter);
    picture_->setAccessibleName(tr("Preview"));
    picture_->setProperty("look", "muted");
    picture_->setText(tr("Drawing the preview..."));
    sizes_->setObjectName(id + ".size");
    for (const Size& size : sizes)
        sizes_->addItem(tr("%1  (%2 × %3)").arg(size.text).arg(size.pixels.width()).arg(size.pixels.height()),
                        size.pixels);
    sizes_->addItem(tr("Another size"));
    theme_->setObjectName(id + ".theme");
    theme_->addItems({tr("Dark"), tr("Light")});
    theme_->setCurrentIndex(start.theme == Theme::dark ? 0 : 1);
    grid_->setObjectName(id + ".grid");
    grid_->setChecked(start.grid);
    label_->setObjectName(id + ".label");
    label_->setChecked(start.gridLabel);
    label_->setEnabled(start.grid);

    auto* sides = new QWidget;
    auto* sidesLayout = new QHBoxLayout(sides);
    sidesLayout->setContentsMargins(0, 0, 0, 0);
    sidesLayout->addWidget(width_);
    sidesLayout->addWidget(new QLabel(QStringLiteral("×")));
    sidesLayout->addWidget(height_);
    sides->setFocusProxy(width_);

    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    layout->addWidget(picture_, 0, Qt::AlignHCenter);
    layout->addWidget(makeRow(tr("&Size"), sizes_));
    layout->addWidget(makeRow(tr("&Pixels"), sides));
    layout->addWidget(makeRow(tr("&Theme"), theme_));
    layout->addWidget(grid_);
    layout->addWidget(label_);

    delay_.setSingleShot(true);
    delay_.setInterval(120);
    connect(&delay_, &QTimer::timeout, this, &StyleForm::drawPreview);
    connect(sizes_, &QComboBox::currentIndexChanged, this, [this] {
        if (const QSize size = sizes_->currentData().toSize(); size.isValid()) {
            width_->setValue(size.width());
            height_->setValue(size.height());
        }
        delay_.start();
    });
    for (ValueField* side : {width_, height_}) {
        connect(side, &ValueField::committed, this, &StyleForm::showSize);
        connect(side, &ValueField::previewed, this, &StyleForm::showSize);
    }
    connect(theme_, &QComboBox::currentIndexChanged, this, [this] { delay_.start(); });
    connect(grid_, &QCheckBox::toggled, this, [this](bool on) {
        label_->setEnabled(on);
        delay_.start();
    });
    connect(label_, &QCheckBox::toggled, this, [this] { delay_.start(); });
    showSize();
}

PictureStyle StyleForm::style() const {
    PictureStyle style;
    style.size = QSize(static_cast<int>(std::lround(width_->value())), static_cast<int>(std::lround(height_->value())));
    style.theme = theme_->currentIndex() == 0 ? Theme::dark : Theme::light;
    style.grid = grid_->isChecked();
    style.gridLabel = label_->isChecked();
    return style;
}

void StyleForm::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    delay_.start();
}

void StyleForm::showSize() {
    const int known = sizes_->findData(style().size);
    const QSignalBlocker quiet(sizes_);
    sizes_->setCurrentIndex(known >= 0 ? known : sizes_->count() - 1);
    delay_.start();
}

void StyleForm::drawPreview() {
    PictureStyle small = style();
    small.size = previewSize(small.size);
    const int number = ++asked_;
    preview_(small, [self = QPointer<StyleForm>(this), number](const QImage& image) {
        if (self && number == self->asked_ && !image.isNull()) self->picture_->setPixmap(QPixmap::fromImage(image));
    });
}

} // namespace lumorph::studio
