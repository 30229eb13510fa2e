#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <QCoreApplication>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/device_link.h"
#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/rig/rig_file.h"
#include "core/scene/project.h"
#include "devices/controllers/controller_kinds.h"
#include "devices/firmware/sketch.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/transport/discovery.h"

namespace lumorph::cli {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kMoveWithin{60};

struct DeviceArguments {
    std::string uri;
    std::string controller;
    std::string profile;
    std::string rig;
    int actuator = 0;
    int level = 0;
    int levels = 33;
    double seconds = 0.0;
    bool mayJump = false;
    bool confirmed = false;
    bool json = false;
};

const char* phaseText(LinkPhase phase) {
    switch (phase) {
    case LinkPhase::off:
        return "off";
    case LinkPhase::connecting:
        return "connecting";
    case LinkPhase::handshake:
        return "handshake";
    case LinkPhase::unidentified:
        return "unidentified";
    case LinkPhase::disarmed:
        return "ready";
    case LinkPhase::starting:
        return "starting";
    case LinkPhase::live:
        return "live";
    case LinkPhase::stopped:
        return "stopped";
    case LinkPhase::lost:
        return "lost";
    }
    return "";
}

const char* failsafeText(LinkFailsafeState state) {
    switch (state) {
    case LinkFailsafeState::none:
        break;
    case LinkFailsafeState::runs:
        return "a process of its own lets servos go when lumorph ends or hangs";
    case LinkFailsafeState::notShared:
        return "! no process lets servos go when lumorph crashes or hangs: this kind of link cannot be shared";
    case LinkFailsafeState::missing:
        return "! no process lets servos go when lumorph crashes or hangs: lumorph-servo-failsafe is missing beside it";
    }
    return "";
}

DeviceProfile profileOf(const DeviceArguments& arguments) {
    DeviceProfile profile;
    if (!arguments.profile.empty()) {
        profile = readProfile(arguments.profile);
    } else {
        const ControllerKind kind =
            arguments.controller.empty() ? likelyController(arguments.uri) : knownController(arguments.controller).kind;
        const std::string rig = arguments.rig.empty() ? resourceFile("models/tablet.glb").string() : arguments.rig;
        profile = profileFor(readRig(rig), firstChannel(kind));
        profile.controller = kind;
    }
    profile.address = arguments.uri;
    profile.restOnExit = false; // a command leaves things where it was told to
    return profile;
}

/// Links and trackers live in threads of Qt, which wants to know of a program.
struct QtProgram {
    int count = 1;
    char name[8] = "lumorph";
    char* words[2] = {name, nullptr};
    QCoreApplication application{count, words};
};

nlohmann::json jsonOf(const LinkStatus& status) {
    nlohmann::json servos = nlohmann::json::array();
    for (const ServoStatus& servo : status.servos) {
        nlohmann::json one = {
            {"wanted", servo.wanted},     {"commanded", servo.commanded}, {"microseconds", servo.microseconds},
            {"attached", servo.attached}, {"known", servo.known},         {"readBack", nullptr}};
        if (servo.readBack) one["readBack"] = *servo.readBack;
        servos.push_back(std::move(one));
    }
    const ControllerState& controller = status.controller;
    nlohmann::json json = {{"phase", phaseText(status.phase)},
                           {"controller", controller.traits.name},
                           {"firmware", controller.firmware},
                           {"product", status.product},
                           {"identity", status.identity},
                           {"readsPosition", controller.traits.readsPosition},
                           {"jumpsOnAttach", controller.traits.jumpsOnAttach},
                           {"failsafe", controller.traits.failsafe},
                           {"failsafeProcess", status.failsafe == LinkFailsafeState::runs},
                           {"volts", nullptr},
                           {"servos", servos}};
    if (controller.volts) json["volts"] = *controller.volts;
    return json;
}

void printText(const std::string& uri, const LinkStatus& status) {
    const ControllerState& controller = status.controller;
    std::printf("%s: %s%s%s, %s\n", uri.c_str(), controller.traits.name.c_str(),
                controller.firmware.empty() ? "" : ", ", controller.firmware.c_str(), phaseText(status.phase));
    if (controller.volts) std::printf("  battery   %.2f V\n", *controller.volts);
    std::printf("  failsafe  of the board: %s\n", controller.traits.failsafeWord.c_str());
    if (const char* process = failsafeText(status.failsafe); *process) std::printf("            %s\n", process);
    if (controller.traits.jumpsOnAttach) std::printf("  ! servos jump to their middle when they are started\n");
    for (std::size_t i = 0; i < status.servos.size(); ++i) {
        const ServoStatus& servo = status.servos[i];
        std::printf("  servo %-3zu %s", i, servo.attached ? "on " : "off");
        if (servo.attached) std::printf("  %.0f us", servo.microseconds);
        if (servo.readBack) std::printf("  stands at %.3f of its way", *servo.readBack);
        std::printf("\n");
    }
}

void list(const DeviceArguments& arguments) {
    const QtProgram program;
    const SimulatedBench bench;
    const std::vector<FoundDevice> found = findDevices(&bench);
    if (arguments.json) {
        nlohmann::json devices = nlohmann::json::array();
        for (const FoundDevice& device : found)
            devices.push_back({{"address", device.address},
                               {"name", device.name},
                               {"hint", device.hint},
                               {"identity", device.identity},
                               {"trouble", device.trouble.why},
                               {"remedy", device.trouble.remedy}});
        printJson(devices);
        return;
    }
    for (const FoundDevice& device : found) {
        std::printf("%-36s %s%s%s\n", device.address.c_str(), device.name.c_str(), device.hint.empty() ? "" : "; ",
                    device.hint.c_str());
        if (!device.trouble.why.empty())
            std::printf("  ! %s; %s\n", device.trouble.why.c_str(), device.trouble.remedy.c_str());
    }
}

void probe(const DeviceArguments& arguments, Session& session) {
    const QtProgram program;
    DeviceLink link(profileOf(arguments), session);
    link.untilReady(arguments.confirmed);
    // Voltages and positions are asked for after the handshake.
    static_cast<void>(link.until([](const LinkStatus& status) { return status.controller.volts.has_value(); },
                                 std::chrono::seconds(1)));
    if (arguments.json)
        printJson(jsonOf(link->status()));
    else
        printText(arguments.uri, link->status());
}

/// What goes over the wire, as text. It is gathered in the link's thread and printed in the command's: whoever reads
/// slowly, or has stopped reading, must not hold the link up.
class WireText {
public:
    void add(std::span<const std::uint8_t> bytes, bool sent) {
        const std::scoped_lock lock(mutex_);
        if (text_.size() > kMostWaiting) {
            ++left_;
            return;
        }
        char word[24];
        std::snprintf(word, sizeof word, "%9.3f %s", std::chrono::duration<double>(Clock::now() - begun_).count(),
                      sent ? "->" : "<-");
        text_ += word;
        for (const std::uint8_t byte : bytes) {
            std::snprintf(word, sizeof word, " %02X", byte);
            text_ += word;
        }
        text_ += '\n';
    }
    void print() {
        std::unique_lock lock(mutex_);
        const std::string text = std::exchange(text_, {});
        const std::size_t left = std::exchange(left_, 0);
        lock.unlock();
        if (text.empty()) return;
        std::fwrite(text.data(), 1, text.size(), stdout);
        if (left > 0) std::printf("... and %zu messages that were not read in time\n", left);
        finishOutput();
    }

private:
    static constexpr std::size_t kMostWaiting = std::size_t{1} << 20U;

