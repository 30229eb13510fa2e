#include "app/workspaces/field/match_numbers.h"

#include <QGridLayout>
#include <QLabel>
#include <QPainter>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"

namespace lumorph::studio {

namespace {

class Chip : public QWidget {
public:
    Chip(bool unmatched, QWidget* parent) : QWidget(parent), unmatched_(unmatched) { setFixedSize(10, 10); }

protected:
    void paintEvent(QPaintEvent* /*event*/) override {
        QPainter painter(this);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setPen(Qt::NoPen);
        painter.setBrush(unmatched_ ? currentPalette().unmatched : currentPalette().overfilled);
        painter.drawRoundedRect(rect(), 2.0, 2.0);
    }

private:
    bool unmatched_;
};

QString iouText(double iou) { return QString::number(iou, 'f', 2); }

QLabel* muted(const QString& text, QWidget* parent) {
    auto* label = new QLabel(text, parent);
    label->setProperty("look", "muted");
    return label;
}

/// Of the rest of the target what the match itself leaves out; what cannot be shown at all is warned of.
QString whyNotBetter(const MatchFrame& frame) {
    constexpr double kLittle = 5e-7; // cubic metres: half a cubic centimetre
    const double givenUp = frame.unmatchedVolume - frame.targetVolume * frame.shareUnreachable;
    return givenUp > kLittle ? QObject::tr("%1 of the target are given up for a better whole.").arg(volumeText(givenUp))
                             : QString();
}

/// A chip, a word and a number in one row.
QWidget* makeVolume(bool unmatched, const QString& text, const QString& hint, QLabel* number, QWidget* parent) {
    auto* row = new QWidget(parent);
    row->setToolTip(hint);
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    layout->addWidget(makeChip(unmatched, row));
    layout->addWidget(new QLabel(text, row), 1);
    layout->addWidget(number);
    return row;
}

} // namespace

QWidget* makeChip(bool unmatched, QWidget* parent) { return new Chip(unmatched, parent); }

MatchNumbers::MatchNumbers(QWidget* parent)
    : QWidget(parent), iou_(new QLabel(this)), word_(muted({}, this)), rest_(muted({}, this)), bound_(muted({}, this)),
      voting_(makeNumber("match.iou.voting", "0.00", this)), wanted_(makeNumber("match.iou.wanted", "0.00", this)),
      reached_(makeNumber("match.iou.reached", "0.00", this)),
      unmatched_(makeNumber("match.unmatched", "0000 cm³", this)),
      overfilled_(makeNumber("match.overfilled", "0000 cm³", this)) {
    iou_->setObjectName("match.iou");
    iou_->setToolTip("Intersection over union of the target and the volume that the device covers: 1 is a perfect fit");
    makeLarge(iou_, 44, "0.00");

    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(2);
    grid->addWidget(iou_, 0, 0, 3, 1);
    grid->addWidget(muted("IoU", this), 0, 1, Qt::AlignLeft | Qt::AlignBottom);
    word_->setObjectName("match.word");
    word_->setToolTip(tr("Good from 0.7 on, fair from 0.4 on, poor below"));
    grid->addWidget(word_, 1, 1, Qt::AlignLeft | Qt::AlignTop);
    grid->setColumnStretch(1, 1);
    const auto step = [&](int row, const QString& text, const QString& hint, QLabel* number) {
        QLabel* label = muted(text, this);
        label->setToolTip(hint);
        grid->addWidget(label, row, 2);
        grid->addWidget(number, row, 3);
    };
    step(0, "voting", "By Eq. 1 alone", voting_);
    step(1, "refined", "After refinement", wanted_);
    step(2, "reached", "Of what the servos have reached by now", reached_);
    grid->setRowMinimumHeight(3, 8);
    grid->addWidget(makeVolume(true, "Unmatched", "Volume of the target that the device leaves out", unmatched_, this),
                    4, 0, 1, 4);
    grid->addWidget(
        makeVolume(false, "Overfilled", "Volume that the device covers outside the target", overfilled_, this), 5, 0, 1,
        4);
    rest_->setObjectName("match.rest");
    rest_->setWordWrap(true);
    rest_->setMinimumHeight(fontMetrics().lineSpacing()); // what is below stays where it is while a target moves
    grid->addWidget(rest_, 6, 0, 1, 4);
    bound_->setObjectName("match.bound");
    bound_->setWordWrap(true);
    bound_->setMinimumHeight(2 * fontMetrics().lineSpacing()); // likewise while it becomes known
    bound_->setToolTip(tr("Certified for the target as it stands, over all joint states at the field's levels. It gets "
                          "tighter for half a minute while nothing moves."));
    grid->addWidget(bound_, 7, 0, 1, 4);
}

void MatchNumbers::show(const MatchFrame& frame, bool refined) {
    const QString none = "–";
    const bool known = frame.matched;
    iou_->setText(known ? iouText(frame.iouWanted) : none);
    voting_->setText(known ? iouText(frame.iouVoting) : none);
    wanted_->setText(known && refined ? iouText(frame.iouWanted) : none);
    reached_->setText(known ? iouText(frame.iouEstimated) : none);
    unmatched_->setText(known ? volumeText(frame.unmatchedVolume) : none);
    overfilled_->setText(known ? volumeText(frame.overfilledVolume) : none);
    word_->setText(!known                   ? ""
                   : frame.iouWanted >= 0.7 ? tr("good")
                   : frame.iouWanted >= 0.4 ? tr("fair")
                                            : tr("poor"));
    rest_->setText(known ? whyNotBetter(frame) : QString());
}

void MatchNumbers::showBound(const QString& sentence) { bound_->setText(sentence); }

} // namespace lumorph::studio
