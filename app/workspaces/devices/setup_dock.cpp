#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <QCheckBox>
#include <QLabel>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/devices/device_words.h"
#include "app/workspaces/devices/devices_docks.h"
#include "app/workspaces/devices/profile_edit.h"
#include "app/workspaces/devices/servo_board.h"
#include "devices/controllers/controller_kinds.h"

namespace lumorph::studio {
namespace {

namespace limits = profile_limits;

QLabel* makeMuted(const char* name) {
    auto* label = new QLabel;
    label->setObjectName(name);
    label->setProperty("look", "muted");
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    return label;
}

class SetupDock : public QWidget {
public:
    explicit SetupDock(Studio& studio) : studio_(studio), pages_(new QStackedWidget(this)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeNoticeBar(studio.notices, "servo"));
        layout->addWidget(pages_, 1);
        pages_->addWidget(makeEmptyState("settings", "No rig is open", "A rig says which servos there are to set up.",
                                         studio.commands.find("rig.open"), this));
        pages_->addWidget(makeContents());
        connect(&studio.devices, &DeviceService::profileChanged, this, [this] { refresh(); });
        connect(&studio.devices, &DeviceService::changed, this, [this] { refreshLink(); });
        refresh();
    }

private:
    using Member = double DeviceProfile::*;
    using Edit = std::function<void(DeviceProfile&)>;

    QWidget* makeContents() {
        const Column column = makeColumn(this);
        QVBoxLayout& rows = *column.layout;
        rows.addWidget(makeHeading("Speed of all servos"));
        addNumber(rows, "&Pause at the start", "setup.stagger",
                  "The pause between the start of one servo and of the next, so that the supply can bear it",
                  &DeviceProfile::staggerSeconds, Quantity::seconds, limits::kStaggerSeconds, 0.1);
        addNumber(rows, "In sl&ow mode", "setup.slowShare", "The share of their velocity that servos have in slow mode",
                  &DeviceProfile::slowShare, Quantity::share, limits::kSlowShare, 0.05);
        addNumber(rows, "Command &rate (/s)", "setup.rate",
                  "At most so many commands a second. The servos are let go, and are started again.",
                  &DeviceProfile::commandsPerSecond, Quantity::plain, limits::kCommandsPerSecond, 5.0);
        rate_ = makeMuted("setup.rateNote");
        rows.addWidget(rate_);
        rows.addWidget(makeHeading("Hands"));
        addNumber(rows, "Slow &nearer than", "setup.hand",
                  "Servos are slow while a tracked hand is nearer to the device; 0: never.\nA tracker tells one point "
                  "of a hand: fingers reach up to 20 cm beyond it.",
                  &DeviceProfile::handDistance, Quantity::length, limits::kHandDistance, 0.01);
        addRest(rows);
        addController(rows);
        return column.widget;
    }

    void addNumber(QVBoxLayout& rows, const QString& label, const char* name, const QString& tip, Member member,
                   Quantity quantity, ProfileLimits range, double step) {
        auto* field = new ValueField(quantity, range.least, range.most, DeviceProfile{}.*member, this);
        field->setObjectName(name);
        field->setToolTip(tip);
        field->setStep(step);
        field->setRefusing(true);
        const QString what = QString(label).remove('&').section(" (", 0, 0);
        connect(field, &ValueField::refused, this, [this, what](const QString& why) { refuse(what, why); });
        const auto set = [member](double value) { return [member, value](DeviceProfile& p) { p.*member = value; }; };
        connect(field, &ValueField::previewed, this, [this, set](double value) { edit_.preview(edited(set(value))); });
        connect(field, &ValueField::committed, this, [this, set, what](double value) { edit(what, set(value)); });
        connect(field, &ValueField::reverted, this, [this] { edit_.revert(); });
        rows.addWidget(makeRow(label, field));
        numbers_.push_back({field, member});
    }

    QCheckBox* addSwitch(QVBoxLayout& rows, const QString& text, const QString& name, const QString& tip,
                         bool DeviceProfile::*member) {
        auto* box = new QCheckBox(text);
        box->setObjectName(name);
        box->setToolTip(tip);
        connect(box, &QCheckBox::clicked, this, [this, member, text](bool on) {
            edit(text, [member, on](DeviceProfile& profile) { profile.*member = on; });
        });
        rows.addWidget(box);
        return box;
    }

    void addRest(QVBoxLayout& rows) {
        rows.addWidget(makeHeading("When the link ends"));
        rest_ = addSwitch(rows, "Go to the rest pose", "setup.rest",
                          "Before the studio ends, or another device is chosen, servos go there for two seconds at "
                          "most.\nElse they are let go where they are.",
                          &DeviceProfile::restOnExit);
        pose_ = makeMuted("setup.pose");
        rows.addWidget(pose_);
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        row->addWidget(addPose("As they are now", "setup.poseNow", "Where the servos are now is their rest pose",
                               [this](std::size_t servo) { return strokeNow(servo); }),
                       1);
        row->addWidget(addPose("All down", "setup.poseDown", "All servos rest at the beginning of their way",
                               [](std::size_t) { return 0.0; }),
                       1);
        rows.addLayout(row);
    }

    QPushButton* addPose(const QString& text, const char* name, const QString& tip,
                         std::function<double(std::size_t)> strokeOf) {
        auto* button = new QPushButton(text);
        button->setObjectName(name);
        button->setToolTip(tip);
        connect(button, &QPushButton::clicked, this, [this, strokeOf = std::move(strokeOf)] {
            edit("Rest pose", [&](DeviceProfile& profile) {
                for (std::size_t k = 0; k < profile.servos.size(); ++k) profile.servos[k].exitStroke = strokeOf(k);
            });
        });
        return button;
    }

