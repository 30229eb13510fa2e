#include "app/studio/shell/visitor_layer.h"

#include <array>
#include <cmath>
#include <vector>

#include "app/applications/demo.h"
#include "app/studio/look/palette.h"
#include "app/studio/shell/pictograms.h"

namespace lumorph::studio {
namespace {

constexpr int kFrameMilliseconds = 50;
constexpr double kBeginSeconds = 9.0; ///< that the ways to play are in sight
constexpr double kHelpSeconds = 30.0;
constexpr int kMargin = 20;
constexpr double kWay = 60.0; ///< side of a way to play, small
constexpr double kWayGap = 18.0;
constexpr double kWayLarge = 84.0;
constexpr double kHand = 76.0;
constexpr double kCaptionWidth = 420.0;
constexpr double kKeyRow = 34.0;
constexpr double kBarWidth = 320.0;

const QColor kInk(255, 255, 255);
const QColor kPlate(14, 18, 22, 168); ///< pictures are of any brightness
const QColor kVeil(14, 18, 22);       ///< over what is no longer true
const QColor kPlateOfHelp(14, 18, 22, 226);

struct Way {
    Pictogram picture;
    Words word;
};
const std::array<Way, 4>& ways() {
    static const std::array<Way, 4> all{{{Pictogram::mouse, {"Mouse", "Maus"}},
                                         {Pictogram::keys, {"Arrow keys", "Pfeiltasten"}},
                                         {Pictogram::tilt, {"Lean it", "Neigen"}},
                                         {Pictogram::pad, {"Gamepad", "Gamepad"}}}};
    return all;
}

struct KeyLine {
    QString keys;
    Words does;
};
/// What keys do that all applications share, with what only some of them answer.
std::vector<KeyLine> keyLines(bool steps, bool compares) {
    std::vector<KeyLine> lines{{"R", {"Begin again", "Von vorn"}}, {"N", {"Next", "Weiter"}}};
    if (steps) lines.push_back({"0-6", {"Choose", "Auswählen"}});
    if (compares) lines.push_back({"O", {"With and without", "Mit und ohne"}});
    lines.push_back({"L", {"Light away and back", "Licht weg und wieder an"}});
    lines.push_back({"B", {"The bare device beside it", "Das Gerät ohne Licht daneben"}});
    lines.push_back({"A", {"Leave it to itself", "Allein laufen lassen"}});
    lines.push_back({"H", {"This help", "Diese Hilfe"}});
    lines.push_back({"Esc", {"All applications", "Alle Anwendungen"}});
    return lines;
}

QFont fontOf(const QFont& base, double pixels, QFont::Weight weight) {
    QFont font = base;
    font.setPixelSize(static_cast<int>(std::lround(pixels)));
    font.setWeight(weight);
    return font;
}

void paintPlate(QPainter& painter, const QRectF& box, const QColor& plate) {
    painter.setPen(Qt::NoPen);
    painter.setBrush(plate);
    painter.drawRoundedRect(box, 12.0, 12.0);
}

} // namespace

VisitorLayer::VisitorLayer(Studio& studio, QWidget* parent) : QWidget(parent), studio_(studio) {
    setObjectName("visitors.layer");
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setAttribute(Qt::WA_NoSystemBackground);
    connect(&studio.loop, &StudioLoop::framed, this, &VisitorLayer::takeFrame);
    connect(&studio.settings, &Settings::languageChanged, this, qOverload<>(&QWidget::update));
    connect(&animation_, &QTimer::timeout, this, &VisitorLayer::animate);
    animation_.start(kFrameMilliseconds);
    since_.start();
}

void VisitorLayer::setForVisitors(bool on) {
    forVisitors_ = on;
    setHelp(false);
    update();
}

void VisitorLayer::begin() {
    begun_.start();
    caption_ = nullptr;
    const Demo* demo = studio_.project.demo();
    hasSteps_ = demo != nullptr && !demo->steps().empty();
    compares_ = demo != nullptr && demo->compares;
    setHelp(false);
    update();
}

void VisitorLayer::setOpening(const Words& title, double fraction) {
    opening_ = Opening{title, fraction};
    show();
    update();
}

void VisitorLayer::endOpening() {
    if (!opening_) return;
    opening_.reset();
    setVisible(help_ || forVisitors_);
    update();
}

void VisitorLayer::setPlayed(bool played) {
    played_ = played;
    update();
}

void VisitorLayer::setHelp(bool on) {
    help_ = on;
    if (on) helped_.start();
    setVisible(on || forVisitors_);
    update();
}

void VisitorLayer::setSeen(bool seen) { seen ? animation_.start(kFrameMilliseconds) : animation_.stop(); }

bool VisitorLayer::waysShown() const {
    return forVisitors_ && !help_ && studio_.loop.program() && begun_.isValid() &&
           static_cast<double>(begun_.elapsed()) < 1e3 * kBeginSeconds;
}

bool VisitorLayer::handShown() const { return forVisitors_ && !help_ && !played_ && studio_.loop.program(); }

/// Of the application; of one that says nothing its own title, while it begins.
QString VisitorLayer::captionTitle() const {
    if (!forVisitors_) return {};
    if (caption_) return studio_.settings.say(caption_->title);
    const Demo* demo = studio_.project.demo();
    const bool begins = begun_.isValid() && static_cast<double>(begun_.elapsed()) < 1e3 * kBeginSeconds;
    return demo != nullptr && begins ? studio_.settings.say(demo->title) : QString();
}

QString VisitorLayer::captionSentence() const {
    if (captionTitle().isEmpty()) return {};
    return studio_.settings.say(caption_ ? caption_->sentence : studio_.project.demo()->sentence);
}

void VisitorLayer::takeFrame() {
    const auto& frame = studio_.loop.frame();
    const auto caption = frame && studio_.loop.program() ? frame->caption : nullptr;
    if (caption == caption_) return;
    caption_ = caption;
    update();
}

/// Only what moves is drawn anew; all of it once when something has come or gone.
void VisitorLayer::animate() {
    if (!isVisible()) return;
    if (help_ && static_cast<double>(helped_.elapsed()) > 1e3 * kHelpSeconds) return setHelp(false);
    if (opening_) return update();
    if (help_ || handShown() || waysShown()) {
        update(animated());
    } else if (begun_.isValid() && static_cast<double>(begun_.elapsed()) > 1e3 * kBeginSeconds) {
        update();
        begun_.invalidate();
    }
}

QRect VisitorLayer::animated() const {
    if (help_) return helpBox().toAlignedRect();
    return {0, height() - 120, width(), 120};
}

double VisitorLayer::turn(double seconds) const {
    return std::fmod(1e-3 * static_cast<double>(since_.elapsed()) / seconds, 1.0);
}

QRectF VisitorLayer::waysBox() const {
    const double wide = (kWay + kWayGap) * static_cast<double>(ways().size()) + kWayGap;
    return {0.5 * (width() - wide), height() - kWay - 2.0 * kMargin, wide, kWay + 8.0};
}

/// Below the picture's middle, and beside the ways to play while they are in sight.
QRectF VisitorLayer::handBox() const {
    const double left = waysShown() ? waysBox().left() - kHand - 0.5 * kMargin : 0.5 * (width() - kHand);
    return {left, height() - kHand - 1.4 * kMargin, kHand, kHand};
}

QRectF VisitorLayer::helpBox() const {
    const auto lines = static_cast<double>(keyLines(hasSteps_, compares_).size());
    const double wide = std::min(4.0 * (kWayLarge + 32.0) + 2.0 * kMargin, width() - 2.0 * kMargin);
    const double high = std::min(kWayLarge + 44.0 + lines * kKeyRow + 3.0 * kMargin, height() - 2.0 * kMargin);
    return {0.5 * (width() - wide), 0.5 * (height() - high), wide, high};
}

void VisitorLayer::paintEvent(QPaintEvent* /*event*/) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    if (opening_) return paintOpening(painter);
    if (!captionTitle().isEmpty()) paintCaption(painter);
    if (waysShown()) paintWays(painter);
    if (handShown()) paintHand(painter);
    if (help_) paintHelp(painter);
}

