#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QShowEvent>
#include <QVBoxLayout>

#include "app/studio/document/job_slots.h"
#include "app/studio/document/scene_edit.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/throttle.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/rig/light_map_view.h"
#include "app/workspaces/rig/rig_docks.h"
#include "core/base/spare_core.h"

namespace lumorph::studio {

namespace {

constexpr const char* kLightPlace = "rig.light";
constexpr int kLightMilliseconds = 200; ///< edits that come faster, as in a drag, are looked at together
constexpr double kFarthest = 10.0;      ///< metres from the middle of the table

/// What the dock knows of a device and the light on it.
struct LightFound {
    std::shared_ptr<const LitDevice> device;
    std::shared_ptr<const TriangleMesh> mesh; ///< at rest, world metres
    LightMap now;                             ///< of the projectors that hang in the room
};

QString placeText(const glm::dvec3& place) {
    const auto centimetres = [](double metres) { return QString::number(std::lround(100.0 * std::abs(metres))); };
    return QString("%1 cm above the table, %2 cm to the %3, %4 cm to the %5")
        .arg(centimetres(place.y), centimetres(place.x), place.x < 0.0 ? "left" : "right", centimetres(place.z),
             place.z < 0.0 ? "back" : "front");
}

QString lightText(const LightMap& map) {
    if (!(map.lit > 0.0)) return "No light reaches the device.";
    return QString("Over all its states %1 of its upper side is lit; of that, 95\u00A0% have %2 pixels a mm or more, "
                   "and light no more than %3\u00B0 from head on.")
        .arg(shareText(map.lit).replace(' ', QChar::Nbsp))
        .arg(map.pixelsPerMillimetre, 0, 'f', 2)
        .arg(std::lround(map.incidence.inDegrees()));
}

QWidget* makePair(ValueField* from, ValueField* to, const QString& between = "to") {
    auto* pair = new QWidget;
    auto* layout = new QHBoxLayout(pair);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    layout->addWidget(from, 1);
    layout->addWidget(new QLabel(between));
    layout->addWidget(to, 1);
    pair->setFocusProxy(from);
    return pair;
}

class RigLight : public QWidget {
public:
    explicit RigLight(Studio& studio);

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        follow();
    }

private:
    QWidget* makeForm();
    ValueField* addNumber(const QString& name, Quantity quantity, double least, double most, double value);
    void follow();  ///< the rig and the room as they are now
    void measure(); ///< the light of the room's projectors
    void search();
    void showAll();
    void hang();
    [[nodiscard]] ProjectorLens lens() const;
    [[nodiscard]] const InstalledProjector* hanging() const;

    Studio& studio_;
    JobSlots slots_;
    QLabel* text_ = new QLabel;
    QComboBox* shown_ = new QComboBox;
    QComboBox* whose_ = new QComboBox;
    QWidget* whoseRow_ = nullptr;
    Throttle* soon_;
    LightMapView* map_ = new LightMapView;
    std::array<ValueField*, 2> size_{}, throw_{};
    std::array<ValueField*, 3> low_{}, high_{};
    ValueField* shift_ = nullptr;
    QPushButton* button_ = new QPushButton("Find the best place");
    QLabel* best_ = new QLabel;
    QPushButton* hang_ = new QPushButton("Hang the projector there");

    std::shared_ptr<const Rig> rig_; ///< that was measured, or is being measured
    std::shared_ptr<const Installation> room_;
    std::shared_ptr<const LightFound> found_;
    std::optional<ProjectorPlace> proposed_;
};

RigLight::RigLight(Studio& studio)
    : studio_(studio), slots_(*this, studio.jobs, studio.notices), soon_(new Throttle(kLightMilliseconds, this)) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(0);
    layout->addWidget(makeNoticeBar(studio.notices, kLightPlace));
    layout->addWidget(makeJobBar(studio.jobs, kLightPlace));
    const Column column = makeColumn();
    layout->addWidget(column.widget, 1);
    text_->setObjectName("rig.light.text");
    text_->setWordWrap(true);
    shown_->setObjectName("rig.light.shown");
    shown_->addItems({"Pixels a millimetre", "Slant of the light", "How often it is lit"});
    shown_->setToolTip("In the worst state in which a place is lit");
    whose_->setObjectName("rig.light.whose");
    whose_->addItems({"As projectors hang now", "From the best place"});
    column.layout->addWidget(text_);
    column.layout->addWidget(makeRow("Ma&p of", shown_));
    whoseRow_ = makeRow("Light", whose_);
    column.layout->addWidget(whoseRow_);
    column.layout->addWidget(map_, 1);
    column.layout->addWidget(makeForm());
    column.layout->addWidget(button_);
    best_->setObjectName("rig.light.best");
    best_->setWordWrap(true);
    column.layout->addWidget(best_);
    column.layout->addWidget(hang_);
    button_->setObjectName("rig.light.search");
    button_->setProperty("look", "primary");
    hang_->setObjectName("rig.light.hang");
    connect(shown_, &QComboBox::currentIndexChanged, this,
            [this](int index) { map_->setShown(static_cast<LightMapView::Shown>(index)); });
    connect(whose_, &QComboBox::currentIndexChanged, this, [this] { showAll(); });
    connect(button_, &QPushButton::clicked, this, [this] { search(); });
    connect(hang_, &QPushButton::clicked, this, [this] { hang(); });
    connect(&studio.document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & (StatePart::rig | StatePart::rigEdited | StatePart::installation)) soon_->request();
    });
    connect(soon_, &Throttle::due, this, [this] { follow(); });
    showAll();
}

