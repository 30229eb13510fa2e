#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string>

#include "app/applications/labyrinth/level.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/plain_text.h"
#include "core/base/resources.h"
#include "core/base/text.h"

namespace lumorph::labyrinth {
namespace {

constexpr std::string_view kFirstLine = "lumorph labyrinth 1";
constexpr std::size_t kMaxBytes = 64U << 10U;
constexpr int kBundled = 8;

struct Sign {
    char letter;
    LevelCell cell;
};

/// All signs of a map but '@' and 'X', which stand on floor.
constexpr char kStart = '@';
constexpr char kGoal = 'X';
constexpr Sign kSigns[] = {
    {'.', {Tile::floor}},
    {'#', {Tile::wall}},
    {'O', {Tile::hole}},
    {'>', {Tile::ramp, Way::right}},
    {'v', {Tile::ramp, Way::down}},
    {'<', {Tile::ramp, Way::left}},
    {'^', {Tile::ramp, Way::up}},
    {'R', {Tile::stairs, Way::right}},
    {'D', {Tile::stairs, Way::down}},
    {'L', {Tile::stairs, Way::left}},
    {'U', {Tile::stairs, Way::up}},
    {'=', {Tile::bridge, Way::right}},
    {'H', {Tile::bridge, Way::down}},
    {'r', {Tile::floor, Way::right, 0, PickUp::red}},
    {'g', {Tile::floor, Way::right, 0, PickUp::green}},
    {'b', {Tile::floor, Way::right, 0, PickUp::blue}},
    {'y', {Tile::floor, Way::right, 0, PickUp::yellow}},
    {'p', {Tile::floor, Way::right, 0, PickUp::violet}},
};

char letterOf(LevelCell cell) {
    cell.height = 0;
    for (const Sign& sign : kSigns)
        if (sign.cell == cell) return sign.letter;
    throw InvalidInput("cell of a level", "no sign of a map says it",
                       "use ways of bridges and pick-ups as the map has");
}

std::string_view trimmed(std::string_view text) {
    const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    return text;
}

class Reader {
public:
    Reader(std::string_view text, const std::string& name, bool finished)
        : rest_(text), name_(name), finished_(finished) {}

    Level read() {
        if (rest_.size() > kMaxBytes) refuse("is larger than 64 KiB", "make it a level of at most 48 x 48 cells");
        if (!next() || trimmed(text_) != kFirstLine)
            refuse("does not begin as a level", "write '" + std::string(kFirstLine) + "' in the first line");
        while (next()) readLine();
        finish();
        return std::move(level_);
    }

private:
    enum class Block { none, map, heights };

    bool next() {
        if (rest_.empty()) return false;
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        text_ = rest_.substr(0, end);
        if (!text_.empty() && text_.back() == '\r') text_.remove_suffix(1);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++line_;
        column_ = 1;
        return true;
    }

    [[noreturn]] void refuse(const std::string& why, const std::string& remedy) const {
        throw DataError(name_ + ", line " + std::to_string(line_) + ", column " + std::to_string(column_), why, remedy);
    }

    void readLine() {
        const std::string_view text = trimmed(text_);
        if (text.empty() || text.front() == ';') return;
        if (const std::size_t colon = text_.find(':'); colon != std::string_view::npos) return readHeader(colon);
        if (block_ == Block::none) refuse("has cells before 'map:'", "write 'map:' in a line before them");
        // Blanks before and after a row say nothing.
        column_ = static_cast<int>(text.data() - text_.data()) + 1;
        if (block_ == Block::map)
            readRow(text);
        else
            readHeights(text);
    }

