#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/base/text.h"
#include "core/rig/templates/sheet_outline.h"

namespace lumorph {
namespace {

using Loop = std::vector<glm::dvec2>;
using Attributes = std::map<std::string, std::string, std::less<>>;

constexpr double kPixel = 0.0254 / 96.0; ///< metres
constexpr double kFlatness = 1e-4;       ///< metres between a curve and its chords
constexpr std::size_t kMaxPoints = 20'000;
constexpr std::size_t kMaxDepth = 64;

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }

std::string_view afterColon(std::string_view name) {
    const std::size_t colon = name.rfind(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// Numbers of an attribute, with commas or spaces between, or none.
class NumberReader {
public:
    explicit NumberReader(std::string_view text) : text_(text) {}

    void skip() {
        while (at_ < text_.size() && (isSpace(text_[at_]) || text_[at_] == ',')) ++at_;
    }
    [[nodiscard]] bool atEnd() {
        skip();
        return at_ >= text_.size();
    }
    [[nodiscard]] char peek() {
        skip();
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    char take() {
        const char c = peek();
        ++at_;
        return c;
    }
    [[nodiscard]] std::optional<double> number() {
        skip();
        std::size_t from = at_;
        if (from < text_.size() && text_[from] == '+') ++from;
        double value = 0.0;
        const auto [end, error] = std::from_chars(text_.data() + from, text_.data() + text_.size(), value);
        if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }
    /// One digit: the flags of an arc need nothing between them.
    [[nodiscard]] std::optional<bool> flag() {
        const char c = peek();
        if (c != '0' && c != '1') return std::nullopt;
        ++at_;
        return c == '1';
    }
    [[nodiscard]] std::string_view word() {
        skip();
        const std::size_t from = at_;
        while (at_ < text_.size() && (std::isalpha(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '%'))
            ++at_;
        return text_.substr(from, at_ - from);
    }

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

/// A path's data as loops of straight pieces, after the grammar of SVG 1.1, 8.3.
class PathReader {
public:
    /// `scale`: metres a unit of the path, for how fine curves become.
    PathReader(std::string_view data, double scale) : reader_(data), scale_(scale) {}

    /// False when the data is not a path.
    [[nodiscard]] bool read() {
        if (reader_.peek() != 'M' && reader_.peek() != 'm') return reader_.atEnd();
        while (!reader_.atEnd()) {
            const char command = reader_.take();
            if (!run(command)) return false;
        }
        return true;
    }
    [[nodiscard]] std::vector<Loop> loops() const { return loops_; }

private:
    /// A command with all its sets of numbers.
    bool run(char command) {
        const bool relative = std::islower(static_cast<unsigned char>(command)) != 0;
        char kind = static_cast<char>(std::toupper(static_cast<unsigned char>(command)));
        if (kind == 'Z') {
            at_ = start_;
            smooth_.reset();
            closed_ = true;
            return true;
        }
        do {
            if (!one(kind, relative)) return false;
            if (kind == 'M') kind = 'L'; // further pairs of a move are lines
        } while (!reader_.atEnd() && std::isalpha(static_cast<unsigned char>(reader_.peek())) == 0);
        return true;
    }

    std::optional<glm::dvec2> point(bool relative) {
        const auto x = reader_.number();
        const auto y = reader_.number();
        if (!x || !y) return std::nullopt;
        return glm::dvec2(*x, *y) + (relative ? at_ : glm::dvec2(0.0));
    }

    bool one(char kind, bool relative) {
        switch (kind) {
        case 'M': {
            const auto to = point(relative);
            if (!to) return false;
            loops_.push_back({*to});
            at_ = start_ = *to;
            closed_ = false;
            smooth_.reset();
            return true;
        }
        case 'L': {
            const auto to = point(relative);
            return to && lineTo(*to);
        }
        case 'H':
        case 'V': {
            const auto value = reader_.number();
            if (!value) return false;
            glm::dvec2 to = at_;
            double& moved = kind == 'H' ? to.x : to.y;
            moved = relative ? moved + *value : *value;
            return lineTo(to);
        }
        case 'C':
        case 'S': {
            const auto first = kind == 'C' ? point(relative) : std::optional(reflected('C'));
            const auto second = point(relative);
            const auto to = point(relative);
            return first && second && to && cubicTo(*first, *second, *to);
        }
        case 'Q':
        case 'T': {
            const auto control = kind == 'Q' ? point(relative) : std::optional(reflected('Q'));
            const auto to = point(relative);
            return control && to && quadraticTo(*control, *to);
        }
        case 'A':
            return arc(relative);
        default:
            return false;
        }
    }

    [[nodiscard]] glm::dvec2 reflected(char kind) const {
        return smooth_ && smoothKind_ == kind ? 2.0 * at_ - *smooth_ : at_;
    }

    void add(const glm::dvec2& p) {
        if (closed_ || loops_.empty()) loops_.push_back({at_}); // goes on where the last part began
        closed_ = false;
        loops_.back().push_back(p);
        at_ = p;
        ++count_;
    }

    bool lineTo(const glm::dvec2& to) {
        add(to);
        smooth_.reset();
        return count_ < kMaxPoints;
    }

    [[nodiscard]] int stepsFor(double bow) const {
        return std::clamp(static_cast<int>(std::ceil(std::sqrt(bow * scale_ / kFlatness))), 1, 1000);
    }

    bool cubicTo(const glm::dvec2& b, const glm::dvec2& c, const glm::dvec2& d) {
        const glm::dvec2 a = at_;
        const int steps = stepsFor(0.75 * std::max(glm::length(a - 2.0 * b + c), glm::length(b - 2.0 * c + d)));
        for (int k = 1; k < steps; ++k) {
            const double t = static_cast<double>(k) / steps;
            const double s = 1.0 - t;
            add(s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d);
        }
        add(d);
        smooth_ = c;
        smoothKind_ = 'C';
        return count_ < kMaxPoints;
    }

    bool quadraticTo(const glm::dvec2& b, const glm::dvec2& c) {
        const glm::dvec2 a = at_;
        const int steps = stepsFor(0.25 * glm::length(a - 2.0 * b + c));
        for (int k = 1; k < steps; ++k) {
            const double t = static_cast<double>(k) / steps;
            add((1.0 - t) * (1.0 - t) * a + 2.0 * (1.0 - t) * t * b + t * t * c);
        }
        add(c);
        smooth_ = b;
        smoothKind_ = 'Q';
        return count_ < kMaxPoints;
    }

    /// SVG 1.1, F.6: from ends to a centre.
    bool arc(bool relative) {
        const auto rx = reader_.number();
        const auto ry = reader_.number();
        const auto tilt = reader_.number();
        const auto large = reader_.flag();
        const auto sweep = reader_.flag();
        const auto to = point(relative);
        if (!rx || !ry || !tilt || !large || !sweep || !to) return false;
        glm::dvec2 radius(std::abs(*rx), std::abs(*ry));
        if (radius.x == 0.0 || radius.y == 0.0 || *to == at_) return lineTo(*to);
        const double angle = *tilt * std::numbers::pi / 180.0;
        const double cosine = std::cos(angle);
        const double sine = std::sin(angle);
        const auto into = [&](const glm::dvec2& p) {
            return glm::dvec2(cosine * p.x + sine * p.y, -sine * p.x + cosine * p.y);
        };
        const auto back = [&](const glm::dvec2& p) {
            return glm::dvec2(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y);
        };
        const glm::dvec2 half = into(0.5 * (at_ - *to)) / radius;
        const double lack = glm::dot(half, half);
        if (lack > 1.0) radius *= std::sqrt(lack);
        const glm::dvec2 unit = into(0.5 * (at_ - *to)) / radius;
        const double squared = glm::dot(unit, unit);
        const double distance = std::sqrt(std::max(0.0, 1.0 / squared - 1.0)) * (*large != *sweep ? 1.0 : -1.0);
        const glm::dvec2 centre = distance * glm::dvec2(unit.y, -unit.x);
        const double from = std::atan2(unit.y - centre.y, unit.x - centre.x);
        double way = std::atan2(-unit.y - centre.y, -unit.x - centre.x) - from;
        if (*sweep && way < 0.0) way += 2.0 * std::numbers::pi;
        if (!*sweep && way > 0.0) way -= 2.0 * std::numbers::pi;
        const glm::dvec2 middle = 0.5 * (at_ + *to);
        const int steps = stepsFor(0.125 * way * way * std::max(radius.x, radius.y));
        for (int k = 1; k < steps; ++k) {
            const double turned = from + way * k / steps;
            add(middle + back((centre + glm::dvec2(std::cos(turned), std::sin(turned))) * radius));
        }
        return lineTo(*to);
    }

    NumberReader reader_;
    double scale_;
    std::vector<Loop> loops_;
    glm::dvec2 at_{0.0};
    glm::dvec2 start_{0.0};
    bool closed_ = false;
    std::optional<glm::dvec2> smooth_; ///< the last control point
    char smoothKind_ = 'C';
    std::size_t count_ = 0;
};

double loopArea(const Loop& loop) {
    double area = 0.0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const glm::dvec2& a = loop[k];
        const glm::dvec2& b = loop[(k + 1) % loop.size()];
        area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return std::abs(area);
}

class SvgReader {
public:
    SvgReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    Loop outline() {
        while (readTag()) {
        }
        if (!seenRoot_) fail("it is no SVG drawing", "save the outline as SVG");
        if (!open_.empty()) fail("it ends within <" + open_.back().name + ">", "save it again");
        if (shapes_ == 0)
            fail("it holds no outline",
                 "draw one closed shape (rectangle, ellipse, polygon or path), not text or lines");
        if (shapes_ > 1)
            fail("it holds " + std::to_string(shapes_) + " closed shapes", "leave only the sheet's outline in it");
        return std::move(found_);
    }

private:
    struct Open {
        std::string name;
        glm::dmat3 matrix{1.0};
        bool hidden = false;
    };

    [[noreturn]] void fail(const std::string& why, const std::string& remedy) const {
        throw DataError(name_, why, remedy);
    }

    /// Goes past the next `end`.
    void skipPast(std::string_view end) {
        const std::size_t place = text_.find(end, at_);
        if (place == std::string_view::npos) fail("it ends before '" + std::string(end) + "'", "save it again");
        at_ = place + end.size();
    }

    bool readTag() {
        at_ = text_.find('<', at_);
        if (at_ == std::string_view::npos) return false;
        const std::string_view rest = text_.substr(at_);
        if (rest.starts_with("<!--"))
            skipPast("-->");
        else if (rest.starts_with("<![CDATA["))
            skipPast("]]>");
        else if (rest.starts_with("<?"))
            skipPast("?>");
        else if (rest.starts_with("<!")) {
            const std::size_t end = rest.find('>');
            if (rest.substr(0, end).find('[') != std::string_view::npos)
                fail("it declares entities of its own", "save it as plain SVG");
            skipPast(">");
        } else if (rest.starts_with("</"))
            closeTag();
        else
            openTag();
        return true;
    }

    void closeTag() {
        const std::size_t from = at_ + 2;
        skipPast(">");
        std::string_view name = text_.substr(from, at_ - 1 - from);
        while (!name.empty() && isSpace(name.back())) name.remove_suffix(1);
        if (open_.empty() || open_.back().name != afterColon(name))
            fail("</" + std::string(name.substr(0, 40)) + "> closes nothing", "save it again");
        open_.pop_back();
    }

    void openTag() {
        ++at_;
        const auto nameEnd = [&](std::size_t from) {
            while (from < text_.size() && !isSpace(text_[from]) && text_[from] != '>' && text_[from] != '/' &&
                   text_[from] != '=')
                ++from;
            return from;
        };
        std::size_t end = nameEnd(at_);
        const std::string name(afterColon(text_.substr(at_, end - at_)));
        at_ = end;
        Attributes attributes;
        bool empty = false;
        for (;;) {
            while (at_ < text_.size() && isSpace(text_[at_])) ++at_;
            if (at_ >= text_.size()) fail("it ends within <" + name + ">", "save it again");
            if (text_[at_] == '>') break;
            if (text_[at_] == '/') {
                empty = true;
                ++at_;
                continue;
            }
            end = nameEnd(at_);
            const std::string key(text_.substr(at_, end - at_));
            at_ = end;
            while (at_ < text_.size() && isSpace(text_[at_])) ++at_;
            if (key.empty() || at_ >= text_.size() || text_[at_] != '=')
                fail("<" + name + "> is no proper XML", "save it again");
            ++at_;
            while (at_ < text_.size() && isSpace(text_[at_])) ++at_;
            if (at_ >= text_.size() || (text_[at_] != '"' && text_[at_] != '\''))
                fail("<" + name + "> is no proper XML", "save it again");
            const char quote = text_[at_++];
            const std::size_t from = at_;
            skipPast(std::string_view(&quote, 1));
            attributes[key] = std::string(text_.substr(from, at_ - 1 - from));
        }
        ++at_;
        enter(name, attributes, empty);
    }

    void enter(const std::string& name, const Attributes& attributes, bool empty) {
        Open open{name, open_.empty() ? glm::dmat3(1.0) : open_.back().matrix, !open_.empty() && open_.back().hidden};
        if (open_.empty()) {
            if (name != "svg" || seenRoot_) fail("it is no SVG drawing", "save the outline as SVG");
            seenRoot_ = true;
            open.matrix = pageMatrix(attributes);
        }
        static constexpr std::array kUnseen{"defs",     "clipPath", "mask",  "symbol", "pattern", "marker",
                                            "metadata", "font",     "style", "title",  "desc",    "script"};
        open.hidden = open.hidden || std::ranges::find(kUnseen, name) != kUnseen.end() ||
                      textAt(attributes, "display") == "none" ||
                      textAt(attributes, "style").find("display:none") != std::string::npos;
        if (const std::string transform = textAt(attributes, "transform"); !transform.empty())
            open.matrix = open.matrix * transformOf(transform, name);
        if (!open.hidden) addShape(name, attributes, open.matrix);
        if (empty) return;
        if (open_.size() >= kMaxDepth) fail("it nests elements deeper than 64 levels", "save it as plain SVG");
        open_.push_back(std::move(open));
    }

    static std::string textAt(const Attributes& attributes, std::string_view key) {
        const auto found = attributes.find(key);
        return found == attributes.end() ? std::string() : found->second;
    }

    /// A length in the units of the drawing; `missing` where it is not given.
    [[nodiscard]] double length(const Attributes& attributes, std::string_view key, double missing) const {
        const std::string text = textAt(attributes, key);
        if (text.empty()) return missing;
        NumberReader reader(text);
        const auto value = reader.number();
        static const std::map<std::string_view, double> kUnits{
            {"", 1.0},    {"px", 1.0},         {"mm", 96.0 / 25.4}, {"cm", 960.0 / 25.4},
            {"in", 96.0}, {"pt", 96.0 / 72.0}, {"pc", 16.0}};
        const auto unit = kUnits.find(reader.word());
        if (!value || unit == kUnits.end() || !reader.atEnd())
            fail("its " + std::string(key) + " " + inQuotes(text) + " is no length",
                 "give a number, or one with mm or cm");
        return *value * unit->second;
    }

    [[nodiscard]] glm::dmat3 pageMatrix(const Attributes& attributes) {
        const bool relative = textAt(attributes, "width").find('%') != std::string::npos ||
                              textAt(attributes, "height").find('%') != std::string::npos;
        const double width = relative ? 0.0 : length(attributes, "width", 0.0);
        const double height = relative ? 0.0 : length(attributes, "height", 0.0);
        glm::dmat3 matrix(kPixel);
        matrix[2][2] = 1.0;
        const std::string box = textAt(attributes, "viewBox");
        if (box.empty()) return matrix;
        NumberReader reader(box);
        std::array<double, 4> view{};
        for (double& value : view) {
            const auto number = reader.number();
            if (!number) fail("its viewBox " + inQuotes(box) + " is not four numbers", "save it again");
            value = *number;
        }
        if (!(view[2] > 0.0 && view[3] > 0.0)) fail("its viewBox is empty", "save it again");
        double scale = 1.0;
        if (width > 0.0 && height > 0.0)
            scale = std::min(width / view[2], height / view[3]);
        else if (width > 0.0)
            scale = width / view[2];
        else if (height > 0.0)
            scale = height / view[3];
        matrix[0][0] = matrix[1][1] = kPixel * scale;
        matrix[2] = glm::dvec3(-view[0] * kPixel * scale, -view[1] * kPixel * scale, 1.0);
        return matrix;
    }

    [[nodiscard]] glm::dmat3 transformOf(const std::string& text, const std::string& name) const {
        const auto wrong = [&] { fail("the transform of <" + name + "> is not understood", "save it as plain SVG"); };
        glm::dmat3 matrix(1.0);
        NumberReader reader(text);
        while (!reader.atEnd()) {
            const std::string kind(reader.word());
            if (reader.take() != '(') wrong();
            std::vector<double> n;
            while (reader.peek() != ')') {
                const auto number = reader.number();
                if (!number || n.size() > 6) wrong();
                n.push_back(*number);
            }
            reader.take();
            const auto of = [](double a, double b, double c, double d, double e, double f) {
                return glm::dmat3(glm::dvec3(a, b, 0), glm::dvec3(c, d, 0), glm::dvec3(e, f, 1));
            };
            const double angle = n.empty() ? 0.0 : n[0] * std::numbers::pi / 180.0;
            if (kind == "translate" && (n.size() == 1 || n.size() == 2))
                matrix = matrix * of(1, 0, 0, 1, n[0], n.size() == 2 ? n[1] : 0.0);
            else if (kind == "scale" && (n.size() == 1 || n.size() == 2))
                matrix = matrix * of(n[0], 0, 0, n.size() == 2 ? n[1] : n[0], 0, 0);
            else if (kind == "rotate" && (n.size() == 1 || n.size() == 3)) {
                const glm::dvec2 about = n.size() == 3 ? glm::dvec2(n[1], n[2]) : glm::dvec2(0.0);
                matrix = matrix * of(1, 0, 0, 1, about.x, about.y) *
                         of(std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle), 0, 0) *
                         of(1, 0, 0, 1, -about.x, -about.y);
            } else if (kind == "skewX" && n.size() == 1)
                matrix = matrix * of(1, 0, std::tan(angle), 1, 0, 0);
            else if (kind == "skewY" && n.size() == 1)
                matrix = matrix * of(1, std::tan(angle), 0, 1, 0, 0);
            else if (kind == "matrix" && n.size() == 6)
                matrix = matrix * of(n[0], n[1], n[2], n[3], n[4], n[5]);
            else
                wrong();
        }
        return matrix;
    }

    void addShape(const std::string& name, const Attributes& attributes, const glm::dmat3& matrix) {
        std::string data;
        const auto text = [](double value) {
            std::array<char, 40> buffer{};
            const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
            return std::string(buffer.data(), end) + ' ';
        };
        if (name == "path")
            data = textAt(attributes, "d");
        else if (name == "polygon" || name == "polyline") {
            data = textAt(attributes, "points");
            if (!data.empty()) data = "M" + data;
        } else if (name == "rect")
            data = rectPath(attributes, text);
        else if (name == "circle" || name == "ellipse") {
            const double x = length(attributes, "cx", 0.0);
            const double y = length(attributes, "cy", 0.0);
            const double rx = length(attributes, name == "circle" ? "r" : "rx", 0.0);
            const double ry = name == "circle" ? rx : length(attributes, "ry", 0.0);
            if (!(rx > 0.0 && ry > 0.0)) return;
            const std::string half = "A" + text(rx) + text(ry) + "0 1 1 ";
            data = "M" + text(x - rx) + text(y) + half + text(x + rx) + text(y) + half + text(x - rx) + text(y) + "Z";
        } else
            return;
        const double scale = std::max(glm::length(glm::dvec2(matrix[0])), glm::length(glm::dvec2(matrix[1])));
        PathReader reader(data, scale);
        if (!reader.read())
            fail("the data of a <" + name + "> is not understood", "save it as plain SVG, with fewer points");
        std::vector<Loop> loops;
        for (Loop& loop : reader.loops()) {
            for (glm::dvec2& p : loop) p = glm::dvec2(matrix * glm::dvec3(p, 1.0));
            if (loopArea(loop) > 1e-7)
                loops.push_back(std::move(loop)); // a tenth of a square centimetre and less is none
        }
        if (loops.empty()) return;
        if (loops.size() > 1)
            fail("its outline has " + std::to_string(loops.size()) + " parts or holes", "draw the sheet in one piece");
        ++shapes_;
        found_ = std::move(loops.front());
    }

    template <typename Text> std::string rectPath(const Attributes& attributes, const Text& text) const {
        const double x = length(attributes, "x", 0.0);
        const double y = length(attributes, "y", 0.0);
        const double width = length(attributes, "width", 0.0);
        const double height = length(attributes, "height", 0.0);
        if (!(width > 0.0 && height > 0.0)) return {};
        const double givenX = length(attributes, "rx", -1.0);
        const double givenY = length(attributes, "ry", -1.0);
        const double rx = std::clamp(givenX >= 0.0 ? givenX : std::max(givenY, 0.0), 0.0, 0.5 * width);
        const double ry = std::clamp(givenY >= 0.0 ? givenY : std::max(givenX, 0.0), 0.0, 0.5 * height);
        if (rx <= 0.0 || ry <= 0.0)
            return "M" + text(x) + text(y) + "h" + text(width) + "v" + text(height) + "h" + text(-width) + "Z";
        const std::string corner = "a" + text(rx) + text(ry) + "0 0 1 ";
        return "M" + text(x + rx) + text(y) + "h" + text(width - 2 * rx) + corner + text(rx) + text(ry) + "v" +
               text(height - 2 * ry) + corner + text(-rx) + text(ry) + "h" + text(2 * rx - width) + corner + text(-rx) +
               text(-ry) + "v" + text(2 * ry - height) + corner + text(rx) + text(-ry) + "Z";
    }

    std::string_view text_;
    std::string name_;
    std::size_t at_ = 0;
    std::vector<Open> open_;
    bool seenRoot_ = false;
    std::size_t shapes_ = 0;
    Loop found_;
};

} // namespace

std::vector<glm::dvec2> svgOutline(std::string_view svg, const std::string& name) {
    const PlainText text(svg);
    return SvgReader(text.view(), name).outline();
}

} // namespace lumorph
