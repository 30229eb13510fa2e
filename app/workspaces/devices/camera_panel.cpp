#include "app/workspaces/devices/camera_panel.h"

#include <utility>

#include <QGridLayout>
#include <QPainter>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/tracking/any_tracker.h"

namespace lumorph::studio {

/// As wide as the dock, in its own proportions.
class CameraPanel::Picture : public QWidget {
public:
    explicit Picture(const QString& name) {
        setObjectName(name);
        setAccessibleName("Picture of the camera");
        setToolTip("What the camera sees. The board's outline is drawn in where it is found, with its axes.");
        QSizePolicy policy(QSizePolicy::Expanding, QSizePolicy::Preferred);
        policy.setHeightForWidth(true);
        setSizePolicy(policy);
    }
    void show(std::shared_ptr<const Image> image) {
        if (image == image_) return;
        const bool shaped = image && (!image_ || image->size() != image_->size());
        image_ = std::move(image);
        if (shaped) updateGeometry();
        update();
    }
    [[nodiscard]] bool hasHeightForWidth() const override { return true; }
    [[nodiscard]] int heightForWidth(int width) const override {
        return image_ ? width * image_->size().y / image_->size().x : width * 9 / 16;
    }
    [[nodiscard]] QSize sizeHint() const override { return {240, heightForWidth(240)}; }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        const Palette& colors = currentPalette();
        QPainter painter(this);
        painter.fillRect(rect(), colors.sunken);
        if (!image_) {
            painter.setPen(colors.textMuted);
            painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, "No picture yet");
            return;
        }
        const QImage shown(image_->pixels().front().data(), image_->size().x, image_->size().y,
                           QImage::Format_RGBA8888);
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        const QSize fitted = shown.size().scaled(size(), Qt::KeepAspectRatio);
        painter.drawImage(QRect(QPoint((width() - fitted.width()) / 2, (height() - fitted.height()) / 2), fitted),
                          shown);
    }

private:
    std::shared_ptr<const Image> image_;
};

CameraPanel::CameraPanel(const QString& name, QWidget* parent)
    : QWidget(parent), picture_(new Picture(name + ".picture")) {
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 4, 0, 0);
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(2);
    grid->setColumnStretch(0, 1);
    grid->addWidget(picture_, 0, 0, 1, 2);
    const auto fact = [&](const char* text, const char* part, const char* widest, const char* tip) {
        auto* title = new QLabel(text);
        title->setProperty("look", "muted");
        QLabel* value = makeNumber(name + '.' + part, widest, this);
        value->setAccessibleName(text);
        for (QLabel* one : {title, value}) one->setToolTip(tip);
        const int row = grid->rowCount();
        grid->addWidget(title, row, 0);
        grid->addWidget(value, row, 1, Qt::AlignRight);
        return value;
    };
    size_ = fact("Pictures", "size", "1920 × 1080, 100.0 /s", "Their size in pixels, and how many come each second");
    fit_ = fact("Reprojection error", "fit", "0.00 px, good",
                "How far the board's corners are from where its pose puts them. Good is up to 0.6 pixels, fair up to "
                "1.5; more says that the print, its measures or the lens are not as the address says.");
    found_ = fact("Board found in", "found", "100 %", "Share of the last hundred pictures");
    lens_ = new QLabel;
    lens_->setObjectName(name + ".lens");
    lens_->setProperty("look", "muted");
    lens_->setTextFormat(Qt::PlainText);
    lens_->setWordWrap(true);
    grid->addWidget(lens_, grid->rowCount(), 0, 1, 2);
}

void CameraPanel::show(const TrackerCamera& camera) {
    picture_->show(camera.preview);
    size_->setText(
        camera.size.x > 0
            ? QString("%1 × %2, %3 /s").arg(camera.size.x).arg(camera.size.y).arg(camera.picturesPerSecond, 0, 'f', 1)
            : QString("none"));
    fit_->setText(
        camera.reprojectionError
            ? QString("%1 px, %2").arg(*camera.reprojectionError, 0, 'f', 2).arg(fitWord(*camera.reprojectionError))
            : QString("not seen"));
    found_->setText(QString::number(100.0 * camera.foundShare, 'f', 0) + " %");
    lens_->setText(QString::fromStdString(camera.lens));
    lens_->setVisible(!camera.lens.empty());
}

} // namespace lumorph::studio
