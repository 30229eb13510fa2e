#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <string_view>

#include <QAction>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "app/studio/calibration/chain_service.h"
#include "app/studio/document/job_slots.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/calibrate/budget_bar.h"
#include "app/workspaces/calibrate/chain_docks.h"
#include "app/workspaces/common/step_card.h"
#include "calibration/budget/error_budget.h"
#include "core/loop/pose_stream.h"

namespace lumorph::studio {
namespace {

constexpr int kPageWidth = 900, kFieldWidth = 560;   // pixels; wider rows part a name from its number
constexpr double kUsualSpeed = 0.3, kFastest = 2.0;  // metres a second
constexpr double kUsualFloat = 0.02, kHighest = 0.2; // metres

QString partName(BudgetPart part) {
    switch (part) {
    case BudgetPart::projector:
        return QObject::tr("Where the light falls");
    case BudgetPart::tracker:
        return QObject::tr("Tracker in the room");
    case BudgetPart::device:
        return QObject::tr("Device on its body");
    case BudgetPart::eye:
        return QObject::tr("Eye");
    case BudgetPart::servos:
        return QObject::tr("Servos");
    case BudgetPart::delay:
        return QObject::tr("Unknown delay");
    case BudgetPart::pointer:
        return QObject::tr("Pointer's tip, in all three");
    case BudgetPart::prediction:
        break;
    }
    return QObject::tr("Left by prediction");
}

QString sourceWords(const BudgetItem& item) {
    switch (item.source) {
    case ErrorSource::told:
        return QObject::tr("measured");
    case ErrorSource::measured:
        return QObject::tr("measured; its size is the usual one");
    case ErrorSource::simulated:
        return QObject::tr("simulated in the virtual lab");
    case ErrorSource::assumed:
        return QObject::tr("not measured; its size is the usual one");
    case ErrorSource::worked:
        break;
    }
    if (item.part == BudgetPart::pointer) return QObject::tr("nothing was measured with it yet");
    return QObject::tr("worked out: noise, and turns of the hand");
}

/// The link that measures a part; empty for what none measures.
std::optional<std::size_t> linkOf(BudgetPart part) {
    if (part == BudgetPart::prediction) return std::nullopt;
    const std::string_view key = part == BudgetPart::delay ? "delays" : keyOf(part);
    const auto& links = chainLinks();
    const auto found = std::ranges::find(links, key, [](const ChainLink& link) { return std::string_view(link.key); });
    if (found == links.end()) return std::nullopt;
    return static_cast<std::size_t>(found - links.begin());
}

QString wholeText(double metres) { return QString("%1 mm").arg(1e3 * metres, 0, 'f', 1); }

QString sentence(const QString& words) { return words.left(1).toUpper() + words.mid(1) + '.'; }

/// What the room, the device and a floating height make of errors; the hand's speed comes after it.
struct BudgetBasis {
    std::shared_ptr<const Rig> rig;
    SlipModel model;
    RoomErrors errors;
};

/// The part that is most of the sum, since squares are added; null where none is.
const BudgetItem* mostOf(const ErrorBudget& budget) {
    constexpr double kMost = 0.5;
    const auto most = std::ranges::max_element(budget.items, {}, &BudgetItem::share);
    return most->share > kMost ? &*most : nullptr;
}

/// "The largest part: Left by prediction, 99 % of the whole."
QString shareWords(const BudgetItem& item) {
    return QObject::tr("The largest part: %1, %2 % of the whole.")
        .arg(partName(item.part))
        .arg(100.0 * item.share, 0, 'f', 0);
}

/// Where measuring again helps little.
StepCardText cardWithoutAdvice(const BudgetItem* most) {
    const QString little = QObject::tr("Measuring a single one again would make the whole hardly smaller.");
    if (!most) return {StepTone::good, QObject::tr("No part stands out"), little, {}};
    const QString slower = QObject::tr("It falls where the hand goes more slowly, and where the time from tracker to "
                                       "light is shorter.");
    return {StepTone::good, shareWords(*most).chopped(1), most->part == BudgetPart::prediction ? slower : little, {}};
}

/// The advised link, as the card over the budget says it.
StepCardText cardOf(const BudgetAdvice& advice, std::size_t link, bool isTrackerPlaced, const BudgetItem* most) {
    const QString title = chainLinks()[link].title.toLower();
    QString text = QObject::tr("That takes the whole from %1 down to about %2.")
                       .arg(wholeText(advice.before), wholeText(advice.after));
    if (most) text += ' ' + shareWords(*most);
    if (!isTrackerPlaced)
        text += ' ' + QObject::tr("So far nobody has said where the tracker's world lies: its part counts as if that "
                                  "were laid in by a ruler.");
    return {StepTone::live,
            advice.isFirst ? QObject::tr("Measure %1").arg(title) : QObject::tr("Measure %1 again").arg(title), text,
            QObject::tr("Show this link")};
}

/// Where the millimetres come from, and the link that helps most.
class BudgetView : public QWidget {
public:
    explicit BudgetView(const CalibrateParts& parts)
        : parts_(parts), jobs_(*this, parts.studio.jobs, parts.studio.notices),
          card_(new StepCard("budget.card", "target", this)), page_(new QWidget(this)), total_(new QLabel(this)),
          bar_(new BudgetBar(this)), cut_(makeWords({}, "muted")),
          speed_(new ValueField(Quantity::length, 0.0, kFastest, kUsualSpeed, this)),
          floats_(new ValueField(Quantity::length, 0.0, kHighest, kUsualFloat, this)) {
        setObjectName("budget.view");
        setProperty("look", "panel");
        setAttribute(Qt::WA_StyledBackground);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(16, 8, 16, 8);
        column->setSpacing(12);
        column->addWidget(card_);
        column->addWidget(makeJobBar(parts.studio.jobs, "budget", this));
        const Column page = makeColumn(this);
        column->addWidget(page.widget, 1);
        auto* back = new QPushButton(tr("Back"), this);
        back->setObjectName("budget.back");
        back->setToolTip(tr("To the chosen link"));
        connect(back, &QPushButton::clicked, this,
                [this] { parts_.selection.setPage(CalibrateSelection::Page::link); });
        page.layout->addWidget(makeHeading(tr("Where the millimetres come from"), this));
        auto* top = new QHBoxLayout;
        top->addWidget(total_);
        top->addStretch(1);
        top->addWidget(back, 0, Qt::AlignTop);
        page.layout->addLayout(top);
        page.layout->addWidget(page_);
        page.layout->addStretch(1);
        fillPage();
        connect(card_, &StepCard::nextWanted, this, [this] { doNext(); });
        connect(&parts.studio.document, &StudioDocument::changed, this, [this](StateParts changed) {
            if (changed & (StateParts(StatePart::rig) | StatePart::rigEdited | StatePart::installation)) makeStale();
        });
        connect(&parts.selection, &CalibrateSelection::pageChanged, this, [this] { follow(); });
        showBudget();
    }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        follow();
    }

private:
    QLabel* makeWords(const QString& text, const char* look) {
        auto* words = new QLabel(text, this);
        words->setProperty("look", look);
        words->setWordWrap(true);
        words->setMaximumWidth(kPageWidth);
        return words;
    }

