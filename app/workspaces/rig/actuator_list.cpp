#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/throttle.h"
#include "app/workspaces/common/field_summary.h"
#include "app/workspaces/rig/actuator_form.h"
#include "app/workspaces/rig/actuator_item.h"
#include "app/workspaces/rig/rig_docks.h"
#include "app/workspaces/rig/rig_facts.h"

namespace lumorph::studio {

namespace {

/// While something is dragged, what stands in the list and below it follows a little later than the view.
constexpr int kFollowMilliseconds = 100;

class RigActuators : public QWidget {
public:
    RigActuators(Studio& studio, RigSelection& selection)
        : studio_(studio), selection_(selection), pages_(new QStackedWidget(this)), list_(new QListWidget(this)),
          form_(new ActuatorForm(studio.document)), details_(new QVBoxLayout),
          soon_(new Throttle(kFollowMilliseconds, this)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeNoticeBar(studio.notices, "rig"));
        layout->addWidget(pages_, 1);
        pages_->addWidget(makeEmptyState("rig", "No rig yet",
                                         "A rig is a device with its actuators: a glTF file, or a folder of one mesh "
                                         "for each state.",
                                         studio.commands.find("rig.open")));
        pages_->addWidget(makeContents());
        connect(&studio.devices, &DeviceService::profileChanged, this, [this] { showDetails(); });
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & StatePart::rig) rebuild();
            if (!(parts & StatePart::rigEdited)) return;
            form_->show(selection_.actuator());
            soon_->request();
        });
        connect(soon_, &Throttle::due, this, [this] { follow(); });
        connect(form_, &ActuatorForm::motionChanged, this, [this] { selection_.wiggle(); });
        connect(list_, &QListWidget::currentRowChanged, this, [this](int row) {
            selection_.select(row < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(row)));
        });
        connect(list_, &QListWidget::itemActivated, this, [this] { selection_.wiggle(); });
        connect(&selection, &RigSelection::changed, this, [this] { showDetails(); });
        rebuild();
    }

private:
    QWidget* makeContents() {
        const Column column = makeColumn();
        QWidget* contents = column.widget;
        QVBoxLayout* layout = column.layout;
        layout->setContentsMargins(16, 12, 16, 16);
        layout->setAlignment({}); // the list takes what height there is
        summary_ = new QLabel;
        summary_->setObjectName("rig.summary");
        summary_->setProperty("look", "muted");
        summary_->setWordWrap(true);
        list_->setObjectName("rig.list");
        list_->setAccessibleName("Actuators");
        list_->setUniformItemSizes(true);
        list_->setMinimumHeight(160); // of three rows; a lower dock scrolls
        list_->setMouseTracking(true);
        list_->setItemDelegate(new ActuatorItem(list_));
        layout->addWidget(summary_);
        layout->addWidget(list_, 1);
        title_ = makeHeading("Actuator");
        layout->addWidget(title_);
        layout->addWidget(form_);
        layout->addLayout(details_);
        layout->addWidget(makeCommandButton(studio_.commands.find("rig.wiggle"), "rig.wiggleButton", nullptr));
        layout->addWidget(makeCommandButton(studio_.commands.find("rig.influence"), "rig.influenceButton", nullptr));
        layout->addWidget(makeCommandButton(studio_.commands.find("rig.back"), "rig.backButton", nullptr));
        return contents;
    }

    /// Another rig: nothing of it is chosen yet.
    void rebuild() {
        const auto& origin = studio_.document.state().rig.origin;
        if (origin == origin_ && origin) return;
        origin_ = origin;
        selection_.select(std::nullopt);
        list_->clear();
        pages_->setCurrentIndex(origin ? 1 : 0);
        follow();
    }

    /// The same rig, edited: what is chosen stays chosen.
    void follow() {
        const auto& parts = studio_.document.state().rig.parts;
        if (!parts) return;
        const std::size_t count = parts->actuators.size();
        while (list_->count() > static_cast<int>(count)) delete list_->takeItem(list_->count() - 1);
        for (std::size_t i = 0; i < count; ++i) {
            const Actuator& actuator = parts->actuators[i];
            QListWidgetItem* item = list_->item(static_cast<int>(i));
            if (!item) item = new QListWidgetItem(list_);
            const QString detail = deformerText(actuator) + ", " + rangeText(actuator);
            item->setText(QString::fromStdString(actuator.name));
            item->setData(kActuatorDetail, detail);
            item->setData(Qt::AccessibleDescriptionRole, detail);
        }
        summary_->setText(
            QString("%1: %2 %3. Choose one to see what it moves, and to edit it.")
                .arg(QString::fromStdString(parts->name), countText(count), count == 1 ? "actuator" : "actuators"));
        showDetails();
    }

    void showDetails() {
        while (QLayoutItem* item = details_->takeAt(0)) {
            item->widget()->hide();
            item->widget()->deleteLater();
            delete item;
        }
        const auto chosen = selection_.actuator();
        form_->show(chosen);
        title_->setVisible(!form_->isHidden());
        const auto& rig = studio_.document.state().rig.rig; // may be that of an edit before
        if (!rig || !chosen || *chosen >= rig->actuatorCount()) return;
        if (list_->currentRow() != static_cast<int>(*chosen)) list_->setCurrentRow(static_cast<int>(*chosen));
        form_->showLoad(*rig);
        const auto& servos = studio_.devices.profile().servos;
        const ServoSetup* setup = servos.size() == rig->actuatorCount() ? &servos[*chosen] : nullptr;
        details_->addWidget(makeFacts(factsOf(*rig, *chosen, setup), "rig.actuator.", this));
    }

    Studio& studio_;
    RigSelection& selection_;
    QStackedWidget* pages_;
    QListWidget* list_;
    ActuatorForm* form_;
    QVBoxLayout* details_;
    Throttle* soon_;
    QLabel* summary_ = nullptr;
    QWidget* title_ = nullptr;
    std::shared_ptr<const Rig> origin_;
};

} // namespace

QWidget* makeRigActuators(Studio& studio, RigSelection& selection) { return new RigActuators(studio, selection); }

} // namespace lumorph::studio
