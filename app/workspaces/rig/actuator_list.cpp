#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/common/field_summary.h"
#include "app/workspaces/rig/actuator_item.h"
#include "app/workspaces/rig/rig_docks.h"
#include "app/workspaces/rig/rig_facts.h"

namespace lumorph::studio {

namespace {

class RigActuators : public QWidget {
public:
    RigActuators(Studio& studio, RigSelection& selection)
        : studio_(studio), selection_(selection), pages_(new QStackedWidget(this)), list_(new QListWidget(this)),
          details_(new QVBoxLayout) {
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
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & StatePart::rig) rebuild();
        });
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
        layout->addLayout(details_);
        layout->addWidget(makeCommandButton(studio_.commands.find("rig.wiggle"), "rig.wiggleButton", nullptr));
        return contents;
    }

    void rebuild() {
        const auto& rig = studio_.document.state().rig.rig;
        if (rig == rig_ && rig) return;
        rig_ = rig;
        selection_.select(std::nullopt);
        list_->clear();
        pages_->setCurrentIndex(rig ? 1 : 0);
        if (!rig) return;
        for (const Actuator& actuator : rig->actuators()) {
            auto* item = new QListWidgetItem(QString::fromStdString(actuator.name), list_);
            const QString detail = deformerText(actuator) + ", " + rangeText(actuator);
            item->setData(kActuatorDetail, detail);
            item->setData(Qt::AccessibleDescriptionRole, detail);
        }
        const std::size_t count = rig->actuatorCount();
        summary_->setText(
            QString("%1: %2 %3. Choose one to see what it moves.")
                .arg(QString::fromStdString(rig->name()), countText(count), count == 1 ? "actuator" : "actuators"));
        showDetails();
    }

    void showDetails() {
        while (QLayoutItem* item = details_->takeAt(0)) {
            item->widget()->hide();
            item->widget()->deleteLater();
            delete item;
        }
        const auto chosen = selection_.actuator();
        if (!rig_ || !chosen || *chosen >= rig_->actuatorCount()) return;
        if (list_->currentRow() != static_cast<int>(*chosen)) list_->setCurrentRow(static_cast<int>(*chosen));
        details_->addWidget(makeHeading(QString::fromStdString(rig_->actuators()[*chosen].name)));
        details_->addWidget(makeFacts(factsOf(*rig_, *chosen), "rig.actuator.", this));
    }

    Studio& studio_;
    RigSelection& selection_;
    QStackedWidget* pages_;
    QListWidget* list_;
    QVBoxLayout* details_;
    QLabel* summary_ = nullptr;
    std::shared_ptr<const Rig> rig_;
};

} // namespace

QWidget* makeRigActuators(Studio& studio, RigSelection& selection) { return new RigActuators(studio, selection); }

} // namespace lumorph::studio
