#pragma once

#include <QPointer>
#include <QWidget>

namespace lumorph::studio {

/// A sheet over a whole window that dims it; follows the window's size, gives the keyboard back when it leaves, and
/// deletes itself. STOP shows through.
class Overlay : public QWidget {
    Q_OBJECT
public:
    explicit Overlay(QWidget& window);

    void open();
    void leave();

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;
    void paintEvent(QPaintEvent* event) override;
    /// Lays out what is on it for its size now.
    virtual void arrange() {}
    /// Everything but `open` and STOP, which stays lit and in reach whatever lies over the window.
    void coverAllBut(const QRegion& open);
    /// What it darkens the window with.
    [[nodiscard]] static QColor dimming();

private:
    QPointer<QWidget> hadKeyboard_;
};

} // namespace lumorph::studio
