#include "devices/controllers/device_profile.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json_check.h"
#include "core/base/text.h"
#include "core/rig/drive_channels.h"
#include "core/scene/json_section.h"
#include "devices/controllers/controller_kinds.h"

namespace lumorph {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
namespace limits = profile_limits;

constexpr const char* kFormat = "lumorph device";
constexpr int kSchema = 1;
constexpr const char* kReplace = "choose another file, or restore this one from a copy";
constexpr JsonLimits kLimits{1U << 20, 8, 4096};

constexpr std::size_t kMostServos = 64;
constexpr std::size_t kLongestText = 500;

std::string numberText(double value) { return std::isfinite(value) ? json(value).dump() : std::to_string(value); }

void requireWithin(const std::string& subject, const char* what, double value, ProfileLimits bounds) {
    if (value >= bounds.least && value <= bounds.most) return;
    throw InvalidInput(subject, std::string(what) + " is " + numberText(value),
                       "use " + numberText(bounds.least) + " to " + numberText(bounds.most));
}

void checkServo(const ServoSetup& servo, const std::string& subject, ControllerKind kind) {
    requireWithin(subject, "the channel", servo.channel, {0.0, static_cast<double>(knownController(kind).lastChannel)});
    requireWithin(subject, "the least pulse", servo.pulseMin, limits::kPulse);
    requireWithin(subject, "the greatest pulse", servo.pulseMax, limits::kPulse);
    const double span = servo.pulseMax - servo.pulseMin;
    if (!(span >= 1.0))
        throw InvalidInput(
            subject, "its pulses run from " + numberText(servo.pulseMin) + " to " + numberText(servo.pulseMax),
            "let the greatest be greater than the least, and reverse the servo if it turns the wrong way");
    if (!isPulseCurve(servo.curve))
        throw InvalidInput(subject, "its curve does not rise from 0 to 1",
                           "give 2 to 65 numbers, each greater than the one before, or none");
    requireWithin(subject, "the trim", servo.trim, {-0.5 * span, 0.5 * span});
    requireWithin(subject, "the velocity", servo.maxVelocity, limits::kVelocity);
    requireWithin(subject, "the acceleration", servo.maxAcceleration, limits::kAcceleration);
    requireWithin(subject, "the place at the end", servo.exitStroke, {0.0, 1.0});
}

void requireShort(const char* what, const std::string& text) {
    if (text.size() > kLongestText)
        throw InvalidInput("device profile", std::string(what) + " is longer than 500 characters", "use a shorter one");
}

json documentOf(const ServoSetup& servo) {
    json document{{"channel", servo.channel},
                  {"pulseMin", servo.pulseMin},
                  {"pulseMax", servo.pulseMax},
                  {"reversed", servo.reversed},
                  {"trim", servo.trim},
                  {"maxVelocity", servo.maxVelocity},
                  {"maxAcceleration", servo.maxAcceleration},
                  {"exitStroke", servo.exitStroke}};
    if (!servo.curve.empty()) document["curve"] = servo.curve;
    return document;
}

/// All options of all kinds: one who tries another board and comes back finds them as they were.
template <typename Use> void eachOption(Use use) {
    for (const KnownController& known : knownControllers())
        for (const ControllerOption& option : known.options)
            std::visit([&](auto member) { use(option, member); }, option.member);
}

json documentOf(const DeviceProfile& profile) {
    json servos = json::array();
    for (const ServoSetup& servo : profile.servos) servos.push_back(documentOf(servo));
    json document = {{"format", kFormat},
                     {"schema", kSchema},
                     {"name", profile.name},
                     {"address", profile.address},
                     {"controller", knownController(profile.controller).key},
                     {"identity", profile.identity},
                     {"confirmed", profile.confirmed},
                     {"servos", std::move(servos)},
                     {"commandsPerSecond", profile.commandsPerSecond},
                     {"staggerSeconds", profile.staggerSeconds},
                     {"slowShare", profile.slowShare},
                     {"handDistance", profile.handDistance},
                     {"restOnExit", profile.restOnExit}};
    eachOption([&](const ControllerOption& option, auto member) { document[option.key] = profile.*member; });
    return document;
}

void require(const JsonSection& section, const char* key) {
    if (!section.has(key)) section.refuse(key, "is missing", "add it");
}

/// A limit whose name is misspelt would silently be another limit: what is not known is an error.
void refuseUnknown(const json& object, const JsonSection& section) {
    if (!object.empty())
        section.refuse(object.begin().key().substr(0, 80), "is not known here", "correct its name, or remove it");
}

void readWithin(JsonSection& section, const char* key, double& value, ProfileLimits bounds) {
    section.number(key, value, bounds.least, bounds.most);
}

ServoSetup readServo(json& object, JsonSection section, ControllerKind kind) {
    for (const char* key : {"channel", "pulseMin", "pulseMax"}) require(section, key);
    ServoSetup servo;
    section.wholeNumber("channel", servo.channel, 0, knownController(kind).lastChannel);
    readWithin(section, "pulseMin", servo.pulseMin, limits::kPulse);
    readWithin(section, "pulseMax", servo.pulseMax, limits::kPulse);
    section.numbers("curve", servo.curve, 0.0, 1.0, kMostCurvePoints);
    section.flag("reversed", servo.reversed);
    section.number("trim", servo.trim, -limits::kPulse.most, limits::kPulse.most);
    readWithin(section, "maxVelocity", servo.maxVelocity, limits::kVelocity);
    readWithin(section, "maxAcceleration", servo.maxAcceleration, limits::kAcceleration);
    section.number("exitStroke", servo.exitStroke, 0.0, 1.0);
    refuseUnknown(object, section);
    return servo;
}

std::vector<ServoSetup> readServos(json& document, const JsonSection& section, ControllerKind kind,
                                   const std::string& file) {
    require(section, "servos");
    json list = std::move(document["servos"]);
    document.erase("servos");
    if (!list.is_array() || list.size() > kMostServos)
        section.refuse("servos", "is not a list of at most 64 servos", "write it in [ ], and remove what is too much");
    std::vector<ServoSetup> servos;
    for (json& object : list) {
        const std::string name = "servos[" + std::to_string(servos.size()) + "]";
        if (!object.is_object()) section.refuse(name, "is not an object", "write it in { }, or remove it");
        servos.push_back(readServo(object, JsonSection(object, name + ".", file), kind));
    }
    return servos;
}

ControllerKind readKind(JsonSection& section) {
    std::string key(knownController(DeviceProfile{}.controller).key);
    section.text("controller", key);
    try {
        return knownController(key).kind;
    } catch (const InvalidInput& error) {
        section.refuse("controller", error.why(), error.remedy());
    }
}

void readOptions(JsonSection& section, DeviceProfile& profile) {
    eachOption([&](const ControllerOption& option, auto member) {
        const std::string key(option.key);
        if constexpr (std::is_same_v<decltype(member), bool DeviceProfile::*>)
            section.flag(key.c_str(), profile.*member);
        else
            section.wholeNumber(key.c_str(), profile.*member, static_cast<int>(option.limits.least),
                                static_cast<int>(option.limits.most));
    });
}

void requireFormat(JsonSection& section, const std::string& file) {
    std::string format;
    section.text("format", format);
    if (format != kFormat) throw DataError(file, "is not a device profile", "choose a file that was saved as one");
    int schema = kSchema;
    section.wholeNumber("schema", schema, 1, 1'000'000);
    if (schema != kSchema) throw DataError(file, "is of a newer version", "open it with a newer version of Lumorph");
}

DeviceProfile profileOf(json& document, const std::string& file) {
    JsonSection section(document, "", file);
    requireFormat(section, file);
    DeviceProfile profile;
    section.text("name", profile.name);
    section.text("address", profile.address);
    profile.controller = readKind(section);
    readOptions(section, profile);
    section.text("identity", profile.identity);
    section.flag("confirmed", profile.confirmed);
    readWithin(section, "commandsPerSecond", profile.commandsPerSecond, limits::kCommandsPerSecond);
    readWithin(section, "staggerSeconds", profile.staggerSeconds, limits::kStaggerSeconds);
    readWithin(section, "slowShare", profile.slowShare, limits::kSlowShare);
    readWithin(section, "handDistance", profile.handDistance, limits::kHandDistance);
    section.flag("restOnExit", profile.restOnExit);
    profile.servos = readServos(document, section, profile.controller, file);
    refuseUnknown(document, section);
    try {
        checkProfile(profile);
    } catch (const InvalidInput& error) {
        throw DataError(file, error.subject() + ": " + error.why(), error.remedy());
    }
    return profile;
}

} // namespace

