#include "core/geometry/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"

namespace lumorph {
namespace {

constexpr bool isBlank(char c) noexcept { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0'; }

std::string_view withoutPlus(std::string_view word) noexcept {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

} // namespace

bool parseReal(std::string_view word, double& value) noexcept {
    word = withoutPlus(word);
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (stop != end || error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range)
        value = word.find("e-") != word.npos || word.find("E-") != word.npos ? 0.0 : HUGE_VAL;
    return true;
}

TextScanner::TextScanner(std::string_view text, std::string name, Continuation continuation)
    : text_(text), name_(std::move(name)), continuation_(continuation) {}

std::size_t TextScanner::lineEnd(std::size_t position) const noexcept {
    if (position >= text_.size()) return 0;
    if (text_[position] == '\n') return 1;
    if (text_[position] != '\r') return 0;
    return position + 1 < text_.size() && text_[position + 1] == '\n' ? 2 : 1;
}

std::string_view TextScanner::wordOnLine() noexcept {
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (isBlank(c)) {
            ++position_;
        } else if (c == '\\' && continuation_ == Continuation::backslash && lineEnd(position_ + 1) > 0) {
            position_ += 1 + lineEnd(position_ + 1);
            ++line_;
        } else if (c == '#') {
            while (position_ < text_.size() && lineEnd(position_) == 0) ++position_;
        } else {
            break;
        }
    }
    const std::size_t start = position_;
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (isBlank(c) || c == '\n' || c == '\r' || c == '#') break;
        if (c == '\\' && continuation_ == Continuation::backslash && lineEnd(position_ + 1) > 0) break;
        ++position_;
    }
    return text_.substr(start, position_ - start);
}

std::string_view TextScanner::word() noexcept {
    for (;;) {
        const std::string_view found = wordOnLine();
        if (!found.empty() || atEnd()) return found;
        position_ += lineEnd(position_);
        ++line_;
    }
}

std::string_view TextScanner::restOfLine() noexcept {
    const std::size_t start = position_;
    while (position_ < text_.size() && lineEnd(position_) == 0) ++position_;
    const std::string_view rest = text_.substr(start, position_ - start);
    if (!atEnd()) {
        position_ += lineEnd(position_);
        ++line_;
    }
    return rest;
}

float TextScanner::coordinate(std::string_view word, std::string_view what) const {
    const std::string_view digits = withoutPlus(word);
    const char* const end = digits.data() + digits.size();
    float value = 0.0F;
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (error == std::errc() && stop == end && std::isfinite(value)) return value;

    // Not the plain case: missing, no number, not finite, or beyond a float at either end.
    if (word.empty()) failMissing(what);
    double wide = 0.0;
    if (!parseReal(word, wide))
        fail(inQuotes(word) + " is not a number, for the " + std::string(what), "write numbers like 1.5 or -2e-3");
    value = static_cast<float>(wide);
    if (!std::isfinite(value))
        fail("the " + std::string(what) + " is " + inQuotes(word) + ", not a finite number",
             "remove the vertex, or export the model again");
    return value;
}

std::int64_t TextScanner::integer(std::string_view word, std::string_view what) const {
    if (word.empty()) failMissing(what);
    const std::string_view digits = withoutPlus(word);
    const char* const end = digits.data() + digits.size();
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(digits.data(), end, value);
    if (error != std::errc() || stop != end)
        fail(inQuotes(word) + " is not a whole number, for the " + std::string(what), "export the model again");
    return value;
}

void TextScanner::fail(const std::string& why, const std::string& remedy) const {
    throw DataError(name_ + ", line " + std::to_string(line_), why, remedy);
}

void TextScanner::failMissing(std::string_view what) const {
    if (atEnd()) failTruncated("the " + std::string(what));
    fail("the " + std::string(what) + " is missing", "export the model again");
}

void TextScanner::failTruncated(std::string_view expected) const {
    fail("the file ends where " + std::string(expected) + " should follow", "it is cut short; copy or export it again");
}

} // namespace lumorph
