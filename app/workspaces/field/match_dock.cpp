#include "app/workspaces/field/match_dock.h"

#include <QHeaderView>
#include <QStackedLayout>
#include <QTreeView>
#include <QVBoxLayout>

#include "app/studio/document/hand_control.h"
#include "app/studio/document/state_rules.h"
#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/plot.h"
#include "app/studio/widgets/throttle.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/driver_hint.h"
#include "app/workspaces/field/error_curves.h"
#include "app/workspaces/field/match_numbers.h"
#include "app/workspaces/field/vote_table.h"

namespace lumorph::studio {

namespace {

constexpr int kRowHeight = 24;
constexpr int kMostRowsShown = 8;
constexpr std::size_t kMostCurves = 36; ///< more would be a wall of numbers
/// A warning appears above the first share and goes below the second, so that it does not flicker.
constexpr double kWarnAbove = 0.02, kWarnBelow = 0.01;

/// One sentence of warning with its remedy as a button; R42.
class ShareWarning : public QWidget {
public:
    ShareWarning(const QString& name, const QString& sentence, QAction* remedy, QWidget* parent)
        : QWidget(parent), sentence_(sentence), text_(new QLabel(this)) {
        setObjectName(name);
        text_->setObjectName(name + ".text");
        text_->setWordWrap(true);
        text_->setProperty("look", "warning");
        auto* layout = new QHBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        layout->addWidget(text_, 1);
        remedy_ = makeCommandButton(remedy, name + ".remedy", this);
        layout->addWidget(remedy_, 0, Qt::AlignTop);
        hide();
    }
    void show(double share) {
        const bool wanted = share > (isHidden() ? kWarnAbove : kWarnBelow);
        if (wanted) text_->setText(sentence_.arg(shareText(share)));
        setVisible(wanted);
    }

    /// One button is enough where two warnings have the same remedy.
    void offerRemedy(bool offered) { remedy_->setVisible(offered); }

private:
    QString sentence_;
    QLabel* text_;
    QPushButton* remedy_ = nullptr;
};

class MatchDock : public QWidget {
public:
    MatchDock(Studio& studio, Throttle& numbers, const FitCertificate& certificate)
        : studio_(studio), due_(numbers), certificate_(certificate), stack_(new QStackedLayout(this)) {
        const auto empty = [&](const char* icon, const char* title, const char* text, const char* command) {
            stack_->addWidget(makeEmptyState(icon, title, text, studio.commands.find(command), this));
        };
        empty("target", "Nothing to match yet",
              "With a target the device takes its shape, and here stands how well it fits.", "");
        empty("field", "No field yet",
              "Matching asks the mechanical distance field of the device. It takes a moment to build.", "field.build");
        stack_->addWidget(column_.widget);
        column_.layout->addWidget(makeDriverHint(studio, "match.driver", column_.widget));
        column_.layout->addWidget(numbers_);
        addStale();
        addWarnings();
        addMethod();
        addActuators();
        addBudget();
        addTimes();
        column_.layout->addStretch(1);
        connect(&numbers, &Throttle::due, this, [this] { refresh(); });
        connect(&certificate, &FitCertificate::changed, &numbers, &Throttle::request);
        connect(&studio.document, &StudioDocument::changed, this, [this] { refresh(); });
        connect(&studio.driver, &DriverControl::changed, this, [this] { refresh(); });
        refresh();
    }

private:
    /// The field is of the rig before an edit.
    void addStale() {
        stale_ = new QWidget(this);
        stale_->setObjectName("match.stale");
        staleText_ = new QLabel(stale_);
        staleText_->setObjectName("match.stale.text");
        staleText_->setWordWrap(true);
        staleText_->setProperty("look", "warning");
        auto* layout = new QHBoxLayout(stale_);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        layout->addWidget(staleText_, 1);
        layout->addWidget(makeCommandButton(studio_.commands.find("field.build"), "match.stale.remedy", stale_), 0,
                          Qt::AlignTop);
        column_.layout->addWidget(stale_);
    }

    void showStale() {
        const StudioState& state = studio_.document.state();
        stale_->setVisible(state.field.stale);
        if (!state.field.stale) return;
        staleText_->setText(fieldFits(state) ? "The field is of the rig before your edit."
                                             : "The field has other actuators than the rig since your edit, so nothing "
                                               "is matched.");
    }

    void addWarnings() {
        QAction* remedy = studio_.commands.find("target.autoPlace");
        beyond_ = new ShareWarning("match.beyond", "%1 of the target reaches beyond the frame.", remedy, this);
        unreachable_ =
            new ShareWarning("match.unreachable", "%1 of the target is where no actuator reaches.", remedy, this);
        column_.layout->addWidget(beyond_);
        column_.layout->addWidget(unreachable_);
    }

    void addMethod() {
        auto* bar = new QWidget(column_.widget);
        auto* layout = new QHBoxLayout(bar);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        const auto add = [&](const char* command, const char* name) {
            layout->addWidget(makeCommandButton(studio_.commands.find(command), name, bar), 1);
        };
        add("match.refined", "match.method.refined");
        add("match.voting", "match.method.voting");
        layout->addSpacing(8);
        add("match.live", "match.live");
        column_.layout->addWidget(bar);
    }

