#include "app/workspaces/devices/servo_board.h"

#include <utility>

#include <QCheckBox>
#include <QStyle>
#include <QTimer>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/common/step_card.h"
#include "app/workspaces/devices/device_facts.h"
#include "app/workspaces/devices/servo_row.h"
#include "app/workspaces/devices/start_panel.h"

namespace lumorph::studio {
namespace {

/// What went wrong this long ago still belongs to the state of things.
constexpr qint64 kLatelySeconds = 20;
constexpr int kMarksMilliseconds = 100;
constexpr int kStartHeight = 190; ///< so that the servos stay in sight

QString lately(const DeviceService& service) {
    const bool live = service.status().phase == LinkPhase::live;
    for (const DeviceLogLine& line : service.log()) {
        if (line.time.secsTo(QDateTime::currentDateTime()) > kLatelySeconds) break;
        if (live && line.time < service.liveSince()) break; // over and done
        if (line.aside) continue;
        if (live && line.kind == LinkEvent::Kind::information) break; // it went well after that
        if (line.kind != LinkEvent::Kind::information)
            return live && !line.remedy.isEmpty() ? line.text + ' ' + line.remedy : line.text; // it is mended else
    }
    return {};
}

class ServoBoard : public QWidget {
public:
    ServoBoard(Studio& studio, ServoSelection& selection)
        : studio_(studio), selection_(selection), card_(new StepCard("devices.card", "device", this)),
          facts_(new DeviceFacts(this)) {
        setObjectName("devices.board");
        setProperty("look", "panel");
        setAttribute(Qt::WA_StyledBackground);
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(16, 8, 16, 8);
        layout->setSpacing(6);
        layout->addWidget(card_);
        start_ = new StartPanel(studio, DeviceService::StartBy::show, this);
        start_->setMaximumHeight(kStartHeight);
        start_->hide();
        layout->addWidget(start_);
        layout->addWidget(makeHint());
        layout->addWidget(makeStrokeLegend(this));
        rows_ = makeColumn(this);
        rows_.layout->setContentsMargins(0, 0, 0, 0);
        rows_.layout->setSpacing(4);
        rows_.layout->setAlignment({}); // rows take what height there is, up to their most
        layout->addWidget(rows_.widget, 1);
        layout->addWidget(makeHands());
        layout->addWidget(facts_);
        card_->setButtonHint("The next step (Ctrl+Return)");
        connect(card_, &StepCard::nextWanted, studio.commands.find("device.next"), &QAction::trigger);
        connect(&studio.devices, &DeviceService::changed, this, [this] { refresh(); });
        connect(&studio.devices, &DeviceService::startAsked, this, [this] {
            if (start_->isVisible()) start_->focusButton();
        });
        // The show goes on without a board, and its marks with it.
        marks_.setInterval(kMarksMilliseconds);
        connect(&marks_, &QTimer::timeout, this, [this] {
            if (isVisible()) showServos();
        });
        marks_.start();
        connect(&studio.devices, &DeviceService::foundChanged, this, [this] { refresh(); });
        connect(&studio.devices, &DeviceService::logged, this, [this] { refresh(); });
        connect(&studio.devices, &DeviceService::profileChanged, this, [this] { rebuild(); });
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & (StatePart::rig | StatePart::rigEdited)) rebuild();
        });
        connect(&selection, &ServoSelection::changed, this, [this] { refresh(); });
        connect(&selection, &ServoSelection::assigningChanged, this, [this] { refresh(); });
        rebuild();
    }

