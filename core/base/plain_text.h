#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace lumorph {

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

} // namespace lumorph
