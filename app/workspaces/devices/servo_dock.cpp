#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QSignalBlocker>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/devices/devices_docks.h"
#include "app/workspaces/devices/profile_edit.h"
#include "app/workspaces/devices/servo_board.h"

namespace lumorph::studio {
namespace {

namespace limits = profile_limits;

constexpr double kLeastSpan = 50.0; // microseconds
constexpr int kMostChannel = 253;

/// "Least" of "&Least (µs)".
QString nameOfLabel(const QString& label) { return QString(label).remove('&').section(" (", 0, 0); }

class ServoDock : public QWidget {
public:
    ServoDock(Studio& studio, ServoSelection& selection)
        : studio_(studio), selection_(selection), pages_(new QStackedWidget(this)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeNoticeBar(studio.notices, "servo"));
        layout->addWidget(pages_, 1);
        pages_->addWidget(
            makeEmptyState("actuator", "No servo chosen", "Click a servo in the middle to set it up.", nullptr, this));
        pages_->addWidget(makeContents());
        connect(&selection, &ServoSelection::changed, this, [this] { refresh(); });
        connect(&studio.devices, &DeviceService::profileChanged, this, [this] { refresh(); });
        connect(&studio.devices, &DeviceService::changed, this, [this] { refreshTests(); });
        refresh();
    }

private:
    using Setup = double ServoSetup::*;

    QWidget* makeContents() {
        const Column column = makeColumn(this);
        QVBoxLayout& rows = *column.layout;
        title_ = new QLabel;
        title_->setObjectName("servo.title");
        title_->setProperty("look", "title");
        title_->setTextFormat(Qt::PlainText);
        title_->setWordWrap(true);
        rows.addWidget(title_);
        addChannel(rows);
        addLimits(rows);
        addTests(rows);
        addProfile(rows);
        return column.widget;
    }

    void addChannel(QVBoxLayout& rows) {
        channel_ = new ValueField(Quantity::level, 0, kMostChannel, 0, this);
        channel_->setObjectName("servo.channel");
        channel_->setToolTip(
            "The channel of the controller, or the pin of an Arduino, that this servo is plugged into");
        channel_->setRefusing(true);
        connect(channel_, &ValueField::committed, this, [this](double value) { setChannel(value); });
        connect(channel_, &ValueField::refused, this, [this](const QString& why) { refuse("Channel", why); });
        rows.addWidget(makeRow("&Channel", channel_));
        assign_ = new QPushButton("Wiggle it to find out");
        assign_->setObjectName("servo.assign");
        assign_->setToolTip("Wiggles this channel; then click the row of the servo that really moved");
        connect(assign_, &QPushButton::clicked, this, [this] {
            const auto servo = selection_.servo();
            if (!servo) return;
            studio_.devices.wiggle(*servo);
            selection_.assign(servo);
        });
        rows.addWidget(assign_);
    }

    ValueField* addNumber(QVBoxLayout& rows, const QString& label, const char* name, const QString& tip, Setup member,
                          double least, double most, double step, Quantity quantity = Quantity::plain) {
        auto* field = new ValueField(quantity, least, most, ServoSetup{}.*member, this);
        field->setObjectName(name);
        field->setToolTip(tip);
        field->setStep(step);
        field->setRefusing(true);
        const QString what = nameOfLabel(label);
        const auto set = [member](double value) { return [member, value](ServoSetup& one) { one.*member = value; }; };
        connect(field, &ValueField::refused, this, [this, what](const QString& why) { refuse(what, why); });
        connect(field, &ValueField::previewed, this, [this, set](double value) { edit_.preview(edited(set(value))); });
        connect(field, &ValueField::committed, this, [this, set, what](double value) { edit(what, set(value)); });
        connect(field, &ValueField::reverted, this, [this] { edit_.revert(); });
        rows.addWidget(makeRow(label, field));
        numbers_.push_back({field, member});
        return field;
    }

