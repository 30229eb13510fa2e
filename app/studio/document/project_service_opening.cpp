#include <algorithm>

#include "app/studio/document/project_service_data.h"
#include "app/studio/document/state_rules.h"
#include "core/base/error.h"
#include "core/rig/rig_file.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

/// A rig and the field that was found for it, if any.
struct OpenedRig {
    Stamped<StudioState::RigAsset> rig;
    Stamped<StudioState::FieldAsset> field;
};

/// The field that lies beside a rig under the same name, when it is really its.
Stamped<StudioState::FieldAsset> fieldBeside(const fs::path& rigPath, const Rig& rig) {
    const fs::path file = fs::path(rigPath).replace_extension(".mdf");
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return {};
    try {
        auto field = readFieldAsset(file);
        if (isFieldOf(*field.asset.field, rig)) return field;
    } catch (const DataError&) {
    } // it is built instead
    return {};
}

OpenedRig readOpenedRig(const fs::path& path, const FieldCache& cache, const Progress& progress) {
    OpenedRig opened;
    progress.report(0.1, "reading the rig");
    opened.rig = readRigAsset(path);
    progress.throwIfCancelled();
    progress.report(0.6, "looking for its field");
    opened.field = fieldBeside(path, *opened.rig.asset.rig);
    if (!opened.field.asset.field) opened.field.asset.field = cache.find(*opened.rig.asset.rig);
    return opened;
}

/// Fits the target to the state's rig where it can; elsewhere it stays as it is.
void fitTarget(StudioState& state) {
    if (!state.rig.rig || !state.target.target) return;
    try {
        state.placement =
            placementThatFits(*state.rig.rig, state.field.field.get(), state.target.target->box, state.placement.yaw);
    } catch (const InvalidInput&) {
    }
}

QString joined(const std::vector<std::string>& sentences) {
    QStringList texts;
    for (const std::string& sentence : sentences) texts << QString::fromStdString(sentence);
    return texts.join(' ');
}

} // namespace

void ProjectService::Data::openAsWhatItIs(const fs::path& file) {
    run<FileKind>(
        "look", "viewport", tr("Looking at %1").arg(fileName(file)), [file](const Progress&) { return kindOf(file); },
        [this, file](FileKind kind) {
            switch (kind) {
            case FileKind::project:
                openProject(file);
                break;
            case FileKind::field:
                openField(file);
                break;
            case FileKind::rig:
                openRig(file);
                break;
            case FileKind::target:
                openTarget(file);
                break;
            case FileKind::recording:
                emit service.recordingChosen(fullName(file));
                break;
            case FileKind::voxels:
                notices.post("target", {Notice::Level::error,
                                        fileName(file),
                                        tr("is a grid of voxels, which has no surface to show and move"),
                                        tr("open the mesh that it was made from"),
                                        {chooseAnother("target")}});
                break;
            case FileKind::unknown:
                notices.post("viewport", {Notice::Level::error,
                                          fileName(file),
                                          tr("is no kind of file that can be opened here"),
                                          tr("choose a mesh (.obj, .stl, .ply, .off, .glb, .gltf), a rig, a field "
                                             "(.mdf), a project (.lumorph) or a recording (.lumorphrec)"),
                                          {chooseAnother("viewport")}});
                break;
            }
        },
        {chooseAnother("viewport")});
}

void ProjectService::Data::openRig(const fs::path& path) {
    run<OpenedRig>(
        "rig", "rig", tr("Opening %1").arg(fileName(path)),
        [path, cache = cache](const Progress& progress) { return readOpenedRig(path, cache, progress); },
        [this, path](const OpenedRig& opened) {
            stop("field");
            read.remember(opened.rig.asset.rig, opened.rig.stamp);
            if (opened.field.stamp.there) read.remember(opened.field.asset.field, opened.field.stamp);
            notices.dismissAll("rig");
            notices.dismissAll("field");
            document.change(tr("Open %1").arg(fullName(path.stem())), [&](StudioState& state) {
                state.rig = opened.rig.asset;
                state.field = opened.field.asset;
                fitTarget(state);
            });
            emit service.opened(fullName(path));
            buildMissing();
        },
        {chooseAnother("rig")});
}

