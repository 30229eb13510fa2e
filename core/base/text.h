#pragma once

#include <cstddef>
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

/// A text as one field of a table of comma separated values (RFC 4180): in quotes where it needs them.
[[nodiscard]] std::string csvField(std::string_view text);

} // namespace lumorph
