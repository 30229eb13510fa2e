#include <algorithm>
#include <vector>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/devices/devices_docks.h"
#include "app/workspaces/devices/room_view.h"
#include "app/workspaces/devices/tracker_card.h"

namespace lumorph::studio {
namespace {

constexpr glm::dvec3 kRoom(20.0); ///< metres; farther away no simulated body goes

class TrackersDock : public QWidget {
public:
    explicit TrackersDock(Studio& studio) : studio_(studio), addresses_(new QComboBox), open_(new QPushButton("Open")) {
        setObjectName("trackers");
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeNoticeBar(studio.notices, "devices"));
        const Column column = makeColumn(this);
        layout->addWidget(column.widget, 1);
        addAddress(*column.layout);
        addTrackers(*column.layout);
        empty_ = makeEmptyState("eye", "No tracker is open",
                                "A tracker tells where heads and the device are, so that the show is drawn for who "
                                "looks at it. Until then the scene's own eye counts.",
                                studio.commands.find("tracker.simulate"));
        column.layout->addWidget(empty_);
        connect(&studio.trackers, &TrackerService::changed, this, [this] { refresh(); });
        connect(&studio.trackers, &TrackerService::addressesChanged, this, [this] { listAddresses(); });
        listAddresses();
        refresh();
    }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        refresh();
    }

private:
    void addAddress(QVBoxLayout& layout) {
        addresses_->setObjectName("trackers.addresses");
        addresses_->setEditable(true);
        addresses_->setInsertPolicy(QComboBox::NoInsert);
        addresses_->setAccessibleName("Address of a tracker");
        addresses_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
        addresses_->setMinimumContentsLength(16);
        addresses_->setToolTip(
            "Where poses come from: OptiTrack Motive (natnet://), opentrack, anything that sends OSC, a printed marker "
            "board before a camera or in a video (board://), or a simulated body. The list has examples to change, and "
            "the cameras that are there.");
        addresses_->lineEdit()->setObjectName("trackers.address");
        open_->setObjectName("trackers.open");
        open_->setToolTip("Starts to listen at this address");
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        row->addWidget(addresses_, 1);
        row->addWidget(open_);
        layout.addLayout(row);
        network_ = new QCheckBox("Take packets from other machines");
        network_->setObjectName("trackers.network");
        network_->setToolTip("Off, only programs on this machine can move the show. Poses are not protected by any "
                             "password: turn it on where you trust the network, and the tracker runs elsewhere. It "
                             "counts for the next one that is opened.");
        layout.addWidget(network_);
        connect(open_, &QPushButton::clicked, this, [this] { openNow(); });
        connect(addresses_->lineEdit(), &QLineEdit::returnPressed, this, [this] { openNow(); });
        connect(addresses_, &QComboBox::currentTextChanged, this, [this] { refreshOpen(); });
    }

    void addTrackers(QVBoxLayout& layout) {
        heading_ = makeHeading("In the room");
        layout.addWidget(heading_);
        room_ = new RoomView;
        room_->setObjectName("trackers.room");
        layout.addWidget(room_);
        connect(room_, &RoomView::moved, this,
                [this](int body, const glm::dvec3& way, double turn) { move(body, way, turn); });
        hint_ =
            new QLabel("Drag a ringed body; the right button turns it, the wheel lifts it. Drag beside it to turn the "
                       "view, double click to look from above. Keys: arrows, PageUp and PageDown, comma and full stop "
                       "to turn, Space for the next body.");
        hint_->setProperty("look", "muted");
        hint_->setWordWrap(true);
        hint_->hide();
        layout.addWidget(hint_);
        cardsLayout_ = new QVBoxLayout;
        cardsLayout_->setSpacing(8);
        layout.addLayout(cardsLayout_);
    }

    void openNow() { studio_.trackers.open(addresses_->currentText(), network_->isChecked()); }

