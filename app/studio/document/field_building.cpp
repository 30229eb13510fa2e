#include "app/studio/document/field_building.h"

#include <algorithm>
#include <utility>

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

FieldBuilding::FieldBuilding(StudioDocument& document, JobSlots& jobs, Notices& notices, FieldCache cache)
    : document_(document), jobs_(jobs), notices_(notices), cache_(std::move(cache)) {
    connect(&document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::field) tellStale();
    });
}

void FieldBuilding::build(const BuildOptions& options, bool asked) {
    const StudioState::RigAsset rig = document_.state().rig;
    if (!rig.rig) {
        notices_.post("field", {Notice::Level::error,
                                tr("Field"),
                                tr("there is no rig to build it for"),
                                tr("open a rig first"),
                                {{tr("Open a rig..."), [this] { emit rigWanted(); }}}});
        return;
    }
    std::vector<Notice::Action> remedies;
    if (asked) remedies.push_back({tr("Build with the usual settings"), [this] { build({}, false); }});
    jobs_.run<std::shared_ptr<const MatchField>>(
        "field", "field", tr("Building the field"),
        [rig, options, cache = cache_](const Progress& progress) {
            // What was edited last may not be compiled yet.
            return built(rig.compiled ? *rig.rig : Rig(*rig.parts), options, cache, progress);
        },
        [this, rig, asked](const std::shared_ptr<const MatchField>& field) {
            if (document_.state().rig.origin != rig.origin) return;
            notices_.dismissAll("field");
            const auto put = [&](StudioState& state) { state.field = {{}, field, rig.parts}; };
            // A field that comes with a project just opened is part of opening it, not the user's change.
            if (!asked && !document_.modified() && document_.undoStack().count() == 0 && !document_.previewing())
                document_.complete(put);
            else
                document_.change(tr("Build the field"), put);
        },
        std::move(remedies));
}

void FieldBuilding::tellStale() {
    const StudioState::FieldAsset& field = document_.state().field;
    const QString subject = tr("Field");
    if (!field.stale) return notices_.dismiss("field", subject);
    BuildOptions options;
    const glm::ivec3 size = field.field->field.frame.dimensions;
    options.resolution = std::min({size.x, size.y, size.z});
    options.levels = field.field->field.levels;
    options.samples = static_cast<int>(field.field->field.samples);
    options.seed = field.field->field.seed;
    notices_.post("field", {Notice::Level::warning,
                            subject,
                            tr("is of the rig before your edit"),
                            tr("build it, or take the edit back"),
                            {{tr("Build the field"), [this, options] { build(options, true); }}}});
}

void FieldBuilding::buildMissing() {
    if (document_.state().rig.rig && !document_.state().field.field) build({}, false);
}

} // namespace lumorph::studio
