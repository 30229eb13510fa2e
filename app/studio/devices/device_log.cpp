#include "app/studio/devices/device_log.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/base/clock.h"

namespace lumorph::studio {
namespace {

constexpr std::size_t kMostLines = 500;

/// Remedies are worded as parts of a sentence; a log has lines.
QString asSentence(QString text) {
    if (text.isEmpty()) return text;
    text[0] = text[0].toUpper();
    return text.endsWith('.') ? text : text + '.';
}

/// Links tell the steady clock's time; people read the wall's.
QDateTime wallTime(Microseconds time) {
    const auto ago = std::chrono::duration_cast<std::chrono::milliseconds>(SteadyClock().now() - time);
    return QDateTime::currentDateTime().addMSecs(-std::clamp<std::int64_t>(ago.count(), 0, 60'000));
}

} // namespace

void DeviceLog::add(DeviceLogLine line) {
    lines_.push_front(std::move(line));
    if (lines_.size() > kMostLines) lines_.pop_back();
}

std::string servosText(const std::vector<std::size_t>& servos) {
    std::string text = servos.size() == 1 ? "Servo " : "Servos ";
    for (std::size_t k = 0; k < servos.size(); ++k)
        text += (k == 0 ? "" : k + 1 == servos.size() ? " and " : ", ") + std::to_string(servos[k] + 1);
    return text;
}

DeviceLogLine lineOf(const LinkEvent& event) {
    return {wallTime(event.time), event.kind, QString::fromStdString(event.text),
            asSentence(QString::fromStdString(event.remedy)), false};
}

Notice noticeOf(const DeviceLogLine& line, const QString& device) {
    Notice notice;
    notice.level = line.kind == LinkEvent::Kind::failure ? Notice::Level::error : Notice::Level::warning;
    notice.subject = device;
    notice.why = line.text;
    notice.remedy = line.remedy;
    return notice;
}

} // namespace lumorph::studio