    void addLimits(QVBoxLayout& rows) {
        rows.addWidget(makeHeading("Pulse"));
        least_ = addNumber(rows, "&Least (µs)", "servo.pulseMin", "No shorter pulse is ever sent; in force at once",
                           &ServoSetup::pulseMin, limits::kPulse.least, limits::kPulse.most, 10.0);
        most_ = addNumber(rows, "&Most (µs)", "servo.pulseMax", "No longer pulse is ever sent; in force at once",
                          &ServoSetup::pulseMax, limits::kPulse.least, limits::kPulse.most, 10.0);
        trim_ = addNumber(rows, "&Trim (µs)", "servo.trim", "Added to every pulse, within least and most",
                          &ServoSetup::trim, 0.0, 0.0, 5.0);
        reversed_ = new QCheckBox("Turns the other way");
        reversed_->setObjectName("servo.reversed");
        reversed_->setToolTip("Rest is at the longest pulse. The servo lets go, and is started again.");
        connect(reversed_, &QCheckBox::clicked, this,
                [this](bool on) { edit("Direction", [on](ServoSetup& servo) { servo.reversed = on; }); });
        rows.addWidget(reversed_);
        rows.addWidget(makeHeading("Speed"));
        addNumber(rows, "&Velocity (strokes/s)", "servo.velocity", "At most so many full strokes a second",
                  &ServoSetup::maxVelocity, limits::kVelocity.least, limits::kVelocity.most, 0.1);
        addNumber(rows, "&Acceleration (strokes/s²)", "servo.acceleration",
                  "At most so much faster or slower, in strokes a second, each second", &ServoSetup::maxAcceleration,
                  limits::kAcceleration.least, limits::kAcceleration.most, 0.5);
        addNumber(rows, "At the &end", "servo.exit",
                  "Where it rests when the link ends, if the set-up wants it to rest", &ServoSetup::exitStroke, 0.0,
                  1.0, 0.05, Quantity::share);
    }

    void addTests(QVBoxLayout& rows) {
        rows.addWidget(makeHeading("Try it slowly"));
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        const struct {
            const char* name;
            const char* text;
            double stroke;
        } tests[] = {{"servo.rest", "Rest", 0.0}, {"servo.middle", "Middle", 0.5}, {"servo.full", "Full", 1.0}};
        for (const auto& test : tests) {
            auto* button = new QPushButton(test.text);
            button->setObjectName(test.name);
            button->setCheckable(true);
            button->setToolTip("Moves this servo there at a quarter of a stroke a second, and keeps it there");
            connect(button, &QPushButton::clicked, this, [this, stroke = test.stroke] {
                if (const auto servo = selection_.servo()) studio_.devices.test(*servo, stroke);
                refreshTests();
            });
            row->addWidget(button, 1);
            tests_.push_back({button, test.stroke});
        }
        rows.addLayout(row);
        follow_ = new QPushButton("Follow the show");
        follow_->setObjectName("servo.follow");
        connect(follow_, &QPushButton::clicked, this, [this] { studio_.devices.endTest(); });
        rows.addWidget(follow_);
        testNote_ = new QLabel("The servo must be live for this.");
        testNote_->setProperty("look", "muted");
        testNote_->setWordWrap(true);
        rows.addWidget(testNote_);
    }

    void addProfile(QVBoxLayout& rows) {
        rows.addWidget(makeHeading("Profile"));
        profiles_ = new QComboBox;
        profiles_->setObjectName("servo.profiles");
        profiles_->setToolTip("All of this is kept by itself under this name. Choose another one to load it.");
        connect(profiles_, &QComboBox::textActivated, this,
                [this](const QString& name) { studio_.devices.loadProfile(name); });
        rows.addWidget(makeRow("&Loaded", profiles_));
        name_ = new QLineEdit;
        name_->setObjectName("servo.profileName");
        name_->setPlaceholderText("New name");
        name_->setAccessibleName("Name of the profile");
        auto* save = new QPushButton("Save as");
        save->setObjectName("servo.saveProfile");
        save->setToolTip("Keeps all servos' set-up under this name, and goes on with it");
        const auto saveAs = [this] {
            if (name_->text().trimmed().isEmpty()) return name_->setFocus();
            studio_.devices.saveProfileAs(name_->text());
            name_->clear();
        };
        connect(save, &QPushButton::clicked, this, saveAs);
        connect(name_, &QLineEdit::returnPressed, this, saveAs);
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        row->addWidget(name_, 1);
        row->addWidget(save);
        rows.addLayout(row);
        auto* reset = new QPushButton("As the rig's file says");
        reset->setObjectName("servo.resetProfile");
        reset->setToolTip("Sets all servos as the rig's own file describes its drives");
        connect(reset, &QPushButton::clicked, this, [this] { studio_.devices.resetProfile(); });
        rows.addWidget(reset);
    }

    using Edit = std::function<void(ServoSetup&)>;
    [[nodiscard]] DeviceProfile edited(const Edit& change) const {
        DeviceProfile profile = studio_.devices.profile();
        const auto servo = selection_.servo();
        if (servo && *servo < profile.servos.size()) change(profile.servos[*servo]);
        return profile;
    }
    void edit(const QString& what, const Edit& change) {
        if (const auto servo = selection_.servo()) edit_.keep(edited(change), what + " of " + nameOf(*servo));
        refresh();
    }
    [[nodiscard]] QString nameOf(std::size_t servo) const { return servoName(servoNamesOf(studio_), servo); }

