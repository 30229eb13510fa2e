#pragma once

#include <functional>
#include <utility>

#include <QObject>
#include <QTimer>

namespace lumorph::studio {

/// Calls `update` soon after a request, at most once in so many milliseconds: numbers that change faster than anyone
/// reads them cost the window its time.
class Throttle : public QObject {
public:
    Throttle(int milliseconds, std::function<void()> update, QObject* parent) : QObject(parent) {
        timer_.setSingleShot(true);
        timer_.setInterval(milliseconds);
        connect(&timer_, &QTimer::timeout, this, std::move(update));
    }
    void request() {
        if (!timer_.isActive()) timer_.start();
    }

private:
    QTimer timer_;
};

} // namespace lumorph::studio
