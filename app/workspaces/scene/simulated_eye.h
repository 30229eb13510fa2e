#pragma once

#include <optional>

#include <QObject>
#include <QPointF>
#include <QSize>
#include <QTimer>
#include <glm/vec3.hpp>

#include "app/studio/document/studio_document.h"

namespace lumorph::studio {

/// The viewer whom the mouse leads around the device: the scene's own eye. All of a drag, or of a turn of the wheel, is
/// one step of undo.
class SimulatedEye : public QObject {
    Q_OBJECT
public:
    /// `document` outlives it.
    explicit SimulatedEye(StudioDocument& document, QObject* parent = nullptr);

    [[nodiscard]] glm::vec3 eye() const;
    /// The middle of all that the device reaches, world metres: what is gone around.
    [[nodiscard]] glm::vec3 centre() const;

    void drag(const QPointF& by, const QSize& view);
    void zoom(double notches);
    /// The drag ended; not taken: it is undone.
    void end(bool taken);
    [[nodiscard]] bool moving() const noexcept { return moving_; }

private:
    void set(const glm::vec3& eye);

    StudioDocument& document_;
    QTimer settled_; ///< the wheel has no end that one sees
    bool moving_ = false;
};

} // namespace lumorph::studio
