#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QStackedWidget>
#include <QStyle>
#include <QVBoxLayout>

#include "app/studio/document/job_slots.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/throttle.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/rig/front_plot.h"
#include "app/workspaces/rig/rig_docks.h"
#include "app/workspaces/rig/sheet_picture.h"
#include "app/workspaces/rig/suggest_search.h"
#include "app/workspaces/rig/suggest_targets.h"
#include "core/base/error.h"

namespace lumorph::studio {

namespace {

constexpr int kMostServos = 12;
constexpr int kUsualServos = 8;
constexpr int kShowMilliseconds = 100;

QString servosText(std::size_t count) { return QString("%1 %2").arg(count).arg(count == 1 ? "servo" : "servos"); }

FrontPlot::Dot dotOf(const DesignScore& score) { return {score.cost, score.fit}; }

/// A design in picture and numbers.
class CandidateCard : public QWidget {
public:
    CandidateCard() : picture_(new SheetPicture), title_(new QLabel), numbers_(new QLabel) {
        auto* row = new QHBoxLayout(this);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(12);
        auto* column = new QVBoxLayout;
        column->setSpacing(4);
        picture_->setObjectName("rig.suggest.picture");
        title_->setObjectName("rig.suggest.title");
        title_->setProperty("look", "heading");
        numbers_->setObjectName("rig.suggest.numbers");
        numbers_->setProperty("look", "muted");
        for (QLabel* label : {title_, numbers_}) {
            label->setWordWrap(true);
            label->setMinimumWidth(1);
            column->addWidget(label);
        }
        column->addStretch(1);
        row->addWidget(picture_, 0, Qt::AlignTop);
        row->addLayout(column, 1);
        setFixedHeight(picture_->height());
    }

    void show(const Candidate& candidate, const Suggestions& found) {
        picture_->show(found.outline, candidate.flaps);
        title_->setText(servosText(candidate.flaps.size()));
        QStringList lines{QString("About %1 EUR").arg(candidate.price, 0, 'f', 0),
                          QString("Fit %1").arg(shareText(candidate.design.score.fit))};
        if (candidate.fits.size() > 1 && candidate.fits.size() == found.targets.size()) {
            const auto [worst, best] = std::ranges::minmax_element(candidate.fits);
            const auto name = [&](auto at) {
                return QString::fromStdString(found.targets[static_cast<std::size_t>(at - candidate.fits.begin())]);
            };
            lines << QString("Best: %1 %2").arg(name(best), shareText(*best))
                  << QString("Worst: %1 %2").arg(name(worst), shareText(*worst));
        }
        numbers_->setText(lines.join('\n'));
    }

private:
    SheetPicture* picture_;
    QLabel* title_;
    QLabel* numbers_;
};

class RigSuggest : public QWidget {
public:
    explicit RigSuggest(Studio& studio);

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        look();
    }

private:
    QWidget* makeForm();
    QWidget* makeResult();
    /// Whether the open rig is a sheet.
    void look();
    void showNoSheet(const std::exception& why);
    [[nodiscard]] SuggestChoice choice() const;
    [[nodiscard]] bool goesOn() const;
    void press(); ///< the one button
    void refresh();
    void showButton();
    void showStatus();
    void showFront();
    void showCard();
    void choose(int dot);
    void use();

    Studio& studio_;
    JobSlots jobs_;
    SuggestSearch search_;
    Throttle* soon_;
    QStackedWidget* pages_;
    QWidget* noSheet_ = nullptr;
    QWidget* form_ = nullptr;
    SuggestTargets* targets_;
    QComboBox* cost_;
    ValueField* most_;
    QPushButton* button_;
    QLabel* status_;
    FrontPlot* plot_;
    CandidateCard* card_;
    QLabel* hint_;
    QPushButton* use_;
    std::shared_ptr<const Rig> looked_;        ///< origin of the rig that was last looked at
    std::shared_ptr<const Suggestions> found_; ///< as it is shown
    std::optional<Candidate> chosen_;
    int hovered_ = -1;
};

RigSuggest::RigSuggest(Studio& studio)
    : studio_(studio), jobs_(*this, studio.jobs, studio.notices), search_(studio.jobs, studio.notices, this),
      soon_(new Throttle(kShowMilliseconds, this)), pages_(new QStackedWidget),
      targets_(new SuggestTargets(studio.settings, studio.notices, kSuggestPlace)), cost_(new QComboBox),
      most_(new ValueField(Quantity::level, 1, kMostServos, kUsualServos)), button_(new QPushButton),
      status_(new QLabel), plot_(new FrontPlot), card_(new CandidateCard), hint_(new QLabel), use_(new QPushButton) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
    layout->addWidget(makeNoticeBar(studio.notices, kSuggestPlace));
    layout->addWidget(pages_, 1);
    pages_->addWidget(makeEmptyState("search", "No rig yet",
                                     "Make or open a sheet device first: then the studio searches for its bend lines.",
                                     studio.commands.find("rig.new")));
    const Column column = makeColumn();
    column.layout->setAlignment({}); // the plot takes what height there is
    form_ = makeForm();
    column.layout->addWidget(form_);
    column.layout->addWidget(button_);
    column.layout->addWidget(status_);
    column.layout->addWidget(makeResult(), 1);
    pages_->addWidget(column.widget);
    button_->setObjectName("rig.suggest.search");
    status_->setObjectName("rig.suggest.status");
    status_->setProperty("look", "muted");
    status_->setWordWrap(true);
    connect(button_, &QPushButton::clicked, this, [this] { press(); });
    connect(&search_, &SuggestSearch::changed, soon_, &Throttle::request);
    connect(soon_, &Throttle::due, this, [this] { refresh(); });
    connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & StatePart::rig) look();
    });
    refresh();
}

