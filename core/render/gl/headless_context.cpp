#include "core/render/gl/headless_context.h"

#include <cstdio>
#include <string>
#include <utility>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "core/base/error.h"

namespace lumorph {
namespace {

DeviceError missing(const std::string& why) {
    return {"OpenGL without a display", why, "install libegl1 and libgl1-mesa-dri, or a driver with OpenGL 4.1 core"};
}

std::string eglErrorName() {
    char text[32];
    std::snprintf(text, sizeof text, "EGL error 0x%04x", static_cast<unsigned>(eglGetError()));
    return text;
}

EGLDisplay surfacelessDisplay() {
    if (!epoxy_has_egl()) throw missing("libEGL cannot be loaded");
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        throw missing("the EGL driver has no surfaceless platform");
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
        throw missing("the EGL display does not start (" + eglErrorName() + ")");
    return display;
}

EGLContext coreContext(EGLDisplay display) {
    if (!eglBindAPI(EGL_OPENGL_API)) throw missing("EGL does not offer desktop OpenGL");
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0)
        throw missing("EGL has no OpenGL configuration");
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 1, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) throw missing("no OpenGL 4.1 core context can be made (" + eglErrorName() + ")");
    return context;
}

} // namespace

HeadlessContext::HeadlessContext() : display_(surfacelessDisplay()), context_(coreContext(display_)) {
    try {
        makeCurrent();
        if (epoxy_gl_version() < 41)
            throw missing("the driver offers OpenGL " + std::to_string(epoxy_gl_version() / 10) + "." +
                          std::to_string(epoxy_gl_version() % 10));
    } catch (...) {
        HeadlessContext discarded(std::move(*this));
        throw;
    }
}

// The display is shared by all users of EGL in the process, so it stays initialised.
HeadlessContext::~HeadlessContext() {
    if (context_ == nullptr) return;
    if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
}

HeadlessContext::HeadlessContext(HeadlessContext&& other) noexcept
    : display_(std::exchange(other.display_, nullptr)), context_(std::exchange(other.context_, nullptr)) {}

HeadlessContext& HeadlessContext::operator=(HeadlessContext&& other) noexcept {
    HeadlessContext taken(std::move(other));
    std::swap(display_, taken.display_);
    std::swap(context_, taken.context_);
    return *this;
}

void HeadlessContext::makeCurrent() const {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
        throw DeviceError("OpenGL without a display", "the context cannot be made current (" + eglErrorName() + ")",
                          "release it on the thread that uses it");
}

} // namespace lumorph