DeviceProfile profileFor(const Rig& rig, int first) {
    DeviceProfile profile;
    profile.name = rig.name().substr(0, kLongestText);
    const std::vector<int> channels = boardChannels(rig, first);
    for (const Actuator& actuator : rig.actuators()) {
        ServoSetup servo;
        servo.channel = channels[profile.servos.size()];
        // A rig that tells the greater pulse for rest means a servo that turns the other way.
        servo.reversed = actuator.drive.pulseMin > actuator.drive.pulseMax;
        const auto [least, greatest] = std::minmax(actuator.drive.pulseMin, actuator.drive.pulseMax);
        servo.pulseMin = std::clamp(least, limits::kPulse.least, limits::kPulse.most - 1.0);
        servo.pulseMax = std::clamp(greatest, servo.pulseMin + 1.0, limits::kPulse.most);
        servo.curve = actuator.drive.curve;
        servo.maxVelocity = std::clamp(actuator.maxVelocity, limits::kVelocity.least, limits::kVelocity.most);
        profile.servos.push_back(servo);
    }
    return profile;
}

double freePulseOf(const ServoSetup& servo, double stroke) noexcept {
    const double turned = turnedAt(servo.curve, stroke);
    const double share = servo.reversed ? 1.0 - turned : turned;
    return servo.pulseMin + share * (servo.pulseMax - servo.pulseMin) + servo.trim;
}

