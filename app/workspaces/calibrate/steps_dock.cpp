#include <algorithm>
#include <map>
#include <optional>

#include <QCheckBox>
#include <QComboBox>
#include <QDesktopServices>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QSignalBlocker>
#include <QUrl>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/calibrate/calibrate_docks.h"
#include "app/workspaces/calibrate/setup_form.h"
#include "app/workspaces/calibrate/state_row.h"
#include "app/workspaces/rig/actuator_item.h"

namespace lumorph::studio {
namespace {

using How = CalibrationStep::How;

std::pair<QString, IconRole> iconOf(How how) {
    switch (how) {
    case How::needsYou:
        return {"hand", IconRole::accent};
    case How::running:
        return {"clock", IconRole::accent};
    case How::good:
        return {"check", IconRole::accent};
    case How::doubtful:
        return {"warning", IconRole::warning};
    case How::refused:
        return {"error", IconRole::danger};
    case How::notBegun:
        break;
    }
    return {"minus", IconRole::muted};
}

/// One step: its number, title, state, and why.
class StepRow : public QWidget {
public:
    StepRow(int number, const QString& id, QWidget* parent) : QWidget(parent), number_(number) {
        setObjectName("calibrate.step." + id);
        row_.emplace(*this, QMargins(0, 4, 0, 4));
    }
    void show(const CalibrationStep& step) {
        const auto [name, role] = iconOf(step.how);
        row_->show({name, role, step.title, howWords(step.how), step.words, number_});
    }

private:
    int number_;
    std::optional<StateRow> row_; ///< once this has its name
};

QString poseDetail(const CalibrationPose& pose, const CalibrationState& state) {
    if (pose.leftOut) return "left out";
    if (pose.refusal) return wordsOf(*pose.refusal).title;
    if (!pose.warnings.empty()) return wordsOf(pose.warnings.front()).title;
    if (state.result)
        for (const ViewQuality& view : state.result->solved.views)
            if (view.name == pose.name && view.heldOut)
                return QString("held out: %1 px%2")
                    .arg(*view.heldOut, 0, 'f', 2)
                    .arg(view.name == state.result->solved.worstView ? "; fits worst" : "");
    return pose.seen ? QString("%1 points of the board").arg(pose.seen->corners.seen.size()) : QString();
}

QString poseIcon(const CalibrationPose& pose) {
    if (pose.leftOut) return "eye-off";
    if (pose.refusal) return "error";
    return pose.warnings.empty() ? "check" : "warning";
}

class StepsDock : public QWidget {
public:
    explicit StepsDock(const CalibrateParts& parts) : parts_(parts), poses_(new QListWidget(this)) {
        auto* whole = new QVBoxLayout(this);
        whole->setContentsMargins(0, 0, 0, 0);
        const Column column = makeColumn(this);
        whole->addWidget(column.widget);
        int number = 1;
        for (const CalibrationStep& step : stepsOf(parts.service.state())) {
            rows_[step.id] = new StepRow(number++, step.id, this);
            column.layout->addWidget(rows_[step.id]);
        }
        addEarlier(*column.layout);
        addPoses(*column.layout);
        column.layout->addWidget(new SetupForm(parts, this));
        auto* end = new QHBoxLayout;
        anew_ = makeCommandButton(parts.studio.commands.find("calibrate.anew"), "calibrate.anew", this);
        end->addWidget(anew_);
        column.layout->addLayout(end);
        connect(&parts.service, &CalibrationService::changed, this, [this] { refresh(); });
        connect(&parts.selection, &CalibrateSelection::changed, this, [this] { showChosen(); });
        refresh();
    }

private:
    /// Poses of another day that one can go on with.
    void addEarlier(QVBoxLayout& column) {
        earlierPart_ = new QWidget(this);
        auto* part = new QVBoxLayout(earlierPart_);
        part->setContentsMargins(0, 0, 0, 0);
        part->setSpacing(8);
        earlier_ = new QLabel(this);
        earlier_->setObjectName("calibrate.earlier");
        earlier_->setWordWrap(true);
        part->addWidget(earlier_);
        auto* goOn = new QPushButton("&Go on with these poses", this);
        goOn->setObjectName("calibrate.goOn");
        goOn->setToolTip("For a camera, a projector and a board that are as they were; nothing may have been moved");
        part->addWidget(goOn, 0, Qt::AlignLeft);
        column.addWidget(earlierPart_);
        connect(goOn, &QPushButton::clicked, this, [this] { parts_.service.goOnWithEarlier(); });
    }

    void showEarlier(const CalibrationState& state) {
        const bool offers = state.earlier && state.poses.empty() && state.work == CalibrationState::Work::none;
        earlierPart_->setVisible(offers);
        if (!offers) return;
        earlier_->setText(
            QString("%1 of the board, photographed %2, %3 not used yet.")
                .arg(state.earlier->count == 1 ? QString("One pose") : QString("%1 poses").arg(state.earlier->count),
                     state.earlier->when, state.earlier->count == 1 ? "was" : "were"));
    }

