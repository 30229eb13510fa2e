#include "app/workspaces/scene/item_fit.h"

#include <algorithm>

#include <QPushButton>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/throttle.h"

namespace lumorph::studio {

namespace {

constexpr int kFitMilliseconds = 150;
constexpr double kWorthSaying = 0.02; ///< of the item's volume
constexpr double kPoorFit = 0.1;      ///< below it nobody recognises the shape

class ItemFitRow : public QWidget {
public:
    ItemFitRow(Studio& studio, const Part<SceneItem>& item)
        : studio_(studio), item_(item), numbers_(new QLabel(this)), warning_(new QLabel(this)),
          give_(makeCommandButton(studio.commands.find("drive.sceneItem"), "item.fit.give", this, true)) {
        setObjectName("item.fit");
        numbers_->setObjectName("item.fit.numbers");
        numbers_->setWordWrap(true);
        numbers_->setToolTip(tr("Intersection over union of the item, from the device's surface up to its top, and the "
                                "volume that the device covers: 1 is a perfect fit"));
        warning_->setObjectName("item.fit.warning");
        warning_->setProperty("look", "warning");
        warning_->setWordWrap(true);
        give_->setText(tr("Let it move the servos"));
        auto* column = new QVBoxLayout(this);
        column->setContentsMargins(0, 0, 0, 0);
        column->setSpacing(4);
        column->addWidget(numbers_);
        column->addWidget(warning_);
        column->addWidget(give_, 0, Qt::AlignLeft);
        auto* due = new Throttle(kFitMilliseconds, this);
        connect(&studio.loop, &StudioLoop::framed, due, &Throttle::request);
        connect(due, &Throttle::due, this, [this] { refresh(); });
        connect(&studio.driver, &DriverControl::changed, this, [this] { refresh(); });
    }

    void refresh() {
        const StudioState& state = studio_.document.state();
        const SceneItem* item = item_.read(state);
        const SceneItem* follows = state.scene ? followableItem(*state.scene) : nullptr;
        const bool forServos = item && follows && item->id == follows->id;
        setVisible(forServos);
        if (!forServos) return;
        const Driver driver = studio_.driver.driver();
        const bool drives = driver == Driver::sceneItem;
        give_->setVisible(!drives);
        if (!drives) {
            numbers_->setText(tr("The servos do not follow it now: %1 '%2' moves them.")
                                  .arg(DriverControl::kindOf(driver).toLower(), studio_.driver.nameOf(driver)));
            return warning_->hide();
        }
        const auto& frame = studio_.loop.frame();
        const bool known = frame && frame->itemFit && frame->itemFit->item == item->id;
        numbers_->setText(known               ? numbersOf(*frame->itemFit)
                          : state.field.field ? tr("The servos follow it.")
                                              : tr("The servos follow it. How well it fits is known once the "
                                                   "field is built, in the Field workspace."));
        const QString why = !known                          ? QString()
                            : item->role == ItemRole::split ? splitOf(*frame->itemFit)
                                                            : warningOf(*frame->itemFit);
        warning_->setText(why);
        warning_->setVisible(!why.isEmpty());
    }

private:
    static QString numbersOf(const ItemFit& fit) {
        return tr("IoU %1, reached %2").arg(fit.iouWanted, 0, 'f', 2).arg(fit.iouEstimated, 0, 'f', 2);
    }

    /// What servos leave out of a split item light shows anyway.
    static QString splitOf(const ItemFit& fit) {
        if (fit.volume <= 0.0)
            return tr("Nothing of it stands above the device's surface, where servos could lift it.");
        const double left = std::max(fit.shareUnreachable, fit.shareBeyondFrame);
        return left > kWorthSaying
                   ? tr("%1 of it is where the servos do not come: light alone shows it there.").arg(shareText(left))
                   : QString();
    }

    /// The gravest alone.
    static QString warningOf(const ItemFit& fit) {
        if (fit.volume <= 0.0)
            return tr("Nothing of it stands above the device's surface, where servos could lift it: move it up or over "
                      "the device.");
        if (fit.shareUnreachable > kWorthSaying && fit.shareUnreachable >= fit.shareBeyondFrame)
            return tr("%1 of it is where no actuator reaches: move or turn it.").arg(shareText(fit.shareUnreachable));
        if (fit.shareBeyondFrame > kWorthSaying)
            return tr("%1 of it lies beyond what the device can reach: make it smaller, or move it.")
                .arg(shareText(fit.shareBeyondFrame));
        if (fit.iouWanted < kPoorFit)
            return tr("The servos cannot show it: it is too small or too steep for them. Make it larger, or leave it "
                      "to light.");
        return {};
    }

    Studio& studio_;
    const Part<SceneItem> item_;
    QLabel* numbers_;
    QLabel* warning_;
    QPushButton* give_;
};

} // namespace

void addItemFitRows(SceneForm& form, Studio& studio, const Part<SceneItem>& item) {
    auto* row = new ItemFitRow(studio, item);
    form.add(row);
    form.onRefresh([row](const StudioState&) { row->refresh(); });
}

} // namespace lumorph::studio
