#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QSpinBox>
#include <QWidget>

#include "app/applications/labyrinth/level.h"

namespace lumorph::studio {

/// What a level says of itself beside its map: name, idea, size, time, materials.
class LevelForm : public QWidget {
    Q_OBJECT
public:
    explicit LevelForm(QWidget* parent = nullptr);
    void show(const labyrinth::Level& level);
    /// The level with what is filled in here; its map as it was.
    [[nodiscard]] labyrinth::Level filled(labyrinth::Level level) const;

signals:
    void edited(const QString& step);
    void resized(int columns, int rows);

private:
    QLineEdit *name_ = new QLineEdit, *idea_ = new QLineEdit;
    QSpinBox *columns_ = new QSpinBox, *rows_ = new QSpinBox, *time_ = new QSpinBox;
    QDoubleSpinBox *cell_ = new QDoubleSpinBox, *step_ = new QDoubleSpinBox, *wall_ = new QDoubleSpinBox;
    QComboBox *floorMaterial_ = new QComboBox, *wallMaterial_ = new QComboBox;
};

} // namespace lumorph::studio