    void readHeader(std::size_t colon) {
        const std::string key(trimmed(text_.substr(0, colon)));
        const std::string_view value = trimmed(text_.substr(colon + 1));
        column_ = static_cast<int>(colon) + 2;
        block_ = Block::none;
        if (key == "map" || key == "heights") {
            if (!value.empty()) refuse("'" + key + ":' has something behind it", "begin its rows in the next line");
            if (key == "map" ? level_.rows > 0 : heightRows_ > 0 || level_.rows == 0)
                refuse("'" + key + ":' comes too late or too early", "write the map once, and its heights after it");
            block_ = key == "map" ? Block::map : Block::heights;
        } else if (key == "name")
            level_.name = value;
        else if (key == "idea")
            level_.idea = value;
        else if (key == "name-de")
            level_.nameGerman = value;
        else if (key == "idea-de")
            level_.ideaGerman = value;
        else if (key == "floor")
            level_.floorMaterial = value;
        else if (key == "walls")
            level_.wallMaterial = value;
        else if (key == "time")
            level_.seconds = number(value, "s", 1.0);
        else if (key == "cell")
            level_.cell = number(value, "mm", 0.001);
        else if (key == "step")
            level_.step = number(value, "mm", 0.001);
        else if (key == "wall")
            level_.wall = number(value, "mm", 0.001);
        else {
            column_ = 1;
            refuse(inQuotes(key) + " is no line of a level",
                   "choose among name, idea, name-de, idea-de, floor, walls, time, cell, step, wall, map, heights");
        }
    }

    double number(std::string_view value, std::string_view unit, double scale) const {
        double number = 0.0;
        const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
        const std::string_view behind = trimmed(value.substr(static_cast<std::size_t>(end - value.data())));
        if (error != std::errc() || !std::isfinite(number) || behind != unit)
            refuse(inQuotes(value) + " is no number in " + std::string(unit),
                   "write it as '10 " + std::string(unit) + "'");
        return number * scale;
    }

    void checkWidth(std::string_view row, int least, int most) {
        if (std::ssize(row) >= least && std::ssize(row) <= most) return;
        column_ += static_cast<int>(std::min<std::ptrdiff_t>(std::ssize(row), most));
        refuse("this row has " + std::to_string(row.size()) + " cells",
               least == most ? "make it " + std::to_string(most) + ", as the first row of the map"
                             : "make it " + std::to_string(least) + " to " + std::to_string(most));
    }

    void readRow(std::string_view row) {
        const bool first = level_.rows == 0;
        checkWidth(row, first ? kMinCells : level_.columns, first ? kMaxCells : level_.columns);
        if (level_.rows == kMaxCells)
            refuse("the map has too many rows", "make it at most " + std::to_string(kMaxCells));
        level_.columns = static_cast<int>(row.size());
        const int from = column_;
        for (const char letter : row) {
            level_.cells.push_back(cellOf(letter, {column_ - from, level_.rows}));
            ++column_;
        }
        mapLines_.push_back({line_, from});
        ++level_.rows;
    }

    LevelCell cellOf(char letter, glm::ivec2 cell) {
        if (letter == kStart || letter == kGoal) {
            bool& known = letter == kStart ? hasStart_ : hasGoal_;
            if (known) refuse(std::string("the map has a second '") + letter + "'", "leave one of them");
            known = true;
            (letter == kStart ? level_.start : level_.goal) = cell;
            return {};
        }
        for (const Sign& sign : kSigns)
            if (sign.letter == letter) return sign.cell;
        refuse(inQuotes(std::string_view(&letter, 1)) + " is no sign of a map",
               "use . floor, # wall, O hole, > v < ^ ramp, R D L U stairs, = H bridge, @ start, X goal, r g b y p "
               "pick-ups");
    }

    void readHeights(std::string_view row) {
        checkWidth(row, level_.columns, level_.columns);
        if (heightRows_ == level_.rows) refuse("there are more heights than rows of the map", "leave this row out");
        for (const char& digit : row) {
            if (digit != '.' && (digit < '0' || digit > '9'))
                refuse(inQuotes(std::string_view(&digit, 1)) + " is no height", "write 0 to 9, or . for 0");
            const auto index =
                static_cast<std::size_t>(heightRows_) * row.size() + static_cast<std::size_t>(&digit - row.data());
            level_.cells[index].height = digit == '.' ? 0 : digit - '0';
            ++column_;
        }
        ++heightRows_;
    }

