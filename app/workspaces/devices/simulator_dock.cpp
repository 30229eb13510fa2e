#include <algorithm>
#include <cmath>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QTimer>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/devices/devices_docks.h"
#include "app/workspaces/devices/horn_view.h"
#include "core/base/error.h"
#include "devices/controllers/controller_kinds.h"
#include "devices/simulator/simulated_bench.h"
#include "devices/transport/address.h"

namespace lumorph::studio {
namespace {

constexpr int kTruthMilliseconds = 40;

class SimulatorDock : public QWidget {
public:
    explicit SimulatorDock(Studio& studio) : studio_(studio), boards_(new QComboBox), horns_(new HornView) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        const Column column = makeColumn(this);
        layout->addWidget(column.widget);
        QVBoxLayout& rows = *column.layout;
        auto* what = new QLabel("A board to break on purpose. See in the middle and in the log what the studio makes "
                                "of it.");
        what->setProperty("look", "muted");
        what->setWordWrap(true);
        rows.addWidget(what);
        boards_->setObjectName("sim.board");
        for (const std::string& name : studio.devices.bench().names()) boards_->addItem(QString::fromStdString(name));
        rows.addWidget(makeRow("&Board", boards_));
        addSwitches(rows);
        addHand(rows);
        addSliders(rows);
        addTruth(rows);
        connect(boards_, &QComboBox::currentIndexChanged, this, [this] { showFaults(); });
        connect(&studio.devices, &DeviceService::profileChanged, this, [this] { followLink(); });
        timer_.setInterval(kTruthMilliseconds);
        connect(&timer_, &QTimer::timeout, this, [this] { showTruth(); });
        followLink();
        showFaults();
    }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        timer_.start();
        showTruth();
    }
    void hideEvent(QHideEvent* event) override {
        timer_.stop();
        QWidget::hideEvent(event);
    }

private:
    struct Switch {
        const char* name;
        const char* text;
        const char* tip;
        bool BoardFaults::*fault;
        const char* done;   ///< "unplugged"
        const char* undone; ///< "plugged in again"
    };
    struct Slider {
        const char* name;
        const char* text;
        const char* tip;
        double BoardFaults::*fault;
        double least, most, step;
        const char* unit;
        double shown; ///< of one unit
        int digits;
    };
    static constexpr Switch kSwitches[] = {
        {"sim.unplugged", "Unplugged", "As if somebody pulled the cable", &BoardFaults::unplugged, "unplugged",
         "plugged in again"},
        {"sim.silent", "Silent", "It is there, but answers nothing", &BoardFaults::silent, "made silent",
         "made to answer again"},
        {"sim.busy", "Busy", "Another program has its port", &BoardFaults::busy, "taken by another program",
         "free again"},
        {"sim.forbidden", "Forbidden", "This user may not open its port", &BoardFaults::forbidden, "forbidden",
         "allowed again"},
        {"sim.nameless", "Nameless", "Its adapter does not say what is behind it; heeded when it is connected anew",
         &BoardFaults::nameless, "without a name", "named again"},
        {"sim.stalled", "Stalled", "The link takes bytes, but passes nothing on", &BoardFaults::stalled, "stalled",
         "flowing again"},
    };
    static constexpr Slider kSliders[] = {
        {"sim.volts", "&Battery", "Voltage of its battery", &BoardFaults::volts, 4.0, 9.0, 0.1, " V", 1.0, 1},
        {"sim.noise", "&Noise", "Share of the bytes that arrive broken", &BoardFaults::noise, 0.0, 0.2, 0.001, " %",
         100.0, 1},
        {"sim.drop", "&Drop", "Share of the bytes that are lost", &BoardFaults::drop, 0.0, 0.2, 0.001, " %", 100.0, 1},
        {"sim.jitter", "&Jitter", "By how much messages are late, now and then", &BoardFaults::jitterMilliseconds, 0.0,
         200.0, 1.0, " ms", 1.0, 0},
    };

    [[nodiscard]] std::shared_ptr<SimulatedBoard> board() const {
        return studio_.devices.bench().board(boards_->currentText().toStdString());
    }

    void change(const std::function<void(BoardFaults&)>& edit) {
        const auto chosen = board();
        if (!chosen) return;
        BoardFaults faults = chosen->faults();
        edit(faults);
        chosen->setFaults(faults);
    }

    void tell(const QString& what) {
        studio_.devices.note("Simulator: the " + boards_->currentText() + " is " + what + '.');
    }

    void addSwitches(QVBoxLayout& rows) {
        rows.addWidget(makeHeading("Break it"));
        for (const Switch& one : kSwitches) {
            auto* box = new QCheckBox(one.text);
            box->setObjectName(one.name);
            box->setToolTip(one.tip);
            connect(box, &QCheckBox::clicked, this, [this, &one](bool on) {
                tell(on ? one.done : one.undone);
                change([&one, on](BoardFaults& faults) { faults.*one.fault = on; });
            });
            rows.addWidget(box);
            switches_.push_back(box);
        }
        auto* reboot = new QPushButton("Restart it");
        reboot->setObjectName("sim.reboot");
        reboot->setToolTip("As after a moment without power: servos go limp, and the board starts anew");
        connect(reboot, &QPushButton::clicked, this, [this] {
            tell("restarted");
            if (const auto chosen = board()) chosen->reboot();
        });
        auto* mend = new QPushButton("Mend all");
        mend->setObjectName("sim.mend");
        mend->setToolTip("Takes back all that was broken here");
        connect(mend, &QPushButton::clicked, this, [this] {
            tell("whole again");
            change([](BoardFaults& faults) { faults = BoardFaults{}; });
            showFaults();
        });
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        row->addWidget(reboot, 1);
        row->addWidget(mend, 1);
        rows.addLayout(row);
    }

