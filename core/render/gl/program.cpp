#include "core/render/gl/program.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph {
namespace {

constexpr const char* kRemedy = "correct the shader, or install Lumorph again if you did not change it";

std::string textOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw DataError(file.string(), "the shader cannot be read", "install Lumorph again");
    return {std::istreambuf_iterator<char>(stream), {}};
}

// The defines are a piece of their own, so that the lines of those after them still count right.
std::string join(const std::vector<std::filesystem::path>& files, const std::vector<std::string>& defines,
                 std::vector<ShaderPiece>& pieces) {
    std::string text;
    for (const auto& file : files) {
        const std::string piece = textOf(file) + "\n";
        pieces.push_back({file, static_cast<int>(std::count(piece.begin(), piece.end(), '\n'))});
        text += piece;
        if (pieces.size() > 1 || defines.empty()) continue;
        for (const std::string& define : defines) text += "#define " + define + "\n";
        pieces.push_back({file, static_cast<int>(defines.size())});
    }
    return text;
}

void compile(GLuint shader, const std::vector<std::filesystem::path>& files, const std::vector<std::string>& defines) {
    std::vector<ShaderPiece> pieces;
    const std::string text = join(files, defines, pieces);
    const char* pointer = text.c_str();
    glShaderSource(shader, 1, &pointer, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled == GL_TRUE) return;
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    const ShaderFault fault = firstFault(log.c_str(), pieces);
    throw DataError(fault.place, fault.message, kRemedy);
}

void link(GLuint program, const ShaderFiles& files) {
    gl::VertexShader vertex;
    gl::FragmentShader fragment;
    compile(vertex.name(), files.vertex, files.defines);
    compile(fragment.name(), files.fragment, files.defines);
    glAttachShader(program, vertex.name());
    glAttachShader(program, fragment.name());
    glLinkProgram(program);
    glDetachShader(program, vertex.name());
    glDetachShader(program, fragment.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) return;
    GLchar log[2048] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    throw DataError(files.fragment.back().string(), std::string("the stages do not fit together: ") + log, kRemedy);
}

} // namespace

ShaderFiles shaderFiles(const std::vector<std::string>& vertex, const std::vector<std::string>& fragment) {
    ShaderFiles files;
    for (const std::string& name : vertex) files.vertex.push_back(resourceFile("shaders/" + name));
    for (const std::string& name : fragment) files.fragment.push_back(resourceFile("shaders/" + name));
    return files;
}

// Drivers write "0:12(3): error: why" (Mesa), "0(12) : error C1: why" (NVIDIA) or "ERROR: 0:12: why".
ShaderFault firstFault(const std::string& log, const std::vector<ShaderPiece>& pieces) {
    static const std::regex mesa(R"(^\d+:(\d{1,9})\(\d+\): error: (.*)$)");
    static const std::regex nvidia(R"(^\d+\((\d{1,9})\) : error \w+: (.*)$)");
    static const std::regex others(R"(^ERROR: \d+:(\d{1,9}): (.*)$)");
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_match(line, match, mesa) && !std::regex_match(line, match, nvidia) &&
            !std::regex_match(line, match, others))
            continue;
        int left = std::stoi(match[1]);
        auto piece = pieces.begin();
        for (; piece + 1 != pieces.end() && left > piece->lines; ++piece) left -= piece->lines;
        return {piece->file.string() + ":" + std::to_string(left), match[2]};
    }
    return {pieces.front().file.string(), log.empty() ? "the driver gives no reason" : log};
}

void Program::use() {
    if (!program_) {
        gl::ProgramObject program;
        link(program.name(), files_);
        program_ = std::move(program);
    }
    glUseProgram(program_->name());
}

GLint Program::location(const std::string& uniform) {
    const auto [entry, added] = locations_.try_emplace(uniform, -1);
    if (added) entry->second = glGetUniformLocation(program_->name(), uniform.c_str());
    return entry->second;
}

void Program::set(const std::string& uniform, int value) { glUniform1i(location(uniform), value); }
void Program::set(const std::string& uniform, float value) { glUniform1f(location(uniform), value); }
void Program::set(const std::string& uniform, const glm::vec2& value) { glUniform2fv(location(uniform), 1, &value.x); }
void Program::set(const std::string& uniform, const glm::vec3& value) { glUniform3fv(location(uniform), 1, &value.x); }
void Program::set(const std::string& uniform, const glm::vec4& value) { glUniform4fv(location(uniform), 1, &value.x); }
void Program::set(const std::string& uniform, const glm::mat4& value) { set(uniform, std::span(&value, 1)); }

void Program::set(const std::string& uniform, std::span<const glm::vec2> values) {
    glUniform2fv(location(uniform), static_cast<GLsizei>(values.size()), &values.front().x);
}

void Program::set(const std::string& uniform, std::span<const glm::vec4> values) {
    glUniform4fv(location(uniform), static_cast<GLsizei>(values.size()), &values.front().x);
}

void Program::set(const std::string& uniform, std::span<const glm::vec3> values) {
    glUniform3fv(location(uniform), static_cast<GLsizei>(values.size()), &values.front().x);
}

void Program::set(const std::string& uniform, std::span<const glm::mat4> values) {
    glUniformMatrix4fv(location(uniform), static_cast<GLsizei>(values.size()), GL_FALSE, &values.front()[0].x);
}

} // namespace lumorph
