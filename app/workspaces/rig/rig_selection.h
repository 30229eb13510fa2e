#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <QObject>

namespace lumorph::studio {

/// Which actuator the Rig workspace points at, and what it tries in the view; not part of the document, no undo.
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
    /// The joint state that is shown in the view alone, one stroke an actuator; empty: as the device stands.
    [[nodiscard]] const std::vector<double>& rehearsed() const noexcept { return rehearsed_; }
    /// `glides`: the view takes a moment to get there, so that one sees what moves.
    void rehearse(std::vector<double> strokes, bool glides = true) {
        if (strokes == rehearsed_) return;
        rehearsed_ = std::move(strokes);
        emit rehearsalChanged(glides);
    }

signals:
    void changed();
    void wiggleWanted();
    void rehearsalChanged(bool glides);

private:
    std::optional<std::size_t> actuator_;
    std::vector<double> rehearsed_;
};

} // namespace lumorph::studio
