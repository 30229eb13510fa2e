#include "app/cli/checks.h"

#include <charconv>
#include <cstdint>
#include <sstream>

namespace lumorph::cli {

namespace {

template <typename Number> bool parses(const std::string& text, Number& number) {
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), number);
    return parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
}

} // namespace

CLI::Validator numberBetween(double min, double max) {
    std::ostringstream range;
    range << "[" << min << " - " << max << "]";
    const auto check = [min, max, range = range.str()](const std::string& text) {
        double number = 0.0;
        if (parses(text, number) && number >= min && number <= max) return std::string();
        return "'" + text + "' is no number in " + range;
    };
    return {check, range.str(), "number"};
}

CLI::Validator seedNumber() {
    const auto check = [](const std::string& text) {
        std::uint64_t number = 0;
        return parses(text, number) ? std::string() : "'" + text + "' is no whole number from 0";
    };
    return {check, "WHOLE", "seed"};
}

} // namespace lumorph::cli
