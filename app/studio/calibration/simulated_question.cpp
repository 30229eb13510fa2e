#include "app/studio/calibration/simulated_question.h"

#include <algorithm>

#include <QObject>
#include <QStringList>

namespace lumorph::studio {

SimulatedQuestionWords wordsOfQuestion(const std::vector<std::string>& asked) {
    constexpr std::size_t kNamed = 4;
    QStringList names;
    for (std::size_t i = 0; i < std::min(asked.size(), kNamed); ++i) names << QString::fromStdString(asked[i]);
    if (asked.size() > kNamed) names << QObject::tr("and more");
    return {QObject::tr("This room holds what was measured or entered"),
            QObject::tr("Already in it: %1. What is simulated says nothing of this room; it stays marked as simulated.")
                .arg(names.join(", ")),
            QObject::tr("Use it as simulated")};
}

} // namespace lumorph::studio
