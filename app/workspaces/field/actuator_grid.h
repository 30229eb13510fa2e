#pragma once

#include <vector>

#include <QStringList>
#include <QWidget>

namespace lumorph::studio {

/// Many actuators at a glance: a cell each, filled as high as it is, with a line where it is asked to be. One is
/// current, chosen by click or arrow keys; it is edited elsewhere.
class ActuatorGrid : public QWidget {
    Q_OBJECT
public:
    explicit ActuatorGrid(QWidget* parent = nullptr);

    void setNames(QStringList names);
    /// Strokes in [0, 1], one a name each.
    void setStrokes(const std::vector<double>& wanted, const std::vector<double>& estimated);
    void setLive(bool live);
    void setCurrent(int index);
    [[nodiscard]] int current() const noexcept { return current_; }
    [[nodiscard]] QRect cellOf(int index) const;
    /// -1: none.
    [[nodiscard]] int cellAt(const QPoint& place) const;

    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] bool hasHeightForWidth() const override { return true; }
    [[nodiscard]] int heightForWidth(int width) const override;

signals:
    void currentChanged(int index);

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    [[nodiscard]] int columns() const;
    [[nodiscard]] int cellSize(int width) const;

    QStringList names_;
    std::vector<double> wanted_, estimated_;
    bool live_ = false;
    int current_ = 0;
};

} // namespace lumorph::studio
