#pragma once

#include <deque>
#include <string>
#include <vector>

#include <QDateTime>
#include <QString>

#include "app/studio/base/notices.h"
#include "devices/controllers/servo_link.h"

namespace lumorph::studio {

/// One line of what happened with the device.
struct DeviceLogLine {
    QDateTime time;
    LinkEvent::Kind kind = LinkEvent::Kind::information;
    QString text;
    QString remedy;
    bool aside = false; ///< by the studio's own panels, not about the link
};

/// What happened, newest first, at most 500 lines.
class DeviceLog {
public:
    [[nodiscard]] const std::deque<DeviceLogLine>& lines() const noexcept { return lines_; }
    void add(DeviceLogLine line);

private:
    std::deque<DeviceLogLine> lines_;
};

/// "Servo 3", "Servos 1, 2 and 4" of indices in order.
[[nodiscard]] std::string servosText(const std::vector<std::size_t>& servos);

/// An event of a link, in the wall's time, its remedy as a sentence.
[[nodiscard]] DeviceLogLine lineOf(const LinkEvent& event);
/// For those who are in another workspace: the status line counts and lists it.
[[nodiscard]] Notice noticeOf(const DeviceLogLine& line, const QString& device);

} // namespace lumorph::studio
