#include "app/workspaces/field/field_dock.h"

#include <algorithm>

#include <QElapsedTimer>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "app/workspaces/common/field_summary.h"
#include "app/workspaces/field/field_build.h"
#include "app/workspaces/field/field_show.h"

namespace lumorph::studio {
namespace {

const QString kFieldPlace = QStringLiteral("field");

/// What the field is, as rows of a name and a value, and warnings below.
class FieldFacts : public QWidget {
public:
    FieldFacts() : grid_(new QGridLayout(this)) {
        grid_->setContentsMargins(0, 0, 0, 0);
        grid_->setHorizontalSpacing(16);
        grid_->setVerticalSpacing(4);
        grid_->setColumnStretch(1, 1);
    }

    void tell(const FieldSummary& summary) {
        while (QLayoutItem* item = grid_->takeAt(0)) {
            // A label may be what the keyboard is on while undo brings us here, so it goes a little later.
            item->widget()->hide();
            item->widget()->setObjectName({});
            item->widget()->deleteLater();
            delete item;
        }
        int row = 0;
        for (const FieldSummary::Fact& fact : summary.facts) addFact(fact, row++);
        for (const QString& warning : summary.warnings) {
            auto* label = new QLabel(warning);
            label->setObjectName("field.warning");
            label->setProperty("look", "warning");
            label->setWordWrap(true);
            grid_->addWidget(label, row++, 0, 1, 2);
        }
    }

private:
    void addFact(const FieldSummary::Fact& fact, int row) {
        auto* name = new QLabel(fact.name);
        name->setProperty("look", "muted");
        auto* value = new QLabel(fact.value);
        value->setWordWrap(true);
        value->setTextInteractionFlags(Qt::TextSelectableByMouse);
        QString id = fact.name.toLower();
        value->setObjectName("field.fact." + id.replace(' ', '-'));
        for (QLabel* label : {name, value}) {
            label->setToolTip(fact.why);
            label->setAlignment(Qt::AlignLeft | Qt::AlignTop);
        }
        grid_->addWidget(name, row, 0);
        grid_->addWidget(value, row, 1);
    }

    QGridLayout* grid_;
};

class FieldDock : public QWidget {
public:
    FieldDock(Studio& studio, FieldDisplayModel& display);

private:
    void addBuildCommand();
    QWidget* makeContents(FieldDisplayModel& display);
    void watchBuilds();
    void refresh();

    Studio& studio_;
    QAction* build_ = nullptr;
    QStackedWidget* pages_;
    FieldFacts* facts_ = nullptr;
    QElapsedTimer since_; ///< the build that runs was started; invalid while none does
    std::weak_ptr<const MatchField> shown_;
    bool stale_ = false;
};

FieldDock::FieldDock(Studio& studio, FieldDisplayModel& display) : studio_(studio), pages_(new QStackedWidget) {
    addBuildCommand();
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
    layout->addWidget(makeNoticeBar(studio.notices, kFieldPlace));
    layout->addWidget(makeJobBar(studio.jobs, kFieldPlace));
    layout->addWidget(pages_, 1);
    pages_->setObjectName("field.pages");
    pages_->addWidget(makeEmptyState(
        "field", tr("No field yet"),
        tr("The mechanical distance field says what space each actuator fills at each level. Matching needs it."),
        build_));
    pages_->addWidget(makeContents(display));
    watchBuilds();
    connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & (StateParts(StatePart::field) | StatePart::rig)) refresh();
    });
    refresh();
}

void FieldDock::addBuildCommand() {
    build_ = studio_.commands.find("field.build");
    if (build_ != nullptr) return;
    Commands::Options options;
    options.icon = "build";
    options.menu = "Actuators";
    options.workspace = "field";
    build_ = studio_.commands.add("field.build", tr("Build the Field..."), options,
                                  [this] { openBuildDialog(studio_, window()); });
}

QWidget* FieldDock::makeContents(FieldDisplayModel& display) {
    const Column column = makeColumn();
    facts_ = new FieldFacts;
    auto* finer = new QPushButton(tr("Build a finer field..."));
    finer->setObjectName("field.finer");
    connect(finer, &QPushButton::clicked, build_, &QAction::trigger);
    column.layout->addWidget(makeHeading(tr("Show")));
    column.layout->addWidget(makeFieldShow(studio_, display));
    column.layout->addWidget(makeHeading(tr("Ramps of a voxel")));
    column.layout->addWidget(makeVoxelRamps(studio_, display));
    column.layout->addWidget(makeHeading(tr("What it is")));
    column.layout->addWidget(facts_);
    column.layout->addWidget(finer);
    column.layout->addStretch(1);
    return column.widget;
}

/// A build is timed from here, because the result is handed over without its time.
void FieldDock::watchBuilds() {
    connect(&studio_.jobs, &Jobs::started, this, [this](int id) {
        const std::vector<Jobs::Status> running = studio_.jobs.running();
        const auto found = std::find_if(running.begin(), running.end(), [id](const Jobs::Status& job) {
            return job.id == id && job.place == kFieldPlace;
        });
        if (found != running.end()) since_.start();
    });
}

void FieldDock::refresh() {
    const StudioState& state = studio_.document.state();
    const auto& field = state.field.field;
    build_->setEnabled(state.rig.rig != nullptr);
    pages_->setCurrentIndex(field ? 1 : 0);
    if (!field || (field == shown_.lock() && state.field.stale == stale_)) return;
    shown_ = field;
    stale_ = state.field.stale;
    const bool built = state.field.path.empty() && since_.isValid();
    FieldSummary summary =
        summaryOf(field->field, state.field.path,
                  built ? std::optional(static_cast<double>(since_.elapsed()) / 1000.0) : std::nullopt);
    if (stale_)
        summary.warnings.insert(summary.warnings.begin(),
                                tr("It is of the rig before your edit, so matches are a little off. Build it again."));
    facts_->tell(summary);
    since_.invalidate();
}

} // namespace

QWidget* makeFieldDock(Studio& studio, FieldDisplayModel& display) { return new FieldDock(studio, display); }

} // namespace lumorph::studio
