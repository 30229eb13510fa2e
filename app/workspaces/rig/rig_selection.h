#pragma once

#include <optional>

#include <QObject>

namespace lumorph::studio {

/// Which actuator the Rig workspace points at; not part of the document, no undo.
class RigSelection : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    [[nodiscard]] std::optional<std::size_t> actuator() const noexcept { return actuator_; }
    void select(std::optional<std::size_t> actuator) {
        if (actuator == actuator_) return;
        actuator_ = actuator;
        emit changed();
    }
    /// Shows in the view alone what the selected actuator does.
    void wiggle() { emit wiggleWanted(); }

signals:
    void changed();
    void wiggleWanted();

private:
    std::optional<std::size_t> actuator_;
};

} // namespace lumorph::studio