    const Clock::time_point begun_ = Clock::now();
    std::mutex mutex_;
    std::string text_;
    std::size_t left_ = 0; ///< messages
};

void monitor(const DeviceArguments& arguments, Session& session) {
    const QtProgram program;
    WireText wire;
    const auto seconds = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(arguments.seconds));
    const auto print = [&wire](const LinkStatus&) {
        wire.print();
        return false;
    };
    bool stopped = false;
    try {
        DeviceLink link(profileOf(arguments), session,
                        [&wire](std::span<const std::uint8_t> bytes, bool sent) { wire.add(bytes, sent); });
        static_cast<void>(link.until(print, seconds));
    } catch (const Cancelled&) {
        stopped = true;
    }
    wire.print(); // with what was said when the link ended
    if (stopped) throw Cancelled();
}

void move(const DeviceArguments& arguments, Session& session) {
    const QtProgram program;
    const DeviceProfile profile = profileOf(arguments);
    const std::size_t count = profile.servos.size();
    if (arguments.actuator < 0 || static_cast<std::size_t>(arguments.actuator) >= count)
        throw InvalidInput("actuator " + std::to_string(arguments.actuator),
                           "the profile has " + std::to_string(count) + " of them", "count from 0");
    if (arguments.levels < 2 || arguments.levels > kMaxLevels || arguments.level < 0 ||
        arguments.level >= arguments.levels)
        throw InvalidInput("level " + std::to_string(arguments.level),
                           "there are " + std::to_string(arguments.levels) + " levels", "count from 0");
    DeviceLink link(profile, session);
    link.untilReady(arguments.confirmed);
    if (link->status().phase == LinkPhase::unidentified)
        throw DeviceError(arguments.uri, "it is not certain what this board is",
                          "look at it with 'lumorph device probe', and say --is-right if it is");
    const auto allKnown = [](const LinkStatus& status) {
        return !status.controller.traits.readsPosition || std::ranges::all_of(status.servos, &ServoStatus::known);
    };
    static_cast<void>(link.until(allKnown, std::chrono::seconds(2)));
    std::vector<double> strokes(count, 0.0);
    const auto servo = static_cast<std::size_t>(arguments.actuator);
    const LinkStatus before = link->status();
    for (std::size_t i = 0; i < count; ++i)
        if (before.servos[i].known) strokes[i] = before.servos[i].commanded;
    strokes[servo] = strokeOf(Level{arguments.level}, arguments.levels);
    link->command(strokes);
    link->arm(arguments.mayJump);
    const auto there = [&](const LinkStatus& status) {
        return (status.phase == LinkPhase::live && std::abs(status.servos[servo].commanded - strokes[servo]) < 1e-3) ||
               !status.waiting.empty();
    };
    if (!link.until(there, kMoveWithin)) link.throwTrouble();
    const LinkStatus after = link->status();
    if (!after.waiting.empty())
        throw DeviceError(arguments.uri, "nobody knows where its servos stand, so they may jump when they start",
                          "keep hands off, and say --may-jump");
    link->leave(); // before printing, which may wait for a reader
    if (arguments.json)
        printJson(jsonOf(after));
    else
        printText(arguments.uri, after);
}

