#pragma once

#include <QString>
#include <QStringList>

#include "app/studio/devices/device_service.h"
#include "app/studio/devices/start_moves.h"
#include "app/workspaces/devices/device_words.h"

namespace lumorph::studio {

/// What the user is asked before servos move: what will move how far, and the word to say.
struct StartQuestion {
    QString title;
    QString text;       ///< the largest jump and the farthest way, by servo
    QStringList servos; ///< what each servo will do
    QString button;     ///< to be held
    bool jumps = false; ///< some servo may leap
    bool possible = false;
    bool operator==(const StartQuestion&) const = default;
};

/// `moves` as startMoves gives them, one a servo of the view.
[[nodiscard]] StartQuestion startQuestion(const DeviceView& view, const std::vector<StartMove>& moves,
                                          DeviceService::StartBy by);

} // namespace lumorph::studio
