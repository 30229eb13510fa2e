#include "app/studio/shell/loop_text.h"

#include <cmath>

namespace lumorph::studio {
namespace {

constexpr double kWorthTelling = 0.01; ///< of the target's volume

/// In two digits that say something.
QString milliseconds(double ms) { return QString::number(ms, 'f', ms < 1.0 ? 2 : 1) + " ms"; }

QString percent(double share) { return QString::number(std::lround(share * 100.0)) + " %"; }

} // namespace

MatchTimes lastMatch(const MatchTimes& before, const MatchFrame& frame) {
    if (!frame.matched) return {};
    if (frame.ms.match > 0.0) return frame.ms;
    MatchTimes times = before;
    if (frame.ms.refine > 0.0) times.refine = frame.ms.refine; // it went on where its time had ended
    return times;
}

QString loopText(const MatchFrame* frame, const MatchTimes& lastMatch, double rate, bool stopped) {
    QString text = stopped ? "Stopped" : rate > 0.0 ? QString::number(std::lround(rate)) + " Hz" : "Idle";
    if (frame == nullptr) return text;
    if (!frame->splitStrokes.empty()) return text + ", servos follow the scene";
    if (!frame->matched) return text + (frame->target ? ", not matching" : ", no target");
    if (lastMatch.match <= 0.0) return text + ", matched";
    text += ", matched in " + milliseconds(lastMatch.match);
    if (lastMatch.refine > 0.0) text += " + refined " + milliseconds(lastMatch.refine);
    return text;
}

std::vector<QString> frameWarnings(const MatchFrame* frame) {
    std::vector<QString> told;
    if (frame == nullptr || !frame->target) return told;
    for (const auto& warning : frame->target->warnings) told.push_back(QString::fromStdString(warning));
    if (frame->shareBeyondFrame > kWorthTelling)
        told.push_back(percent(frame->shareBeyondFrame) +
                       " of the target lies beyond what the device can reach; fit it, or make it smaller");
    if (frame->shareUnreachable > kWorthTelling)
        told.push_back(percent(frame->shareUnreachable) +
                       " of the target is where no actuator reaches; move or turn it, or auto-place it");
    return told;
}

} // namespace lumorph::studio
