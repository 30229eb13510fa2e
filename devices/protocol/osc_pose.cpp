#include "devices/protocol/osc_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>

#include <glm/trigonometric.hpp>
#include <lo/lo.h>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph::osc {

namespace {

using Bytes = std::span<const std::byte>;

constexpr std::string_view kBundle("#bundle\0", 8);
constexpr std::string_view kPrefix = "/tracking/trackers/";
constexpr std::string_view kPositionEnd = "/position";
constexpr std::string_view kRotationEnd = "/rotation";
constexpr std::size_t kLongestName = 64;
constexpr std::size_t kTimeBytes = 8;
constexpr std::size_t kArgumentBytes = 3 * 4;
constexpr std::size_t kLargestMessage = 128; ///< of those that are about poses
constexpr int kDeepest = 4;
constexpr double kFarthest = 1000.0;
constexpr double kMostDegrees = 3600.0;

[[noreturn]] void refuse(const std::string& why) {
    throw DataError("OSC packet", why, "let the sender send /tracking/trackers/head/position with three floats");
}

std::string_view textOf(Bytes bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

/// Takes a text with its zero and padding from the front.
std::string_view takeText(Bytes& bytes) {
    const std::size_t length = textOf(bytes).find('\0');
    if (length == std::string_view::npos) refuse("a text in it has no end");
    const std::size_t padded = (length / 4 + 1) * 4;
    if (padded > bytes.size()) refuse("it ends too early");
    const std::string_view text = textOf(bytes).substr(0, length);
    bytes = bytes.subspan(padded);
    return text;
}

struct Address {
    std::string_view name;
    PosePart::Kind kind = PosePart::Kind::position;
};

std::optional<Address> poseAddress(std::string_view path) {
    if (!path.starts_with(kPrefix)) return std::nullopt;
    const std::string_view rest = path.substr(kPrefix.size());
    Address address;
    if (rest.ends_with(kRotationEnd))
        address.kind = PosePart::Kind::rotation;
    else if (!rest.ends_with(kPositionEnd))
        return std::nullopt;
    static_assert(kPositionEnd.size() == kRotationEnd.size());
    address.name = rest.substr(0, rest.size() - kPositionEnd.size());
    return address;
}

void checkName(std::string_view name) {
    const auto isFit = [](char c) { return c > ' ' && c <= '~' && c != '/'; };
    if (name.empty() || name.size() > kLongestName || !std::ranges::all_of(name, isFit))
        refuse("the name of a tracker in it is empty, too long or has odd characters");
}

/// The three floats of a message whose sizes were all checked before.
glm::dvec3 floatsOf(Bytes message) {
    // Of its own memory and aligned: the library writes into what it is given.
    alignas(8) std::array<char, kLargestMessage> copy{};
    std::memcpy(copy.data(), message.data(), message.size());
    int result = 0;
    const std::unique_ptr<void, void (*)(lo_message)> parsed(
        lo_message_deserialise(copy.data(), message.size(), &result), lo_message_free);
    if (parsed == nullptr || lo_message_get_argc(parsed.get()) != 3) refuse("a message in it cannot be read");
    lo_arg** arguments = lo_message_get_argv(parsed.get());
    // Arguments lie at multiples of four bytes, which is too little for the library's own type.
    glm::dvec3 value;
    for (int axis = 0; axis < 3; ++axis) {
        float number = 0.0F;
        std::memcpy(&number, static_cast<const void*>(arguments[axis]), sizeof number);
        value[axis] = number;
    }
    return value;
}

void readMessage(Bytes message, std::vector<PosePart>& parts) {
    Bytes rest = message;
    const std::string_view path = takeText(rest);
    if (!path.starts_with('/')) refuse("a message in it has no address");
    const std::string_view types = takeText(rest);
    if (!types.starts_with(',')) refuse("a message in it does not tell the kinds of its arguments");
    const std::optional<Address> address = poseAddress(path);
    if (!address) return;
    checkName(address->name);
    if (types != ",fff" || rest.size() != kArgumentBytes) refuse("a pose in it is not three floats");
    if (message.size() > kLargestMessage) refuse("a message in it is too long");
    const glm::dvec3 value = floatsOf(message);
    const double most = address->kind == PosePart::Kind::position ? kFarthest : kMostDegrees;
    for (int axis = 0; axis < 3; ++axis)
        // Written so that NaN fails as well.
        if (!(std::abs(value[axis]) <= most)) refuse("a number in it is out of range");
    parts.push_back({std::string(address->name), address->kind, value});
}

std::size_t takeSize(Bytes& bytes) {
    if (bytes.size() < 4) refuse("it ends too early");
    std::uint32_t size = 0;
    for (int i = 0; i < 4; ++i) size = size << 8U | std::to_integer<std::uint32_t>(bytes[static_cast<std::size_t>(i)]);
    bytes = bytes.subspan(4);
    if (size == 0 || size % 4 != 0 || size > bytes.size()) refuse("a part of it has a wrong size");
    return size;
}

/// The address of a message, as far as it has one.
std::string_view addressOf(Bytes message) {
    const std::string_view text = textOf(message);
    return text.substr(0, std::min(text.find('\0'), text.size()));
}

void readElement(Bytes element, int depth, std::vector<PosePart>& parts, std::vector<std::string>* refused) {
    if (element.empty() || element.size() % 4 != 0) refuse("its size is no multiple of four");
    if (!textOf(element).starts_with(kBundle)) {
        if (depth == 0) return readMessage(element, parts);
        try {
            readMessage(element, parts);
        } catch (const DataError& error) {
            if (refused != nullptr) refused->push_back(inQuotes(addressOf(element)) + ": " + error.why());
        }
        return;
    }
    if (depth == kDeepest) refuse("its bundles are too deep in each other");
    if (element.size() < kBundle.size() + kTimeBytes) refuse("it ends too early");
    for (Bytes rest = element.subspan(kBundle.size() + kTimeBytes); !rest.empty();) {
        const std::size_t size = takeSize(rest);
        readElement(rest.first(size), depth + 1, parts, refused);
        rest = rest.subspan(size);
    }
}

} // namespace

std::vector<PosePart> readPoseParts(std::span<const std::byte> datagram, std::vector<std::string>* refused) {
    std::vector<PosePart> parts;
    readElement(datagram, 0, parts, refused);
    return parts;
}

glm::dvec3 positionOf(const glm::dvec3& sent) { return {sent.x, sent.y, -sent.z}; }

glm::dquat rotationOf(const glm::dvec3& degrees) {
    // Seen in a mirror that turns Z over, turns about X and Y go the other way.
    const glm::dvec3 r = glm::radians(degrees);
    return glm::angleAxis(-r.y, glm::dvec3(0, 1, 0)) * glm::angleAxis(-r.x, glm::dvec3(1, 0, 0)) *
           glm::angleAxis(r.z, glm::dvec3(0, 0, 1));
}

} // namespace lumorph::osc
