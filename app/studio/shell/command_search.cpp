#include "app/studio/shell/command_search.h"

#include <algorithm>

namespace lumorph::studio {
namespace {

constexpr double kLetter = 1.0, kWordStart = 4.0, kNextToEachOther = 3.0, kFromTheStart = 3.0, kPerLetterLeft = 0.02;
constexpr double kWorthShowing = 0.4; ///< of the best score; less is letters found by chance

bool startsWord(const QString& text, qsizetype at) { return at == 0 || !text[at - 1].isLetterOrNumber(); }

} // namespace

/// The best way to lay the letters over the text, by one table row a letter: `best[at]` is the best score with the
/// newest letter at `at`.
std::optional<double> searchScore(const QString& typed, const QString& text) {
    const QString letters = typed.simplified().remove(' ').toCaseFolded();
    const QString in = text.toCaseFolded();
    if (letters.isEmpty()) return 0.0;
    constexpr double kNone = -1.0;
    std::vector<double> best(static_cast<std::size_t>(in.size()), kNone);
    for (qsizetype letter = 0; letter < letters.size(); ++letter) {
        std::vector<double> next(best.size(), kNone);
        double before = kNone; // best with the letter before anywhere to the left
        for (std::size_t at = 0; at < best.size(); ++at) {
            const auto position = static_cast<qsizetype>(at);
            const bool fits = in[position] == letters[letter];
            const double own = kLetter + (startsWord(in, position) ? kWordStart : 0.0);
            if (fits && letter == 0) next[at] = own + (at == 0 ? kFromTheStart : 0.0);
            if (fits && letter > 0) {
                const double joined = at > 0 && best[at - 1] >= 0.0 ? best[at - 1] + kNextToEachOther : kNone;
                const double from = std::max(joined, before);
                if (from >= 0.0) next[at] = from + own;
            }
            before = std::max(before, best[at]);
        }
        best = std::move(next);
    }
    const double score = best.empty() ? kNone : *std::max_element(best.begin(), best.end());
    if (score < 0.0) return std::nullopt;
    return score - kPerLetterLeft * static_cast<double>(in.size() - letters.size());
}

QString commandTitle(const QAction& action) {
    QString title = action.text().section('\t', 0, 0);
    title.remove('&').remove("...").remove(QChar(0x2026));
    return title.trimmed();
}

std::vector<Commands::Entry> searchCommands(const Commands& commands, const QString& typed) {
    std::vector<std::pair<double, Commands::Entry>> found;
    for (const Commands::Entry& entry : commands.all()) {
        if (!entry.action->isVisible()) continue;
        auto score = searchScore(typed, commandTitle(*entry.action));
        // The menu's name finds its commands too, behind those that are called so.
        if (const auto inMenu = searchScore(typed, entry.options.menu + ' ' + commandTitle(*entry.action)))
            score = std::max(score.value_or(0.0), *inMenu * 0.6);
        if (score) found.emplace_back(*score, entry);
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    if (!found.empty()) {
        const double worst = found.front().first * kWorthShowing;
        std::erase_if(found, [worst](const auto& one) { return one.first < worst; });
    }
    std::vector<Commands::Entry> entries;
    entries.reserve(found.size());
    for (auto& [score, entry] : found) entries.push_back(std::move(entry));
    return entries;
}

} // namespace lumorph::studio
