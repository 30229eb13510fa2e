#pragma once

#include <vector>

#include <QImage>
#include <QPolygonF>
#include <QString>
#include <QWidget>

namespace lumorph::studio {

/// What is drawn over a picture of the camera; all points in its pixels.
struct PictureMarks {
    std::vector<QPointF> corners;    ///< of the board
    std::vector<QPolygonF> coverage; ///< where boards have been
    QPolygonF ghost;                 ///< where the board should be next
    QString ghostText;
    struct Arrow {
        QPointF at, error;
    };
    std::vector<Arrow> arrows; ///< drawn `arrowScale` times as long
    double arrowScale = 1.0;
    QString words;                ///< in the lower left corner
    std::vector<float> histogram; ///< shares, dark to bright, in the lower right corner; empty: none
    QString light;                ///< above it: how sharp, how much is clipped
};

/// A picture as large as fits, with marks over it.
class CapturePicture : public QWidget {
    Q_OBJECT
public:
    explicit CapturePicture(QWidget* parent = nullptr);

    /// `pixels` is the size in which marks are told, which need not be the picture's. A null picture: `emptyText`.
    void show(const QImage& picture, QSize pixels, PictureMarks marks, const QString& emptyText);
    [[nodiscard]] const PictureMarks& marks() const noexcept { return marks_; }
    [[nodiscard]] const QImage& picture() const noexcept { return picture_; }
    [[nodiscard]] QSize sizeHint() const override { return {640, 480}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {240, 160}; }

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    QImage picture_;
    QSize pixels_;
    PictureMarks marks_;
    QString emptyText_;
};

} // namespace lumorph::studio
