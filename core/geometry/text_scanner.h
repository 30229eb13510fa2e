#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace lumorph {

/// Takes a text file apart into words and knows the line each stands on. Lines end with LF, CR LF or
/// CR; `#` starts a comment. Errors are DataError "NAME, line N: ...".
class TextScanner {
public:
    enum class Continuation { none, backslash }; ///< whether a backslash joins the next line

    TextScanner(std::string_view text, std::string name, Continuation continuation = Continuation::none);

    /// Next word of this line; empty at its end, where it stays.
    [[nodiscard]] std::string_view wordOnLine() noexcept;
    /// Next word of this or a later line; empty at the end of the file.
    [[nodiscard]] std::string_view word() noexcept;
    /// The rest of this line as it stands, comments included; goes on to the next line.
    std::string_view restOfLine() noexcept;

    /// Next word as a number; `what` names it in errors ("x coordinate").
    [[nodiscard]] float coordinate(std::string_view word, std::string_view what) const;
    [[nodiscard]] std::int64_t integer(std::string_view word, std::string_view what) const;

    [[nodiscard]] bool atEnd() const noexcept { return position_ >= text_.size(); }
    [[nodiscard]] std::size_t line() const noexcept { return line_; }
    [[nodiscard]] std::size_t position() const noexcept { return position_; }
    [[nodiscard]] std::size_t remaining() const noexcept { return text_.size() - position_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[noreturn]] void fail(const std::string& why, const std::string& remedy) const;
    [[noreturn]] void failTruncated(std::string_view expected) const;

private:
    [[noreturn]] void failMissing(std::string_view what) const;
    /// Length of the line end at `position`, 0 when there is none.
    [[nodiscard]] std::size_t lineEnd(std::size_t position) const noexcept;

    std::string_view text_;
    std::string name_;
    Continuation continuation_;
    std::size_t position_ = 0;
    std::size_t line_ = 1;
};

/// A real number that may be out of a float's range; false when the word is no number. "nan" and
/// "inf" are numbers here.
[[nodiscard]] bool parseReal(std::string_view word, double& value) noexcept;

} // namespace lumorph