    void fillPage() {
        auto* page = new QVBoxLayout(page_);
        page->setContentsMargins(0, 0, 0, 0);
        page->setSpacing(8);
        total_->setObjectName("budget.total");
        total_->setAccessibleName(tr("All together"));
        makeLarge(total_, 32, {});
        page->addWidget(
            makeWords(tr("is how far beside its place the viewer sees what is shown: root mean square over the "
                         "device, all parts together."),
                      ""));
        bar_->setMaximumWidth(kPageWidth);
        page->addSpacing(8);
        page->addWidget(bar_);
        page->addWidget(
            makeWords(tr("Squares are added, so that the largest part is nearly all that counts. Hatched "
                         "is what nobody has measured in this room: it is taken to be as large as it usually "
                         "is, or what is simulated as large as in the virtual lab."),
                      "muted"));
        cut_->setObjectName("budget.cut");
        page->addWidget(cut_);
        page->addSpacing(8);
        page->addWidget(makeHeading(tr("What is shown, and who carries it"), this));
        speed_->setObjectName("budget.speed");
        floats_->setObjectName("budget.floats");
        speed_->setValue(kUsualSpeed);
        floats_->setValue(kUsualFloat);
        for (QWidget* row : {makeRow(tr("In a second the hand carries it"), speed_, this),
                             makeRow(tr("Things float over the surface by"), floats_, this)}) {
            row->setMaximumWidth(kFieldWidth);
            page->addWidget(row);
        }
        for (ValueField* field : {speed_, floats_}) {
            const auto take = [this, field] {
                if (field == floats_)
                    makeStale();
                else
                    showBudget();
            };
            connect(field, &ValueField::committed, this, take);
            if (field == speed_) connect(field, &ValueField::previewed, this, [this](double) { showBudget(); });
            connect(field, &ValueField::reverted, this, take);
        }
    }

