#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/base/error.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "NatNet is read as it lies in memory");

namespace lumorph::natnet {

[[noreturn]] inline void refusePacket(const std::string& why) {
    throw DataError("NatNet packet", why, "check that the server speaks NatNet 2.5 to 4.1");
}

/// A walk over the bytes of a packet that never leaves them.
class Bytes {
public:
    explicit Bytes(std::span<const std::byte> rest) : rest_(rest) {}

    [[nodiscard]] std::size_t left() const noexcept { return rest_.size(); }

    std::span<const std::byte> skip(std::size_t size) {
        if (size > rest_.size()) refusePacket("it ends too early");
        const auto taken = rest_.first(size);
        rest_ = rest_.subspan(size);
        return taken;
    }

    template <typename T> T take() {
        static_assert(std::is_arithmetic_v<T>);
        T value{};
        std::memcpy(&value, skip(sizeof value).data(), sizeof value);
        return value;
    }

    glm::vec3 vector() {
        const float x = take<float>();
        const float y = take<float>();
        return {x, y, take<float>()};
    }

    glm::quat quaternion() {
        const glm::vec3 v = vector();
        return {take<float>(), v.x, v.y, v.z};
    }

    /// Up to the zero that ends it.
    std::string_view text() {
        const auto end = std::ranges::find(rest_, std::byte{0});
        if (end == rest_.end()) refusePacket("a name in it has no end");
        const auto bytes = skip(static_cast<std::size_t>(end - rest_.begin()) + 1);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size() - 1};
    }

    /// How many things follow, each of at least so many bytes: no more than can be there.
    std::size_t count(std::size_t leastBytes) {
        const auto number = take<std::int32_t>();
        if (number < 0 || static_cast<std::size_t>(number) > left() / leastBytes)
            refusePacket("it tells of " + std::to_string(number) + " things and has no room for them");
        return static_cast<std::size_t>(number);
    }

    void expectEnd(const char* of) const {
        if (!rest_.empty()) refusePacket(std::string(of) + " has " + std::to_string(left()) + " bytes too many");
    }

private:
    std::span<const std::byte> rest_;
};

inline constexpr std::size_t kVectorBytes = 12;

} // namespace lumorph::natnet
