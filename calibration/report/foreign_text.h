#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lumorph {

/// One entry of a text file of another program: YAML, XML or JSON, as one tree. Texts are parts of what was parsed,
/// which must outlive them.
struct ForeignEntry {
    std::string_view key;   ///< empty: an element of a list, or a whole document
    std::string_view value; ///< as in the text, with quotes and brackets; empty where there are `children`
    std::size_t line = 0;   ///< of the key
    std::vector<ForeignEntry> children;
    [[nodiscard]] const ForeignEntry* child(std::string_view name) const;
};

/// A text file of another program, parsed.
class ForeignText {
public:
    /// YAML as OpenCV's FileStorage, PyYAML, ROS and people write it, or XML, or JSON, by how the text begins. A strict
    /// reader of our own: OpenCV's ends the program on some texts. `name` is used in errors. Throws DataError with the
    /// line.
    ForeignText(std::string_view text, std::string name);

    /// One or several: ROS separates what it repeats by "---".
    [[nodiscard]] const std::vector<ForeignEntry>& documents() const noexcept { return documents_; }
    /// All numbers of an entry, in their order, without those that say its shape (rows, cols, dt). Throws DataError
    /// with the line for more than 64, or what is no number up to 1e9.
    [[nodiscard]] std::vector<double> numbersOf(const ForeignEntry& entry) const;
    /// The value of an entry without quotes and without what could not be printed.
    [[nodiscard]] static std::string wordOf(const ForeignEntry& entry);
    [[noreturn]] void refuse(std::size_t line, const std::string& why) const;
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::string placeOf(std::size_t line) const { return name_ + ", line " + std::to_string(line); }

private:
    class Yaml;
    class Xml;
    [[nodiscard]] std::size_t lineAt(const char* place) const;
    void addNumbers(const ForeignEntry& entry, std::vector<double>& numbers) const;

    std::string_view text_;
    std::string name_;
    std::vector<std::size_t> lineBegins_;
    std::vector<ForeignEntry> documents_;
};

/// A number as files have it; nothing for anything else, and beyond 1e9.
[[nodiscard]] std::optional<double> foreignNumber(std::string_view word);

} // namespace lumorph
