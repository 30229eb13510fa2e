#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "calibration/lab/device_lab.h"
#include "calibration/lab/lab_capture.h"
#include "core/base/error.h"
#include "core/rig/rig_file.h"
#include "core/scene/project.h"

namespace lumorph::cli {

namespace {

struct LabArguments {
    std::string project;
    std::string board;
    std::string device; ///< a rig, in place of a board
    std::string pattern = "graycode";
    std::string size;
    std::string fault;
    std::string output;
    int poses = 6;
    std::uint32_t seed = 1;
    bool json = false;
};

std::string faultKeys() {
    std::string keys;
    for (const Cause cause : labFaults()) keys += (keys.empty() ? "" : ", ") + std::string(keyOf(cause));
    return keys;
}

std::optional<Cause> faultOf(const std::string& key) {
    if (key.empty()) return std::nullopt;
    const std::optional<Cause> cause = causeOf(key);
    if (!cause) throw InvalidInput("fault '" + key + "'", "there is no such fault", "choose one of: " + faultKeys());
    return cause;
}

/// A word as a shell reads it back: in single quotes where it needs them.
std::string shellWord(const std::string& text) {
    const auto isPlain = [](unsigned char c) {
        return std::isalnum(c) != 0 || c >= 0x80 ||
               std::string_view("_-./:,=+@%").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!text.empty() && std::ranges::all_of(text, isPlain)) return text;
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

/// The same for a path: one that begins with a dash would be an option.
std::string shellPath(const std::string& path) { return shellWord(path.starts_with('-') ? "./" + path : path); }

std::string shortest(double value) {
    std::array<char, 32> digits{};
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

/// The words of a board whose lengths, all behind its size, are other ones.
std::string scaledBoard(const std::string& board, double scale) {
    std::string words;
    std::size_t part = 0;
    for (std::size_t from = 0; from <= board.size(); ++part) {
        const std::size_t end = std::min(board.find(':', from), board.size());
        const std::string text = board.substr(from, end - from);
        double length = 0.0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), length);
        const bool isLength = part >= 2 && error == std::errc() && stop == text.data() + text.size();
        words += (part > 0 ? ":" : "") + (isLength ? shortest(std::round(1e6 * scale * length) / 1e6) : text);
        from = end + 1;
    }
    return words;
}

/// Boards are named in millimetres. One that is larger than the lab's lit place is taken as printed smaller, and named
/// so.
std::unique_ptr<LabCapturer> capturerOf(LabCapture capture) {
    try {
        return std::make_unique<LabCapturer>(capture);
    } catch (const InvalidInput&) {
        const CalibrationBoard board = parseCalibrationBoard(capture.board);
        const double longest = board.spacing * (std::max(board.columns, board.rows) + 2) * 0.001;
        constexpr double kFits = 0.29; // metres
        if (longest <= kFits) throw;
        // A spacing of whole micrometres is read back as it is written.
        const double scale = 0.001 * std::floor(1000.0 * board.spacing * kFits / longest) / board.spacing;
        capture.board = scaledBoard(capture.board, scale);
        auto capturer = std::make_unique<LabCapturer>(capture);
        printWarnings({"The board is larger than what the lab's projector lights, so it is taken as printed smaller: " +
                       capture.board + "."});
        return capturer;
    }
}

/// The installation in which a capture is taken, with a camera.
Installation roomOf(const LabArguments& arguments) {
    Installation room =
        arguments.project.empty() ? defaultInstallation() : readProject(projectFile(arguments.project)).installation;
    if (room.projectors.empty())
        throw InvalidInput("installation", "it has no projector", "add one in the studio, or name no project");
    if (room.cameras.empty()) {
        CalibratedCamera camera = defaultLabCamera(room.projectors.front().camera);
        constexpr double kCloser = 1.7; // zoomed in, since a device is smaller than where boards are held
        if (!arguments.device.empty()) camera.focal *= kCloser;
        room.cameras.push_back({"Camera", "", camera, {}, {}});
        printWarnings({"The installation has no camera; one beside the projector is assumed."});
    }
    if (!arguments.size.empty()) {
        CalibratedCamera& camera = room.cameras.front().camera;
        const cv::Size size = parseProjectorSize(arguments.size);
        camera = withSize(camera, {size.width, size.height});
    }
    return room;
}

void captureDevice(const LabArguments& arguments, const Session& session) {
    if (!arguments.board.empty() || !arguments.fault.empty())
        throw InvalidInput("--device", "boards and faults are not for captures of the device",
                           "leave --board and --fault out, or --device");
    DeviceLabCapture capture;
    capture.room = roomOf(arguments);
    capture.pattern = arguments.pattern;
    capture.seed = arguments.seed;
    const Rig rig = readRig(arguments.device);
    writeDeviceLabCapture(capture, rig, arguments.output, session.progress());
    Session::endProgress();
    const glm::ivec2 projector = capture.room.projectors.front().camera.size;
    const std::size_t shots = rig.actuatorCount() + 1;
    if (arguments.json) {
        printJson({{"folder", arguments.output},
                   {"shots", shots},
                   {"rig", arguments.device},
                   {"pattern", arguments.pattern},
                   {"projector", {projector.x, projector.y}},
                   {"truth", arguments.output + "/truth.json"}});
        return;
    }
    std::printf("%zu shots of %s in %s; the truth is in truth.json\n", shots, rig.name().c_str(),
                arguments.output.c_str());
    std::printf("  lumorph calibrate device %s --rig %s --projector %dx%d --pattern %s\n",
                shellPath(arguments.output).c_str(), shellPath(arguments.device).c_str(), projector.x, projector.y,
                shellWord(arguments.pattern).c_str());
}

void capture(const LabArguments& arguments, const Session& session) {
    if (!arguments.device.empty()) return captureDevice(arguments, session);
    if (arguments.board.empty())
        throw InvalidInput("--board", "it says no board to photograph",
                           "add --board chess:9x7:25, or --device RIG.glb for the device itself");
    LabCapture capture;
    capture.room = roomOf(arguments);
    capture.board = arguments.board;
    capture.pattern = arguments.pattern;
    capture.poses = arguments.poses;
    capture.seed = arguments.seed;
    capture.fault = faultOf(arguments.fault);
    const std::unique_ptr<LabCapturer> capturer = capturerOf(capture);
    const std::string& board = capturer->capture().board;
    writeLabCapture(*capturer, arguments.output, session.progress());
    Session::endProgress();
    const CalibratedCamera& projector = capturer->lab().projector().camera;
    if (arguments.json) {
        printJson({{"folder", arguments.output},
                   {"poses", arguments.poses},
                   {"board", board},
                   {"pattern", arguments.pattern},
                   {"projector", {projector.size.x, projector.size.y}},
                   {"truth", arguments.output + "/truth.json"}});
        return;
    }
    std::printf("%d poses of %s in %s; the truth is in truth.json\n", arguments.poses, board.c_str(),
                arguments.output.c_str());
    std::printf("  lumorph calibrate procam %s --board %s --projector %dx%d --pattern %s\n",
                shellPath(arguments.output).c_str(), shellWord(board).c_str(), projector.size.x, projector.size.y,
                shellWord(arguments.pattern).c_str());
}

} // namespace

void addLabCommands(CLI::App& app, Session& session) {
    CLI::App* group = app.add_subcommand("lab", "The virtual lab");
    group->require_subcommand(1);
    auto arguments = std::make_shared<LabArguments>();
    CLI::App* command = group->add_subcommand("capture", "Photograph a board, or the device, under a projector's "
                                                         "patterns, with the truth beside: for calibrating and trying");
    command->add_option("project", arguments->project,
                        "A .lumorph file whose installation is used, or a bundled one: resource:projects/NAME.lumorph "
                        "(default: the virtual lab's installation)");
    command->add_option("--board", arguments->board,
                        "The board, millimetres: chess:9x7:25 (inner corners, side of a square), circles:4x11:20, "
                        "charuco:5x7:30:22, charuco:6x8:30:22:6X6_250, charuco:6x8:30:22:old (as OpenCV printed even "
                        "numbers of rows before 4.6)");
    command->add_option("--device", arguments->device,
                        "A rig, photographed in place of a board: at rest, and with each actuator raised");
    command->add_option("--poses", arguments->poses, "How many; the first lies flat on the table")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_option("--seed", arguments->seed, "Other poses, noise and fault for another number")
        ->check(seedNumber())
        ->capture_default_str();
    command->add_option("--fault", arguments->fault, "Make something wrong on purpose: " + faultKeys());
    command->add_option("--pattern", arguments->pattern, "graycode, or phase:16x3+1x3 (periods x steps)")
        ->capture_default_str();
    command->add_option("--size", arguments->size,
                        "Of the camera's pictures, WIDTHxHEIGHT (default: the camera's own)");
    command->add_option("-o,--output", arguments->output, "A folder, new or empty")->required();
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { capture(*arguments, session); });
    addPlacementCommand(*group, session);
    addLabRegisterCommand(*group, session);
}

} // namespace lumorph::cli
