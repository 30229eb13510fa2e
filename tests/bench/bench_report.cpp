#include "tests/bench/bench_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lumorph::bench {

std::string fixed(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

namespace {

using Cells = std::vector<std::string>;

/// Three significant digits, without exponent.
std::string numberText(double value) {
    const double size = std::abs(value);
    if (value == std::round(value) || size >= 100.0) return fixed(value, 0);
    return fixed(value, size >= 10.0 ? 1 : size >= 1.0 ? 2 : size >= 0.1 ? 3 : 4);
}

std::string withUnit(double value, const std::string& unit) {
    return unit.empty() || unit == "x" ? numberText(value) + unit : numberText(value) + " " + unit;
}

std::string limitText(const std::optional<Limit>& limit, const std::string& unit) {
    if (!limit) return "";
    return (limit->sense == Limit::Sense::atLeast ? ">= " : "<= ") + withUnit(limit->value, unit);
}

std::string verdict(const std::optional<Limit>& limit, double figure, const char* held, const char* missed) {
    if (!limit) return "";
    return limit->holds(figure) ? held : missed;
}

void printAligned(const std::vector<Cells>& lines, const std::vector<Cells>& notes, bool rightAligned) {
    std::vector<std::size_t> widths;
    for (const Cells& line : lines) {
        widths.resize(std::max(widths.size(), line.size()));
        for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
    }
    for (std::size_t i = 0; i < lines.size(); ++i) {
        std::string text;
        for (std::size_t c = 0; c < lines[i].size(); ++c) {
            const std::string padding(widths[c] - lines[i][c].size(), ' ');
            text += rightAligned ? padding + lines[i][c] : lines[i][c] + padding;
            text += "  ";
        }
        std::printf("%s\n", text.substr(0, text.find_last_not_of(' ') + 1).c_str());
        if (i < notes.size())
            for (const std::string& note : notes[i]) std::printf("    %s\n", note.c_str());
    }
}

nlohmann::json limitJson(const std::optional<Limit>& limit) {
    if (!limit) return nullptr;
    return {{limit->sense == Limit::Sense::atLeast ? "atLeast" : "atMost", limit->value}};
}

nlohmann::json heldJson(const std::optional<Limit>& limit, double figure) {
    if (!limit) return nullptr;
    return limit->holds(figure);
}

} // namespace

void Report::printText() const {
    std::vector<Cells> lines{{"row", "what", "bar", "aim", "measured", "bar", "aim"}};
    std::vector<Cells> notes{{}};
    for (const Row& row : rows_) {
        lines.push_back({row.name, row.what, limitText(row.bar, row.unit), limitText(row.aim, row.unit),
                         withUnit(row.figure, row.unit), verdict(row.bar, row.figure, "met", "MISSED"),
                         verdict(row.aim, row.figure, "met", "not met")});
        notes.push_back(row.notes);
    }
    if (!rows_.empty()) printAligned(lines, notes, false);
    for (const Series& series : series_) {
        std::printf("\n%s: %s\n", series.name.c_str(), series.title.c_str());
        lines.assign(1, series.columns);
        for (const std::vector<double>& values : series.lines) {
            Cells& cells = lines.emplace_back();
            for (const double value : values) cells.push_back(numberText(value));
        }
        printAligned(lines, {}, true);
    }
    for (const Failure& failure : failures_) std::printf("\nERROR %s: %s\n", failure.name.c_str(), failure.why.c_str());
}

void Report::printJson() const {
    nlohmann::json all{
        {"rows", nlohmann::json::array()}, {"series", nlohmann::json::array()}, {"errors", nlohmann::json::array()}};
    for (const Row& row : rows_)
        all["rows"].push_back({{"name", row.name},
                               {"what", row.what},
                               {"measured", row.figure},
                               {"unit", row.unit},
                               {"bar", limitJson(row.bar)},
                               {"aim", limitJson(row.aim)},
                               {"barMet", heldJson(row.bar, row.figure)},
                               {"aimMet", heldJson(row.aim, row.figure)},
                               {"notes", row.notes}});
    for (const Series& series : series_)
        all["series"].push_back(
            {{"name", series.name}, {"title", series.title}, {"columns", series.columns}, {"lines", series.lines}});
    for (const Failure& failure : failures_) all["errors"].push_back({{"name", failure.name}, {"why", failure.why}});
    std::printf("%s\n", all.dump(2).c_str());
}

} // namespace lumorph::bench
