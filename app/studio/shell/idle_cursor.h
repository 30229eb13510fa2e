#pragma once

#include <QObject>
#include <QTimer>

namespace lumorph::studio {

/// Hides the pointer while it is still for some seconds, as on a show screen.
class IdleCursor : public QObject {
    Q_OBJECT
public:
    explicit IdleCursor(QObject* parent);
    ~IdleCursor() override;

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void setHidden(bool hidden);

    QTimer idle_;
    bool hidden_ = false;
};

} // namespace lumorph::studio
