#include <QLabel>
#include <QPointer>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/rig/rig_docks.h"
#include "app/workspaces/rig/rig_facts.h"

namespace lumorph::studio {

namespace {

constexpr int kStates = 100;

class RigReport : public QWidget {
public:
    explicit RigReport(Studio& studio) : studio_(studio), pages_(new QStackedWidget(this)) {
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
                                         "Looks the mesh over, at rest and in 100 random states, and measures what "
                                         "shapes the rig can take.",
                                         check_));
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & (StatePart::rig | StatePart::rigEdited)) follow();
        });
        follow();
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
        if (pages_->count() < 2) return;
        QWidget* old = pages_->widget(1);
        pages_->removeWidget(old);
        old->deleteLater();
    }

    void check() {
        if (!rig_) return;
        const std::shared_ptr<const Rig> rig = rig_;
        const QPointer<RigReport> alive(this);
        studio_.jobs.run<std::shared_ptr<const ShapeReport>>(
            "rig", "Checking the rig",
            [rig](const Progress& progress) {
                return std::make_shared<const ShapeReport>(shapeReport(*rig, kStates, 1, progress));
            },
            [alive, rig](const std::shared_ptr<const ShapeReport>& report) {
                if (alive && alive->isOf(*rig)) alive->show(*report);
            },
            [alive](const std::exception& error) {
                if (alive) alive->studio_.notices.post("rig", noticeOf(error));
            });
    }

    void show(const ShapeReport& report) {
        clear();
        const Column column = makeColumn();
        addVerdict(report, column);
        column.layout->addWidget(makeHeading("Mesh at rest"));
        column.layout->addWidget(makeFacts(meshFacts(report), "rig.mesh.", column.widget));
        column.layout->addWidget(makeHeading("Shape"));
        column.layout->addWidget(makeFacts(shapeFacts(report), "rig.shape.", column.widget));
        column.layout->addWidget(makeCommandButton(check_, "rig.checkAgain", column.widget));
        column.layout->addStretch(1);
        pages_->addWidget(column.widget);
        pages_->setCurrentIndex(1);
    }

    void addVerdict(const ShapeReport& report, const Column& column) {
        const auto add = [&](const QString& text, const char* look) {
            auto* label = new QLabel(text, column.widget);
            label->setObjectName(QString("rig.report.") + look);
            label->setProperty("look", look);
            label->setWordWrap(true);
            column.layout->addWidget(label);
        };
        if (report.warnings.empty()) {
            add("The rig is a clean solid in every state looked at.", "title");
            return;
        }
        for (const std::string& warning : report.warnings) add(QString::fromStdString(warning), "warning");
        add("What is covered is worked out from the solid, so that faults make matches wrong. Mend the mesh in a "
            "modeller, or narrow the ranges in which it fails, and open the rig again.",
            "muted");
        column.layout->addWidget(
            makeCommandButton(studio_.commands.find("rig.open"), "rig.report.open", column.widget));
    }

    Studio& studio_;
    QStackedWidget* pages_;
    QAction* check_ = nullptr;
    std::shared_ptr<const Rig> rig_;
};

} // namespace

QWidget* makeRigReport(Studio& studio) { return new RigReport(studio); }

} // namespace lumorph::studio
