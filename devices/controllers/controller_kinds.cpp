#include "devices/controllers/controller_kinds.h"

#include <algorithm>
#include <cctype>

#include "core/base/error.h"
#include "core/base/text.h"
#include "devices/controllers/controller_base.h"

namespace lumorph {
namespace {

/// A new kind of board is one more row here; CONTRIBUTING.md says what else it needs.
const std::vector<KnownController>& controllerTable() {
    static const std::vector<KnownController> table = {
        {.kind = ControllerKind::firmata,
         .key = "firmata",
         .title = "Arduino with Firmata",
         .words = {"firmata"},
         .firstChannel = 2, // pins 0 and 1 are the serial link's
         .lastChannel = 127,
         .options = {},
         .simulators = {"tablet", "uno"},
         .make = makeFirmata},
        {.kind = ControllerKind::lewansoul,
         .key = "lewansoul",
         .title = "LewanSoul, Hiwonder",
         .words = {"hid://", "xarm", "learm", "lobot", "lewansoul", "hiwonder"},
         .firstChannel = 1,
         .lastChannel = 253, // 254 means all servos
         .options = {},
         .simulators = {"xarm"},
         .make = makeLewansoul},
        {.kind = ControllerKind::maestro,
         .key = "maestro",
         .title = "Pololu Maestro",
         .words = {"maestro", "pololu"},
         .firstChannel = 0,
         .lastChannel = 23,
         .options = {{.key = "controllerNumber",
                      .title = "Device number",
                      .tip = "The Maestro's device number, as its own settings (Maestro Control Center) say; 12 "
                             "unless somebody changed it",
                      .member = &DeviceProfile::controllerNumber,
                      .limits = profile_limits::kControllerNumber},
                     {.key = "maestroCrc",
                      .title = "Expects a checksum (CRC)",
                      .tip = "As \"Enable CRC\" in the Maestro's own settings; wrong here, it heeds no command",
                      .member = &DeviceProfile::maestroCrc,
                      .limits = {}}},
         .simulators = {"maestro"},
         .make = makeMaestro},
    };
    return table;
}

/// The longest of a kind's words that stands in the text; 0 where none does.
std::size_t longestWordIn(const std::string& text, const KnownController& known) {
    std::size_t longest = 0;
    const auto look = [&](std::string_view word) {
        if (text.find(word) != std::string::npos) longest = std::max(longest, word.size());
    };
    for (const std::string_view word : known.words) look(word);
    for (const std::string_view board : known.simulators) look("sim://" + std::string(board));
    return longest;
}

} // namespace

std::span<const KnownController> knownControllers() { return controllerTable(); }

std::string controllerKeys() {
    const auto all = knownControllers();
    std::string keys;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i > 0) keys += i + 1 < all.size() ? ", " : " or ";
        keys += all[i].key;
    }
    return keys;
}

const KnownController& knownController(ControllerKind kind) {
    const auto all = knownControllers();
    const auto found = std::ranges::find(all, kind, &KnownController::kind);
    if (found == all.end())
        throw InvalidInput("controller kind " + std::to_string(static_cast<int>(kind)), "it is not known here",
                           "use " + controllerKeys());
    return *found;
}

const KnownController& knownController(std::string_view key) {
    const auto all = knownControllers();
    const auto found = std::ranges::find(all, key, &KnownController::key);
    if (found == all.end())
        throw InvalidInput("controller", inQuotes(key) + " is no controller that is known here",
                           "write " + controllerKeys());
    return *found;
}

ControllerKind likelyController(std::string_view words) {
    std::string lower(words);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto all = knownControllers();
    return std::ranges::max_element(all, {}, [&](const KnownController& known) { return longestWordIn(lower, known); })
        ->kind;
}

int firstChannel(ControllerKind controller) { return knownController(controller).firstChannel; }

bool sameOptions(const DeviceProfile& a, const DeviceProfile& b) {
    for (const KnownController& known : knownControllers())
        for (const ControllerOption& option : known.options)
            if (std::visit([&](auto member) { return a.*member != b.*member; }, option.member)) return false;
    return true;
}

std::unique_ptr<ServoController> makeController(const DeviceProfile& profile, const DeviceAddress& address) {
    const KnownController& known = knownController(profile.controller);
    checkChannels(profile, known.lastChannel);
    return known.make(profile, address);
}

} // namespace lumorph
