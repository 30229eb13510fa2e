#include "app/studio/shell/dialogs.h"

#include <utility>

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

#include "app/studio/shell/command_search.h"
#include "app/studio/widgets/panel.h"

namespace lumorph::studio {
namespace {

/// Null when it is open already.
QDialog* makeDialog(QWidget& window, const QString& name, const QString& title) {
    if (auto* open = window.findChild<QDialog*>(name)) {
        open->raise();
        open->activateWindow();
        return nullptr;
    }
    auto* dialog = new QDialog(&window);
    dialog->setObjectName(name);
    dialog->setWindowTitle(title);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    auto* column = new QVBoxLayout(dialog);
    column->setContentsMargins(24, 16, 24, 16);
    column->setSpacing(8);
    return dialog;
}

void addClose(QDialog& dialog) {
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, &dialog);
    QObject::connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::close);
    dialog.layout()->addWidget(buttons);
}

QLabel* muted(const QString& text, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    label->setProperty("look", "muted");
    label->setWordWrap(true);
    return label;
}

void addLook(Studio& studio, QDialog& dialog) {
    dialog.layout()->addWidget(makeHeading("Look", &dialog));
    auto* theme = new QComboBox(&dialog);
    theme->setObjectName("settings.theme");
    theme->addItems({"Dark", "Light"});
    theme->setCurrentIndex(studio.settings.theme() == Theme::light ? 1 : 0);
    QObject::connect(theme, &QComboBox::currentIndexChanged, &dialog,
                     [&studio](int index) { studio.settings.setTheme(index == 1 ? Theme::light : Theme::dark); });
    QObject::connect(&studio.settings, &Settings::themeChanged, theme,
                     [theme, &studio] { theme->setCurrentIndex(studio.settings.theme() == Theme::light ? 1 : 0); });
    dialog.layout()->addWidget(makeRow("&Theme", theme, &dialog));
    auto* still = new QCheckBox("&Draw a still view in full quality", &dialog);
    still->setObjectName("settings.stillQuality");
    still->setChecked(studio.settings.stillQuality());
    still->setToolTip(
        "Soft shadows and smooth edges as soon as nothing moves. Takes a moment without a graphics card.");
    QObject::connect(still, &QCheckBox::toggled, &studio.settings, &Settings::setStillQuality);
    dialog.layout()->addWidget(still);
}

void addMatching(Studio& studio, QDialog& dialog) {
    dialog.layout()->addWidget(makeHeading("Matching", &dialog));
    auto* rate = new QSpinBox(&dialog);
    rate->setObjectName("settings.loopRate");
    rate->setRange(10, 120);
    rate->setSuffix(" Hz");
    rate->setValue(static_cast<int>(studio.settings.loopRate()));
    rate->setKeyboardTracking(false);
    QObject::connect(rate, &QSpinBox::valueChanged, &studio.settings,
                     [&studio](int hertz) { studio.settings.setLoopRate(hertz); });
    dialog.layout()->addWidget(makeRow("Loop &rate", rate, &dialog));
    dialog.layout()->addWidget(muted("How often a second the device looks at the target anew.", &dialog));
    auto* place = new QCheckBox("&Place new targets where they match best", &dialog);
    place->setObjectName("settings.placesNewTargets");
    place->setChecked(studio.settings.placesNewTargets());
    place->setToolTip("A model in the middle is out of the tablet's reach. Undo brings a target back to where it was.");
    QObject::connect(place, &QCheckBox::toggled, &studio.settings, &Settings::setPlacesNewTargets);
    dialog.layout()->addWidget(place);
}

QDoubleSpinBox* makeMinutes(Studio& studio, QWidget* parent, bool kiosk, const QString& name) {
    auto* minutes = new QDoubleSpinBox(parent);
    minutes->setObjectName(name);
    minutes->setRange(0.0, 120.0);
    minutes->setDecimals(0);
    minutes->setSuffix(" min");
    minutes->setSpecialValueText("Never");
    minutes->setValue(studio.settings.nextMinutes(kiosk));
    minutes->setKeyboardTracking(false);
    QObject::connect(minutes, &QDoubleSpinBox::valueChanged, &studio.settings,
                     [&studio, kiosk](double value) { studio.settings.setNextMinutes(kiosk, value); });
    return minutes;
}

void addVisitors(Studio& studio, QDialog& dialog) {
    dialog.layout()->addWidget(makeHeading("Visitors", &dialog));
    auto* language = new QComboBox(&dialog);
    language->setObjectName("settings.language");
    language->addItems({"English", "Deutsch"});
    const auto show = [language, &studio] {
        language->setCurrentIndex(studio.settings.language() == Language::german ? 1 : 0);
    };
    show();
    QObject::connect(language, &QComboBox::activated, &studio.settings, [&studio](int index) {
        studio.settings.setLanguage(index == 1 ? Language::german : Language::english);
    });
    QObject::connect(&studio.settings, &Settings::languageChanged, language, show);
    dialog.layout()->addWidget(makeRow("&Language", language, &dialog));
    dialog.layout()->addWidget(
        makeRow("Next in the &kiosk after", makeMinutes(studio, &dialog, true, "settings.nextInKiosk"), &dialog));
    dialog.layout()->addWidget(
        makeRow("Next in full &view after", makeMinutes(studio, &dialog, false, "settings.next"), &dialog));
    dialog.layout()->addWidget(muted("Without a visitor for so long, the next application shows.", &dialog));
}

