#include <algorithm>
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
#include "calibration/budget/error_budget.h"

namespace lumorph::studio {
namespace {

constexpr int kPageWidth = 900;                      // pixels; wider rows part a name from its number
constexpr double kUsualSpeed = 0.3, kFastest = 2.0;  // metres a second
constexpr double kUsualFloat = 0.02, kHighest = 0.2; // metres

QString partName(BudgetPart part) {
    switch (part) {
    case BudgetPart::projector:
        return QObject::tr("Projector's light");
    case BudgetPart::tracker:
        return QObject::tr("Tracker in the room");
    case BudgetPart::device:
        return QObject::tr("Device on its body");
    case BudgetPart::eye:
        return QObject::tr("Eye");
    case BudgetPart::servos:
        return QObject::tr("Servos");
    case BudgetPart::delay:
        return QObject::tr("Delay that is not known");
    case BudgetPart::prediction:
        break;
    }
    return QObject::tr("What prediction leaves");
}

QString sourceWords(ErrorSource source) {
    switch (source) {
    case ErrorSource::told:
        return QObject::tr("measured");
    case ErrorSource::measured:
        return QObject::tr("measured; as it usually comes out");
    case ErrorSource::assumed:
        return QObject::tr("not measured; as it usually is");
    case ErrorSource::worked:
        break;
    }
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

QString millimetresText(double metres) { return QString("%1 mm").arg(1e3 * metres, 0, 'f', 1); }

/// What the room, the device and a floating height make of errors; the hand's speed comes after it.
struct BudgetBasis {
    std::shared_ptr<const Rig> rig;
    SlipModel model;
    RoomErrors errors;
};

/// Where the millimetres come from, and the link that helps most.
class BudgetView : public QWidget {
public:
    explicit BudgetView(const CalibrateParts& parts)
        : parts_(parts), jobs_(*this, parts.studio.jobs, parts.studio.notices), total_(new QLabel(this)),
          words_(new QLabel(this)), bar_(new BudgetBar(this)), help_(new QPushButton(this)),
          speed_(new ValueField(Quantity::length, 0.0, kFastest, kUsualSpeed, this)),
          floats_(new ValueField(Quantity::length, 0.0, kHighest, kUsualFloat, this)) {
        setObjectName("budget.view");
        setProperty("look", "panel");
        setAttribute(Qt::WA_StyledBackground);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(16, 8, 16, 8);
        column->setSpacing(12);
        auto* top = new QHBoxLayout;
        top->addWidget(makeHeading(tr("Where the millimetres come from"), this), 1);
        auto* back = new QPushButton(tr("Back to the links"), this);
        back->setObjectName("budget.back");
        connect(back, &QPushButton::clicked, this, [this] { parts_.selection.setBudget(false); });
        top->addWidget(back);
        column->addLayout(top);
        column->addWidget(makeJobBar(parts.studio.jobs, "budget", this));
        column->addWidget(makeNoticeBar(parts.studio.notices, "budget", this));
        const Column page = makeColumn(this);
        column->addWidget(page.widget, 1);
        fillPage(*page.layout);
        connect(&parts.studio.document, &StudioDocument::changed, this, [this](StateParts changed) {
            if (changed & (StateParts(StatePart::rig) | StatePart::rigEdited | StatePart::installation)) makeStale();
        });
        connect(&parts.selection, &CalibrateSelection::budgetChanged, this, [this] { follow(); });
        showBudget();
    }

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        follow();
    }

private:
    void fillPage(QVBoxLayout& page) {
        total_->setObjectName("budget.total");
        total_->setAccessibleName(tr("All together"));
        makeLarge(total_, 32, {});
        page.addWidget(total_);
        words_->setObjectName("budget.words");
        words_->setProperty("look", "muted");
        words_->setWordWrap(true);
        words_->setMaximumWidth(kPageWidth);
        page.addWidget(words_);
        bar_->setMaximumWidth(kPageWidth);
        page.addWidget(bar_);
        help_->setObjectName("budget.help");
        help_->setProperty("look", "primary");
        connect(help_, &QPushButton::clicked, this, [this] { goToLink(); });
        page.addWidget(help_, 0, Qt::AlignLeft);
        page.addWidget(makeHeading(tr("What is shown, and who carries it"), this));
        speed_->setObjectName("budget.speed");
        floats_->setObjectName("budget.floats");
        speed_->setValue(kUsualSpeed);
        floats_->setValue(kUsualFloat);
        for (QWidget* row : {makeRow(tr("The hand goes in a second"), speed_, this),
                             makeRow(tr("Things float over the surface by"), floats_, this)}) {
            row->setMaximumWidth(420);
            page.addWidget(row);
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
        page.addStretch(1);
    }

    void makeStale() {
        isStale_ = true;
        follow();
    }

    /// Works only for who looks.
    void follow() {
        if (!isStale_ || !isVisible()) return;
        isStale_ = false;
        const StudioState& state = parts_.studio.document.state();
        if (!state.rig.rig) {
            basis_.reset();
            return showBudget();
        }
        parts_.studio.notices.dismissAll("budget");
        jobs_.run<BudgetBasis>(
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
            });
    }

    void showBudget() {
        advised_.reset();
        for (QWidget* part : {static_cast<QWidget*>(total_), static_cast<QWidget*>(bar_)})
            part->setVisible(basis_ != nullptr);
        help_->hide();
        if (!basis_) {
            words_->setText(tr("Open a device: how far pictures slip on it is added up here, part by part."));
            return;
        }
        CarryingHand hand;
        hand.speed = speed_->value();
        const ErrorBudget budget = budgetOf(*basis_->rig, basis_->model, basis_->errors, hand);
        total_->setText(millimetresText(budget.total));
        QString words = tr("So far what is shown lies beside where the viewer should see it, across the sight: root "
                           "mean square over the device, all parts together. Squares are added, so that the largest "
                           "part is nearly all that counts.");
        if (!budget.isTrackerPlaced)
            words += ' ' + tr("Nobody has said where the tracker's world lies; it counts as if laid in by a ruler.");
        words_->setText(words);
        std::vector<BudgetSlice> slices;
        for (const BudgetItem& item : budget.items)
            slices.push_back({partName(item.part), sourceWords(item.source), 1e3 * item.metres, item.share,
                              item.source != ErrorSource::assumed});
        bar_->show(std::move(slices));
        const auto best =
            std::ranges::find_if(budget.advice, [](const BudgetAdvice& one) { return linkOf(one.part).has_value(); });
        if (best == budget.advice.end()) return;
        advised_ = linkOf(best->part);
        const QString title = chainLinks()[*advised_].title.toLower();
        help_->setText((best->isFirst ? tr("Measure: %1, %2 → %3") : tr("Measure again: %1, %2 → %3"))
                           .arg(title, millimetresText(best->before), millimetresText(best->after)));
        help_->show();
    }

    void goToLink() {
        if (!advised_) return;
        parts_.chain.choose(*advised_);
        parts_.selection.setBudget(false);
    }

    CalibrateParts parts_;
    JobSlots jobs_;
    QLabel *total_, *words_;
    BudgetBar* bar_;
    QPushButton* help_;
    ValueField *speed_, *floats_;
    std::unique_ptr<BudgetBasis> basis_;
    std::optional<std::size_t> advised_;
    bool isStale_ = true;
};

} // namespace

QWidget* makeBudgetView(const CalibrateParts& parts) { return new BudgetView(parts); }

} // namespace lumorph::studio
