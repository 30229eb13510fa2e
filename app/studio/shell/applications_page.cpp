#include "app/studio/shell/applications_page.h"

#include <algorithm>

#include <QFocusEvent>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QPainterPath>
#include <QPointer>
#include <QPushButton>
#include <QVBoxLayout>

#include "app/applications/registry/demos.h"
#include "app/studio/look/icons.h"
#include "app/studio/look/palette.h"
#include "app/studio/shell/demo_options.h"
#include "app/studio/shell/escape_twice.h"
#include "app/studio/shell/kept_work_list.h"
#include "app/studio/shell/pictograms.h"
#include "core/base/error.h"
#include "core/base/resources.h"

namespace lumorph::studio {
namespace {

constexpr int kTop = 40; ///< of the window: its bar stays in reach
constexpr int kMargin = 32;
constexpr int kGap = 20;
constexpr int kLeastCard = 260, kMostCard = 380; ///< pixels wide
constexpr int kMostColumns = 4;
constexpr int kRoomForAll = 860; ///< pixels high, for a line of kept work and what Lumorph is
constexpr int kTextHeight = 104;
constexpr double kPictureShape = 200.0 / 320.0;

const Words kHeading{"What would you like to see?", "Was möchtest du sehen?"};
const Words kAbout{
    "A tablet that bends by itself, and light that stays on it: few motors make the shape, a projector the rest.",
    "Ein Tablet, das sich von selbst biegt, und Licht, das darauf bleibt: wenige Motoren geben die Form, ein Projektor "
    "alles andere."};

QPixmap pictureOf(const Demo& demo) {
    try {
        return QPixmap(QString::fromStdString(resourceFile(demo.thumbnail).string()));
    } catch (const DataError&) { // one without a picture has a card all the same
        return {};
    }
}

/// Picture, title and sentence of one demonstration.
class Card : public QAbstractButton {
public:
    Card(Studio& studio, const Demo& demo, QWidget* parent)
        : QAbstractButton(parent), studio_(studio), demo_(demo), picture_(pictureOf(demo)) {
        setObjectName("applications." + QString::fromStdString(demo.name));
        setFocusPolicy(Qt::StrongFocus);
        setAttribute(Qt::WA_Hover);
        setCursor(Qt::PointingHandCursor);
        say();
    }
    void say() {
        setText(studio_.settings.say(demo_.title));
        setAccessibleDescription(studio_.settings.say(demo_.sentence));
        update();
    }
    void setWide(int wide) { setFixedSize(wide, static_cast<int>(wide * kPictureShape) + kTextHeight); }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        const Palette& colors = currentPalette();
        const bool lit = underMouse() || (byKey_ && hasFocus());
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
        const QRectF plate = QRectF(rect()).adjusted(1.5, 1.5, -1.5, -1.5);
        QPainterPath shape;
        shape.addRoundedRect(plate, 10.0, 10.0);
        painter.fillPath(shape, lit ? colors.hovered : colors.raised);
        const QRectF picture(plate.left(), plate.top(), plate.width(), plate.width() * kPictureShape);
        painter.save();
        painter.setClipPath(shape);
        if (picture_.isNull())
            painter.fillRect(picture, colors.sunken);
        else
            painter.drawPixmap(picture, picture_, picture_.rect());
        painter.restore();
        paintPlayable(painter, picture);
        paintWords(painter, picture.bottom());
        painter.setPen(QPen(lit ? colors.accent : colors.border, lit ? 3.0 : 1.0));
        painter.setBrush(Qt::NoBrush);
        painter.drawPath(shape);
    }

