#include "app/studio/document/studio_document.h"

#include <utility>

#include <QUndoCommand>

#include "app/studio/document/state_rules.h"

namespace lumorph::studio {

namespace {

// A step may hold a whole field; without a limit a long session would fill the memory.
constexpr int kMostSteps = 200;

} // namespace

/// The one command: what was before and what is after. It has happened already when it is pushed.
class StudioDocument::ChangeState : public QUndoCommand {
public:
    ChangeState(StudioDocument& document, const QString& what, StudioState before, StudioState after)
        : QUndoCommand(what), document_(document), before_(std::move(before)), after_(std::move(after)) {
        // Pictures that only undo would hold can be read again.
        before_.assets.reset();
        after_.assets.reset();
        // Edited parts can be compiled again; only what was opened is kept whole.
        for (StudioState::RigAsset* rig : {&before_.rig, &after_.rig})
            if (isEdited(*rig)) rig->rig.reset();
    }

    void undo() override {
        document_.previewing_ = false;
        document_.exchange(before_);
    }
    void redo() override {
        if (!std::exchange(pushed_, true)) return;
        document_.previewing_ = false;
        document_.exchange(after_);
    }

private:
    StudioDocument& document_;
    StudioState before_;
    StudioState after_;
    bool pushed_ = false;
};

StudioDocument::StudioDocument(QObject* parent) : QObject(parent) {
    state_ = settled({}, {});
    undo_.setUndoLimit(kMostSteps);
    connect(&undo_, &QUndoStack::cleanChanged, this, &StudioDocument::titleChanged);
}

void StudioDocument::change(const QString& what, const std::function<void(StudioState&)>& edit) {
    const StudioState before = previewing_ ? beforePreview_ : state_;
    StudioState after = before;
    edit(after);
    after = withTakeover(before, settled(before, std::move(after)));
    if (!differenceOf(before, after)) return;
    // A result that arrives during a drag is a step of its own below the drag, which goes on.
    StudioState shown = after;
    if (previewing_) {
        shown = state_;
        edit(shown);
        shown = withTakeover(state_, settled(state_, std::move(shown)));
        beforePreview_ = after;
    }
    undo_.push(new ChangeState(*this, what, before, std::move(after)));
    exchange(shown);
}

void StudioDocument::preview(const std::function<void(StudioState&)>& edit) {
    if (!previewing_) beforePreview_ = state_;
    previewing_ = true;
    StudioState next = state_;
    edit(next);
    exchange(withTakeover(state_, settled(state_, std::move(next))));
}

void StudioDocument::commitPreview(const QString& what) {
    if (!std::exchange(previewing_, false)) return;
    if (!differenceOf(beforePreview_, state_)) return;
    undo_.push(new ChangeState(*this, what, std::exchange(beforePreview_, {}), state_));
}

void StudioDocument::cancelPreview() {
    if (std::exchange(previewing_, false)) exchange(std::exchange(beforePreview_, {}));
}

void StudioDocument::setAssets(std::shared_ptr<const SceneAssets> assets) {
    if (state_.assets == assets) return;
    state_.assets = std::move(assets);
    emit changed(StatePart::scene);
}

void StudioDocument::setInstallation(std::shared_ptr<const Installation> installation) {
    StudioState next = state_;
    next.installation = std::move(installation);
    exchange(next);
}

void StudioDocument::setCompiled(const StudioState::RigAsset& of, const std::shared_ptr<const Rig>& rig) {
    const auto take = [&](StudioState::RigAsset& asset) {
        if (asset.compiled || asset.origin != of.origin) return;
        asset.rig = rig;
        asset.compiled = asset.parts == of.parts;
    };
    if (previewing_) take(beforePreview_.rig);
    StudioState next = state_;
    take(next.rig);
    exchange(next);
}

void StudioDocument::complete(const std::function<void(StudioState&)>& put) {
    StudioState next = state_;
    put(next);
    exchange(settled(state_, std::move(next)));
}

void StudioDocument::reset(StudioState state, const std::filesystem::path& file) {
    previewing_ = false;
    beforePreview_ = {};
    if (!state.installation) state.installation = state_.installation;
    state_ = settled({}, std::move(state));
    file_ = file;
    undo_.clear();
    emit changed(StatePart::all);
    emit titleChanged();
}

void StudioDocument::setSaved(const std::filesystem::path& file) {
    file_ = file;
    undo_.setClean();
    emit titleChanged();
}

bool StudioDocument::modified() const noexcept { return !undo_.isClean(); }

QString StudioDocument::name() const {
    return file_.empty() ? tr("Untitled") : QString::fromStdString(file_.stem().string());
}

void StudioDocument::exchange(const StudioState& next) {
    const StudioState before = std::exchange(state_, withRig(next, state_.rig));
    state_.assets = before.assets;
    const StateParts parts = differenceOf(before, state_);
    if (!parts) return;
    emit changed(parts);
}

} // namespace lumorph::studio
