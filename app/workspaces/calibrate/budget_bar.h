#pragma once

#include <cstddef>
#include <vector>

#include <QString>
#include <QWidget>

namespace lumorph::studio {

/// One part of a stacked bar.
struct BudgetSlice {
    QString name, words; ///< what it is, and how it is known
    double millimetres = 0.0;
    double share = 0.0;      ///< of the whole bar, in [0, 1]
    bool isMeasured = false; ///< in the room
};

/// A bar of parts, each as wide as its share, and under it a row for each: colour, name, millimetres, how it is known.
/// What was not measured is hatched.
class BudgetBar : public QWidget {
    Q_OBJECT
public:
    explicit BudgetBar(QWidget* parent = nullptr);
    void show(std::vector<BudgetSlice> slices);
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;
    [[nodiscard]] int heightForWidth(int width) const override;

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    [[nodiscard]] int rowHeight(int width) const;
    void paintRow(QPainter& painter, std::size_t row) const;

    std::vector<BudgetSlice> slices_;
};

} // namespace lumorph::studio
