#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QStyle>
#include <QVBoxLayout>

#include "app/studio/calibration/chain_service.h"
#include "app/studio/calibration/table_bench.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/segments.h"
#include "app/workspaces/calibrate/calibrate_commands.h"
#include "app/workspaces/calibrate/chain_docks.h"
#include "app/workspaces/calibrate/touch_picture.h"

namespace lumorph::studio {
namespace {

constexpr int kRecordingWidth = 900; // pixels; wider rows part a name from its button

class ChainSource : public QWidget {
public:
    ChainSource(const CalibrateParts& parts, QWidget* parent)
        : QWidget(parent), parts_(parts),
          way_(
              new Segments({{"chain.way.lab", "Virtual lab", "Without any hardware; the truth is known"},
                            {"chain.way.live", "Connected tracker", "By touching, step by step, what the studio shows"},
                            {"chain.way.files", "Recordings", "What was recorded before, here or elsewhere"}},
                           this)) {
        setMaximumWidth(kRecordingWidth);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(0, 0, 0, 0);
        column->setSpacing(8);
        column->addWidget(makeHeading("Measured from", this));
        column->addWidget(way_, 0, Qt::AlignLeft);
        list_ = new QWidget(this);
        rows_ = new QVBoxLayout(list_);
        rows_->setContentsMargins(0, 0, 0, 0);
        rows_->setSpacing(8);
        lab_ = new QLabel(this);
        lab_->setObjectName("chain.lab");
        lab_->setProperty("look", "muted");
        lab_->setWordWrap(true);
        column->addWidget(lab_);
        pack_ = new QPushButton("Pack the lab up", this);
        pack_->setObjectName("chain.lab.pack");
        pack_->setToolTip("All in the lab is again as the room is believed to be; what was measured stays in the room");
        column->addWidget(pack_, 0, Qt::AlignLeft);
        connect(pack_, &QPushButton::clicked, this, [this] { parts_.studio.lab.packUp(); });
        connect(&parts.studio.lab, &LabRoom::changed, this, [this] { refresh(); });
        column->addWidget(list_);
        seen_ = new QLabel(this);
        seen_->setObjectName("chain.live.seen");
        seen_->setWordWrap(true);
        column->addWidget(seen_);
        auto* buttons = new QHBoxLayout;
        devices_ = new QPushButton("Open Devices", this);
        devices_->setObjectName("chain.live.devices");
        back_ = new QPushButton("Do the last step again", this);
        back_->setObjectName("chain.live.back");
        for (QPushButton* button : {devices_, back_}) buttons->addWidget(button);
        buttons->addStretch(1);
        column->addLayout(buttons);
        corner_ = new TouchPicture(this);
        column->addWidget(corner_);
        connect(devices_, &QPushButton::clicked, this,
                [this] { emit parts_.studio.commands.workspaceWanted("devices"); });
        connect(back_, &QPushButton::clicked, this, [this] { parts_.live.takeBack(); });
        connect(way_, &Segments::chosen, this, [this](int way) { parts_.chain.setWay(static_cast<LinkWay>(way)); });
        connect(&parts.chain, &ChainService::changed, this, [this] { refresh(); });
        connect(&parts.studio.trackers, &TrackerService::changed, this, [this] { refreshLive(); });
        connect(&parts.studio.devices, &DeviceService::changed, this, [this] { refreshLive(); });
        connect(&parts.studio.document, &StudioDocument::changed, this, [this](StateParts changed) {
            if (changed & StatePart::installation) refreshLive();
        });
        refresh();
    }

private:
    void refresh() {
        const ChainState& state = parts_.chain.state();
        const ChainLink& link = chainLinks()[state.chosen];
        setVisible(!link.stage->hasSequence());
        if (link.isOnTable)
            way_->setSegment(1, link.isMoved ? "Camera and servos" : "Camera and projectors",
                             "What is on the table, as it is connected");
        else
            way_->setSegment(1, link.isWithTracker() ? "Connected tracker" : "At the table",
                             link.isWithTracker() ? "By touching, step by step, what the studio shows"
                                                  : link.notConnected);
        way_->setChosen(static_cast<int>(wayOf(state, state.chosen)));
        for (QWidget* part : {static_cast<QWidget*>(way_), list_}) part->setEnabled(!state.session.running());
        refreshLive();
        const bool unpacked = parts_.studio.lab.isUnpacked();
        lab_->setText(unpacked ? "The lab is unpacked: its tracker, pointer, device, eyes and servos are as they came "
                                 "out of their boxes, for simulated trackers too. Only the chain finds out how."
                               : "All in the lab is as the room is believed to be. The first measurement unpacks it: "
                                 "then nobody knows how its things are, until the chain has measured them.");
        lab_->setVisible(wayOf(state, state.chosen) == LinkWay::lab);
        pack_->setVisible(wayOf(state, state.chosen) == LinkWay::lab && unpacked);
        const auto chosen = state.files.find(state.chosen);
        const auto files = chosen == state.files.end() ? std::vector<std::filesystem::path>() : chosen->second;
        const std::optional<std::size_t> shown =
            wayOf(state, state.chosen) == LinkWay::files ? std::optional(state.chosen) : std::nullopt;
        if (shown == shown_ && files == files_) return; // a button that is pressed stays
        shown_ = shown;
        files_ = files;
        while (QLayoutItem* old = rows_->takeAt(0)) {
            if (old->widget()) {
                old->widget()->hide();
                old->widget()->deleteLater();
            }
            delete old;
        }
        if (shown)
            for (std::size_t k = 0; k <= chainLinks()[*shown].files.size(); ++k) {
                const std::size_t count = chainLinks()[*shown].files.size();
                addRow(*shown, k == 0 ? count : k - 1); // ours first
            }
    }

