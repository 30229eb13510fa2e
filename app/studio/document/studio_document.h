#pragma once

#include <functional>

#include <QObject>
#include <QString>
#include <QUndoStack>

#include "app/studio/document/studio_state.h"

namespace lumorph::studio {

/// The parts of a StudioState, for telling what changed. `rig` says that there is another rig now; `rigEdited` that the
/// same one was edited, or is compiled now, so that selections, cameras and links may stay as they are.
enum class StatePart : unsigned {
    rig = 1,
    field = 2,
    target = 4,
    placement = 8,
    strokes = 16,
    matching = 32,
    playback = 64,
    scene = 128,
    installation = 256,
    poses = 1024,
    all = 511 | poses,
    rigEdited = 512, ///< not in `all`, which replaces the rig
};
Q_DECLARE_FLAGS(StateParts, StatePart)
Q_DECLARE_OPERATORS_FOR_FLAGS(StateParts)

/// What is open, with undo. Panels edit it through `change` and `preview` and listen to `changed`; none knows another.
/// Lives in the window's thread.
class StudioDocument : public QObject {
    Q_OBJECT
public:
    explicit StudioDocument(QObject* parent = nullptr);

    [[nodiscard]] const StudioState& state() const noexcept { return state_; }

    /// One step of undo. An edit that leaves everything as it was is no step.
    void change(const QString& what, const std::function<void(StudioState&)>& edit);
    /// An edit while something is dragged: shown at once, not yet a step of undo.
    void preview(const std::function<void(StudioState&)>& edit);
    /// Makes one step of undo of all previews since the last step.
    void commitPreview(const QString& what);
    /// Takes all previews back, as when Esc is pressed during a drag.
    void cancelPreview();
    [[nodiscard]] bool previewing() const noexcept { return previewing_; }

    /// Hands over what the scene names; no step of undo, and told as a change of the scene.
    void setAssets(std::shared_ptr<const SceneAssets> assets);

    /// Hands over what the parts in `of` were compiled to; no step of undo. It is shown until the newest parts are
    /// compiled; where they are already, or the rig is another one by now, nothing happens.
    void setCompiled(const StudioState::RigAsset& of, const std::shared_ptr<const Rig>& rig);

    /// What belongs to a project that was just opened and comes after it, such as its field; no step of undo.
    void complete(const std::function<void(StudioState&)>& put);

    /// What the machine has kept of the room; no step of undo.
    void setInstallation(std::shared_ptr<const Installation> installation);

    /// Replaces everything but the installation, unless the state brings one, and forgets undo: a project was opened,
    /// or a new one begun.
    void reset(StudioState state, const std::filesystem::path& file);

    /// The project's file; empty while it has none.
    [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
    /// It was saved as `file`.
    void setSaved(const std::filesystem::path& file);
    /// Changed since it was saved.
    [[nodiscard]] bool modified() const noexcept;
    /// What the window calls the project: the file's name, or "Untitled".
    [[nodiscard]] QString name() const;

    [[nodiscard]] QUndoStack& undoStack() noexcept { return undo_; }

signals:
    void changed(lumorph::studio::StateParts parts);
    /// Name, file or modified flag.
    void titleChanged();

private:
    class ChangeState;
    void exchange(const StudioState& next);

    StudioState state_;
    StudioState beforePreview_;
    bool previewing_ = false;
    std::filesystem::path file_;
    QUndoStack undo_;
};

} // namespace lumorph::studio
