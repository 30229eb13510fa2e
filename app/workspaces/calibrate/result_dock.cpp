#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include <QDateTime>
#include <QGridLayout>
#include <QLabel>
#include <QLocale>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/segments.h"
#include "app/workspaces/calibrate/calibrate_docks.h"
#include "app/workspaces/calibrate/finding_card.h"
#include "app/workspaces/calibrate/residual_plots.h"
#include "calibration/report/calibration_record.h"

namespace lumorph::studio {
namespace {

/// Without the second number where it is not known.
QString plusMinus(double value, double sigma, int decimals) {
    if (!whereSaid(sigma)) return QString("%1 px").arg(value, 0, 'f', decimals);
    return QString("%1 ± %2 px").arg(value, 0, 'f', decimals).arg(sigma, 0, 'f', decimals + (sigma < 1.0 ? 1 : 0));
}

QString errorWords(double error) {
    return whereSaid(error) ? QString("%1 px").arg(error, 0, 'f', 3) : QString("unknown");
}

class ResultDock : public QWidget {
public:
    explicit ResultDock(const CalibrateParts& parts) : parts_(parts) {
        auto* whole = new QVBoxLayout(this);
        whole->setContentsMargins(0, 0, 0, 0);
        empty_ = makeEmptyState("target", "No result yet",
                                "How exact camera and projector are known, and how far light can be trusted on the "
                                "table, is told here once enough poses are there.",
                                nullptr, this);
        whole->addWidget(empty_);
        const Column column = makeColumn(this);
        result_ = column.widget;
        whole->addWidget(result_);
        findings_ = new QWidget(this);
        auto* list = new QVBoxLayout(findings_);
        list->setContentsMargins(0, 0, 0, 0);
        list->setSpacing(8);
        column.layout->addWidget(findings_);
        addFigures(*column.layout);
        addPlots(*column.layout);
        auto* files = new QHBoxLayout;
        files->setSpacing(8);
        for (const char* id : {"calibrate.report", "calibrate.export", "calibrate.import"})
            files->addWidget(makeCommandButton(parts.studio.commands.find(id), QString("result.") + id, this), 1);
        whole->addLayout(files);
        files->setContentsMargins(16, 0, 16, 8);
        connect(&parts.service, &CalibrationService::changed, this, [this] { refresh(); });
        connect(&parts.selection, &CalibrateSelection::changed, this, [this] { showPlots(); });
        refresh();
    }

private:
    void addFigures(QVBoxLayout& column) {
        figures_ = new QWidget(this);
        auto* part = new QVBoxLayout(figures_);
        part->setContentsMargins(0, 0, 0, 0);
        part->setSpacing(4);
        headline_ = new QLabel(this);
        headline_->setObjectName("calibrate.headline");
        makeLarge(headline_, 24, "0.00 mm");
        part->addWidget(headline_);
        headlineWords_ = new QLabel(this);
        headlineWords_->setObjectName("calibrate.headline.words");
        headlineWords_->setProperty("look", "muted");
        headlineWords_->setWordWrap(true);
        part->addWidget(headlineWords_);
        part->addWidget(makeHeading("Figures", this));
        auto* grid = new QGridLayout;
        grid->setHorizontalSpacing(8);
        grid->setVerticalSpacing(4);
        grid->setColumnStretch(0, 1);
        const struct {
            const char* id;
            const char* name;
            const char* tip;
        } facts[] = {
            {"truth", "Truly beside", "Known in the lab alone: how far light really lands beside on the table"},
            {"mapMean", "By uncertainty, mean",
             "What the uncertainties of all parameters make of it, within 10 cm of the "
             "middle: 95 of 100"},
            {"mapWorst", "By uncertainty, worst", "The same at the worst place"},
            {"heldOutMm", "By held-out poses", "What poses that were left out of the solution show: 95 of 100"},
            {"heldOut", "Held out, worst",
             "A pose that was left out of the solution: how far the others put its light "
             "beside, in projector pixels"},
            {"halves", "Two halves differ",
             "Both halves of the poses solved apart: how far they put the same light from "
             "each other, and how far noise allows"},
            {"cameraError", "Camera error", "Root mean square distance of the board's points from the solution"},
            {"projectorError", "Projector error", "The same of decoded points in the projector"},
            {"projectorFocal", "Projector focal", "With its standard deviation"},
            {"projectorCentre", "Projector centre", "Principal point; a lens shift puts it outside of the picture"},
            {"cameraFocal", "Camera focal", "With its standard deviation"},
            {"lenses", "Lens models", "The simplest that tells held-out poses about as well as the best"},
            {"date", "Solved", ""}};
        for (const auto& fact : facts) {
            auto* name = new QLabel(fact.name, this);
            name->setProperty("look", "muted");
            QLabel* value = makeNumber(QString("calibrate.figure.") + fact.id, "", this);
            value->setAccessibleName(fact.name);
            value->setTextInteractionFlags(Qt::TextSelectableByMouse);
            for (QLabel* one : {name, value}) one->setToolTip(fact.tip);
            const int row = grid->rowCount();
            grid->addWidget(name, row, 0);
            grid->addWidget(value, row, 1, Qt::AlignRight);
            values_.emplace_back(fact.id, name, value);
        }
        part->addLayout(grid);
        column.addWidget(figures_);
    }

