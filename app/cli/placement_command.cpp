#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "app/cli/project_frame.h"
#include "calibration/placement/light_plan.h"
#include "calibration/placement/projector_models.h"
#include "core/base/error.h"
#include "core/rig/rig_file.h"
#include "core/scene/project.h"

namespace lumorph::cli {

namespace {

struct PlacementArguments {
    std::string rig, project;
    std::string lens, within, blur;
    std::optional<double> aperture, focus; ///< millimetres, metres
    double wanted = LightWish{}.pixelsPerMillimetre;
    double incidence = LightWish{}.mostIncidence.inDegrees();
    bool json = false;
};

/// Numbers between single characters of `between`, all of the text.
std::vector<double> numbersOf(const std::string& text, const std::string& between) {
    std::string spaced = text;
    for (char& character : spaced)
        if (between.find(character) != std::string::npos) character = ' ';
    std::istringstream stream(spaced);
    std::vector<double> numbers;
    for (double number = 0.0; stream >> number;) numbers.push_back(number);
    return stream.eof() ? numbers : std::vector<double>{};
}

std::string modelNames() {
    std::string names;
    for (const ProjectorModel& model : projectorModels())
        names += (names.empty() ? "" : ", ") + std::string(model.name);
    return names;
}

ProjectorLens lensOf(const std::string& text) {
    if (const ProjectorModel* model = findProjectorModel(text)) return lensOf(*model);
    const std::size_t x = text.find('x');
    const std::size_t colon = text.find(':');
    const std::size_t second = colon == std::string::npos ? colon : text.find(':', colon + 1);
    const std::vector<double> size = numbersOf(text.substr(0, colon), "x");
    const std::vector<double> ratio =
        colon == std::string::npos ? std::vector<double>{} : numbersOf(text.substr(colon + 1, second - colon - 1), "-");
    const std::vector<double> shift =
        second == std::string::npos ? std::vector<double>{0.0} : numbersOf(text.substr(second + 1), "");
    if (x == std::string::npos || size.size() != 2 || ratio.empty() || ratio.size() > 2 || shift.size() != 1 ||
        !(size[0] >= 1 && size[0] <= 20000 && size[1] >= 1 && size[1] <= 20000))
        throw InvalidInput("--lens " + text, "it is no lens",
                           "write pixels, throw ratio and shift, such as 1920x1080:1.32-2.15:0 or "
                           "1920x1080:0.496:0.66, or name one of " +
                               modelNames());
    return {{static_cast<int>(size[0]), static_cast<int>(size[1])}, ratio.front(), ratio.back(), shift.front()};
}

std::array<glm::dvec3, 2> boundsOf(const std::string& text) {
    const std::vector<double> numbers = numbersOf(text, ",:");
    if (numbers.size() != 6)
        throw InvalidInput("--within " + text, "it is no box",
                           "write two corners in metres, the lower one first: -0.5,1,-0.5:0.5,2,0.5");
    return {glm::dvec3(numbers[0], numbers[1], numbers[2]), glm::dvec3(numbers[3], numbers[4], numbers[5])};
}

/// What is known of a projector's lens, with what the command line says better.
LensFocus focusOf(const LensFocus& known, const PlacementArguments& arguments) {
    LensFocus focus = known;
    if (!arguments.blur.empty()) {
        const std::vector<double> numbers = numbersOf(arguments.blur, ",:");
        std::vector<MeasuredBlur> measured;
        for (std::size_t k = 0; k + 1 < numbers.size(); k += 2) measured.push_back({numbers[k], 1e-3 * numbers[k + 1]});
        if (numbers.empty() || numbers.size() % 2 != 0)
            throw InvalidInput("--blur " + arguments.blur, "it is no list of distances and widths",
                               "write metres and millimetres, such as 1.6:2.1,1.9:0.4,2.3:2.8");
        focus = lensFocusOf(measured);
    }
    if (arguments.aperture) focus.aperture = 1e-3 * *arguments.aperture;
    if (arguments.focus) focus.focusDistance = *arguments.focus;
    return focus;
}

nlohmann::json jsonOf(const LightMap& map) {
    nlohmann::json json{{"lit", map.lit},
                        {"pixelsPerMillimetre", map.pixelsPerMillimetre},
                        {"incidence", map.incidence.inDegrees()},
                        {"worth", map.worth},
                        {"bestFocus", map.bestFocus}};
    if (map.blurKnown) json["blurMillimetres"] = 1e3 * map.blur;
    return json;
}

void printLight(const char* title, const LightMap& map) {
    std::printf("%s\n  lit             %.1f %% of the upper side over all states\n"
                "  pixels          %.2f a millimetre at least on 95 %% of what is lit\n"
                "  incidence       %.0f degrees at most there\n",
                title, 100.0 * map.lit, map.pixelsPerMillimetre, map.incidence.inDegrees());
    if (map.blurKnown) std::printf("  blur            %.2f mm at most there\n", 1e3 * map.blur);
    for (const double distance : map.bestFocus)
        if (distance > 0.0) std::printf("  best focus      %.3f m before the lens\n", distance);
}

void plan(const PlacementArguments& arguments, const Session& session) {
    const std::optional<ProjectorLens> lens =
        arguments.lens.empty() ? std::nullopt : std::optional(lensOf(arguments.lens));
    const auto [low, high] = boundsOf(arguments.within);
    const Rig rig = readRig(arguments.rig);
    const Installation room =
        arguments.project.empty() ? defaultInstallation() : readProject(projectFile(arguments.project)).installation;
    LightWish wish;
    wish.pixelsPerMillimetre = arguments.wanted;
    wish.mostIncidence = Angle::degrees(arguments.incidence);
    const Progress progress = session.progress();
    const LitDevice device(rig, room.worldFromDevice, 8, 1000, progress.part(0.0, 0.2));
    std::vector<CalibratedCamera> hanging;
    std::vector<LensFocus> focus;
    for (const InstalledProjector& projector : room.projectors) {
        if (!projector.enabled) continue;
        hanging.push_back(projector.camera);
        focus.push_back(focusOf(projector.focus, arguments));
    }
    const LightMap now = device.lightOf(hanging, wish, focus);
    std::vector<LightMap> seen; // by each camera: a tracker loses a device that it does not see
    for (const InstalledCamera& camera : room.cameras) seen.push_back(device.lightOf({&camera.camera, 1}, wish));
    std::optional<ProjectorPlace> best;
    // With a lens of its own the question is where the one projector goes; beside those of a project, where one more.
    if (lens)
        best = bestProjectorPlace(device, *lens, low, high,
                                  arguments.project.empty() ? std::span<const CalibratedCamera>() : hanging, wish,
                                  progress.part(0.2, 1.0));
    if (best && best->light.bestFocus.back() > 0.0) { // a projector that is hung is focused then
        if (arguments.project.empty()) hanging.clear(), focus.clear();
        hanging.push_back(best->camera);
        focus.push_back({focusOf({}, arguments).aperture, best->light.bestFocus.back()});
        best->light = device.lightOf(hanging, wish, focus);
    }
    Session::endProgress();
    if (arguments.json) {
        nlohmann::json all{{"now", jsonOf(now)}, {"cameras", nlohmann::json::array()}};
        for (std::size_t k = 0; k < seen.size(); ++k) {
            all["cameras"].push_back({{"name", room.cameras[k].name},
                                      {"sees", seen[k].lit},
                                      {"pixelsPerMillimetre", seen[k].pixelsPerMillimetre},
                                      {"incidence", seen[k].incidence.inDegrees()}});
        }
        if (best) {
            const glm::dvec3 place = positionOf(best->camera);
            const glm::dvec3 towards = directionOf(best->camera, 0.5 * glm::dvec2(best->camera.size - 1));
            all["best"] = jsonOf(best->light);
            all["best"]["place"] = {place.x, place.y, place.z};
            all["best"]["direction"] = {towards.x, towards.y, towards.z};
            all["best"]["throw"] = best->throwRatio;
            all["best"]["turned"] = best->turned;
        }
        printJson(all);
        return;
    }
    printLight(arguments.project.empty() ? "The lab's projector" : "The projectors that hang there", now);
    for (std::size_t k = 0; k < seen.size(); ++k)
        std::printf("%s\n  sees            %.1f %% of the upper side over all states, with %.2f pixels a millimetre at "
                    "least on 95 %% of it\n",
                    room.cameras[k].name.c_str(), 100.0 * seen[k].lit, seen[k].pixelsPerMillimetre);
    if (!best) return;
    const glm::dvec3 place = positionOf(best->camera);
    std::printf("\nBest place  (%.3f, %.3f, %.3f) m%s, throw ratio %.2f\n", place.x, place.y, place.z,
                best->turned ? ", on its side" : "", best->throwRatio);
    printLight("Light from there", best->light);
}

} // namespace

void addPlacementCommand(CLI::App& group, Session& session) {
    auto arguments = std::make_shared<PlacementArguments>();
    CLI::App* command = group.add_subcommand(
        "placement", "Where a projector should hang: pixels, incidence and shadows on a device over all its states");
    command->add_option("rig", arguments->rig, "A .glb or .gltf file, or a folder of one mesh per state")->required();
    command->add_option("--project", arguments->project,
                        "A .lumorph file with the projectors that hang already, or a bundled one (default: the virtual "
                        "lab's)");
    command->add_option("--lens", arguments->lens,
                        "Of the projector to place: pixels, throw ratio or its range, and how far the picture's middle "
                        "lies above the lens in picture heights: 1920x1080:1.32-2.15:0; or a model: " +
                            modelNames());
    command
        ->add_option("--within", arguments->within,
                     "Where its lens may be, metres in the room (x right, y up, z to the viewer): two corners")
        ->default_val("-0.6,0.8,-0.6:0.6,2.2,0.6");
    command->add_option("--wanted", arguments->wanted, "Pixels a millimetre beyond which more is worth nothing")
        ->check(numberBetween(0.01, 100.0))
        ->capture_default_str();
    command->add_option("--incidence", arguments->incidence, "Degrees beyond which light counts as none")
        ->check(numberBetween(1.0, 89.0))
        ->capture_default_str();
    command
        ->add_option("--aperture", arguments->aperture,
                     "Millimetres that the opening of the projectors' lenses is wide: focal length / f-number")
        ->check(numberBetween(0.0, 500.0));
    command->add_option("--focus", arguments->focus, "Metres before their lenses at which their picture is sharp")
        ->check(numberBetween(0.05, 100.0));
    command->add_option("--blur", arguments->blur,
                        "Instead, the width of a pixel's light on paper as it was measured: metres:millimetres, at "
                        "three distances or more");
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { plan(*arguments, session); });
}

} // namespace lumorph::cli
