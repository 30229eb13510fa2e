#pragma once

#include <vector>

#include <QWidget>
#include <glm/vec2.hpp>

#include "core/rig/templates/flap_layout.h"

namespace lumorph::studio {

/// A sheet from above, as it is drawn on the page: its outline, the parts that bend, and their bend lines.
class SheetPicture : public QWidget {
    Q_OBJECT
public:
    explicit SheetPicture(QWidget* parent = nullptr);
    /// `outline`: (x, z) in metres, as SheetDevice has it. Without one nothing is drawn.
    void show(std::vector<glm::dvec2> outline, std::vector<Flap> flaps);
    [[nodiscard]] QSize sizeHint() const override { return {128, 96}; }
    [[nodiscard]] const std::vector<Flap>& flaps() const noexcept { return flaps_; }

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    std::vector<glm::dvec2> outline_;
    std::vector<Flap> flaps_;
};

} // namespace lumorph::studio
