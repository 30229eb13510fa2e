#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/render/gl/gl_objects.h"

namespace lumorph {

/// The files of a program. The pieces of a stage are compiled one after the other as one text; the
/// first begins with `#version 410 core`. `defines` ("NAME" or "NAME value") stand between the first piece, which then
/// is best version.glsl alone, and the others of both stages.
struct ShaderFiles {
    std::vector<std::filesystem::path> vertex;
    std::vector<std::filesystem::path> fragment;
    std::vector<std::string> defines = {};
};

/// Names of files in resources/shaders. Throws DataError when one is missing.
[[nodiscard]] ShaderFiles shaderFiles(const std::vector<std::string>& vertex, const std::vector<std::string>& fragment);

/// A piece of a stage, as far as it matters for an error's place.
struct ShaderPiece {
    std::filesystem::path file;
    int lines = 0;
};

/// Where and why a stage does not compile, from the driver's log, which counts lines over all pieces.
struct ShaderFault {
    std::string place; ///< "file:line", or the first file when the log names no line
    std::string message;
};
[[nodiscard]] ShaderFault firstFault(const std::string& log, const std::vector<ShaderPiece>& pieces);

/// A program from shader files, built when first used.
class Program {
public:
    explicit Program(ShaderFiles files) : files_(std::move(files)) {}

    /// Makes it the current program. The first call throws DataError naming file and line when a
    /// shader does not compile.
    void use();
    /// Sets a uniform of the current program; a name the program does not have is ignored, because
    /// drivers drop uniforms that have no effect.
    void set(const std::string& uniform, int value);
    void set(const std::string& uniform, float value);
    void set(const std::string& uniform, const glm::vec2& value);
    void set(const std::string& uniform, const glm::vec3& value);
    void set(const std::string& uniform, const glm::vec4& value);
    void set(const std::string& uniform, const glm::mat4& value);
    void set(const std::string& uniform, std::span<const glm::vec2> values);
    void set(const std::string& uniform, std::span<const glm::vec3> values);
    void set(const std::string& uniform, std::span<const glm::vec4> values);
    void set(const std::string& uniform, std::span<const glm::mat4> values);
    /// OpenGL objects held now: none before it is first used.
    [[nodiscard]] std::size_t objectCount() const noexcept { return program_ ? 1 : 0; }

private:
    [[nodiscard]] GLint location(const std::string& uniform);

    ShaderFiles files_;
    std::optional<gl::ProgramObject> program_;
    std::unordered_map<std::string, GLint> locations_;
};

} // namespace lumorph
