#include "app/workspaces/field/field_exports.h"

#include <chrono>
#include <future>

#include <QApplication>
#include <QDesktopServices>
#include <QFileInfo>
#include <QPointer>
#include <QUrl>

#include "app/workspaces/common/export_dialogs.h"
#include "app/workspaces/common/field_output.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"

namespace lumorph::studio {
namespace {

const QString kExportPlace = QStringLiteral("export");

using Frame = std::shared_ptr<const MatchFrame>;
using Path = std::filesystem::path;

Path pathOf(const QString& text) { return Path(text.toStdString()); }

void tellWritten(Studio& studio, const Path& path) {
    const QString text = QString::fromStdString(path.string());
    const QFileInfo file(text);
    Notice notice;
    notice.level = Notice::Level::info;
    notice.subject = file.fileName();
    notice.why = QObject::tr("written to %1").arg(file.absolutePath());
    const QString folder = file.isDir() ? file.absoluteFilePath() : file.absolutePath();
    notice.actions.push_back(
        {QObject::tr("Open its folder"), [folder] { QDesktopServices::openUrl(QUrl::fromLocalFile(folder)); }});
    studio.notices.post(kExportPlace, std::move(notice));
}

void tellFailed(Studio& studio, const std::exception& error, std::function<void()> again) {
    Notice notice = noticeOf(error);
    notice.actions.push_back({QObject::tr("Choose another place"), std::move(again)});
    studio.notices.post(kExportPlace, std::move(notice));
}

/// All exports of one workspace; lives as long as the commands it added.
class FieldExports : public QObject {
public:
    explicit FieldExports(ExportContext context) : QObject(&context.studio.commands), context_(std::move(context)) {}

    void addCommands();

private:
    void add(const QString& id, const QString& text, const QString& icon, std::function<void()> run,
             std::function<bool()> possible);
    void showPossible();
    void exportShape();
    void exportField();
    void exportGrids();
    void exportTarget();
    void exportTable();
    void exportPicture();
    void exportTurntable();

    /// Runs `write` as a job; it gives what was written. `again` is offered when that failed.
    void run(const QString& title, const QString& again, std::function<Path(const Progress&)> write);
    [[nodiscard]] PreviewPainter preview() const;
    [[nodiscard]] QString suggestedName(const QString& ending = {}) const;
    /// What dialogs belong to.
    [[nodiscard]] QWidget* window() const { return context_.parent ? context_.parent : QApplication::activeWindow(); }
    [[nodiscard]] Frame frame() const { return studio().loop.frame(); }
    [[nodiscard]] Studio& studio() const { return context_.studio; }

