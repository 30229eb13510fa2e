#pragma once

#include <QFocusFrame>
#include <QPointer>

namespace lumorph::studio {

/// A ring in the accent colour around the widget that has the keyboard, shown only after it was reached by the
/// keyboard, so that clicking leaves no rings behind. The application owns it.
class FocusRing : public QObject {
    Q_OBJECT
public:
    explicit FocusRing(QObject* parent);

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void follow(QWidget* widget);

    QPointer<QFocusFrame> frame_;
    bool byKeyboard_ = false;
};

} // namespace lumorph::studio