    void addPoses(QVBoxLayout& column) {
        posesPart_ = new QWidget(this);
        auto* part = new QVBoxLayout(posesPart_);
        part->setContentsMargins(0, 0, 0, 0);
        part->setSpacing(8);
        part->addWidget(makeHeading("Poses", this));
        poses_->setObjectName("calibrate.poses.list");
        poses_->setAccessibleName("Poses of the board");
        poses_->setItemDelegate(new ActuatorItem(poses_));
        poses_->setUniformItemSizes(true);
        poses_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
        part->addWidget(poses_);
        saved_ = new QLabel(this);
        saved_->setObjectName("calibrate.saved");
        saved_->setProperty("look", "muted");
        saved_->setWordWrap(true);
        saved_->setTextFormat(Qt::RichText);
        connect(saved_, &QLabel::linkActivated, this,
                [](const QString& folder) { QDesktopServices::openUrl(QUrl::fromLocalFile(folder)); });
        part->addWidget(saved_);
        leaveOut_ = new QCheckBox("Leave this pose out", this);
        leaveOut_->setObjectName("calibrate.leaveOut");
        part->addWidget(leaveOut_);
        flat_ = new QComboBox(this);
        flat_->setObjectName("calibrate.flat");
        flat_->setToolTip("From this pose the studio learns where the table is: its middle becomes the middle of the "
                          "room");
        part->addWidget(makeRow("Lay on the &table in", flat_, this));
        column.addWidget(posesPart_);
        connect(poses_, &QListWidget::currentRowChanged, this, [this](int row) {
            const auto& poses = parts_.service.state().poses;
            if (row >= 0 && static_cast<std::size_t>(row) < poses.size())
                parts_.selection.setPose(poses[static_cast<std::size_t>(row)].name);
        });
        connect(leaveOut_, &QCheckBox::clicked, this,
                [this](bool out) { parts_.service.setLeftOut(parts_.selection.pose(), out); });
        connect(flat_, &QComboBox::activated, this,
                [this] { parts_.service.setFlatPose(flat_->currentText().toStdString()); });
    }

    void refresh() {
        const CalibrationState& state = parts_.service.state();
        const bool byHand = state.setup.way == CaptureWay::crosshairs; // its card says what is to be done
        for (const CalibrationStep& step : stepsOf(state)) {
            rows_.at(step.id)->show(step);
            rows_.at(step.id)->setVisible(!byHand);
        }
        anew_->setVisible(!byHand);
        posesPart_->setVisible(!state.poses.empty());
        {
            const QSignalBlocker quiet(poses_);
            while (poses_->count() > static_cast<int>(state.poses.size())) delete poses_->takeItem(poses_->count() - 1);
            for (std::size_t k = 0; k < state.poses.size(); ++k) {
                const CalibrationPose& pose = state.poses[k];
                QListWidgetItem* item = poses_->item(static_cast<int>(k));
                if (!item) item = new QListWidgetItem(poses_);
                item->setText(QString::fromStdString(pose.name));
                item->setData(kActuatorDetail, poseDetail(pose, state));
                item->setData(kActuatorIcon, poseIcon(pose));
                item->setData(Qt::AccessibleDescriptionRole, poseDetail(pose, state));
            }
            const int rows = std::clamp(poses_->count(), 1, 6);
            poses_->setFixedHeight(rows * std::max(24, poses_->sizeHintForRow(0)) + 6);
        }
        showEarlier(state);
        showSaved(state);
        const QSignalBlocker quiet(flat_);
        flat_->clear();
        for (const CalibrationPose& pose : state.poses)
            if (pose.counts()) flat_->addItem(QString::fromStdString(pose.name));
        flat_->setCurrentIndex(flat_->findText(QString::fromStdString(state.flatPose)));
        showChosen();
    }

    void showSaved(const CalibrationState& state) {
        saved_->setVisible(!state.savedIn.empty() || state.unsaved > 0);
        const QString folder = QString::fromStdString(state.savedIn.string());
        const QString name = QString::fromStdString(state.savedIn.filename().string());
        QStringList words;
        if (!name.isEmpty())
            words << QString("Saved in <a href=\"%1\">%2</a>").arg(folder.toHtmlEscaped(), name.toHtmlEscaped());
        if (state.unsaved > 0) words << QString("not saved yet: %1").arg(state.unsaved);
        saved_->setText(words.join(", "));
        saved_->setToolTip(folder);
    }

    void showChosen() {
        const CalibrationState& state = parts_.service.state();
        const auto& poses = state.poses;
        const auto found = std::ranges::find(poses, parts_.selection.pose(), &CalibrationPose::name);
        const QSignalBlocker quiet(poses_);
        poses_->setCurrentRow(found == poses.end() ? -1 : static_cast<int>(found - poses.begin()));
        leaveOut_->setEnabled(found != poses.end() && state.work == CalibrationState::Work::none);
        leaveOut_->setChecked(found != poses.end() && found->leftOut);
    }

    CalibrateParts parts_;
    std::map<QString, StepRow*> rows_;
    QWidget* earlierPart_ = nullptr;
    QLabel* earlier_ = nullptr;
    QWidget* posesPart_ = nullptr;
    QListWidget* poses_;
    QCheckBox* leaveOut_ = nullptr;
    QLabel* saved_ = nullptr;
    QComboBox* flat_ = nullptr;
    QPushButton* anew_ = nullptr;
};

} // namespace

QWidget* makeStepsDock(const CalibrateParts& parts) { return new StepsDock(parts); }

} // namespace lumorph::studio
