#include <algorithm>

#include "app/studio/document/project_service_data.h"

namespace lumorph::studio {

namespace {

/// Building itself, then what matching needs of it, then a copy for the next time.
std::shared_ptr<const MatchField> built(const Rig& rig, const BuildOptions& options, const FieldCache& cache,
                                        const Progress& progress) {
    auto field = std::make_shared<const MatchField>(buildField(rig, options, progress));
    progress.throwIfCancelled();
    cache.keep(field->field);
    return field;
}

} // namespace

void ProjectService::Data::build(const BuildOptions& options, bool asked) {
    const StudioState::RigAsset rig = document.state().rig;
    if (!rig.rig) {
        notices.post("field", {Notice::Level::error,
                               tr("Field"),
                               tr("there is no rig to build it for"),
                               tr("open a rig first"),
                               {{tr("Open a rig..."), [this] { emit service.chooseFile("rig"); }}}});
        return;
    }
    std::vector<Notice::Action> remedies;
    if (asked) remedies.push_back({tr("Build with the usual settings"), [this] { build({}, false); }});
    run<std::shared_ptr<const MatchField>>(
        "field", "field", tr("Building the field"),
        [rig, options, cache = cache](const Progress& progress) {
            // What was edited last may not be compiled yet.
            return built(rig.compiled ? *rig.rig : Rig(*rig.parts), options, cache, progress);
        },
        [this, rig, asked](const std::shared_ptr<const MatchField>& field) {
            if (document.state().rig.origin != rig.origin) return;
            notices.dismissAll("field");
            const auto put = [&](StudioState& state) { state.field = {{}, field, rig.parts}; };
            // A field that comes with a project just opened is part of opening it, not the user's change.
            if (!asked && !document.modified() && document.undoStack().count() == 0 && !document.previewing()) {
                StudioState state = document.state();
                put(state);
                document.reset(std::move(state), document.file());
            } else {
                document.change(tr("Build the field"), put);
            }
        },
        std::move(remedies));
}

void ProjectService::Data::tellStale() {
    const StudioState::FieldAsset& field = document.state().field;
    const QString subject = tr("Field");
    if (!field.stale) return notices.dismiss("field", subject);
    BuildOptions options;
    const glm::ivec3 size = field.field->field.frame.dimensions;
    options.resolution = std::min({size.x, size.y, size.z});
    options.levels = field.field->field.levels;
    options.samples = static_cast<int>(field.field->field.samples);
    options.seed = field.field->field.seed;
    notices.post("field", {Notice::Level::warning,
                           subject,
                           tr("is of the rig before your edit"),
                           tr("build it, or take the edit back"),
                           {{tr("Build the field"), [this, options] { build(options, true); }}}});
}

void ProjectService::Data::buildMissing() {
    if (document.state().rig.rig && !document.state().field.field) build({}, false);
}

} // namespace lumorph::studio
