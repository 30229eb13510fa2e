#include "app/studio/shell/visitor_desk.h"

#include <algorithm>
#include <array>
#include <utility>

#include <QKeyEvent>
#include <QTimer>

#include "app/applications/registry/demos.h"
#include "app/studio/shell/kiosk.h"
#include "app/studio/shell/program_inputs.h"

namespace lumorph::studio {
namespace {

constexpr int kBarMargin = 16;
constexpr int kOpensAtOnce = 200;             ///< milliseconds
constexpr auto kPlace = "visitors";           ///< of notices
constexpr Microseconds kAsksAgain{2'000'000}; ///< for a file that may be back

bool isHelpKey(int key) { return key == Qt::Key_H || key == Qt::Key_Question || key == Qt::Key_F1; }

bool isPointing(QEvent::Type type) {
    constexpr std::array kTypes{QEvent::MouseButtonPress,
                                QEvent::MouseButtonRelease,
                                QEvent::MouseButtonDblClick,
                                QEvent::Wheel,
                                QEvent::TouchBegin,
                                QEvent::TouchUpdate,
                                QEvent::TouchEnd};
    return std::ranges::find(kTypes, type) != kTypes.end();
}

bool isKey(QEvent::Type type) {
    return type == QEvent::KeyPress || type == QEvent::KeyRelease || type == QEvent::ShortcutOverride;
}

} // namespace

VisitorDesk::VisitorDesk(Studio& studio, QMainWindow& window, QWidget& stage, const Clock& clock)
    : QObject(&window), studio_(studio), window_(window), stage_(stage), clock_(clock),
      turn_(
          demos(), [&studio](const Demo& demo) { return studio.settings.toldTo(demo.name); }, clock),
      watch_(studio.loop, clock, this), layer_(new VisitorLayer(studio, stage.parentWidget())),
      bar_(new VisitorBar(studio, stage.parentWidget())), rest_(new RestPage(studio.settings, stage.parentWidget())) {
    layer_->hide();
    bar_->hide();
    rest_->hide();
    stage.installEventFilter(this);
    connect(&studio.project, &ProjectService::programOpened, this, &VisitorDesk::takeOpened);
    connect(&studio.loop, &StudioLoop::driverChanged, this, &VisitorDesk::followBar);
    connect(&watch_, &VisitorWatch::thereChanged, this, [this] { layer_->setPlayed(watch_.there()); });
    connect(&watch_, &VisitorWatch::ticked, this, &VisitorDesk::goOnWhereNobodyPlays);
    connect(&watch_, &VisitorWatch::ticked, this, &VisitorDesk::askAgain);
    connect(&studio.project, &ProjectService::demoFailed, this, &VisitorDesk::takeFailure);
    connect(&studio.loop, &StudioLoop::failed, this, &VisitorDesk::takeEnd);
    for (const auto happened : {&Jobs::progressed, &Jobs::finished})
        connect(&studio.jobs, happened, this, &VisitorDesk::followOpening);
    connect(bar_, &VisitorBar::cardsWanted, this, &VisitorDesk::showCards);
    connect(bar_, &VisitorBar::helpWanted, this, [this] { layer_->setHelp(!layer_->helpShown()); });
}

void VisitorDesk::setMode(Mode mode) {
    mode_ = mode;
    setResting(false);
    hideCards();
    watch_.beginAnew(watch_.there());
    follow();
    if (mode != Mode::studio) giveKeyboard();
    if (mode == Mode::kiosk && broken_) goOn();
}

bool VisitorDesk::offers() const { return studio_.project.demo() != nullptr; }

void VisitorDesk::wantApplication(const Demo& demo) {
    opening_ = &demo;
    openingSince_.start();
    emit applicationWanted(demo);
    QTimer::singleShot(kOpensAtOnce + 1, this, &VisitorDesk::followOpening); // it may have nothing to report for long
}

/// What opens at once needs no veil.
void VisitorDesk::followOpening() {
    const auto jobs = studio_.jobs.running();
    const auto job = std::ranges::find(jobs, QString("project"), &Jobs::Status::place);
    const bool isOver = job == jobs.end() && openingSince_.isValid() && openingSince_.elapsed() > kOpensAtOnce;
    if (mode_ == Mode::studio || isOver) opening_ = nullptr; // cancelled, for example
    const bool wasShown = layer_->openingShown();
    if (opening_ == nullptr || job == jobs.end())
        layer_->endOpening();
    else if (openingSince_.elapsed() > kOpensAtOnce)
        layer_->setOpening(opening_->title, job->fraction);
    if (layer_->openingShown() != wasShown) arrange();
}

void VisitorDesk::takeOpened() {
    opening_ = nullptr;
    followOpening();
    chosen_ = broken_ = false;
    played_ = studio_.loop.program() != nullptr;
    setResting(false);
    if (const Demo* demo = studio_.project.demo(); demo != nullptr && played_) {
        turn_.shown(*demo);
        studio_.notices.dismiss(kPlace, QString::fromStdString(demo->title.english));
    }
    watch_.beginAnew(false);
    layer_->begin();
    follow();
    if (mode_ != Mode::studio) giveKeyboard();
}

void VisitorDesk::follow() {
    const bool visitors = mode_ != Mode::studio && offers();
    layer_->setForVisitors(visitors);
    bar_->setVisible(visitors);
    followBar();
}

/// With as many buttons as there are, it stays in its corner.
void VisitorDesk::followBar() {
    bar_->follow(!rest_->isHidden());
    arrange();
}

void VisitorDesk::setResting(bool rests) {
    rest_->setVisible(rests);
    followBar();
    emit coversChanged();
}

void VisitorDesk::arrange() {
    layer_->setGeometry(stage_.geometry());
    const QSize size = bar_->sizeHint();
    const QRect room = stage_.geometry().adjusted(kBarMargin, kBarMargin, -kBarMargin, -kBarMargin);
    bar_->setGeometry(QRect(QPoint(room.right() + 1 - size.width(), room.bottom() + 1 - size.height()), size));
    rest_->setGeometry(stage_.geometry());
    layer_->raise();
    rest_->raise();
    bar_->raise();
}

/// To the view in sight that takes an application's keys, where no sheet lies over it.
void VisitorDesk::giveKeyboard() {
    if (cards_ || otherSheetOpen()) return;
    for (QWidget* view : stage_.findChildren<QWidget*>())
        if (view->isVisible() && takesProgramInputs(*view)) return view->setFocus(Qt::MouseFocusReason); // no ring
}

void VisitorDesk::showCards() {
    if (cards_) return hideCards();
    if (rest_->isVisible()) return; // there are none to choose from
    layer_->setHelp(false);
    const auto whom = mode_ == Mode::kiosk ? ApplicationsPage::For::visitors : ApplicationsPage::For::host;
    cards_ = new ApplicationsPage(studio_, window_, whom, [this](const Demo& demo) { return !turn_.leavesOut(demo); });
    connect(cards_, &ApplicationsPage::chosen, this, [this](const Demo& demo) {
        hideCards();
        chosen_ = true;
        wantApplication(demo);
    });
    connect(cards_, &ApplicationsPage::studioWanted, this, [this] {
        hideCards();
        emit studioWanted();
    });
    connect(cards_, &ApplicationsPage::workWanted, this, [this](const std::string& id) {
        hideCards();
        emit studioWanted();
        studio_.project.bringBack(id);
    });
    connect(cards_, &ApplicationsPage::backWanted, this, &VisitorDesk::hideCards);
    connect(cards_, &ApplicationsPage::tourWanted, this, [this] {
        hideCards();
        emit tourWanted();
    });
    cards_->open();
    cards_->setFocus(Qt::OtherFocusReason);
    connect(cards_, &QObject::destroyed, this, &VisitorDesk::coversChanged); // whoever closed them
    emit coversChanged();
    watch_.beginAnew(watch_.there());
}

void VisitorDesk::hideCards() {
    if (!cards_) return;
    cards_->leave();
    cards_ = nullptr;
    emit coversChanged();
    if (mode_ != Mode::studio) giveKeyboard();
}

bool VisitorDesk::covers() const { return (cards_ && !cards_->isHidden()) || !rest_->isHidden(); }

bool VisitorDesk::otherSheetOpen() const {
    const auto sheets = window_.findChildren<Overlay*>(Qt::FindDirectChildrenOnly);
    return std::ranges::any_of(sheets, [this](const Overlay* sheet) { return sheet->isVisible() && sheet != cards_; });
}

void VisitorDesk::escape() {
    if (layer_->helpShown()) return layer_->setHelp(false);
    if (cards_) return hideCards();
    if (mode_ != Mode::studio && offers() && !otherSheetOpen()) showCards();
}

bool VisitorDesk::takeKey(const QObject& watched, const QKeyEvent& event) {
    if (!isHelpKey(event.key()) || !studio_.loop.program() || !watched.isWidgetType()) return false;
    if (cards_ || otherSheetOpen() || (event.modifiers() & ~(Qt::ShiftModifier | Qt::KeypadModifier))) return false;
    // In the studio F1 is the guide, and letters are the view's alone.
    if (mode_ == Mode::studio && (event.key() == Qt::Key_F1 || !takesProgramInputs(watched))) return false;
    if (event.type() == QEvent::KeyPress && !event.isAutoRepeat()) layer_->setHelp(!layer_->helpShown());
    return true;
}

bool VisitorDesk::mayHave(const QObject& watched, const QEvent& event) const {
    if (!offers() || otherSheetOpen()) return false;
    if ((cards_ && belongsTo(&watched, cards_)) || belongsTo(&watched, bar_)) return true;
    if (!studio_.loop.program()) return false;
    if (isPointing(event.type())) return takesProgramInputs(watched);
    if (!isKey(event.type())) return false;
    const int key = static_cast<const QKeyEvent&>(event).key();
    return isHelpKey(key) || isProgramKey(key) || isViewKey(key);
}

/// Whatever shows, and whoever does something with it, stays; so does what the host has changed.
void VisitorDesk::goOnWhereNobodyPlays() {
    // A sheet that went may have left the keyboard to nobody.
    if (mode_ != Mode::studio && studio_.loop.program() && (!window_.focusWidget() || window_.hasFocus()))
        giveKeyboard();
    const double minutes = studio_.settings.nextMinutes(mode_ == Mode::kiosk);
    const bool wanted = mode_ != Mode::studio && minutes > 0.0 && offers() && !otherSheetOpen();
    if (!wanted || watch_.there() || watch_.quiet() < Microseconds(static_cast<std::int64_t>(6e7 * minutes))) return;
    watch_.beginAnew(false);
    if (studio_.jobs.running().empty()) goOn();
}

/// To the next whose turn it is; what plays goes on where there is none.
void VisitorDesk::goOn() {
    const Demo* shown = studio_.project.demo();
    const Demo* next = turn_.after(shown != nullptr ? shown->name : std::string());
    const bool plays = studio_.loop.program() != nullptr;
    setResting(mode_ == Mode::kiosk && broken_ && (rest_->isVisible() || next == nullptr));
    askedLast_ = clock_.now();
    if (next == nullptr || (plays && next == shown)) return;
    if (studio_.loop.stopped() || studio_.document.modified()) return; // neither is an application's to end
    hideCards();
    chosen_ = false;
    wantApplication(*next);
}

/// Where nothing can be shown: a file may be back, or enough time may have passed.
void VisitorDesk::askAgain() {
    if (rest_->isVisible() && clock_.now() - askedLast_ > kAsksAgain && studio_.jobs.running().empty()) goOn();
}

/// Who has chosen it as a host reads the notice in the studio; a visitor chooses another. Else the next is tried.
void VisitorDesk::takeFailure(const QString& name, const Notice& why) {
    opening_ = nullptr;
    followOpening();
    const bool chosen = std::exchange(chosen_, false);
    if (mode_ == Mode::studio) return;
    if (mode_ == Mode::full && chosen) return emit studioWanted();
    const auto demo = std::ranges::find(demos(), name.toStdString(), &Demo::name);
    if (demo == demos().end()) return;
    leaveOut(*demo, why);
    const Demo* shown = studio_.project.demo();
    broken_ = broken_ || (!studio_.loop.program() && (shown == nullptr || shown == &*demo));
    if (!chosen) return QTimer::singleShot(0, this, &VisitorDesk::goOn);
    if (!cards_) showCards();
}

/// One that ends by an error would do so again.
void VisitorDesk::takeEnd(const QString& why) {
    const Demo* demo = studio_.project.demo();
    if (!std::exchange(played_, studio_.loop.program() != nullptr) || played_ || demo == nullptr) return;
    if (mode_ != Mode::kiosk) return;
    broken_ = true;
    leaveOut(*demo, {Notice::Level::error, "Show", why, QObject::tr("start it again"), {}});
    QTimer::singleShot(0, this, &VisitorDesk::goOn);
}

/// The host finds it when he comes.
void VisitorDesk::leaveOut(const Demo& demo, const Notice& why) {
    turn_.failed(demo);
    constexpr auto kMinutes = ApplicationTurn::kLeftOut.count() / 60'000'000;
    studio_.notices.post(kPlace, {Notice::Level::warning,
                                  QString::fromStdString(demo.title.english),
                                  QObject::tr("visitors do not see it for now: %1: %2").arg(why.subject, why.why),
                                  QObject::tr("%1; it is tried again after %2 minutes, or once its file is another")
                                      .arg(why.remedy)
                                      .arg(kMinutes),
                                  {}});
}

bool VisitorDesk::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::Resize || event->type() == QEvent::Move) arrange();
    return QObject::eventFilter(watched, event);
}

} // namespace lumorph::studio