    void addBudget() {
        budget_ = new ValueField(Quantity::plain, 1.0, 100.0, 8.0, column_.widget);
        budget_->setObjectName("match.budget");
        budget_->setStep(1.0);
        budget_->setToolTip("Milliseconds that refinement may take for each frame");
        const auto edit = [](double milliseconds) {
            return [budget = Microseconds(static_cast<std::int64_t>(milliseconds * 1000.0))](StudioState& state) {
                state.matching.budget = budget;
            };
        };
        connect(budget_, &ValueField::previewed, this,
                [this, edit](double value) { studio_.document.preview(edit(value)); });
        connect(budget_, &ValueField::committed, this, [this, edit](double value) {
            studio_.document.preview(edit(value));
            studio_.document.commitPreview("Change the budget");
        });
        connect(budget_, &ValueField::reverted, this, [this] { studio_.document.cancelPreview(); });
        column_.layout->addWidget(makeRow("&Budget in ms", budget_, column_.widget));
    }

    void addActuators() {
        column_.layout->addWidget(makeHeading("Actuators", column_.widget));
        model_ = new VoteModel(this);
        table_ = new QTreeView(column_.widget);
        table_->setObjectName("match.actuators");
        table_->setAccessibleName("What the match says for each actuator");
        table_->setModel(model_);
        table_->setRootIsDecorated(false);
        table_->setUniformRowHeights(true);
        table_->setFrameShape(QFrame::NoFrame);
        table_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        table_->header()->setStretchLastSection(false);
        table_->header()->setSectionResizeMode(VoteModel::nameColumn, QHeaderView::Stretch);
        table_->header()->setSectionResizeMode(VoteModel::levelColumn, QHeaderView::Fixed);
        table_->header()->resizeSection(VoteModel::levelColumn, fontMetrics().horizontalAdvance("out of reach") + 24);
        connect(table_->selectionModel(), &QItemSelectionModel::currentChanged, this, [this] {
            chosenByUser_ = chosenByUser_ || !preselecting_;
            plotSelected();
        });
        column_.layout->addWidget(table_);

        plot_ = new Plot(column_.widget);
        plot_->setObjectName("match.plot");
        plot_->setAccessibleName("Error at each level of the chosen actuator");
        plot_->setAxes("level", "error");
        plot_->setToolTip("Eq. 1: symmetric difference over intersection with the target, for each level of the chosen "
                          "actuator. The lowest point is its vote.");
        plot_->setEmptyText("No level of this actuator touches the target.");
        column_.layout->addWidget(plot_);
        addCurves();
    }

    void addCurves() {
        curvesHeading_ = makeHeading("Error by level", column_.widget);
        column_.layout->addWidget(curvesHeading_);
        curves_ = new ErrorCurves(column_.widget);
        curves_->setObjectName("match.curves");
        curves_->setAccessibleName("Error curves of all actuators; Shift and the arrow keys try levels");
        column_.layout->addWidget(curves_);
        const auto strokeOf = [this](int level) {
            const auto& field = studio_.document.state().field.field;
            return field ? level / static_cast<double>(std::max(1, field->field.levels - 1)) : 0.0;
        };
        connect(curves_, &ErrorCurves::chosen, this,
                [this](int actuator) { table_->setCurrentIndex(model_->index(actuator, 0)); });
        connect(curves_, &ErrorCurves::previewed, this, [this, strokeOf](int actuator, int level) {
            hand_.preview(static_cast<std::size_t>(actuator), strokeOf(level));
        });
        connect(curves_, &ErrorCurves::letGo, this, [this] { hand_.cancel(); });
        connect(curves_, &ErrorCurves::kept, this, [this, strokeOf](int actuator, int level) {
            hand_.commit(static_cast<std::size_t>(actuator), strokeOf(level));
        });
    }

    void showCurves(const MatchFrame& frame) {
        const std::size_t count = frame.rig ? frame.rig->actuatorCount() : 0;
        const bool shown = count > 0 && count <= kMostCurves;
        curvesHeading_->setVisible(shown);
        curves_->setVisible(shown);
        if (!shown) return;
        QStringList names;
        for (const Actuator& actuator : frame.rig->actuators()) names << QString::fromStdString(actuator.name);
        curves_->setNames(names);
        if (frame.matched && frame.votes) curves_->setVotes(frame.votes->actuators, frame.wanted);
        curves_->setCurrent(table_->currentIndex().row());
    }

