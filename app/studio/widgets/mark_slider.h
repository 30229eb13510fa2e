#pragma once

#include <vector>

#include <QSlider>

namespace lumorph::studio {

/// A line of time with ticks where something was marked; a click goes there at once.
class MarkSlider : public QSlider {
    Q_OBJECT
public:
    struct Mark {
        double seconds = 0.0;
        QString text;
    };
    explicit MarkSlider(QWidget* parent = nullptr);

    void setDuration(double seconds);
    void setMarks(std::vector<Mark> marks);
    void showSeconds(double seconds);

signals:
    /// The user wants to be there.
    void sought(double seconds);

protected:
    bool event(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;

private:
    [[nodiscard]] double secondsAt(double x) const;
    [[nodiscard]] double xOf(double seconds) const;
    void seekTo(double x);

    double duration_ = 0.0;
    std::vector<Mark> marks_;
};

} // namespace lumorph::studio
