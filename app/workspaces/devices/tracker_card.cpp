#include "app/workspaces/devices/tracker_card.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <QPushButton>

#include "app/studio/look/palette.h"
#include "app/studio/widgets/dock_parts.h"
#include "app/studio/widgets/plot_axes.h"
#include "app/workspaces/devices/device_words.h"

namespace lumorph::studio {
namespace {

constexpr std::size_t kMostRows = 12;
constexpr int kPlotHeight = 104;
constexpr std::optional<PoseRole> kRoles[] = {std::nullopt, PoseRole::head, PoseRole::device, PoseRole::pointer};
constexpr const char* kRoleTexts[] = {"Nobody", "Head", "Device", "Pointer"};

int indexOf(std::optional<PoseRole> role) { return static_cast<int>(std::ranges::find(kRoles, role) - kRoles); }

QString asText(const std::string& words) { return QString::fromStdString(words); }

/// A long address may break after its marks, so that it does not make the dock wide.
QString breakable(QString text) {
    constexpr QChar kMayBreak(0x200B);
    for (const char* mark : {"/", "?", "&", ",", "="}) text.replace(mark, mark + QString(kMayBreak));
    return text;
}

QString headlineOf(const TrackerStatus& status) {
    QString source = asText(status.source);
    if (source.isEmpty()) return "Nobody is heard yet";
    source[0] = source[0].toUpper();
    return source;
}

QString placeText(const Pose& pose) {
    const auto centimetres = [](double metres) { return QString::number(100.0 * metres, 'f', 1); };
    return QString("x %1   y %2   z %3 cm")
        .arg(centimetres(pose.position.x), centimetres(pose.position.y), centimetres(pose.position.z));
}

/// Ten seconds of something; `least`: the highest value that the axis shows at any rate.
void showHistory(Plot& plot, const QString& name, double least, const std::deque<double>& values,
                 const QString& unknown) {
    const bool known = std::ranges::any_of(values, [](double value) { return std::isfinite(value); });
    plot.setEmptyText(known || unknown.isEmpty() ? QString("The last ten seconds come here.") : unknown);
    if (!known) return plot.setCurves({});
    double most = least;
    for (const double value : values)
        if (std::isfinite(value)) most = std::max(most, value);
    plot.setRange(0.0, niceTick(1.02 * most, 1)); // so that the axis is labelled at its end
    plot.setCurves({{name, currentPalette().accent, std::vector<double>(values.begin(), values.end())}});
}

QString perSecond(double rate) { return QString::number(rate, 'f', 1) + " /s"; }

} // namespace

TrackerCard::TrackerCard(TrackerService& service, const QString& address, const QString& name, QWidget* parent)
    : QFrame(parent), service_(service), address_(address), name_(name), layout_(new QVBoxLayout(this)) {
    setProperty("look", "card");
    setObjectName(name);
    layout_->setContentsMargins(12, 8, 12, 12);
    layout_->setSpacing(6);
    addHead();
    unproven_ = addText("unproven", "muted");
    unproven_->setText("Never tried with real software: check a few positions before you trust it.");
    advice_ = addText("advice", "warning");
    addFacts();
    sourceRow_ = layout_->count();
    reason_ = addText("reason", "muted");
    event_ = addText("event", "muted");
    bodies_ = new QVBoxLayout;
    bodies_->setContentsMargins(0, 4, 0, 0);
    bodies_->setSpacing(6);
    layout_->addLayout(bodies_);
    more_ = addText("more", "muted");
    rate_ = addPlot("rates", "Frames a second in the last ten seconds", "frames/s");
    delay_ = addPlot("delays", "Latency in the last ten seconds", "ms");
}

Plot* TrackerCard::addPlot(const QString& part, const QString& what, const QString& unit) {
    auto* plot = new Plot;
    plot->setObjectName(name_ + '.' + part);
    plot->setAccessibleName(what);
    plot->setFixedHeight(kPlotHeight);
    plot->setAxes("Tenths of a second", unit);
    layout_->addWidget(plot);
    return plot;
}

QLabel* TrackerCard::addText(const QString& part, const char* look) {
    auto* label = new QLabel;
    label->setObjectName(name_ + '.' + part);
    label->setProperty("look", look);
    label->setTextFormat(Qt::PlainText); // what a network says is no markup
    label->setWordWrap(true);
    layout_->addWidget(label);
    return label;
}

void TrackerCard::addHead() {
    source_ = addText("source", "heading");
    auto* where = addText("address", "muted");
    where->setText(breakable(address_));
    layout_->removeWidget(where);
    auto* close = new QPushButton("Close");
    close->setObjectName(name_ + ".close");
    close->setToolTip("Ends this tracker. Without one, the show goes back to the scene's own eye.");
    connect(close, &QPushButton::clicked, this, [this, close] {
        close->setEnabled(false);
        service_.close(address_);
    });
    auto* row = new QHBoxLayout;
    row->setSpacing(8);
    row->addWidget(where, 1);
    row->addWidget(close);
    layout_->addLayout(row);
}

QLabel* TrackerCard::addFact(QGridLayout& grid, int row, int column, const QString& label, const QString& part,
                             const QString& tip) {
    auto* title = new QLabel(label);
    title->setProperty("look", "muted");
    QLabel* value = makeNumber(name_ + '.' + part, "1000.0 /s", this);
    for (QLabel* one : {title, value}) one->setToolTip(tip);
    value->setAccessibleName(label);
    grid.addWidget(title, row, 2 * column);
    grid.addWidget(value, row, 2 * column + 1, Qt::AlignRight);
    return value;
}

void TrackerCard::addFacts() {
    auto* grid = new QGridLayout;
    grid->setHorizontalSpacing(8);
    grid->setVerticalSpacing(2);
    grid->setColumnStretch(0, 1);
    grid->setColumnStretch(2, 1);
    frames_ = addFact(*grid, 0, 0, "Frames", "frames", "Pictures of the whole room that were understood, each second");
    packets_ = addFact(*grid, 0, 1, "Packets", "packets", "All that arrived at the port, each second");
    latency_ = addFact(*grid, 1, 0, "Latency", "latency",
                       "From the cameras to here. Known where the tracker tells when its cameras looked.");
    rejected_ = addFact(*grid, 1, 1, "Rejected", "rejected", "Packets that were wrong, since it was opened");
    layout_->addLayout(grid);
}

void TrackerCard::addBodyRow() {
    const QString name = QString("%1.body.%2").arg(name_).arg(rows_.size());
    BodyRow row;
    row.widget = new QWidget;
    auto* grid = new QGridLayout(row.widget);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setVerticalSpacing(0);
    grid->setColumnStretch(0, 1);
    row.name = new QLabel;
    row.name->setObjectName(name + ".name");
    row.name->setTextFormat(Qt::PlainText);
    row.place = makeNumber(name + ".place", "x -100.0   y -100.0   z -100.0 cm", this);
    row.place->setAlignment(Qt::AlignLeft);
    row.place->setProperty("look", "muted");
    row.role = new QComboBox;
    row.role->setObjectName(name + ".role");
    row.role->setAccessibleName("Role");
    row.role->setToolTip("Who this is in the show. A head is what the pictures are drawn for; the device is where the "
                         "scene stands. Remembered by the body's name.");
    for (const char* text : kRoleTexts) row.role->addItem(text);
    const std::size_t index = rows_.size();
    connect(row.role, &QComboBox::activated, this,
            [this, index](int chosen) { service_.setRole(shown_.at(index), kRoles[chosen]); });
    grid->addWidget(row.name, 0, 0);
    grid->addWidget(row.role, 0, 1);
    grid->addWidget(row.place, 1, 0, 1, 2);
    bodies_->addWidget(row.widget);
    rows_.push_back(row);
}

void TrackerCard::show(const OpenTracker& tracker) {
    const TrackerStatus& status = tracker.status;
    source_->setText(breakable(headlineOf(status)));
    unproven_->setVisible(!status.verified);
    advice_->setText(sentence(status.advice));
    advice_->setVisible(!status.advice.empty());
    frames_->setText(perSecond(status.framesPerSecond));
    packets_->setText(perSecond(status.packetsPerSecond));
    rejected_->setText(QString::number(status.rejected));
    latency_->setText(status.latencyMilliseconds ? QString::number(*status.latencyMilliseconds, 'f', 1) + " ms"
                                                 : QString("unknown"));
    reason_->setText("Rejected last: " + asText(status.lastRejected));
    reason_->setVisible(!status.lastRejected.empty());
    event_->setText("Noticed last: " + tracker.event);
    event_->setVisible(!tracker.event.isEmpty());
    showSource(tracker);
    showBodies(status);
    showHistory(*rate_, "Frames", 10.0, tracker.rate, {});
    showHistory(*delay_, "Latency", 1.0, tracker.latency, "The tracker does not tell when its cameras looked.");
}

void TrackerCard::showBodies(const TrackerStatus& status) {
    const std::size_t count = std::min(status.bodies.size(), kMostRows);
    while (rows_.size() < count) addBodyRow();
    shown_.resize(rows_.size());
    for (std::size_t k = 0; k < rows_.size(); ++k) {
        const BodyRow& row = rows_[k];
        row.widget->setVisible(k < count);
        if (k >= count) continue;
        const TrackedBody& body = status.bodies[k];
        const bool seen = body.valid && status.receiving;
        shown_[k] = body.name;
        row.name->setText(QString("%1 - %2").arg(asText(body.name).left(60), seen ? "seen" : "lost"));
        row.place->setText(seen ? placeText(body.pose) : QString("It is not seen now."));
        const int role = indexOf(service_.role(body.name));
        if (row.role->currentIndex() != role) row.role->setCurrentIndex(role);
    }
    more_->setText(QString("And %1 more.").arg(status.bodies.size() - count));
    more_->setVisible(status.bodies.size() > count);
}

/// What only cameras and simulated trackers have.
void TrackerCard::showSource(const OpenTracker& tracker) {
    if (tracker.status.camera) {
        if (camera_ == nullptr) layout_->insertWidget(sourceRow_, camera_ = new CameraPanel(name_ + ".camera", this));
        camera_->show(*tracker.status.camera);
    }
    if (tracker.steering) {
        if (simulated_ == nullptr)
            layout_->insertWidget(sourceRow_, simulated_ = new SimulatedPanel(tracker.steering, name_ + ".sim", this));
        simulated_->refresh();
    }
}

} // namespace lumorph::studio
