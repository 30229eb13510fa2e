#pragma once

#include <utility>

#include <epoxy/gl.h>

namespace lumorph::gl {

/// Owns one OpenGL name; move-only. Made and destroyed while its context, or for what contexts share
/// (not vertex arrays and framebuffers) one of its group, is current.
template <class Kind> class Object {
public:
    Object() : name_(Kind::create()) {}
    ~Object() {
        if (name_ != 0) Kind::destroy(name_);
    }
    Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Object& operator=(Object&& other) noexcept {
        Object taken(std::move(other));
        std::swap(name_, taken.name_);
        return *this;
    }
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;

    [[nodiscard]] GLuint name() const noexcept { return name_; }

private:
    GLuint name_;
};

struct BufferKind {
    static GLuint create() {
        GLuint name = 0;
        glGenBuffers(1, &name);
        return name;
    }
    static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct VertexArrayKind {
    static GLuint create() {
        GLuint name = 0;
        glGenVertexArrays(1, &name);
        return name;
    }
    static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct TextureKind {
    static GLuint create() {
        GLuint name = 0;
        glGenTextures(1, &name);
        return name;
    }
    static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct RenderbufferKind {
    static GLuint create() {
        GLuint name = 0;
        glGenRenderbuffers(1, &name);
        return name;
    }
    static void destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }
};
struct FramebufferKind {
    static GLuint create() {
        GLuint name = 0;
        glGenFramebuffers(1, &name);
        return name;
    }
    static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct ProgramKind {
    static GLuint create() { return glCreateProgram(); }
    static void destroy(GLuint name) { glDeleteProgram(name); }
};
template <GLenum Stage> struct ShaderKind {
    static GLuint create() { return glCreateShader(Stage); }
    static void destroy(GLuint name) { glDeleteShader(name); }
};

using Buffer = Object<BufferKind>;
using VertexArray = Object<VertexArrayKind>;
using Texture = Object<TextureKind>;
using Renderbuffer = Object<RenderbufferKind>;
using Framebuffer = Object<FramebufferKind>;
using ProgramObject = Object<ProgramKind>;
using VertexShader = Object<ShaderKind<GL_VERTEX_SHADER>>;
using FragmentShader = Object<ShaderKind<GL_FRAGMENT_SHADER>>;

} // namespace lumorph::gl
