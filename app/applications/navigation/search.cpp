#include "app/applications/navigation/search.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace lumorph::navigation {
namespace {

/// Latin letters with marks at U+00C0 to U+00FF, by the letter that they are read as.
constexpr std::string_view kPlain = "aaaaaaaceeeeiiiidnooooo*ouuuuypsaaaaaaaceeeeiiiidnooooo/ouuuuypy";

/// Small letters, digits and single spaces; marks taken off.
std::string folded(std::string_view text) {
    std::string plain;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const auto c = static_cast<unsigned char>(text[k]);
        if (c == 0xC3 && k + 1 < text.size()) {
            const auto low = static_cast<unsigned char>(text[++k]);
            if (low >= 0x80 && low < 0xC0) plain += kPlain[low - 0x80U];
        } else if (c >= 'A' && c <= 'Z') {
            plain += static_cast<char>(c - 'A' + 'a');
        } else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c >= 0x80) {
            plain += static_cast<char>(c);
        } else if ((c == ' ' || c == '-' || c == '_') && !plain.empty() && plain.back() != ' ') {
            plain += ' ';
        }
    }
    while (!plain.empty() && plain.back() == ' ') plain.pop_back();
    return plain;
}

/// Letters to put in, take out or change (Levenshtein).
std::size_t slips(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t before = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t changed = before + (a[i] == b[j] ? 0 : 1);
            before = row[j + 1];
            row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::vector<std::string_view> wordsOf(std::string_view text) {
    std::vector<std::string_view> words;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        if (end > 0) words.push_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return words;
}

/// How far from what is meant; 0: the same.
std::size_t strangeness(const std::string& name, const std::string& wish) {
    constexpr std::size_t kBegins = 1, kHolds = 2, kSlips = 3;
    if (name == wish) return 0;
    if (name.starts_with(wish)) return kBegins;
    if (name.find(wish) != std::string::npos) return kHolds;
    std::size_t sum = 0;
    for (const std::string_view word : wordsOf(wish)) {
        std::size_t least = word.size();
        for (const std::string_view own : wordsOf(name)) least = std::min(least, slips(own, word));
        if (3 * least > word.size()) return std::string::npos; // a third of a word may be wrong
        sum += least;
    }
    return kSlips + sum;
}

} // namespace

std::optional<std::size_t> find(std::span<const Place> places, std::string_view name) {
    const std::string wish = folded(name);
    if (wish.empty()) return std::nullopt;
    std::optional<std::size_t> best;
    std::size_t least = std::string::npos;
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Words& own = places[k].name;
        std::size_t strange = strangeness(folded(own.english), wish);
        if (!own.german.empty()) strange = std::min(strange, strangeness(folded(own.german), wish));
        if (strange >= least) continue;
        least = strange;
        best = k;
    }
    return best;
}

} // namespace lumorph::navigation
