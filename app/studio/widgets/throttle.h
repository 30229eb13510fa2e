#pragma once

#include <QObject>
#include <QTimer>

namespace lumorph::studio {

/// Says when to show numbers anew: soon after a request, at most once in so many milliseconds. Numbers that change
/// faster than anyone reads them cost the window its time; those that share a throttle always agree.
class Throttle : public QObject {
    Q_OBJECT
public:
    explicit Throttle(int milliseconds, QObject* parent = nullptr) : QObject(parent) {
        timer_.setSingleShot(true);
        timer_.setInterval(milliseconds);
        connect(&timer_, &QTimer::timeout, this, &Throttle::due);
    }
    void request() {
        if (!timer_.isActive()) timer_.start();
    }

signals:
    void due();

private:
    QTimer timer_;
};

} // namespace lumorph::studio