    void makeStale() {
        isStale_ = true;
        follow();
    }

    /// Works only for who looks.
    void follow() {
        if (!isStale_ || !isVisible()) return;
        isStale_ = false;
        trouble_.reset();
        const StudioState& state = parts_.studio.document.state();
        if (!state.rig.rig) {
            jobs_.stop("budget");
            basis_.reset();
            return showBudget();
        }
        jobs_.runWith<BudgetBasis>(
            "budget", "budget", tr("Adding up the millimetres"),
            [rig = state.rig.rig, room = *state.installation, floats = floats_->value()](const Progress& progress) {
                SlipView view;
                view.floats = floats;
                return BudgetBasis{rig, slipModelOf(*rig, room, view, progress),
                                   errorsOf(room, *rig, commandedOf(view, *rig))};
            },
            [this](BudgetBasis basis) {
                basis_ = std::make_unique<BudgetBasis>(std::move(basis));
                showBudget();
            },
            [this](const std::exception& error) {
                basis_.reset(); // its numbers are of another room
                trouble_ = noticeOf(error);
                showBudget();
            });
        showBudget();
    }

    void showBudget() {
        advised_.reset();
        for (QWidget* part : {static_cast<QWidget*>(total_), page_}) part->setVisible(basis_ != nullptr);
        if (!basis_) return card_->show(cardWithout());
        CarryingHand hand;
        hand.speed = speed_->value();
        const ErrorBudget budget = budgetOf(*basis_->rig, basis_->model, basis_->errors, hand);
        total_->setText(wholeText(budget.total));
        std::vector<BudgetSlice> slices;
        for (const BudgetItem& item : budget.items)
            slices.push_back({partName(item.part), sourceWords(item), 1e3 * item.metres, item.share,
                              item.source != ErrorSource::assumed && item.source != ErrorSource::simulated});
        bar_->show(std::move(slices));
        cut_->setVisible(budget.cutSeconds > 0.0);
        cut_->setText(
            tr("Poses are predicted by %1 ms at most. %2 ms more, in which the hand goes %3, are not compensated; "
               "they count to what is left by prediction.")
                .arg(1e3 * PoseStream::kFarthestAhead, 0, 'f', 0)
                .arg(1e3 * budget.cutSeconds, 0, 'f', 0)
                .arg(wholeText(budget.cutMetres)));
        const auto best =
            std::ranges::find_if(budget.advice, [](const BudgetAdvice& one) { return linkOf(one.part).has_value(); });
        if (best == budget.advice.end()) return card_->show(cardWithoutAdvice(mostOf(budget)));
        advised_ = linkOf(best->part);
        card_->show(cardOf(*best, *advised_, budget.isTrackerPlaced, mostOf(budget)));
    }

    /// While there is no budget: why.
    [[nodiscard]] StepCardText cardWithout() const {
        if (trouble_)
            return {StepTone::failure,
                    tr("The millimetres cannot be added up"),
                    sentence(trouble_->subject + ": " + trouble_->why) + ' ' + sentence(trouble_->remedy),
                    {}};
        if (!parts_.studio.document.state().rig.rig)
            return {StepTone::quiet, tr("No device is open"),
                    tr("How far pictures slip on it is added up here, part by part."), tr("Open a device...")};
        return {StepTone::live, tr("Adding up the millimetres"), {}, {}};
    }

    void doNext() {
        if (!basis_) return parts_.studio.commands.find("rig.open")->trigger();
        if (!advised_) return;
        parts_.chain.choose(*advised_);
        parts_.selection.setPage(CalibrateSelection::Page::link);
    }

    CalibrateParts parts_;
    JobSlots jobs_;
    StepCard* card_;
    QWidget* page_; ///< what is below the whole sum
    QLabel* total_;
    BudgetBar* bar_;
    QLabel* cut_; ///< what no prediction reaches
    ValueField *speed_, *floats_;
    std::unique_ptr<BudgetBasis> basis_;
    std::optional<Notice> trouble_; ///< why there is no basis
    std::optional<std::size_t> advised_;
    bool isStale_ = true;
};

} // namespace

QWidget* makeBudgetView(const CalibrateParts& parts) { return new BudgetView(parts); }

} // namespace lumorph::studio
