#include <cstdio>
#include <memory>
#include <optional>

#include "app/cli/commands.h"
#include "app/cli/scene_report.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/geometry/mesh_file.h"
#include "core/geometry/model.h"
#include "core/mdf/field_file.h"
#include "core/rig/rig_file.h"
#include "core/scene/project.h"

namespace lumorph::cli {

namespace {

/// What is known of one asset after reading it.
struct AssetReport {
    nlohmann::json json; ///< null where the project has none
    std::string text;
};

const char* nameOf(Driver driver) {
    return driver == Driver::target ? "the target" : driver == Driver::sceneItem ? "the scene's item" : "the hand";
}

/// A project looked through asset by asset: one that is broken does not hide what is wrong with the next.
class Check {
public:
    Check(const std::string& file, const Session& session)
        : file_(file), session_(session), project_(readProject(file)) {
        rig_ = look(project_.rig, [this](const std::filesystem::path& path) { return readRigAsset(path); });
        field_ = look(project_.field, [this](const std::filesystem::path& path) { return readFieldAsset(path); });
        target_ = look(project_.target, [this](const std::filesystem::path& path) { return readTargetAsset(path); });
        checkStrokes();
        lookAtPoses();
        checkScenery();
    }

    void printText() const {
        std::printf("%s: a project of schema %d\n", file_.c_str(), kProjectSchema);
        std::printf("  rig     %s\n", rig_.text.c_str());
        std::printf("  field   %s\n", field_.text.c_str());
        std::printf("  target  %s\n", target_.text.c_str());
        std::printf("  servos  follow %s; matching %s, within %g ms\n", nameOf(project_.matching.driver),
                    project_.matching.refined ? "refined" : "voting", project_.matching.budgetMilliseconds);
        std::printf("  poses   %s\n", poses_.text.c_str());
        std::printf("  scene   %s\n", scene_.text.c_str());
        for (const Error& problem : problems_) std::printf("  ! %s\n", problem.what());
    }

    [[nodiscard]] nlohmann::json json() const {
        nlohmann::json problems = nlohmann::json::array();
        for (const Error& problem : problems_)
            problems.push_back({{"subject", problem.subject()}, {"why", problem.why()}, {"remedy", problem.remedy()}});
        return {{"ok", problems_.empty()}, {"schemaVersion", kProjectSchema},
                {"rig", rig_.json},        {"field", field_.json},
                {"target", target_.json},  {"poses", poses_.json},
                {"scene", scene_.json},    {"problems", problems}};
    }

    void throwIfBroken() const {
        if (!problems_.empty()) throw DataError(problems_.front());
    }

private:
    template <typename Read> AssetReport look(const std::string& asset, Read read) {
        if (asset.empty()) return {nullptr, "none"};
        session_.throwIfCancelled();
        AssetReport report{{{"asset", asset}, {"ok", false}}, asset + ": cannot be used"};
        try {
            const AssetReport known = read(assetPath(file_, asset));
            report.json.update(known.json);
            report.json["ok"] = true;
            report.text = asset + ": " + known.text;
        } catch (const DataError& error) {
            problems_.push_back(error);
        } catch (const InvalidInput& error) {
            problems_.emplace_back(error.subject(), error.why(), error.remedy());
        }
        return report;
    }

    AssetReport readRigAsset(const std::filesystem::path& path) {
        const Rig rig = readRig(path);
        actuators_.emplace();
        for (const Actuator& actuator : rig.actuators()) actuators_->push_back(actuator.name);
        return {{{"actuators", *actuators_}, {"triangles", rig.restMesh().triangles.size()}},
                std::to_string(rig.actuatorCount()) + " actuators, " + std::to_string(rig.restMesh().triangles.size()) +
                    " triangles"};
    }

