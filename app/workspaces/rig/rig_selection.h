#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <QObject>
#include <glm/vec3.hpp>

#include "app/workspaces/rig/surface_bands.h"

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
    void rehearse(std::vector<double> strokes, bool glides = true) { show(std::move(strokes), std::nullopt, glides); }
    /// The same, with a place of the device (metres) that the view turns to and marks.
    void inspect(std::vector<double> strokes, const glm::vec3& place) { show(std::move(strokes), place, true); }
    [[nodiscard]] const std::optional<glm::vec3>& inspectedPlace() const noexcept { return place_; }

    /// Colours over the device in the view, of the rig that is open; null: none.
    struct Colours {
        SurfaceBands bands;
        std::vector<glm::vec3> colors; ///< one a band, sRGB
    };
    [[nodiscard]] const std::shared_ptr<const Colours>& colours() const noexcept { return colours_; }
    void showColours(std::shared_ptr<const Colours> colours) {
        if (colours == colours_) return;
        colours_ = std::move(colours);
        emit coloursChanged();
    }

signals:
    void changed();
    void coloursChanged();
    void wiggleWanted();
    void rehearsalChanged(bool glides);

private:
    void show(std::vector<double> strokes, const std::optional<glm::vec3>& place, bool glides) {
        if (strokes == rehearsed_ && place == place_) return;
        rehearsed_ = std::move(strokes);
        place_ = place;
        emit rehearsalChanged(glides);
    }

    std::optional<std::size_t> actuator_;
    std::vector<double> rehearsed_;
    std::optional<glm::vec3> place_;
    std::shared_ptr<const Colours> colours_;
};

} // namespace lumorph::studio
