#pragma once

#include <string>

namespace lumorph {

/// The driver behind the current OpenGL context.
struct GlDriver {
    int version = 0; ///< 41 is OpenGL 4.1; 0 when there is none
    std::string renderer;
    bool software = false;    ///< drawn by the processor
    bool tellsResets = false; ///< `contextLost` can say so
};
[[nodiscard]] GlDriver currentDriver();
/// Whether the driver was reset: nothing is drawn any more, and all objects of the current context are gone.
[[nodiscard]] bool contextLost(const GlDriver& driver);

} // namespace lumorph
