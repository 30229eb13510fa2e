#pragma once

#include <utility>

#include <QObject>
#include <glm/vec3.hpp>

#include "core/rig/actuator_weights.h"

namespace lumorph::studio {

/// How the influence of the chosen actuator is edited in the view: which tool, and how large. Not part of the document.
class InfluenceTools : public QObject {
    Q_OBJECT
public:
    using QObject::QObject;
    enum class Tool { paint, erase, smooth, distance };

    [[nodiscard]] bool editing() const noexcept { return editing_; }
    void setEditing(bool on) {
        if (std::exchange(editing_, on) != on) emit changed();
    }
    [[nodiscard]] Tool tool() const noexcept { return tool_; }
    void setTool(Tool tool) {
        if (std::exchange(tool_, tool) != tool) emit changed();
    }
    /// Of the tools but `distance`.
    [[nodiscard]] WeightBrush brush() const noexcept {
        WeightBrush brush = brush_;
        brush.tool = tool_ == Tool::erase    ? WeightBrush::Tool::erase
                     : tool_ == Tool::smooth ? WeightBrush::Tool::smooth
                                             : WeightBrush::Tool::paint;
        return brush;
    }
    void setRadius(double metres) { brush_.radius = metres, emit changed(); }
    void setStrength(double share) { brush_.strength = share, emit changed(); }
    [[nodiscard]] const WeightFalloff& falloff() const noexcept { return falloff_; }
    void setFalloff(const WeightFalloff& falloff) { falloff_ = falloff, emit changed(); }
    /// A place of the rest mesh (metres) was clicked with the tool `distance`.
    void pick(const glm::vec3& place) { emit placePicked(place); }

signals:
    void changed();
    void placePicked(const glm::vec3& place);

private:
    bool editing_ = false;
    Tool tool_ = Tool::paint;
    WeightBrush brush_{WeightBrush::Tool::paint, 0.012, 0.35};
    WeightFalloff falloff_;
};

} // namespace lumorph::studio
