#pragma once

#include <string>
#include <vector>

#include <QWidget>

#include "app/studio/calibration/calibration_state.h"

namespace lumorph::studio {

/// A bar for each pose and device: how far its points lie beside the solution. A click, or the arrow keys, choose one.
class PoseBars : public QWidget {
    Q_OBJECT
public:
    explicit PoseBars(QWidget* parent = nullptr);
    void show(const ProcamCalibration& solved, const std::string& chosen);
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override { return sizeHint(); }
    /// Upper edge of the first pose's row, below the legend, which takes as many lines as the width asks for.
    [[nodiscard]] int rowsTop() const;

signals:
    void chosen(const QString& pose);

protected:
    void paintEvent(QPaintEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    std::vector<ViewQuality> views_;
    std::string worst_, chosen_;
};

/// Residuals over the image of one device: each as an arrow, enlarged so that the longest can be seen.
class ResidualField : public QWidget {
    Q_OBJECT
public:
    explicit ResidualField(QWidget* parent = nullptr);
    /// `pose`: is drawn in front of the others; empty: all alike.
    void show(std::vector<std::pair<std::string, std::vector<Residual>>> residuals, QSize image,
              const std::string& pose);
    [[nodiscard]] QSize sizeHint() const override { return {260, 190}; }

protected:
    void paintEvent(QPaintEvent* event) override;

private:
    std::vector<std::pair<std::string, std::vector<Residual>>> residuals_;
    QSize image_;
    std::string pose_;
};

} // namespace lumorph::studio