    /// Marked only where keys are used: else nobody asks for it.
    void focusInEvent(QFocusEvent* event) override {
        byKey_ = event->reason() == Qt::TabFocusReason || event->reason() == Qt::BacktabFocusReason;
        QAbstractButton::focusInEvent(event);
    }

private:
    /// A hand on those that answer: the others go by time alone.
    void paintPlayable(QPainter& painter, const QRectF& picture) const {
        if (!demo_.program) return;
        const QRectF badge(picture.right() - 46.0, picture.bottom() - 46.0, 38.0, 38.0);
        painter.setPen(Qt::NoPen);
        painter.setBrush(QColor(14, 18, 22, 190));
        painter.drawEllipse(badge);
        paintPictogram(painter, Pictogram::hand, badge.adjusted(6, 8, -4, -2), Qt::white, 0.35);
    }
    /// Rather smaller than cut: the largest size, in pixels from `most` down, that fits.
    template <class Fits> static void setLargest(QFont& font, int most, const Fits& fits) {
        constexpr int kLeast = 11;
        for (int pixels = most; pixels >= kLeast; --pixels) {
            font.setPixelSize(pixels);
            if (fits()) return;
        }
    }
    void paintWords(QPainter& painter, double top) const {
        const Palette& colors = currentPalette();
        const QRectF room(16.0, top + 10.0, width() - 32.0, height() - top - 14.0);
        QFont title = font();
        title.setWeight(QFont::DemiBold);
        setLargest(title, 17, [&] { return QFontMetricsF(title).horizontalAdvance(text()) <= room.width(); });
        painter.setFont(title);
        painter.setPen(colors.text);
        painter.drawText(room, Qt::AlignLeft | Qt::AlignTop,
                         QFontMetricsF(title).elidedText(text(), Qt::ElideRight, room.width()));
        QFont sentence = font();
        const QRectF below = room.adjusted(0.0, 28.0, 0.0, 2.0);
        setLargest(sentence, 14, [&] {
            const QRectF taken = QFontMetricsF(sentence).boundingRect(QRectF(0.0, 0.0, below.width(), 1e4),
                                                                      Qt::TextWordWrap, accessibleDescription());
            return taken.height() <= below.height();
        });
        painter.setFont(sentence);
        painter.setPen(colors.textMuted);
        painter.drawText(below, Qt::TextWordWrap, accessibleDescription());
    }

    Studio& studio_;
    const Demo& demo_;
    QPixmap picture_;
    bool byKey_ = false; ///< the focus came by a key
};

} // namespace

ApplicationsPage::ApplicationsPage(Studio& studio, QWidget& window, For whom, const Offered& offered)
    : Overlay(window), studio_(studio), whom_(whom) {
    setObjectName("applications");
    EscapeTwice::setCloses(*this, false); // the window does, and Esc Esc stops all the same
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(kMargin, kTop + kMargin, kMargin, kMargin);
    column->setSpacing(kGap);
    heading_ = new QLabel(this);
    QFont large = heading_->font();
    large.setPixelSize(26);
    large.setWeight(QFont::DemiBold);
    heading_->setFont(large);
    heading_->setStyleSheet("font-size: 26px; font-weight: 600;");
    heading_->setAlignment(Qt::AlignHCenter);
    column->addWidget(heading_);
    about_ = new QLabel(this);
    about_->setObjectName("applications.about");
    about_->setProperty("look", "muted");
    about_->setAlignment(Qt::AlignHCenter);
    about_->setWordWrap(true);
    column->addWidget(about_);
    if (whom == For::host) addKeptWork();
    area_ = new QScrollArea(this);
    area_->setWidgetResizable(true);
    area_->setFrameShape(QFrame::NoFrame);
    area_->setFocusPolicy(Qt::NoFocus);
    area_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    column->addWidget(area_, 1);
    addCards(offered);
    foot_ = new QWidget(this);
    column->addWidget(foot_);
    addFoot(whom);
    connect(&studio.settings, &Settings::languageChanged, this, &ApplicationsPage::say);
    say();
}

