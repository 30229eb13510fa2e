#pragma once

#include <string>
#include <vector>

#include <QString>

#include "calibration/stages/simulated_question.h"

namespace lumorph::studio {

/// The question, as a card says it.
struct SimulatedQuestionWords {
    QString title, text, button;
};
[[nodiscard]] SimulatedQuestionWords wordsOfQuestion(const std::vector<std::string>& asked);

} // namespace lumorph::studio
