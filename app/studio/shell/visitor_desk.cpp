#include "app/studio/shell/visitor_desk.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include <QKeyEvent>

#include "app/applications/registry/demos.h"
#include "app/studio/shell/kiosk.h"
#include "app/studio/shell/program_inputs.h"

namespace lumorph::studio {
namespace {

constexpr int kBarMargin = 16;

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

const Demo* applicationAfter(const std::string& name) {
    std::vector<const Demo*> all;
    for (const Demo& demo : demos())
        if (demo.program) all.push_back(&demo);
    if (all.empty()) return nullptr;
    const auto found = std::ranges::find(all, name, [](const Demo* demo) { return demo->name; });
    if (found == all.end() || std::next(found) == all.end()) return all.front();
    return *std::next(found);
}

VisitorDesk::VisitorDesk(Studio& studio, QMainWindow& window, QWidget& stage, const Clock& clock)
    : QObject(&window), studio_(studio), window_(window), stage_(stage), watch_(studio.loop, clock, this),
      layer_(new VisitorLayer(studio, stage.parentWidget())), bar_(new VisitorBar(studio, stage.parentWidget())) {
    layer_->hide();
    bar_->hide();
    stage.installEventFilter(this);
    connect(&studio.project, &ProjectService::programOpened, this, &VisitorDesk::takeOpened);
    connect(&studio.loop, &StudioLoop::driverChanged, bar_, &VisitorBar::follow);
    connect(&watch_, &VisitorWatch::thereChanged, this, [this] { layer_->setPlayed(watch_.there()); });
    connect(&watch_, &VisitorWatch::ticked, this, &VisitorDesk::goOnWhereNobodyPlays);
    connect(bar_, &VisitorBar::cardsWanted, this, &VisitorDesk::showCards);
    connect(bar_, &VisitorBar::helpWanted, this, [this] { layer_->setHelp(!layer_->helpShown()); });
}

void VisitorDesk::setMode(Mode mode) {
    mode_ = mode;
    hideCards();
    watch_.beginAnew(watch_.there());
    follow();
    if (mode != Mode::studio) giveKeyboard();
}

bool VisitorDesk::offers() const { return studio_.project.demo() != nullptr; }

void VisitorDesk::takeOpened() {
    watch_.beginAnew(false);
    layer_->begin();
    follow();
    if (mode_ != Mode::studio) giveKeyboard();
}

void VisitorDesk::follow() {
    const bool visitors = mode_ != Mode::studio && offers();
    layer_->setForVisitors(visitors);
    bar_->follow();
    bar_->setVisible(visitors);
    arrange();
}

void VisitorDesk::arrange() {
    layer_->setGeometry(stage_.geometry());
    const QSize size = bar_->sizeHint();
    const QRect room = stage_.geometry().adjusted(kBarMargin, kBarMargin, -kBarMargin, -kBarMargin);
    bar_->setGeometry(QRect(QPoint(room.right() + 1 - size.width(), room.bottom() + 1 - size.height()), size));
    layer_->raise();
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
    layer_->setHelp(false);
    const auto whom = mode_ == Mode::kiosk ? ApplicationsPage::For::visitors : ApplicationsPage::For::host;
    cards_ = new ApplicationsPage(studio_, window_, whom);
    connect(cards_, &ApplicationsPage::chosen, this, [this](const Demo& demo) {
        hideCards();
        emit applicationWanted(demo);
    });
    connect(cards_, &ApplicationsPage::studioWanted, this, [this] {
        hideCards();
        emit studioWanted();
    });
    connect(cards_, &ApplicationsPage::backWanted, this, &VisitorDesk::hideCards);
    connect(cards_, &ApplicationsPage::tourWanted, this, [this] {
        hideCards();
        emit tourWanted();
    });
    cards_->open();
    cards_->setFocus(Qt::OtherFocusReason);
    watch_.beginAnew(watch_.there());
}

void VisitorDesk::hideCards() {
    if (!cards_) return;
    cards_->leave();
    cards_ = nullptr;
    if (mode_ != Mode::studio) giveKeyboard();
}

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
    return isHelpKey(key) || isProgramKey(key);
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
    if (studio_.loop.stopped() || studio_.document.modified() || !studio_.jobs.running().empty()) return;
    const std::string shown = studio_.project.demo()->name;
    const Demo* next = applicationAfter(shown);
    hideCards();
    if (next != nullptr && next->name != shown) emit applicationWanted(*next);
}

bool VisitorDesk::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::Resize || event->type() == QEvent::Move) arrange();
    return QObject::eventFilter(watched, event);
}

} // namespace lumorph::studio
