#pragma once

#include <optional>
#include <vector>

#include <QWidget>

#include "core/motion/pose_sequence.h"

namespace lumorph::studio {

/// Steps of a sequence side by side, as long as they last: the way to a pose as the curve of its easing, then the time
/// it is held. A part that the servos need beyond what was set is hatched. Dragging moves a step to another place; keys
/// choose (arrows), move (Alt with arrows) and remove (Delete).
class PoseTimeline : public QWidget {
    Q_OBJECT
public:
    explicit PoseTimeline(QWidget* parent = nullptr);

    /// `planned` has as many steps as `set`, each at least as long.
    void setSequence(const PoseSequence& set, const PoseSequence& planned);
    void setChosen(int step);
    /// Where the sequence is, seconds of this round; empty: it does not play.
    void setPlayhead(std::optional<double> seconds);
    /// The width there is to fill; more steps than fit make it wider.
    void setRoom(int width);

    /// The box of a step, pixels.
    [[nodiscard]] QRect boxOf(int step) const;
    [[nodiscard]] double playheadX() const; ///< pixels; -1 without one
    [[nodiscard]] QSize sizeHint() const override;

signals:
    void chosen(int step); ///< by the user
    void moved(int from, int to);
    void removed();

protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    bool event(QEvent* event) override;

private:
    void layOut();
    [[nodiscard]] int stepAt(double x) const;
    [[nodiscard]] double xOf(double seconds) const;
    [[nodiscard]] int dropPlace() const;
    void paintStep(QPainter& painter, int step) const;
    void paintScale(QPainter& painter) const;
    void choose(int step);
    [[nodiscard]] int count() const { return static_cast<int>(set_.steps.size()); }

    PoseSequence set_;
    PoseSequence planned_;
    std::vector<double> edges_; ///< where each step begins, and the last ends; pixels
    int chosen_ = -1;
    int room_ = 0;
    std::optional<double> playhead_;
    int pressed_ = -1;
    double pressX_ = 0.0, dragX_ = 0.0;
    bool dragging_ = false;
};

} // namespace lumorph::studio