    void addPlots(QVBoxLayout& column) {
        plots_ = new QWidget(this);
        auto* part = new QVBoxLayout(plots_);
        part->setContentsMargins(0, 0, 0, 0);
        part->setSpacing(8);
        part->addWidget(makeHeading("Errors by pose, pixels", this));
        bars_ = new PoseBars(this);
        part->addWidget(bars_);
        residualParts_ = new QWidget(plots_);
        auto* over = new QVBoxLayout(residualParts_);
        over->setContentsMargins(0, 0, 0, 0);
        over->setSpacing(8);
        over->addWidget(makeHeading("Errors over the image", this));
        device_ =
            new Segments({{"calibrate.residuals.camera", "Camera", "Points of the board in the camera's image"},
                          {"calibrate.residuals.projector", "Projector", "Decoded points in the projector's image"}},
                         this);
        device_->setChosen(0);
        over->addWidget(device_);
        field_ = new ResidualField(this);
        over->addWidget(field_);
        part->addWidget(residualParts_);
        column.addWidget(plots_);
        connect(bars_, &PoseBars::chosen, this,
                [this](const QString& pose) { parts_.selection.setPose(pose.toStdString()); });
        connect(device_, &Segments::chosen, this, [this](int device) {
            isProjector_ = device == 1;
            showPlots();
        });
    }

    void set(const char* id, const QString& text) {
        for (const auto& [one, name, value] : values_) {
            if (QString(one) != id) continue;
            value->setText(text);
            value->setVisible(!text.isEmpty());
            name->setVisible(!text.isEmpty());
        }
    }

    void refresh() {
        const CalibrationState& state = parts_.service.state();
        std::vector<std::pair<Finding, bool>> findings;
        if (state.refusal) findings.emplace_back(*state.refusal, true);
        for (const CalibrationPose& pose : state.poses)
            if (pose.refusal && !pose.leftOut) findings.emplace_back(*pose.refusal, true);
        if (state.result) {
            for (const Finding& doubt : doubtsOf(*state.result)) findings.emplace_back(doubt, false);
            for (const Finding& remark : remarksOf(*state.result)) findings.emplace_back(remark, false);
        } else {
            for (const CalibrationPose& pose : state.poses)
                if (!pose.leftOut)
                    for (const Finding& warning : pose.warnings) findings.emplace_back(warning, false);
        }
        const bool any = state.result || !findings.empty();
        empty_->setVisible(!any && state.setup.way != CaptureWay::crosshairs); // whose figures are in the middle
        result_->setVisible(any);
        if (findings != shown_) {
            shown_ = findings;
            while (QLayoutItem* item = findings_->layout()->takeAt(0)) {
                delete item->widget();
                delete item;
            }
            for (const auto& [finding, refusal] : findings)
                findings_->layout()->addWidget(
                    makeFindingCard(refusal ? wordsOf(finding) : wordsOfDoubt(finding), refusal, findings_));
        }
        figures_->setVisible(state.result != nullptr);
        // A file has no points to draw; of poses it may have figures.
        plots_->setVisible(state.result && (!state.result->residuals.empty() || !state.result->solved.views.empty()));
        residualParts_->setVisible(state.result && !state.result->residuals.empty());
        if (state.result) showFigures(*state.result);
        showPlots();
    }

