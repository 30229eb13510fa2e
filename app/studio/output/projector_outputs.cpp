#include "app/studio/output/projector_outputs.h"

#include <algorithm>

#include <QApplication>
#include <QGuiApplication>

#include "app/studio/document/scene_edit.h"
#include "app/studio/rendering/show_frames.h"

namespace lumorph::studio {
namespace {

constexpr auto kPlace = "output";

QScreen* screenNamed(const QString& name) {
    const auto screens = QGuiApplication::screens();
    const auto found = std::find_if(screens.begin(), screens.end(), [&](QScreen* one) { return one->name() == name; });
    return found == screens.end() ? nullptr : *found;
}

/// Whether a window of the studio that is no output stands on a screen.
bool showsStudio(const QScreen* screen) {
    const auto windows = QApplication::topLevelWidgets();
    return std::any_of(windows.begin(), windows.end(), [&](const QWidget* window) {
        return window->isVisible() && window->windowType() == Qt::Window && window->screen() == screen &&
               qobject_cast<const ProjectorWindow*>(window) == nullptr;
    });
}

QString titleOf(std::size_t projector) { return ProjectorOutputs::tr("Projector %1").arg(projector + 1); }

QSize sizeOf(const InstalledProjector& projector) { return {projector.camera.size.x, projector.camera.size.y}; }

} // namespace

ProjectorOutputs::ProjectorOutputs(StudioDocument& document, ShowFeed& feed, Commands& commands, Notices& notices,
                                   QObject* parent)
    : QObject(parent), document_(document), feed_(feed), commands_(commands), notices_(notices) {
    addCommands();
    connect(&document_, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::installation) onInstallationChanged();
    });
    connect(qGuiApp, &QGuiApplication::screenAdded, this, [this] { addScreenCommands(); });
    connect(qGuiApp, &QGuiApplication::screenRemoved, this, [this](QScreen* screen) { screenGone(screen->name()); });
    onInstallationChanged();
}

ProjectorOutputs::~ProjectorOutputs() {
    // No window may outlive the feed it asks for pictures.
    for (const QPointer<ProjectorWindow>& window : closing_) delete window;
}

std::size_t ProjectorOutputs::count() const {
    const auto& installation = document_.state().installation;
    return installation ? installation->projectors.size() : 0;
}

QAction* ProjectorOutputs::add(const QString& id, const QString& text, std::function<void()> run, bool checkable) {
    Commands::Options options;
    options.icon = "projector";
    options.checkable = checkable;
    return commands_.add(id, text, options, std::move(run));
}

void ProjectorOutputs::addCommands() {
    add("output.identify", tr("Identify projectors"), [this] { identify(); });
    add("output.close", tr("Close all projector outputs"), [this] { closeAll(); });
    QAction* scaled = add("output.scale", tr("Scale projector pictures to their windows"), {}, true);
    connect(scaled, &QAction::toggled, this, &ProjectorOutputs::setScaled);
    for (const TestPattern pattern : kTestPatterns)
        add(QString("output.pattern%1").arg(static_cast<int>(pattern)), tr("Projectors show: %1").arg(nameOf(pattern)),
            [this, pattern] { setPattern(pattern); });
}

/// A command for each projector and screen that has been there; it sleeps while one of them is not.
void ProjectorOutputs::addScreenCommands() {
    for (std::size_t projector = 0; projector < count(); ++projector) {
        const QString id = QString("output.projector%1.").arg(projector + 1);
        if (!commands_.find(id + "window"))
            add(id + "window", tr("%1 in a window").arg(titleOf(projector)),
                [this, projector] { showInWindow(projector); });
        for (const QScreen* screen : QGuiApplication::screens())
            if (const QString name = screen->name(); !commands_.find(id + "screen." + name))
                add(id + "screen." + name, tr("%1, full screen on %2").arg(titleOf(projector), name),
                    [this, projector, name] { showOnScreen(projector, name); });
    }
    for (const Commands::Entry& entry : commands_.all()) {
        const QStringList parts = entry.action->objectName().split('.');
        if (parts.size() < 3 || !parts[1].startsWith("projector") || parts[0] != "output") continue;
        const bool there = parts[1].mid(9).toUInt() <= count();
        const QString screen = parts.size() > 3 ? parts.mid(3).join('.') : QString();
        entry.action->setEnabled(there && (screen.isEmpty() || screenNamed(screen) != nullptr));
    }
}

void ProjectorOutputs::onInstallationChanged() {
    addScreenCommands();
    for (auto& [number, output] : outputs_) {
        const auto& projectors = document_.state().installation->projectors;
        if (number < projectors.size())
            output.window->setProjector(titleOf(number), sizeOf(projectors[number]));
        else
            output.window->setProjector(titleOf(number), {});
    }
}

