#pragma once

#include <QWidget>

#include "app/studio/widgets/range_slider.h"
#include "app/studio/widgets/value_field.h"

namespace lumorph::studio {

/// "label [from] ==o====o== [to]": a range of whole numbers by two fields and a slider between them. The fields are
/// called `id`.from and `id`.to, the slider `id`.slider.
class RangeRow : public QWidget {
    Q_OBJECT
public:
    /// `name` is what a screen reader says, such as "Slice across".
    RangeRow(const QString& id, const QString& label, const QString& name, QWidget* parent = nullptr);

    /// New limits; a range that was the whole stays the whole.
    void setLimits(int lowest, int highest);
    /// Shows it without a signal.
    void setRange(int from, int to);

signals:
    void changed(int from, int to);

private:
    void showValues();

    ValueField* from_;
    RangeSlider* slider_;
    ValueField* to_;
};

} // namespace lumorph::studio
