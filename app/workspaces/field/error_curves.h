#pragma once

#include <vector>

#include <QStringList>
#include <QWidget>

#include "core/mdf/voting.h"

namespace lumorph::studio {

/// The error curves of all actuators side by side, a small plot each, with the level that each is asked for. Dragging
/// in one shows the device at the level under the pointer and lets go of it at the end; a double click, or Enter, keeps
/// it. By keyboard the arrow keys go from curve to curve, and Shift with them tries levels.
class ErrorCurves : public QWidget {
    Q_OBJECT
public:
    explicit ErrorCurves(QWidget* parent = nullptr);

    void setNames(const QStringList& names);
    /// One vote and one level an actuator. While a level is tried, the curves stay what they were.
    void setVotes(const std::vector<ActuatorVote>& votes, const std::vector<Level>& levels);
    void setCurrent(int actuator);
    [[nodiscard]] int current() const noexcept { return current_; }
    [[nodiscard]] bool trying() const noexcept { return tried_ >= 0; }

    [[nodiscard]] bool hasHeightForWidth() const override { return true; }
    [[nodiscard]] int heightForWidth(int width) const override;
    [[nodiscard]] QSize sizeHint() const override;
    /// Where things are drawn, widget pixels; for tests.
    [[nodiscard]] QRect cellOf(int actuator) const;
    [[nodiscard]] int xOf(int actuator, int level) const;

signals:
    void chosen(int actuator);
    void previewed(int actuator, int level);
    void letGo();
    void kept(int actuator, int level);

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void keyReleaseEvent(QKeyEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

private:
    [[nodiscard]] int columns(int width) const;
    [[nodiscard]] QRect plotOf(int actuator) const;
    [[nodiscard]] int cellAt(const QPoint& place) const;
    [[nodiscard]] int levelAt(int actuator, int x) const;
    [[nodiscard]] int stepsOf(int actuator) const;
    void choose(int actuator);
    void tryLevel(int level);
    void endTry(bool keep);
    void drawCell(QPainter& painter, int actuator) const;

    QStringList names_;
    std::vector<std::vector<double>> curves_; ///< empty for an actuator out of whose reach the target is
    std::vector<int> levels_;
    int current_ = -1;
    int tried_ = -1; ///< level that is shown of the current actuator
    bool dragging_ = false;
};

} // namespace lumorph::studio