/// A quiet line: the newest unsaved work that something else has replaced, and the way to the others.
void ApplicationsPage::addKeptWork() {
    kept_ = new QWidget(this);
    kept_->setObjectName("applications.kept");
    auto* row = new QHBoxLayout(kept_);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(12);
    keptName_ = new QLabel(kept_);
    keptName_->setObjectName("applications.kept.name");
    keptName_->setProperty("look", "muted");
    keptName_->setTextFormat(Qt::PlainText);
    auto* back = new QPushButton(kept_);
    back->setObjectName("applications.kept.bringBack");
    keptAll_ = new QPushButton(kept_);
    keptAll_->setObjectName("applications.kept.all");
    keptAll_->setProperty("look", "flat");
    row->addStretch(1);
    for (QWidget* part :
         {static_cast<QWidget*>(keptName_), static_cast<QWidget*>(back), static_cast<QWidget*>(keptAll_)})
        row->addWidget(part);
    row->addStretch(1);
    said_.push_back({back, {"Bring back", "Zurückholen"}});
    connect(back, &QPushButton::clicked, this, [this] {
        if (const auto all = studio_.project.keptWork(); !all.empty() && !all.front().thrown)
            emit workWanted(all.front().id);
    });
    connect(keptAll_, &QPushButton::clicked, this, [this] { openKeptWork(studio_, *window()); });
    connect(&studio_.project, &ProjectService::keptWorkChanged, this, [this] {
        showKeptWork();
        arrange();
    });
    layout()->addWidget(kept_);
}

void ApplicationsPage::showKeptWork() {
    if (kept_ == nullptr) return;
    const std::vector<KeptWork> all = studio_.project.keptWork();
    const bool any = !all.empty() && !all.front().thrown;
    kept_->setVisible(any);
    if (!any) return;
    const QString name =
        fontMetrics().elidedText(studio::nameOf(all.front(), studio_.settings.language()), Qt::ElideMiddle, kMostCard);
    keptName_->setText(studio_.settings
                           .say({"Your work from %1 (%2, not saved)", "Deine Arbeit von %1 (%2, nicht "
                                                                      "gespeichert)"})
                           .arg(timeWords(all.front().when), name));
    keptAll_->setVisible(all.size() > 1);
    keptAll_->setText(studio_.settings.say({"Show all %1...", "Alle %1 zeigen..."}).arg(all.size()));
}

void ApplicationsPage::addCards(const Offered& offered) {
    auto* shelf = new QWidget;
    shelf->setProperty("look", "column"); // see through
    auto* middle = new QGridLayout(shelf);
    middle->setContentsMargins(2, 2, 2, 2);
    grid_ = new QGridLayout;
    grid_->setSpacing(kGap);
    middle->addLayout(grid_, 0, 0, Qt::AlignCenter);
    for (const Demo& demo : demos()) {
        if (whom_ == For::visitors && (!demo.forVisitors || !offered(demo))) continue;
        auto* card = new Card(studio_, demo, shelf);
        connect(card, &QAbstractButton::clicked, this, [this, &demo] { emit chosen(demo); });
        connect(&studio_.settings, &Settings::languageChanged, card, [card] { card->say(); });
        if (whom_ == For::host && !demo.options.empty()) addOptions(*card, demo);
        cards_.push_back(card);
    }
    area_->setWidget(shelf);
    if (!cards_.empty()) setFocusProxy(cards_.front());
}

/// On the card's picture: what this application may be told.
void ApplicationsPage::addOptions(QAbstractButton& card, const Demo& demo) {
    auto* row = new QHBoxLayout(&card);
    row->setContentsMargins(10, 10, 10, 10);
    auto* button = new QPushButton(icon("settings"), {}, &card);
    button->setObjectName(card.objectName() + ".options");
    button->setFixedSize(36, 36);
    button->setCursor(Qt::ArrowCursor);
    row->addWidget(button, 0, Qt::AlignRight | Qt::AlignTop);
    const auto say = [this, button] {
        const QString text = studio_.settings.say({"What it shows...", "Was gezeigt wird..."});
        button->setToolTip(text);
        button->setAccessibleName(text);
    };
    say();
    connect(&studio_.settings, &Settings::languageChanged, button, say);
    connect(button, &QPushButton::clicked, this, [this, &demo] {
        openDemoOptions(studio_, *window(), demo, [page = QPointer(this), &demo] {
            if (page) emit page->chosen(demo);
        });
    });
}

