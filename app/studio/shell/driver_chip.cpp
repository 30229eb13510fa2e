#include "app/studio/shell/driver_chip.h"

#include <array>
#include <map>
#include <utility>

#include <QHBoxLayout>
#include <QMenu>
#include <QPushButton>
#include <QStyle>
#include <QTimer>

#include "app/studio/look/icons.h"

namespace lumorph::studio {
namespace {

constexpr int kLitMilliseconds = 4000;
constexpr int kChipTextWidth = 150;
constexpr int kIconGap = 6;

struct DriverCommand {
    Driver driver;
    const char* id;
    const char* words; ///< what the servos do
};

constexpr std::array<DriverCommand, 6> kCommands = {
    {{Driver::target, "drive.target", "Servos follow the target"},
     {Driver::sceneItem, "drive.sceneItem", "Servos follow the scene's item"},
     {Driver::hand, "drive.hand", "Servos are moved by hand"},
     {Driver::dance, "drive.dance", "Servos dance"},
     {Driver::recording, "drive.recording", "Servos follow the recording"},
     {Driver::program, "drive.program", "Servos follow the show program"}}};

/// The commands as they stand: one object that follows the studio, a child of its commands.
class DriverCommands : public QObject {
public:
    explicit DriverCommands(Studio& studio) : QObject(&studio.commands), studio_(studio) {
        for (const DriverCommand& command : kCommands) add(command);
        Commands::Options options;
        options.icon = "undo";
        back_ = studio.commands.add("drive.back", "Servos back to who moved them before", options,
                                    [&studio] { studio.driver.back(); });
        connect(&studio.driver, &DriverControl::changed, this, &DriverCommands::follow);
        connect(&studio.document, &StudioDocument::changed, this, &DriverCommands::follow);
        follow();
    }

private:
    void add(const DriverCommand& command) {
        Commands::Options options;
        options.icon = DriverControl::iconOf(command.driver);
        options.checkable = true;
        actions_[command.driver] =
            studio_.commands.add(command.id, command.words, options, [this, driver = command.driver] {
                studio_.driver.choose(driver);
                follow(); // what was chosen already stays checked
            });
    }

    void follow() {
        const DriverControl& driver = studio_.driver;
        for (const DriverCommand& command : kCommands) {
            QAction* action = actions_.at(command.driver);
            const QString why = driver.whyNot(command.driver);
            const bool named = why.isEmpty() && command.driver != Driver::hand && command.driver != Driver::dance &&
                               command.driver != Driver::program;
            action->setText(QString(command.words) + (named ? " '" + driver.nameOf(command.driver) + '\'' : QString()));
            action->setToolTip(why.isEmpty() ? action->text() : why);
            action->setEnabled(why.isEmpty());
            action->setChecked(command.driver == driver.driver());
        }
        const auto before = driver.before();
        back_->setEnabled(before.has_value());
        back_->setText(before ? "Servos back to " + driver.nameOf(*before) : "Servos back to who moved them before");
    }

    Studio& studio_;
    std::map<Driver, QAction*> actions_;
    QAction* back_ = nullptr;
};

void relookChip(QWidget& widget, const char* look) {
    if (widget.property("look").toString() == look) return;
    widget.setProperty("look", look);
    widget.style()->unpolish(&widget);
    widget.style()->polish(&widget);
}

} // namespace

void addDriverCommands(Studio& studio) { new DriverCommands(studio); }

DriverChip::DriverChip(Studio& studio, QWidget* parent)
    : QWidget(parent), studio_(studio), chip_(new QPushButton(this)), back_(new QPushButton(this)),
      lit_(new QTimer(this)) {
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    chip_->setObjectName("bar.driver");
    back_->setObjectName("bar.driver.back");
    back_->setIcon(icon("undo"));
    row->addWidget(back_);
    row->addWidget(chip_);
    auto* menu = new QMenu(chip_);
    menu->setObjectName("bar.driver.menu");
    menu->setToolTipsVisible(true);
    for (const DriverCommand& command : kCommands) menu->addAction(studio.commands.find(command.id));
    chip_->setMenu(menu);
    connect(back_, &QPushButton::clicked, studio.commands.find("drive.back"), &QAction::trigger);
    connect(&studio.driver, &DriverControl::changed, this, &DriverChip::refresh);
    connect(&studio.driver, &DriverControl::tookOver, this, &DriverChip::light);
    connect(&studio.document, &StudioDocument::changed, this, &DriverChip::refresh);
    lit_->setSingleShot(true);
    lit_->setInterval(kLitMilliseconds);
    connect(lit_, &QTimer::timeout, this, &DriverChip::refresh);
    refresh();
}

void DriverChip::setNarrow(bool narrow) {
    if (std::exchange(narrow_, narrow) != narrow) refresh();
}

void DriverChip::light() {
    lit_->start();
    refresh();
}

void DriverChip::refresh() {
    const DriverControl& control = studio_.driver;
    const Driver driver = control.driver();
    const QString still = control.whyStill();
    const QString name = control.nameOf(driver);
    const QString words = still.isEmpty() ? tr("Servos: %1").arg(name) : tr("Servos hold");
    chip_->setIcon(icon(DriverControl::iconOf(driver), lit_->isActive()  ? IconRole::onAccent
                                                       : still.isEmpty() ? IconRole::control
                                                                         : IconRole::warning));
    wordsWidth_ = 0;
    const auto say = [this](QPushButton* button, const QString& text) {
        const QString fits = button->fontMetrics().elidedText(text, Qt::ElideRight, kChipTextWidth);
        button->setText(narrow_ ? QString() : fits);
        wordsWidth_ += button->fontMetrics().horizontalAdvance(fits) + kIconGap;
    };
    say(chip_, words);
    const QString who = tr("%1 '%2' moves the servos.").arg(DriverControl::kindOf(driver), name);
    chip_->setToolTip(still.isEmpty() ? who : still);
    chip_->setAccessibleName(tr("Who moves the servos: %1").arg(still.isEmpty() ? name : still));
    relookChip(*chip_, lit_->isActive() ? "primary" : "");
    const auto before = control.before();
    back_->setVisible(before.has_value());
    if (!before) return;
    const QString way = tr("Back to %1").arg(control.nameOf(*before));
    say(back_, way);
    back_->setToolTip(tr("%1 moves the servos again").arg(control.nameOf(*before)));
}

} // namespace lumorph::studio
