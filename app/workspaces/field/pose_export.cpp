#include "app/workspaces/field/pose_export.h"

#include <filesystem>
#include <optional>

#include <QComboBox>
#include <QDesktopServices>
#include <QDialog>
#include <QDialogButtonBox>
#include <QLabel>
#include <QPushButton>
#include <QRadioButton>
#include <QUrl>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/common/export_dialogs.h"
#include "app/workspaces/field/pose_desk.h"
#include "core/base/error.h"
#include "devices/firmware/sketch.h"

namespace lumorph::studio {

namespace {

const QString kButtonKey = QStringLiteral("poses/button");
constexpr int kWrapWidth = 440;

QString pinText(int pin) { return pin < 14 ? QString::number(pin) : QString("A%1 (%2)").arg(pin - 14).arg(pin); }

Notice writtenNotice(const std::filesystem::path& folder) {
    const QString place = QString::fromStdString(folder.string());
    Notice notice;
    notice.level = Notice::Level::info;
    notice.subject = QObject::tr("The sketch with the poses");
    notice.why = QObject::tr("It is in %1").arg(place);
    notice.remedy = QObject::tr("Open %1.ino there in the Arduino IDE and upload it to the board")
                        .arg(QString::fromStdString(folder.filename().string()));
    notice.actions.push_back(
        {QObject::tr("Open its folder"), [place] { QDesktopServices::openUrl(QUrl::fromLocalFile(place)); }});
    return notice;
}

class PoseExport : public QDialog {
public:
    PoseExport(Studio& studio, QWidget* parent) : QDialog(parent), studio_(studio), profile_(studio.devices.profile()) {
        std::vector<std::string> names;
        for (const Actuator& actuator : studio.document.state().rig.rig->actuators()) names.push_back(actuator.name);
        sequence_ = sequenceFor(*studio.document.state().poses, names);
        setObjectName("poses.export.dialog");
        setAttribute(Qt::WA_DeleteOnClose);
        setWindowTitle(tr("Export the poses with the firmware"));
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(16, 16, 16, 16);
        layout->setSpacing(12);
        auto* what =
            new QLabel(tr("The sketch for the Arduino Pro Mini, with pins and limits of the set-up in Devices. "
                          "Uploaded, it shows the sequence without a computer, and a computer that connects "
                          "takes over at once."));
        what->setWordWrap(true);
        layout->addWidget(what);
        layout->addWidget(makeChoice());
        says_ = makeText("poses.export.says", "muted");
        wrong_ = makeText("poses.export.wrong", "warning");
        layout->addWidget(says_);
        layout->addWidget(wrong_);
        layout->addStretch(1);
        layout->addWidget(makeButtons());
        setMinimumWidth(kWrapWidth);
        look();
    }

private:
    QLabel* makeText(const QString& name, const char* look) {
        auto* label = new QLabel;
        label->setObjectName(name);
        label->setProperty("look", look);
        label->setTextFormat(Qt::PlainText);
        label->setWordWrap(true);
        return label;
    }

    QWidget* makeChoice() {
        auto* choice = new QWidget;
        auto* layout = new QVBoxLayout(choice);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(4);
        byButton_ = new QRadioButton(tr("A &button starts it"));
        byButton_->setObjectName("poses.export.byButton");
        byButton_->setToolTip(tr("Between the pin and ground; pressed while it moves, the servos are let go"));
        atPower_ = new QRadioButton(tr("It starts by &itself when the board gets power, and never ends"));
        atPower_->setObjectName("poses.export.atPower");
        atPower_->setToolTip(tr("Three seconds after power on, if no computer speaks by then"));
        pin_ = new QComboBox;
        pin_->setObjectName("poses.export.pin");
        for (const int pin : buttonPins(profile_)) pin_->addItem(pinText(pin), pin);
        const int kept = pin_->findData(studio_.settings.value(kButtonKey, 12));
        pin_->setCurrentIndex(kept >= 0 ? kept : pin_->count() - 1);
        byButton_->setChecked(true);
        layout->addWidget(byButton_);
        pinRow_ = makeRow(tr("Button to ground on &pin"), pin_);
        pinRow_->setContentsMargins(24, 0, 0, 0);
        layout->addWidget(pinRow_);
        layout->addWidget(atPower_);
        connect(byButton_, &QRadioButton::toggled, this, [this] { look(); });
        connect(pin_, &QComboBox::activated, this, [this] { look(); });
        return choice;
    }