private:
    /// Says what a click on a row does while channels are assigned, or that a servo is held for a test.
    QWidget* makeHint() {
        hint_ = new QWidget(this);
        hint_->setObjectName("devices.hint");
        hintText_ = new QLabel(hint_);
        hintText_->setObjectName("devices.hint.text");
        hintText_->setProperty("look", "warning");
        hintText_->setWordWrap(true);
        hintEnd_ = new QPushButton(hint_);
        hintEnd_->setObjectName("devices.hint.end");
        auto* row = new QHBoxLayout(hint_);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(8);
        row->addWidget(hintText_, 1);
        row->addWidget(hintEnd_);
        connect(hintEnd_, &QPushButton::clicked, this, [this] {
            if (selection_.assigning())
                selection_.assign(std::nullopt);
            else
                studio_.devices.endTest();
        });
        return hint_;
    }

    QWidget* makeHands() {
        auto* hands = new QWidget(this);
        handsText_ = new QLabel(hands);
        handsText_->setObjectName("devices.hands");
        handsText_->setToolTip("Servos are slow while a tracked hand is nearer than the set-up says, or while a servo "
                               "that is read back does not follow.\nWhere nothing senses hands, make it slow, or "
                               "press STOP, before you reach in.");
        auto* slow = new QCheckBox("Slow", hands);
        slow->setObjectName("devices.slow");
        QAction* command = studio_.commands.find("device.slow");
        slow->setToolTip(command->toolTip());
        connect(slow, &QCheckBox::clicked, command, &QAction::trigger);
        connect(command, &QAction::changed, slow, [slow, command] { slow->setChecked(command->isChecked()); });
        auto* row = new QHBoxLayout(hands);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(16);
        row->addWidget(handsText_);
        row->addWidget(slow);
        row->addStretch(1);
        row->addWidget(makeCommandButton(studio_.commands.find("device.release"), "devices.release", hands));
        return hands;
    }

    void rebuild() {
        const QStringList names = servoNamesOf(studio_);
        if (names == names_) return refresh();
        const bool sameCount = names.size() == names_.size(); // renamed, most likely
        names_ = names;
        list_.clear();
        while (QLayoutItem* item = rows_.layout->takeAt(0)) {
            delete item->widget();
            delete item;
        }
        for (qsizetype k = 0; k < names.size(); ++k) addRow(static_cast<std::size_t>(k));
        rows_.layout->addStretch(1);
        if (!sameCount) selection_.select(names.isEmpty() ? std::nullopt : std::optional<std::size_t>(0));
        refresh();
    }

    void addRow(std::size_t servo) {
        auto* row = new ServoRow(servo, names_[static_cast<qsizetype>(servo)], rows_.layout->parentWidget());
        rows_.layout->addWidget(row);
        list_.push_back(row);
        connect(row, &ServoRow::clicked, this, [this, servo] { choose(servo); });
        connect(row, &ServoRow::wiggled, this, [this, servo] { studio_.devices.wiggle(servo); });
    }

    void choose(std::size_t servo) {
        if (const auto wiggling = selection_.assigning()) {
            selection_.assign(std::nullopt);
            exchangeChannels(*wiggling, servo);
        }
        selection_.select(servo);
        refresh();
    }

    /// The one that moved has the channel that wiggled.
    void exchangeChannels(std::size_t wiggled, std::size_t moved) {
        DeviceProfile profile = studio_.devices.profile();
        if (wiggled == moved || std::max(wiggled, moved) >= profile.servos.size()) return;
        std::swap(profile.servos[wiggled].channel, profile.servos[moved].channel);
        if (studio_.devices.setProfile(profile, "Exchange the channels of " + servoName(names_, wiggled) + " and " +
                                                    servoName(names_, moved)))
            studio_.devices.note(
                QString("%1 has channel %2 now.").arg(servoName(names_, moved)).arg(profile.servos[moved].channel));
    }

    void refresh() {
        const DeviceService& service = studio_.devices;
        const DeviceCard card = cardOf(deviceViewOf(studio_));
        card_->show({card.tone, card.title, card.text, card.button, false});
        start_->setVisible(card.starts());
        facts_->show(service.status(), service.stopKeysProblem());
        showHands(service.hands());
        showServos();
        showHint();
    }

    void showServos() {
        const DeviceService& service = studio_.devices;
        const std::vector<double> wanted = service.wanted();
        const auto& setups = service.profile().servos;
        for (std::size_t k = 0; k < list_.size() && k < setups.size(); ++k) {
            list_[k]->show(service.status(), setups[k], service.tested(k).has_value(),
                           k < wanted.size() ? wanted[k] : 0.0);
            list_[k]->setChecked(selection_.servo() == k);
        }
    }

    void showHands(const HandSense& hands) {
        handsText_->setText(handsText(hands, names_));
        const QString look = hands.near || !hands.held.empty() ? "warning" : "";
        if (handsText_->property("look").toString() == look) return;
        handsText_->setProperty("look", look);
        handsText_->style()->unpolish(handsText_);
        handsText_->style()->polish(handsText_);
    }

    void showHint() {
        const auto assigning = selection_.assigning();
        hint_->setVisible(assigning || studio_.devices.testing());
        hintText_->setText(assigning ? QString("Channel %1 wiggles. Click the row of the servo that really moved.")
                                           .arg(channelOf(*assigning))
                           : anyTested() ? QString("Held for a test: it does not follow the show.")
                                         : QString("On the way to the show, slowly."));
        hintEnd_->setVisible(assigning || anyTested());
        hintEnd_->setText(assigning ? "Leave it" : "Follow the show");
    }

    [[nodiscard]] bool anyTested() const {
        for (std::size_t k = 0; k < list_.size(); ++k)
            if (studio_.devices.tested(k)) return true;
        return false;
    }

    [[nodiscard]] int channelOf(std::size_t servo) const {
        const auto& servos = studio_.devices.profile().servos;
        return servo < servos.size() ? servos[servo].channel : 0;
    }

    Studio& studio_;
    ServoSelection& selection_;
    StepCard* card_;
    DeviceFacts* facts_;
    StartPanel* start_ = nullptr;
    QTimer marks_;
    QWidget* hint_ = nullptr;
    QLabel* hintText_ = nullptr;
    QLabel* handsText_ = nullptr;
    QPushButton* hintEnd_ = nullptr;
    Column rows_;
    std::vector<ServoRow*> list_;
    QStringList names_;
};

} // namespace

QStringList servoNamesOf(Studio& studio) {
    QStringList names;
    if (const auto& rig = studio.document.state().rig.rig)
        for (const Actuator& actuator : rig->actuators()) names << QString::fromStdString(actuator.name);
    return names;
}

DeviceView deviceViewOf(Studio& studio) {
    const DeviceService& service = studio.devices;
    DeviceView view;
    view.rig = studio.document.state().rig.rig != nullptr;
    view.link = service.status();
    view.name = service.name();
    view.address = QString::fromStdString(service.profile().address);
    view.stopped = studio.loop.stopped();
    view.lately = lately(service);
    view.servos = servoNamesOf(studio);
    return view;
}

QWidget* makeServoBoard(Studio& studio, ServoSelection& selection) { return new ServoBoard(studio, selection); }

} // namespace lumorph::studio
