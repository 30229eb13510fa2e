#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <QDateTime>
#include <QObject>
#include <QString>

#include "app/applications/demo.h"
#include "app/studio/base/jobs.h"
#include "app/studio/base/notices.h"
#include "app/studio/document/kept_work.h"
#include "app/studio/document/project_io.h"
#include "app/studio/document/studio_document.h"
#include "core/loop/show_program.h"
#include "core/mdf/auto_place.h"
#include "core/mdf/builder.h"

namespace lumorph::studio {

/// For whom a demonstration is opened. Visitors get its program. So do hosts, but of one with steps, of which they
/// choose one by one and change what they see.
enum class Audience { host, visitors };

/// Opens, builds, saves and keeps: whatever turns files into document and back. Each takes its time as a job and tells
/// failures as notices with a remedy; the document changes only when all went well, by one step of undo.
class ProjectService : public QObject {
    Q_OBJECT
public:
    ProjectService(StudioDocument& document, Jobs& jobs, Notices& notices, QObject* parent = nullptr);

    /// Opens a file by what it is: a project, a field, a rig (a glTF with actuators, a folder), a target or a
    /// recording. For files dropped on the window and the command line.
    void open(const std::filesystem::path& file);
    void openProject(const std::filesystem::path& file);
    /// Opens a rig, and the field that lies beside it or was built for it last; else builds one.
    void openRig(const std::filesystem::path& path);
    /// Opens a rig that was made here, "flower" for example; it has no file until the project or the rig is saved.
    void takeRig(const std::shared_ptr<const Rig>& rig, const QString& name);
    /// A field of another rig is refused; the notice offers to open the field's own rig.
    void openField(const std::filesystem::path& file);
    /// Opens a target and places it: as large as fits the frame (`fitPlacement`).
    void openTarget(const std::filesystem::path& file);
    /// Whether a closed target that stands still is then moved where it matches best, by a second step of undo. It
    /// shows at once where it fits; whoever moves it or takes it back meanwhile is not interfered with. Off at first.
    void setPlacesNewTargets(bool places);
    void removeTarget();
    void buildField(const BuildOptions& options);
    void fit();                  ///< the largest size that fits, standing on the device
    void autoPlace();            ///< searches orientation, size and place
    void setRelief(bool relief); ///< the target shown as a relief, or as it is
    /// The different places that were found last for target and field as they are, the best first.
    [[nodiscard]] std::span<const PlacementCandidate> places() const;
    void choosePlace(std::size_t index);
    [[nodiscard]] bool autoPlaced() const; ///< it just did so: again would change nothing

    /// What is open, as it would be saved now.
    [[nodiscard]] ProjectSource project() const;

    /// Names another file where the scene names `asset`, by one step of undo.
    void relink(const std::string& asset, const std::filesystem::path& file);

    void newProject(); ///< the bundled tablet, no target
    /// A demonstration of app/applications by its name, told what its options say; without a name the first.
    void openDemo(const std::string& name = {}, Audience audience = Audience::host, const DemoTold& told = {});
    /// Makes a program by a seed, in a job's thread; what it throws is told.
    using MakeProgram = std::function<std::unique_ptr<ShowProgram>(std::uint64_t seed)>;
    /// A demonstration with another program than its own, of which nothing is kept.
    void openDemo(const std::string& name, MakeProgram make);
    /// The demonstration that is open, as long as nothing else is opened; null: none.
    [[nodiscard]] const Demo* demo() const noexcept;
    /// The program that shows is over; the demonstration stays open.
    void endProgram();
    /// Saves to the project's file; it is on disk when this returns, or the document is still modified and a notice
    /// says why. False when it has no file; ask for one and use saveAs.
    bool save();
    void saveAs(const std::filesystem::path& file);

    /// Goes on where the last session ended; the demo when there was none. `onReady` runs when it is there or failed.
    void restoreSession(std::function<void()> onReady = {});
    /// Keeps the session now; blocks until it is on disk. Called at the end; while running it is kept half a second
    /// after each change at the latest.
    void keepSession();

    /// Edited work that something else replaced before it was saved: kept on disk, through any number of starts, until
    /// it is brought back or thrown away. The newest first.
    [[nodiscard]] std::vector<KeptWork> keptWork() const;
    /// Opens it again, as it was and unsaved; what is open and edited is kept in turn.
    void bringBack(const std::string& id);
    /// Throws it away, which can be undone for a day.
    void setThrown(const std::string& id, bool thrown);

    /// False where another studio of this user runs: this one then keeps its session in a folder of its own.
    [[nodiscard]] bool keepsSession() const;
    /// Since when the other studio runs; empty where there is none, or it does not say.
    [[nodiscard]] std::optional<QDateTime> otherSince() const;
    /// Where sessions are kept; for tests.
    static std::filesystem::path sessionFolder();

signals:
    void placesChanged();
    void keptWorkChanged();
    void tookOver();                  ///< the other studio has ended; the session is kept where its was
    void opened(const QString& path); ///< for the list of recent files
    void saved(const QString& path);
    /// A project was opened, which holds a copy of the installation that it was made in. The document's is the room's.
    void openedElsewhere(const QString& path, std::shared_ptr<const lumorph::Installation> installation);
    /// Something else is open now, and with it the application that answers what happens; null: none does.
    /// What it wants kept belongs into `keepsake`; empty: that of none is kept.
    void programOpened(std::shared_ptr<lumorph::ShowProgram> program, const std::filesystem::path& keepsake);
    /// A demonstration of this name could not be opened, and a notice says why. What was open still is; of a session
    /// that is all but its application.
    void demoFailed(const QString& name, const lumorph::studio::Notice& why);
    /// A recording was to be opened, which is no part of the document.
    void recordingChosen(const QString& path);
    /// The remedy of a notice: ask for another file of this place ("target", "rig", "field", "project"; "viewport" for
    /// any kind) and open it.
    void chooseFile(const QString& place);
    /// The remedy of a notice: ask for another file, and `relink` this asset of the scene.
    void chooseAsset(const QString& asset);
    /// The remedy of a notice: ask where to save, and `saveAs`.
    void saveElsewhere();

private:
    struct Data;
    std::unique_ptr<Data> data_;

public:
    ~ProjectService() override;
};

} // namespace lumorph::studio
