#include "app/workspaces/field/field_commands.h"

#include <filesystem>
#include <numbers>
#include <utility>

#include <QActionGroup>
#include <QFileDialog>
#include <QFileInfo>
#include <QRandomGenerator>

#include "app/studio/document/hand_control.h"
#include "app/studio/look/icons.h"
#include "app/studio/widgets/bundled_shelf.h"
#include "app/workspaces/field/actuator_scale.h"
#include "core/base/resources.h"

namespace lumorph::studio {

namespace {

constexpr double kSpin = std::numbers::pi / 6.0; ///< radians a second, when it is switched on
constexpr const char* kTargetFolder = "folders/target";

/// The commands and what they need; lives as long as the commands do.
class FieldCommands : public QObject {
public:
    FieldCommands(Studio& studio, std::function<QWidget*()> parent)
        : QObject(&studio.commands), studio_(studio), parent_(std::move(parent)) {
        addTarget();
        studio_.commands.addFinder([this] {
            std::vector<Findable> found;
            for (const BundledFile& one : bundledTargets())
                found.push_back({one.title, "Target", "target", "field",
                                 [this, file = one.file] { studio_.project.openTarget(file); }});
            return found;
        });
        addRig();
        addMatch();
        connect(&studio.document, &StudioDocument::changed, this, [this] { follow(); });
        connect(&studio.driver, &DriverControl::changed, this, [this] { follow(); });
        connect(&studio.jobs, &Jobs::finished, this, [this] { follow(); });
        connect(&studio.project, &ProjectService::chooseFile, this, [this](const QString& place) {
            if (place == "target") openTarget();
        });
        follow();
    }

private:
    struct Words {
        const char* id;
        const char* text;
        const char* hint;
        const char* icon;
        const char* shortcut;
    };

    QAction* add(const Words& words, const QString& menu, bool checkable, std::function<void()> run) {
        Commands::Options options;
        options.icon = words.icon;
        options.shortcut = QKeySequence(words.shortcut);
        options.menu = menu;
        options.workspace = "field";
        options.checkable = checkable;
        QAction* action = studio_.commands.add(words.id, words.text, options, std::move(run));
        const QString keys = options.shortcut.toString(QKeySequence::NativeText);
        action->setToolTip(QString(words.hint) + (keys.isEmpty() ? QString() : " (" + keys + ")"));
        return action;
    }

    void addTarget() {
        add({"target.open", "Open target...", "Open a 3D model to be matched", "open", "Ctrl+T"}, "Target", false,
            [this] { openTarget(); });
        add({"target.dunes", "Try the dunes", "Open a bundled model that the tablet can show well", "target", ""},
            "Target", false, [this] { studio_.project.openTarget(resourceFile("targets/dunes.glb")); });
        add({"target.bloom", "Try the bloom", "Open a bundled model that moves as the tablet can", "target", ""},
            "Target", false, [this] { studio_.project.openTarget(resourceFile("targets/bloom.glb")); });
        add({"target.swell", "Try the swell", "Open a bundled wave that moves", "target", ""}, "Target", false,
            [this] { studio_.project.openTarget(resourceFile("targets/swell.glb")); });
        remove_ = add({"target.remove", "Remove", "Take the target away", "close", "Ctrl+Shift+T"}, "Target", false,
                      [this] { studio_.project.removeTarget(); });
        fit_ = add({"target.fit", "Fit", "As large as the device can show, in its middle", "fit", "Ctrl+Shift+F"},
                   "Target", false, [this] { studio_.project.fit(); });
        autoPlace_ = add({"target.autoPlace", "Auto-place", "Search the orientation, size and place that match best",
                          "auto-place", "Ctrl+Shift+A"},
                         "Target", false, [this] { studio_.project.autoPlace(); });
        spin_ = add({"target.spin", "Spin", "Turn the target slowly about its upright axis", "spin", "Ctrl+Shift+G"},
                    "Target", true, [this] {
                        studio_.document.change("Spin the target", [](StudioState& state) {
                            state.playback.spin = state.playback.spin == 0.0 ? kSpin : 0.0;
                        });
                    });
        play_ = add({"target.play", "Play", "Play or stop the target's animation", "play", "Ctrl+Space"}, "Target",
                    false, [this] {
                        studio_.document.change("Play or stop the animation", [](StudioState& state) {
                            state.playback.playing = !state.playback.playing;
                        });
                    });
    }

    void addRig() {
        rest_ = add({"rig.rest", "Rest", "Bring all actuators to rest", "rest", "Ctrl+0"}, "Actuators", false,
                    [this] { hand_.moveAll("Bring to rest", {}); });
        random_ = add({"rig.random", "Random", "Bring every actuator to a random level", "random", "Ctrl+R"},
                      "Actuators", false, [this] { moveAtRandom(); });
        dance_ = add({"rig.dance", "Dance", "Smooth random moves until you stop them", "dance", "Ctrl+D"}, "Actuators",
                     true, [this] { studio_.loop.setDancing(!studio_.loop.dancing()); });
    }

