#include "app/workspaces/devices/start_words.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lumorph::studio {
namespace {

constexpr double kStands = 0.005; ///< strokes, less is no way

QString strokePercent(double stroke) { return QString("%1 %").arg(100.0 * stroke, 0, 'f', 0); }
QString microsecondsText(double width) { return QString("%1 µs").arg(width, 0, 'f', 0); }
double wayOf(const StartMove& move) { return move.from ? std::abs(move.to - *move.from) : 0.0; }

QString moveText(const StartMove& move) {
    if (move.jump > 0.0) return "may jump by up to " + microsecondsText(move.jump);
    if (wayOf(move) < kStands) return "stays at " + strokePercent(move.to);
    return strokePercent(*move.from) + " to " + strokePercent(move.to) + ", slowly";
}

std::vector<std::size_t> farthestFirst(const std::vector<StartMove>& moves) {
    std::vector<std::size_t> order(moves.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return std::pair(moves[a].jump, wayOf(moves[a])) > std::pair(moves[b].jump, wayOf(moves[b]));
    });
    return order;
}

QString titleOf(const DeviceView& view, DeviceService::StartBy by) {
    if (by == DeviceService::StartBy::recording) return "Drive the servos by the recording?";
    return view.link.phase == LinkPhase::stopped ? "Start the servos again?" : "Start the servos?";
}

QString buttonOf(const DeviceView& view, bool jumps, DeviceService::StartBy by) {
    if (by == DeviceService::StartBy::recording) return "Hold to drive the servos";
    if (jumps) return "Hold to start anyway";
    return view.link.phase == LinkPhase::stopped ? "Hold to start again" : "Hold to start servos";
}

bool canBegin(const LinkStatus& link, DeviceService::StartBy by) {
    const bool driven = link.phase == LinkPhase::live && link.waiting.empty();
    if (driven) return by == DeviceService::StartBy::recording;
    return link.controller.answering &&
           (link.phase == LinkPhase::disarmed || link.phase == LinkPhase::stopped || !link.waiting.empty());
}

} // namespace

StartQuestion startQuestion(const DeviceView& view, const std::vector<StartMove>& moves, DeviceService::StartBy by) {
    StartQuestion question;
    const std::vector<std::size_t> order = farthestFirst(moves);
    for (std::size_t k = 0; k < moves.size(); ++k)
        question.servos << servoName(view.servos, k) + ": " + moveText(moves[k]);
    question.jumps = !order.empty() && moves[order.front()].jump > 0.0;
    question.possible = canBegin(view.link, by);
    question.title = titleOf(view, by);
    question.button = buttonOf(view, question.jumps, by);
    if (order.empty()) return question;
    const StartMove& first = moves[order.front()];
    if (question.jumps) {
        const bool known = first.from.has_value();
        question.text =
            "Hands off: the largest jump may be " + microsecondsText(first.jump) + ", of " +
            servoName(view.servos, order.front()) +
            (known ? ". Its firmware drives servos to the middle first." : ". Nobody knows where it stands.");
        return question;
    }
    const bool told = view.link.controller.traits.readsPosition || view.link.phase == LinkPhase::live;
    question.text = told ? "No servo jumps."
                         : "No servo jumps, unless it was moved since it was let go: this board "
                           "cannot tell.";
    if (wayOf(first) >= kStands)
        question.text += " The farthest way is " + strokePercent(wayOf(first)) + " of a stroke, of " +
                         servoName(view.servos, order.front()) + '.';
    return question;
}

} // namespace lumorph::studio