void VisitorLayer::paintWays(QPainter& painter) const {
    const QRectF box = waysBox();
    paintPlate(painter, box, kPlate);
    double left = box.left() + kWayGap;
    for (const Way& way : ways()) {
        paintPictogram(painter, way.picture, {left, box.top() + 6.0, kWay, kWay - 4.0}, kInk, turn(2.4));
        left += kWay + kWayGap;
    }
}

void VisitorLayer::paintHand(QPainter& painter) const {
    painter.setPen(Qt::NoPen);
    painter.setBrush(kPlate);
    painter.drawEllipse(handBox());
    paintPictogram(painter, Pictogram::hand, handBox().adjusted(12, 14, -8, -6), kInk, turn(1.6));
}

void VisitorLayer::paintCaption(QPainter& painter) const {
    const QFont title = fontOf(font(), 17.0, QFont::DemiBold), text = fontOf(font(), 14.0, QFont::Normal);
    const double wide = std::min(kCaptionWidth, width() - 2.0 * kMargin);
    const QRectF room(0.0, 0.0, wide - 32.0, 200.0);
    const QString sentence = captionSentence();
    const QRectF titleBox = QFontMetricsF(title).boundingRect(room, Qt::TextWordWrap, captionTitle());
    const QRectF textBox =
        sentence.isEmpty() ? QRectF() : QFontMetricsF(text).boundingRect(room, Qt::TextWordWrap, sentence);
    const double high = titleBox.height() + (sentence.isEmpty() ? 0.0 : textBox.height() + 4.0) + 24.0;
    const QRectF plate(kMargin, kMargin, std::max(titleBox.width(), textBox.width()) + 34.0, high);
    paintPlate(painter, plate, kPlate);
    painter.setPen(kInk);
    painter.setFont(title);
    painter.drawText(QRectF(plate.left() + 16.0, plate.top() + 12.0, room.width() + 2.0, titleBox.height()),
                     Qt::TextWordWrap, captionTitle());
    painter.setFont(text);
    painter.drawText(
        QRectF(plate.left() + 16.0, plate.top() + 16.0 + titleBox.height(), room.width() + 2.0, textBox.height()),
        Qt::TextWordWrap, sentence);
}

