#include "core/loop/match_target.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/geometry/gltf_reader.h"
#include "core/geometry/mesh_check.h"
#include "core/geometry/mesh_file.h"

namespace lumorph {

namespace {

bool isGltf(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".gltf" || extension == ".glb";
}

int chosenAnimation(const Model& model, std::optional<int> wish, const std::string& file) {
    const int count = static_cast<int>(model.animations.size());
    if (!wish) return count > 0 ? 0 : -1;
    if (*wish < 0 || *wish >= count)
        throw DataError(file,
                        "it has " + std::to_string(count) + " animations, and none with the number " +
                            std::to_string(*wish) + " counted from 0",
                        "choose another animation, or export the model with it");
    return *wish;
}

void checkTriangles(std::size_t triangles, const std::vector<std::string>& warnings, const std::string& file) {
    if (triangles == 0)
        throw DataError(file,
                        "it holds no triangles" + (warnings.empty() ? std::string() : " (" + warnings.front() + ")"),
                        "export the model as a surface of polygons");
    if (triangles > kMaxTriangles)
        throw DataError(file,
                        "it has " + std::to_string(triangles) + " triangles; at most " + std::to_string(kMaxTriangles) +
                            " are taken",
                        "simplify the model before exporting it");
}

void checkVolume(const MatchTarget& target, const std::string& file) {
    const glm::dvec3 size(target.box.size());
    const double largest = std::max({size.x, size.y, size.z});
    if (std::min({size.x, size.y, size.z}) <= 1e-6 * largest)
        throw DataError(file, "it is flat, so that it has no volume to match",
                        "give it a thickness, or choose a solid model");
    if (target.animation < 0 && target.solid.closed &&
        std::abs(signedVolume(target.solid.mesh)) <= 1e-9 * size.x * size.y * size.z)
        throw DataError(file, "its surface encloses no volume",
                        "look for faces that lie on one another, and choose a solid model");
}

/// A mesh that moves is used as it is: a repair would hold for one of its poses only.
Target movingTarget(TriangleMesh mesh) {
    if (isClosedSolid(mesh)) return {std::move(mesh), true, {}};
    Target target{std::move(mesh), false, {}};
    target.warnings = checkMesh(target.mesh, IntersectionTest::skip).findings();
    target.warnings.emplace_back("The animated target is not a closed solid; what counts as inside is estimated by "
                                 "winding numbers in every frame, which makes matching slower and may differ near the "
                                 "holes. Close it in a modeller.");
    return target;
}

void measureAnimation(MatchTarget& target, const Model::Animation& animation, const Progress& progress) {
    constexpr double kSamplesPerSecond = 30.0;
    constexpr double kMostSamples = 240.0;
    const double samples = std::clamp(std::ceil(kSamplesPerSecond * target.duration), 1.0, kMostSamples);
    target.box = boxOverAnimation(*target.model, animation, static_cast<int>(samples), samples / target.duration,
                                  progress.part(0.5, 1.0));
}

MatchTarget targetOfModel(std::shared_ptr<const Model> model, const std::vector<std::string>& warnings,
                          const std::string& file, std::optional<int> wish, const Progress& progress) {
    MatchTarget target;
    const int index = chosenAnimation(*model, wish, file);
    const Model::Animation* animation = index < 0 ? nullptr : &model->animations[static_cast<std::size_t>(index)];
    TriangleMesh mesh = animation ? flatten(*model, *animation, 0.0) : flatten(*model);
    checkTriangles(mesh.triangles.size(), warnings, file);
    progress.report(0.3, "looking the mesh over");
    target.name = model->name;
    target.model = std::move(model);
    target.duration = animation ? animation->duration() : 0.0;
    if (target.duration > 0.0) {
        target.animation = index;
        target.solid = movingTarget(std::move(mesh));
        measureAnimation(target, *animation, progress);
    } else {
        target.solid = makeTarget(std::move(mesh));
        target.box = boundingBox(target.solid.mesh.positions);
    }
    return target;
}

MatchTarget targetOfMesh(TriangleMesh mesh, const std::vector<std::string>& warnings, const std::string& file,
                         const Progress& progress) {
    checkTriangles(mesh.triangles.size(), warnings, file);
    progress.report(0.3, "looking the mesh over");
    MatchTarget target;
    target.solid = makeTarget(std::move(mesh));
    target.box = boundingBox(target.solid.mesh.positions);
    return target;
}

} // namespace

std::shared_ptr<const MatchTarget> readMatchTarget(const std::filesystem::path& file, std::optional<int> animation,
                                                   const Progress& progress) {
    progress.report(0.0, "reading the target");
    progress.throwIfCancelled();
    MatchTarget target;
    std::vector<std::string> warnings; // of the file
    try {
        if (isGltf(file)) {
            ReadModel read = readModelFile(file);
            warnings = std::move(read.warnings);
            auto model = std::make_shared<const Model>(std::move(read.model));
            progress.throwIfCancelled();
            target = targetOfModel(std::move(model), warnings, file.string(), animation, progress);
        } else {
            TriangleMesh mesh = readMesh(file, &warnings);
            progress.throwIfCancelled();
            target = targetOfMesh(std::move(mesh), warnings, file.string(), progress);
        }
    } catch (const InvalidInput& error) {
        throw DataError(file.string(), error.why(), error.remedy());
    }
    checkVolume(target, file.string());
    if (!file.stem().empty()) target.name = file.stem().string();
    target.warnings = std::move(warnings);
    target.warnings.insert(target.warnings.end(), target.solid.warnings.begin(), target.solid.warnings.end());
    progress.report(1.0, "reading the target");
    return std::make_shared<const MatchTarget>(std::move(target));
}

double animationTime(const MatchTarget& target, double seconds) {
    // The end itself is shown as the end, so that a slider reaches it.
    if (!(target.duration > 0.0) || seconds == target.duration) return target.duration;
    const double time = std::fmod(seconds, target.duration);
    return time < 0.0 ? time + target.duration : time;
}

TriangleMesh meshAt(const MatchTarget& target, double seconds) {
    if (!target.model || target.animation < 0) return target.solid.mesh;
    return flatten(*target.model, target.model->animations[static_cast<std::size_t>(target.animation)],
                   animationTime(target, seconds));
}

} // namespace lumorph
