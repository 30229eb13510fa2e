#include "app/workspaces/rig/metric_table.h"

#include <algorithm>
#include <array>

#include "app/workspaces/rig/rig_facts.h"

namespace lumorph::studio {
namespace {

constexpr std::array kColumns = {"physical", "light", "together"};
constexpr std::array kHeadings = {"Physical", "With light", "Together"};

QString valueText(const ShapeMetric& metric, std::size_t column) {
    const std::array values = {metric.physical, metric.withLight, metric.together};
    QString shown = QString::fromStdString(inUsualUnit(values[column], metric.unit));
    return shown == "-" ? QString("–") : shown.replace("cm2", "cm²");
}

} // namespace

MetricTable::MetricTable(QWidget* parent) : QWidget(parent), grid_(new QGridLayout(this)) {
    grid_->setContentsMargins(0, 0, 0, 0);
    grid_->setHorizontalSpacing(8);
    grid_->setVerticalSpacing(2);
    for (int c = 0; c < 4; ++c) grid_->setColumnStretch(c, c == 0 ? 4 : 3);
    for (int c = 0; c < 3; ++c) {
        QLabel* heading = add(0, c + 1, {}, true);
        heading->setText(kHeadings.at(static_cast<std::size_t>(c)));
        headings_.push_back(heading);
    }
}

QLabel* MetricTable::add(int row, int column, const QString& objectName, bool muted) {
    auto* label = new QLabel(this);
    label->setObjectName(objectName);
    if (muted) label->setProperty("look", "muted");
    if (column > 0) label->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    grid_->addWidget(label, row, column);
    return label;
}

void MetricTable::makeRows(const ShapeResolution& resolution) {
    if (!rows_.empty()) return;
    for (int at = 1; const ShapeMetric& metric : resolution.metrics) {
        const QString name = "rig.metric." + shownText(metric.key);
        Row row{add(at, 0, {}, false), {}, add(at + 1, 0, {}, true), {}};
        row.name->setText(shownText(metric.name));
        const QString meaning =
            QString("<p>%1</p><p><b>Light:</b> %2</p>")
                .arg(shownText(metric.meaning).toHtmlEscaped(), shownText(metric.light).toHtmlEscaped());
        row.name->setToolTip(meaning);
        for (int c = 0; c < 3; ++c) {
            row.values[c] = add(at, c + 1, name + '.' + kColumns.at(static_cast<std::size_t>(c)), false);
            row.values[c]->setToolTip(meaning);
            row.compared[c] = add(at + 1, c + 1, name + ".compared." + kColumns.at(static_cast<std::size_t>(c)), true);
        }
        rows_.push_back(row);
        at += 2;
    }
    setReference(nullptr);
}

void MetricTable::setDevice(const ShapeResolution& resolution) {
    makeRows(resolution);
    for (std::size_t m = 0; m < rows_.size(); ++m)
        for (std::size_t c = 0; c < 3; ++c) rows_[m].values[c]->setText(valueText(resolution.metrics[m], c));
}

void MetricTable::setReference(const ShapeResolution* resolution, const QString& name) {
    for (std::size_t m = 0; m < rows_.size(); ++m) {
        rows_[m].reference->setVisible(resolution != nullptr);
        if (resolution) rows_[m].reference->setText("  " + name);
        for (std::size_t c = 0; c < 3; ++c) {
            rows_[m].compared[c]->setVisible(resolution != nullptr);
            if (resolution) rows_[m].compared[c]->setText(valueText(resolution->metrics[m], c));
        }
    }
}

void MetricTable::setStale(bool stale) {
    for (const Row& row : rows_)
        for (QLabel* value : row.values) value->setEnabled(!stale);
}

} // namespace lumorph::studio
