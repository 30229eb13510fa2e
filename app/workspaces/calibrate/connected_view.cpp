#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <QAction>
#include <QLabel>
#include <QPushButton>
#include <QTimer>
#include <QVBoxLayout>

#include "app/studio/calibration/connected.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/calibrate/chain_docks.h"
#include "app/workspaces/calibrate/state_row.h"
#include "app/workspaces/common/step_card.h"

namespace lumorph::studio {
namespace {

constexpr int kConnectedWidth = 900;          // pixels; wider rows part words from their button
constexpr int kPlaceButton = 180;             // pixels, so that the buttons of all rows line up
constexpr int kConnectedMilliseconds = 1'000; // between two looks at what announces no change

ConnectedFacts connectedFacts(Studio& studio) {
    const StudioState& state = studio.document.state();
    ConnectedFacts facts;
    facts.room = *state.installation;
    for (std::size_t k = 0; k < facts.room.projectors.size(); ++k) {
        const ProjectorWindow* window = studio.outputs.window(k);
        facts.outputs.push_back(
            {window != nullptr, studio.outputs.screenOf(k), window ? window->calibrationProblem() : QString()});
    }
    // Of other addresses only opening tells, which may take seconds.
    const std::string camera = facts.room.cameras.empty() ? std::string() : facts.room.cameras.front().address;
    std::error_code ignored;
    facts.isCameraPresent = !camera.starts_with("/dev/") || std::filesystem::exists(camera, ignored);
    for (const OpenTracker& tracker : studio.trackers.trackers()) facts.trackers.push_back(tracker.status);
    facts.bodies = studio.trackers.bodies();
    if (const auto& rig = state.rig.rig) {
        facts.rig = QString::fromStdString(rig->name());
        facts.servos = rig->actuatorCount();
    }
    facts.link = studio.devices.status();
    facts.controller = studio.devices.name();
    facts.isControllerSimulated = studio.devices.profile().address.starts_with("sim://");
    return facts;
}

std::pair<const char*, IconRole> connectedIcon(ConnectedPart::State state) {
    switch (state) {
    case ConnectedPart::State::ready:
        return {"check", IconRole::accent};
    case ConnectedPart::State::needsYou:
        return {"warning", IconRole::warning};
    case ConnectedPart::State::lab:
        return {"lab", IconRole::muted};
    case ConnectedPart::State::missing:
        break;
    }
    return {"minus", IconRole::muted};
}

/// One part, with the button that leads to where it is set up.
class ConnectedRow : public QWidget {
public:
    ConnectedRow(const QString& name, QWidget* parent) : QWidget(parent), go_(new QPushButton(this)) {
        setObjectName(name);
        setMaximumWidth(kConnectedWidth);
        row_.emplace(*this, QMargins(0, 8, 0, 8));
        // As the texts of cards, which have a button too.
        findChild<QLabel*>(name + ".words")->setObjectName(name + ".text");
        go_->setObjectName(name + ".go");
        go_->setMinimumWidth(kPlaceButton);
        layout()->addWidget(go_);
        layout()->setAlignment(go_, Qt::AlignTop);
    }
    [[nodiscard]] QPushButton* button() const { return go_; }
    void show(const ConnectedPart& part) {
        const auto [icon, role] = connectedIcon(part.state);
        row_->show({icon, role, part.title, wordOf(part.state), part.text});
        go_->setText(buttonOf(part.place));
        go_->setAccessibleDescription(part.title);
    }

private:
    std::optional<StateRow> row_; ///< once this has its name
    QPushButton* go_;
};

class ConnectedView : public QWidget {
public:
    explicit ConnectedView(const CalibrateParts& parts)
        : parts_(parts), card_(new StepCard("connected.card", "link", this)), list_(new QVBoxLayout) {
        setObjectName("connected.view");
        setProperty("look", "panel");
        setAttribute(Qt::WA_StyledBackground);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(16, 8, 16, 8);
        column->setSpacing(12);
        column->addWidget(card_);
        const Column page = makeColumn(this);
        column->addWidget(page.widget, 1);
        page.layout->addWidget(makeHeading(tr("What is connected"), this));
        list_->setSpacing(0);
        page.layout->addLayout(list_);
        page.layout->addStretch(1);
        Studio& studio = parts.studio;
        connect(card_, &StepCard::nextWanted, this, [this] {
            if (next_)
                go(*next_);
            else
                parts_.selection.setPage(CalibrateSelection::Page::link);
        });
        connect(&studio.trackers, &TrackerService::changed, this, [this] { refresh(); });
        connect(&studio.devices, &DeviceService::changed, this, [this] { refresh(); });
        connect(&studio.document, &StudioDocument::changed, this, [this] { refresh(); });
        connect(&studio.outputs, &ProjectorOutputs::changed, this, [this] { refresh(); });
        auto* timer = new QTimer(this);
        connect(timer, &QTimer::timeout, this, [this] { refresh(); });
        timer->start(kConnectedMilliseconds);
    }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        refresh();
    }

private:
    void refresh() {
        if (!isVisible()) return;
        std::vector<ConnectedPart> parts = connectedParts(connectedFacts(parts_.studio));
        if (parts == shown_) return;
        if (!std::ranges::equal(parts, shown_, {}, &ConnectedPart::kind, &ConnectedPart::kind)) makeRows(parts);
        shown_ = std::move(parts);
        for (std::size_t k = 0; k < rows_.size(); ++k) rows_[k]->show(shown_[k]);
        const ConnectedSummary summary = connectedSummary(shown_);
        next_ = summary.place;
        card_->show({summary.tone, summary.title, summary.text, summary.button});
    }

    void makeRows(const std::vector<ConnectedPart>& parts) {
        for (ConnectedRow* row : rows_) {
            row->hide();
            row->deleteLater();
        }
        rows_.clear();
        for (std::size_t k = 0; k < parts.size(); ++k) {
            rows_.push_back(new ConnectedRow("connected." + parts[k].kind, this));
            list_->addWidget(rows_[k]);
            connect(rows_[k]->button(), &QPushButton::clicked, this, [this, k] { go(shown_[k].place); });
        }
    }

    void go(ConnectedPart::Place place) {
        switch (place) {
        case ConnectedPart::Place::setup:
            return parts_.selection.setWhole(false);
        case ConnectedPart::Place::devices:
            emit parts_.studio.commands.workspaceWanted("devices");
            return;
        case ConnectedPart::Place::scene:
            emit parts_.studio.commands.workspaceWanted("scene");
            return;
        case ConnectedPart::Place::rig:
            return parts_.studio.commands.find("rig.open")->trigger();
        }
    }

    CalibrateParts parts_;
    StepCard* card_;
    QVBoxLayout* list_;
    std::vector<ConnectedRow*> rows_;
    std::vector<ConnectedPart> shown_;         ///< one a row
    std::optional<ConnectedPart::Place> next_; ///< to which the card's button leads; empty: to the chain
};

} // namespace

QWidget* makeConnectedView(const CalibrateParts& parts) { return new ConnectedView(parts); }

} // namespace lumorph::studio