struct SketchArguments {
    std::string project;
    std::string profile;
    std::string output;
    int button = 0;
    bool atPower = false;
    bool json = false;
};

/// The poses of a project for the rig that it names.
BoardSequence posesOf(const SketchArguments& arguments, const Project& project, const Rig& rig) {
    std::vector<std::string> names;
    for (const Actuator& actuator : rig.actuators()) names.push_back(actuator.name);
    if (project.poses.sequence.steps.empty())
        throw DataError(arguments.project, "it has no sequence of poses", "make one in the studio's dock Poses");
    return {sequenceFor(project.poses, names), arguments.atPower ? std::nullopt : std::optional<int>(arguments.button)};
}

void sketch(const SketchArguments& arguments) {
    const Project project = readProject(arguments.project);
    const Rig rig = readRig(assetPath(arguments.project, project.rig));
    const DeviceProfile profile = arguments.profile.empty() ? profileFor(rig, firstChannel(ControllerKind::firmata))
                                                            : readProfile(arguments.profile);
    const BoardSequence poses = posesOf(arguments, project, rig);
    const BoardPlan plan = planForBoard(profile, poses);
    const std::filesystem::path folder = writeSketch(profile, arguments.output, &poses);
    if (arguments.json) {
        printJson({{"folder", folder.string()},
                   {"steps", plan.sequence.steps.size()},
                   {"seconds", durationOf(plan.sequence)},
                   {"bytes", plan.bytes},
                   {"mostBytes", kMostSequenceBytes},
                   {"loop", plan.sequence.loop},
                   {"button", poses.button ? nlohmann::json(*poses.button) : nlohmann::json()},
                   {"notes", plan.notes}});
        return;
    }
    std::printf("%s: %zu steps in %.1f s, %zu of %zu bytes; %s\n", folder.c_str(), plan.sequence.steps.size(),
                durationOf(plan.sequence), plan.bytes, kMostSequenceBytes,
                poses.button ? ("a button on pin " + std::to_string(*poses.button) + " starts it").c_str()
                             : "it starts when the board gets power");
    for (const std::string& note : plan.notes) std::printf("  ! %s\n", note.c_str());
}

