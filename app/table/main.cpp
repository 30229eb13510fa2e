#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/table/gige_camera.h"
#include "app/table/mjpeg_server.h"
#include "app/table/screen_eye.h"
#include "app/table/servo_port.h"
#include "app/table/table.h"
#include "app/table/table_camera.h"
#include "app/table/table_lines.h"
#include "app/table/table_truth.h"
#include "app/table/tracker_server.h"
#include "core/base/error.h"
#include "core/base/resources.h"
#include "core/rig/rig_file.h"

namespace {

using namespace lumorph;
using namespace lumorph::table;

struct Arguments {
    std::uint32_t seed = 1;
    std::string truth, rig;
    std::string board = "chess:9x7:25";
    std::vector<std::string> screens;
    int projectors = 1, cameras = 0;
    std::string cameraSize = "1280x1024";
};

/// Those that were named; else as many as there are projectors, the last ones first: on the first is the studio.
std::vector<Screen> screensFor(const Arguments& arguments) {
    const std::vector<Screen> all = ScreenEye::screens();
    std::vector<Screen> chosen;
    for (const std::string& name : arguments.screens) {
        const auto found = std::ranges::find(all, name, &Screen::name);
        std::string names;
        for (const Screen& one : all) names += (names.empty() ? "" : ", ") + one.name;
        if (found == all.end())
            throw InvalidInput("screen " + name, "the display has none of that name", "it has " + names);
        chosen.push_back(*found);
    }
    if (!chosen.empty()) return chosen;
    if (arguments.projectors < 1 || static_cast<std::size_t>(arguments.projectors) > all.size())
        throw InvalidInput("projectors", "there are " + std::to_string(all.size()) + " screens",
                           "connect more, or ask for fewer");
    chosen.assign(all.end() - arguments.projectors, all.end());
    return chosen;
}

glm::ivec2 sizeOf(const std::string& text) {
    glm::ivec2 size{0};
    if (std::sscanf(text.c_str(), "%dx%d", &size.x, &size.y) != 2 || size.x < 8 || size.y < 8 || size.x > 8192 ||
        size.y > 8192)
        throw InvalidInput("camera size " + text, "it is no size", "write 1280x1024");
    return size;
}

int run(const Arguments& arguments) {
    ScreenEye eye(screensFor(arguments));
    TableOrder order;
    order.seed = arguments.seed;
    for (const Screen& screen : eye.watched()) order.screens.push_back(screen.size);
    order.cameras = arguments.cameras > 0 ? arguments.cameras : static_cast<int>(order.screens.size());
    order.cameraSize = sizeOf(arguments.cameraSize);
    order.board = arguments.board;
    const std::string rig = arguments.rig.empty() ? resourceFile("models/tablet.glb").string() : arguments.rig;
    table::Table table(drawTruth(order, std::make_shared<const Rig>(readRig(rig))));
    if (!arguments.truth.empty()) writeTruth(table.truth(), arguments.truth);

    nlohmann::ordered_json ready;
    std::vector<std::unique_ptr<TableCamera>> cameras;
    std::vector<std::unique_ptr<GigeCamera>> network;
    std::vector<std::unique_ptr<MjpegServer>> telephones;
    for (int k = 0; k < order.cameras; ++k) {
        const std::string number = std::to_string(k + 1);
        cameras.push_back(std::make_unique<TableCamera>(table, eye, static_cast<std::size_t>(k)));
        network.push_back(std::make_unique<GigeCamera>(*cameras.back(), "127.0.0." + number, "TABLE" + number));
        telephones.push_back(std::make_unique<MjpegServer>(*cameras.back()));
        ready["cameras"].push_back({{"uri", network.back()->address()}, {"mjpeg", telephones.back()->address()}});
    }
    TrackerServer tracker(table);
    ServoPort servos(table);
    ready["tracker"] = tracker.address();
    ready["servos"] = servos.address();
    for (const Screen& screen : eye.watched())
        ready["screens"].push_back({{"name", screen.name}, {"width", screen.size.x}, {"height", screen.size.y}});
    std::cout << ready.dump() << std::endl;

    TableLines lines({table, eye, tracker, servos, network});
    for (std::string line; !lines.ended() && std::getline(std::cin, line);)
        if (!line.empty()) std::cout << lines.answer(line) << std::endl;
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app("A room behind sockets: cameras, a tracker and servos that answer as real ones do, and look at the "
                 "studio's projector windows. Lines on standard input are the hands: " +
                     std::string(TableLines::help()),
                 "lumorph-table");
    app.set_version_flag("--version", LUMORPH_VERSION);
    app.add_option("--seed", arguments.seed, "Which room")->capture_default_str();
    app.add_option("--truth", arguments.truth, "Write how the room truly is to this file, for whoever judges");
    app.add_option("--rig", arguments.rig, "The device; else the bundled tablet");
    app.add_option("--board", arguments.board, "The printed board, millimetres")->capture_default_str();
    app.add_option("--screen", arguments.screens, "A screen that a projector shows, once for each");
    app.add_option("--projectors", arguments.projectors, "How many, at the last screens")->capture_default_str();
    app.add_option("--cameras", arguments.cameras, "How many; else one a projector");
    app.add_option("--camera-size", arguments.cameraSize, "Pixels of each")->capture_default_str();
    std::signal(SIGPIPE, SIG_IGN);
    try {
        app.parse(argc, argv);
        return run(arguments);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lumorph-table: %s\n", error.what());
        return 1;
    }
}