double strokeOf(const ServoSetup& servo, double pulse) noexcept {
    const double share = (pulse - servo.trim - servo.pulseMin) / (servo.pulseMax - servo.pulseMin);
    return strokeWhereTurned(servo.curve, servo.reversed ? 1.0 - share : share);
}

double pulseOf(const ServoSetup& servo, double stroke) noexcept {
    return std::clamp(freePulseOf(servo, std::clamp(stroke, 0.0, 1.0)), servo.pulseMin, servo.pulseMax);
}

double fastestPulse(const ServoSetup& servo) noexcept {
    return servo.maxVelocity * steepest(servo.curve) * (servo.pulseMax - servo.pulseMin);
}

void checkProfile(const DeviceProfile& profile) {
    requireShort("the name", profile.name);
    requireShort("the address", profile.address);
    requireShort("the identity", profile.identity);
    if (profile.servos.size() > kMostServos)
        throw InvalidInput("device profile", std::to_string(profile.servos.size()) + " servos, and 64 is the most",
                           "spread them over several controllers");
    const std::string all = "device profile";
    eachOption([&](const ControllerOption& option, auto member) {
        if constexpr (std::is_same_v<decltype(member), int DeviceProfile::*>)
            requireWithin(all, inQuotes(option.title).c_str(), profile.*member, option.limits);
    });
    requireWithin(all, "the rate of commands", profile.commandsPerSecond, limits::kCommandsPerSecond);
    requireWithin(all, "the pause between servo starts", profile.staggerSeconds, limits::kStaggerSeconds);
    requireWithin(all, "the share of slow mode", profile.slowShare, limits::kSlowShare);
    requireWithin(all, "the distance of hands", profile.handDistance, limits::kHandDistance);
    std::vector<int> channels;
    for (const ServoSetup& servo : profile.servos) {
        const std::string subject = "servo " + std::to_string(channels.size() + 1);
        checkServo(servo, subject, profile.controller);
        const auto twin = std::ranges::find(channels, servo.channel);
        if (twin != channels.end())
            throw InvalidInput(subject,
                               "channel " + std::to_string(servo.channel) + " is already that of servo " +
                                   std::to_string(twin - channels.begin() + 1),
                               "give each servo a channel of its own");
        channels.push_back(servo.channel);
    }
}

std::string profileText(const DeviceProfile& profile) {
    return documentOf(profile).dump(-1, ' ', false, json::error_handler_t::replace);
}

DeviceProfile parseProfile(std::string_view text, const std::string& subject) {
    if (const std::string problem = jsonProblem(text, kLimits); !problem.empty())
        throw DataError(subject, problem, kReplace);
    try {
        json document = json::parse(text);
        if (!document.is_object()) throw DataError(subject, "is not a device profile", kReplace);
        return profileOf(document, subject);
    } catch (const json::exception&) {
        throw DataError(subject, "is not sound JSON", kReplace);
    }
}

DeviceProfile readProfile(const fs::path& file) {
    const std::string name = file.string();
    std::error_code failed;
    // Reading a pipe or a device might never end.
    if (fs::exists(file, failed) && fs::is_other(file, failed))
        throw DataError(name, "is not a file", "choose a device profile");
    const std::vector<std::byte> bytes = readFile(file, kLimits.bytes);
    return parseProfile({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
}

void writeProfile(const DeviceProfile& profile, const fs::path& file) {
    checkProfile(profile);
    std::string text;
    try {
        text = documentOf(profile).dump(2) + "\n";
    } catch (const json::exception&) {
        throw InvalidInput("device profile", "a name or address holds text that is not UTF-8", "write it anew");
    }
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

} // namespace lumorph