    void addSliders(QVBoxLayout& rows) {
        rows.addWidget(makeHeading("Wear it down"));
        for (const Slider& one : kSliders) {
            auto* control = new QWidget;
            auto* row = new QHBoxLayout(control);
            row->setContentsMargins(0, 0, 0, 0);
            row->setSpacing(8);
            auto* slider = new QSlider(Qt::Horizontal);
            slider->setObjectName(one.name);
            slider->setRange(0, static_cast<int>(std::lround((one.most - one.least) / one.step)));
            slider->setToolTip(one.tip);
            auto* value = makeNumber(QString(one.name) + ".value", "100.0 %", control);
            row->addWidget(slider, 1);
            row->addWidget(value);
            connect(slider, &QSlider::valueChanged, this, [this, &one, value](int steps) {
                const double now = one.least + steps * one.step;
                value->setText(QString::number(now * one.shown, 'f', one.digits) + one.unit);
                change([&one, now](BoardFaults& faults) { faults.*one.fault = now; });
            });
            control->setFocusProxy(slider);
            rows.addWidget(makeRow(one.text, control));
            slider->setAccessibleName(QString(one.text).remove('&'));
            sliders_.push_back(slider);
            values_.push_back(value);
        }
    }

    void addHand(QVBoxLayout& rows) {
        hand_ = new QComboBox;
        hand_->setObjectName("sim.held");
        hand_->setToolTip("As if a hand held the horn of one servo: it does not move, whatever it is told");
        connect(hand_, &QComboBox::activated, this, [this](int index) {
            if (index == 0)
                studio_.devices.note("Simulator: nobody holds a servo of the " + boards_->currentText() + '.');
            else
                tell("held at " + hand_->itemText(index));
            change([index](BoardFaults& faults) {
                faults.held.reset();
                if (index > 0) faults.held = static_cast<std::size_t>(index - 1);
            });
        });
        rows.addWidget(makeRow("&Held", hand_));
    }

    void showHand(const SimulatedBoard& chosen) {
        const int first = firstChannel(likelyController("sim://" + chosen.name()));
        hand_->clear();
        hand_->addItem("by nobody");
        for (std::size_t k = 0; k < chosen.servos().size(); ++k)
            hand_->addItem(QString("channel %1").arg(first + static_cast<int>(k)));
        hand_->setCurrentIndex(chosen.faults().held ? static_cast<int>(*chosen.faults().held) + 1 : 0);
    }

    void addTruth(QVBoxLayout& rows) {
        rows.addWidget(makeHeading("What its servos really do"));
        rows.addWidget(horns_);
        extremes_ = new QLabel;
        extremes_->setObjectName("sim.extremes");
        extremes_->setProperty("look", "muted");
        extremes_->setWordWrap(true);
        rows.addWidget(extremes_);
    }

    /// The board that is connected is the one to break.
    void followLink() {
        try {
            const DeviceAddress address = parseDeviceAddress(studio_.devices.profile().address);
            if (const auto* simulated = std::get_if<SimulatedAddress>(&address))
                boards_->setCurrentText(QString::fromStdString(simulated->device));
        } catch (const InvalidInput&) {
            return; // none is chosen yet
        }
    }

    void showFaults() {
        const auto chosen = board();
        if (!chosen) return;
        const BoardFaults faults = chosen->faults();
        for (std::size_t k = 0; k < switches_.size(); ++k) switches_[k]->setChecked(faults.*kSwitches[k].fault);
        for (std::size_t k = 0; k < sliders_.size(); ++k) {
            const Slider& one = kSliders[k];
            const QSignalBlocker quiet(sliders_[k]);
            const double value = faults.*one.fault;
            sliders_[k]->setValue(static_cast<int>(std::lround((value - one.least) / one.step)));
            values_[k]->setText(QString::number(value * one.shown, 'f', one.digits) + one.unit);
        }
        showHand(*chosen);
        showTruth();
    }

    void showTruth() {
        const auto chosen = board();
        if (!chosen) return;
        std::vector<int> channels;
        for (const ServoSetup& servo : studio_.devices.profile().servos) channels.push_back(servo.channel);
        const int first = firstChannel(likelyController("sim://" + boards_->currentText().toStdString()));
        const std::vector<SimulatedServo> servos = chosen->servos();
        double fastest = 0.0, jump = 0.0;
        for (const SimulatedServo& servo : servos) {
            fastest = std::max(fastest, servo.fastest);
            jump = std::max(jump, servo.largestJump);
        }
        extremes_->setText(QString("Fastest pulse so far %1 µs a second; largest jump at a start %2 µs.")
                               .arg(fastest, 0, 'f', 0)
                               .arg(jump, 0, 'f', 0));
        horns_->show(servos, channels, first);
    }

    Studio& studio_;
    QComboBox* boards_;
    QComboBox* hand_ = nullptr;
    HornView* horns_;
    QLabel* extremes_ = nullptr;
    std::vector<QCheckBox*> switches_;
    std::vector<QSlider*> sliders_;
    std::vector<QLabel*> values_;
    QTimer timer_;
};

} // namespace

QWidget* makeSimulatorDock(Studio& studio) { return new SimulatorDock(studio); }

} // namespace lumorph::studio
