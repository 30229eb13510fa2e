#include "app/workspaces/field/actuator_dock.h"

#include <algorithm>
#include <memory>
#include <vector>

#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/throttle.h"
#include "app/workspaces/common/driver_hint.h"
#include "app/workspaces/field/actuator_grid.h"
#include "app/workspaces/field/actuator_row.h"

namespace lumorph::studio {

namespace {

/// More actuators than this do not have a row each.
constexpr std::size_t kMostRows = 24;
constexpr int kRefreshMilliseconds = 40;

class ActuatorDock : public QWidget {
public:
    explicit ActuatorDock(Studio& studio)
        : studio_(studio), hand_(studio.document, studio.loop), refresh_(new Throttle(kRefreshMilliseconds, this)) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeButtons());
        layout->addWidget(column_.widget, 1);
        layout->addWidget(makeHint());
        connect(&studio.loop, &StudioLoop::framed, refresh_, &Throttle::request);
        connect(refresh_, &Throttle::due, this, [this] {
            if (isVisible()) refresh();
        });
        // Building rows takes long, and a rig is dragged in another workspace, where this dock is hidden.
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (!isVisible()) return;
            if (parts & (StatePart::rig | StatePart::rigEdited | StatePart::field)) rebuild();
            refresh();
        });
        rebuild();
        refresh();
    }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        rebuild();
        refresh();
    }

private:
    QWidget* makeButtons() {
        auto* bar = new QWidget(this);
        auto* layout = new QGridLayout(bar);
        layout->setContentsMargins(16, 12, 16, 4);
        layout->setSpacing(8);
        int column = 0;
        for (const char* id : {"rest", "random", "dance"})
            layout->addWidget(
                makeCommandButton(studio_.commands.find(QString("rig.") + id), QString("actuators.") + id, bar), 0,
                column++);
        layout->addWidget(makeCommandButton(studio_.commands.find("poses.keep"), "actuators.keep", bar), 1, 0, 1,
                          column);
        return bar;
    }

    QWidget* makeHint() {
        QWidget* hint = makeDriverHint(studio_, "actuators.hint", this);
        hint->layout()->setContentsMargins(16, 8, 16, 12);
        return hint;
    }

    [[nodiscard]] int levelsOf(const Actuator& actuator) const {
        const auto& field = studio_.document.state().field.field;
        return field ? field->field.levels : actuator.levels;
    }

    /// Whether rows of this rig would be those that are shown, as with most edits of it.
    [[nodiscard]] bool looksAs(const std::shared_ptr<const Rig>& rig) const {
        if (rig == rig_ || !rig || !rig_) return rig == rig_;
        return std::ranges::equal(rig->actuators(), rig_->actuators(), [](const Actuator& a, const Actuator& b) {
            return a.name == b.name && a.levels == b.levels && a.deformer == b.deformer;
        });
    }

    void rebuild() {
        const auto& rig = studio_.document.state().rig.rig;
        const auto& field = studio_.document.state().field.field;
        if (field == field_ && built_ && looksAs(rig)) return;
        rig_ = rig;
        field_ = field;
        built_ = true;
        clear();
        if (!rig) {
            column_.layout->addWidget(makeEmptyState("actuator", "No device yet",
                                                     "Open a rig, or begin a new project with the tablet.",
                                                     studio_.commands.find("file.new"), column_.widget));
            return;
        }
        if (rig->actuatorCount() > kMostRows)
            makeGrid();
        else
            for (std::size_t i = 0; i < rig->actuatorCount(); ++i) addRow(i, QString::number(i));
        column_.layout->addStretch(1);
    }

    void clear() {
        rows_.clear();
        grid_ = nullptr;
        while (QLayoutItem* item = column_.layout->takeAt(0)) {
            delete item->widget();
            delete item;
        }
    }

    void addRow(std::size_t index, const QString& name, int at = -1) {
        const Actuator& actuator = rig_->actuators()[index];
        auto* row = new ActuatorRow(hand_, name, index, actuator, levelsOf(actuator), column_.widget);
        column_.layout->insertWidget(at, row);
        rows_.push_back({index, row});
    }

    void makeGrid() {
        QStringList names;
        for (const Actuator& actuator : rig_->actuators()) names << QString::fromStdString(actuator.name);
        grid_ = new ActuatorGrid(column_.widget);
        grid_->setObjectName("actuators.grid");
        grid_->setAccessibleName("Levels of all actuators");
        grid_->setNames(names);
        addRow(0, "current");
        column_.layout->addWidget(grid_);
        connect(grid_, &ActuatorGrid::currentChanged, this, [this](int index) {
            delete rows_.front().widget;
            rows_.clear();
            addRow(static_cast<std::size_t>(index), "current", 0);
            refresh();
        });
    }

    void refresh() {
        const StudioState& state = studio_.document.state();
        const Driver driver = studio_.driver.driver();
        const bool driven = driver != Driver::hand && studio_.driver.whyNot(driver).isEmpty() &&
                            (driver != Driver::target || state.field.field);
        if (!rig_) return;
        const auto& frame = studio_.loop.frame();
        const std::vector<double> wanted = hand_.strokes();
        const bool known = frame && isOf(*frame, state) && frame->estimatedStrokes.size() == wanted.size();
        const std::vector<double>& estimated = known ? frame->estimatedStrokes : wanted;
        for (const Row& row : rows_) {
            row.widget->setLive(driven);
            row.widget->show(wanted[row.actuator], estimated[row.actuator]);
        }
        if (!grid_) return;
        grid_->setLive(driven);
        grid_->setStrokes(wanted, estimated);
    }

    struct Row {
        std::size_t actuator = 0;
        ActuatorRow* widget = nullptr;
    };

    Studio& studio_;
    HandControl hand_;
    Throttle* refresh_;
    Column column_ = makeColumn(this);
    ActuatorGrid* grid_ = nullptr;
    std::vector<Row> rows_;
    std::shared_ptr<const Rig> rig_;
    std::shared_ptr<const MatchField> field_;
    bool built_ = false;
};

} // namespace

QWidget* makeActuatorDock(Studio& studio) { return new ActuatorDock(studio); }

} // namespace lumorph::studio