    /// Until the user chooses, the first actuator that has a curve to show.
    void preselect(const MatchFrame& frame) {
        if (chosenByUser_ || curves_->trying() || !frame.matched || !frame.votes) return;
        const auto& votes = frame.votes->actuators;
        const int now = table_->currentIndex().row();
        if (now >= 0 && static_cast<std::size_t>(now) < votes.size() && votes[static_cast<std::size_t>(now)].reached)
            return;
        const auto first = std::ranges::find_if(votes, &ActuatorVote::reached);
        preselecting_ = true;
        table_->setCurrentIndex(first == votes.end() ? QModelIndex()
                                                     : model_->index(static_cast<int>(first - votes.begin()), 0));
        preselecting_ = false;
    }

    void addTimes() {
        times_ = new QLabel(column_.widget);
        times_->setObjectName("match.times");
        times_->setProperty("look", "muted");
        times_->setWordWrap(true);
        times_->setToolTip("Milliseconds of each stage of the newest frame");
        column_.layout->addWidget(times_);
    }

    void refresh() {
        const StudioState& state = studio_.document.state();
        stack_->setCurrentIndex(!state.target.target ? 0 : !state.field.field ? 1 : 2);
        showStale();
        const auto& frame = studio_.loop.frame();
        if (!isVisible() || !frame) return;
        const bool follows = studio_.driver.driver() == Driver::target;
        const bool left = isTargetLeft(studio_);
        for (QWidget* part :
             {static_cast<QWidget*>(numbers_), static_cast<QWidget*>(table_), static_cast<QWidget*>(plot_)})
            part->setEnabled(!left);
        numbers_->show(*frame, follows && state.matching.method == MatchMethod::refined);
        numbers_->showBound(frame->matched ? certificateText(certificate_.known(), frame->iouWanted) : QString());
        beyond_->show(frame->matched && !left ? frame->shareBeyondFrame : 0.0);
        unreachable_->show(frame->matched && !left ? frame->shareUnreachable : 0.0);
        const bool helps = !studio_.project.autoPlaced(); // it is not offered where it just ran
        beyond_->offerRemedy(helps);
        unreachable_->offerRemedy(helps && beyond_->isHidden());
        budget_->setEnabled(state.matching.method == MatchMethod::refined);
        budget_->setValue(static_cast<double>(state.matching.budget.count()) / 1000.0);
        showActuators(frame);
        showTimes(frame->ms);
    }

    void showActuators(const std::shared_ptr<const MatchFrame>& frame) {
        const int before = model_->rowCount();
        model_->setFrame(frame);
        const int rows = model_->rowCount();
        if (rows != before || table_->height() <= kRowHeight)
            table_->setFixedHeight(table_->header()->sizeHint().height() + 4 +
                                   std::min(rows, kMostRowsShown) * std::max(kRowHeight, table_->sizeHintForRow(0)));
        if (rows != before) chosenByUser_ = false;
        preselect(*frame);
        plotSelected();
        showCurves(*frame);
    }

    void plotSelected() {
        const auto& frame = studio_.loop.frame();
        const int row = table_->currentIndex().row();
        const bool known = frame && frame->matched && frame->votes && row >= 0 &&
                           static_cast<std::size_t>(row) < frame->votes->actuators.size();
        const ActuatorVote* vote = known ? &frame->votes->actuators[static_cast<std::size_t>(row)] : nullptr;
        if (!vote || !vote->reached) {
            plot_->setCurves({});
            plot_->setMark(-1.0);
            return;
        }
        const QString name = model_->index(row, VoteModel::nameColumn).data().toString();
        plot_->setCurves({{name, currentPalette().accent, errorCurve(*vote)}});
        const auto at = static_cast<std::size_t>(row);
        plot_->setMark(at < frame->wanted.size() ? frame->wanted[at].index : vote->level.index);
    }

    void showTimes(const MatchTimes& ms) {
        const auto number = [](double value) { return QString::number(value, 'f', 1); };
        times_->setText(QString("pose %1 · voxels %2 · voting %3 · refine %4 · deform %5 · frame %6 ms")
                            .arg(number(ms.pose), number(ms.voxelize), number(ms.match), number(ms.refine),
                                 number(ms.deform), number(ms.total)));
    }

    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        due_.request();
    }

    Studio& studio_;
    Throttle& due_;
    const FitCertificate& certificate_;
    QStackedLayout* stack_;
    Column column_ = makeColumn(this);
    MatchNumbers* numbers_ = new MatchNumbers(column_.widget);
    QWidget* stale_ = nullptr;
    QLabel* staleText_ = nullptr;
    ShareWarning* beyond_ = nullptr;
    ShareWarning* unreachable_ = nullptr;
    ValueField* budget_ = nullptr;
    VoteModel* model_ = nullptr;
    QTreeView* table_ = nullptr;
    Plot* plot_ = nullptr;
    QWidget* curvesHeading_ = nullptr;
    ErrorCurves* curves_ = nullptr;
    HandControl hand_{studio_.document, studio_.loop};
    bool chosenByUser_ = false;
    bool preselecting_ = false;
    QLabel* times_ = nullptr;
};

} // namespace

QWidget* makeMatchDock(Studio& studio, Throttle& numbers, const FitCertificate& certificate) {
    return new MatchDock(studio, numbers, certificate);
}

} // namespace lumorph::studio