    QWidget* makeButtons() {
        auto* buttons = new QDialogButtonBox;
        write_ = buttons->addButton(tr("Choose a folder..."), QDialogButtonBox::AcceptRole);
        write_->setObjectName("poses.export.accept");
        write_->setProperty("look", "primary");
        write_->setDefault(true);
        buttons->addButton(QDialogButtonBox::Cancel)->setObjectName("poses.export.cancel");
        connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
        connect(buttons, &QDialogButtonBox::accepted, this, [this] {
            if (byButton_->isChecked()) studio_.settings.setValue(kButtonKey, pin_->currentData());
            accept();
            askWhere();
        });
        return buttons;
    }

    [[nodiscard]] BoardSequence asked() const {
        BoardSequence asked{sequence_, std::nullopt};
        if (byButton_->isChecked()) asked.button = pin_->currentData().toInt();
        return asked;
    }

    void look() {
        pinRow_->setEnabled(byButton_->isChecked());
        try {
            const BoardPlan plan = planForBoard(profile_, asked());
            QStringList lines{tr("%1 steps in %2 s; %3 of %4 bytes of the board.")
                                  .arg(plan.sequence.steps.size())
                                  .arg(durationOf(plan.sequence), 0, 'f', 1)
                                  .arg(plan.bytes)
                                  .arg(kMostSequenceBytes)};
            for (const std::string& note : plan.notes) lines << QString::fromStdString(note);
            says_->setText(lines.join('\n'));
            wrong_->clear();
        } catch (const Error& error) {
            const Notice notice = noticeOf(error);
            says_->clear();
            wrong_->setText(QString("%1: %2. %3.").arg(notice.subject, notice.why, notice.remedy));
        }
        says_->setVisible(!says_->text().isEmpty());
        wrong_->setVisible(!wrong_->text().isEmpty());
        write_->setEnabled(wrong_->text().isEmpty());
    }

    void askWhere() {
        Studio& studio = studio_;
        askFolder(parentWidget(), studio.settings, "poses.export", tr("Where to put the folder of the sketch"),
                  [&studio, profile = profile_, poses = asked()](const QString& chosen) {
                      studio.jobs.run<std::filesystem::path>(
                          kPosePlace, QObject::tr("Writing the sketch"),
                          [profile, poses, parent = std::filesystem::path(chosen.toStdString())](const Progress&) {
                              return writeSketch(profile, parent, &poses);
                          },
                          [&studio](const std::filesystem::path& folder) {
                              studio.notices.post(kPosePlace, writtenNotice(folder));
                          },
                          [&studio](const std::exception& error) { studio.notices.post(kPosePlace, noticeOf(error)); });
                  });
    }

    Studio& studio_;
    DeviceProfile profile_;
    PoseSequence sequence_;
    QRadioButton *byButton_ = nullptr, *atPower_ = nullptr;
    QComboBox* pin_ = nullptr;
    QWidget* pinRow_ = nullptr;
    QLabel *says_ = nullptr, *wrong_ = nullptr;
    QPushButton* write_ = nullptr;
};

} // namespace

void openPoseExport(Studio& studio, QWidget* parent) {
    const StudioState& state = studio.document.state();
    if (!state.rig.rig || state.poses->sequence.steps.empty()) return;
    if (auto* open = parent ? parent->findChild<QDialog*>("poses.export.dialog") : nullptr) return open->raise();
    (new PoseExport(studio, parent))->open();
}

} // namespace lumorph::studio