void addSketchCommand(CLI::App& group) {
    auto arguments = std::make_shared<SketchArguments>();
    CLI::App* command = group.add_subcommand(
        "sketch", "Write the board's sketch with a project's poses, which it shows without a computer");
    command->add_option("project", arguments->project, "A .lumorph file with a sequence of poses")->required();
    command->add_option("--profile", arguments->profile,
                        "Channels, pulses and limits of the servos (default: as the rig says, from pin 2 on)");
    CLI::Option_group* start = command->add_option_group("start", "What starts it");
    start->add_option("--button", arguments->button, "Pin of a button to ground that starts it");
    start->add_flag("--at-power-on", arguments->atPower, "It starts by itself, and never ends");
    start->require_option(1);
    command->add_option("-o,--output", arguments->output, "The folder in which the sketch's own folder is made")
        ->required();
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments] { sketch(*arguments); });
}

CLI::App* addCommand(CLI::App& group, const char* name, const char* what, DeviceArguments& arguments) {
    CLI::App* command = group.add_subcommand(name, what);
    command
        ->add_option("uri", arguments.uri,
                     "serial:///dev/NAME?baud=N, bt://MAC, hid://VENDOR:PRODUCT?product=TEXT or sim://tablet")
        ->required();
    command
        ->add_option("--controller", arguments.controller,
                     "What it speaks: " + controllerKeys() + " (default: what such an address usually has)")
        ->check([](const std::string& key) {
            try {
                static_cast<void>(knownController(key));
                return std::string();
            } catch (const InvalidInput& error) {
                return std::string(error.what());
            }
        });
    command->add_option("--profile", arguments.profile, "A device profile: channels, pulses, limits");
    command->add_option("--rig", arguments.rig, "The rig whose servos they are (default: the tablet)");
    command->add_flag("--is-right", arguments.confirmed, "It is what it seems to be");
    return command;
}

} // namespace

void addDeviceCommands(CLI::App& app, Session& session) {
    CLI::App* group = app.add_subcommand("device", "Servo controllers");
    group->require_subcommand(1);
    auto arguments = std::make_shared<DeviceArguments>();
    CLI::App* lists = group->add_subcommand("list", "What is connected to this machine, and the simulated boards");
    lists->add_flag("--json", arguments->json, "Print one JSON value");
    lists->callback([arguments] { list(*arguments); });
    addSketchCommand(*group);
    CLI::App* probes =
        addCommand(*group, "probe", "Ask a controller what it is; nothing is driven, and servos that are on are let go",
                   *arguments);
    probes->add_flag("--json", arguments->json, "Print one JSON value");
    probes->callback([arguments, &session] { probe(*arguments, session); });
    CLI::App* monitors =
        addCommand(*group, "monitor",
                   "Print every byte, both ways; nothing is driven, and servos that are on are let go", *arguments);
    monitors->add_option("--seconds", arguments->seconds, "How long (default: until Ctrl-C)")
        ->check(numberBetween(0.0, 1e6));
    monitors->callback([arguments, &session] { monitor(*arguments, session); });
    CLI::App* moves = addCommand(*group, "move", "Start the servos softly and lead one to a level", *arguments);
    moves->add_option("--actuator", arguments->actuator, "Which, from 0")->required();
    moves->add_option("--level", arguments->level, "Where to, from 0")->required();
    moves->add_option("--levels", arguments->levels, "How many levels there are (default 33)");
    moves->add_flag("--may-jump", arguments->mayJump, "Servos whose place is unknown may jump when they start");
    moves->add_flag("--json", arguments->json, "Print one JSON value");
    moves->callback([arguments, &session] { move(*arguments, session); });
}

} // namespace lumorph::cli
