#pragma once

#include <QPainter>
#include <QPointF>
#include <QSize>

namespace lumorph::studio {

/// Something that is drawn over a picture and may take the pointer: the handles of a thing in it. Sizes and places are
/// pixels of the desktop, from the picture's upper left corner.
class PaneOverlay {
public:
    virtual ~PaneOverlay() = default;
    virtual void paint(QPainter& painter, const QSize& size) = 0;
    /// True: the drag that begins here is the overlay's.
    virtual bool press(const QPointF& at, const QSize& size, Qt::KeyboardModifiers modifiers) = 0;
    virtual void drag(const QPointF& to, const QSize& size, Qt::KeyboardModifiers modifiers) = 0;
    virtual void release() = 0;
    virtual void cancel() = 0;
    /// True when something changed that has to be painted.
    virtual bool hover(const QPointF& at, const QSize& size) = 0;
    /// The pointer is over something that a press would take.
    [[nodiscard]] virtual bool hot() const = 0;
};

} // namespace lumorph::studio