ProjectorOutputs::Output& ProjectorOutputs::open(std::size_t projector) {
    Output& output = outputs_[projector];
    if (output.window) return output;
    output.window = std::make_unique<ProjectorWindow>(feed_, commands_, projector);
    output.window->setPattern(pattern_);
    output.window->setScaled(scaled_);
    output.window->setProjector(titleOf(projector), sizeOf(document_.state().installation->projectors[projector]));
    connect(output.window.get(), &ProjectorWindow::closed, this, [this, projector] { close(projector); });
    connect(output.window.get(), &ProjectorWindow::covered, this, [this, projector] { heedSize(projector); });
    connect(output.window.get(), &ProjectorWindow::leftScreen, this, [this, projector] {
        outputs_[projector].screen.clear();
        notices_.dismiss(kPlace, titleOf(projector));
        emit changed();
    });
    return output;
}

void ProjectorOutputs::showInWindow(std::size_t projector) {
    if (projector >= count()) return;
    ProjectorWindow* known = outputs_[projector].window.get();
    Output& output = open(projector);
    if (!known) { // in the lower right corner: what the studio says next stands at the upper left
        const QRect room = output.window->screen()->availableGeometry();
        output.window->move(room.right() - output.window->width(), room.bottom() - output.window->height());
    }
    output.window->isFullScreen() ? output.window->leaveScreen() : output.window->show();
    output.window->raise();
    emit changed();
}

void ProjectorOutputs::showOnScreen(std::size_t projector, const QString& screen) {
    const QScreen* wanted = screenNamed(screen);
    if (projector >= count() || wanted == nullptr) return;
    if (showsStudio(wanted) && !allowed_.contains(screen))
        ask(projector, screen);
    else
        cover(projector, screen);
}

void ProjectorOutputs::useScreen(std::size_t projector, const QString& screen) {
    const QScreen* wanted = screenNamed(screen);
    if (projector >= count() || wanted == nullptr) return;
    const QSize pixels = pixelsOf(*wanted);
    const InstalledProjector& known = document_.state().installation->projectors[projector];
    if (known.lens.way != Origin::Way::measured && sizeOf(known) != pixels)
        editInstallation(document_, tr("%1 has the pixels of its screen").arg(titleOf(projector)),
                         [&](Installation& room) {
                             Origin& lens = room.projectors[projector].lens;
                             if (lens.way != Origin::Way::entered) // a lens that the user entered stays so
                                 lens = {Origin::Way::assumed, "with the pixels of its screen", utcDate()};
                             CalibratedCamera& camera = room.projectors[projector].camera;
                             const glm::dvec2 focal = camera.focal * static_cast<double>(pixels.width()) /
                                                      static_cast<double>(camera.size.x);
                             camera = resized(camera, {pixels.width(), pixels.height()});
                             camera.focal = focal; // a screen of another shape has no other pixels
                         });
    showOnScreen(projector, screen);
}

QString ProjectorOutputs::screenOf(std::size_t projector) const {
    const auto found = outputs_.find(projector);
    return found == outputs_.end() ? QString() : found->second.screen;
}

QString ProjectorOutputs::freeScreen() const {
    for (const QScreen* screen : QGuiApplication::screens())
        if (!showsStudio(screen) &&
            std::ranges::none_of(outputs_, [&](const auto& one) { return one.second.screen == screen->name(); }))
            return screen->name();
    return {};
}

QSize ProjectorOutputs::pixelsOf(const QScreen& screen) {
    const QSizeF pixels = screen.devicePixelRatio() * QSizeF(screen.size());
    return {qRound(pixels.width()), qRound(pixels.height())};
}

void ProjectorOutputs::ask(std::size_t projector, const QString& screen) {
    Notice notice;
    notice.level = Notice::Level::info;
    notice.subject = titleOf(projector);
    notice.why = tr("The studio itself is on the screen %1 and would be covered.").arg(screen);
    notice.remedy = tr("Esc brings it back.");
    notice.actions.push_back({tr("Cover it"), [this, projector, screen] {
                                  allowed_.insert(screen);
                                  cover(projector, screen);
                              }});
    notice.actions.push_back({tr("Use a window"), [this, projector] { showInWindow(projector); }});
    notices_.post(kPlace, std::move(notice));
}

void ProjectorOutputs::cover(std::size_t projector, const QString& screen) {
    QScreen* wanted = screenNamed(screen);
    if (projector >= count() || wanted == nullptr) return;
    Output& output = open(projector);
    output.screen = screen;
    notices_.dismiss(kPlace, titleOf(projector));
    output.window->coverScreen(wanted);
    emit changed();
}

