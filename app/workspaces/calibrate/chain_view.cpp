#include <optional>

#include <QFrame>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QVBoxLayout>

#include "app/studio/calibration/chain_service.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/workspaces/calibrate/calibrate_commands.h"
#include "app/workspaces/calibrate/chain_docks.h"
#include "app/workspaces/calibrate/finding_card.h"
#include "app/workspaces/calibrate/point_bars.h"
#include "app/workspaces/calibrate/state_row.h"
#include "app/workspaces/common/step_card.h"

namespace lumorph::studio {
namespace {

using How = StageStand::How;

struct StandLook {
    QString icon;
    IconRole role;
    QString word;
};

StandLook lookOf(const ChainState& state, std::size_t link) {
    const CalibrationSession& session = state.session;
    if (session.running() == link) return {"clock", IconRole::accent, "Running"};
    if (session.troubles().contains(link)) return {"error", IconRole::danger, "Refused"};
    if (const StageOutcome* outcome = session.outcomeAt(link); outcome && !outcome->isUsed)
        return outcome->isGood ? StandLook{"hand", IconRole::accent, "To be used"}
                               : StandLook{"warning", IconRole::warning, "Needs you"};
    switch (session.stands()[link].how) {
    case How::measured:
        return {"check", IconRole::accent, "Measured"};
    case How::simulated:
        return {"check", IconRole::muted, "Simulated"};
    case How::entered:
        return {"check", IconRole::muted, "By hand"};
    case How::stale:
        return {"warning", IconRole::warning, "Again"};
    case How::waits:
        return {"minus", IconRole::muted, "Later"};
    case How::spare:
        return {"minus", IconRole::muted, "Optional"};
    case How::open:
        break;
    }
    const bool next = session.next() == link;
    return {next ? "hand" : "minus", next ? IconRole::accent : IconRole::muted, next ? "Next" : "Open"};
}

constexpr int kRowWidth = 300; // pixels, at least; a long title breaks into lines

/// One link as a button: number, title, where it stands, and why.
class LinkRow : public QPushButton {
public:
    LinkRow(std::size_t link, QWidget* parent) : QPushButton(parent), link_(link) {
        setObjectName(QString("chain.link.") + chainLinks()[link].key);
        setProperty("look", "row");
        setCheckable(true);
        setAutoExclusive(true);
        row_.emplace(*this, QMargins(8, 6, 8, 6));
        setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Minimum);
    }
    /// `isChosen`: not while none of them is looked at. `number`: its place among those that are shown; 0: none.
    void show(const ChainState& state, bool isChosen, int number) {
        const StandLook look = lookOf(state, link_);
        const ChainLink& shown = chainLinks()[link_];
        const QString words = wordsOf(state.session.stands()[link_]);
        row_->show({look.icon, look.role, shown.title, look.word,
                    words.isEmpty() ? shown.purpose : words.left(1).toUpper() + words.mid(1), number});
        setAutoExclusive(false); // else the chosen one could not be let go of
        setChecked(isChosen);
        setAutoExclusive(true);
    }
    [[nodiscard]] QSize sizeHint() const override { return layout()->sizeHint(); }
    [[nodiscard]] QSize minimumSizeHint() const override { return layout()->minimumSize().expandedTo({kRowWidth, 0}); }

private:
    std::size_t link_;
    std::optional<StateRow> row_; ///< once this has its name
};

class ChainLinks : public QWidget {
public:
    explicit ChainLinks(const CalibrateParts& parts) : parts_(parts) {
        auto* whole = new QVBoxLayout(this);
        whole->setContentsMargins(0, 0, 0, 0);
        const Column column = makeColumn(this);
        whole->addWidget(column.widget);
        column.layout->addWidget(
            makeCommandButton(parts.studio.commands.find("calibrate.connected"), "chain.connected", this));
        for (std::size_t k = 0; k < chainLinks().size(); ++k) {
            auto* row = new LinkRow(k, this);
            connect(row, &QPushButton::clicked, this, [this, k] {
                parts_.chain.choose(k);
                parts_.selection.setPage(CalibrateSelection::Page::link);
            });
            rows_.push_back(row);
            if (isAside(k))
                others_.push_back(row);
            else
                column.layout->addWidget(row);
        }
        rest_ = makeCommandButton(parts.studio.commands.find("calibrate.chain.rest"), "chain.rest", this);
        column.layout->addWidget(rest_);
        column.layout->addWidget(
            makeCommandButton(parts.studio.commands.find("calibrate.budget"), "chain.budget", this));
        column.layout->addWidget(makeHeading("Other ways to calibrate a projector", this));
        for (LinkRow* row : others_) column.layout->addWidget(row);
        column.layout->addStretch(1);
        connect(&parts.chain, &ChainService::changed, this, [this] { refresh(); });
        connect(&parts.selection, &CalibrateSelection::pageChanged, this, [this] { refresh(); });
        refresh();
    }

private:
    /// In place of another link, not one after it.
    static bool isAside(std::size_t link) {
        return chainLinks()[link].id == LinkId::mirror || chainLinks()[link].id == LinkId::deviceAlone;
    }

