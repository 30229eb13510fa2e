#include "app/studio/look/style_sheet.h"

namespace lumorph::studio {
namespace {

constexpr auto kBoxes = R"(
* { outline: none; }
QWidget { color: @text; selection-background-color: @selection; selection-color: @text; }
QMainWindow, QDialog, QMessageBox { background: @window; }
QMainWindow::separator { background: @window; width: 5px; height: 5px; }
QMainWindow::separator:hover { background: @accent; }
QDialog { background: @panel; }
QFrame[frameShape="4"], QFrame[frameShape="5"] { color: @line; }
QLabel { background: transparent; }
QLabel:disabled { color: @disabled; }
QLabel[look="muted"] { color: @muted; }
QLabel[look="heading"] { color: @text; font-weight: 600; }
QLabel[look="title"] { font-size: 16px; font-weight: 600; }
QLabel[look="badge"] { background: @raised; color: @muted; border-radius: 4px; padding: 1px 6px; }
QLabel[look="accent"] { color: @accentText; }
QLabel[look="warning"] { color: @warning; }
QFrame[look="hairline"] { background: @line; border: none; max-height: 1px; min-height: 1px; }
QFrame[look="card"] { background: @raised; border: 1px solid @line; border-radius: 6px; }
QFrame[look="popup"] { background: @panel; border: 1px solid @border; border-radius: 8px; }
QWidget[look="panel"] { background: @panel; }
QToolTip { background: @raised; color: @text; border: 1px solid @border; padding: 4px 8px; }
)";

constexpr auto kButtons = R"(
QPushButton { background: @raised; border: 1px solid @border; border-radius: 4px; padding: 0 12px;
    min-height: 26px; font-weight: 500; qproperty-iconSize: 22px 16px; }
QPushButton:hover { background: @hovered; border-color: @muted; }
QPushButton:pressed { background: @sunken; }
QPushButton:checked { background: @selection; border-color: @accent; color: @accentText; }
QPushButton:disabled { background: @panel; border-color: @line; color: @disabled; }
QPushButton[look="primary"], QDialogButtonBox QPushButton:default { background: @accent; border-color: @accent; color: @onAccent; }
QPushButton[look="primary"]:hover, QDialogButtonBox QPushButton:default:hover { background: @accentHover; border-color: @accentHover; }
QPushButton[look="primary"]:pressed { background: @accentPressed; border-color: @accentPressed; }
QPushButton[look="primary"]:disabled, QDialogButtonBox QPushButton:default:disabled { background: @panel; border-color: @line; color: @disabled; }
QPushButton[look="danger"] { background: @danger; border-color: @danger; color: @onDanger; font-weight: 600; }
QPushButton[look="danger"]:hover { background: @dangerHover; border-color: @dangerHover; }
QPushButton[look="danger"]:pressed { background: @dangerPressed; border-color: @dangerPressed; }
QPushButton[look="latched"] { background: @panel; border: 2px solid @danger; color: @text; font-weight: 600; }
QPushButton[look="latched"]:hover { background: @hovered; }
QPushButton[look="hold"] { background: @raised; border: 2px solid @accent; color: @text; font-weight: 600; padding: 0 20px; }
QPushButton[look="hold"]:hover { background: @hovered; }
QPushButton[look="hold"]:disabled { background: @panel; border-color: @line; color: @disabled; }
QPushButton[look="flat"] { background: transparent; border-color: transparent; padding: 0 8px; color: @text; }
QPushButton[look="flat"]:hover { background: @hovered; border-color: transparent; }
QPushButton[look="flat"]:disabled { color: @disabled; }
QPushButton[look="row"] { background: transparent; border: 1px solid transparent; text-align: left; padding: 0; }
QPushButton[look="row"]:hover { background: @hovered; }
QPushButton[look="row"]:checked { background: @raised; border-color: @border; }
QPushButton[look="link"] { background: transparent; border: none; padding: 0; color: @accentText; text-align: left; }
QPushButton[look="link"]:hover { text-decoration: underline; }
QPushButton::menu-indicator { image: none; width: 0; }
QPushButton[look="segment"] { padding: 0 4px; }
QPushButton[look="color"] { padding: 0 8px 0 52px; text-align: left; font-weight: 400; }
QToolButton[look="section"] { font-weight: 600; padding: 2px 4px 2px 0; border: none; }
QToolButton[look="section"]:hover { background: transparent; color: @accentText; }
QToolButton[look="section"]:checked { background: transparent; color: @text; }
QPushButton[look="search"] { background: @sunken; border: 1px solid @line; color: @muted; font-weight: 400;
    text-align: left; padding: 0 4px; }
QPushButton[look="search"]:hover { border-color: @border; color: @text; }
QPushButton[look="status"] { background: transparent; border: none; border-radius: 4px; padding: 0 8px; min-height: 22px;
    color: @muted; font-weight: 400; }
QPushButton[look="status"]:hover { background: @hovered; color: @text; }
QToolButton { background: transparent; border: 1px solid transparent; border-radius: 4px; padding: 3px; min-height: 20px;
    min-width: 20px; font-weight: 500; }
QToolButton:hover { background: @hovered; }
QToolButton:pressed { background: @sunken; }
QToolButton:checked { background: @selection; color: @accentText; }
QToolButton:disabled { color: @disabled; }
QToolButton::menu-indicator { image: none; }
QToolButton[look="tab"] { border-radius: 0; border: none; border-top: 2px solid transparent;
    border-bottom: 2px solid transparent; padding: 0 12px; color: @muted; min-height: 34px; }
QToolButton[look="tab"]:hover { background: transparent; color: @text; }
QToolButton[look="tab"]:checked { background: transparent; color: @text; border-bottom: 2px solid @accent; }
QToolButton[look="title"] { padding: 1px; min-width: 16px; min-height: 16px; border: none; }
)";

