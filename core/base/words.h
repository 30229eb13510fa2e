#pragma once

#include <string>
#include <utility>

namespace lumorph {

/// What visitors may read.
enum class Language { english, german };

/// A text for visitors in each language; English stands in where another is missing. `"Ice"` is one without German,
/// `{"Ice", "Eis"}` one in both.
struct Words {
    std::string english;
    std::string german; ///< UTF-8, as the other is; empty: there is none

    Words() = default;
    // Not explicit: a text that is alone is written as any other text.
    Words(const char* englishText) : english(englishText) {}
    Words(std::string englishText, std::string germanText = {})
        : english(std::move(englishText)), german(std::move(germanText)) {}

    [[nodiscard]] const std::string& in(Language language) const noexcept {
        return language == Language::german && !german.empty() ? german : english;
    }
    [[nodiscard]] bool empty() const noexcept { return english.empty(); }
    bool operator==(const Words&) const = default;
};

} // namespace lumorph
