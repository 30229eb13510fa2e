#include "calibration/tracking/board_address.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <vector>

#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace lumorph {

namespace {

constexpr std::string_view kScheme = "board://";
constexpr std::size_t kLongestName = 60;
constexpr double kFarthest = 1000.0; // metres, and pixels times a hundred

std::vector<std::string_view> split(std::string_view text, char at) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(at, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

std::optional<double> numberOf(std::string_view text) {
    double value = 0.0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// "%20" is a space.
std::string decoded(std::string_view text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned code = 0;
        const char* hex = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() && std::from_chars(hex, hex + 2, code, 16).ptr == hex + 2) {
            plain += static_cast<char>(code);
            i += 2;
        } else {
            plain += text[i];
        }
    }
    return plain;
}

/// The words of one address, each taken once; what is left over is a mistake of the one who wrote it.
class Words {
public:
    Words(std::string_view address, std::string_view query) : address_(address) {
        if (query.empty()) return;
        for (const std::string_view part : split(query, '&')) {
            const std::size_t equals = part.find('=');
            if (equals == std::string_view::npos) refuse("'" + std::string(part) + "' has no value");
            words_[std::string(part.substr(0, equals))] = decoded(part.substr(equals + 1));
        }
    }

    [[noreturn]] void refuse(const std::string& why) const {
        throw InvalidInput("board address '" + address_ + "'", why,
                           "write board://camera0?squares=5x7&size=30&marker=22, sizes in millimetres");
    }

    std::optional<std::string> take(const std::string& key) {
        const auto found = words_.find(key);
        if (found == words_.end()) return std::nullopt;
        std::string value = std::move(found->second);
        words_.erase(found);
        return value;
    }

    double number(const std::string& key, double otherwise, double least, double most) {
        const auto text = take(key);
        if (!text) return otherwise;
        const auto value = numberOf(*text);
        if (!value || *value < least || *value > most)
            refuse(key + " must be " + std::to_string(static_cast<int>(least)) + " to " +
                   std::to_string(static_cast<int>(most)));
        return *value;
    }

    /// `otherwise` or the other word.
    bool isOther(const std::string& key, const std::string& otherwise, const std::string& other) {
        const std::string text = take(key).value_or(otherwise);
        if (text != otherwise && text != other) refuse(key + " is " + otherwise + " or " + other);
        return text == other;
    }

    /// Empty where the key is not there.
    std::vector<double> numbers(const std::string& key, const std::string& what) {
        const auto text = take(key);
        const std::string wrong = key + " must be " + what;
        std::vector<double> all;
        if (!text) return all;
        for (const std::string_view part : split(*text, ',')) {
            const auto value = numberOf(part);
            if (!value || std::abs(*value) > 100.0 * kFarthest) refuse(wrong);
            all.push_back(*value);
        }
        return all;
    }

    void expectNothingMore() const {
        if (!words_.empty()) refuse("nothing is known of '" + words_.begin()->first + "'");
    }

private:
    std::string address_;
    std::map<std::string, std::string> words_;
};

MarkerBoard boardOf(Words& words) {
    MarkerBoard board;
    board.kind = words.isOther("kind", "charuco", "aruco") ? MarkerBoard::Kind::aruco : MarkerBoard::Kind::charuco;
    if (const auto squares = words.take("squares")) {
        const auto sides = split(*squares, 'x');
        const auto columns = numberOf(sides.front());
        const auto rows = numberOf(sides.back());
        const auto isWhole = [](const auto& n) { return n && *n == std::floor(*n) && *n >= 0.0 && *n < 1000.0; };
        if (sides.size() != 2 || !isWhole(columns) || !isWhole(rows)) words.refuse("squares must be such as 5x7");
        board.columns = static_cast<int>(*columns);
        board.rows = static_cast<int>(*rows);
    }
    const double proportion = board.marker / board.square;
    const double square = words.number("size", 1e3 * board.square, 1.0, 2000.0);
    board.marker = words.number("marker", proportion * square, 0.5, 2000.0) / 1000.0;
    board.square = square / 1000.0;
    board.dictionary = words.take("dictionary").value_or(board.dictionary);
    checkBoard(board);
    return board;
}

std::optional<CameraLens> lensOf(Words& words) {
    const std::string what = "fx,fy,cx,cy and then none, four or five of k1,k2,p1,p2,k3";
    const std::vector<double> n = words.numbers("lens", what);
    if (n.empty()) return std::nullopt;
    if ((n.size() != 4 && n.size() != 8 && n.size() != 9) || !(n[0] > 1.0) || !(n[1] > 1.0))
        words.refuse("lens must be " + what);
    CameraLens lens{n[0], n[1], n[2], n[3], {}};
    std::copy(n.begin() + 4, n.end(), lens.distortion.begin());
    return lens;
}

std::optional<CameraPlace> placeOf(Words& words) {
    const std::vector<double> from = words.numbers("from", "x,y,z in metres");
    const std::vector<double> to = words.numbers("to", "x,y,z in metres");
    if (from.empty() && to.empty()) return std::nullopt;
    if (from.size() != 3 || (!to.empty() && to.size() != 3)) words.refuse("from and to must be x,y,z in metres");
    CameraPlace place{{from[0], from[1], from[2]}, {}};
    if (!to.empty()) place.to = {to[0], to[1], to[2]};
    if (!(glm::distance(place.from, place.to) > 0.01) || glm::length(place.from) > kFarthest)
        words.refuse("from must be apart from to, and in the room");
    return place;
}

std::string sourceOf(std::string_view target, const Words& words) {
    if (target.starts_with("camera")) {
        const std::string_view number = target.substr(6);
        const bool isNumber = !number.empty() && number.size() < 4 &&
                              std::ranges::all_of(number, [](unsigned char c) { return std::isdigit(c) != 0; });
        if (isNumber) return "/dev/video" + std::string(number);
    }
    if (!target.starts_with('/') || target.size() < 2)
        words.refuse("after board:// comes a camera such as camera0, or /dev/video0, or the whole path of a video");
    return decoded(target);
}

} // namespace

bool isBoardAddress(std::string_view uri) { return uri.starts_with(kScheme); }

BoardAddress parseBoardAddress(std::string_view uri) {
    const std::string_view rest = isBoardAddress(uri) ? uri.substr(kScheme.size()) : std::string_view{};
    const std::size_t question = std::min(rest.find('?'), rest.size());
    Words words(uri, rest.substr(std::min(question + 1, rest.size())));
    if (!isBoardAddress(uri)) words.refuse("it does not begin with board://");
    BoardAddress address;
    address.source = sourceOf(rest.substr(0, question), words);
    address.board = boardOf(words);
    address.body = words.take("name").value_or(address.body);
    if (address.body.empty() || address.body.size() > kLongestName) words.refuse("name must have 1 to 60 letters");
    address.lens = lensOf(words);
    address.fieldOfViewDegrees = words.number("fov", address.fieldOfViewDegrees, 5.0, 150.0);
    address.place = placeOf(words);
    address.aboveMillimetres = words.number("above", 0.0, -1000.0, 1000.0);
    address.repeat = words.isOther("repeat", "no", "yes");
    words.expectNothingMore();
    return address;
}

MarkerBoard parseBoardWords(std::string_view query) {
    Words words(query, query);
    MarkerBoard board = boardOf(words);
    words.expectNothingMore();
    return board;
}

} // namespace lumorph