    void refresh() {
        const ChainState& state = parts_.chain.state();
        int number = 0;
        for (std::size_t k = 0; k < rows_.size(); ++k) {
            const bool isChosen = state.chosen == k && parts_.selection.page() == CalibrateSelection::Page::link;
            // With one projector there are not several to be brought together.
            const bool isShown =
                chainLinks()[k].id != LinkId::room || state.session.stands()[k].how != How::spare || isChosen;
            rows_[k]->setVisible(isShown);
            rows_[k]->show(state, isChosen, isShown && !isAside(k) ? ++number : 0);
        }
    }

    CalibrateParts parts_;
    std::vector<LinkRow*> rows_, others_;
    QPushButton* rest_ = nullptr;
};

QLabel* makeText(const QString& name, const char* look, QWidget* parent) {
    auto* label = new QLabel(parent);
    label->setObjectName(name);
    label->setProperty("look", look);
    label->setWordWrap(true);
    label->setTextFormat(Qt::PlainText);
    return label;
}

StepCardText cardOf(const ChainStep& step) {
    return {step.tone, step.title, step.text, step.button, step.what == ChainStep::Do::cancel};
}

/// The chosen link: its next step, what will happen, and what it came to.
class ChainView : public QWidget {
public:
    explicit ChainView(const CalibrateParts& parts)
        : parts_(parts), card_(new StepCard("chain.card", "target", this)), progress_(new QProgressBar(this)),
          warning_(makeText("chain.warning", "", this)), how_(makeText("chain.how", "", this)),
          points_(new PointBars(this)) {
        setObjectName("chain.view");
        setProperty("look", "panel");
        setAttribute(Qt::WA_StyledBackground);
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(16, 8, 16, 8);
        column->setSpacing(12);
        column->addWidget(card_);
        progress_->setObjectName("chain.progress");
        progress_->setTextVisible(false);
        QSizePolicy keeps = progress_->sizePolicy();
        keeps.setRetainSizeWhenHidden(true);
        progress_->setSizePolicy(keeps);
        column->addWidget(progress_);
        const Column page = makeColumn(this);
        column->addWidget(page.widget, 1);
        makeLarge(warning_, 30, {});
        warning_->setAlignment(Qt::AlignCenter);
        warning_->setMinimumHeight(90);
        page.layout->addWidget(warning_);
        heading_ = makeHeading("What happens", this);
        page.layout->addWidget(heading_);
        page.layout->addWidget(how_);
        page.layout->addWidget(makeChainSource(parts, this));
        points_->setMaximumWidth(900);
        pointsHeading_ = makeHeading("How far points lie beside", this);
        page.layout->addWidget(pointsHeading_);
        page.layout->addWidget(points_);
        page.layout->addStretch(1);
        connect(card_, &StepCard::nextWanted, parts.studio.commands.find("calibrate.next"), &QAction::trigger);
        connect(&parts.chain, &ChainService::changed, this, [this] { refresh(); });
        refresh();
    }

private:
    void refresh() {
        const ChainState& state = parts_.chain.state();
        const ChainLink& link = chainLinks()[state.chosen];
        card_->show(cardOf(stepOf(state)));
        const std::optional<std::size_t> running = state.session.running();
        progress_->setVisible(running.has_value());
        progress_->setRange(0, state.fraction < 0.0 ? 0 : 1000);
        progress_->setValue(static_cast<int>(1000.0 * state.fraction));
        const bool runs = running == state.chosen;
        const StageOutcome* outcome = state.session.outcomeAt(state.chosen);
        // Who touches things stands at the table, and reads the step from there.
        const bool touches = runs && state.live;
        const bool isStill = wayOf(state, state.chosen) == LinkWay::live && !link.isMoved;
        const QString large = touches ? state.live->title : isStill ? QString() : link.warning;
        warning_->setText(large);
        warning_->setVisible(!large.isEmpty() && (runs || !outcome));
        QString text;
        for (std::size_t k = 0; k < link.how.size(); ++k)
            text += QString("%1%2.  %3").arg(k == 0 ? "" : "\n").arg(k + 1).arg(link.how[k]);
        how_->setText(text);
        // Recordings say themselves what is in them.
        for (QWidget* part : {heading_, static_cast<QWidget*>(how_)})
            part->setVisible(wayOf(state, state.chosen) != LinkWay::files && !state.live);
        const std::vector<LinkPoint> points = outcome ? wordsOf(*outcome).points : std::vector<LinkPoint>();
        pointsHeading_->setVisible(!points.empty());
        points_->setVisible(!points.empty());
        points_->show(points);
    }