    struct Offer {
        QAction* action;
        std::function<bool()> possible;
    };
    ExportContext context_;
    std::vector<Offer> offers_;
    PictureStyle picture_{QSize(), Theme::dark, true, true};
    Turntable turntable_;
};

void FieldExports::addCommands() {
    const auto haveFrame = [this] { return frame() != nullptr; };
    const auto haveField = [this] { return frame() && frame()->field; };
    const auto haveBoth = [this] { return frame() && frame()->field && frame()->target; };
    add(
        "export.mesh", tr("Export the shape..."), "device", [this] { exportShape(); }, haveFrame);
    add(
        "export.picture", tr("Export a picture..."), "picture", [this] { exportPicture(); }, haveFrame);
    add(
        "export.turntable", tr("Export a turntable video..."), "video", [this] { exportTurntable(); }, haveFrame);
    add(
        "export.csv", tr("Export the match as a table..."), "file", [this] { exportTable(); }, haveField);
    add(
        "export.target", tr("Export the target's voxels..."), "target", [this] { exportTarget(); }, haveBoth);
    add(
        "export.field", tr("Export the field..."), "field", [this] { exportField(); }, haveField);
    add(
        "export.grids", tr("Export the field as NRRD grids..."), "voxels", [this] { exportGrids(); }, haveField);
    connect(&studio().loop, &StudioLoop::framed, this, [this] { showPossible(); });
    connect(&studio().document, &StudioDocument::changed, this, [this] { showPossible(); });
    showPossible();
}

void FieldExports::add(const QString& id, const QString& text, const QString& icon, std::function<void()> run,
                       std::function<bool()> possible) {
    Commands::Options options;
    options.icon = icon;
    options.menu = QStringLiteral("File");
    options.workspace = QStringLiteral("field");
    offers_.push_back({studio().commands.add(id, text, options, std::move(run)), std::move(possible)});
}

void FieldExports::showPossible() {
    for (const Offer& offer : offers_) offer.action->setEnabled(offer.possible());
}

QString FieldExports::suggestedName(const QString& ending) const {
    const QString project = studio().document.name();
    const Frame now = frame();
    const QString rig = now ? QString::fromStdString(now->rig->name()) : QString();
    QString name = studio().document.file().empty() && !rig.isEmpty() ? rig : QFileInfo(project).completeBaseName();
    name.replace('/', '-');
    return ending.isEmpty() ? name : name + " " + ending;
}

void FieldExports::run(const QString& title, const QString& again, std::function<Path(const Progress&)> write) {
    runExport(
        studio(), title,
        [self = QPointer<FieldExports>(this), again] {
            if (!self) return;
            if (QAction* action = self->studio().commands.find(again)) action->trigger();
        },
        std::move(write));
}

void FieldExports::exportShape() {
    askShape(window(), [this](bool estimated) {
        askFile(window(), studio().settings, "export.mesh", tr("Export the shape"),
                suggestedName(estimated ? tr("shape") : tr("wanted shape")),
                {{tr("Wavefront OBJ"), "obj"}, {tr("Binary glTF"), "glb"}, {tr("STL"), "stl"}},
                [this, estimated, now = frame()](const QString& file) {
                    run(tr("Writing the shape"), "export.mesh", [now, estimated, path = pathOf(file)](const Progress&) {
                        writeShape(*now, estimated, path);
                        return path;
                    });
                });
    });
}

void FieldExports::exportField() {
    askFile(window(), studio().settings, "export.field", tr("Export the field"), suggestedName(),
            {{tr("Mechanical distance field"), "mdf"}}, [this, field = frame()->field](const QString& file) {
                run(tr("Writing the field"), "export.field", [field, path = pathOf(file)](const Progress&) {
                    writeFieldFile(field->field, path);
                    return path;
                });
            });
}

void FieldExports::exportGrids() {
    askFolder(window(), studio().settings, "export.grids", tr("Where to put the folder of NRRD grids"),
              [this, field = frame()->field](const QString& folder) {
                  run(tr("Writing the grids"), "export.grids",
                      [field, path = pathOf(folder)](const Progress& progress) {
                          return writeFieldGrids(field->field, path, progress);
                      });
              });
}

void FieldExports::exportTarget() {
    askFile(window(), studio().settings, "export.target", tr("Export the target's voxels"), suggestedName(tr("target")),
            {{tr("NRRD grid"), "nrrd"}}, [this, now = frame()](const QString& file) {
                run(tr("Writing the target's voxels"), "export.target", [now, path = pathOf(file)](const Progress&) {
                    writeTargetVoxels(*now, path);
                    return path;
                });
            });
}

void FieldExports::exportTable() {
    const Frame now = frame();
    const bool clip = now->target && now->target->model && now->target->animation >= 0;
    askFile(window(), studio().settings, "export.csv",
            clip ? tr("Export the match of the whole animation") : tr("Export the match"),
            suggestedName(clip ? tr("animation") : tr("match")), {{tr("Table"), "csv"}},
            [this, now, clip, state = studio().document.state()](const QString& file) {
                run(clip ? tr("Matching the whole animation") : tr("Writing the match"), "export.csv",
                    [now, clip, state, path = pathOf(file)](const Progress& progress) {
                        const std::string table = clip ? tableOfClip(*now, state.placement, state.matching.method,
                                                                     state.matching.budget, progress)
                                                       : tableOfNow(*now);
                        progress.throwIfCancelled();
                        writeFileAtomically(path, std::as_bytes(std::span(table)));
                        return path;
                    });
            });
}

PreviewPainter FieldExports::preview() const {
    return [view = context_.view(), renderer = QPointer<RenderThread>(&studio().renderer)](
               const PictureStyle& style, std::function<void(QImage)> done) {
        if (!renderer || !view.scene) return;
        const FrameRequest request = pictureRequest(view.scene, view.camera, view.ratio, style);
        renderer->picture(request, [request, style, done = std::move(done)](QImage image, const QString&) {
            if (!image.isNull()) addGridLabel(image, request, style);
            done(std::move(image));
        });
    };
}

void FieldExports::exportPicture() {
    const ExportView view = context_.view();
    if (!view.scene) return;
    if (picture_.size.isEmpty()) picture_.theme = view.scene->theme;
    askPicture(window(), picture_, view.ratio, preview(), [this, view](const PictureStyle& style) {
        picture_ = style;
        askFile(window(), studio().settings, "export.picture", tr("Export a picture"), suggestedName(),
                {{tr("PNG picture"), "png"}}, [this, view, style](const QString& file) {
                    run(tr("Drawing the picture"), "export.picture",
                        [view, style, paint = painterOf(studio()), path = pathOf(file)](const Progress& progress) {
                            const FrameRequest request = pictureRequest(view.scene, view.camera, view.ratio, style);
                            progress.report(0.1, "drawing");
                            QImage picture = paint(request, progress);
                            addGridLabel(picture, request, style);
                            progress.report(0.7, "writing the file");
                            progress.throwIfCancelled();
                            writePng(imageOf(picture), path);
                            return path;
                        });
                });
    });
}

void FieldExports::exportTurntable() {
    const ExportView view = context_.view();
    if (!view.scene) return;
    turntable_.style.theme = view.scene->theme;
    askTurntable(window(), turntable_, preview(), [this, view](const Turntable& turntable) {
        turntable_ = turntable;
        askFile(window(), studio().settings, "export.turntable", tr("Export a turntable video"),
                suggestedName(tr("turntable")), {{tr("MP4 video"), "mp4"}},
                [this, view, turntable](const QString& file) {
                    run(tr("Drawing the turntable"), "export.turntable",
                        [view, turntable, paint = painterOf(studio()), path = pathOf(file)](const Progress& progress) {
                            writeTurntable(turntable, view.scene, view.camera, view.ratio, paint, path, progress);
                            return path;
                        });
                });
    });
}

} // namespace

Painter painterOf(Studio& studio) {
    struct Drawn {
        QImage image;
        QString why;
    };
    return [jobs = &studio.jobs, renderer = QPointer<RenderThread>(&studio.renderer)](const FrameRequest& request,
                                                                                      const Progress& progress) {
        auto promise = std::make_shared<std::promise<Drawn>>();
        std::future<Drawn> answer = promise->get_future();
        QMetaObject::invokeMethod(jobs, [renderer, request, promise = std::move(promise)] {
            if (renderer)
                renderer->picture(request, [promise](QImage image, QString why) {
                    promise->set_value({std::move(image), std::move(why)});
                });
        });
        while (answer.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) progress.throwIfCancelled();
        Drawn drawn;
        try {
            drawn = answer.get();
        } catch (const std::future_error&) {
            throw Cancelled();
        }
        if (drawn.image.isNull())
            throw DeviceError("picture", drawn.why.isEmpty() ? "it could not be drawn" : drawn.why.toStdString(),
                              "choose a smaller size");
        return drawn.image;
    };
}

void runExport(Studio& studio, const QString& title, std::function<void()> again,
               std::function<Path(const Progress&)> write) {
    studio.jobs.run<Path>(
        kExportPlace, title, std::move(write), [&studio](const Path& path) { tellWritten(studio, path); },
        [&studio, again = std::move(again)](const std::exception& error) { tellFailed(studio, error, again); });
}

void addFieldExports(const ExportContext& context) {
    // Owned by the commands, with which it ends.
    auto* exports = new FieldExports(context);
    exports->addCommands();
}

} // namespace lumorph::studio
