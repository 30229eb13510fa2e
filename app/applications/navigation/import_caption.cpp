#include "app/applications/navigation/import_caption.h"

#include <algorithm>
#include <cmath>

namespace lumorph::navigation {
namespace {

constexpr std::size_t kMostNotes = 3;

/// "1 road, " or "7 roads, "; nothing where there are none.
void count(Words& to, std::size_t number, const Words& one, const Words& many) {
    if (number == 0) return;
    const Words& name = number == 1 ? one : many;
    const auto add = [&](std::string& text, const std::string& word) {
        text += (text.empty() ? "" : ", ") + std::to_string(number) + " " + word;
    };
    add(to.english, name.english);
    add(to.german, name.german);
}

} // namespace

ShowCaption importCaption(const MapReport& report, const std::string& name) {
    ShowCaption caption{{"Read: " + name, "Gelesen: " + name}, {}};
    Words& told = caption.sentence;
    count(told, report.buildings, {"building", "Gebäude"}, {"buildings", "Gebäude"});
    count(told, report.heightMissing, {"height guessed", "Höhe geschätzt"}, {"heights guessed", "Höhen geschätzt"});
    count(told, report.roads, {"road", "Straße"}, {"roads", "Straßen"});
    count(told, report.places, {"place", "Ort"}, {"places", "Orte"});
    count(told, report.mended, {"outline mended", "Umriss berichtigt"}, {"outlines mended", "Umrisse berichtigt"});
    count(told, report.closed, {"ring closed", "Ring geschlossen"}, {"rings closed", "Ringe geschlossen"});
    count(told, report.leftOut, {"thing left out", "Ding weggelassen"}, {"things left out", "Dinge weggelassen"});
    if (report.filled > 0.0) {
        const std::string percent = std::to_string(std::max(1L, std::lround(100.0 * report.filled)));
        told.english += (told.english.empty() ? "" : ", ") + percent + " % of the heights filled in";
        told.german += (told.german.empty() ? "" : ", ") + percent + " % der Höhen ergänzt";
    }
    if (told.english.empty()) told = {"land alone", "nur Land"};
    for (const Language language : {Language::english, Language::german}) {
        std::string& text = language == Language::german ? told.german : told.english;
        text += ".";
        for (std::size_t k = 0; k < std::min(report.notes.size(), kMostNotes); ++k)
            text += " " + report.notes[k].in(language);
        if (report.notes.size() > kMostNotes) text += " …";
    }
    return caption;
}

} // namespace lumorph::navigation
