#include "app/workspaces/devices/simulated_panel.h"

#include <cmath>
#include <utility>

#include <QGridLayout>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "app/studio/widgets/dock_parts.h"

namespace lumorph::studio {
namespace {

struct Words {
    const char* part;
    const char* text;
    const char* tip;
    double SimulatedOrders::*order;
    int least, most; ///< steps of the slider
    double scale, shown;
    const char* unit;
};

constexpr Words kWords[] = {
    {"noise", "&Noise", "Standard deviation of each position, along each axis", &SimulatedOrders::noiseMillimetres, 0,
     100, 0.5, 1.0, "mm"},
    {"drop", "&Dropout", "Share of the frames that never arrive", &SimulatedOrders::dropShare, 0, 100, 0.01, 100.0,
     "%"},
    {"latency", "&Latency", "How long a frame is on its way", &SimulatedOrders::latencyMilliseconds, 0, 100, 5.0, 1.0,
     "ms"},
    {"rate", "&Rate", "Frames a second", &SimulatedOrders::rateHertz, 1, 240, 1.0, 1.0, "Hz"},
};

} // namespace

SimulatedPanel::SimulatedPanel(std::shared_ptr<SimulatedSteering> steering, const QString& name, QWidget* parent)
    : QWidget(parent), steering_(std::move(steering)) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 4, 0, 4);
    column->setSpacing(8);
    setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
    auto* grid = new QGridLayout;
    column->addLayout(grid);
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(4);
    grid->setColumnStretch(1, 1);
    for (const Words& words : kWords) {
        auto* slider = new QSlider(Qt::Horizontal);
        slider->setObjectName(name + '.' + words.part);
        slider->setRange(words.least, words.most);
        slider->setToolTip(words.tip);
        auto* label = new QLabel(words.text);
        label->setBuddy(slider);
        slider->setAccessibleName(QString(words.text).remove('&'));
        QLabel* value = makeNumber(name + '.' + words.part + ".value", "100.0 mm", this);
        const int row = grid->rowCount();
        grid->addWidget(label, row, 0);
        grid->addWidget(slider, row, 1);
        grid->addWidget(value, row, 2);
        rows_.push_back({words.order, words.scale, words.shown, words.unit, slider, value});
        connect(slider, &QSlider::valueChanged, this, [this, &words](int steps) {
            change([&](SimulatedOrders& orders) { orders.*words.order = words.scale * steps; });
        });
    }
    const auto button = [&](const char* part, const char* text, const char* tip, auto run) {
        auto* made = new QPushButton(text);
        made->setObjectName(name + '.' + part);
        made->setToolTip(tip);
        connect(made, &QPushButton::clicked, this, [this, run] { change(run); });
        return made;
    };
    auto* faults = new QGridLayout;
    faults->setSpacing(6);
    faults->addWidget(button("teleport", "Teleport", "For ten frames it is said to be 3 m away",
                             [](SimulatedOrders& orders) { ++orders.jumps; }),
                      0, 0);
    faults->addWidget(button("nan", "Send NaN", "For ten frames its position is no number",
                             [](SimulatedOrders& orders) { ++orders.notNumbers; }),
                      0, 1);
    hidden_ = new QCheckBox("Hidden");
    hidden_->setObjectName(name + ".hidden");
    hidden_->setToolTip("Frames come, and the body is not in them: as if somebody stood in the way");
    connect(hidden_, &QCheckBox::toggled, this,
            [this](bool hidden) { change([hidden](SimulatedOrders& orders) { orders.hidden = hidden; }); });
    faults->addWidget(hidden_, 1, 0);
    release_ = button("release", "Move by itself", "Lets go of the body: it goes its own way again",
                      [](SimulatedOrders& orders) { orders.held.reset(); });
    faults->addWidget(release_, 1, 1);
    column->addLayout(faults);
    refresh();
}

void SimulatedPanel::change(const std::function<void(SimulatedOrders&)>& edit) {
    SimulatedOrders orders = steering_->orders();
    edit(orders);
    steering_->order(orders);
    refresh();
}

void SimulatedPanel::refresh() {
    const SimulatedOrders orders = steering_->orders();
    for (const Row& row : rows_) {
        const double value = orders.*row.order;
        const QSignalBlocker quiet(row.slider);
        // What an address orders more finely stays as it is until the slider is moved.
        if (!row.slider->isSliderDown()) row.slider->setValue(static_cast<int>(std::lround(value / row.scale)));
        row.value->setText(QString::number(row.shown * value, 'f', row.scale < 1.0 && row.shown == 1.0 ? 1 : 0) + ' ' +
                           row.unit);
    }
    const QSignalBlocker quiet(hidden_);
    hidden_->setChecked(orders.hidden);
    release_->setEnabled(orders.held.has_value());
}

} // namespace lumorph::studio
