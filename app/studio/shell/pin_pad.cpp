#include "app/studio/shell/pin_pad.h"

#include <algorithm>
#include <utility>

#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QTimer>
#include <QVBoxLayout>

#include "app/studio/look/palette.h"

namespace lumorph::studio {
namespace {

constexpr int kPadWidth = 296;
constexpr int kRestOfPad = 300; ///< its height without the four rows of keys
constexpr int kIdlePadMilliseconds = 30'000;
constexpr int kCountMilliseconds = 250;

/// A dot for each digit that was typed: a visitor may look over a shoulder.
class PinDots : public QWidget {
public:
    explicit PinDots(QWidget* parent) : QWidget(parent) { setFixedHeight(24); }
    void setTyped(qsizetype count) {
        count_ = static_cast<int>(count);
        setAccessibleName(QString("%1 digits").arg(count));
        update();
    }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        constexpr int kStep = 22;
        const int places = std::max(OperatorPin::kFewestDigits, count_);
        const double left = 0.5 * (width() - kStep * (places - 1));
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        for (int i = 0; i < places; ++i) {
            const bool typed = i < count_;
            painter.setPen(QPen(typed ? currentPalette().accent : currentPalette().border, 1.5));
            painter.setBrush(typed ? QBrush(currentPalette().accent) : QBrush(Qt::NoBrush));
            painter.drawEllipse(QPointF(left + kStep * i, 0.5 * height()), 6.0, 6.0);
        }
    }

private:
    int count_ = 0;
};

class PinPad : public Overlay {
public:
    enum class Asks { pin, fresh, again };

    PinPad(QWidget& window, OperatorPin& pin, Asks asks, bool mayCancel, std::function<void()> done)
        : Overlay(window), pin_(pin), asks_(asks), mayCancel_(mayCancel), done_(std::move(done)) {
        setObjectName("pin");
        makeCard();
        if (mayCancel) {
            idle_.setSingleShot(true);
            connect(&idle_, &QTimer::timeout, this, [this] { leave(); });
            idle_.start(kIdlePadMilliseconds);
        }
        connect(&count_, &QTimer::timeout, this, [this] { showWait(); });
        count_.start(kCountMilliseconds);
        showTyped();
        showWait();
    }

    void say(const QString& title, const QString& text) {
        title_->setText(title);
        text_->setText(text);
    }

protected:
    void keyPressEvent(QKeyEvent* event) override {
        const int key = event->key();
        if (key >= Qt::Key_0 && key <= Qt::Key_9)
            type(static_cast<char>('0' + key - Qt::Key_0));
        else if (key == Qt::Key_Backspace)
            takeBack();
        else if (key == Qt::Key_Return || key == Qt::Key_Enter)
            accept();
        else
            event->ignore();
    }
    void mousePressEvent(QMouseEvent* event) override { event->accept(); }

    void arrange() override {
        const int key = std::clamp((height() - kRestOfPad) / 4, 26, 56); // large enough for fingers
        if (key != std::exchange(keyHeight_, key))
            card_->setStyleSheet(QString("QPushButton { min-height: %1px; max-height: %1px; font-size: 17px; }")
                                     .arg(key - 2)); // and its edges
        card_->setFixedWidth(std::min(kPadWidth, width() - 16));
        card_->adjustSize();
        card_->move((width() - card_->width()) / 2, std::max(0, (height() - card_->height()) / 2));
    }

private:
    void makeCard() {
        card_ = new QFrame(this);
        card_->setObjectName("pin.card");
        card_->setProperty("look", "popup");
        auto* column = new QVBoxLayout(card_);
        column->setContentsMargins(20, 16, 20, 16);
        column->setSpacing(8);
        title_ = new QLabel(card_);
        title_->setObjectName("pin.title");
        title_->setProperty("look", "title");
        title_->setAlignment(Qt::AlignHCenter);
        text_ = new QLabel(card_);
        text_->setProperty("look", "muted");
        text_->setAlignment(Qt::AlignHCenter);
        text_->setWordWrap(true);
        dots_ = new PinDots(card_);
        message_ = new QLabel(card_);
        message_->setObjectName("pin.message");
        message_->setProperty("look", "warning");
        message_->setAlignment(Qt::AlignCenter);
        message_->setWordWrap(true);
        message_->setFixedHeight(36);
        for (QWidget* widget : {static_cast<QWidget*>(title_), static_cast<QWidget*>(text_),
                                static_cast<QWidget*>(dots_), static_cast<QWidget*>(message_)})
            column->addWidget(widget);
        column->addLayout(makeKeys());
    }