ValueField* RigLight::addNumber(const QString& name, Quantity quantity, double least, double most, double value) {
    auto* field = new ValueField(quantity, least, most, value);
    field->setObjectName("rig.light." + name);
    field->setValue(value);
    return field;
}

QWidget* RigLight::makeForm() {
    auto* form = new QWidget;
    auto* layout = new QVBoxLayout(form);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    layout->addWidget(makeHeading("Where should a projector hang?"));
    size_ = {addNumber("width", Quantity::plain, 16, 16384, 1920),
             addNumber("height", Quantity::plain, 16, 16384, 1080)};
    throw_ = {addNumber("throwLeast", Quantity::plain, 0.1, 20.0, 1.2),
              addNumber("throwMost", Quantity::plain, 0.1, 20.0, 1.2)};
    shift_ = addNumber("shift", Quantity::share, -2.0, 2.0, 0.0);
    for (ValueField* field : size_) field->setStep(1.0);
    for (ValueField* field : throw_) {
        field->setStep(0.05);
        field->setToolTip("Distance divided by the picture's width, at both ends of the zoom; in its data sheet\n" +
                          field->toolTip());
    }
    shift_->setToolTip("How far the middle of its picture lies above the lens, in picture heights: 0 straight ahead, "
                       "50 % where the picture begins at the lens\n" +
                       shift_->toolTip());
    constexpr std::array<const char*, 3> kAxes{"x", "y", "z"};
    constexpr std::array<double, 3> kLow{-0.6, 0.8, -0.6}, kHigh{0.6, 2.2, 0.6};
    for (std::size_t k = 0; k < 3; ++k) {
        const double least = k == 1 ? 0.05 : -kFarthest;
        low_[k] = addNumber(QString("low.") + kAxes[k], Quantity::length, least, kFarthest, kLow[k]);
        high_[k] = addNumber(QString("high.") + kAxes[k], Quantity::length, least, kFarthest, kHigh[k]);
    }
    size_[0]->setAccessibleName("Pixels across");
    size_[1]->setAccessibleName("Pixels down");
    throw_[0]->setAccessibleName("Least throw ratio");
    throw_[1]->setAccessibleName("Largest throw ratio");
    constexpr std::array<const char*, 3> kFirst{"Farthest left", "Lowest above the table", "Farthest back"};
    constexpr std::array<const char*, 3> kLast{"Farthest right", "Highest above the table", "Farthest to the front"};
    for (std::size_t k = 0; k < 3; ++k) {
        low_[k]->setAccessibleName(kFirst[k]);
        high_[k]->setAccessibleName(kLast[k]);
    }
    layout->addWidget(makeRow("Pi&xels", makePair(size_[0], size_[1], "\u00D7")));
    layout->addWidget(makeRow("&Throw ratio", makePair(throw_[0], throw_[1])));
    layout->addWidget(makeRow("&Lens shift", shift_));
    layout->addWidget(makeRow("Left to &right", makePair(low_[0], high_[0])));
    layout->addWidget(makeRow("&Above the table", makePair(low_[1], high_[1])));
    layout->addWidget(makeRow("&Back to front", makePair(low_[2], high_[2])));
    return form;
}

const InstalledProjector* RigLight::hanging() const {
    return room_ && !room_->projectors.empty() ? &room_->projectors.front() : nullptr;
}

ProjectorLens RigLight::lens() const {
    return {{static_cast<int>(std::lround(size_[0]->value())), static_cast<int>(std::lround(size_[1]->value()))},
            std::min(throw_[0]->value(), throw_[1]->value()),
            std::max(throw_[0]->value(), throw_[1]->value()),
            shift_->value()};
}