    /// Whether the tracker sees what is needed, and the corner that is to be touched.
    void refreshLive() {
        const ChainState& state = parts_.chain.state();
        const ChainLink& link = chainLinks()[state.chosen];
        const bool isLive = wayOf(state, state.chosen) == LinkWay::live;
        const StudioState& document = parts_.studio.document.state();
        const QString obstacle = !isLive || !link.notConnected.isEmpty() ? QString()
                                 : link.isOnTable
                                     ? tableObstacle(*document.installation, parts_.studio.devices, link.isMoved)
                                     : parts_.live.obstacle(link.liveRoles);
        seen_->setVisible(isLive && !state.live && link.notConnected.isEmpty()); // else the card says it
        const QString words = !obstacle.isEmpty() ? obstacle
                              : link.isMoved      ? QString("Camera, projectors and servos are connected.")
                              : link.isOnTable
                                  ? QString("The room's camera is opened to measure. %1").arg(link.onTable).trimmed()
                                  : QString("The tracker sees all that is needed.");
        if (words != seen_->text()) { // it is asked ten times a second
            seen_->setText(words);
            seen_->setProperty("look", obstacle.isEmpty() ? "muted" : "warning");
            seen_->style()->polish(seen_);
        }
        devices_->setVisible(isLive && !obstacle.isEmpty());
        back_->setVisible(isLive && state.live && state.live->step > 0);
        corner_->show(document.rig.rig, state.live ? state.live->corner : std::nullopt);
    }

    void addRow(std::size_t link, std::size_t file) {
        const LinkFile ours{
            "recording", "Recording",
            chainLinks()[link].files.empty()
                ? "The folder that was kept when this was measured, here or elsewhere."
                : "The folder that was kept when this was measured; or, of a tracker's own recordings:"};
        const LinkFile& wanted = file < chainLinks()[link].files.size() ? chainLinks()[link].files[file] : ours;
        const std::filesystem::path path = file < files_.size() ? files_[file] : std::filesystem::path();
        auto* plate = new QWidget(list_);
        auto* column = new QVBoxLayout(plate);
        column->setContentsMargins(0, 0, 0, 0);
        column->setSpacing(2);
        auto* button = new QPushButton(
            path.empty() ? QString("Choose...") : QString::fromStdString(path.filename().string()), plate);
        button->setObjectName(QString("chain.file.") + wanted.key);
        button->setAccessibleName(wanted.title);
        button->setToolTip(path.empty() ? wanted.words : QString::fromStdString(path.string()));
        connect(button, &QPushButton::clicked, this, [this, link, file] { askForRecording(parts_, link, file); });
        column->addWidget(makeRow(wanted.title, button, plate));
        auto* words = new QLabel(wanted.words, plate);
        words->setProperty("look", "muted");
        words->setWordWrap(true);
        column->addWidget(words);
        rows_->addWidget(plate);
    }

    CalibrateParts parts_;
    Segments* way_;
    QLabel* lab_ = nullptr;
    QPushButton* pack_ = nullptr;
    QLabel* seen_ = nullptr;
    QPushButton *devices_ = nullptr, *back_ = nullptr;
    TouchPicture* corner_ = nullptr;
    QWidget* list_ = nullptr;
    QVBoxLayout* rows_ = nullptr;
    std::optional<std::size_t> shown_; ///< link whose recordings are listed
    std::vector<std::filesystem::path> files_;
};

} // namespace

QWidget* makeChainSource(const CalibrateParts& parts, QWidget* parent) { return new ChainSource(parts, parent); }

} // namespace lumorph::studio
