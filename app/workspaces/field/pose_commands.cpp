#include "app/workspaces/field/pose_commands.h"

#include <utility>

#include <QApplication>

#include "app/studio/look/icons.h"
#include "app/workspaces/field/pose_export.h"

namespace lumorph::studio {

namespace {

/// The commands; lives as long as the desk they work on.
class PoseCommands : public QObject {
public:
    PoseCommands(Studio& studio, PoseDesk& desk) : QObject(&desk), studio_(studio), desk_(desk) {
        keep_ = add(
            "keep", "Keep this pose", "mark", "Where the device is asked to be now, under a name", [this] { keep(); },
            QKeySequence("Ctrl+Shift+P"));
        update_ = add("update", "Take the pose again", "replay", "The chosen pose becomes where the device is now",
                      [this] { desk_.update(); });
        go_ = add("go", "Go to the pose", "hand", "The device takes the chosen pose", [this] { desk_.go(); });
        remove_ = add("remove", "Delete the pose", "trash", "With its steps; undo brings both back",
                      [this] { desk_.remove(); });
        addStep_ = add("addStep", "Add the pose to the sequence", "plus", "As a step behind the chosen one",
                       [this] { desk_.addStep(); });
        removeStep_ = add("removeStep", "Remove the step", "minus", "The chosen step of the sequence (Delete)",
                          [this] { desk_.removeStep(); });
        play_ = add("play", "Play the poses", "play", "", [this] { playOrPause(); });
        stop_ = add("stop", "Stop the poses", "stop", "The device stays where it is", [this] { desk_.stop(); });
        loop_ = add(
            "loop", "Loop the poses", "reset", "From the last pose on to the first, until you stop it",
            [this] { desk_.setLoop(!desk_.book().sequence.loop); }, {}, true);
        export_ = add("export", "Export the poses with the firmware...", "export",
                      "The board's sketch with the sequence in it: the device shows it without a computer",
                      [this] { openPoseExport(studio_, QApplication::activeWindow()); });
        keep_->setIconText("Keep");
        export_->setIconText("Export...");
        connect(&desk, &PoseDesk::changed, this, &PoseCommands::follow);
        connect(&studio.document, &StudioDocument::changed, this, &PoseCommands::follow);
        connect(&studio.loop, &StudioLoop::stoppedChanged, this, &PoseCommands::follow);
        follow();
    }

private:
    QAction* add(const char* id, const char* text, const char* image, const char* hint, std::function<void()> run,
                 const QKeySequence& keys = {}, bool checkable = false) {
        Commands::Options options;
        options.icon = image;
        options.menu = "Actuators";
        options.workspace = "field";
        options.shortcut = keys;
        options.checkable = checkable;
        QAction* action = studio_.commands.add(QString("poses.") + id, text, options, std::move(run));
        const QString shortcut = keys.toString(QKeySequence::NativeText);
        action->setToolTip(hint + (shortcut.isEmpty() ? QString() : " (" + shortcut + ")"));
        return action;
    }

    void keep() {
        QAction* dock = studio_.commands.find("view.dock.poses");
        if (dock && !dock->isChecked()) dock->trigger();
        desk_.keep();
    }

    void playOrPause() {
        if (desk_.state() == PoseDesk::State::playing)
            desk_.pause();
        else
            desk_.play();
    }

    void follow() {
        const bool rig = studio_.document.state().rig.rig != nullptr;
        const bool steps = rig && !desk_.book().sequence.steps.empty();
        const bool plays = desk_.state() == PoseDesk::State::playing;
        keep_->setEnabled(rig);
        for (QAction* action : {update_, go_}) action->setEnabled(rig && desk_.pose() >= 0);
        for (QAction* action : {remove_, addStep_}) action->setEnabled(desk_.pose() >= 0);
        removeStep_->setEnabled(desk_.step() >= 0);
        play_->setEnabled(steps && !studio_.loop.stopped());
        play_->setText(plays ? "Pause the poses" : "Play the poses");
        play_->setIcon(icon(plays ? "pause" : "play"));
        play_->setToolTip(studio_.loop.stopped() ? "After STOP nothing moves until you resume"
                          : !steps               ? "Add a pose to the sequence first"
                          : plays                ? "The device waits where it is"
                                                 : "The servos go through the sequence, under all their limits");
        stop_->setEnabled(desk_.state() != PoseDesk::State::stopped);
        loop_->setChecked(desk_.book().sequence.loop);
        loop_->setEnabled(steps);
        export_->setEnabled(steps);
    }

    Studio& studio_;
    PoseDesk& desk_;
    QAction *keep_ = nullptr, *update_ = nullptr, *go_ = nullptr, *remove_ = nullptr;
    QAction *addStep_ = nullptr, *removeStep_ = nullptr, *play_ = nullptr, *stop_ = nullptr;
    QAction *loop_ = nullptr, *export_ = nullptr;
};

} // namespace

void addPoseCommands(Studio& studio, PoseDesk& desk) { new PoseCommands(studio, desk); }

} // namespace lumorph::studio