    void finish() {
        column_ = 1;
        if (level_.rows == 0) refuse("there is no map", "write 'map:' and its rows");
        if (!hasStart_) refuse("the map has no start", "put an @ on its floor");
        if (!hasGoal_) refuse("the map has no goal", "put an X on its floor");
        if (heightRows_ > 0 && heightRows_ < level_.rows)
            refuse("there are fewer heights than rows of the map", "write " + std::to_string(level_.rows) + " rows");
        if (!finished_) return;
        try {
            checkLevel(level_);
        } catch (const InvalidInput& wrong) {
            throw DataError(name_ + placeIn(wrong.subject()), wrong.why(), wrong.remedy());
        }
    }

    /// The line and column of the map for what checkLevel says of a cell.
    std::string placeIn(const std::string& subject) const {
        int column = 0, row = 0;
        if (std::sscanf(subject.c_str(), "cell in column %d, row %d", &column, &row) != 2) return ", " + subject;
        if (row < 1 || row > std::ssize(mapLines_)) return ", " + subject;
        const glm::ivec2 line = mapLines_[static_cast<std::size_t>(row) - 1];
        return ", line " + std::to_string(line.x) + ", column " + std::to_string(line.y + column - 1);
    }

    std::string_view rest_;
    const std::string& name_;
    bool finished_;         ///< it has to be one that can be played
    std::string_view text_; ///< of the line that is read
    int line_ = 0;
    int column_ = 1;
    Block block_ = Block::none;
    Level level_;
    int heightRows_ = 0;
    bool hasStart_ = false, hasGoal_ = false;
    std::vector<glm::ivec2> mapLines_; ///< line and first column of each row
};

std::string shortest(double value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    return {digits, end};
}

/// The number whose thousandth is read as the value again, to the bit.
std::string millimetres(double metres) {
    double value = std::round(metres * 1e6) * 1e-3;
    if (value * 0.001 != metres) value = metres * 1000.0;
    if (value * 0.001 != metres) value = std::nextafter(value, value * 0.001 < metres ? HUGE_VAL : 0.0);
    return shortest(value) + " mm\n";
}

std::string textOf(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, kMaxBytes);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

Level readLevel(std::string_view text, const std::string& name) {
    const PlainText plain(text);
    return Reader(plain.view(), name, true).read();
}

Level readLevelFile(const std::filesystem::path& file) { return readLevel(textOf(file), file.string()); }

Level readUnfinishedLevel(const std::filesystem::path& file) {
    const std::string text = textOf(file), name = file.string();
    const PlainText plain(text);
    return Reader(plain.view(), name, false).read();
}

std::string levelText(const Level& level) {
    checkLevel(level);
    return unfinishedLevelText(level);
}

std::string unfinishedLevelText(const Level& level) {
    std::string text = std::string(kFirstLine) + "\n";
    text += "name: " + level.name + "\nidea: " + level.idea + "\n";
    if (!level.nameGerman.empty()) text += "name-de: " + level.nameGerman + "\n";
    if (!level.ideaGerman.empty()) text += "idea-de: " + level.ideaGerman + "\n";
    text += "floor: " + level.floorMaterial + "\nwalls: " + level.wallMaterial + "\n";
    text += "time: " + shortest(level.seconds) + " s\n";
    text +=
        "cell: " + millimetres(level.cell) + "step: " + millimetres(level.step) + "wall: " + millimetres(level.wall);
    std::string map, heights;
    for (int row = 0; row < level.rows; ++row) {
        for (int column = 0; column < level.columns; ++column) {
            const glm::ivec2 cell(column, row);
            map += cell == level.start ? kStart : cell == level.goal ? kGoal : letterOf(level.at(cell));
            heights += static_cast<char>('0' + level.at(cell).height);
        }
        map += '\n';
        heights += '\n';
    }
    return text + "\nmap:\n" + map + "\nheights:\n" + heights;
}

std::vector<Level> bundledLevels() {
    std::vector<Level> levels;
    for (int number = 1; number <= kBundled; ++number)
        levels.push_back(readLevelFile(resourceFile("levels/" + std::to_string(number) + ".txt")));
    return levels;
}

} // namespace lumorph::labyrinth