void VisitorLayer::paintOpening(QPainter& painter) const {
    painter.fillRect(rect(), kVeil);
    painter.setPen(kInk);
    painter.setFont(fontOf(font(), 22.0, QFont::DemiBold));
    const QRectF words(kMargin, 0.5 * height() - 60.0, width() - 2.0 * kMargin, 40.0);
    painter.drawText(words, Qt::AlignCenter, studio_.settings.say(opening_->title));
    const QRectF bar(0.5 * (width() - kBarWidth), 0.5 * height(), kBarWidth, 6.0);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(255, 255, 255, 50));
    painter.drawRoundedRect(bar, 3.0, 3.0);
    QRectF done = bar;
    if (opening_->fraction >= 0.0)
        done.setWidth(std::max(6.0, std::min(opening_->fraction, 1.0) * bar.width()));
    else
        done = {bar.left() + turn(1.6) * 0.7 * bar.width(), bar.top(), 0.3 * bar.width(), bar.height()};
    painter.setBrush(kInk);
    painter.drawRoundedRect(done, 3.0, 3.0);
}

void VisitorLayer::paintHelp(QPainter& painter) const {
    const QRectF box = helpBox();
    paintPlate(painter, box, kPlateOfHelp);
    const QFont word = fontOf(font(), 15.0, QFont::Normal), key = fontOf(font(), 14.0, QFont::DemiBold);
    const double column = (box.width() - 2.0 * kMargin) / static_cast<double>(ways().size());
    double left = box.left() + kMargin;
    painter.setFont(word);
    for (const Way& way : ways()) {
        paintPictogram(painter, way.picture, {left, box.top() + kMargin, column, kWayLarge}, kInk, turn(2.4));
        painter.setPen(kInk);
        painter.drawText(QRectF(left, box.top() + kMargin + kWayLarge, column, 24.0), Qt::AlignCenter,
                         studio_.settings.say(way.word));
        left += column;
    }
    double top = box.top() + kWayLarge + 44.0 + 1.5 * kMargin;
    const double middle = box.left() + 0.36 * box.width();
    for (const KeyLine& line : keyLines(hasSteps_, compares_)) {
        painter.setFont(key);
        const double wide = std::max(28.0, QFontMetricsF(key).horizontalAdvance(line.keys) + 16.0);
        paintKeycap(painter, {middle - wide, top, wide, 26.0}, line.keys, kInk);
        painter.setFont(word);
        painter.setPen(kInk);
        painter.drawText(QRectF(middle + 16.0, top, box.right() - middle - 16.0, 26.0), Qt::AlignVCenter,
                         studio_.settings.say(line.does));
        top += kKeyRow;
    }
}

} // namespace lumorph::studio