    AssetReport readFieldAsset(const std::filesystem::path& path) {
        const Field field = parseField(readFile(path, kMaxFileBytes), path.string());
        std::vector<std::string> names;
        for (const ActuatorField& actuator : field.actuators) names.push_back(actuator.name);
        if (actuators_ && names != *actuators_)
            throw DataError(path.string(), "was built for another rig (" + field.rigName + ")",
                            "build the field of this rig");
        const glm::ivec3& d = field.frame.dimensions;
        return {{{"dims", {d.x, d.y, d.z}}, {"levels", field.levels}},
                std::to_string(d.x) + " x " + std::to_string(d.y) + " x " + std::to_string(d.z) + " voxels, " +
                    std::to_string(field.levels) + " levels"};
    }

    AssetReport readTargetAsset(const std::filesystem::path& path) {
        std::vector<std::string> warnings;
        const TriangleMesh mesh = readMesh(path, &warnings);
        printWarnings(warnings);
        const std::size_t animations = isGltfFile(path) ? readModel(path).animations.size() : 0;
        if (project_.animation > 0 && static_cast<std::size_t>(project_.animation) >= animations)
            throw DataError(file_,
                            "animation: " + std::to_string(project_.animation) + " is not one of the target's " +
                                std::to_string(animations),
                            "choose one from 0 up");
        return {{{"triangles", mesh.triangles.size()}, {"animations", animations}},
                std::to_string(mesh.triangles.size()) + " triangles, " + std::to_string(animations) + " animations"};
    }

    void checkStrokes() {
        const std::size_t strokes = project_.strokes.size();
        if (!actuators_ || strokes == 0 || strokes == actuators_->size()) return;
        problems_.emplace_back(file_,
                               "strokes: are " + std::to_string(strokes) + ", but the rig has " +
                                   std::to_string(actuators_->size()) + " actuators",
                               "give one an actuator, or remove them");
    }

    /// Poses of other actuators are no mistake: they are kept for the rig that has them.
    void lookAtPoses() {
        const PoseSequence& sequence = project_.poses.sequence;
        poses_ = {{{"count", sequence.poses.size()},
                   {"steps", sequence.steps.size()},
                   {"seconds", durationOf(sequence)},
                   {"loop", sequence.loop}},
                  sequence.poses.empty() ? "none"
                                         : std::to_string(sequence.poses.size()) + " poses, " +
                                               std::to_string(sequence.steps.size()) + " steps"};
        if (!actuators_) return;
        const PoseFit fit = fitOf(project_.poses, *actuators_);
        poses_.json["atRest"] = fit.atRest;
        poses_.json["kept"] = fit.kept;
        if (!fit.atRest.empty())
            poses_.text += "; " + std::to_string(fit.atRest.size()) + " actuators of the rig rest in them";
        if (!fit.kept.empty())
            poses_.text += "; of " + std::to_string(fit.kept.size()) + " actuators that the rig does not have";
    }

    void checkScenery() {
        session_.throwIfCancelled();
        const SceneReport report = sceneReport(project_.scene, project_.installation, file_);
        scene_ = {report.json, report.text};
        problems_.insert(problems_.end(), report.problems.begin(), report.problems.end());
    }

    std::string file_;
    const Session& session_;
    Project project_;
    std::optional<std::vector<std::string>> actuators_; ///< of the rig, once it has been read
    AssetReport rig_, field_, target_, poses_, scene_;
    std::vector<DataError> problems_;
};

struct CheckArguments {
    std::string project;
    bool json = false;
};

void check(const CheckArguments& arguments, const Session& session) {
    const Check check(arguments.project, session);
    if (arguments.json)
        printJson(check.json());
    else
        check.printText();
    check.throwIfBroken();
}

} // namespace

void addProjectCommand(CLI::App& app, Session& session) {
    CLI::App* group = app.add_subcommand("project", "Look at project files");
    group->require_subcommand(1);

    auto arguments = std::make_shared<CheckArguments>();
    CLI::App* command = group->add_subcommand("check", "Read a project and everything it names, and say what is wrong");
    command->add_option("project", arguments->project, "A .lumorph file")->required();
    command->add_flag("--json", arguments->json, "Print one JSON value");
    command->callback([arguments, &session] { check(*arguments, session); });
}

} // namespace lumorph::cli
