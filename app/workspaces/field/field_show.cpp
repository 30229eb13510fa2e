#include "app/workspaces/field/field_show.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <QButtonGroup>
#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QPushButton>
#include <QSlider>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "app/studio/widgets/range_row.h"
#include "app/studio/widgets/value_field.h"
#include "app/workspaces/field/level_legend.h"

namespace lumorph::studio {
namespace {

using Show = FieldDisplay::Show;

/// The controls of what is shown. They write whole values to the display and are filled from it, so that a change from
/// anywhere else shows here too.
class FieldShow : public QWidget {
public:
    FieldShow(Studio& studio, FieldDisplayModel& display);

private:
    void addKinds(QVBoxLayout& layout);
    void addActuator(QVBoxLayout& layout);
    void addVoxels(QVBoxLayout& layout);
    void addSurface(QVBoxLayout& layout);
    void takeField();
    void fill();
    template <class Edit> void edit(Edit&& change) {
        FieldDisplay value = display_.value();
        change(value);
        display_.set(value);
    }
    [[nodiscard]] const Field* field() const {
        const auto& held = studio_.document.state().field.field;
        return held ? &held->field : nullptr;
    }

    Studio& studio_;
    FieldDisplayModel& display_;
    std::weak_ptr<const MatchField> shown_;
    QButtonGroup kinds_;
    QWidget* actuatorRow_ = nullptr;
    QComboBox* actuator_ = nullptr;
    QWidget* voxels_ = nullptr;
    RangeRow* levels_ = nullptr;
    std::array<RangeRow*, 3> slices_{};
    QCheckBox* touched_ = nullptr;
    LevelLegend* legend_ = nullptr;
    QWidget* surface_ = nullptr;
    QSlider* surfaceSlider_ = nullptr;
    ValueField* surfaceLevel_ = nullptr;
};

QVBoxLayout* plainColumn(QWidget* widget) {
    auto* layout = new QVBoxLayout(widget);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(8);
    return layout;
}

FieldShow::FieldShow(Studio& studio, FieldDisplayModel& display) : studio_(studio), display_(display) {
    auto* layout = plainColumn(this);
    addKinds(*layout);
    addActuator(*layout);
    addVoxels(*layout);
    addSurface(*layout);
    connect(&display_, &FieldDisplayModel::changed, this, [this] { fill(); });
    connect(&studio_.document, &StudioDocument::changed, this, [this](StateParts parts) {
        if (parts & (StateParts(StatePart::field) | StatePart::target)) takeField();
    });
    takeField();
}

void FieldShow::addKinds(QVBoxLayout& layout) {
    struct Kind {
        Show show;
        const char* id;
        QString text, hint;
    };
    const std::array kinds{
        Kind{Show::nothing, "field.show.nothing", tr("&Nothing"), tr("Only the device and the target")},
        Kind{Show::voxels, "field.show.voxels", tr("&Voxels"), tr("Every voxel in the colour of its level")},
        Kind{Show::surface, "field.show.surface", tr("Le&vel surface"),
             tr("What is expected to be filled at one level")}};
    auto* row = new QHBoxLayout;
    row->setSpacing(4);
    for (const Kind& kind : kinds) {
        auto* button = new QPushButton(kind.text);
        button->setObjectName(kind.id);
        button->setToolTip(kind.hint);
        button->setCheckable(true);
        kinds_.addButton(button, static_cast<int>(kind.show));
        row->addWidget(button, 1);
    }
    layout.addLayout(row);
    connect(&kinds_, &QButtonGroup::idClicked, this,
            [this](int id) { edit([id](FieldDisplay& value) { value.show = static_cast<Show>(id); }); });
}

void FieldShow::addActuator(QVBoxLayout& layout) {
    actuator_ = new QComboBox;
    actuator_->setObjectName("field.actuator");
    actuator_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    actuator_->setMinimumContentsLength(12);
    actuatorRow_ = makeRow(tr("&Actuator"), actuator_);
    layout.addWidget(actuatorRow_);
    connect(actuator_, &QComboBox::activated, this, [this](int index) {
        edit([index](FieldDisplay& value) { value.actuator = index == 0 ? std::nullopt : std::optional(index - 1); });
    });
}

void FieldShow::addVoxels(QVBoxLayout& layout) {
    voxels_ = new QWidget;
    auto* column = plainColumn(voxels_);
    legend_ = new LevelLegend;
    legend_->setObjectName("field.legend");
    levels_ = new RangeRow("field.levels", tr("Levels"), tr("Levels"));
    column->addWidget(legend_);
    column->addWidget(levels_);
    connect(levels_, &RangeRow::changed, this, [this](int from, int to) {
        edit([&](FieldDisplay& value) {
            value.lowestLevel = from;
            value.highestLevel = to;
        });
    });
    const std::array names{tr("Left to right"), tr("Bottom to top"), tr("Back to front")};
    const std::array labels{tr("Slice x"), tr("Slice y"), tr("Slice z")};
    for (std::size_t axis = 0; axis < slices_.size(); ++axis) {
        const QString id = QStringLiteral("field.slice.") + QChar::fromLatin1("xyz"[axis]);
        slices_[axis] = new RangeRow(id, labels[axis], names[axis]);
        slices_[axis]->setToolTip(names[axis]);
        column->addWidget(slices_[axis]);
        connect(slices_[axis], &RangeRow::changed, this, [this, k = static_cast<int>(axis)](int from, int to) {
            edit([&](FieldDisplay& value) {
                value.sliceFrom[k] = from;
                value.sliceTo[k] = to;
            });
        });
    }
    touched_ = new QCheckBox(tr("Only what the &target touches"));
    touched_->setObjectName("field.touched");
    column->addWidget(touched_);
    connect(touched_, &QCheckBox::clicked, this,
            [this](bool on) { edit([on](FieldDisplay& value) { value.touchedOnly = on; }); });
    layout.addWidget(voxels_);
}

void FieldShow::addSurface(QVBoxLayout& layout) {
    surfaceSlider_ = new QSlider(Qt::Horizontal);
    surfaceSlider_->setObjectName("field.surface.slider");
    surfaceSlider_->setAccessibleName(tr("Level of the surface"));
    surfaceLevel_ = new ValueField(Quantity::level, 0, 1, 0);
    surfaceLevel_->setObjectName("field.surface.level");
    surfaceLevel_->setAccessibleName(tr("Level of the surface"));
    surfaceLevel_->setFixedWidth(56);
    surfaceLevel_->setStep(1.0);
    auto* both = new QWidget;
    auto* row = new QHBoxLayout(both);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(8);
    row->addWidget(surfaceSlider_, 1);
    row->addWidget(surfaceLevel_);
    both->setFocusProxy(surfaceSlider_);
    surface_ = makeRow(tr("&Level"), both);
    layout.addWidget(surface_);
    const auto take = [this](double level) {
        edit([level](FieldDisplay& value) { value.surfaceLevel = static_cast<int>(std::lround(level)); });
    };
    connect(surfaceSlider_, &QSlider::valueChanged, this, take);
    connect(surfaceLevel_, &ValueField::committed, this, take);
    connect(surfaceLevel_, &ValueField::previewed, this, take);
}

/// Fits limits and names to the field that is open now; another field is shown whole.
void FieldShow::takeField() {
    const auto held = studio_.document.state().field.field;
    if (held && held != shown_.lock()) {
        const auto before = shown_.lock();
        shown_ = held;
        const Field& now = held->field;
        {
            const QSignalBlocker quiet(actuator_);
            actuator_->clear();
            actuator_->addItem(tr("All combined"));
            for (const ActuatorField& one : now.actuators) actuator_->addItem(QString::fromStdString(one.name));
        }
        edit([&](FieldDisplay& value) {
            if (value.actuator && *value.actuator >= static_cast<int>(now.actuators.size())) value.actuator.reset();
            if (!before || before->field.levels != now.levels) value.surfaceLevel = now.levels / 2;
            value.lowestLevel = 0;
            value.highestLevel = 255;
            value.sliceFrom = glm::ivec3(0);
            value.sliceTo = glm::ivec3(0x7FFF);
            value.voxel.reset();
        });
    }
    fill();
}

void FieldShow::fill() {
    const Field* now = field();
    if (now == nullptr) return;
    const FieldDisplay& value = display_.value();
    if (QAbstractButton* button = kinds_.button(static_cast<int>(value.show))) button->setChecked(true);
    actuatorRow_->setVisible(value.show != Show::nothing);
    voxels_->setVisible(value.show == Show::voxels);
    surface_->setVisible(value.show == Show::surface);
    actuator_->setCurrentIndex(value.actuator ? *value.actuator + 1 : 0);
    const int highest = now->levels - 1;
    legend_->setLevels(0, highest);
    levels_->setLimits(0, highest);
    levels_->setRange(value.lowestLevel, value.highestLevel);
    for (std::size_t axis = 0; axis < slices_.size(); ++axis) {
        const auto k = static_cast<int>(axis);
        slices_[axis]->setLimits(0, now->frame.dimensions[k] - 1);
        slices_[axis]->setRange(value.sliceFrom[k], value.sliceTo[k]);
    }
    touched_->setChecked(value.touchedOnly);
    touched_->setEnabled(studio_.document.state().target.target != nullptr);
    const QSignalBlocker quiet(surfaceSlider_);
    surfaceSlider_->setRange(0, highest);
    surfaceSlider_->setValue(value.surfaceLevel);
    surfaceLevel_->setRange(0, highest);
    surfaceLevel_->setValue(std::clamp(value.surfaceLevel, 0, highest));
}

} // namespace

QWidget* makeFieldShow(Studio& studio, FieldDisplayModel& display) { return new FieldShow(studio, display); }

} // namespace lumorph::studio
