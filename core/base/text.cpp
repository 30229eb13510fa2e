#include "core/base/text.h"

namespace lumorph {
namespace {

/// Bytes of the UTF-8 character that `text` begins with, as RFC 3629 has them; 0 where there is none.
std::size_t characterLength(std::string_view text) noexcept {
    const auto byte = [&](std::size_t i) -> unsigned { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xC2 && first <= 0xDF   ? 2
                               : first >= 0xE0 && first <= 0xEF ? 3
                               : first >= 0xF0 && first <= 0xF4 ? 4
                                                                : 0;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
    // Longer than need be, halves of surrogate pairs, and what lies beyond Unicode.
    const unsigned second = byte(1);
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) || (first == 0xF0 && second < 0x90) ||
        (first == 0xF4 && second > 0x8F))
        return 0;
    return length;
}

enum class Encoding { bytes, utf16Little, utf16Big };

/// By a byte order mark, or by the zeros of a text that begins with four characters of ASCII.
Encoding encodingOf(std::string_view text) noexcept {
    if (text.starts_with("\xFF\xFE")) return Encoding::utf16Little;
    if (text.starts_with("\xFE\xFF")) return Encoding::utf16Big;
    constexpr std::size_t kJudged = 8;
    if (text.size() < kJudged) return Encoding::bytes;
    bool little = true, big = true;
    for (std::size_t i = 0; i < kJudged; ++i) {
        const char c = text[i];
        const bool ascii = (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t';
        little = little && (i % 2 == 0 ? ascii : c == '\0');
        big = big && (i % 2 == 1 ? ascii : c == '\0');
    }
    return little ? Encoding::utf16Little : big ? Encoding::utf16Big : Encoding::bytes;
}

void addUtf8(std::string& text, char32_t c) {
    const auto add = [&text](char32_t byte) { text += static_cast<char>(byte); };
    if (c < 0x80) return add(c);
    if (c < 0x800) {
        add(0xC0U | c >> 6U);
    } else if (c < 0x10000) {
        add(0xE0U | c >> 12U);
        add(0x80U | (c >> 6U & 0x3FU));
    } else {
        add(0xF0U | c >> 18U);
        add(0x80U | (c >> 12U & 0x3FU));
        add(0x80U | (c >> 6U & 0x3FU));
    }
    add(0x80U | (c & 0x3FU));
}

/// Halves of pairs that are alone become U+FFFD, as does half a character at the end.
std::string utf8Of(std::string_view utf16, bool big) {
    constexpr char32_t kNone = 0xFFFD;
    const auto unit = [&](std::size_t i) -> char32_t {
        const auto a = static_cast<unsigned char>(utf16[i]), b = static_cast<unsigned char>(utf16[i + 1]);
        return big ? static_cast<char32_t>(a) << 8U | b : static_cast<char32_t>(b) << 8U | a;
    };
    const auto isHalf = [](char32_t c, char32_t from) { return c >= from && c < from + 0x400; };
    std::string text;
    text.reserve(utf16.size() / 2);
    std::size_t at = 0;
    for (; at + 1 < utf16.size(); at += 2) {
        char32_t c = unit(at);
        if (isHalf(c, 0xD800) && at + 3 < utf16.size() && isHalf(unit(at + 2), 0xDC00)) {
            c = 0x10000 + ((c - 0xD800) << 10U) + (unit(at + 2) - 0xDC00);
            at += 2;
        } else if (isHalf(c, 0xD800) || isHalf(c, 0xDC00)) {
            c = kNone;
        }
        addUtf8(text, c);
    }
    if (at < utf16.size()) addUtf8(text, kNone);
    return text;
}

bool isControl(std::string_view character) noexcept {
    const auto first = static_cast<unsigned char>(character[0]);
    if (character.size() == 1) return first < 0x20 || first == 0x7F;
    return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0; // U+0080 to U+009F
}

} // namespace

std::string inQuotes(std::string_view text, std::size_t most) {
    std::string result = "'";
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t length = characterLength(text.substr(at));
        const std::size_t taken = length > 0 ? length : 1;
        if (at + taken > most) {
            result += "...";
            break;
        }
        const std::string_view character = text.substr(at, taken);
        if (length == 0 || isControl(character))
            result += '?';
        else
            result += character;
        at += taken;
    }
    return result + '\'';
}

std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

bool isUtf8(std::string_view text) noexcept {
    while (!text.empty()) {
        const std::size_t length = characterLength(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

PlainText::PlainText(std::span<const std::byte> bytes)
    : view_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {
    if (const Encoding encoding = encodingOf(view_); encoding != Encoding::bytes) {
        converted_ = utf8Of(view_, encoding == Encoding::utf16Big);
        view_ = converted_;
    }
    if (view_.starts_with("\xEF\xBB\xBF")) view_.remove_prefix(3);
}

std::string csvField(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"') result += '"';
        result += c;
    }
    return result + '"';
}

} // namespace lumorph
