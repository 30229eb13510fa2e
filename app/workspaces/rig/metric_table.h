#pragma once

#include <optional>
#include <vector>

#include <QGridLayout>
#include <QLabel>
#include <QWidget>

#include "core/rig/shape_resolution.h"

namespace lumorph::studio {

/// The ten features of shape resolution: of the device alone, of light alone, and of both; below each, in muted words,
/// those of a device to compare with.
class MetricTable : public QWidget {
public:
    explicit MetricTable(QWidget* parent = nullptr);

    void setDevice(const ShapeResolution& resolution);
    /// Null: nothing to compare with.
    void setReference(const ShapeResolution* resolution, const QString& name = {});
    void setStale(bool stale);

private:
    struct Row {
        QLabel* name;
        QLabel* values[3];
        QLabel* reference; ///< whose the values below are
        QLabel* compared[3];
    };
    void makeRows(const ShapeResolution& resolution);
    QLabel* add(int row, int column, const QString& objectName, bool muted);

    QGridLayout* grid_;
    std::vector<Row> rows_;
    std::vector<QLabel*> headings_;
};

} // namespace lumorph::studio
