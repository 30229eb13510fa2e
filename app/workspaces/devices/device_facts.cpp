#include "app/workspaces/devices/device_facts.h"

#include <QGridLayout>
#include <QLocale>
#include <QStyle>

#include "app/workspaces/devices/device_words.h"

namespace lumorph::studio {
namespace {

constexpr int kColumns = 4;
const QString kUnknown(QChar(0x2013));
constexpr double kLowVolts = 6.0; ///< of two lithium cells, as the link warns of

struct Fact {
    const char* id;
    const char* name;
    const char* tip;
    QString (*text)(const LinkStatus&);
};

QString batteryText(const LinkStatus& link) {
    if (link.controller.volts) return QString("%1 V").arg(*link.controller.volts, 0, 'f', 1);
    return link.controller.traits.name.empty() || link.controller.traits.readsVoltage ? kUnknown : "not measured";
}

const Fact kFacts[] = {
    {"battery", "Battery", "What the board measures of its supply", batteryText},
    {"firmware", "Firmware", "What the board says that it runs",
     [](const LinkStatus& link) {
         return link.controller.firmware.empty() ? kUnknown : QString::fromStdString(link.controller.firmware);
     }},
    {"rate", "Commands", "How many commands went out in the last second; what does not change is not sent",
     [](const LinkStatus& link) { return QString("%1 / s").arg(link.commandsPerSecond, 0, 'f', 0); }},
    {"latency", "Latency", "From a command to its first byte on the wire",
     [](const LinkStatus& link) { return QString("%1 ms").arg(link.latencyMilliseconds, 0, 'f', 1); }},
    {"errors", "Errors", "Broken messages, and errors that the board told",
     [](const LinkStatus& link) { return QString::number(link.controller.errors); }},
    {"restarts", "Restarts", "How often the board restarted, and the link came back, in this session",
     [](const LinkStatus& link) {
         return QString("%1 board, %2 link").arg(link.controller.reboots).arg(link.reconnects);
     }},
    {"clamped", "Limited", "How often a command was held to the limits of range, speed and acceleration",
     [](const LinkStatus& link) { return QLocale::c().toString(static_cast<qulonglong>(link.clamped)); }},
    {"refused", "Refused", "How often a command was no number, or was for other servos",
     [](const LinkStatus& link) { return QLocale::c().toString(static_cast<qulonglong>(link.refused)); }},
};

void warn(QLabel* label, bool on) {
    const QString look = on ? "warning" : "";
    if (label->property("look").toString() == look) return;
    label->setProperty("look", look);
    label->style()->unpolish(label);
    label->style()->polish(label);
}

} // namespace

DeviceFacts::DeviceFacts(QWidget* parent) : QWidget(parent), failsafe_(new QLabel(this)), stopKeys_(new QLabel(this)) {
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setHorizontalSpacing(16);
    grid->setVerticalSpacing(0);
    int index = 0;
    for (const Fact& fact : kFacts) {
        auto* name = new QLabel(fact.name, this);
        name->setProperty("look", "muted");
        auto* value = new QLabel(kUnknown, this);
        value->setObjectName(QString("devices.fact.") + fact.id);
        value->setTextFormat(Qt::PlainText);
        value->setTextInteractionFlags(Qt::TextSelectableByMouse);
        value->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
        name->setToolTip(fact.tip);
        value->setToolTip(fact.tip);
        const int row = 3 * (index / kColumns), column = index % kColumns;
        grid->addWidget(name, row, column);
        grid->addWidget(value, row + 1, column);
        grid->setColumnStretch(column, 1);
        values_.push_back(value);
        ++index;
    }
    grid->setRowMinimumHeight(2, 8);
    grid->setRowMinimumHeight(5, 8);
    failsafe_->setObjectName("devices.failsafe");
    failsafe_->setProperty("look", "muted");
    failsafe_->setWordWrap(true);
    grid->addWidget(failsafe_, 6, 0, 1, kColumns);
    stopKeys_->setObjectName("devices.stopKeys");
    stopKeys_->setProperty("look", "warning");
    stopKeys_->setWordWrap(true);
    stopKeys_->hide();
    grid->addWidget(stopKeys_, 7, 0, 1, kColumns);
}

void DeviceFacts::show(const LinkStatus& link, const QString& stopKeysProblem) {
    for (std::size_t k = 0; k < values_.size(); ++k) {
        const QString text = link.phase == LinkPhase::off ? kUnknown : kFacts[k].text(link);
        if (values_[k]->text() != text) values_[k]->setText(text);
    }
    failsafe_->setText(failsafeText(link));
    stopKeys_->setText(stopKeysText(stopKeysProblem));
    stopKeys_->setVisible(!stopKeysProblem.isEmpty() && link.phase != LinkPhase::off);
    const bool low = link.phase != LinkPhase::off && link.controller.volts && *link.controller.volts < kLowVolts;
    warn(values_.front(), low);
}

} // namespace lumorph::studio
