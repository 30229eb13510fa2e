#include "devices/controllers/controller_kinds.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace lumorph {

ControllerKind likelyController(std::string_view words) {
    std::string lower(words);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto holds = [&lower](const char* word) { return lower.find(word) != std::string::npos; };
    if (holds("maestro") || holds("pololu")) return ControllerKind::maestro;
    for (const char* word : {"hid://", "xarm", "learm", "lobot", "lewansoul", "hiwonder"})
        if (holds(word)) return ControllerKind::lewansoul;
    return ControllerKind::firmata;
}

int firstChannel(ControllerKind controller) {
    switch (controller) {
    case ControllerKind::firmata:
        return 2; // pins 0 and 1 are the serial link's
    case ControllerKind::lewansoul:
        return 1;
    case ControllerKind::maestro:
        return 0;
    }
    return 0;
}

void countChannelsFrom(DeviceProfile& profile, int first) {
    if (profile.servos.empty()) return;
    const int least = std::ranges::min(profile.servos, {}, &ServoSetup::channel).channel;
    for (ServoSetup& servo : profile.servos) servo.channel += first - least;
}

} // namespace lumorph
