#include "app/workspaces/field/target_dock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QStackedLayout>
#include <QToolButton>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/field_summary.h"
#include "app/workspaces/common/fit_relief.h"
#include "app/workspaces/field/placement_form.h"

namespace lumorph::studio {

namespace {

constexpr double kFastestSpin = 2.0 * std::numbers::pi;
constexpr QSize kPlacePicture(84, 60);

QLabel* makeText(const QString& name, const char* look, QWidget* parent) {
    auto* label = new QLabel(parent);
    label->setObjectName(name);
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    label->setProperty("look", look);
    return label;
}

/// "12,345 triangles, closed" and such.
QString whatItIs(const MatchTarget& target) {
    QString text = countText(target.solid.mesh.triangles.size()) + " triangles, ";
    text += target.solid.closed ? "closed" : "open";
    if (target.duration > 0.0) text += QString(", animated, %1 s").arg(target.duration, 0, 'f', 1);
    return text;
}

class TargetDock : public QWidget {
public:
    explicit TargetDock(Studio& studio) : studio_(studio) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeNoticeBar(studio.notices, "target", this));
        stack_ = new QStackedLayout;
        layout->addLayout(stack_, 1);
        stack_->addWidget(makeEmptyState("target", "No target yet",
                                         "The target is the 3D model whose shape the device takes. Open one, or drop "
                                         "it on the window.",
                                         studio.commands.find("target.open"), this));
        stack_->addWidget(column_.widget);
        addAbout();
        addPlace();
        addMotion();
        column_.layout->addStretch(1);
        connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
            if (parts & (StatePart::target | StatePart::field | StatePart::placement | StatePart::playback)) refresh();
        });
        showPlaces();
    }

