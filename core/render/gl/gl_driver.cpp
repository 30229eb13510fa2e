#include "core/render/gl/gl_driver.h"

#include <epoxy/gl.h>

namespace lumorph {

GlDriver currentDriver() {
    GlDriver driver;
    driver.version = epoxy_gl_version();
    if (const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER))) driver.renderer = name;
    for (const char* software : {"llvmpipe", "softpipe", "SWR", "swrast", "Software", "GDI Generic", "Basic Render"})
        driver.software = driver.software || driver.renderer.find(software) != std::string::npos;
    driver.tellsResets = driver.version >= 45 || epoxy_has_gl_extension("GL_KHR_robustness");
    return driver;
}

bool contextLost(const GlDriver& driver) { return driver.tellsResets && glGetGraphicsResetStatus() != GL_NO_ERROR; }

} // namespace lumorph