    CalibrateParts parts_;
    StepCard* card_;
    QProgressBar* progress_;
    QLabel *warning_, *how_;
    QWidget* heading_ = nullptr;
    QWidget* pointsHeading_ = nullptr;
    PointBars* points_;
};

/// Figures and findings of the chosen link.
class ChainResult : public QWidget {
public:
    explicit ChainResult(const CalibrateParts& parts) : parts_(parts) {
        auto* whole = new QVBoxLayout(this);
        whole->setContentsMargins(0, 0, 0, 0);
        empty_ = makeEmptyState(
            "target", "Not measured yet",
            "What a measurement came to is told here, with the check points that the fit never saw.", nullptr, this);
        whole->addWidget(empty_);
        const Column column = makeColumn(this);
        page_ = column.widget;
        list_ = column.layout;
        whole->addWidget(page_);
        connect(&parts.chain, &ChainService::changed, this, [this] { refresh(); });
        refresh();
    }

private:
    void refresh() {
        const ChainState& state = parts_.chain.state();
        const StageOutcome* outcome = state.session.outcomeAt(state.chosen);
        empty_->setVisible(!outcome);
        page_->setVisible(outcome);
        while (QLayoutItem* old = list_->takeAt(0)) {
            if (old->widget()) {
                old->widget()->hide();
                old->widget()->deleteLater();
            }
            delete old;
        }
        if (!outcome) return;
        const LinkWords read = wordsOf(*outcome);
        list_->addWidget(makeHeading(chainLinks()[state.chosen].title, page_));
        for (const FindingWords& words : read.findings)
            list_->addWidget(makeFindingCard(words, !outcome->isGood, page_));
        for (const LinkFigure& figure : read.figures) list_->addWidget(makeFigure(figure));
        if (outcome->recording) addKeeping(state);
        list_->addStretch(1);
    }

    /// What was recorded can be solved again, where it is kept.
    void addKeeping(const ChainState& state) {
        const auto kept = state.kept.find(state.chosen);
        if (kept != state.kept.end()) {
            auto* where =
                new QLabel(QString("Recording kept in %1").arg(QString::fromStdString(kept->second.string())), page_);
            where->setObjectName("chain.kept");
            where->setProperty("look", "muted");
            where->setWordWrap(true);
            list_->addWidget(where);
            return;
        }
        auto* keep = new QPushButton("Keep the recording...", page_);
        keep->setObjectName("chain.keep");
        keep->setToolTip("Pictures, poses and times as the devices gave them, in a folder: they can be solved again");
        connect(keep, &QPushButton::clicked, this, [this, link = state.chosen] { askToKeepRecording(parts_, link); });
        list_->addWidget(keep, 0, Qt::AlignLeft);
    }

    QWidget* makeFigure(const LinkFigure& figure) {
        auto* plate = new QWidget(page_);
        auto* column = new QVBoxLayout(plate);
        column->setContentsMargins(0, 4, 0, 4);
        column->setSpacing(0);
        auto* value = new QLabel(figure.value, plate);
        value->setObjectName("chain.figure." + figure.name);
        value->setAccessibleName(figure.name);
        makeLarge(value, 20, {});
        if (!figure.isGood) value->setProperty("look", "warning");
        value->setTextInteractionFlags(Qt::TextSelectableByMouse);
        value->setWordWrap(true);
        auto* name = new QLabel(figure.name, plate);
        name->setProperty("look", "muted");
        column->addWidget(value);
        column->addWidget(name);
        return plate;
    }

    CalibrateParts parts_;
    QWidget* empty_;
    QWidget* page_ = nullptr;
    QVBoxLayout* list_ = nullptr;
};

} // namespace

QWidget* makeChainLinks(const CalibrateParts& parts) { return new ChainLinks(parts); }
QWidget* makeChainView(const CalibrateParts& parts) { return new ChainView(parts); }
QWidget* makeChainResult(const CalibrateParts& parts) { return new ChainResult(parts); }

} // namespace lumorph::studio