QWidget* RigSuggest::makeForm() {
    auto* form = new QWidget;
    auto* layout = new QVBoxLayout(form);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    layout->addWidget(makeHeading("Shapes that count"));
    layout->addWidget(targets_);
    cost_->setObjectName("rig.suggest.cost");
    cost_->addItem("Fewest servos");
    cost_->addItem("Lowest price");
    cost_->setToolTip("What is weighed against the fit. Price: of the cheapest servo that carries each flap.");
    most_->setObjectName("rig.suggest.most");
    most_->setStep(1.0);
    most_->setValue(kUsualServos);
    layout->addWidget(makeRow("&Look for", cost_));
    layout->addWidget(makeRow("&Most servos", most_));
    connect(targets_, &SuggestTargets::changed, soon_, &Throttle::request);
    connect(cost_, &QComboBox::currentIndexChanged, soon_, &Throttle::request);
    connect(most_, &ValueField::committed, this, [this](double count) {
        most_->setValue(std::round(count));
        soon_->request();
    });
    return form;
}

QWidget* RigSuggest::makeResult() {
    auto* result = new QWidget;
    auto* layout = new QVBoxLayout(result);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    plot_->setObjectName("rig.suggest.plot");
    plot_->setAccessibleName("Designs by cost and fit");
    plot_->setEmptyText("Each dot will be a device: farther up it takes the shapes better, farther left it needs "
                        "less.");
    hint_->setObjectName("rig.suggest.hint");
    hint_->setProperty("look", "muted");
    hint_->setWordWrap(true);
    hint_->setText("Point at a dot to see its bend lines; click it to choose it.");
    hint_->setToolTip("All designs are judged by the same shapes at the same places. What it can be places each shape "
                      "anew for one device, so that its figure differs.");
    hint_->setFixedHeight(card_->height());
    hint_->setAlignment(Qt::AlignTop);
    use_->setObjectName("rig.suggest.use");
    use_->setText("Use this device");
    use_->setToolTip("Builds the chosen design and makes it the rig; undo brings the rig of before back");
    layout->addWidget(plot_, 1);
    layout->addWidget(card_);
    layout->addWidget(hint_);
    layout->addWidget(use_);
    layout->addWidget(makeJobBar(studio_.jobs, QString(kSuggestPlace) + ".build"));
    connect(plot_, &FrontPlot::hovered, this, [this](int dot) {
        hovered_ = dot;
        showCard();
    });
    connect(plot_, &FrontPlot::clicked, this, [this](int dot) { choose(dot); });
    connect(plot_, &FrontPlot::taken, this, [this](int dot) {
        choose(dot);
        use();
    });
    connect(use_, &QPushButton::clicked, this, [this] { use(); });
    return result;
}

void RigSuggest::look() {
    const StudioState::RigAsset& asset = studio_.document.state().rig;
    if (!search_.empty() && !search_.knows(asset.origin)) {
        chosen_.reset();
        search_.clear();
    }
    soon_->request();
    if (!isVisible() || asset.origin == looked_) return;
    looked_ = asset.origin;
    studio_.notices.dismissAll(kSuggestPlace);
    if (!asset.rig) return pages_->setCurrentIndex(0);
    if (search_.knows(asset.origin)) return pages_->setCurrentIndex(1);
    jobs_.runWith<bool>(
        "look", kSuggestPlace + QString(".look"), "Looking at the sheet",
        [rig = asset.rig](const Progress&) { return !sheetDeviceOf(*rig).outline.empty(); },
        [this](bool) { pages_->setCurrentIndex(1); }, [this](const std::exception& why) { showNoSheet(why); });
}

void RigSuggest::showNoSheet(const std::exception& why) {
    if (noSheet_) {
        pages_->removeWidget(noSheet_);
        noSheet_->deleteLater();
    }
    const Notice notice = noticeOf(why);
    noSheet_ = makeEmptyState("search", "This rig is no plain sheet",
                              QString("Bend lines are searched for on a flat sheet with a convex outline. %1: %2.\n\n"
                                      "Begin a new device: a sheet, a tablet or a phone of your measures.")
                                  .arg(notice.subject, notice.why),
                              studio_.commands.find("rig.new"));
    noSheet_->setObjectName("rig.suggest.noSheet");
    pages_->addWidget(noSheet_);
    pages_->setCurrentWidget(noSheet_);
}