private:
    QPushButton* button(const QString& command, QWidget* parent) {
        return makeCommandButton(studio_.commands.find(command), "button." + command, parent);
    }

    QWidget* makeButtons(const QString& first, const QString& second) {
        auto* bar = new QWidget(column_.widget);
        auto* layout = new QHBoxLayout(bar);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(8);
        layout->addWidget(button(first, bar), 1);
        layout->addWidget(button(second, bar), 1);
        return bar;
    }

    void addAbout() {
        name_ = makeText("target.name", "heading", column_.widget);
        about_ = makeText("target.about", "muted", column_.widget);
        size_ = makeText("target.extent", "muted", column_.widget);
        size_->setToolTip("Width, height and depth at this size, before it is turned and tipped");
        warnings_ = makeText("target.warnings", "warning", column_.widget);
        column_.layout->addWidget(name_);
        column_.layout->addWidget(about_);
        column_.layout->addWidget(size_);
        column_.layout->addWidget(warnings_);
        column_.layout->addWidget(makeButtons("target.open", "target.remove"));
    }

    void addPlace() {
        column_.layout->addWidget(makeHeading("Place", column_.widget));
        placesTitle_ = makeText("target.placesTitle", "muted", column_.widget);
        placesTitle_->setText(tr("Places that were found, and their IoU:"));
        column_.layout->addWidget(placesTitle_);
        places_ = new QWidget(column_.widget);
        auto* row = new QHBoxLayout(places_);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(8);
        for (std::size_t k = 0; k < placeButtons_.size(); ++k) {
            auto* place = new QToolButton(places_);
            place->setObjectName(QString("target.place.%1").arg(k + 1));
            place->setToolButtonStyle(Qt::ToolButtonTextUnderIcon);
            place->setIconSize(kPlacePicture);
            place->setCheckable(true);
            place->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
            connect(place, &QToolButton::clicked, this, [this, k] {
                studio_.project.choosePlace(k);
                refresh();
            });
            row->addWidget(place, 1);
            placeButtons_[k] = place;
        }
        column_.layout->addWidget(places_);
        column_.layout->addWidget(makePlacementForm(studio_.document, column_.widget));
        column_.layout->addWidget(makeButtons("target.fit", "target.autoPlace"));
        relief_ = new QCheckBox(tr("Show as &relief"), column_.widget);
        relief_->setObjectName("target.relief");
        relief_->setToolTip(tr("Face up, as a head on a coin: the heights are compressed to what the device rises by. "
                               "Light shows the target as it is."));
        connect(relief_, &QCheckBox::clicked, this, [this](bool on) {
            studio_.project.setRelief(on);
            refresh(); // until a place is found it is as it was
        });
        column_.layout->addWidget(relief_);
        shares_ = makeText("target.shares", "muted", column_.widget);
        column_.layout->addWidget(shares_);
        connect(&studio_.project, &ProjectService::placesChanged, this, [this] { showPlaces(); });
    }

    /// A picture of each: the target on the device, and what is missing or too much in their colours.
    void showPlaces() {
        const auto found = studio_.project.places();
        for (std::size_t k = 0; k < placeButtons_.size(); ++k) {
            placeButtons_[k]->setVisible(k < found.size());
            if (k >= found.size()) continue;
            const Coverage& coverage = studio_.document.state().field.field->coverage;
            const qreal ratio = devicePixelRatioF();
            QImage picture = pictureOf(reliefOf(coverage.body(), found[k].wanted, found[k].covered),
                                       kPlacePicture * ratio, currentPalette());
            picture.setDevicePixelRatio(ratio);
            placeButtons_[k]->setIcon(QPixmap::fromImage(picture));
            const QString iou = QString::number(found[k].iou, 'f', 2);
            placeButtons_[k]->setText(found[k].placement.relief ? tr("%1, relief").arg(iou) : iou);
            placeButtons_[k]->setToolTip(tr("Put the target there"));
        }
        placesTitle_->setVisible(found.size() > 1);
        places_->setVisible(found.size() > 1);
        refresh();
    }

    /// Which of them it is, and what a relief leaves to light.
    void refreshPlaces(const StudioState& state) {
        const auto found = studio_.project.places();
        for (std::size_t k = 0; k < found.size(); ++k)
            placeButtons_[k]->setChecked(found[k].placement == state.placement);
        relief_->setChecked(state.placement.relief);
        relief_->setEnabled(state.field.field && state.field.field->relief);
        shares_->setVisible(state.placement.relief && relief_->isEnabled());
        if (!shares_->isVisibleTo(this)) return;
        const ReliefRoom& room = *state.field.field->relief;
        const Box placed = boundingBox(cornersOf(state.target.target->box, state.placement.deviceFromTarget()));
        const double share = std::min(1.0, static_cast<double>((room.top - room.rest) / placed.size().y));
        shares_->setText(
            tr("Servos show its heights at %1 %; light shows the rest, undistorted.").arg(std::lround(100.0 * share)));
    }

    void addMotion() {
        column_.layout->addWidget(makeHeading("Motion", column_.widget));
        spin_ = new ValueField(Quantity::angle, -kFastestSpin, kFastestSpin, 0.0, column_.widget);
        spin_->setObjectName("target.spin");
        spin_->setStep(std::numbers::pi / 36.0);
        spin_->setToolTip("How far the target turns in a second. A double click stops it.");
        const auto edit = [](double value) { return [value](StudioState& state) { state.playback.spin = value; }; };
        connect(spin_, &ValueField::previewed, this,
                [this, edit](double value) { studio_.document.preview(edit(value)); });
        connect(spin_, &ValueField::committed, this, [this, edit](double value) {
            studio_.document.preview(edit(value));
            studio_.document.commitPreview("Spin the target");
        });
        connect(spin_, &ValueField::reverted, this, [this] { studio_.document.cancelPreview(); });
        column_.layout->addWidget(makeRow("S&pin a second", spin_, column_.widget));

        animations_ = new QComboBox(column_.widget);
        animations_->setObjectName("target.animation");
        animations_->setToolTip("Which of the file's animations is shown");
        connect(animations_, &QComboBox::activated, this, [this](int index) { choose(index); });
        animationRow_ = makeRow("&Animation", animations_, column_.widget);
        column_.layout->addWidget(animationRow_);
        play_ = button("target.play", column_.widget);
        column_.layout->addWidget(play_);
    }

    /// Reads the target again with another of its animations; its place stays.
    void choose(int animation) {
        const std::filesystem::path file = studio_.document.state().target.path;
        using Result = std::shared_ptr<const MatchTarget>;
        studio_.jobs.run<Result>(
            "target", "Reading the animation",
            [file, animation](const Progress& progress) { return readMatchTarget(file, animation, progress); },
            [this, file](const Result& target) {
                if (studio_.document.state().target.path != file) return;
                studio_.document.change("Choose an animation",
                                        [&target](StudioState& state) { state.target.target = target; });
            },
            [this](const std::exception& error) {
                studio_.notices.post("target", noticeOf(error));
                refresh();
            });
    }

    void refresh() {
        const StudioState& state = studio_.document.state();
        const auto& target = state.target.target;
        stack_->setCurrentIndex(target ? 1 : 0);
        if (!target) {
            shown_.reset();
            return;
        }
        refreshPlaces(state);
        const glm::vec3 size = target->box.size() * static_cast<float>(state.placement.scale);
        size_->setText(sizeText(size.x, size.y, size.z));
        spin_->setValue(state.playback.spin);
        if (target != shown_) describe(*target);
        shown_ = target;
    }

    void describe(const MatchTarget& target) {
        name_->setText(QString::fromStdString(target.name));
        about_->setText(whatItIs(target));
        QStringList warnings;
        for (const auto* list : {&target.warnings, &target.solid.warnings})
            for (const std::string& warning : *list)
                if (const QString text = QString::fromStdString(warning); !warnings.contains(text)) warnings << text;
        warnings_->setText(warnings.join('\n'));
        warnings_->setVisible(!warnings.isEmpty());
        listAnimations(target);
        play_->setVisible(target.duration > 0.0);
    }

    void listAnimations(const MatchTarget& target) {
        const QSignalBlocker quiet(animations_);
        animations_->clear();
        if (target.model)
            for (const Model::Animation& animation : target.model->animations)
                animations_->addItem(animation.name.empty() ? QString("Animation %1").arg(animations_->count() + 1)
                                                            : QString::fromStdString(animation.name));
        animations_->setCurrentIndex(target.animation);
        animationRow_->setVisible(animations_->count() > 1);
    }

    Studio& studio_;
    QCheckBox* relief_ = nullptr;
    QLabel *shares_ = nullptr, *placesTitle_ = nullptr;
    QWidget* places_ = nullptr;
    std::array<QToolButton*, 3> placeButtons_{};
    QStackedLayout* stack_ = nullptr;
    Column column_ = makeColumn(this);
    QLabel* name_ = nullptr;
    QLabel* about_ = nullptr;
    QLabel* size_ = nullptr;
    QLabel* warnings_ = nullptr;
    ValueField* spin_ = nullptr;
    QComboBox* animations_ = nullptr;
    QWidget* animationRow_ = nullptr;
    QPushButton* play_ = nullptr;
    std::shared_ptr<const MatchTarget> shown_;
};

} // namespace

QWidget* makeTargetDock(Studio& studio) { return new TargetDock(studio); }

} // namespace lumorph::studio
