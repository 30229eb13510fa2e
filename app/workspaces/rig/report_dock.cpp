#include <algorithm>

#include <QHideEvent>
#include <QLabel>
#include <QPointer>
#include <QPushButton>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/field_summary.h"
#include "app/workspaces/rig/finding_row.h"
#include "app/workspaces/rig/rig_docks.h"
#include "app/workspaces/rig/rig_facts.h"

namespace lumorph::studio {

namespace {

constexpr int kStates = 100;
constexpr std::size_t kMostRows = 50;
constexpr const char* kMaxStretch = "rig/maxStretch";
constexpr const char* kMaxSpeed = "rig/maxSpeed";

struct Checked {
    ShapeReport report;
    RigCheck check;
};

class RigReport : public QWidget {
public:
    RigReport(Studio& studio, RigSelection& selection)
        : studio_(studio), selection_(selection), pages_(new QStackedWidget(this)) {
        Commands::Options options;
        options.icon = "check";
        options.menu = "Actuators";
        options.workspace = "rig";
        check_ = studio.commands.add("rig.check", "Check the rig", options, [this] { check(); });
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeJobBar(studio.jobs, "rig"));
        layout->addWidget(pages_, 1);
        pages_->setObjectName("rig.report.pages");
        pages_->addWidget(makeEmptyState("check", "Is the rig sound?",
                                         "Looks at each actuator at every level, and at all of them together: "
                                         "whether the surface opens, crosses itself or stretches too far, whether "
                                         "parts collide, and whether anything moves fast enough to startle.",
                                         check_));
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & (StatePart::rig | StatePart::rigEdited)) follow();
        });
        connect(&selection, &RigSelection::rehearsalChanged, this, [this] {
            if (!selection_.inspectedPlace()) chooseRow(nullptr);
        });
        follow();
    }

protected:
    void hideEvent(QHideEvent* event) override {
        QWidget::hideEvent(event);
        leaveView();
    }

