#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace lumorph {

/// A foreign text made fit for a message: in single quotes, on one line, valid UTF-8 (what is neither shows as '?'),
/// and with "..." in place of what goes beyond `most` bytes. Not named `quoted`, which would mean std::quoted for a
/// std::string.
[[nodiscard]] std::string inQuotes(std::string_view text, std::size_t most = 80);

/// The same text in small letters; only those of ASCII are changed.
[[nodiscard]] std::string lowerCase(std::string_view text);

/// Whether all of it is UTF-8 (RFC 3629), as every file of ours is.
[[nodiscard]] bool isUtf8(std::string_view text) noexcept;

/// The bytes of a text file as UTF-8, without a byte order mark; UTF-16, told by its mark or by the zeros of its first
/// four characters, is converted. Other bytes are left as they are, and then have to outlive this.
class PlainText {
public:
    explicit PlainText(std::span<const std::byte> bytes);
    explicit PlainText(std::string_view bytes) : PlainText(std::as_bytes(std::span(bytes))) {}
    PlainText(const PlainText&) = delete;
    PlainText& operator=(const PlainText&) = delete;

    [[nodiscard]] std::string_view view() const noexcept { return view_; }

private:
    std::string converted_;
    std::string_view view_;
};

/// A text as one field of a table of comma separated values (RFC 4180): in quotes where it needs them.
[[nodiscard]] std::string csvField(std::string_view text);

} // namespace lumorph
