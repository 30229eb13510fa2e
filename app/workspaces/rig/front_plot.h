#pragma once

#include <optional>
#include <vector>

#include <QString>
#include <QWidget>

namespace lumorph::studio {

struct PlotAxes;

/// Designs as dots, cost across and fit up, joined by the steps of what no design beats; the device that is open as a
/// cross. By keyboard the arrow keys go from dot to dot, and Enter takes one.
class FrontPlot : public QWidget {
    Q_OBJECT
public:
    struct Dot {
        double cost = 0.0;
        double fit = 0.0; ///< 0 to 1; drawn in percent
        bool operator==(const Dot&) const = default;
    };

    explicit FrontPlot(QWidget* parent = nullptr);

    /// What cost is called, and the range that it has at least.
    void setCost(const QString& name, double most);
    /// The cheapest first.
    void setDots(std::vector<Dot> dots);
    void setOpenDevice(std::optional<Dot> dot);
    /// The dot that is chosen; it may have left the front.
    void setChosen(std::optional<Dot> dot);
    void setEmptyText(const QString& text);

    [[nodiscard]] const std::vector<Dot>& dots() const noexcept { return dots_; }
    [[nodiscard]] const std::optional<Dot>& openDevice() const noexcept { return open_; }
    /// Where a dot is drawn, widget pixels.
    [[nodiscard]] QPointF placeOf(const Dot& dot) const;
    [[nodiscard]] QSize sizeHint() const override { return {280, 220}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {160, 150}; }

signals:
    void hovered(int dot); ///< -1: none
    void clicked(int dot);
    void taken(int dot); ///< double click, or Enter

protected:
    void paintEvent(QPaintEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;

private:
    [[nodiscard]] PlotAxes axes() const;
    [[nodiscard]] int dotAt(const QPointF& pixel) const;
    [[nodiscard]] int chosenDot() const;
    void hover(int dot);
    void drawDots(QPainter& painter, const PlotAxes& axes) const;
    void drawOpenDevice(QPainter& painter, const PlotAxes& axes) const;

    std::vector<Dot> dots_;
    std::optional<Dot> open_, chosen_;
    QString cost_, empty_;
    double most_ = 1.0;
    int hover_ = -1;
};

} // namespace lumorph::studio