/// Said in the studio, not in the picture that is projected.
void ProjectorOutputs::heedSize(std::size_t projector) {
    const auto found = outputs_.find(projector);
    if (found == outputs_.end() || projector >= count()) return;
    const QSize there = found->second.window->pixels();
    const QSize wanted = sizeOf(document_.state().installation->projectors[projector]);
    const QString subject = tr("Size of %1").arg(titleOf(projector));
    // At some desktop scales a screen is counted a pixel larger than it is; a smaller one would lose its last row.
    const QSize more = there - wanted;
    const auto fits = [](int pixels) { return pixels == 0 || pixels == 1; };
    if (fits(more.width()) && fits(more.height())) return notices_.dismiss(kPlace, subject);
    Notice notice;
    notice.level = Notice::Level::warning;
    notice.subject = subject;
    notice.why = tr("The screen has %1 × %2 pixels, the projector %3 × %4; the picture is centred, pixel by pixel.")
                     .arg(there.width())
                     .arg(there.height())
                     .arg(wanted.width())
                     .arg(wanted.height());
    notice.remedy = tr("Set the screen to the projector's own resolution, and the desktop to a scale that fits it, "
                       "such as 100 %.");
    notices_.post(kPlace, std::move(notice));
}

void ProjectorOutputs::screenGone(const QString& name) {
    for (auto& [projector, output] : outputs_) {
        if (output.screen != name) continue;
        output.window->leaveScreen();
        output.screen.clear();
        if (QScreen* primary = QGuiApplication::primaryScreen())
            output.window->move(primary->availableGeometry().center() / 2);
        askBack(projector, name);
    }
    addScreenCommands();
    emit changed();
}

void ProjectorOutputs::askBack(std::size_t projector, const QString& screen) {
    Notice notice;
    notice.level = Notice::Level::warning;
    notice.subject = titleOf(projector);
    notice.why = tr("Screen %1 is gone; the picture is in a window now.").arg(screen);
    notice.remedy = tr("Plug the projector in again, then go back.");
    notice.actions.push_back({tr("Back to full screen"), [this, projector, screen] {
                                  if (screenNamed(screen) != nullptr)
                                      showOnScreen(projector, screen);
                                  else
                                      askBack(projector, screen);
                              }});
    notices_.post(kPlace, std::move(notice));
}

void ProjectorOutputs::close(std::size_t projector) {
    const auto found = outputs_.find(projector);
    if (found == outputs_.end()) return;
    notices_.dismiss(kPlace, titleOf(projector));
    notices_.dismiss(kPlace, tr("Size of %1").arg(titleOf(projector)));
    // It may be the one that tells of its end.
    ProjectorWindow* const window = found->second.window.release();
    outputs_.erase(found);
    std::erase(closing_, nullptr);
    closing_.emplace_back(window);
    window->hide();
    window->deleteLater();
    emit changed();
}

void ProjectorOutputs::closeAll() {
    while (!outputs_.empty()) close(outputs_.begin()->first);
}

void ProjectorOutputs::identify() {
    for (auto& [number, output] : outputs_) output.window->identify();
}

void ProjectorOutputs::setPattern(TestPattern pattern) {
    pattern_ = pattern;
    for (auto& [number, output] : outputs_) output.window->setPattern(pattern);
    emit changed();
}

void ProjectorOutputs::setScaled(bool on) {
    scaled_ = on;
    for (auto& [number, output] : outputs_) output.window->setScaled(on);
}

ProjectorWindow* ProjectorOutputs::window(std::size_t projector) const {
    const auto found = outputs_.find(projector);
    return found == outputs_.end() ? nullptr : found->second.window.get();
}

void ProjectorOutputs::fillMenu(QMenu& menu) {
    menu.clear();
    for (const Commands::Entry& entry : commands_.all()) {
        const QString id = entry.action->objectName();
        if (id.startsWith("output.projector") && entry.action->isEnabled()) menu.addAction(entry.action);
    }
    if (menu.isEmpty()) menu.addAction(tr("The scene has no projector"))->setEnabled(false);
    menu.addSeparator();
    QMenu* patterns = menu.addMenu(tr("Test pattern"));
    for (const TestPattern pattern : kTestPatterns) {
        QAction* choice = patterns->addAction(nameOf(pattern), this, [this, pattern] { setPattern(pattern); });
        choice->setCheckable(true);
        choice->setChecked(pattern == pattern_);
    }
    for (const char* id : {"output.identify", "output.scale", "output.close"}) menu.addAction(commands_.find(id));
}

} // namespace lumorph::studio
