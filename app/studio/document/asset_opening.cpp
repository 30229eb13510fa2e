#include "app/studio/document/asset_opening.h"

#include <algorithm>
#include <utility>

#include "app/studio/document/path_text.h"
#include "app/studio/document/state_rules.h"
#include "core/base/error.h"
#include "core/rig/rig_file.h"

namespace lumorph::studio {

namespace {

namespace fs = std::filesystem;

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

/// A rig and the field that was found for it, if any.
struct AssetOpening::OpenedRig {
    Stamped<StudioState::RigAsset> rig;
    Stamped<StudioState::FieldAsset> field;
};

AssetOpening::AssetOpening(StudioDocument& document, JobSlots& jobs, Notices& notices, ReadFiles& read,
                           FieldCache cache)
    : document_(document), jobs_(jobs), notices_(notices), read_(read), cache_(std::move(cache)) {}

void AssetOpening::open(const fs::path& file) {
    jobs_.run<FileKind>(
        "look", "viewport", tr("Looking at %1").arg(fileName(file)), [file](const Progress&) { return kindOf(file); },
        [this, file](FileKind kind) {
            switch (kind) {
            case FileKind::project:
                emit projectChosen(file);
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
                emit recordingChosen(fullName(file));
                break;
            case FileKind::voxels:
                notices_.post("target", {Notice::Level::error,
                                         fileName(file),
                                         tr("is a grid of voxels, which has no surface to show and move"),
                                         tr("open the mesh that it was made from"),
                                         {chooseAnother("target")}});
                break;
            case FileKind::unknown:
                notices_.post("viewport", {Notice::Level::error,
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

void AssetOpening::openRig(const fs::path& path) {
    const auto read = [path, cache = cache_](const Progress& progress) {
        OpenedRig opened;
        progress.report(0.1, "reading the rig");
        opened.rig = readRigAsset(path);
        progress.throwIfCancelled();
        progress.report(0.6, "looking for its field");
        opened.field = fieldBeside(path, *opened.rig.asset.rig);
        if (!opened.field.asset.field) opened.field.asset.field = cache.find(*opened.rig.asset.rig);
        return opened;
    };
    jobs_.run<OpenedRig>("rig", "rig", tr("Opening %1").arg(fileName(path)), read,
                         [this, path](const OpenedRig& opened) {
                             read_.remember(opened.rig.asset.rig, opened.rig.stamp);
                             if (opened.field.stamp.there) read_.remember(opened.field.asset.field, opened.field.stamp);
                             takeOpened(opened, tr("Open %1").arg(fullName(path.stem())));
                             emit this->opened(fullName(path));
                             emit rigOpened();
                         },
                         {chooseAnother("rig")});
}

void AssetOpening::takeRig(const std::shared_ptr<const Rig>& rig, const QString& name) {
    const auto find = [rig, cache = cache_](const Progress&) {
        OpenedRig made;
        made.rig.asset.rig = rig;
        made.field.asset.field = cache.find(*rig);
        return made;
    };
    jobs_.run<OpenedRig>("rig", "rig", tr("Opening %1").arg(name), find, [this, name](const OpenedRig& made) {
        takeOpened(made, tr("New %1").arg(name));
        emit rigOpened();
    });
}

/// One step of undo: the rig, its field where there is one, and the target fitted anew.
void AssetOpening::takeOpened(const OpenedRig& opened, const QString& step) {
    jobs_.stop("field");
    notices_.dismissAll("rig");
    notices_.dismissAll("field");
    document_.change(step, [&](StudioState& state) {
        state.rig = opened.rig.asset;
        state.field = opened.field.asset;
        fitTarget(state);
    });
}

void AssetOpening::openField(const fs::path& file) {
    jobs_.run<Stamped<StudioState::FieldAsset>>(
        "field", "field", tr("Opening %1").arg(fileName(file)),
        [file](const Progress&) { return readFieldAsset(file); },
        [this, file](const Stamped<StudioState::FieldAsset>& field) {
            read_.remember(field.asset.field, field.stamp);
            takeField(field.asset, tr("Open %1").arg(fullName(file.stem())));
        },
        {chooseAnother("field")});
}

void AssetOpening::takeField(StudioState::FieldAsset field, const QString& what) {
    const StudioState& state = document_.state();
    if (!state.rig.rig) {
        takeRigOfField(field);
        return;
    }
    if (isFieldOf(*field.field, *state.rig.rig)) {
        notices_.dismissAll("field");
        const QString path = fullName(field.path);
        document_.change(what, [&](StudioState& next) { next.field = field; });
        emit opened(path);
        return;
    }
    const QString why = tr("was built for another rig, \"%1\"").arg(QString::fromStdString(field.field->rig.name()));
    notices_.post("field",
                  {Notice::Level::error,
                   fileName(field.path),
                   why,
                   tr("open the rig it was built for, or keep yours"),
                   {{tr("Open its rig"), [this, field] { takeRigOfField(field); }}, {tr("Keep mine"), [] {}}}});
}

void AssetOpening::takeRigOfField(const StudioState::FieldAsset& field) {
    jobs_.stop("rig");
    notices_.dismissAll("field");
    document_.change(tr("Open the rig of %1").arg(fullName(field.path.stem())), [&](StudioState& state) {
        state.rig = {{}, std::shared_ptr<const Rig>(field.field, &field.field->rig)};
        state.field = field;
        fitTarget(state);
    });
    emit opened(fullName(field.path));
}

void AssetOpening::openTarget(const fs::path& file) {
    jobs_.run<Stamped<StudioState::TargetAsset>>(
        "target", "target", tr("Opening %1").arg(fileName(file)),
        [file](const Progress& progress) { return readTargetAsset(file, std::nullopt, progress); },
        [this, file](const Stamped<StudioState::TargetAsset>& target) {
            jobs_.stop("place");
            read_.remember(target.asset.target, target.stamp);
            document_.change(tr("Open %1").arg(fullName(file.stem())), [&](StudioState& state) {
                state.target = target.asset;
                state.placement = {};
                fitTarget(state);
            });
            tellTarget(target.asset);
            emit opened(fullName(file));
            emit targetOpened();
        },
        {chooseAnother("target")});
}

void AssetOpening::readTargetAgain(const fs::path& file) {
    const auto& open = document_.state().target.target;
    const std::optional<int> animation = open && open->animation > 0 ? std::optional(open->animation) : std::nullopt;
    jobs_.run<Stamped<StudioState::TargetAsset>>(
        "target", "target", tr("Opening %1").arg(fileName(file)),
        [file, animation](const Progress& progress) { return readTargetAsset(file, animation, progress); },
        [this, file](const Stamped<StudioState::TargetAsset>& target) {
            read_.remember(target.asset.target, target.stamp);
            document_.change(tr("Read %1 again").arg(fullName(file.stem())),
                             [&](StudioState& state) { state.target = target.asset; });
            tellTarget(target.asset);
        },
        {chooseAnother("target")});
}

void AssetOpening::tellTarget(const StudioState::TargetAsset& target) {
    notices_.dismissAll("target");
    if (!target.target->warnings.empty())
        notices_.post("target",
                      {Notice::Level::warning, fileName(target.path), joined(target.target->warnings), {}, {}});
}

Notice::Action AssetOpening::chooseAnother(const QString& place) {
    return {tr("Choose another file..."), [this, place] { emit fileWanted(place); }};
}

} // namespace lumorph::studio
