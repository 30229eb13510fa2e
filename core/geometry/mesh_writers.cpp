#include "core/geometry/mesh_writers.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>

#include <glm/geometric.hpp>

namespace lumorph {
namespace {

template <typename Number> void appendNumber(std::string& text, Number value) {
    std::array<char, 32> digits;
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    text += ' ';
    text.append(digits.data(), result.ptr);
}

std::byte* putLittleEndian(std::byte* to, std::uint32_t value) noexcept {
    for (unsigned shift = 0; shift < 32; shift += 8) *to++ = static_cast<std::byte>(value >> shift);
    return to;
}

std::byte* put(std::byte* to, const glm::vec3& v) noexcept {
    for (const float value : {v.x, v.y, v.z}) to = putLittleEndian(to, std::bit_cast<std::uint32_t>(value));
    return to;
}

glm::vec3 normalOf(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) noexcept {
    const glm::dvec3 origin(a);
    const glm::dvec3 normal = glm::cross(glm::dvec3(b) - origin, glm::dvec3(c) - origin);
    const double length = glm::length(normal);
    return length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0F);
}

} // namespace

std::string writeObj(const TriangleMesh& mesh) {
    std::string text = "# Lumorph\n";
    text.reserve(mesh.positions.size() * 36 + mesh.triangles.size() * 24);
    for (const glm::vec3& p : mesh.positions) {
        text += 'v';
        for (const float value : {p.x, p.y, p.z}) appendNumber(text, value);
        text += '\n';
    }
    for (const glm::uvec3& t : mesh.triangles) {
        text += 'f';
        // In 64 bits, as the last vertex there can be would overflow.
        for (const std::uint64_t index : {t.x, t.y, t.z}) appendNumber(text, index + 1);
        text += '\n';
    }
    return text;
}

std::vector<std::byte> writeStl(const TriangleMesh& mesh) {
    // The head must not begin with "solid", or readers take the file for a text.
    constexpr std::string_view kHead = "Binary STL written by Lumorph";
    std::vector<std::byte> bytes(84 + 50 * mesh.triangles.size());
    std::memcpy(bytes.data(), kHead.data(), kHead.size());
    std::byte* to = putLittleEndian(bytes.data() + 80, static_cast<std::uint32_t>(mesh.triangles.size()));
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3& a = mesh.positions[t.x];
        const glm::vec3& b = mesh.positions[t.y];
        const glm::vec3& c = mesh.positions[t.z];
        to = put(put(put(put(to, normalOf(a, b, c)), a), b), c) + 2;
    }
    return bytes;
}

} // namespace lumorph