constexpr auto kFields = R"(
QLineEdit, QPlainTextEdit, QTextEdit { background: @raised; border: 1px solid @border; border-radius: 4px;
    padding: 0 7px; min-height: 26px; selection-background-color: @selectionStrong; }
QLineEdit:hover { background: @hovered; }
QLineEdit[look="large"] { min-height: 34px; font-size: 14px; }
QLineEdit:focus, QPlainTextEdit:focus, QTextEdit:focus { border-color: @accent; background: @sunken; }
QLineEdit:disabled { background: @panel; border-color: @line; color: @disabled; }
QLineEdit:read-only { background: transparent; border-color: @line; }
QLineEdit[wrong="true"] { border: 1px solid @danger; background: @wrong; }
QComboBox QLineEdit, QAbstractSpinBox QLineEdit, QComboBox QLineEdit:focus, QAbstractSpinBox QLineEdit:focus,
QAbstractSpinBox QLineEdit:hover { background: transparent; border: none; padding: 0; min-height: 20px; }
QComboBox QAbstractItemView { background: @panel; border: 1px solid @border; padding: 4px; }
QCheckBox, QRadioButton { background: transparent; min-height: 24px; }
QCheckBox:disabled, QRadioButton:disabled { color: @disabled; }
QProgressBar { background: @track; border: none; border-radius: 2px; max-height: 4px; min-height: 4px; color: transparent; }
QProgressBar::chunk { background: @accent; border-radius: 2px; }
QAbstractItemView { background: @sunken; alternate-background-color: @panel; border: 1px solid @line; border-radius: 4px; }
QAbstractItemView::item { min-height: 24px; padding: 0 4px; border: none; border-radius: 3px; color: @text; }
QAbstractItemView::item:hover { background: @hovered; }
QAbstractItemView::item:selected { background: @selection; color: @text; }
QHeaderView { background: @panel; border: none; }
QHeaderView::section { background: @panel; color: @muted; border: none; border-bottom: 1px solid @line; padding: 4px 8px; }
QScrollArea, QScrollArea > QWidget > QWidget[look="column"] { background: transparent; border: none; }
QAbstractScrollArea::corner { background: transparent; }
QGroupBox { border: 1px solid @line; border-radius: 6px; margin-top: 16px; padding: 8px; }
QGroupBox::title { subcontrol-origin: margin; left: 8px; padding: 0 4px; color: @muted; }
)";

constexpr auto kFrames = R"(
QMenuBar { background: transparent; border: none; padding: 0; }
QMenuBar::item { background: transparent; color: @muted; padding: 6px 8px; border-radius: 4px; }
QMenuBar::item:selected, QMenuBar::item:pressed { background: @hovered; color: @text; }
QMenu { background: @panel; border: 1px solid @border; padding: 4px; }
QMenu::item { padding: 5px 24px 5px 8px; border-radius: 4px; min-width: 160px; }
QMenu::item:selected { background: @selection; }
QMenu::item:disabled { color: @disabled; }
QMenu::icon { padding-left: 8px; }
QMenu::separator { height: 1px; background: @line; margin: 4px 8px; }
QTabBar { background: transparent; qproperty-drawBase: 0; }
QTabBar::tab { background: transparent; color: @muted; padding: 6px 12px; border: none; border-bottom: 2px solid transparent; font-weight: 500; }
QTabBar::tab:hover { color: @text; }
QTabBar::tab:selected { color: @text; border-bottom: 2px solid @accent; }
QTabBar::tab:focus { color: @accentText; }
QTabWidget::pane { border: none; border-top: 1px solid @line; }
QDockWidget { background: @panel; }
QDockWidget > QWidget { background: @panel; }
QWidget#dockTitle { background: @panel; border-bottom: 1px solid @line; }
QWidget#dockTitle QLabel { color: @text; font-weight: 600; }
QWidget#topBar { background: @panel; border-bottom: 1px solid @line; }
QWidget#statusLine { background: @panel; border-top: 1px solid @line; }
QWidget#statusLine QLabel { color: @muted; }
QSplitter::handle { background: @window; }
QStatusBar { background: @panel; }
QFileDialog QToolButton { padding: 4px; }
)";

} // namespace

QString styleSheet(const Palette& palette) {
    const std::vector<std::pair<QString, QColor>> colors{
        {"@selectionStrong", blend(palette.panel, palette.accent, 0.4)},
        {"@selection", selectedColor(palette)},
        {"@accentHover", hoveredAccent(palette)},
        {"@accentPressed", blend(palette.accent, palette.window, 0.1)},
        {"@accentText", palette.accentText},
        {"@accent", palette.accent},
        {"@onAccent", palette.onAccent},
        {"@dangerHover", hoveredDanger(palette)},
        {"@dangerPressed", blend(palette.danger, palette.window, 0.25)},
        {"@danger", palette.danger},
        {"@onDanger", palette.onDanger},
        {"@warning", palette.warning},
        {"@window", palette.window},
        {"@wrong", blend(palette.panel, palette.danger, 0.15)},
        {"@panel", palette.panel},
        {"@raised", palette.raised},
        {"@hovered", palette.hovered},
        {"@sunken", palette.sunken},
        {"@track", blend(palette.panel, palette.border, 0.4)},
        {"@line", palette.line},
        {"@border", palette.border},
        {"@text", palette.text},
        {"@muted", palette.textMuted},
        {"@disabled", disabledText(palette)},
    };
    QString sheet = QString(kBoxes) + kButtons + kFields + kFrames;
    for (const auto& [token, color] : colors) sheet.replace(token, color.name());
    return sheet;
}

} // namespace lumorph::studio
