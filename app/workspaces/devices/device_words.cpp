#include "app/workspaces/devices/device_words.h"

#include <algorithm>

#include "app/studio/devices/device_log.h"

namespace lumorph::studio {
namespace {

using Step = DeviceCard::Step;
using Tone = DeviceCard::Tone;

QString joined(const QString& first, const QString& second) {
    if (first.isEmpty() || second.isEmpty()) return first + second;
    return first + ' ' + second;
}

QString troubleText(const LinkTrouble& trouble) { return joined(sentence(trouble.why), sentence(trouble.remedy)); }

DeviceCard offCard(const DeviceView& view) {
    if (view.address.isEmpty())
        return {Tone::quiet, "Nothing is connected",
                "Choose a device on the left. The simulated ones behave like real boards, and nothing can break.",
                Step::connect, "Connect the simulated tablet"};
    return {Tone::quiet, "Nothing is connected", "The device of last time was " + view.name + '.', Step::connect,
            "Connect"};
}

DeviceCard lostCard(const DeviceView& view) {
    const auto& trouble = view.link.trouble ? view.link.trouble : view.link.controller.trouble;
    QString text = trouble ? troubleText(*trouble) : QString("It does not answer any more.");
    const bool was = view.link.phase == LinkPhase::lost;
    return {Tone::failure,
            (was ? "The link to " + view.name + " is lost" : "No link to " + view.name),
            joined(text, "The studio tries again by itself."),
            Step::none,
            {}};
}

DeviceCard handshakeCard(const DeviceView& view) {
    const ControllerState& controller = view.link.controller;
    const bool refused = controller.phase == ControllerPhase::refused;
    if (refused || controller.trouble)
        return {Tone::failure,
                view.name + (refused || controller.answering ? " cannot be used as it is" : " does not answer"),
                controller.trouble ? troubleText(*controller.trouble) : QString("It is something else."),
                Step::none,
                {}};
    return {Tone::quiet,
            "Connecting to " + view.name,
            controller.answering ? "The link is open; the board is asked what it is."
                                 : "The link is open, but the board says nothing. Is it switched on, and is this its "
                                   "kind of controller and its speed?",
            Step::none,
            {}};
}

DeviceCard confirmCard(const DeviceView& view) {
    const QString product = QString::fromStdString(view.link.product);
    const QString firmware = QString::fromStdString(view.link.controller.firmware);
    const QString itself = firmware.isEmpty() ? product : firmware;
    return {Tone::warning, "Is this your device?",
            (itself.isEmpty() ? QString("It does not say what it is.") : "It calls itself " + itself + '.') +
                " Nothing moves until you say so.",
            Step::confirm, "Yes, this is it"};
}

DeviceCard waitingCard(const DeviceView& view) {
    const auto& waiting = view.link.waiting;
    if (waiting.size() == 1)
        return {Tone::warning,
                servoName(view.servos, waiting.front()) + " may jump when it starts: hands off",
                "Nobody knows where it stands.",
                Step::startAnyway,
                {}};
    if (static_cast<qsizetype>(waiting.size()) == view.servos.size())
        return {Tone::warning,
                "All servos may jump when they start: hands off",
                "Nobody knows where they stand. They start one after the other.",
                Step::startAnyway,
                {}};
    return {Tone::warning,
            QString::fromStdString(servosText(waiting)) + " may jump when they start: hands off",
            "Nobody knows where they stand. They start one after the other.",
            Step::startAnyway,
            {}};
}

DeviceCard readyCard(const DeviceView& view) {
    const bool known = std::ranges::all_of(view.link.servos, &ServoStatus::known);
    QString text = known ? "Its servos are limp. They start one after the other, slowly."
                         : "Its servos are limp, and nobody knows where they stand. They start one after the other.";
    if (view.link.controller.traits.jumpsOnAttach)
        text = "Its firmware lets servos jump to the middle when they start: hands off.";
    if (!view.link.controller.answering)
        return {Tone::warning,
                view.name + " does not answer",
                "It was there a moment ago. Is it busy, or has it no "
                "power?",
                Step::none,
                {}};
    if (!view.lately.isEmpty())
        return {Tone::warning, view.name + " is ready again", "Just now: " + view.lately, Step::start, {}};
    return {Tone::quiet, view.name + " is ready", text, Step::start, {}};
}

DeviceCard liveCard(const DeviceView& view) {
    if (!view.link.controller.answering)
        return {Tone::warning, view.name + " does not answer", "Commands are still sent.", Step::none, {}};
    if (!view.lately.isEmpty()) return {Tone::warning, "Live, but look at this", view.lately, Step::none, {}};
    return {Tone::live, "Live", "The servos of " + view.name + " follow the show.", Step::none, {}};
}

/// What Lumorph itself does when it can drive the servos no longer.
QString processText(const LinkStatus& link) {
    switch (link.failsafe) {
    case LinkFailsafeState::runs:
        return "when Lumorph ends or hangs, a process of its own lets the servos go within a second. ";
    case LinkFailsafeState::notShared:
        return "Lumorph's own process, which lets servos go when Lumorph crashes or hangs, cannot use this kind of "
               "link. Keep the switch of their power at hand. ";
    case LinkFailsafeState::missing:
        return "the process that lets servos go when Lumorph crashes or hangs could not be started: "
               "lumorph-servo-failsafe is missing beside the program. Install Lumorph again. ";
    case LinkFailsafeState::none:
        break;
    }
    return {};
}

} // namespace

QString sentence(const std::string& words) {
    QString text = QString::fromStdString(words).trimmed();
    if (text.isEmpty()) return text;
    text[0] = text[0].toUpper();
    return text.back().isPunct() ? text : text + '.';
}

DeviceCard cardOf(const DeviceView& view) {
    if (!view.rig)
        return {Tone::quiet, "No device yet", "A rig says which servos there are and what they move.", Step::openRig,
                "Open rig..."};
    switch (view.link.phase) {
    case LinkPhase::off:
        return offCard(view);
    case LinkPhase::connecting:
        return view.link.trouble
                   ? lostCard(view)
                   : DeviceCard{Tone::quiet, "Connecting to " + view.name, "The link is opened.", Step::none, {}};
    case LinkPhase::handshake:
        return handshakeCard(view);
    case LinkPhase::unidentified:
        return confirmCard(view);
    case LinkPhase::disarmed:
        return readyCard(view);
    case LinkPhase::starting:
        if (!view.link.waiting.empty()) return waitingCard(view);
        return {Tone::live, "Servos start", "One after the other, each from where it is.", Step::none, {}};
    case LinkPhase::live:
        return view.link.waiting.empty() ? liveCard(view) : waitingCard(view);
    case LinkPhase::stopped:
        return {Tone::failure,
                "Stopped",
                "The show holds still, and all servos are limp until you start them again.",
                Step::startAgain,
                {}};
    case LinkPhase::lost:
        return lostCard(view);
    }
    return {};
}

QString servoName(const QStringList& servos, std::size_t servo) {
    const QString number = "Servo " + QString::number(servo + 1);
    const auto index = static_cast<qsizetype>(servo);
    return index < servos.size() ? number + " (" + servos[index] + ')' : number;
}

QString servoWord(const LinkStatus& link, std::size_t servo, bool tested) {
    if (servo >= link.servos.size()) return "No link";
    const ServoStatus& one = link.servos[servo];
    for (const std::size_t waits : link.waiting)
        if (waits == servo) return "Waits for you";
    if (link.phase == LinkPhase::lost) return "Link lost";
    if (!one.attached) return link.phase == LinkPhase::starting ? "Comes next" : "Limp";
    if (tested) return "Test";
    return "Follows";
}

QString failsafeText(const LinkStatus& link) {
    const ControllerTraits& traits = link.controller.traits;
    const bool answered =
        link.phase != LinkPhase::off && link.phase != LinkPhase::connecting && link.phase != LinkPhase::handshake;
    if (!answered || traits.name.empty()) return "Failsafe: known once a device answers.";
    return "Failsafe: " + processText(link) + "The board's: " + QString::fromStdString(traits.failsafeWord) + '.';
}

QString stopKeysText(const QString& why) {
    if (why.isEmpty()) return {};
    return "Esc Esc stops the servos only while this window has the keyboard and is not stuck: " + why +
           ". Keep the switch of their power at hand.";
}

QString handsText(const HandSense& hands, const QStringList& servos) {
    if (!hands.held.empty()) {
        const bool one = hands.held.size() == 1;
        QString who = one ? servoName(servos, hands.held.front()) : QString::fromStdString(servosText(hands.held));
        who[0] = who[0].toLower();
        return "Slow: " + who + (one ? " is held, or stuck" : " are held, or stuck");
    }
    const QString distance = hands.distance ? QString("%1 cm").arg(100.0 * *hands.distance, 0, 'f', 0) : QString();
    if (hands.near && !hands.distance) return "Slow: a hand was near when it was seen last";
    if (hands.near) return "Slow: a hand is tracked " + distance + " away";
    if (hands.distance) return "A hand is tracked " + distance + " away";
    return hands.feels ? "Hands are not tracked; a servo that is held is felt" : "Hands are not sensed";
}

QString restText(const DeviceProfile& profile, const QStringList& servos) {
    QStringList raised;
    for (std::size_t k = 0; k < profile.servos.size(); ++k)
        if (const double stroke = profile.servos[k].exitStroke; stroke > 0.0)
            raised << QString("%1 at %2 %").arg(servoName(servos, k)).arg(100.0 * stroke, 0, 'f', 0);
    if (raised.isEmpty()) return "All servos down.";
    const bool all = raised.size() == static_cast<qsizetype>(profile.servos.size());
    return raised.join(", ") + (all ? "." : ", the others down.");
}

} // namespace lumorph::studio
