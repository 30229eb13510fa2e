#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <QComboBox>
#include <QHBoxLayout>
#include <QHideEvent>
#include <QLabel>
#include <QPushButton>
#include <QShowEvent>
#include <QStackedWidget>
#include <QVBoxLayout>

#include "app/studio/document/hand_control.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/shell/guide_window.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/plot.h"
#include "app/studio/widgets/throttle.h"
#include "app/workspaces/rig/device_fit.h"
#include "app/workspaces/rig/metric_table.h"
#include "app/workspaces/rig/rig_docks.h"
#include "app/workspaces/rig/rig_facts.h"
#include "app/workspaces/rig/target_tiles.h"
#include "core/base/resources.h"
#include "core/rig/templates/reference_rigs.h"

namespace lumorph::studio {

namespace {

using Library = std::vector<LibraryTarget>;

constexpr const char* kFitPlace = "rig.fit";
/// Edits that come faster, as in a drag, are looked at together.
constexpr int kFitMilliseconds = 120;

/// What a coarse match brings: the first one also reads the library.
struct Matched {
    std::shared_ptr<const Library> library;
    DeviceFit device;
};

class RigFit : public QWidget {
public:
    RigFit(Studio& studio, RigSelection& selection);

protected:
    void showEvent(QShowEvent* event) override;
    void hideEvent(QHideEvent* event) override;

private:
    enum Page { noRig, moveless, contents };

    void addCommand();
    QWidget* makeContents();
    QWidget* makeTried();
    QWidget* makeLegend();
    QWidget* makeChoosers();
    void follow();
    void clear();
    void stopAll();
    void matchCoarsely();
    void measure();
    void leaveActuatorsOut();
    void matchFully();
    void compare();
    void take(const DeviceFit& device, bool coarse);
    void takeMeasures(const ShapeResolution& resolution);
    void takeSteps(const std::vector<FitWithout>& steps);
    void fail(const std::exception& error);
    void tellState();
    void showTried();
    void takeBack();
    [[nodiscard]] const ServoType& servo() const {
        return servoTypes()[static_cast<std::size_t>(servo_->currentIndex())];
    }

    Studio& studio_;
    RigSelection& selection_;
    JobSlots jobs_;
    HandControl hand_;
    Throttle* soon_;
    QStackedWidget* pages_;
    QLabel* verdict_ = new QLabel;
    QLabel* weak_ = new QLabel;
    QLabel* state_ = new QLabel;
    TargetTiles* tiles_ = new TargetTiles;
    QWidget* tried_ = nullptr;
    std::vector<double> asked_; ///< strokes in the view that a tile asked for
    QLabel* triedText_ = new QLabel;
    Plot* steps_ = new Plot;
    MetricTable* metrics_ = new MetricTable;
    QComboBox* servo_ = new QComboBox;
    QComboBox* reference_ = new QComboBox;
    QAction* takeCommand_ = nullptr;

    std::shared_ptr<const Library> library_;
    std::shared_ptr<const Rig> rig_;     ///< that is worked on, or was last
    std::shared_ptr<const Rig> shownOf_; ///< whose fit is shown
    std::shared_ptr<const Rig> origin_;
    std::optional<LibraryFit> fit_;                 ///< that is shown
    bool matching_ = false;                         ///< a coarse match is under way
    bool coarse_ = false;                           ///< a finer one is still to come
    bool complete_ = false;                         ///< nothing is left to be worked out for `rig_`
    std::map<QString, ShapeResolution> references_; ///< by the name of the reference and the servo it was measured with
};

RigFit::RigFit(Studio& studio, RigSelection& selection)
    : studio_(studio), selection_(selection), jobs_(*this, studio.jobs, studio.notices),
      hand_(studio.document, studio.loop), soon_(new Throttle(kFitMilliseconds, this)),
      pages_(new QStackedWidget(this)) {
    addCommand();
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
    layout->addWidget(makeNoticeBar(studio.notices, kFitPlace));
    layout->addWidget(makeJobBar(studio.jobs, kFitPlace));
    layout->addWidget(pages_, 1);
    pages_->setObjectName("rig.fit.pages");
    QAction* anew = studio.commands.find("rig.new");
    pages_->addWidget(makeEmptyState("target", "What can it be?",
                                     "Make or open a device, and see which shapes it takes on, and how well.", anew));
    pages_->addWidget(makeEmptyState("actuator", "Nothing moves yet",
                                     "A device without actuators has one shape only. Start from a template, whose "
                                     "measures you set, or draw bend lines across a sheet.",
                                     anew));
    pages_->addWidget(makeContents());
    connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::rig) follow();
        if (!(parts & StatePart::rigEdited)) return;
        tellState();
        soon_->request();
    });
    connect(soon_, &Throttle::due, this, &RigFit::follow);
    connect(&selection, &RigSelection::rehearsalChanged, this, [this] {
        // A pose of somebody else's in the view is not that of the tile.
        if (selection_.rehearsed() != asked_) {
            tiles_->choose(std::nullopt);
            asked_.clear();
        }
        showTried();
    });
    connect(tiles_, &TargetTiles::chosenChanged, this, &RigFit::showTried);
}

