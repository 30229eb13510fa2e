#pragma once

#include <QWidget>

namespace lumorph::studio {

/// The colours of field voxels: light green for what is filled at a low level, darker green for a high one, with the
/// levels at the ends.
class LevelLegend : public QWidget {
    Q_OBJECT
public:
    explicit LevelLegend(QWidget* parent = nullptr);
    void setLevels(int lowest, int highest);
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    int lowest_ = 0, highest_ = 32;
};

} // namespace lumorph::studio