void ApplicationsPage::addFoot(For whom) {
    auto* row = new QHBoxLayout(foot_);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(12);
    row->addStretch(1);
    auto* language = addFootButton("applications.language", {"Deutsch", "English"});
    connect(language, &QPushButton::clicked, this, [this] {
        const bool german = studio_.settings.language() == Language::german;
        studio_.settings.setLanguage(german ? Language::english : Language::german);
    });
    if (whom == For::host) {
        auto* tour = addFootButton("applications.tour", {"Tour of the studio", "Rundgang durch das Studio"});
        connect(tour, &QPushButton::clicked, this, &ApplicationsPage::tourWanted);
    }
    if (whom == For::host) {
        auto* studio = addFootButton("applications.studio", {"To the studio", "Ins Studio"});
        connect(studio, &QPushButton::clicked, this, &ApplicationsPage::studioWanted);
    } else {
        auto* back = addFootButton("applications.back", {"Back", "Zurück"});
        connect(back, &QPushButton::clicked, this, &ApplicationsPage::backWanted);
    }
    row->addStretch(1);
}

QPushButton* ApplicationsPage::addFootButton(const char* name, const Words& words) {
    auto* button = new QPushButton(foot_);
    button->setObjectName(name);
    button->setMinimumHeight(40);
    foot_->layout()->addWidget(button);
    said_.push_back({button, words});
    return button;
}

void ApplicationsPage::say() {
    heading_->setText(studio_.settings.say(kHeading));
    about_->setText(studio_.settings.say(kAbout));
    for (const auto& [button, words] : said_) button->setText(studio_.settings.say(words));
    showKeptWork();
}

/// As large as fits, so that all are in sight at once; where that is too small, it scrolls.
void ApplicationsPage::arrange() {
    const int wide = width() - 2 * kMargin - 20; // and a scroll bar
    // A line of kept work takes its height from the margins, so that the cards stay as large as they are.
    const int line = kept_ != nullptr && !kept_->isHidden() ? kept_->sizeHint().height() + kGap : 0;
    about_->setVisible(line == 0 || height() >= kRoomForAll);
    const int about = about_->isHidden() ? 0 : about_->sizeHint().height() + kGap;
    const int margin = std::max(4, kMargin - (line + about) / 2);
    layout()->setContentsMargins(kMargin, kTop + margin, kMargin, margin);
    const int high = height() - kTop - 2 * margin - 130 - about - line;
    const auto count = static_cast<int>(cards_.size());
    int columns = 1, card = kLeastCard;
    for (int tried = 1; tried <= std::min(kMostColumns, count); ++tried) {
        const int rows = (count + tried - 1) / tried;
        const int byWidth = (wide - (tried - 1) * kGap) / tried;
        const int picture = (high - (rows - 1) * kGap) / rows - kTextHeight;
        const int byHeight = static_cast<int>(picture / kPictureShape);
        const int fits = std::min({byWidth, byHeight, kMostCard});
        if (fits > card || (card == kLeastCard && byWidth >= kLeastCard)) {
            columns = tried;
            card = std::max(fits, kLeastCard);
        }
    }
    for (int k = 0; k < count; ++k) {
        static_cast<Card*>(cards_[static_cast<std::size_t>(k)])->setWide(card);
        grid_->addWidget(cards_[static_cast<std::size_t>(k)], k / columns, k % columns);
    }
    coverAllBut(QRect(0, 0, width(), kTop));
}

void ApplicationsPage::paintEvent(QPaintEvent* /*event*/) {
    QColor ground = currentPalette().window;
    ground.setAlphaF(0.96F);
    QPainter(this).fillRect(rect(), ground);
}

} // namespace lumorph::studio
