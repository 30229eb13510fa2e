#include "app/cli/scene_report.h"

#include <array>

#include "core/scene/scene_assets.h"

namespace lumorph::cli {
namespace {

/// In the order of ItemKind.
constexpr std::array<const char*, std::variant_size_v<ItemKind>> kKinds = {"mesh", "target", "shape", "heights",
                                                                           "fog",  "light",  "group"};

std::string counted(std::size_t count, const std::string& one) {
    return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

nlohmann::json projectorsOf(const Installation& installation) {
    nlohmann::json projectors = nlohmann::json::array();
    for (const InstalledProjector& projector : installation.projectors)
        projectors.push_back({{"name", projector.name},
                              {"enabled", projector.enabled},
                              {"size", {projector.camera.size.x, projector.camera.size.y}}});
    return projectors;
}

/// A problem of the form "asset: why; what to do" in its parts.
DataError errorOf(const std::string& asset, const std::string& problem) {
    const std::size_t why = problem.starts_with(asset + ": ") ? asset.size() + 2 : 0;
    const std::size_t remedy = problem.rfind("; ");
    if (remedy == std::string::npos || remedy < why) return {asset, problem.substr(why), "choose another file"};
    return {asset, problem.substr(why, remedy - why), problem.substr(remedy + 2)};
}

} // namespace

SceneReport sceneReport(const Scene& scene, const Installation& installation,
                        const std::filesystem::path& projectFile) {
    SceneReport report;
    nlohmann::json items = nlohmann::json::object();
    for (const char* kind : kKinds) items[kind] = 0;
    for (const SceneItem& item : scene.items) {
        nlohmann::json& count = items[kKinds.at(item.kind.index())];
        count = count.get<int>() + 1;
    }
    nlohmann::json assets = nlohmann::json::array();
    const auto loaded = loadSceneAssets(scene, projectFile);
    for (const std::string& name : assetNames(scene)) {
        const auto problem = loaded->problems.find(name);
        const bool found = problem == loaded->problems.end();
        assets.push_back({{"asset", name}, {"ok", found}});
        if (found) continue;
        const DataError error = errorOf(name, problem->second);
        assets.back().update({{"why", error.why()}, {"remedy", error.remedy()}});
        report.problems.push_back(error);
    }
    const SceneItem* driving = drivingItem(scene);
    report.json = {{"items", items},
                   {"servosFollow", driving ? nlohmann::json(driving->name) : nlohmann::json()},
                   {"projectors", projectorsOf(installation)},
                   {"assets", assets}};
    report.text = counted(scene.items.size(), "item") + ", " + counted(installation.projectors.size(), "projector") +
                  ", " + counted(assets.size(), "file") +
                  (report.problems.empty() ? "" : " (" + std::to_string(report.problems.size()) + " broken)");
    return report;
}

} // namespace lumorph::cli
