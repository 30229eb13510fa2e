#include <algorithm>
#include <cmath>
#include <numbers>

#include <QDateTime>
#include <QGridLayout>
#include <QLabel>
#include <QListWidget>
#include <QLocale>
#include <QPushButton>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/calibrate/calibrate_docks.h"
#include "app/workspaces/rig/actuator_item.h"
#include "core/scene/installation_store.h"

namespace lumorph::studio {
namespace {

QString dateWords(const std::string& date) {
    const QDateTime when = QDateTime::fromString(QString::fromStdString(date), Qt::ISODate).toLocalTime();
    return when.isValid() ? QLocale().toString(when, QLocale::ShortFormat) : QString::fromStdString(date);
}

QString figureWords(double value, const std::string& unit) {
    if (unit.empty() && value == std::round(value)) return QString::number(value, 'f', 0); // a count
    const QString number = QString::number(value, 'f', std::abs(value) >= 100.0 ? 1 : std::abs(value) >= 10.0 ? 2 : 3);
    return unit.empty() ? number : number + ' ' + QString::fromStdString(unit);
}

/// What measurements made of the room, one beside the other.
class VersionsDock : public QWidget {
public:
    explicit VersionsDock(const CalibrateParts& parts) : parts_(parts), list_(new QListWidget(this)) {
        auto* whole = new QVBoxLayout(this);
        whole->setContentsMargins(0, 0, 0, 0);
        empty_ = makeEmptyState("clock", "No version yet",
                                "Each calibration that you use is kept here with its date and figures. It can be "
                                "compared with others, and brought back with one click.",
                                nullptr, this);
        whole->addWidget(empty_);
        const Column column = makeColumn(this);
        column_ = column.widget;
        whole->addWidget(column_);
        list_->setObjectName("calibrate.versions.list");
        list_->setAccessibleName("Versions of the installation");
        list_->setItemDelegate(new ActuatorItem(list_));
        list_->setUniformItemSizes(true);
        column.layout->addWidget(list_);
        auto* row = new QHBoxLayout;
        row->setSpacing(8);
        back_ = new QPushButton("Bring back", this);
        back_->setObjectName("calibrate.versions.back");
        back_->setToolTip("The room gets the figures of this version; undo takes that back");
        remove_ = new QPushButton("Forget", this);
        remove_->setObjectName("calibrate.versions.remove");
        remove_->setToolTip("Removes this version; the room stays as it is");
        row->addWidget(back_, 1);
        row->addWidget(remove_, 1);
        column.layout->addLayout(row);
        compared_ = new QLabel(this);
        compared_->setObjectName("calibrate.versions.compared");
        compared_->setProperty("look", "muted");
        compared_->setWordWrap(true);
        compared_->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);
        column.layout->addWidget(compared_);
        table_ = new QWidget(this);
        table_->setLayout(new QGridLayout);
        table_->layout()->setContentsMargins(0, 0, 0, 0);
        column.layout->addWidget(table_);
        column.layout->addStretch(1);
        connect(list_, &QListWidget::currentRowChanged, this, [this] { showChosen(); });
        connect(back_, &QPushButton::clicked, this, [this] {
            if (const KeptVersion* version = chosen()) parts_.studio.room.bringBackVersion(version->file);
        });
        connect(remove_, &QPushButton::clicked, this, [this] {
            if (const KeptVersion* version = chosen()) parts_.studio.room.removeVersion(version->file);
        });
        connect(&parts.studio.room, &InstallationKeeper::versionsChanged, this, [this] { read(); });
        connect(&parts.studio.document, &StudioDocument::changed, this, [this](StateParts what) {
            if (what & StatePart::installation) list();
        });
        read();
    }

private:
    [[nodiscard]] const KeptVersion* chosen() const {
        const int row = list_->currentRow();
        return row >= 0 && static_cast<std::size_t>(row) < versions_.size() ? &versions_[static_cast<std::size_t>(row)]
                                                                            : nullptr;
    }

    void read() {
        versions_ = parts_.studio.room.versions();
        list();
    }

