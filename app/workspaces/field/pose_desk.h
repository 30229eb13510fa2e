#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <QObject>
#include <QString>

#include "app/studio/document/hand_control.h"
#include "app/studio/shell/studio.h"
#include "core/motion/pose_book.h"

namespace lumorph::studio {

inline const QString kPosePlace = QStringLiteral("poses"); ///< of notices and jobs

/// The document's poses as one works with them: which pose and step are chosen, what edits do, and a sequence that
/// plays. It moves the servos as a hand does: by the loop's wish, under all limits. Lives in the window's thread.
class PoseDesk : public QObject {
    Q_OBJECT
public:
    explicit PoseDesk(Studio& studio, QObject* parent = nullptr);

    enum class State { stopped, playing, paused };
    [[nodiscard]] State state() const;
    /// Begins at the first step, or goes on after a pause. Nothing where there is no step.
    void play();
    void pause();
    /// The device stays where it is asked to be now, as one step of undo.
    void stop();
    /// How far the sequence has come in this round, seconds; empty while it does not play.
    [[nodiscard]] std::optional<double> seconds() const;
    /// The sequence as it plays: for this rig, from where the device is, no faster than servos may. Empty where there
    /// is nothing to play.
    [[nodiscard]] std::optional<PoseSequence> planned() const;
    /// Which steps take longer than they were set to, in a sentence; empty: none.
    [[nodiscard]] QString slowedText() const;
    /// Where poses and rig do not know the same actuators, in a sentence; empty: they do.
    [[nodiscard]] QString fitText() const;

    [[nodiscard]] const PoseBook& book() const;
    [[nodiscard]] std::vector<std::string> actuatorNames() const; ///< of the rig
    [[nodiscard]] int pose() const noexcept { return pose_; }     ///< that is chosen; -1: none
    [[nodiscard]] int step() const noexcept { return step_; }
    void choosePose(int index);
    void chooseStep(int index);

    void keep();   ///< where the device is asked to be, as a new pose
    void update(); ///< the same, in place of the chosen one
    void rename(int pose, const QString& name);
    void remove();
    void go();      ///< to the chosen pose
    void addStep(); ///< to the chosen pose, behind the chosen step
    void removeStep();
    void moveStep(int from, int to);
    void editStep(const QString& what, const std::function<void(PoseStep&)>& edit);
    /// While a number is dragged; `commitPreview` of the document makes a step of undo of it.
    void previewStep(const std::function<void(PoseStep&)>& edit);
    void setLoop(bool loop);

signals:
    /// Poses, what is chosen, or whether they play.
    void changed();
    /// A pose is there that the user may want to name.
    void kept(int pose);

private:
    void onChanged(StateParts parts);
    void onFrame();
    void edit(const QString& what, const std::function<void(PoseBook&)>& edit);
    [[nodiscard]] std::vector<PoseLimits> limits() const;
    [[nodiscard]] std::optional<PoseSequence> plannedFrom(const std::vector<double>& from) const;
    void settleChoice();

    Studio& studio_;
    HandControl hand_;
    int pose_ = -1;
    int step_ = -1;
};

} // namespace lumorph::studio
