#include "core/base/plain_text.h"

namespace lumorph {
namespace {

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

} // namespace

PlainText::PlainText(std::span<const std::byte> bytes)
    : view_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {
    if (const Encoding encoding = encodingOf(view_); encoding != Encoding::bytes) {
        converted_ = utf8Of(view_, encoding == Encoding::utf16Big);
        view_ = converted_;
    }
    if (view_.starts_with("\xEF\xBB\xBF")) view_.remove_prefix(3);
}

} // namespace lumorph
