#pragma once

#include <map>
#include <utility>

#include <QPointer>

#include "app/studio/document/assets.h"
#include "app/studio/document/field_cache.h"
#include "app/studio/document/file_watch.h"
#include "app/studio/document/project_service.h"
#include "app/studio/document/rig_compiler.h"
#include "app/studio/document/session_keeper.h"

namespace lumorph::studio {

/// What the service works with; its functions are spread over files by what they do.
struct ProjectService::Data {
    Data(ProjectService& owner, StudioDocument& openDocument, Jobs& allJobs, Notices& allNotices);

    // project_service_opening.cpp
    void openAsWhatItIs(const std::filesystem::path& file);
    void openRig(const std::filesystem::path& path);
    void openField(const std::filesystem::path& file);
    void openTarget(const std::filesystem::path& file);
    void readTargetAgain(const std::filesystem::path& file);
    void takeField(StudioState::FieldAsset field, const QString& what);
    void takeRigOfField(const StudioState::FieldAsset& field);
    void tellTarget(const StudioState::TargetAsset& target);

    // project_service_building.cpp
    void build(const BuildOptions& options, bool asked);
    void buildMissing();
    /// Says that the field is of the rig before an edit, and no longer when it is not.
    void tellStale();

    // project_service_placing.cpp
    void fit();
    void autoPlace();
    void placeNew();
    void glideTo(const Placement& place, const QString& what);

    // project_service_scene.cpp
    void readMissingAssets();
    void readAssetAgain(const std::string& asset);
    void readAssets(std::shared_ptr<const SceneAssets> before);
    void takeAssets(const std::shared_ptr<const SceneAssets>& assets);
    void tellVanishedAsset(const QString& path);
    void relink(const std::string& asset, const std::filesystem::path& file);
    [[nodiscard]] std::map<std::string, FileStamp> sceneStamps();
    [[nodiscard]] Notice::Action offerRelink(const std::string& asset);

    // project_service_saving.cpp
    void openProject(const std::filesystem::path& file);
    /// A demo by its name, or a new project.
    void openBundled(const std::string& demo, std::function<void()> onReady);
    void saveTo(const std::filesystem::path& file);
    void restore(std::function<void()> onReady);
    void replaceAll(LoadedProject loaded, const std::filesystem::path& file);
    [[nodiscard]] ProjectSource source() const;
    [[nodiscard]] std::optional<SessionState> session() const;

    // project_service.cpp
    void watchFiles();
    void tellChanged(const QString& place, const QString& path);
    void tellVanished(const QString& place, const QString& path);
    void fail(const QString& place, const std::exception& error, std::vector<Notice::Action> actions = {});
    [[nodiscard]] Notice::Action chooseAnother(const QString& place);

    /// A job that fails by a notice at its place. Of one slot only the newest runs.
    template <class Result>
    void run(const QString& slot, const QString& place, const QString& title,
             std::function<Result(const Progress&)> work, std::function<void(Result)> done,
             std::vector<Notice::Action> remedies = {}) {
        // After the service has gone nothing is handed over.
        const QPointer<ProjectService> alive(&service);
        runWith<Result>(slot, place, title, std::move(work), std::move(done),
                        [this, alive, place, remedies = std::move(remedies)](const std::exception& error) {
                            if (alive) fail(place, error, remedies);
                        });
    }
    template <class Result>
    void runWith(const QString& slot, const QString& place, const QString& title,
                 std::function<Result(const Progress&)> work, std::function<void(Result)> done,
                 std::function<void(const std::exception&)> failed) {
        const QPointer<ProjectService> alive(&service);
        if (const auto old = slots_.find(slot); old != slots_.end()) jobs.cancel(old->second);
        slots_[slot] = jobs.run<Result>(
            place, title, std::move(work),
            [alive, done = std::move(done)](Result result) {
                if (alive) done(std::move(result));
            },
            std::move(failed));
    }
    void stop(const QString& slot) {
        if (const auto old = slots_.find(slot); old != slots_.end()) jobs.cancel(old->second);
    }

    ProjectService& service;
    StudioDocument& document;
    Jobs& jobs;
    Notices& notices;
    ReadFiles read;
    ProjectExtras extras;
    FieldCache cache;
    FileWatch watch;
    SessionKeeper keeper;
    RigCompiler compiler;
    bool placesNewTargets = false;
    std::vector<std::string> reading;             ///< what the scene names of which is being read
    std::map<std::string, FileStamp> assetStamps; ///< of the scene's files as they were read
    /// A target that was just opened and waits for its better place, and where it stands until then.
    struct Unplaced {
        std::shared_ptr<const MatchTarget> target;
        Placement placement;
    };
    Unplaced unplaced;
    std::map<QString, Jobs::Id> slots_;
};

/// What the scene's files are watched as, before their names.
inline constexpr const char* kScenePlace = "scene:";

/// The last part of a path, as a user knows it.
[[nodiscard]] inline QString fileName(const std::filesystem::path& path) {
    const std::filesystem::path name = path.has_filename() ? path.filename() : path.parent_path().filename();
    return QString::fromStdString(name.string());
}
[[nodiscard]] inline QString fullName(const std::filesystem::path& path) {
    return QString::fromStdString(path.string());
}

} // namespace lumorph::studio