    void showFigures(const CalibrationResult& result) {
        const ProcamCalibration& solved = result.solved;
        const auto within = result.millimetres();
        const bool isImported = parts_.service.state().isImported;
        const bool hasProjector = !solved.projector.size.empty();
        headline_->setText(within ? QString("%1 mm").arg(*within, 0, 'f', 2) : "not known");
        headlineWords_->setText(!hasProjector ? "A camera alone casts no light; the file has no projector."
                                : within && isImported
                                    ? "Light lands no farther beside on the file's boards, in 95 of 100 cases."
                                : within ? "Light lands no farther beside where the device stands, in 95 of 100 cases."
                                : isImported ? "The file does not say how far light lands beside."
                                             : "With more poses the studio can tell how far light lands beside.");
        const auto millimetres = [](const std::optional<double>& value) {
            return value && std::isfinite(*value) ? QString("%1 mm").arg(*value, 0, 'f', 2) : QString();
        };
        set("mapMean", result.plan ? millimetres(result.plan->mean) : QString());
        set("mapWorst", result.plan ? millimetres(result.plan->worst) : QString());
        set("heldOutMm", millimetres(result.heldOutMillimetres));
        set("truth", result.trueMillimetres ? QString("%1 mm").arg(*result.trueMillimetres, 0, 'f', 2) : QString());
        double worst = -1.0;
        for (const ViewQuality& view : solved.views) worst = std::max(worst, view.heldOut.value_or(-1.0));
        set("heldOut", worst < 0.0 ? QString() : QString("%1 px").arg(worst, 0, 'f', 2));
        set("halves",
            solved.halvesDiffer && solved.halvesAllowed
                ? QString("%1 of %2 px").arg(*solved.halvesDiffer, 0, 'f', 2).arg(*solved.halvesAllowed, 0, 'f', 2)
                : QString());
        set("cameraError", errorWords(solved.camera.rms));
        set("projectorError", hasProjector ? errorWords(solved.projector.rms) : QString());
        const auto focal = [](const CalibratedDevice& device) {
            return plusMinus(device.lens[kFocalLength], device.sigma[kFocalLength], 1);
        };
        set("projectorFocal", hasProjector ? focal(solved.projector) : QString());
        set("cameraFocal", focal(solved.camera));
        set("projectorCentre", hasProjector ? QString("%1, %2 px")
                                                  .arg(solved.projector.lens[kPrincipalX], 0, 'f', 1)
                                                  .arg(solved.projector.lens[kPrincipalY], 0, 'f', 1)
                                            : QString());
        set("lenses",
            QString::fromStdString(solved.camera.model + (hasProjector ? "; " + solved.projector.model : "")));
        const QDateTime date = QDateTime::fromString(QString::fromStdString(result.date), Qt::ISODate).toLocalTime();
        set("date", date.isValid() ? QLocale().toString(date, QLocale::ShortFormat) : QString("unknown"));
    }

    void showPlots() {
        const auto& result = parts_.service.state().result;
        if (!result) return;
        bars_->show(result->solved, parts_.selection.pose());
        std::vector<std::pair<std::string, std::vector<Residual>>> residuals;
        for (const PoseResiduals& one : result->residuals)
            residuals.emplace_back(one.name, isProjector_ ? one.projector : one.camera);
        const cv::Size size = isProjector_ ? result->solved.projector.size : result->solved.camera.size;
        field_->show(std::move(residuals), {size.width, size.height}, parts_.selection.pose());
    }

    CalibrateParts parts_;
    QWidget* empty_ = nullptr;
    QWidget* result_ = nullptr;
    QWidget* findings_ = nullptr;
    QWidget* figures_ = nullptr;
    QWidget* plots_ = nullptr;
    QWidget* residualParts_ = nullptr; ///< of them what needs points
    QLabel* headline_ = nullptr;
    QLabel* headlineWords_ = nullptr;
    std::vector<std::tuple<const char*, QLabel*, QLabel*>> values_;
    PoseBars* bars_ = nullptr;
    ResidualField* field_ = nullptr;
    Segments* device_ = nullptr;
    bool isProjector_ = false;
    std::vector<std::pair<Finding, bool>> shown_;
};

} // namespace

QWidget* makeResultDock(const CalibrateParts& parts) { return new ResultDock(parts); }

} // namespace lumorph::studio