    void listAddresses() {
        const QString text = addresses_->currentText();
        const QSignalBlocker quiet(addresses_);
        addresses_->clear();
        addresses_->addItems(studio_.trackers.addresses());
        if (!text.isEmpty()) addresses_->setEditText(text);
        refreshOpen();
    }

    void refreshOpen() {
        open_->setText(studio_.trackers.opening() ? "Opening..." : "Open");
        open_->setEnabled(!studio_.trackers.opening() && !addresses_->currentText().trimmed().isEmpty());
    }

    /// Cards stay as long as the same trackers are open, so that a list that hangs open does not close.
    void matchCards() {
        const std::vector<OpenTracker>& trackers = studio_.trackers.trackers();
        const bool same = std::ranges::equal(trackers, cards_, [](const OpenTracker& tracker, const TrackerCard* card) {
            return QString::fromStdString(tracker.status.address) == card->address();
        });
        if (same) return;
        for (TrackerCard* card : cards_) {
            card->hide();
            card->deleteLater(); // it may be in the middle of its own click
        }
        cards_.clear();
        for (const OpenTracker& tracker : trackers) {
            cards_.push_back(new TrackerCard(studio_.trackers, QString::fromStdString(tracker.status.address),
                                             QString("tracker.%1").arg(cards_.size())));
            cardsLayout_->addWidget(cards_.back());
        }
    }

    void refresh() {
        refreshOpen();
        matchCards();
        const std::vector<OpenTracker>& trackers = studio_.trackers.trackers();
        empty_->setVisible(trackers.empty());
        if (trackers.empty()) hint_->hide();
        heading_->setVisible(!trackers.empty());
        room_->setVisible(!trackers.empty());
        if (!isVisible()) return;
        std::vector<RoomView::Body> bodies;
        std::vector<std::shared_ptr<SimulatedSteering>> steerings;
        for (std::size_t k = 0; k < trackers.size(); ++k) {
            const TrackerStatus& status = trackers[k].status;
            cards_[k]->show(trackers[k]);
            for (const TrackedBody& body : status.bodies)
                bodies.push_back({QString::fromStdString(body.name), QString::fromStdString(status.address), body.pose,
                                  body.valid && status.receiving, trackers[k].steering != nullptr});
            steerings.insert(steerings.end(), status.bodies.size(), trackers[k].steering);
        }
        const bool simulated = std::ranges::any_of(bodies, &RoomView::Body::movable);
        hint_->setVisible(simulated);
        room_->show(std::move(bodies));
        steerings_ = std::move(steerings);
    }

    /// A person takes a simulated body by the hand, as it is seen in the world of its tracker.
    void move(int body, glm::dvec3 way, double turn) {
        const auto index = static_cast<std::size_t>(body);
        if (index >= steerings_.size() || !steerings_[index]) return;
        SimulatedSteering& steering = *steerings_[index];
        SimulatedOrders orders = steering.orders();
        if (const auto room = steering.room()) way = glm::dmat3(glm::mat3(room->worldFromTracker)) * way;
        Pose pose = orders.held.value_or(steering.truth());
        pose.position = glm::clamp(pose.position + way, -kRoom, kRoom);
        pose.rotation = glm::normalize(glm::angleAxis(turn, glm::dvec3(0.0, 1.0, 0.0)) * pose.rotation);
        orders.held = pose;
        steering.order(orders);
    }

    Studio& studio_;
    QComboBox* addresses_;
    QPushButton* open_;
    QCheckBox* network_ = nullptr;
    QVBoxLayout* cardsLayout_ = nullptr;
    std::vector<TrackerCard*> cards_;
    QWidget* heading_ = nullptr;
    RoomView* room_ = nullptr;
    QLabel* hint_ = nullptr;
    std::vector<std::shared_ptr<SimulatedSteering>> steerings_; ///< of the bodies in the view
    QWidget* empty_ = nullptr;
};

} // namespace

QWidget* makeTrackersDock(Studio& studio) { return new TrackersDock(studio); }

} // namespace lumorph::studio
