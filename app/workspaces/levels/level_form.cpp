#include "app/workspaces/levels/level_form.h"

#include <cmath>

#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/studio/widgets/panel.h"
#include "core/scene/material_library.h"

namespace lumorph::studio {
namespace {

constexpr int kMostLetters = 100; ///< of a line: of two bytes each at most 200

void setUp(QDoubleSpinBox& box, const char* name, double least, double most, double step) {
    box.setObjectName(name);
    box.setRange(least, most);
    box.setSingleStep(step);
    box.setDecimals(1);
    box.setSuffix(" mm");
    box.setKeyboardTracking(false);
}

void setUp(QSpinBox& box, const char* name, int least, int most, const QString& suffix = {}) {
    box.setObjectName(name);
    box.setRange(least, most);
    box.setSuffix(suffix);
    box.setKeyboardTracking(false);
}

/// The number of the level itself where the field shows just that, since it is rounded.
double metresOf(const QDoubleSpinBox& box, double before) {
    constexpr double kShown = 0.5e-4; // metres: half of the last digit
    const double metres = 1e-3 * box.value();
    return std::abs(metres - before) <= kShown ? before : metres;
}

} // namespace

LevelForm::LevelForm(QWidget* parent) : QWidget(parent) {
    name_->setObjectName("levels.name");
    idea_->setObjectName("levels.idea");
    idea_->setPlaceholderText(tr("What is new in it"));
    for (QLineEdit* line : {name_, idea_}) line->setMaxLength(kMostLetters);
    setUp(*columns_, "levels.columns", labyrinth::kMinCells, labyrinth::kMaxCells);
    setUp(*rows_, "levels.rows", labyrinth::kMinCells, labyrinth::kMaxCells);
    setUp(*time_, "levels.time", 1, 3600, " s");
    time_->setToolTip(tr("Who is faster scores"));
    setUp(*cell_, "levels.cell", 9.0, 40.0, 0.5);
    setUp(*step_, "levels.step", 0.5, 5.0, 0.1);
    setUp(*wall_, "levels.wall", 4.0, 20.0, 0.5);
    cell_->setToolTip(tr("Side of a cell; 21 x 15 cells of 10 mm are as large as the tablet"));
    step_->setToolTip(tr("One unit of height"));
    wall_->setToolTip(tr("How far walls stand over the highest floor beside them"));
    floorMaterial_->setObjectName("levels.floor");
    wallMaterial_->setObjectName("levels.walls");
    for (const Material& material : readyMaterials())
        for (QComboBox* box : {floorMaterial_, wallMaterial_}) box->addItem(QString::fromStdString(material.name));

    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(6);
    column->addWidget(makeRow(tr("&Name"), name_));
    column->addWidget(makeRow(tr("I&dea"), idea_));
    column->addWidget(makeRow(tr("&Time"), time_));
    column->addWidget(makeHeading(tr("Board")));
    column->addWidget(makeRow(tr("&Columns"), columns_));
    column->addWidget(makeRow(tr("&Rows"), rows_));
    column->addWidget(makeRow(tr("C&ell"), cell_));
    column->addWidget(makeRow(tr("&Height step"), step_));
    column->addWidget(makeRow(tr("&Walls' height"), wall_));
    column->addWidget(makeHeading(tr("Materials")));
    column->addWidget(makeRow(tr("&Floor"), floorMaterial_));
    column->addWidget(makeRow(tr("W&alls"), wallMaterial_));

    connect(name_, &QLineEdit::editingFinished, this, [this] { emit edited(tr("Change the name")); });
    connect(idea_, &QLineEdit::editingFinished, this, [this] { emit edited(tr("Change the idea")); });
    connect(time_, &QSpinBox::valueChanged, this, [this] { emit edited(tr("Change the time")); });
    for (const QDoubleSpinBox* box : {cell_, step_, wall_})
        connect(box, &QDoubleSpinBox::valueChanged, this, [this] { emit edited(tr("Change a measure")); });
    for (const QComboBox* box : {floorMaterial_, wallMaterial_})
        connect(box, &QComboBox::activated, this, [this] { emit edited(tr("Change a material")); });
    for (const QSpinBox* box : {columns_, rows_})
        connect(box, &QSpinBox::valueChanged, this, [this] { emit resized(columns_->value(), rows_->value()); });
}

void LevelForm::show(const labyrinth::Level& level) {
    const QSignalBlocker still[] = {QSignalBlocker(time_), QSignalBlocker(columns_), QSignalBlocker(rows_),
                                    QSignalBlocker(cell_), QSignalBlocker(step_),    QSignalBlocker(wall_)};
    const auto text = [](QLineEdit& line, const std::string& value) { // whoever types keeps his place
        if (line.text() != QString::fromStdString(value)) line.setText(QString::fromStdString(value));
        if (!line.hasFocus()) line.setCursorPosition(0); // what is long is read from its beginning
    };
    text(*name_, level.name);
    text(*idea_, level.idea);
    time_->setValue(static_cast<int>(std::lround(level.seconds)));
    columns_->setValue(level.columns);
    rows_->setValue(level.rows);
    cell_->setValue(1e3 * level.cell);
    step_->setValue(1e3 * level.step);
    wall_->setValue(1e3 * level.wall);
    floorMaterial_->setCurrentText(QString::fromStdString(level.floorMaterial));
    wallMaterial_->setCurrentText(QString::fromStdString(level.wallMaterial));
}

labyrinth::Level LevelForm::filled(labyrinth::Level level) const {
    level.name = name_->text().simplified().toStdString();
    level.idea = idea_->text().simplified().toStdString();
    if (std::lround(level.seconds) != time_->value()) level.seconds = time_->value();
    level.cell = metresOf(*cell_, level.cell);
    level.step = metresOf(*step_, level.step);
    level.wall = metresOf(*wall_, level.wall);
    level.floorMaterial = floorMaterial_->currentText().toStdString();
    level.wallMaterial = wallMaterial_->currentText().toStdString();
    return level;
}

} // namespace lumorph::studio
