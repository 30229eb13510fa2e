#include "app/studio/shell/visitor_watch.h"

#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "app/applications/visitor.h"

namespace lumorph::studio {
namespace {

constexpr int kTickMilliseconds = 200;
constexpr double kLeans = 0.02; ///< radians by which the device leans otherwise than before

} // namespace

VisitorWatch::VisitorWatch(StudioLoop& loop, const Clock& clock, QObject* parent)
    : QObject(parent), loop_(loop), clock_(clock), lastInput_(clock.now()) {
    connect(&loop, &StudioLoop::inputGiven, this, &VisitorWatch::take);
    connect(&ticks_, &QTimer::timeout, this, &VisitorWatch::tick);
    ticks_.start(kTickMilliseconds);
}

void VisitorWatch::beginAnew(bool there) {
    lastInput_ = lastDone_ = clock_.now();
    lean_.reset();
    setThere(there);
}

void VisitorWatch::take(const QString& name, double value) {
    lastInput_ = clock_.now();
    if (name == "key.attract") {
        if (value > 0.5) setThere(false);
    } else if (value != 0.0) {
        lastDone_ = lastInput_;
        setThere(true);
    }
}

void VisitorWatch::tick() {
    if (deviceLeans()) {
        lastInput_ = lastDone_ = clock_.now();
        setThere(true);
    }
    if (clock_.now() - lastDone_ > Microseconds(std::llround(1e6 * Visitor::kSilence))) setThere(false);
    emit ticked();
}

/// A tracked device is in somebody's hands when it leans otherwise than before.
bool VisitorWatch::deviceLeans() {
    const auto& frame = loop_.frame();
    if (!frame || !frame->program) return false;
    const glm::dvec2 lean = leanOf(frame->worldFromDevice);
    if (!lean_) lean_ = lean;
    if (glm::length(lean - *lean_) < kLeans) return false;
    lean_ = lean;
    return true;
}

void VisitorWatch::setThere(bool there) {
    if (std::exchange(there_, there) != there) emit thereChanged();
}

} // namespace lumorph::studio
