#include <array>
#include <charconv>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "app/cli/render_views.h"
#include "core/base/error.h"

namespace lumorph::cli {

namespace {

using View = ViewRequest::View;

constexpr double kLongestShow = 3600.0; ///< seconds that a device may have followed
constexpr int kSmallestSide = 16;
constexpr int kLargestSide = 8192;

const std::map<std::string, View> kViews{{"eye", View::eye},
                                         {"projector", View::projector},
                                         {"lab", View::lab},
                                         {"mask", View::mask},
                                         {"device", View::device}};

struct RenderArguments {
    std::string project;
    std::string view;
    std::string eye;
    std::string observer;
    std::string size;
    std::string state;
    std::string output;
    std::vector<std::string> hands;
    bool handsTracked = false;
    double ambient = 0.0;
    int projector = 0;
    double seconds = 0.0;
    bool json = false;
};

/// The numbers of "A,B,C"; empty unless each part is one.
template <typename Number> std::vector<Number> numbersOf(const std::string& text, char separator) {
    std::vector<Number> numbers;
    const char* place = text.data();
    const char* const end = place + text.size();
    for (;;) {
        Number number{};
        const auto [next, error] = std::from_chars(place, end, number);
        if (error != std::errc()) return {};
        numbers.push_back(number);
        if (next == end) return numbers;
        if (*next != separator) return {};
        place = next + 1;
    }
}

std::optional<glm::vec3> placeOf(const char* option, const std::string& text) {
    if (text.empty()) return std::nullopt;
    const auto numbers = numbersOf<float>(text, ',');
    if (numbers.size() != 3)
        throw InvalidInput(option, "'" + text + "' is no place", "give three numbers, metres: X,Y,Z");
    return glm::vec3(numbers[0], numbers[1], numbers[2]);
}

std::optional<glm::ivec2> sizeOf(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const auto numbers = numbersOf<int>(text, 'x');
    if (numbers.size() != 2) throw InvalidInput("--size", "'" + text + "' is no size", "write it as 1280x800");
    for (const int side : numbers)
        if (side < kSmallestSide || side > kLargestSide)
            throw InvalidInput("--size", std::to_string(side) + " pixels are out of range",
                               "use " + std::to_string(kSmallestSide) + " to " + std::to_string(kLargestSide));
    return glm::ivec2(numbers[0], numbers[1]);
}

nlohmann::json cameraJson(const CalibratedCamera& camera) {
    nlohmann::json pose = nlohmann::json::array();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) pose.push_back(camera.cameraFromWorld[column][row]);
    const glm::dvec3 position = positionOf(camera);
    return {{"size", {camera.size.x, camera.size.y}},
            {"matrix", {camera.focal.x, 0, camera.principal.x, 0, camera.focal.y, camera.principal.y, 0, 0, 1}},
            {"distortion", camera.distortion},
            {"cameraFromWorld", pose},
            {"position", {position.x, position.y, position.z}}};
}

void printReport(const RenderArguments& arguments, const ProjectFrame& project, const RenderedView& view) {
    nlohmann::json milliseconds = {{"upload", view.ms.upload},
                                   {"shadow", view.ms.shadow},
                                   {"eye", view.ms.eye},
                                   {"projectors", view.ms.projectors},
                                   {"total", view.ms.total}};
    if (arguments.view == "lab") milliseconds["lab"] = view.labMilliseconds;
    printJson({{"view", arguments.view},
               {"size", {view.image.size().x, view.image.size().y}},
               {"seconds", arguments.seconds},
               {"strokes", project.strokes},
               {"camera", view.camera ? cameraJson(*view.camera) : nlohmann::json()},
               {"milliseconds", milliseconds}});
}

void render(const RenderArguments& arguments, const Session& session) {
    const std::filesystem::path file = projectFile(arguments.project);
    checkOutput(arguments.output, file.string());
    if (arguments.output == "-") throw InvalidInput("--output", "a picture needs a file", "name a .png file");
    ViewRequest request{kViews.at(arguments.view),
                        static_cast<std::size_t>(arguments.projector),
                        placeOf("--observer", arguments.observer),
                        sizeOf(arguments.size),
                        {},
                        arguments.ambient};
    for (const std::string& hand : arguments.hands) {
        const auto place = placeOf("--hand", hand);
        if (!place) throw InvalidInput("--hand", "it is empty", "give a place as X,Y,Z in metres");
        request.hands.push_back(*place);
    }
    request.handsTracked = arguments.handsTracked;
    ProjectMoment moment{arguments.seconds, placeOf("--eye", arguments.eye), std::nullopt};
    if (!arguments.state.empty()) moment.state = parseState(arguments.state);

    ProjectFrame project = readProjectFrame(file, moment, session);
    const RenderedView view = renderView(project.frame, request);
    session.throwIfCancelled();
    writePng(view.image, arguments.output);
    printWarnings(project.warnings);
    printWarnings(view.warnings);
    if (arguments.json) printReport(arguments, project, view);
}

} // namespace

void addRenderCommand(CLI::App& app, Session& session) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = app.add_subcommand("render", "Draw what a project shows, without a window");
    command
        ->add_option("project", arguments->project, "A .lumorph file, or a bundled one: resource:projects/NAME.lumorph")
        ->required();
    command
        ->add_option(
            "--view", arguments->view,
            "eye: what the viewer should see; projector: what is sent out; lab: what an observer sees of the lit "
            "device and table; mask: white where eye and projector see the same surface; device: the device "
            "without light")
        ->required()
        ->check(CLI::IsMember(kViews));
    command->add_option("--eye", arguments->eye,
                        "The viewer whom the show follows, world metres: X,Y,Z (default: the project's)");
    command->add_option("--observer", arguments->observer,
                        "Who looks at lab or device, world metres: X,Y,Z (default: the eye)");
    command
        ->add_option("--hand", arguments->hands,
                     "In the lab, the viewer's hand at a place, world metres: X,Y,Z; once for each hand")
        ->allow_extra_args(false); // else it takes the project that follows for another hand
    command->add_flag("--hands-tracked", arguments->handsTracked,
                      "A tracker sees these hands: projectors leave to one another what a hand keeps from one");
    command->add_option("--ambient", arguments->ambient, "In the lab, the room's light: radiance of white")
        ->check(numberBetween(0.0, 10.0))
        ->capture_default_str();
    command->add_option("--projector", arguments->projector, "Which projector, from 0")
        ->check(CLI::Range(0, 63))
        ->capture_default_str();
    command->add_option("--time", arguments->seconds, "Seconds since the show began; the device has followed it so far")
        ->check(numberBetween(0.0, kLongestShow))
        ->capture_default_str();
    command->add_option("--size", arguments->size,
                        "Pixels, WIDTHxHEIGHT (default: 1280x800; a projector's picture has its own size)");
    command->add_option(
        "--state", arguments->state,
        "Where the device is instead: one level for each actuator, 0,12,... (of the field's levels, or 33)");
    command->add_option("-o,--output", arguments->output, "A .png file")->required();
    command->add_flag("--json", arguments->json, "Print size, camera and milliseconds as one JSON value");
    command->callback([arguments, &session] { render(*arguments, session); });
}

} // namespace lumorph::cli
