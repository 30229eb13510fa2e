#include "app/studio/shell/visitor_bar.h"

#include <utility>

#include <QHBoxLayout>

#include "app/applications/demo.h"
#include "app/studio/look/icons.h"

namespace lumorph::studio {
namespace {

constexpr int kButton = 44; ///< large enough for fingers
constexpr int kIcon = 24;

} // namespace

VisitorBar::VisitorBar(Studio& studio, QWidget* parent) : FloatingCard(parent), studio_(studio) {
    setObjectName("visitors.bar");
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(6, 6, 6, 6);
    row->setSpacing(4);
    row->setSizeConstraint(QLayout::SetFixedSize);
    const auto press = [this](const char* key) {
        studio_.loop.input(key, 1.0);
        studio_.loop.input(key, 0.0);
    };
    cards_ = add("visitors.cards", "grid", {"All applications", "Alle Anwendungen"}, [this] { emit cardsWanted(); });
    restart_ = add("visitors.restart", "reset", {"Begin again", "Von vorn"}, [press] { press("key.restart"); });
    off_ = add("visitors.off", "compare", {"With and without", "Mit und ohne"}, [press] { press("key.off"); });
    next_ = add("visitors.next", "chevron-right", {"Next", "Weiter"}, [press] { press("key.next"); });
    help_ = add("visitors.help", "help", {"How to play", "So geht es"}, [this] { emit helpWanted(); });
    // Each says what it leads to, in that language.
    language_ = add("visitors.language", "", {"Deutsch", "English"}, [this] {
        const bool german = studio_.settings.language() == Language::german;
        studio_.settings.setLanguage(german ? Language::english : Language::german);
    });
    connect(&studio.settings, &Settings::languageChanged, this, &VisitorBar::say);
    say();
    follow(false);
}

QToolButton* VisitorBar::add(const char* name, const char* iconName, const Words& words, std::function<void()> run) {
    auto* button = new QToolButton(this);
    button->setObjectName(name);
    button->setFixedSize(kButton, kButton);
    button->setIconSize(QSize(kIcon, kIcon));
    button->setFocusPolicy(Qt::NoFocus); // keys stay with the application
    if (*iconName != '\0') button->setIcon(icon(iconName));
    connect(button, &QToolButton::clicked, this, std::move(run));
    layout()->addWidget(button);
    buttons_.push_back({button, words});
    return button;
}

void VisitorBar::say() {
    for (const auto& [button, words] : buttons_) {
        button->setToolTip(studio_.settings.say(words));
        button->setAccessibleName(studio_.settings.say(words));
    }
    language_->setText(studio_.settings.language() == Language::german ? "EN" : "DE");
}

void VisitorBar::follow(bool rests) {
    const Demo* demo = studio_.project.demo();
    const bool plays = studio_.loop.program() != nullptr;
    cards_->setVisible(!rests);
    for (QToolButton* button : {restart_, next_, help_}) button->setVisible(plays);
    off_->setVisible(plays && demo != nullptr && demo->compares);
    adjustSize();
}

} // namespace lumorph::studio
