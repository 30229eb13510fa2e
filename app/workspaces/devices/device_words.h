#pragma once

#include <QString>
#include <QStringList>

#include "app/studio/devices/hand_watch.h"
#include "app/workspaces/common/step_card.h"
#include "devices/controllers/servo_link.h"

namespace lumorph::studio {

/// What the card over the servos says: how things are, in one sentence, and the one sensible next step.
struct DeviceCard {
    using Tone = StepCardText::Tone;
    enum class Step { none, openRig, connect, confirm, start, startAnyway, startAgain };
    Tone tone = Tone::quiet;
    QString title;
    QString text;
    Step step = Step::none;
    QString button; ///< empty: there is nothing to do, or servos are to be started, which StartPanel asks about
    [[nodiscard]] bool starts() const {
        return step == Step::start || step == Step::startAnyway || step == Step::startAgain;
    }
    bool operator==(const DeviceCard&) const = default;
};

/// What the words are about.
struct DeviceView {
    bool rig = false;
    LinkStatus link;
    QString name;         ///< of the device
    QString address;      ///< empty: none was ever chosen
    bool stopped = false; ///< STOP is latched
    QString lately;       ///< what went wrong last, while it still matters; may be empty
    QStringList servos;   ///< names of the actuators
};

[[nodiscard]] DeviceCard cardOf(const DeviceView& view);

/// What one servo does right now: "Follows", "Limp", "Waits for you".
[[nodiscard]] QString servoWord(const LinkStatus& link, std::size_t servo, bool tested);
/// What the controller does when the studio dies; honest where it does nothing.
[[nodiscard]] QString failsafeText(const LinkStatus& link);
/// How far Esc Esc reaches, where it is not everywhere; `why` may be empty.
[[nodiscard]] QString stopKeysText(const QString& why);
/// Who senses hands, or that nobody does, and why servos are slow.
[[nodiscard]] QString handsText(const HandSense& hands, const QStringList& servos);
/// "Servo 3 (front left)" of an index.
[[nodiscard]] QString servoName(const QStringList& servos, std::size_t servo);
/// "All at rest", or who rests where.
[[nodiscard]] QString restText(const DeviceProfile& profile, const QStringList& servos);
/// The first letter large and a full stop at the end.
[[nodiscard]] QString sentence(const std::string& words);

} // namespace lumorph::studio