void addBareInlay(Studio& studio, QDialog& dialog) {
    auto* corner = new QComboBox(&dialog);
    corner->setObjectName("settings.bareCorner");
    corner->addItems({"Nowhere", "Top right", "Bottom left"}); // as BareInlay::Corner
    auto* share = new QSpinBox(&dialog);
    share->setObjectName("settings.bareShare");
    share->setRange(15, 40);
    share->setSuffix(" %");
    share->setToolTip("Of the width of the view");
    share->setKeyboardTracking(false);
    const BareInlay shown = studio.settings.bareInlay();
    corner->setCurrentIndex(static_cast<int>(shown.corner));
    share->setValue(static_cast<int>(std::lround(100.0 * shown.share)));
    const auto take = [corner, share, &studio] {
        studio.settings.setBareInlay({static_cast<BareInlay::Corner>(corner->currentIndex()), 0.01 * share->value()});
    };
    QObject::connect(corner, &QComboBox::currentIndexChanged, &studio.settings, take);
    QObject::connect(share, &QSpinBox::valueChanged, &studio.settings, take);
    dialog.layout()->addWidget(makeRow("&Bare device in full view", corner, &dialog));
    dialog.layout()->addWidget(makeRow("Its &width", share, &dialog));
}

void addMemory(Studio& studio, QDialog& dialog) {
    dialog.layout()->addWidget(makeHeading("Memory", &dialog));
    auto* row = new QWidget(&dialog);
    auto* buttons = new QHBoxLayout(row);
    buttons->setContentsMargins(0, 0, 0, 0);
    const auto add = [&](const char* text, std::function<void()> run) {
        auto* button = new QPushButton(text, row);
        button->setAutoDefault(false);
        QObject::connect(button, &QPushButton::clicked, &studio.settings, [button, run = std::move(run)] {
            run();
            button->setEnabled(false); // done; the change itself is elsewhere on the screen
        });
        buttons->addWidget(button);
    };
    add("Forget recent &files", [&studio] { studio.settings.clearRecentFiles(); });
    add("Reset &layout", [&studio] {
        if (QAction* reset = studio.commands.find("view.resetLayout")) reset->trigger();
    });
    buttons->addStretch(1);
    dialog.layout()->addWidget(row);
}

struct KeyLine {
    const char* keys;
    const char* does;
};

/// Keys and gestures that are no commands.
constexpr KeyLine kGestures[] = {
    {"Esc Esc", "STOP: the show holds still, all servos are let go"},
    {"Left drag, middle drag", "Turn the view"},
    {"Shift drag, right drag", "Move the view"},
    {"Wheel, + and -", "Zoom"},
    {"F, Home", "Frame what is selected, frame everything"},
    {"1, 3, 7, 5", "Front, right, top; perspective or orthographic"},
    {"Drag on a number", "Change it; Shift fine, Ctrl coarse"},
    {"Double click on a number", "Reset it"},
    {"Tab, Shift Tab", "Next and previous control"},
};

void addKeyLine(QVBoxLayout& column, const QString& keys, const QString& does, QWidget* parent) {
    auto* row = new QWidget(parent);
    auto* line = new QHBoxLayout(row);
    line->setContentsMargins(0, 0, 0, 0);
    line->addWidget(new QLabel(does, row), 1);
    auto* badge = new QLabel(keys, row);
    badge->setProperty("look", "badge");
    line->addWidget(badge);
    column.addWidget(row);
}

/// The commands of one menu that have keys.
void addKeysOf(Studio& studio, const QString& menu, const Column& column) {
    bool begun = false;
    for (const auto& entry : studio.commands.all()) {
        if (entry.options.menu != menu || entry.action->shortcut().isEmpty()) continue;
        if (!std::exchange(begun, true)) column.layout->addWidget(makeHeading(menu, column.widget));
        addKeyLine(*column.layout, entry.action->shortcut().toString(QKeySequence::NativeText),
                   commandTitle(*entry.action), column.widget);
    }
}

} // namespace

void openSettings(Studio& studio, QWidget& window) {
    QDialog* dialog = makeDialog(window, "dialog.settings", "Settings");
    if (dialog == nullptr) return;
    addLook(studio, *dialog);
    addMatching(studio, *dialog);
    addVisitors(studio, *dialog);
    addBareInlay(studio, *dialog);
    addMemory(studio, *dialog);
    static_cast<QVBoxLayout*>(dialog->layout())->addStretch(1);
    addClose(*dialog);
    dialog->resize(440, dialog->sizeHint().height());
    dialog->show();
}

void openShortcuts(Studio& studio, QWidget& window) {
    QDialog* dialog = makeDialog(window, "dialog.shortcuts", "Keyboard and mouse");
    if (dialog == nullptr) return;
    const Column column = makeColumn(dialog);
    for (const QString& menu : kMenus) addKeysOf(studio, menu, column);
    column.layout->addWidget(makeHeading("View and numbers", dialog));
    for (const KeyLine& line : kGestures) addKeyLine(*column.layout, line.keys, line.does, dialog);
    dialog->layout()->addWidget(column.widget);
    addClose(*dialog);
    dialog->resize(QSize(560, 640).boundedTo(window.size() * 0.9));
    dialog->show();
}

void openAbout(QWidget& window) {
    QDialog* dialog = makeDialog(window, "dialog.about", "About Lumorph");
    if (dialog == nullptr) return;
    auto* name = new QLabel("Lumorph " LUMORPH_VERSION, dialog);
    name->setProperty("look", "title");
    dialog->layout()->addWidget(name);
    dialog->layout()->addWidget(new QLabel("Studio for objects that change shape and are painted with light.", dialog));
    dialog->layout()->addWidget(
        muted("Free software under the GNU General Public License, version 3 or later. Drawn with Qt, set in Inter.",
              dialog));
    addClose(*dialog);
    dialog->show();
}

} // namespace lumorph::studio
