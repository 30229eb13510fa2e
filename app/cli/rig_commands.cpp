#include <cstdio>
#include <memory>

#include "app/cli/checks.h"
#include "app/cli/commands.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/mesh_writers.h"
#include "core/rig/rig_check.h"
#include "core/rig/rig_file.h"
#include "core/rig/servo_types.h"
#include "core/rig/shape_report.h"
#include "core/rig/templates/rig_templates.h"
#include "core/rig/templates/sheet_file.h"

namespace lumorph::cli {

namespace {

struct InfoOptions {
    std::string rig;
    bool json = false;
    int states = 100;
    std::uint64_t seed = 1;
    double maxStretch = RigCheckOptions{}.maxStretch;
    double maxSpeed = RigCheckOptions{}.maxSpeed;
};

nlohmann::json vectorJson(const glm::vec3& v) { return {v.x, v.y, v.z}; }

nlohmann::json meshJson(const MeshReport& mesh) {
    return {{"vertices", mesh.vertices},
            {"triangles", mesh.triangles},
            {"components", mesh.components},
            {"closed", mesh.closed()},
            {"manifold", mesh.manifold()},
            {"boundaryEdges", mesh.boundaryEdges},
            {"nonManifoldEdges", mesh.nonManifoldEdges},
            {"degenerateTriangles", mesh.degenerateTriangles},
            {"selfIntersections", mesh.selfIntersections},
            {"inwardComponents", mesh.inwardComponents},
            {"volume", mesh.volume},
            {"findings", mesh.findings()}};
}

nlohmann::json checkJson(const Rig& rig, const RigCheck& check) {
    nlohmann::json findings = nlohmann::json::array();
    for (const RigFinding& finding : check.findings) {
        nlohmann::json names = nlohmann::json::array();
        for (const std::size_t a : finding.actuators) names.push_back(rig.actuators()[a].name);
        findings.push_back({{"kind", nameOf(finding.kind)},
                            {"actuators", names},
                            {"first", finding.first},
                            {"worst", finding.worst},
                            {"amount", finding.amount},
                            {"unit", unitOf(finding.kind)},
                            {"limit", finding.limit},
                            {"place", vectorJson(finding.place)},
                            {"sentence", finding.sentence},
                            {"remedy", finding.remedy}});
    }
    return {{"findings", findings},
            {"levels", check.levelsLookedAt},
            {"pairs", check.pairsLookedAt},
            {"jointStates", check.jointStates}};
}

void printCheck(const RigCheck& check) {
    std::printf("\n  Each actuator alone in %d levels, %d pairs that can meet, %d joint states: ", check.levelsLookedAt,
                check.pairsLookedAt, check.jointStates);
    std::printf(check.findings.empty() ? "nothing wrong.\n" : "%zu found.\n", check.findings.size());
    constexpr std::size_t kMost = 24;
    for (std::size_t k = 0; k < std::min(kMost, check.findings.size()); ++k)
        std::printf("  ! %s\n      %s\n", check.findings[k].sentence.c_str(), check.findings[k].remedy.c_str());
    if (check.findings.size() > kMost) std::printf("  ... and %zu more\n", check.findings.size() - kMost);
}

nlohmann::json reportJson(const Rig& rig, const ShapeReport& report) {
    nlohmann::json actuators = nlohmann::json::array();
    for (std::size_t i = 0; i < report.actuators.size(); ++i) {
        const ShapeReport::PerActuator& a = report.actuators[i];
        const Actuator& actuator = rig.actuators()[i];
        actuators.push_back({{"name", a.name},
                             {"deformer", a.deformer},
                             {"range", {a.rangeMin, a.rangeMax}},
                             {"unit", a.unit},
                             {"levels", actuator.levels},
                             {"maxVelocity", actuator.maxVelocity},
                             {"channel", actuator.drive.channel},
                             {"pulse", {actuator.drive.pulseMin, actuator.drive.pulseMax}},
                             {"pulseCurve", actuator.drive.curve},
                             {"vertices", a.vertices},
                             {"amplitude", a.amplitude},
                             {"sweptArea", a.sweptArea},
                             {"maxCurvature", a.maxCurvature},
                             {"fullStrokeSeconds", a.fullStrokeSeconds},
                             {"torque", a.torque},
                             {"servo", a.servo}});
    }
    return {{"name", rig.name()},
            {"actuators", actuators},
            {"mesh", meshJson(report.rest)},
            {"reach", {{"min", vectorJson(report.reach.min)}, {"max", vectorJson(report.reach.max)}}},
            {"shape",
             {{"area", report.area},
              {"granularity", report.granularity},
              {"maxStretch", report.maxStretch},
              {"secondEquilibria", report.seconds ? nlohmann::json(report.seconds->states) : nlohmann::json()},
              {"volume", {report.volumeMin, report.volumeMax}},
              {"sampledStates", report.sampledStates},
              {"openStates", report.openStates},
              {"intersectingStates", report.intersectingStates},
              {"invertedStates", report.invertedStates},
              {"pathInside", report.pathInside},
              {"pathOutsideShare", report.pathOutsideShare}}},
            {"warnings", report.warnings}};
}

void printRange(const ShapeReport::PerActuator& a) {
    if (a.unit == "rad")
        std::printf("%6.1f to %5.1f deg", Angle::radians(a.rangeMin).inDegrees(),
                    Angle::radians(a.rangeMax).inDegrees());
    else if (a.unit == "m")
        std::printf("%6.1f to %5.1f mm ", 1000 * a.rangeMin, 1000 * a.rangeMax);
    else
        std::printf("%6.2f to %5.2f    ", a.rangeMin, a.rangeMax);
}

/// What holds the levers of a sheet: "  corner front left: an SG90, at most 43 % of its stall torque".
void printServos(const ShapeReport& report) {
    for (const ShapeReport::PerActuator& a : report.actuators) {
        const ServoType* servo = findServo(a.servo);
        if (a.torque <= 0.0) continue;
        std::printf("  %-22s holds at most %.0f mN m", a.name.c_str(), 1e3 * a.torque);
        if (servo != nullptr)
            std::printf(", %.0f %% of what stalls its %s", 100.0 * a.torque / servo->stallTorque, a.servo.c_str());
        std::printf("\n");
    }
}

void printShapes(const Rig& rig, const ShapeReport& report) {
    const glm::vec3 size = 1000.0F * report.reach.size();
    std::printf("%s: %zu triangles, %s, %.0f x %.0f x %.0f mm over all states\n\n", rig.name().c_str(),
                report.rest.triangles, report.rest.solid() ? "a clean closed solid" : "not a clean solid",
                static_cast<double>(size.x), static_cast<double>(size.y), static_cast<double>(size.z));
    constexpr std::size_t kMost = 24;
    std::printf("  %-22s %-12s %-22s %10s %10s %9s\n", "actuator", "moves by", "range", "amplitude", "area", "stroke");
    for (std::size_t i = 0; i < std::min(kMost, report.actuators.size()); ++i) {
        const ShapeReport::PerActuator& a = report.actuators[i];
        std::printf("  %-22s %-12s ", a.name.c_str(), a.deformer == "morph" ? "morph target" : a.deformer.c_str());
        printRange(a);
        std::printf(" %7.1f mm %6.1f cm2 %7.2f s\n", 1000 * a.amplitude, 1e4 * a.sweptArea, a.fullStrokeSeconds);
    }
    if (report.actuators.size() > kMost) std::printf("  ... and %zu more\n", report.actuators.size() - kMost);
    printServos(report);
    std::printf(
        "\n  In %d random states: %d open, %d crossing themselves, %d turned inside out; the top stretches by at "
        "most %.1f %%.\n",
        report.sampledStates, report.openStates, report.intersectingStates, report.invertedStates,
        100 * report.maxStretch);
    if (report.seconds && report.seconds->states > 0)
        std::printf("  In %zu of the %zu joint states that were solved the sheet can also rest in another shape, up to "
                    "%.1f mm away.\n",
                    report.seconds->states, report.seconds->of, 1e3 * report.seconds->distance);
    else if (report.seconds)
        std::printf("  None of the %zu joint states that were solved has a second equilibrium.\n", report.seconds->of);
    for (const std::string& finding : report.rest.findings()) std::printf("  ! %s\n", finding.c_str());
    for (const std::string& warning : report.warnings) std::printf("  ! %s\n", warning.c_str());
}

void rigInfo(const InfoOptions& options, const Session& session) {
    const Rig rig = readRig(options.rig);
    const Progress progress = session.progress();
    const ShapeReport report = shapeReport(rig, options.states, options.seed, progress.part(0.0, 0.5));
    RigCheckOptions limits;
    limits.maxStretch = options.maxStretch;
    limits.maxSpeed = options.maxSpeed;
    limits.states = options.states;
    limits.seed = options.seed;
    const RigCheck check = checkRig(rig, limits, progress.part(0.5, 1.0));
    Session::endProgress();
    if (options.json) {
        nlohmann::json json = reportJson(rig, report);
        json["check"] = checkJson(rig, check);
        return printJson(json);
    }
    printShapes(rig, report);
    printCheck(check);
}

struct DeformOptions {
    std::string rig;
    std::string state;
    std::string output;
    int levels = 0;
};

void deform(const DeformOptions& options) {
    checkOutput(options.output, options.rig);
    const Rig rig = readRig(options.rig);
    const int levels = options.levels > 0        ? options.levels
                       : rig.actuatorCount() > 0 ? rig.actuators().front().levels
                                                 : 33;
    const std::vector<double> strokes = strokesOf(rig, parseState(options.state), levels);
    const TriangleMesh mesh = deformed(rig, strokes);
    if (options.output == "-")
        writeOutput("-", bytesOfText(writeObj(mesh)));
    else
        writeMesh(mesh, options.output);
}

void checkRigOutput(const std::string& output, const std::string& input) {
    if (output.empty()) throw InvalidInput("--output", "it says nowhere to write to", "add -o RIG.glb");
    checkOutput(output, input);
    if (output != "-" && !output.ends_with(".glb"))
        throw InvalidInput(output, "a rig is written as .glb", "name a .glb file");
}

void writeRig(const Rig& rig, const std::string& output) {
    writeOutput(output, writeRigGlb(rig));
    if (output == "-") return;
    const glm::vec3 size = 100.0F * boundingBox(rig.restMesh().positions).size();
    std::printf("%s: %zu actuators, %.1f x %.1f x %.1f cm at rest, %zu triangles\n", rig.name().c_str(),
                rig.actuatorCount(), static_cast<double>(size.x), static_cast<double>(size.z),
                static_cast<double>(size.y), rig.restMesh().triangles.size());
}

struct NewOptions {
    std::string kind;
    std::vector<std::string> choices;
    std::string output;
    bool list = false;
    bool json = false;
};

const char* unitOf(TemplateParameter::Unit unit) {
    return unit == TemplateParameter::Unit::centimetres ? "cm" : unit == TemplateParameter::Unit::degrees ? "deg" : "";
}

std::string wordsOf(const TemplateParameter& parameter) {
    std::string words;
    for (const std::string_view word : parameter.words) words += (words.empty() ? "" : ", ") + std::string(word);
    return words;
}

nlohmann::json parametersJson(const RigTemplate& kind) {
    nlohmann::json parameters = nlohmann::json::array();
    for (const TemplateParameter& p : kind.parameters) {
        nlohmann::json entry{{"name", p.name}, {"meaning", p.meaning}};
        if (p.words.empty()) {
            entry.update({{"unit", unitOf(p.unit)}, {"value", p.value}, {"range", {p.min, p.max}}});
        } else {
            entry["value"] = p.words[static_cast<std::size_t>(p.value)];
            entry["words"] = p.words;
        }
        parameters.push_back(std::move(entry));
    }
    return {{"template", kind.name}, {"meaning", kind.meaning}, {"parameters", parameters}};
}

void printParameters(const RigTemplate& kind) {
    std::printf("%s: %s\n", std::string(kind.name).c_str(), std::string(kind.meaning).c_str());
    for (const TemplateParameter& p : kind.parameters)
        if (p.words.empty())
            std::printf("  %-10s %8.2f %-3s  %s (%g to %g)\n", std::string(p.name).c_str(), p.value, unitOf(p.unit),
                        std::string(p.meaning).c_str(), p.min, p.max);
        else
            std::printf("  %-10s %12s  %s (%s)\n", std::string(p.name).c_str(),
                        std::string(p.words[static_cast<std::size_t>(p.value)]).c_str(), std::string(p.meaning).c_str(),
                        wordsOf(p).c_str());
}

void newRig(const NewOptions& options, const Session& session) {
    const RigTemplate& kind = rigTemplate(options.kind);
    if (options.list) {
        options.json ? printJson(parametersJson(kind)) : printParameters(kind);
        return;
    }
    checkRigOutput(options.output, {});
    std::vector<TemplateChoice> choices;
    for (const std::string& text : options.choices) choices.push_back(parseChoice(kind, text));
    const Rig rig = rigOf(kind, choices, session.progress());
    Session::endProgress();
    writeRig(rig, options.output);
}

struct SheetOptions {
    std::string outline;
    std::string bends;
    std::string output;
};

void sheet(const SheetOptions& options, const Session& session) {
    checkRigOutput(options.output, options.outline);
    checkRigOutput(options.output, options.bends);
    const Rig rig = sheetRig(readSheetDevice(options.outline, options.bends), session.progress());
    Session::endProgress();
    writeRig(rig, options.output);
}

void addMakingCommands(CLI::App* group, Session& session) {
    auto newOptions = std::make_shared<NewOptions>();
    std::string names;
    for (const RigTemplate& kind : rigTemplates()) names += (names.empty() ? "" : ", ") + std::string(kind.name);
    CLI::App* newCommand = group->add_subcommand("new", "Make a rig from a template: " + names);
    newCommand->add_option("template", newOptions->kind, names)->required();
    newCommand->add_option("--set", newOptions->choices, "A parameter, such as width=21cm; again for each")
        ->take_all()
        ->allow_extra_args(false);
    newCommand->add_flag("--list", newOptions->list, "Print the template's parameters instead");
    newCommand->add_flag("--json", newOptions->json, "Print them as one JSON value");
    newCommand->add_option("-o,--output", newOptions->output, "A .glb file, or - for standard output");
    newCommand->callback([newOptions, &session] { newRig(*newOptions, session); });

    auto sheetOptions = std::make_shared<SheetOptions>();
    CLI::App* sheetCommand =
        group->add_subcommand("sheet", "Make a rig of a sheet with an outline and bend lines across it");
    sheetCommand->add_option("outline", sheetOptions->outline, "An SVG file with one closed shape")->required();
    sheetCommand
        ->add_option(
            "--bends", sheetOptions->bends,
            "A JSON file: {\"bends\": [{\"name\", \"from\": [x, y], \"to\": [x, y], \"ends\": \"joined\" or "
            "\"free\", \"side\": \"smaller\", \"left\" or \"right\", \"angle\"}], \"name\", \"top\": \"cut\" or "
            "\"continuous\", \"material\", \"pad\", \"thickness\", \"housing\", \"arc\"}, in cm on the SVG's page and "
            "degrees")
        ->required();
    sheetCommand->add_option("-o,--output", sheetOptions->output, "A .glb file, or - for standard output")->required();
    sheetCommand->callback([sheetOptions, &session] { sheet(*sheetOptions, session); });
}

} // namespace

void addRigCommands(CLI::App& app, Session& session) {
    CLI::App* group = app.add_subcommand("rig", "Make a rig, look at it and deform it");
    group->require_subcommand(1);

    auto infoOptions = std::make_shared<InfoOptions>();
    CLI::App* infoCommand =
        group->add_subcommand("info", "Actuators, ranges, mesh checks and the shape-resolution report");
    infoCommand->add_option("rig", infoOptions->rig, "A .glb or .gltf file, or a folder of one mesh per state")
        ->required();
    infoCommand->add_flag("--json", infoOptions->json, "Print one JSON value");
    infoCommand->add_option("--states", infoOptions->states, "Random joint states to check")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    infoCommand->add_option("--seed", infoOptions->seed, "Which random states")
        ->check(seedNumber())
        ->capture_default_str();
    infoCommand
        ->add_option("--max-stretch", infoOptions->maxStretch,
                     "How much longer than at rest the material may get: 0.1 is a tenth")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    infoCommand
        ->add_option("--max-speed", infoOptions->maxSpeed,
                     "Above this a point of the surface startles, in metres a second")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    infoCommand->callback([infoOptions, &session] { rigInfo(*infoOptions, session); });

    auto deformOptions = std::make_shared<DeformOptions>();
    CLI::App* deformCommand = group->add_subcommand("deform", "Write the mesh of a joint state, in metres");
    deformCommand->add_option("rig", deformOptions->rig, "The rig")->required();
    deformCommand->add_option("--state", deformOptions->state, "One level for each actuator: 0,12,...")->required();
    deformCommand->add_option("--levels", deformOptions->levels, "Levels an actuator (default: the rig's own)")
        ->check(CLI::Range(2, kMaxLevels));
    deformCommand
        ->add_option("-o,--output", deformOptions->output,
                     "An .obj, .stl or .glb file, or - for OBJ on standard output")
        ->required();
    deformCommand->callback([deformOptions] { deform(*deformOptions); });

    addMakingCommands(group, session);
    addRigReport(*group, session);
    addRigSearch(*group, session);
    addPartsCommand(*group, session);
}

} // namespace lumorph::cli