void RigLight::follow() {
    if (!isVisible()) return;
    const StudioState& state = studio_.document.state();
    const bool sameRig =
        rig_ && state.rig.rig && (rig_ == state.rig.rig || deformAlike(rig_->parts(), state.rig.rig->parts()));
    const bool sameRoom = room_ && state.installation && isSameRoom(*room_, *state.installation);
    if (sameRig && sameRoom) return;
    const bool first = !room_;
    const bool samePlace = room_ && state.installation && room_->worldFromDevice == state.installation->worldFromDevice;
    rig_ = state.rig.rig;
    room_ = state.installation;
    if (first && hanging()) { // the lens that is there is the first to ask about
        const CalibratedCamera& camera = hanging()->camera;
        size_[0]->setValue(camera.size.x);
        size_[1]->setValue(camera.size.y);
        for (ValueField* field : throw_) field->setValue(camera.focal.x / camera.size.x);
        shift_->setValue((camera.principal.y - 0.5 * (camera.size.y - 1)) / camera.size.y);
    }
    if (!sameRig || !samePlace) proposed_.reset();
    measure();
}

void RigLight::measure() {
    if (!rig_ || !room_) {
        found_.reset();
        return showAll();
    }
    text_->setEnabled(false); // what it says is of before
    slots_.runWith<std::shared_ptr<const LightFound>>(
        "measure", kLightPlace, tr("Following the light"),
        [rig = rig_, room = room_](const Progress& progress) {
            auto found = std::make_shared<LightFound>();
            leavingACore([&] {
                found->device = std::make_shared<const LitDevice>(*rig, room->worldFromDevice, 8, 1000, progress);
                auto mesh = std::make_shared<TriangleMesh>(rig->restMesh());
                for (glm::vec3& point : mesh->positions)
                    point = glm::vec3(room->worldFromDevice * glm::vec4(point, 1.0F));
                found->mesh = std::move(mesh);
                std::vector<CalibratedCamera> cameras;
                for (const InstalledProjector& projector : room->projectors)
                    if (projector.enabled) cameras.push_back(projector.camera);
                found->now = found->device->lightOf(cameras);
            });
            return std::shared_ptr<const LightFound>(std::move(found));
        },
        [this](std::shared_ptr<const LightFound> found) {
            found_ = std::move(found);
            text_->setEnabled(true);
            showAll();
        },
        [this](const std::exception& error) {
            found_.reset(); // it was of another rig
            slots_.fail(kLightPlace, error);
            showAll();
        });
    showAll();
}

void RigLight::search() {
    if (!found_) return;
    glm::dvec3 low, high;
    for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        low[k] = std::min(low_[axis]->value(), high_[axis]->value());
        high[k] = std::max(low_[axis]->value(), high_[axis]->value());
    }
    std::vector<CalibratedCamera> others; // what hangs beside the first projector, whose place is looked for
    for (std::size_t k = 1; room_ && k < room_->projectors.size(); ++k)
        if (room_->projectors[k].enabled) others.push_back(room_->projectors[k].camera);
    studio_.notices.dismissAll(kLightPlace);
    slots_.run<ProjectorPlace>(
        "search", kLightPlace, tr("Looking for the best place"),
        [device = found_->device, lens = lens(), low, high, others](const Progress& progress) {
            std::optional<ProjectorPlace> best;
            leavingACore([&] { best = bestProjectorPlace(*device, lens, low, high, others, {}, progress); });
            return *best;
        },
        [this](ProjectorPlace best) {
            proposed_ = std::move(best);
            whose_->setCurrentIndex(1);
            showAll();
        });
}

void RigLight::showAll() {
    const bool fromBest = proposed_ && whose_->currentIndex() == 1;
    text_->setText(!rig_     ? "Open a rig to see how light reaches it."
                   : !found_ ? "How light reaches it is not known yet."
                             : lightText(found_->now));
    whoseRow_->setVisible(proposed_.has_value());
    button_->setEnabled(found_ != nullptr);
    if (found_)
        map_->show(std::make_shared<const LightMap>(fromBest ? proposed_->light : found_->now), found_->mesh, {});
    else
        map_->show(nullptr, nullptr, {});
    best_->setVisible(proposed_.has_value());
    hang_->setVisible(proposed_.has_value());
    if (!proposed_) return;
    best_->setText(QString("Best place: %1%2, throw ratio %3. %4")
                       .arg(placeText(positionOf(proposed_->camera)), proposed_->turned ? ", on its side" : "")
                       .arg(proposed_->throwRatio, 0, 'f', 2)
                       .arg(lightText(proposed_->light)));
    const bool measured = hanging() && hanging()->pose.way == Origin::Way::measured;
    hang_->setEnabled(hanging() && !measured);
    hang_->setToolTip(measured ? "Where the projector stands was measured; a plan does not take the place of that"
                               : "The room's first projector gets this lens and place, by one step of undo");
}

void RigLight::hang() {
    if (!proposed_ || !hanging()) return;
    editInstallation(studio_.document, tr("Hang the projector"), [camera = proposed_->camera](Installation& room) {
        InstalledProjector& projector = room.projectors.front();
        projector.camera = camera;
        projector.lens = projector.pose = {Origin::Way::entered, "planned", utcDate()};
    });
}

} // namespace

QWidget* makeRigLight(Studio& studio) { return new RigLight(studio); }

} // namespace lumorph::studio