    QGridLayout* makeKeys() {
        auto* grid = new QGridLayout;
        grid->setSpacing(8);
        for (int digit = 1; digit <= 9; ++digit)
            grid->addWidget(addKey(QString::number(digit)), (digit - 1) / 3, (digit - 1) % 3);
        auto* back = addKey(QChar(0x2190));
        back->setObjectName("pin.back");
        back->setAccessibleName("Take back the last digit");
        grid->addWidget(back, 3, 0);
        grid->addWidget(addKey("0"), 3, 1);
        accept_ = addKey("OK");
        accept_->setObjectName("pin.accept");
        accept_->setProperty("look", "primary");
        grid->addWidget(accept_, 3, 2);
        connect(back, &QPushButton::clicked, this, [this] { takeBack(); });
        connect(accept_, &QPushButton::clicked, this, [this] { accept(); });
        if (mayCancel_) {
            auto* cancel = new QPushButton("Cancel", card_);
            cancel->setObjectName("pin.cancel");
            cancel->setProperty("look", "flat");
            cancel->setFocusPolicy(Qt::NoFocus);
            grid->addWidget(cancel, 4, 0, 1, 3);
            connect(cancel, &QPushButton::clicked, this, [this] { leave(); });
        }
        return grid;
    }

    /// Not in the way of the keyboard's focus: keys are typed as digits wherever it is.
    QPushButton* addKey(const QString& text) {
        auto* key = new QPushButton(text, card_);
        key->setFocusPolicy(Qt::NoFocus);
        keys_.push_back(key);
        if (text.size() == 1 && text[0].isDigit()) {
            key->setObjectName("pin.digit." + text);
            connect(key, &QPushButton::clicked, this, [this, text] { type(text[0].toLatin1()); });
        }
        return key;
    }

    void type(char digit) {
        if (waits() || typed_.size() >= OperatorPin::kMostDigits) return;
        typed_ += QLatin1Char(digit);
        message_->clear();
        showTyped();
    }

    void takeBack() {
        typed_.chop(1);
        showTyped();
    }

    void showTyped() {
        if (idle_.isActive()) idle_.start();
        dots_->setTyped(typed_.size());
        accept_->setEnabled(typed_.size() >= OperatorPin::kFewestDigits && !waits());
    }

    [[nodiscard]] bool waits() const { return asks_ == Asks::pin && pin_.secondsToWait() > 0; }

    void showWait() {
        const bool waits = this->waits();
        if (waits)
            message_->setText(QString("Too many wrong tries. The next one in %1 s.").arg(pin_.secondsToWait()));
        else if (waited_)
            message_->clear();
        if (std::exchange(waited_, waits) == waits) return;
        for (QPushButton* key : keys_) key->setEnabled(!waits);
        showTyped();
    }

    void accept() {
        if (typed_.size() < OperatorPin::kFewestDigits) return;
        const QString pin = std::exchange(typed_, {});
        switch (asks_) {
        case Asks::pin:
            if (pin_.attempt(pin) == OperatorPin::Answer::right) return finish();
            message_->setText("That is not the PIN.");
            break;
        case Asks::fresh:
            first_ = pin;
            asks_ = Asks::again;
            say("Once more", "The same digits again, so that no slip of a finger locks you out.");
            break;
        case Asks::again:
            if (pin == first_) {
                pin_.choose(pin);
                return finish();
            }
            asks_ = Asks::fresh;
            say("Choose the operator's PIN", "4 to 8 digits.");
            message_->setText("These were not the same. Choose again.");
            break;
        }
        showTyped();
        showWait();
        arrange();
    }

    void finish() {
        const auto done = std::exchange(done_, nullptr);
        leave();
        if (done) done();
    }

    OperatorPin& pin_;
    Asks asks_;
    bool mayCancel_;
    std::function<void()> done_;
    QString typed_, first_;
    bool waited_ = false;
    int keyHeight_ = 0;
    QTimer idle_, count_;
    QFrame* card_ = nullptr;
    QLabel *title_ = nullptr, *text_ = nullptr, *message_ = nullptr;
    PinDots* dots_ = nullptr;
    QPushButton* accept_ = nullptr;
    std::vector<QPushButton*> keys_;
};

Overlay* openPad(PinPad* pad, const QString& title, const QString& text) {
    pad->say(title, text);
    pad->open();
    pad->setFocus(Qt::PopupFocusReason);
    return pad;
}

} // namespace

Overlay* askPin(QWidget& window, OperatorPin& pin, const QString& why, std::function<void()> right) {
    return openPad(new PinPad(window, pin, PinPad::Asks::pin, true, std::move(right)), "Operator's PIN", why);
}

Overlay* choosePin(QWidget& window, OperatorPin& pin, bool mayCancel, std::function<void()> chosen) {
    return openPad(new PinPad(window, pin, PinPad::Asks::fresh, mayCancel, std::move(chosen)),
                   "Choose the operator's PIN",
                   "4 to 8 digits. In the kiosk anybody can stop the servos; with this you resume and leave.");
}

} // namespace lumorph::studio