SuggestChoice RigSuggest::choice() const {
    return {targets_->ticked(), cost_->currentIndex() == 1 ? SearchCost::price : SearchCost::servos,
            static_cast<std::size_t>(std::lround(most_->value()))};
}

bool RigSuggest::goesOn() const { return !search_.empty() && choice() == search_.choice(); }

void RigSuggest::press() {
    const StudioState::RigAsset& asset = studio_.document.state().rig;
    if (search_.running()) return search_.stop();
    studio_.notices.dismissAll(kSuggestPlace);
    if (goesOn()) return search_.goOn();
    chosen_.reset();
    if (asset.rig) search_.start(asset.rig, asset.origin, choice());
}

void RigSuggest::refresh() {
    found_ = search_.found();
    if (hovered_ >= 0 && (!found_ || hovered_ >= static_cast<int>(found_->front.size()))) hovered_ = -1;
    form_->setEnabled(!search_.running());
    form_->setToolTip(search_.running() ? "Stop the search to change what it looks for" : "");
    showButton();
    showStatus();
    showFront();
    showCard();
}

void RigSuggest::showButton() {
    const bool primary = !search_.running() && !chosen_;
    if (button_->property("look").toString() != (primary ? "primary" : "")) {
        button_->setProperty("look", primary ? "primary" : "");
        button_->style()->polish(button_);
    }
    button_->setText(search_.running() ? "Stop searching" : goesOn() ? "Go on searching" : "Search");
    button_->setEnabled(search_.running() || !targets_->ticked().empty());
}

void RigSuggest::showStatus() {
    if (!search_.running() && targets_->ticked().empty()) return status_->setText("Tick the shapes that count.");
    if (search_.empty())
        return status_->setText("The studio tries bend lines on this sheet until you stop it; the device stays as "
                                "it is.");
    if (!found_) return status_->setText(search_.running() ? "Getting ready: " + search_.stage() : "Stopped.");
    const double best = found_->front.empty() ? 0.0 : found_->front.back().design.score.fit;
    const QString begun = found_->generation == 0
                              ? QString("Single lines first")
                              : QString("Generation %1").arg(QLocale::c().toString(found_->generation));
    status_->setText(QString("%1, %2 designs looked at, best fit %3")
                         .arg(begun, QLocale(QLocale::English).toString(static_cast<qulonglong>(found_->evaluations)),
                              shareText(best)));
}

void RigSuggest::showFront() {
    const bool byPrice = (search_.empty() ? choice() : search_.choice()).cost == SearchCost::price;
    plot_->setCost(byPrice ? "price of the servos, EUR" : "servos",
                   byPrice ? 10.0 : static_cast<double>(search_.empty() ? choice().most : search_.choice().most));
    std::vector<FrontPlot::Dot> dots;
    if (found_)
        for (const Candidate& candidate : found_->front) dots.push_back(dotOf(candidate.design.score));
    plot_->setDots(std::move(dots));
    const auto open = search_.scoreOf(studio_.document.state().rig.origin);
    plot_->setOpenDevice(open ? std::optional(dotOf(*open)) : std::nullopt);
    plot_->setChosen(chosen_ ? std::optional(dotOf(chosen_->design.score)) : std::nullopt);
}

void RigSuggest::showCard() {
    const Candidate* shown = chosen_ ? &*chosen_ : nullptr;
    if (found_ && hovered_ >= 0 && hovered_ < static_cast<int>(found_->front.size()))
        shown = &found_->front[static_cast<std::size_t>(hovered_)];
    const bool some = found_ && !found_->front.empty();
    card_->setVisible(shown != nullptr && found_ != nullptr);
    hint_->setVisible(some && !card_->isVisibleTo(this));
    use_->setVisible(some);
    use_->setEnabled(chosen_.has_value());
    if (use_->property("look").toString() != (chosen_ ? "primary" : "")) {
        use_->setProperty("look", chosen_ ? "primary" : "");
        use_->style()->polish(use_);
    }
    if (shown != nullptr && found_) card_->show(*shown, *found_);
}

void RigSuggest::choose(int dot) {
    if (!found_ || dot < 0 || dot >= static_cast<int>(found_->front.size())) return;
    chosen_ = found_->front[static_cast<std::size_t>(dot)];
    refresh();
}

void RigSuggest::use() {
    if (!chosen_) return;
    const QString name = "design with " + servosText(chosen_->flaps.size());
    search_.build(*chosen_,
                  [this, name](const std::shared_ptr<const Rig>& rig) { studio_.project.takeRig(rig, name); });
}

} // namespace

QWidget* makeRigSuggest(Studio& studio) { return new RigSuggest(studio); }

} // namespace lumorph::studio