    void addMatch() {
        live_ = add({"match.live", "Match live", "The device follows the target while it moves", "live", "Ctrl+L"},
                    "Target", true, [this] { toggleLive(); });
        const auto choose = [this](MatchMethod method) {
            return [this, method] {
                studio_.document.change("Change the matching",
                                        [method](StudioState& state) { state.matching.method = method; });
            };
        };
        refined_ = add({"match.refined", "Refined", "Voting first, then all actuators together improve the fit", "",
                        "Ctrl+Shift+R"},
                       "Target", true, choose(MatchMethod::refined));
        voting_ =
            add({"match.voting", "Voting", "Each actuator decides alone by the field (Eq. 1)", "", "Ctrl+Shift+V"},
                "Target", true, choose(MatchMethod::voting));
        auto* methods = new QActionGroup(this);
        methods->addAction(refined_);
        methods->addAction(voting_);
    }

    /// Without blocking: the loop goes on and STOP stays in reach.
    void openTarget() {
        QWidget* window = parent_();
        if (auto* open = window ? window->findChild<QFileDialog*>("dialog.target") : nullptr) return open->raise();
        auto* dialog = new QFileDialog(window, "Open target", studio_.settings.value(kTargetFolder).toString());
        dialog->setObjectName("dialog.target");
        dialog->setOption(QFileDialog::DontUseNativeDialog);
        dialog->setAttribute(Qt::WA_DeleteOnClose);
        dialog->setFileMode(QFileDialog::ExistingFile);
        dialog->setNameFilters({"3D models (*.obj *.stl *.ply *.off *.glb *.gltf)", "All files (*)"});
        connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& file) {
            studio_.settings.setValue(kTargetFolder, QFileInfo(file).absolutePath());
            studio_.project.openTarget(std::filesystem::path(file.toStdU16String()));
        });
        addBundledShelf(*dialog, "Targets that come with Lumorph", bundledTargets(),
                        [this](const std::filesystem::path& file) { studio_.project.openTarget(file); });
        dialog->open();
    }

    void moveAtRandom() {
        const auto& rig = studio_.document.state().rig.rig;
        if (!rig) return;
        const auto& field = studio_.document.state().field.field;
        std::vector<double> strokes;
        for (const Actuator& actuator : rig->actuators()) {
            const int levels = std::max(field ? field->field.levels : actuator.levels, 2);
            strokes.push_back(QRandomGenerator::global()->bounded(levels) / static_cast<double>(levels - 1));
        }
        hand_.moveAll("Random levels", std::move(strokes));
    }

    /// Back to the target, or off it with the actuators staying where they are.
    void toggleLive() {
        studio_.driver.choose(studio_.driver.driver() == Driver::target ? Driver::hand : Driver::target);
        follow(); // also where that was not to be had
    }

    void follow() {
        const StudioState& state = studio_.document.state();
        const bool target = static_cast<bool>(state.target.target);
        const bool field = static_cast<bool>(state.field.field);
        const bool rig = static_cast<bool>(state.rig.rig);
        for (QAction* action : {remove_, spin_}) action->setEnabled(target);
        const bool placed = studio_.project.autoPlaced();
        fit_->setEnabled(target && field);
        autoPlace_->setEnabled(target && field && !placed);
        autoPlace_->setToolTip(placed ? "The target stands where auto-place put it; it would change nothing"
                                      : "Search the orientation, size and place that match best (Ctrl+Shift+A)");
        for (QAction* action : {rest_, random_, dance_}) action->setEnabled(rig);
        play_->setEnabled(target && state.target.target->duration > 0.0);
        play_->setText(state.playback.playing ? "Pause" : "Play");
        play_->setIcon(icon(state.playback.playing ? "pause" : "play"));
        spin_->setChecked(state.playback.spin != 0.0);
        dance_->setChecked(studio_.loop.dancing());
        live_->setChecked(studio_.driver.driver() == Driver::target);
        refined_->setChecked(state.matching.method == MatchMethod::refined);
        voting_->setChecked(state.matching.method == MatchMethod::voting);
    }

    Studio& studio_;
    std::function<QWidget*()> parent_;
    HandControl hand_{studio_.document, studio_.loop};
    QAction *remove_ = nullptr, *fit_ = nullptr, *autoPlace_ = nullptr, *spin_ = nullptr, *play_ = nullptr;
    QAction *rest_ = nullptr, *random_ = nullptr, *dance_ = nullptr;
    QAction *live_ = nullptr, *refined_ = nullptr, *voting_ = nullptr;
};

} // namespace

void addFieldCommands(Studio& studio, std::function<QWidget*()> parent) {
    new FieldCommands(studio, std::move(parent));
}

} // namespace lumorph::studio