private:
    void follow() {
        const auto& rig = studio_.document.state().rig.rig;
        check_->setEnabled(rig != nullptr);
        if (!rig || !isOf(*rig)) clear();
        rig_ = rig;
    }

    /// What was found is true of edits that leave the shape as it is.
    [[nodiscard]] bool isOf(const Rig& rig) const { return rig_ && deformAlike(rig_->parts(), rig.parts()); }

    void clear() {
        leaveView();
        rows_.clear();
        back_ = nullptr;
        if (pages_->count() < 2) return;
        QWidget* old = pages_->widget(1);
        pages_->removeWidget(old);
        old->deleteLater();
    }

    void check() {
        if (!rig_) return;
        const std::shared_ptr<const Rig> rig = rig_;
        const QPointer<RigReport> alive(this);
        studio_.jobs.run<std::shared_ptr<const Checked>>(
            "rig", "Checking the rig",
            [rig, limits = limits()](const Progress& progress) {
                auto checked = std::make_shared<Checked>();
                checked->report = shapeReport(*rig, kStates, 1, progress.part(0.0, 0.4));
                checked->check = checkRig(*rig, limits, progress.part(0.4, 1.0));
                return std::shared_ptr<const Checked>(std::move(checked));
            },
            [alive, rig](const std::shared_ptr<const Checked>& checked) {
                if (alive && alive->isOf(*rig)) alive->show(*rig, *checked);
            },
            [alive](const std::exception& error) {
                if (alive) alive->studio_.notices.post("rig", noticeOf(error));
            });
    }

    [[nodiscard]] RigCheckOptions limits() const {
        RigCheckOptions options;
        options.states = kStates;
        options.maxStretch = studio_.settings.value(kMaxStretch, options.maxStretch).toDouble();
        options.maxSpeed = studio_.settings.value(kMaxSpeed, options.maxSpeed).toDouble();
        return options;
    }

    void show(const Rig& rig, const Checked& checked) {
        clear();
        const Column column = makeColumn();
        addVerdict(checked, column);
        addFindings(rig, checked.check, column);
        addWarnings(checked.report.warnings, column);
        column.layout->addWidget(makeHeading("Limits"));
        addLimits(column);
        column.layout->addWidget(makeHeading("Mesh at rest"));
        column.layout->addWidget(makeFacts(meshFacts(checked.report), "rig.mesh.", column.widget));
        column.layout->addWidget(makeHeading("Shape"));
        column.layout->addWidget(makeFacts(shapeFacts(checked.report), "rig.shape.", column.widget));
        column.layout->addWidget(makeCommandButton(check_, "rig.checkAgain", column.widget));
        column.layout->addStretch(1);
        pages_->addWidget(column.widget);
        pages_->setCurrentIndex(1);
    }

    void addFindings(const Rig& rig, const RigCheck& check, const Column& column) {
        auto* looked = new QLabel(QString("Looked at %1 levels of single actuators, %2 %3 that can meet, and %4 joint "
                                          "states.")
                                      .arg(countText(static_cast<std::size_t>(check.levelsLookedAt)),
                                           countText(static_cast<std::size_t>(check.pairsLookedAt)),
                                           check.pairsLookedAt == 1 ? "pair" : "pairs",
                                           countText(static_cast<std::size_t>(check.jointStates))),
                                  column.widget);
        looked->setObjectName("rig.report.looked");
        looked->setProperty("look", "muted");
        looked->setWordWrap(true);
        column.layout->addWidget(looked);
        for (std::size_t k = 0; k < std::min(kMostRows, check.findings.size()); ++k)
            column.layout->addWidget(makeRowOf(rig, check.findings[k], column.widget));
        if (check.findings.size() > kMostRows)
            column.layout->addWidget(new QLabel(
                QString("... and %1 more").arg(countText(check.findings.size() - kMostRows)), column.widget));
        back_ = new QPushButton("Show the device as it stands", column.widget);
        back_->setObjectName("rig.finding.back");
        back_->hide();
        connect(back_, &QPushButton::clicked, this, [this] { leaveView(); });
        column.layout->addWidget(back_);
    }

    QWidget* makeRowOf(const Rig& rig, const RigFinding& finding, QWidget* parent) {
        auto* row = new FindingRow(finding, parent);
        row->setObjectName(QString("rig.finding.%1").arg(rows_.size()));
        rows_.push_back(row);
        connect(row, &FindingRow::clicked, this, [this, row, finding, count = rig.actuatorCount()] {
            if (!row->isChecked()) return leaveView();
            chooseRow(row);
            if (!finding.actuators.empty()) selection_.select(finding.actuators.front());
            if (finding.worst.size() == count) selection_.inspect(finding.worst, finding.place);
        });
        return row;
    }

    void chooseRow(FindingRow* chosen) {
        for (FindingRow* row : rows_) row->setChecked(row == chosen);
        if (back_) back_->setVisible(chosen != nullptr);
    }

    /// The view is the device's again, unless another dock has it.
    void leaveView() {
        if (selection_.inspectedPlace()) selection_.rehearse({});
        chooseRow(nullptr);
    }

    void addLimits(const Column& column) {
        const RigCheckOptions now = limits();
        const auto add = [&](const QString& label, const char* key, Quantity quantity, double value, double usual,
                             double most, const QString& why) {
            auto* field = new ValueField(quantity, 0.0, most, usual, column.widget);
            field->setObjectName(QString(key).replace('/', '.'));
            field->setValue(value);
            field->setToolTip(why);
            connect(field, &ValueField::committed, this, [this, key](double to) {
                studio_.settings.setValue(key, to);
                check();
            });
            column.layout->addWidget(makeRow(label, field, column.widget));
        };
        add("Material &gives", kMaxStretch, Quantity::share, now.maxStretch, RigCheckOptions{}.maxStretch, 10.0,
            "How much longer than at rest the upper surface may get. Knitted fabric with elastane gives about its own "
            "length (100 %), woven cloth a tenth or two, paper next to nothing.");
        add("S&tartles above (m/s)", kMaxSpeed, Quantity::plain, now.maxSpeed, RigCheckOptions{}.maxSpeed, 10.0,
            "How fast a point of the surface may get. 0.25 m/s is what robots may do with people in reach while they "
            "are set up (ISO 10218-1).");
    }

    static void addText(const QString& text, const char* look, const Column& column) {
        auto* label = new QLabel(text, column.widget);
        label->setObjectName(QString("rig.report.") + look);
        label->setProperty("look", look);
        label->setWordWrap(true);
        column.layout->addWidget(label);
    }

    static void addVerdict(const Checked& checked, const Column& column) {
        const std::size_t count = checked.check.findings.size();
        const bool sound = count == 0 && checked.report.warnings.empty();
        addText(sound        ? QString("The rig is a clean solid in every state looked at.")
                : count == 0 ? QString("Something is wrong")
                : count == 1 ? QString("One thing to look at")
                             : countText(count) + " things to look at",
                "title", column);
    }

    void addWarnings(const std::vector<std::string>& warnings, const Column& column) {
        if (warnings.empty()) return;
        for (const std::string& warning : warnings) addText(shownText(warning), "warning", column);
        addText("What is covered is worked out from the solid, so that faults make matches wrong. Mend the mesh in a "
                "modeller, or narrow the ranges in which it fails, and open the rig again.",
                "muted", column);
        column.layout->addWidget(
            makeCommandButton(studio_.commands.find("rig.open"), "rig.report.open", column.widget));
    }

    Studio& studio_;
    RigSelection& selection_;
    QStackedWidget* pages_;
    QPushButton* back_ = nullptr;
    std::vector<FindingRow*> rows_; ///< of the page that is shown
    QAction* check_ = nullptr;
    std::shared_ptr<const Rig> rig_;
};

} // namespace

QWidget* makeRigReport(Studio& studio, RigSelection& selection) { return new RigReport(studio, selection); }

} // namespace lumorph::studio
