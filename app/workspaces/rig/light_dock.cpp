#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPointer>
#include <QPushButton>
#include <QShowEvent>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/studio/document/job_slots.h"
#include "app/studio/document/scene_edit.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/throttle.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/common/field_colors.h"
#include "app/workspaces/rig/light_map_view.h"
#include "app/workspaces/rig/rig_docks.h"
#include "calibration/placement/projector_models.h"
#include "core/base/spare_core.h"

namespace lumorph::studio {

namespace {

constexpr const char* kLightPlace = "rig.light";
constexpr int kLightMilliseconds = 200; ///< edits that come faster, as in a drag, are looked at together
const QString kSightOf = "Sight of ";
constexpr double kFarthest = 10.0; ///< metres from the middle of the table

/// What the dock knows of a device and the light on it.
struct LightFound {
    std::shared_ptr<const LitDevice> device;
    std::shared_ptr<const TriangleMesh> mesh; ///< at rest, world metres
    LightMap now;                             ///< of the projectors that hang in the room
    std::shared_ptr<const Installation> room; ///< it was found in
    std::vector<LightMap> seen;               ///< by each of its cameras
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

QString metresText(double metres) { return QString("%1\u00A0m").arg(metres, 0, 'f', 2); }

/// Of the room's first projector.
QString focusText(const LightMap& map, const LensFocus& focus) {
    if (map.bestFocus.empty() || !(map.bestFocus.front() > 0.0)) return "It lights nothing that could be sharp.";
    const QString best = metresText(map.bestFocus.front());
    if (!(focus.aperture > 0.0)) return QString("For all states alike it is best focused at %1.").arg(best);
    return QString(
               "On 95\u00A0% of what is lit a point of the picture is no wider than %1\u00A0mm; best focused at %2.")
        .arg(1e3 * map.blur, 0, 'g', 2)
        .arg(best);
}

/// "1.6: 2.1, 1.9: 0.4": metres and millimetres; empty where it says nothing of the kind.
std::vector<MeasuredBlur> blurOf(const QString& text) {
    std::vector<MeasuredBlur> measured;
    for (const QString& pair : text.split(',', Qt::SkipEmptyParts)) {
        const QStringList numbers = pair.split(':');
        bool isDistance = false, isBlur = false;
        const MeasuredBlur at{numbers.front().toDouble(&isDistance), 1e-3 * numbers.back().toDouble(&isBlur)};
        if (numbers.size() != 2 || !isDistance || !isBlur) return {};
        measured.push_back(at);
    }
    return measured;
}

QString seenText(const LightMap& map, const QString& camera) {
    if (!(map.lit > 0.0)) return QString("%1 sees nothing of the device.").arg(camera);
    return QString("%1 sees %2 of its upper side over all its states; of that, 95\u00A0% with %3 pixels a mm or more.")
        .arg(camera, shareText(map.lit).replace(' ', QChar::Nbsp))
        .arg(map.pixelsPerMillimetre, 0, 'f', 2);
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
    RigLight(Studio& studio, RigSelection& selection);

protected:
    void showEvent(QShowEvent* event) override {
        QWidget::showEvent(event);
        follow();
        colourDevice();
    }
    void hideEvent(QHideEvent* event) override {
        QWidget::hideEvent(event);
        if (selection_) selection_->showColours(nullptr); // nothing would tell any more what they mean
    }

private:
    QWidget* makeForm();
    QWidget* makeFocus();
    void showFocus();
    void setLensFocus(const QString& what, const LensFocus& focus); ///< of the room's first projector
    void measureFocus();                                            ///< from blur that was typed in
    ValueField* addNumber(const QString& name, Quantity quantity, double least, double most, double value);
    void chooseModel();
    void showModel();  ///< which one the lens' numbers are of
    void listSights(); ///< whose light, or sight, the map can show
    void follow();     ///< the rig and the room as they are now
    void measure();    ///< the light of the room's projectors
    void search();
    void showAll();
    void colourDevice();                            ///< in the view, as the map is
    [[nodiscard]] const LightMap* shownMap() const; ///< null: none yet
    void hang();
    [[nodiscard]] ProjectorLens lens() const;
    [[nodiscard]] const InstalledProjector* hanging() const;

    Studio& studio_;
    QPointer<RigSelection> selection_; ///< the window hides its docks also when the workspace is gone
    JobSlots slots_;
    QLabel* text_ = new QLabel;
    QComboBox* shown_ = new QComboBox;
    QComboBox* whose_ = new QComboBox;
    QComboBox* model_ = new QComboBox;
    QLabel* modelNote_ = new QLabel;
    Throttle* soon_;
    LightMapView* map_ = new LightMapView;
    QCheckBox* onDevice_ = new QCheckBox("Colour the &device in the view too");
    std::array<ValueField*, 2> size_{}, throw_{};
    std::array<ValueField*, 3> low_{}, high_{};
    ValueField* shift_ = nullptr;
    QLabel* focusNote_ = new QLabel;
    ValueField *aperture_ = nullptr, *focused_ = nullptr;
    QLineEdit* blur_ = new QLineEdit;
    QPushButton* focusBest_ = new QPushButton("It is focused there now");
    QPushButton* button_ = new QPushButton("Find the best place");
    QLabel* best_ = new QLabel;
    QPushButton* hang_ = new QPushButton("Hang the projector there");

    std::shared_ptr<const Rig> rig_; ///< that was measured, or is being measured
    std::shared_ptr<const Installation> room_;
    std::shared_ptr<const LightFound> found_;
    std::optional<ProjectorPlace> proposed_;
};

RigLight::RigLight(Studio& studio, RigSelection& selection)
    : studio_(studio), selection_(&selection), slots_(*this, studio.jobs, studio.notices),
      soon_(new Throttle(kLightMilliseconds, this)) {
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
    shown_->addItems({"Pixels a millimetre", "Slant of the light", "How often it is lit", "Blur of the light"});
    shown_->setToolTip("In the worst state in which a place is lit");
    whose_->setObjectName("rig.light.whose");
    whose_->setToolTip("Whose light is shown, or what a camera sees: a tracker loses a device that it does not see");
    column.layout->addWidget(text_);
    column.layout->addWidget(makeRow("Ma&p of", shown_));
    column.layout->addWidget(makeRow("&By", whose_));
    column.layout->addWidget(map_, 1);
    onDevice_->setObjectName("rig.light.onDevice");
    connect(onDevice_, &QCheckBox::toggled, this, [this] { colourDevice(); });
    column.layout->addWidget(onDevice_);
    column.layout->addWidget(makeFocus());
    column.layout->addWidget(makeForm());
    column.layout->addWidget(button_);
    best_->setObjectName("rig.light.best");
    best_->setWordWrap(true);
    column.layout->addWidget(best_);
    column.layout->addWidget(hang_);
    button_->setObjectName("rig.light.search");
    button_->setProperty("look", "primary");
    hang_->setObjectName("rig.light.hang");
    connect(shown_, &QComboBox::currentIndexChanged, this, [this](int index) {
        map_->setShown(static_cast<LightMapView::Shown>(index));
        colourDevice();
    });
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
    model_->setObjectName("rig.light.model");
    model_->addItem("Other, by its numbers");
    for (const ProjectorModel& model : projectorModels())
        model_->addItem(QString::fromUtf8(model.name.data(), std::ssize(model.name)));
    modelNote_->setObjectName("rig.light.model.note");
    modelNote_->setWordWrap(true);
    modelNote_->setProperty("look", "muted");
    connect(model_, &QComboBox::activated, this, [this] { chooseModel(); });
    size_ = {addNumber("width", Quantity::plain, 16, 16384, 1920),
             addNumber("height", Quantity::plain, 16, 16384, 1080)};
    throw_ = {addNumber("throwLeast", Quantity::plain, 0.1, 20.0, 1.2),
              addNumber("throwMost", Quantity::plain, 0.1, 20.0, 1.2)};
    shift_ = addNumber("shift", Quantity::share, -2.0, 2.0, 0.0);
    for (ValueField* field : {size_[0], size_[1], throw_[0], throw_[1], shift_})
        connect(field, &ValueField::committed, this, [this] { showModel(); });
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
    layout->addWidget(makeRow("Pro&jector", model_));
    layout->addWidget(makeRow("Pi&xels", makePair(size_[0], size_[1], "\u00D7")));
    layout->addWidget(makeRow("&Throw ratio", makePair(throw_[0], throw_[1])));
    layout->addWidget(makeRow("&Lens shift", shift_));
    layout->addWidget(modelNote_);
    layout->addWidget(makeRow("Left to &right", makePair(low_[0], high_[0])));
    layout->addWidget(makeRow("&Above the table", makePair(low_[1], high_[1])));
    layout->addWidget(makeRow("&Back to front", makePair(low_[2], high_[2])));
    return form;
}

QWidget* RigLight::makeFocus() {
    auto* form = new QWidget;
    auto* layout = new QVBoxLayout(form);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(4);
    layout->addWidget(makeHeading("How sharp is the light?"));
    aperture_ = addNumber("aperture", Quantity::length, 0.0, 0.5, 0.0);
    aperture_->setStep(1e-3);
    aperture_->setToolTip("Width of the lens' opening: its focal length divided by its f-number, 18 mm / 2.4 for "
                          "example; 0 where it is not known\n" +
                          aperture_->toolTip());
    focused_ = addNumber("focused", Quantity::length, 0.05, kFarthest, 2.0);
    focused_->setToolTip("How far before the lens its picture is sharp\n" + focused_->toolTip());
    blur_->setObjectName("rig.light.blur");
    blur_->setPlaceholderText("1.6: 2.1, 1.9: 0.4, 2.3: 2.8");
    blur_->setToolTip("Instead of the aperture: how wide a single pixel's light is on paper, in millimetres, at three "
                      "distances or more from the lens, in metres");
    focusNote_->setObjectName("rig.light.focus.note");
    focusNote_->setWordWrap(true);
    focusBest_->setObjectName("rig.light.focus.best");
    focusBest_->setToolTip("After its ring was turned until a sheet at that distance is sharp");
    connect(aperture_, &ValueField::committed, this, [this](double value) {
        if (hanging()) setLensFocus(tr("Aperture of the projector"), {value, hanging()->focus.focusDistance});
    });
    connect(focused_, &ValueField::committed, this, [this](double value) {
        if (hanging()) setLensFocus(tr("Focus of the projector"), {hanging()->focus.aperture, value});
    });
    connect(blur_, &QLineEdit::returnPressed, this, [this] { measureFocus(); });
    connect(focusBest_, &QPushButton::clicked, this, [this] {
        if (hanging() && found_ && !found_->now.bestFocus.empty())
            setLensFocus(tr("Focus of the projector"), {hanging()->focus.aperture, found_->now.bestFocus.front()});
    });
    layout->addWidget(makeRow("Ape&rture", aperture_));
    layout->addWidget(makeRow("&Focused at", focused_));
    layout->addWidget(makeRow("Meas&ured blur", blur_));
    layout->addWidget(focusNote_);
    layout->addWidget(focusBest_);
    return form;
}

void RigLight::setLensFocus(const QString& what, const LensFocus& focus) {
    editInstallation(studio_.document, what, [&focus](Installation& room) { room.projectors.front().focus = focus; });
}

void RigLight::measureFocus() {
    if (!hanging() || blur_->text().trimmed().isEmpty()) return;
    studio_.notices.dismissAll(kLightPlace);
    try {
        setLensFocus(tr("Measured blur of the projector"), lensFocusOf(blurOf(blur_->text())));
        blur_->clear();
    } catch (const InvalidInput& error) {
        slots_.fail(kLightPlace, error);
    }
}

void RigLight::showFocus() {
    const InstalledProjector* projector = hanging();
    for (QWidget* part : std::initializer_list<QWidget*>{aperture_, focused_, blur_}) part->setEnabled(projector);
    focusNote_->setVisible(projector && found_);
    const bool lights = projector && projector->enabled && found_ && !found_->now.bestFocus.empty() &&
                        found_->now.bestFocus.front() > 0.0;
    focusBest_->setVisible(lights && std::abs(found_->now.bestFocus.front() - projector->focus.focusDistance) > 5e-3);
    if (!projector) return;
    aperture_->setValue(projector->focus.aperture);
    focused_->setValue(projector->focus.focusDistance);
    if (!found_) return;
    const auto& measured = found_->room->projectors;
    const bool isOfNow = !measured.empty() && measured.front().focus == projector->focus;
    focusNote_->setEnabled(isOfNow);
    if (isOfNow) focusNote_->setText(focusText(lights ? found_->now : LightMap{}, projector->focus));
}

void RigLight::chooseModel() {
    const int chosen = model_->currentIndex() - 1;
    if (chosen >= 0) {
        const ProjectorLens lens = lensOf(projectorModels()[static_cast<std::size_t>(chosen)], shift_->value());
        size_[0]->setValue(lens.size.x);
        size_[1]->setValue(lens.size.y);
        throw_[0]->setValue(lens.throwLeast);
        throw_[1]->setValue(lens.throwMost);
        shift_->setValue(lens.shift);
    }
    showModel();
}

void RigLight::showModel() {
    const ProjectorLens now = lens();
    const auto isOf = [&](const ProjectorModel& model) {
        const ProjectorLens its = lensOf(model, now.shift);
        return its.size == now.size && std::abs(its.throwLeast - now.throwLeast) < 5e-4 &&
               std::abs(its.throwMost - now.throwMost) < 5e-4 && std::abs(its.shift - now.shift) < 5e-4;
    };
    const auto models = projectorModels();
    const auto found = std::ranges::find_if(models, isOf);
    model_->setCurrentIndex(found == models.end() ? 0 : static_cast<int>(found - models.begin()) + 1);
    QString note;
    if (found != models.end() && !found->shift)
        note = "How far its picture stands above its lens is not known here: look into its data sheet.";
    else if (found != models.end() && found->shift->least < found->shift->most)
        note = QString("Its lens can be shifted from %1 to %2.")
                   .arg(shareText(found->shift->least), shareText(found->shift->most));
    modelNote_->setText(note);
    modelNote_->setVisible(!note.isEmpty());
}

void RigLight::listSights() {
    QStringList names{"Projectors as they hang now"};
    if (proposed_) names.push_back("A projector at the best place");
    if (found_)
        for (const InstalledCamera& camera : found_->room->cameras)
            names.push_back(kSightOf + QString::fromStdString(camera.name));
    QStringList there;
    for (int k = 0; k < whose_->count(); ++k) there.push_back(whose_->itemText(k));
    if (names == there) return;
    const QString chosen = whose_->currentText();
    const QSignalBlocker quiet(whose_);
    whose_->clear();
    whose_->addItems(names);
    whose_->setCurrentIndex(std::max<int>(0, static_cast<int>(names.indexOf(chosen))));
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
        showModel();
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
                found->room = room;
                auto mesh = std::make_shared<TriangleMesh>(rig->restMesh());
                for (glm::vec3& point : mesh->positions)
                    point = glm::vec3(room->worldFromDevice * glm::vec4(point, 1.0F));
                found->mesh = std::move(mesh);
                std::vector<CalibratedCamera> cameras;
                std::vector<LensFocus> focus;
                for (const InstalledProjector& projector : room->projectors) {
                    if (!projector.enabled) continue;
                    cameras.push_back(projector.camera);
                    focus.push_back(projector.focus);
                }
                found->now = found->device->lightOf(cameras, {}, focus);
                for (const InstalledCamera& camera : room->cameras)
                    found->seen.push_back(found->device->lightOf({&camera.camera, 1}));
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
            listSights();
            whose_->setCurrentIndex(1);
            showAll();
        });
}

const LightMap* RigLight::shownMap() const {
    if (!found_) return nullptr;
    const int chosen = whose_->currentIndex() - (proposed_ ? 1 : 0);
    if (whose_->currentIndex() <= 0) return &found_->now;
    return chosen == 0 ? &proposed_->light : &found_->seen[static_cast<std::size_t>(chosen - 1)];
}

void RigLight::showAll() {
    listSights();
    showFocus();
    const LightMap* map = shownMap();
    const int camera = whose_->currentIndex() - (proposed_ ? 2 : 1);
    text_->setText(!rig_         ? "Open a rig to see how light reaches it."
                   : !found_     ? "How light reaches it is not known yet."
                   : camera >= 0 ? seenText(*map, whose_->currentText().mid(kSightOf.size()))
                                 : lightText(found_->now));
    button_->setEnabled(found_ != nullptr);
    if (map)
        map_->show(std::make_shared<const LightMap>(*map), found_->mesh, {});
    else
        map_->show(nullptr, nullptr, {});
    onDevice_->setEnabled(map != nullptr);
    colourDevice();
    best_->setVisible(proposed_.has_value());
    hang_->setVisible(proposed_.has_value());
    if (!proposed_) return;
    best_->setText(QString("Best place: %1%2, throw ratio %3. %4")
                       .arg(placeText(positionOf(proposed_->camera)), proposed_->turned ? ", on its side" : "")
                       .arg(proposed_->throwRatio, 0, 'f', 2)
                       .arg(lightText(proposed_->light)));
    const bool measured = hanging() && hanging()->pose.isCalibrated();
    hang_->setEnabled(hanging() && !measured);
    hang_->setToolTip(measured ? QString("Where the projector stands was %1; a plan does not take the place of that")
                                     .arg(hanging()->pose.way == Origin::Way::simulated ? "simulated" : "measured")
                               : "The room's first projector gets this lens and place, by one step of undo");
}

void RigLight::colourDevice() {
    const LightMap* map = shownMap();
    if (!map || !isVisible() || !onDevice_->isChecked()) return selection_->showColours(nullptr);
    std::vector<int> bands;
    bands.reserve(found_->device->placeOfTriangle().size());
    for (const int place : found_->device->placeOfTriangle())
        bands.push_back(place < 0 ? -1
                                  : SurfaceBands::bandOf(map_->goodness(map->places[static_cast<std::size_t>(place)])));
    std::vector<glm::vec3> colors;
    colors.reserve(SurfaceBands::kBands);
    for (int b = 0; b < SurfaceBands::kBands; ++b)
        colors.push_back(sceneColor(gradeColor(static_cast<double>(b) / (SurfaceBands::kBands - 1))));
    selection_->showColours(std::make_shared<const RigSelection::Colours>(
        RigSelection::Colours{SurfaceBands(*found_->mesh, bands), std::move(colors)}));
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

QWidget* makeRigLight(Studio& studio, RigSelection& selection) { return new RigLight(studio, selection); }

} // namespace lumorph::studio