void RigFit::addCommand() {
    Commands::Options options;
    options.icon = "hand";
    options.menu = "Actuators";
    options.workspace = "rig";
    takeCommand_ = studio_.commands.add("rig.fit.take", "Move the device there", options, [this] {
        if (!fit_ || !tiles_->chosen()) return;
        const std::size_t target = *tiles_->chosen();
        hand_.moveAll("Move to " + targetTitle(fit_->targets[target].name), strokesOf(*fit_, target));
    });
    takeCommand_->setToolTip("Takes the servos by hand and moves them to what the view shows; one step of undo");
    takeCommand_->setEnabled(false);
}

QWidget* RigFit::makeContents() {
    const Column column = makeColumn();
    verdict_->setObjectName("rig.fit.verdict");
    verdict_->setToolTip("Fit is intersection over union: what target and device share, of what either fills. Targets "
                         "stand on the device as large as they fit; poses of a device stay where they are.");
    weak_->setObjectName("rig.fit.weak");
    weak_->setProperty("look", "warning");
    state_->setObjectName("rig.fit.state");
    state_->setProperty("look", "muted");
    for (QLabel* label : {verdict_, weak_}) label->setWordWrap(true);
    for (QWidget* widget : {static_cast<QWidget*>(verdict_), static_cast<QWidget*>(weak_),
                            static_cast<QWidget*>(state_), static_cast<QWidget*>(tiles_), makeLegend(), makeTried()})
        column.layout->addWidget(widget);
    weak_->hide();
    column.layout->addWidget(makeHeading("Fit by number of actuators"));
    steps_->setObjectName("rig.fit.steps");
    steps_->setAccessibleName("Fit by number of actuators");
    steps_->setToolTip("The mean fit that is left when the actuators that are missed least stay at rest");
    steps_->setAxes("actuators", "fit, %");
    steps_->setRange(0.0, 100.0);
    steps_->setEmptyText("Follows once the targets are matched");
    column.layout->addWidget(steps_);
    column.layout->addWidget(makeHeading("Shape resolution"));
    column.layout->addWidget(makeChoosers());
    column.layout->addWidget(metrics_);
    column.layout->addWidget(makeGuideLink("What these figures mean", "shape-resolution"));
    return column.widget;
}

QWidget* RigFit::makeLegend() {
    auto* legend = new QLabel;
    legend->setObjectName("rig.fit.legend");
    legend->setProperty("look", "muted");
    const auto tell = [legend] {
        const Palette& colors = currentPalette();
        legend->setText(QString("<span style='color:%1'>■</span> device falls short &nbsp; "
                                "<span style='color:%2'>■</span> device too high")
                            .arg(colors.unmatched.name(), colors.overfilled.name()));
    };
    tell();
    connect(&studio_.settings, &Settings::themeChanged, legend, tell, Qt::QueuedConnection);
    return legend;
}

/// What the view shows instead of the device as it stands.
QWidget* RigFit::makeTried() {
    tried_ = new QWidget;
    auto* layout = new QVBoxLayout(tried_);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    triedText_->setObjectName("rig.fit.tried");
    triedText_->setWordWrap(true);
    layout->addWidget(triedText_);
    auto* buttons = new QHBoxLayout;
    buttons->setSpacing(8);
    buttons->addWidget(makeCommandButton(takeCommand_, "rig.fit.takeButton", tried_));
    auto* back = new QPushButton("Back", tried_);
    back->setObjectName("rig.fit.back");
    back->setToolTip("Shows the device as it stands again");
    connect(back, &QPushButton::clicked, this, [this] { selection_.rehearse({}); });
    buttons->addWidget(back);
    buttons->addStretch(1);
    layout->addLayout(buttons);
    tried_->hide();
    return tried_;
}