void ProjectService::Data::openField(const fs::path& file) {
    run<Stamped<StudioState::FieldAsset>>(
        "field", "field", tr("Opening %1").arg(fileName(file)),
        [file](const Progress&) { return readFieldAsset(file); },
        [this, file](const Stamped<StudioState::FieldAsset>& field) {
            read.remember(field.asset.field, field.stamp);
            takeField(field.asset, tr("Open %1").arg(fullName(file.stem())));
        },
        {chooseAnother("field")});
}

void ProjectService::Data::takeField(StudioState::FieldAsset field, const QString& what) {
    const StudioState& state = document.state();
    if (!state.rig.rig) {
        takeRigOfField(field);
        return;
    }
    if (isFieldOf(*field.field, *state.rig.rig)) {
        notices.dismissAll("field");
        const QString path = fullName(field.path);
        document.change(what, [&](StudioState& next) { next.field = field; });
        emit service.opened(path);
        return;
    }
    const QString why = tr("was built for another rig, \"%1\"").arg(QString::fromStdString(field.field->rig.name()));
    notices.post("field", {Notice::Level::error,
                           fileName(field.path),
                           why,
                           tr("open the rig it was built for, or keep yours"),
                           {{tr("Open its rig"), [this, field] { takeRigOfField(field); }}, {tr("Keep mine"), [] {}}}});
}

void ProjectService::Data::takeRigOfField(const StudioState::FieldAsset& field) {
    stop("rig");
    notices.dismissAll("field");
    document.change(tr("Open the rig of %1").arg(fullName(field.path.stem())), [&](StudioState& state) {
        state.rig = {{}, std::shared_ptr<const Rig>(field.field, &field.field->rig)};
        state.field = field;
        fitTarget(state);
    });
    emit service.opened(fullName(field.path));
}

void ProjectService::Data::openTarget(const fs::path& file) {
    run<Stamped<StudioState::TargetAsset>>(
        "target", "target", tr("Opening %1").arg(fileName(file)),
        [file](const Progress& progress) { return readTargetAsset(file, std::nullopt, progress); },
        [this, file](const Stamped<StudioState::TargetAsset>& target) {
            stop("place");
            read.remember(target.asset.target, target.stamp);
            document.change(tr("Open %1").arg(fullName(file.stem())), [&](StudioState& state) {
                state.target = target.asset;
                state.placement = {};
                fitTarget(state);
            });
            tellTarget(target.asset);
            emit service.opened(fullName(file));
            // Each look at an open mesh takes tens of milliseconds, and the search needs hundreds of them.
            const MatchTarget& opened = *target.asset.target;
            if (!placesNewTargets || opened.duration > 0.0 || !opened.solid.closed) return;
            unplaced = {target.asset.target, document.state().placement};
            placeNew();
        },
        {chooseAnother("target")});
}

void ProjectService::Data::readTargetAgain(const fs::path& file) {
    const auto& open = document.state().target.target;
    const std::optional<int> animation = open && open->animation > 0 ? std::optional(open->animation) : std::nullopt;
    run<Stamped<StudioState::TargetAsset>>(
        "target", "target", tr("Opening %1").arg(fileName(file)),
        [file, animation](const Progress& progress) { return readTargetAsset(file, animation, progress); },
        [this, file](const Stamped<StudioState::TargetAsset>& target) {
            read.remember(target.asset.target, target.stamp);
            document.change(tr("Read %1 again").arg(fullName(file.stem())),
                            [&](StudioState& state) { state.target = target.asset; });
            tellTarget(target.asset);
        },
        {chooseAnother("target")});
}

void ProjectService::Data::tellTarget(const StudioState::TargetAsset& target) {
    notices.dismissAll("target");
    if (!target.target->warnings.empty())
        notices.post("target",
                     {Notice::Level::warning, fileName(target.path), joined(target.target->warnings), {}, {}});
}

} // namespace lumorph::studio
