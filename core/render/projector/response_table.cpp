#include "core/render/projector/response_table.h"

#include <vector>

#include <glm/vec3.hpp>

#include "core/render/gl/draw_state.h"
#include "core/scene/projector_response.h"

namespace lumorph {

ResponseTable::ResponseTable() {
    bindTexture(0, texture_.name());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    bindTexture(0, 0);
}

void ResponseTable::update(const InstalledProjector& projector) {
    if (shown_ && shown_->responseCurve == projector.responseCurve && shown_->gamma == projector.gamma &&
        shown_->black == projector.black)
        return;
    std::vector<glm::vec3> rows(2 * kSteps);
    for (int k = 0; k < kSteps; ++k) {
        const double along = static_cast<double>(k) / (kSteps - 1);
        // By the root of light, because little light takes the finest steps.
        rows[static_cast<std::size_t>(k)] = glm::vec3(valueOfLight(projector, glm::dvec3(along * along)));
        rows[static_cast<std::size_t>(kSteps + k)] = glm::vec3(lightOfValue(projector, along));
    }
    bindTexture(0, texture_.name());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, kSteps, 2, 0, GL_RGB, GL_FLOAT, rows.data());
    bindTexture(0, 0);
    shown_ = projector;
}

void ResponseTable::set(Program& program, int unit) const {
    bindTexture(unit, texture_.name());
    program.set("response", unit);
    program.set("projectorBlack", shown_ ? shown_->black : glm::vec3(0.0F));
}

} // namespace lumorph