QWidget* RigFit::makeChoosers() {
    auto* choosers = new QWidget;
    auto* layout = new QVBoxLayout(choosers);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    for (const ServoType& type : servoTypes()) servo_->addItem(shownText(type.name));
    servo_->setCurrentIndex(std::max(0, servo_->findText("SG90")));
    servo_->setObjectName("rig.fit.servo");
    servo_->setToolTip(
        "Which servos the device has where an actuator names none of its own: strength and speed follow from it");
    reference_->addItem("nothing", "");
    reference_->addItem("phone", "phone");
    reference_->addItem("tablet", "tablet");
    reference_->addItem("pin display", "pins");
    reference_->setObjectName("rig.fit.reference");
    reference_->setToolTip("Adds the figures of a device of common size below each of this one's");
    layout->addWidget(makeRow("Ser&vos", servo_));
    layout->addWidget(makeRow("&Compare with", reference_));
    connect(servo_, &QComboBox::currentIndexChanged, this, [this] {
        if (fit_ && shownOf_ == rig_ && isVisible()) measure();
        compare();
    });
    connect(reference_, &QComboBox::currentIndexChanged, this, &RigFit::compare);
    return choosers;
}

void RigFit::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    follow();
}

void RigFit::hideEvent(QHideEvent* event) {
    QWidget::hideEvent(event);
    stopAll();
    if (!complete_) rig_.reset(); // begins anew when it is seen again
    tiles_->choose(std::nullopt);
    showTried();
}

void RigFit::stopAll() {
    for (const char* slot : {"coarse", "measure", "steps", "full"}) jobs_.stop(slot);
    matching_ = false;
}

void RigFit::follow() {
    if (!isVisible()) return;
    const StudioState::RigAsset& asset = studio_.document.state().rig;
    if (asset.origin != origin_) clear();
    origin_ = asset.origin;
    const Page page = !asset.rig ? noRig : asset.rig->actuatorCount() == 0 ? moveless : contents;
    pages_->setCurrentIndex(page);
    if (page != contents) {
        stopAll();
        rig_.reset();
        return;
    }
    // In a drag each match is seen to its end, so that the pictures follow the hand.
    if (asset.rig == rig_ || (matching_ && studio_.document.previewing())) return tellState();
    const bool samePictures = complete_ && shownOf_ && deformAlike(shownOf_->parts(), asset.rig->parts());
    rig_ = asset.rig;
    studio_.notices.dismissAll(kFitPlace);
    if (samePictures) {
        shownOf_ = rig_;
        measure();
    } else {
        matchCoarsely();
    }
    tellState();
}

void RigFit::clear() {
    stopAll();
    rig_.reset();
    shownOf_.reset();
    fit_.reset();
    complete_ = false;
    tiles_->choose(std::nullopt);
    takeBack();
    verdict_->setText("Matching the targets...");
    for (QWidget* left : {static_cast<QWidget*>(weak_), static_cast<QWidget*>(tiles_), static_cast<QWidget*>(metrics_)})
        left->hide();
    steps_->setCurves({});
    studio_.notices.dismissAll(kFitPlace);
}

void RigFit::matchCoarsely() {
    stopAll();
    complete_ = false;
    matching_ = true;
    using Result = std::shared_ptr<const Matched>;
    jobs_.runWith<Result>(
        "coarse", kFitPlace, "Matching the targets coarsely",
        [rig = rig_, library = library_](const Progress& progress) -> Result {
            Matched matched;
            matched.library = library ? library
                                      : std::make_shared<const Library>(
                                            readTargetLibrary(resourcesFolder() / "targets", progress.part(0.0, 0.3)));
            matched.device = fitDevice(*rig, *matched.library, LibraryFitOptions::coarse(), progress.part(0.3, 1.0));
            return std::make_shared<const Matched>(std::move(matched));
        },
        [this, rig = rig_](const Result& result) {
            matching_ = false;
            library_ = result->library;
            shownOf_ = rig;
            take(result->device, true);
            if (studio_.document.state().rig.rig != rig) return follow();
            measure();
        },
        [this](const std::exception& error) {
            matching_ = false;
            fail(error);
        });
}

void RigFit::measure() {
    using Result = std::shared_ptr<const ShapeResolution>;
    ShapeResolutionOptions options;
    options.servo = &servo();
    jobs_.runWith<Result>(
        "measure", kFitPlace, "Measuring shape resolution",
        [rig = rig_, options](const Progress& progress) -> Result {
            return std::make_shared<const ShapeResolution>(shapeResolution(*rig, options, progress));
        },
        [this](const Result& result) {
            takeMeasures(*result);
            if (coarse_) matchFully();
        },
        [this](const std::exception& error) { fail(error); });
}

void RigFit::matchFully() {
    using Result = std::shared_ptr<const DeviceFit>;
    jobs_.runWith<Result>(
        "full", kFitPlace, "Matching the targets finely",
        [rig = rig_, library = library_](const Progress& progress) -> Result {
            return std::make_shared<const DeviceFit>(fitDevice(*rig, *library, {}, progress));
        },
        [this](const Result& result) {
            take(*result, false);
            leaveActuatorsOut();
        },
        [this](const std::exception& error) { fail(error); });
}