    /// Of a servo that is driven, what it was told; else where the show has it.
    [[nodiscard]] double strokeNow(std::size_t servo) const {
        const LinkStatus& link = studio_.devices.status();
        if (servo < link.servos.size() && link.servos[servo].attached) return link.servos[servo].commanded;
        const auto& frame = studio_.loop.frame();
        if (!frame) return 0.0;
        const auto& strokes = frame->commandedStrokes.empty() ? frame->estimatedStrokes : frame->commandedStrokes;
        return servo < strokes.size() ? strokes[servo] : 0.0;
    }

    void addController(QVBoxLayout& rows) {
        rows.addWidget(makeHeading("Controller"));
        kind_ = makeMuted("setup.kind");
        rows.addWidget(kind_);
        for (const KnownController& known : knownControllers())
            if (!known.options.empty()) rows.addWidget(makeOptions(known));
        identity_ = makeMuted("setup.identity");
        rows.addWidget(identity_);
        forget_ = new QPushButton("Forget this board");
        forget_->setObjectName("setup.forget");
        forget_->setToolTip("The profile is then good for whatever board is at its address");
        connect(forget_, &QPushButton::clicked, this, [this] {
            edit("Forget this board", [](DeviceProfile& profile) {
                profile.identity.clear();
                profile.confirmed = false;
            });
        });
        rows.addWidget(forget_);
    }

    /// What only this kind of controller has to be told.
    QWidget* makeOptions(const KnownController& known) {
        auto* group = new QWidget;
        auto* column = new QVBoxLayout(group);
        column->setContentsMargins(0, 0, 0, 0);
        column->setSpacing(8);
        for (const ControllerOption& option : known.options)
            std::visit([&](auto member) { addOption(*column, option, member); }, option.member);
        groups_.emplace_back(known.kind, group);
        return group;
    }

    void addOption(QVBoxLayout& rows, const ControllerOption& option, int DeviceProfile::*member) {
        auto* field =
            new ValueField(Quantity::level, option.limits.least, option.limits.most, DeviceProfile{}.*member, this);
        field->setObjectName(optionName(option));
        field->setToolTip(QString::fromUtf8(option.tip));
        field->setStep(1.0);
        field->setRefusing(true);
        const QString what = QString::fromUtf8(option.title);
        connect(field, &ValueField::refused, this, [this, what](const QString& why) { refuse(what, why); });
        connect(field, &ValueField::committed, this, [this, member, what](double value) {
            if (value != std::floor(value)) return refuse(what, "It is a whole number");
            edit(what,
                 [member, value](DeviceProfile& profile) { profile.*member = static_cast<int>(std::lround(value)); });
        });
        rows.addWidget(makeRow('&' + what, field));
        shown_.emplace_back([field, member](const DeviceProfile& profile) { field->setValue(profile.*member); });
    }
    void addOption(QVBoxLayout& rows, const ControllerOption& option, bool DeviceProfile::*member) {
        QCheckBox* box =
            addSwitch(rows, QString::fromUtf8(option.title), optionName(option), QString::fromUtf8(option.tip), member);
        shown_.emplace_back([box, member](const DeviceProfile& profile) { box->setChecked(profile.*member); });
    }
    static QString optionName(const ControllerOption& option) { return "setup." + QString::fromUtf8(option.key); }

    [[nodiscard]] DeviceProfile edited(const Edit& change) const {
        DeviceProfile profile = studio_.devices.profile();
        change(profile);
        return profile;
    }
    void edit(const QString& what, const Edit& change) {
        edit_.keep(edited(change), what);
        refresh();
    }
    void refuse(const QString& what, const QString& why) {
        studio_.notices.dismissAll("servo");
        studio_.notices.post("servo", {Notice::Level::warning, what, why, {}, {}});
        refresh();
    }

    void refresh() {
        const DeviceProfile& profile = studio_.devices.profile();
        pages_->setCurrentIndex(profile.servos.empty() ? 0 : 1);
        for (const auto& [field, member] : numbers_) field->setValue(profile.*member);
        rest_->setChecked(profile.restOnExit);
        pose_->setText(restText(profile, servoNamesOf(studio_)));
        for (const auto& show : shown_) show(profile);
        const bool known = !profile.identity.empty();
        identity_->setText((profile.confirmed ? "You said that this is your board: " : "Set up with the board ") +
                           QString::fromStdString(profile.identity) + '.');
        identity_->setVisible(known);
        forget_->setVisible(known);
        kind_->setText(QString::fromUtf8(knownController(profile.controller).title));
        for (const auto& [kind, group] : groups_) group->setVisible(kind == profile.controller);
        refreshLink();
    }

    void refreshLink() {
        const double most = studio_.devices.status().controller.traits.commandsPerSecond;
        const bool less = most > 0.0 && most < studio_.devices.profile().commandsPerSecond;
        rate_->setText(QString("This link takes %1 a second at most.").arg(most, 0, 'f', most < 10.0 ? 1 : 0));
        rate_->setVisible(less);
    }

    struct Number {
        ValueField* field;
        Member member;
    };

    Studio& studio_;
    QStackedWidget* pages_;
    std::vector<Number> numbers_;
    QLabel* rate_ = nullptr;
    QCheckBox* rest_ = nullptr;
    QLabel* pose_ = nullptr;
    QLabel* kind_ = nullptr;
    std::vector<std::pair<ControllerKind, QWidget*>> groups_;      ///< of options, a kind each that has some
    std::vector<std::function<void(const DeviceProfile&)>> shown_; ///< puts an option's value into its widget
    QLabel* identity_ = nullptr;
    QPushButton* forget_ = nullptr;
    ProfileEdit edit_{studio_.devices};
};

} // namespace

QWidget* makeSetupDock(Studio& studio) { return new SetupDock(studio); }

} // namespace lumorph::studio
