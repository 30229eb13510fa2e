#pragma once

#include <optional>

#include <QObject>
#include <QTimer>

#include <glm/vec2.hpp>

#include "app/studio/document/studio_loop.h"
#include "core/base/clock.h"

namespace lumorph::studio {

/// Whether somebody plays the application that shows, as its `Visitor` sees it, and since when nothing was done.
class VisitorWatch : public QObject {
    Q_OBJECT
public:
    /// Both outlive it.
    VisitorWatch(StudioLoop& loop, const Clock& clock, QObject* parent);

    [[nodiscard]] bool there() const noexcept { return there_; }
    /// Since the last input, or since `beginAnew`.
    [[nodiscard]] Microseconds quiet() const { return clock_.now() - lastInput_; }
    /// Another application shows, or what is done to the window counts as done.
    void beginAnew(bool there);

signals:
    void thereChanged();
    void ticked(); ///< some times a second

private:
    void take(const QString& name, double value);
    void tick();
    [[nodiscard]] bool deviceLeans();
    void setThere(bool there);

    StudioLoop& loop_;
    const Clock& clock_;
    Microseconds lastInput_{0}; ///< of any kind
    Microseconds lastDone_{0};  ///< that somebody plays by
    std::optional<glm::dvec2> lean_;
    bool there_ = false;
    QTimer ticks_;
};

} // namespace lumorph::studio