    /// Nothing is set to another value than the one that was meant.
    void refuse(const QString& what, const QString& why, const QString& remedy = {},
                std::vector<Notice::Action> actions = {}) {
        const auto servo = selection_.servo();
        if (!servo) return;
        studio_.notices.dismissAll("servo");
        studio_.notices.post("servo",
                             {Notice::Level::warning, what + " of " + nameOf(*servo), why, remedy, std::move(actions)});
        refresh();
    }

    void setChannel(double value) {
        const auto servo = selection_.servo();
        if (!servo) return;
        if (value != std::floor(value))
            return refuse("Channel",
                          "A channel is a whole number, and " + formatQuantity(value, Quantity::plain) + " is none");
        const int channel = static_cast<int>(value);
        const auto& servos = studio_.devices.profile().servos;
        const auto twin = std::ranges::find(servos, channel, &ServoSetup::channel);
        const auto other = static_cast<std::size_t>(twin - servos.begin());
        if (twin == servos.end() || other == *servo)
            return edit("Channel", [channel](ServoSetup& one) { one.channel = channel; });
        refuse("Channel", QString("Channel %1 is that of %2").arg(channel).arg(nameOf(other)),
               "Choose one that is free, or let the two exchange theirs",
               {{"Exchange channels", [this, a = *servo, b = other] { exchange(a, b); }}});
    }

    void exchange(std::size_t a, std::size_t b) {
        DeviceProfile profile = studio_.devices.profile();
        if (std::max(a, b) >= profile.servos.size()) return;
        std::swap(profile.servos[a].channel, profile.servos[b].channel);
        edit_.keep(profile, "Exchange the channels of " + nameOf(a) + " and " + nameOf(b));
    }

    void refresh() {
        const auto servo = selection_.servo();
        const auto& servos = studio_.devices.profile().servos;
        const bool there = servo && *servo < servos.size();
        pages_->setCurrentIndex(there ? 1 : 0);
        if (!there) return;
        const ServoSetup& setup = servos[*servo];
        title_->setText(servoName(servoNamesOf(studio_), *servo));
        channel_->setValue(setup.channel);
        // What a profile has is shown as it is, also where it is narrower than a drag may make it.
        least_->setRange(limits::kPulse.least, std::max(setup.pulseMin, setup.pulseMax - kLeastSpan));
        most_->setRange(std::min(setup.pulseMax, setup.pulseMin + kLeastSpan), limits::kPulse.most);
        const double mostTrim = 0.5 * (setup.pulseMax - setup.pulseMin);
        trim_->setRange(-mostTrim, mostTrim);
        for (const auto& [field, member] : numbers_) field->setValue(setup.*member);
        reversed_->setChecked(setup.reversed);
        const QSignalBlocker quiet(profiles_);
        profiles_->clear();
        const QString name = QString::fromStdString(studio_.devices.profile().name);
        QStringList names = studio_.devices.profileNames();
        if (!names.contains(name)) names.prepend(name);
        profiles_->addItems(names);
        profiles_->setCurrentText(name);
        refreshTests();
    }

    void refreshTests() {
        const auto servo = selection_.servo();
        const LinkStatus& link = studio_.devices.status();
        const bool live =
            link.phase == LinkPhase::live && servo && *servo < link.servos.size() && link.servos[*servo].attached;
        const auto held = servo ? studio_.devices.tested(*servo) : std::nullopt;
        for (const auto& [button, stroke] : tests_) {
            button->setEnabled(live);
            button->setChecked(held == stroke);
        }
        follow_->setEnabled(studio_.devices.testing());
        testNote_->setVisible(!live);
        assign_->setEnabled(live);
    }

    struct Number {
        ValueField* field;
        Setup member;
    };
    struct Test {
        QPushButton* button;
        double stroke;
    };

    Studio& studio_;
    ServoSelection& selection_;
    QStackedWidget* pages_;
    QLabel* title_ = nullptr;
    ValueField* channel_ = nullptr;
    ValueField* least_ = nullptr;
    ValueField* most_ = nullptr;
    ValueField* trim_ = nullptr;
    QCheckBox* reversed_ = nullptr;
    QPushButton* assign_ = nullptr;
    QPushButton* follow_ = nullptr;
    QLabel* testNote_ = nullptr;
    QComboBox* profiles_ = nullptr;
    QLineEdit* name_ = nullptr;
    std::vector<Number> numbers_;
    std::vector<Test> tests_;
    ProfileEdit edit_{studio_.devices};
};

} // namespace

QWidget* makeServoDock(Studio& studio, ServoSelection& selection) { return new ServoDock(studio, selection); }

} // namespace lumorph::studio