    void list() {
        empty_->setVisible(versions_.empty());
        column_->setVisible(!versions_.empty());
        const QSignalBlocker quiet(list_);
        const int before = std::max(0, list_->currentRow());
        list_->clear();
        for (const KeptVersion& version : versions_) {
            auto* item = new QListWidgetItem(QString::fromStdString(version.version.title), list_);
            QString detail = dateWords(version.version.date);
            if (!version.version.figures.empty()) {
                const VersionFigure& figure = version.version.figures.front();
                detail += ", " + figureWords(figure.value, figure.unit);
            }
            if (version.version.isSimulated) detail += ", simulated";
            const bool isCurrent = parts_.studio.room.isCurrent(version.version);
            if (isCurrent) detail += ", in use";
            item->setData(kActuatorDetail, detail);
            item->setData(kActuatorIcon, isCurrent ? "check" : "clock");
            item->setData(Qt::AccessibleDescriptionRole, detail);
        }
        list_->setFixedHeight(std::clamp(list_->count(), 1, 6) * std::max(24, list_->sizeHintForRow(0)) + 6);
        list_->setCurrentRow(std::min(before, list_->count() - 1));
        showChosen();
    }

    void showChosen() {
        auto* grid = static_cast<QGridLayout*>(table_->layout());
        while (QLayoutItem* item = grid->takeAt(0)) {
            delete item->widget();
            delete item;
        }
        const KeptVersion* version = chosen();
        back_->setEnabled(version && !parts_.studio.room.isCurrent(version->version));
        remove_->setEnabled(version != nullptr);
        compared_->clear();
        if (!version) return;
        const auto current = std::ranges::find_if(
            versions_, [this](const KeptVersion& one) { return parts_.studio.room.isCurrent(one.version); });
        InstallationVersion present;
        present.installation = *parts_.studio.document.state().installation;
        if (current != versions_.end()) present = current->version;
        const bool same = current != versions_.end() && &*current == version;
        QStringList inputs;
        for (const std::string& input : version->version.inputs) inputs << QString::fromStdString(input);
        compared_->setText((version->version.isSimulated ? "Simulated in the virtual lab. " : QString()) +
                           (inputs.isEmpty() ? QString() : "Made of " + inputs.join(", ") + ". ") +
                           (same ? "It is in use." : "Beside what is in use:"));
        int row = 0;
        const auto add = [&](const QString& name, const QString& here, const QString& inUse) {
            int column = 0;
            for (const QString& text : {name, here, inUse}) {
                auto* label = new QLabel(text, table_);
                label->setProperty("look", column == 1 ? "" : "muted");
                grid->addWidget(label, row, column, column == 0 ? Qt::AlignLeft : Qt::AlignRight);
                ++column;
            }
            ++row;
        };
        grid->setColumnStretch(0, 1);
        if (!same) add({}, "this", "in use");
        for (const FigureChange& figure : compareFigures(present, version->version)) {
            const auto words = [&](const std::optional<double>& value) {
                return value ? figureWords(*value, figure.unit) : QString("-");
            };
            if (same)
                add(QString::fromStdString(figure.name), words(figure.after), {});
            else
                add(QString::fromStdString(figure.name), words(figure.after), words(figure.before));
        }
        if (same) return;
        for (const DeviceChange& device : compareDevices(present.installation, version->version.installation))
            add(QString::fromStdString(device.name),
                QString("%1 mm, %2°")
                    .arg(1000.0 * device.moved, 0, 'f', 1)
                    .arg(device.turned * 180.0 / std::numbers::pi, 0, 'f', 2),
                "apart");
    }

    CalibrateParts parts_;
    QWidget* empty_ = nullptr;
    QWidget* column_ = nullptr;
    QListWidget* list_;
    QPushButton* back_ = nullptr;
    QPushButton* remove_ = nullptr;
    QLabel* compared_ = nullptr;
    QWidget* table_ = nullptr;
    std::vector<KeptVersion> versions_;
};

} // namespace

QWidget* makeVersionsDock(const CalibrateParts& parts) { return new VersionsDock(parts); }

} // namespace lumorph::studio
