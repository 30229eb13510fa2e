#pragma once

namespace lumorph {

/// An OpenGL 4.1 core context without window or display server (EGL, surfaceless), for the command
/// line and for tests. It is current on the creating thread until destroyed or another one is made
/// current. Everything else in core/render draws into whatever context is current.
class HeadlessContext {
public:
    /// Throws DeviceError with the packages to install when EGL or OpenGL 4.1 core is missing.
    HeadlessContext();
    ~HeadlessContext();
    HeadlessContext(HeadlessContext&& other) noexcept;
    HeadlessContext& operator=(HeadlessContext&& other) noexcept;
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    /// Makes it current on the calling thread. Throws DeviceError when the driver refuses, for
    /// example because it is current on another thread.
    void makeCurrent() const;

private:
    void* display_ = nullptr;
    void* context_ = nullptr;
};

} // namespace lumorph
