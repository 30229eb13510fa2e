#pragma once

#include <QElapsedTimer>
#include <QPushButton>
#include <QTimer>

namespace lumorph::studio {

/// A button for what must not happen by a slip: held for a second, by the left mouse button, Space or Enter, it fills
/// and then emits `held`. Let go of, left or covered before, nothing happens; a click alone never does anything. It
/// must be let go of before it can be held again.
class HoldButton : public QPushButton {
    Q_OBJECT
public:
    static constexpr int kHoldMilliseconds = 1000;

    explicit HoldButton(const QString& text, QWidget* parent = nullptr);
    /// How much of the second has passed, in [0, 1]; 0 while it is not held.
    [[nodiscard]] double progress() const;
    /// As if it had been let go of: what it would do is another thing now.
    void cancel();

signals:
    void held();

protected:
    bool event(QEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void keyReleaseEvent(QKeyEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;
    void hideEvent(QHideEvent* event) override;
    void changeEvent(QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;

private:
    void begin();
    void tick();

    QTimer ticks_;
    QElapsedTimer last_; ///< since the last tick
    qint64 held_ = 0;    ///< milliseconds that count
    int key_ = 0;        ///< that holds it; 0: the mouse
};

} // namespace lumorph::studio