void RigFit::leaveActuatorsOut() {
    using Result = std::vector<FitWithout>;
    jobs_.runWith<Result>(
        "steps", kFitPlace, "Leaving actuators out",
        [rig = rig_, library = library_](const Progress& progress) -> Result {
            LibraryMatcher matcher(*rig, *library, LibraryFitOptions::coarse(), progress.part(0.0, 0.2));
            return matcher.fitByActuators(progress.part(0.2, 1.0));
        },
        [this](const Result& steps) {
            takeSteps(steps);
            complete_ = true;
        },
        [this](const std::exception& error) { fail(error); });
}

void RigFit::compare() {
    const QString name = reference_->currentData().toString();
    jobs_.stop("reference");
    if (name.isEmpty()) return metrics_->setReference(nullptr);
    const QString key = name + ' ' + servo_->currentText();
    if (const auto known = references_.find(key); known != references_.end())
        return metrics_->setReference(&known->second, reference_->currentText());
    using Result = std::shared_ptr<const ShapeResolution>;
    ShapeResolutionOptions options;
    options.servo = &servo();
    jobs_.runWith<Result>(
        "reference", kFitPlace, "Measuring what to compare with",
        [wanted = name.toStdString(), options](const Progress& progress) -> Result {
            const std::vector<Rig> rigs = referenceRigs(progress.part(0.0, 0.4));
            const auto found = std::ranges::find(rigs, wanted, &Rig::name);
            return std::make_shared<const ShapeResolution>(
                shapeResolution(found == rigs.end() ? rigs.front() : *found, options, progress.part(0.4, 1.0)));
        },
        [this, key](const Result& result) {
            references_[key] = *result;
            compare();
        },
        [this](const std::exception& error) { fail(error); });
}

void RigFit::take(const DeviceFit& device, bool coarse) {
    fit_ = device.fit;
    coarse_ = coarse;
    verdict_->setText(fitText(device.fit));
    tiles_->setFit(device);
    tiles_->show();
    tellState();
    showTried();
}

void RigFit::takeMeasures(const ShapeResolution& resolution) {
    metrics_->setDevice(resolution);
    metrics_->show();
    compare();
    const QString weak = weakServosText(resolution.loads);
    weak_->setText(weak);
    weak_->setVisible(!weak.isEmpty());
    tellState();
}

void RigFit::takeSteps(const std::vector<FitWithout>& steps) {
    if (steps.empty()) return steps_->setCurves({});
    Plot::Curve curve{"mean of the targets", currentPalette().accentText, {}};
    curve.values.assign(steps.front().actuators + 1, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < steps.size(); ++k) {
        curve.values[steps[k].actuators] = 100.0 * steps[k].fit;
        if (k == 0) continue;
        // Of many actuators several go at a time: straight between two that were matched.
        const std::size_t few = steps[k].actuators, many = steps[k - 1].actuators;
        for (std::size_t n = few + 1; n < many; ++n)
            curve.values[n] = 100.0 * std::lerp(steps[k].fit, steps[k - 1].fit,
                                                static_cast<double>(n - few) / static_cast<double>(many - few));
    }
    steps_->setCurves({std::move(curve)});
}

void RigFit::fail(const std::exception& error) {
    complete_ = false;
    if (!fit_) verdict_->setText("The targets could not be matched.");
    jobs_.fail(kFitPlace, error);
    tellState();
}

/// Whether what is shown is of the rig as it is now.
void RigFit::tellState() {
    const StudioState::RigAsset& asset = studio_.document.state().rig;
    const bool stale = fit_ && asset.rig && (!asset.compiled || shownOf_ != asset.rig) &&
                       !(asset.parts && shownOf_ && deformAlike(shownOf_->parts(), *asset.parts));
    tiles_->setStale(stale);
    metrics_->setStale(stale);
    verdict_->setEnabled(!stale);
    state_->setText(!fit_     ? QString()
                    : stale   ? "Of the rig before your edit"
                    : coarse_ ? "Coarse, a finer one follows"
                              : "");
}

/// Ends the pose in the view that a tile asked for.
void RigFit::takeBack() {
    const std::vector<double> asked = std::exchange(asked_, {});
    if (!asked.empty() && asked == selection_.rehearsed()) selection_.rehearse({});
}

void RigFit::showTried() {
    const auto chosen = tiles_->chosen();
    const bool tries = fit_ && chosen && *chosen < fit_->targets.size();
    takeCommand_->setEnabled(tries);
    tried_->setVisible(tries);
    if (!tries) return takeBack();
    triedText_->setText(targetText(fit_->targets[*chosen]));
    asked_ = strokesOf(*fit_, *chosen);
    selection_.rehearse(asked_);
}

} // namespace

QWidget* makeRigFit(Studio& studio, RigSelection& selection) { return new RigFit(studio, selection); }

} // namespace lumorph::studio
