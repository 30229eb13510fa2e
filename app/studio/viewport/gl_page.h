#pragma once

#include <functional>

#include <QLabel>
#include <QWidget>

namespace lumorph::studio {

/// Stands in for a view that cannot be drawn: what is missing, what to do, and a button to look again.
class GlPage : public QWidget {
public:
    /// `retry` runs when the button is pressed.
    GlPage(std::function<void()> retry, QWidget* parent);

    void setReason(const QString& why);

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    QLabel* title_;
    QLabel* reason_;
    QLabel* rest_;
};

} // namespace lumorph::studio
