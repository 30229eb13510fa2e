#include "calibration/report/foreign_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/json_check.h"
#include "core/base/text.h"

namespace lumorph {

namespace {

constexpr std::size_t kMostForeignBytes = std::size_t{16} << 20;
constexpr std::size_t kMostEntries = 200'000;
constexpr std::size_t kMostNumbers = 64; // of one entry that is read
constexpr int kDeepestEntry = 32;
constexpr double kLargestNumber = 1e9;
constexpr std::string_view kBlank = " \t\r";
constexpr std::string_view kSpace = " \t\r\n";

std::string_view trimmedOf(std::string_view text, std::string_view blank = kBlank) {
    const std::size_t begin = text.find_first_not_of(blank);
    if (begin == std::string_view::npos) return text.substr(0, 0);
    return text.substr(begin, text.find_last_not_of(blank) - begin + 1);
}

bool isQuote(char c) { return c == '"' || c == '\''; }

std::string_view withoutQuotes(std::string_view text) {
    const bool isQuoted = text.size() >= 2 && isQuote(text.front()) && text.back() == text.front();
    return isQuoted ? text.substr(1, text.size() - 2) : text;
}

/// "key: rest"; empty where it is none. A colon counts before a blank or the end.
std::optional<std::pair<std::string_view, std::string_view>> memberOf(std::string_view line) {
    std::size_t from = 0;
    if (!line.empty() && isQuote(line.front())) from = line.find(line.front(), 1);
    if (from == std::string_view::npos) return std::nullopt;
    for (std::size_t at = line.find(':', from); at != std::string_view::npos; at = line.find(':', at + 1))
        if (at > 0 && (at + 1 == line.size() || line[at + 1] == ' ' || line[at + 1] == '\t'))
            return std::pair(withoutQuotes(trimmedOf(line.substr(0, at))), trimmedOf(line.substr(at + 1)));
    return std::nullopt;
}

/// Without "!!opencv-matrix", "&anchor" and such.
std::string_view withoutTags(std::string_view rest) {
    while (!rest.empty() && (rest.front() == '!' || rest.front() == '&')) {
        const std::size_t blank = rest.find(' ');
        rest = blank == std::string_view::npos ? rest.substr(rest.size()) : trimmedOf(rest.substr(blank));
    }
    return rest;
}

std::string_view withoutComment(std::string_view text) {
    if (!text.empty() && text.front() == '#') return text.substr(0, 0);
    if (!text.empty() && isQuote(text.front())) return text;
    const std::size_t at = std::min(text.find(" #"), text.find("\t#"));
    return at == std::string_view::npos ? text : trimmedOf(text.substr(0, at));
}

bool isElement(std::string_view line) { return line == "-" || line.starts_with("- "); }
bool isFlow(std::string_view text) { return !text.empty() && (text.front() == '[' || text.front() == '{'); }

/// Walks over a list or map in brackets; a quoted text or a comment opens and closes nothing.
struct Brackets {
    int open = 0;
    char quote = '\0';
    bool inComment = false, afterSpace = true, isEscaped = false;
    void take(char c) {
        if (std::exchange(isEscaped, false)) return;
        if (inComment) {
            inComment = c != '\n';
        } else if (quote != '\0') {
            isEscaped = quote == '"' && c == '\\';
            if (c == quote) quote = '\0';
        } else if (isQuote(c)) {
            quote = c;
        } else if (c == '#' && afterSpace) {
            inComment = true;
        } else if (c == '[' || c == '{') {
            ++open;
        } else if (c == ']' || c == '}') {
            --open;
        }
        afterSpace = kSpace.find(c) != std::string_view::npos;
    }
    [[nodiscard]] bool isPlain() const { return quote == '\0' && !inComment; }
};

} // namespace

std::optional<double> foreignNumber(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double number = 0.0;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
    if (read.ec != std::errc() || read.ptr != word.data() + word.size()) return std::nullopt;
    if (!(std::abs(number) <= kLargestNumber)) return std::nullopt;
    return number;
}

const ForeignEntry* ForeignEntry::child(std::string_view name) const {
    const auto found = std::ranges::find(children, name, &ForeignEntry::key);
    return found == children.end() ? nullptr : &*found;
}

/// By indentation, with lists and maps in brackets.
class ForeignText::Yaml {
public:
    explicit Yaml(ForeignText& owner) : owner_(owner), text_(owner.text_) {}

    void read() {
        owner_.documents_.emplace_back();
        next();
        while (!ended_) {
            if (isSeparator()) {
                if (!owner_.documents_.back().children.empty()) owner_.documents_.emplace_back();
                next();
            } else {
                block(0, owner_.documents_.back(), 0);
            }
        }
        if (owner_.documents_.size() > 1 && owner_.documents_.back().children.empty()) owner_.documents_.pop_back();
    }

private:
    /// The next line that says something.
    void next() {
        while (at_ < text_.size()) {
            const std::size_t end = std::min(text_.find('\n', at_), text_.size());
            const std::string_view whole = text_.substr(at_, end - at_);
            at_ = end + 1;
            line_ = withoutComment(trimmedOf(whole));
            if (line_.empty() || (whole.front() == '%') || line_ == "...") continue;
            indent_ = static_cast<int>(line_.data() - whole.data());
            return;
        }
        ended_ = true;
        line_ = {};
    }

    [[nodiscard]] bool isSeparator() const { return indent_ == 0 && line_.starts_with("---"); }
    [[nodiscard]] std::size_t number() const { return owner_.lineAt(line_.data()); }

    ForeignEntry& add(ForeignEntry& parent, std::string_view key) {
        if (++count_ > kMostEntries) owner_.refuse(number(), "holds more entries than a calibration");
        ForeignEntry& entry = parent.children.emplace_back();
        entry.key = key;
        entry.line = number();
        return entry;
    }

    /// Lines that are indented so far, or farther.
    void block(int indent, ForeignEntry& parent, int depth) {
        if (depth > kDeepestEntry) owner_.refuse(number(), "nests deeper than a calibration");
        while (!ended_ && !isSeparator() && indent_ >= indent) {
            if (isFlow(line_)) {
                ForeignEntry& one = depth == 0 ? parent : add(parent, {});
                value(one, line_, depth == 0 ? -1 : indent_, depth);
            } else if (isElement(line_)) {
                element(parent, depth);
            } else if (const auto member = memberOf(line_)) {
                ForeignEntry& entry = add(parent, member->first);
                value(entry, withoutTags(member->second), indent_, depth);
            } else if (depth == 0) {
                owner_.refuse(number(), "is no 'key: value'");
            } else {
                value(add(parent, {}), line_, indent_, depth);
            }
        }
    }

    void element(ForeignEntry& parent, int depth) {
        ForeignEntry& entry = add(parent, {});
        const std::string_view rest = withoutTags(trimmedOf(line_.substr(1)));
        if (rest.empty() || isFlow(rest) || (!isElement(rest) && !memberOf(rest))) {
            value(entry, rest, indent_, depth);
            return;
        }
        const int own = indent_;
        indent_ += static_cast<int>(rest.data() - line_.data());
        line_ = rest;
        block(own + 1, entry, depth + 1);
    }

    /// What follows a key or a dash in the line, and in those below that are indented farther.
    void value(ForeignEntry& entry, std::string_view rest, int own, int depth) {
        if (isFlow(rest)) return flowValue(entry, rest, own, depth);
        if (rest.empty()) {
            const bool isKey = !entry.key.empty();
            next();
            if (ended_ || isSeparator()) return;
            // PyYAML does not indent the list under a key.
            if (isKey && indent_ == own && isElement(line_)) {
                while (!ended_ && !isSeparator() && indent_ == own && isElement(line_)) element(entry, depth + 1);
            } else if (indent_ > own) {
                block(own + 1, entry, depth + 1);
            }
            return;
        }
        const char* end = rest.data() + rest.size();
        next();
        while (!ended_ && !isSeparator() && indent_ > own) { // a text of several lines
            end = line_.data() + line_.size();
            next();
        }
        entry.value = {rest.data(), static_cast<std::size_t>(end - rest.data())};
    }

    void flowValue(ForeignEntry& entry, std::string_view rest, int own, int depth) {
        const auto begin = static_cast<std::size_t>(rest.data() - text_.data());
        Brackets brackets;
        for (std::size_t at = begin; at < text_.size(); ++at) {
            brackets.take(text_[at]);
            if (brackets.open == 0 && brackets.isPlain()) {
                flow(text_.substr(begin, at + 1 - begin), entry, depth);
                at_ = std::min(text_.find('\n', at), text_.size() - 1) + 1;
                return next();
            }
            if (text_[at] == '\n' && brackets.isPlain()) refuseIfNewKey(at + 1, own, entry);
        }
        owner_.refuse(owner_.lineAt(rest.data()), "ends within a list");
    }

    /// A key that is indented no farther than the one of an open list: its bracket is missing.
    void refuseIfNewKey(std::size_t begin, int own, const ForeignEntry& entry) const {
        const std::string_view line = text_.substr(begin, text_.find('\n', begin) - begin);
        const std::string_view said = trimmedOf(line);
        if (said.empty() || isQuote(said.front()) || isFlow(said) || said.front() == '#') return;
        if (static_cast<int>(said.data() - line.data()) <= own && memberOf(said))
            owner_.refuse(owner_.lineAt(said.data()),
                          "begins before the list of line " + std::to_string(entry.line) + " ends");
    }

    /// "[...]" or "{...}". Lists of numbers stay as they are.
    void flow(std::string_view text, ForeignEntry& entry, int depth) {
        if (depth > kDeepestEntry) owner_.refuse(owner_.lineAt(text.data()), "nests deeper than a calibration");
        const bool isMap = text.front() == '{';
        if (!isMap && text.find('{') == std::string_view::npos) {
            entry.value = text;
            return;
        }
        const std::string_view inner = text.substr(1, text.size() - 2);
        Brackets brackets;
        std::size_t begin = 0;
        for (std::size_t at = 0; at <= inner.size(); ++at) {
            const bool ends = at == inner.size() || (inner[at] == ',' && brackets.open == 0 && brackets.isPlain());
            if (!ends) {
                brackets.take(inner[at]);
                continue;
            }
            const std::string_view part = trimmedOf(inner.substr(begin, at - begin), kSpace);
            begin = at + 1;
            if (part.empty()) continue;
            if (isMap)
                flowMember(part, entry, depth);
            else
                flowPart(part, addAt(entry, {}, part), depth);
        }
    }

    void flowMember(std::string_view part, ForeignEntry& parent, int depth) {
        std::size_t colon = std::string_view::npos;
        if (isQuote(part.front())) {
            const std::size_t end = part.find(part.front(), 1);
            if (end != std::string_view::npos) colon = part.find(':', end);
        } else {
            colon = part.find(':');
        }
        if (colon == std::string_view::npos) owner_.refuse(owner_.lineAt(part.data()), "is no 'key: value'");
        const std::string_view key = withoutQuotes(trimmedOf(part.substr(0, colon), kSpace));
        flowPart(withoutTags(trimmedOf(part.substr(colon + 1), kSpace)), addAt(parent, key, part), depth);
    }

    void flowPart(std::string_view part, ForeignEntry& entry, int depth) {
        const bool isWhole = isFlow(part) && part.size() > 1 && (part.back() == ']' || part.back() == '}');
        if (isWhole)
            flow(part, entry, depth + 1);
        else
            entry.value = part;
    }

    ForeignEntry& addAt(ForeignEntry& parent, std::string_view key, std::string_view place) {
        if (++count_ > kMostEntries)
            owner_.refuse(owner_.lineAt(place.data()), "holds more entries than a calibration");
        ForeignEntry& entry = parent.children.emplace_back();
        entry.key = key;
        entry.line = owner_.lineAt(place.data());
        return entry;
    }

    ForeignText& owner_;
    std::string_view text_;
    std::size_t at_ = 0; ///< of the line after `line_`
    std::string_view line_;
    int indent_ = 0;
    bool ended_ = false;
    std::size_t count_ = 0;
};

/// Elements and their texts; attributes are passed over.
class ForeignText::Xml {
public:
    explicit Xml(ForeignText& owner) : owner_(owner), text_(owner.text_) {}

    void read() {
        ForeignEntry& document = owner_.documents_.emplace_back();
        bool hasRoot = false;
        while (skipTo('<')) {
            if (skipOther()) continue;
            if (hasRoot) refuse("begins a second document");
            hasRoot = true;
            element(document, 0);
        }
        if (!hasRoot) refuse("holds no element");
    }

private:
    [[noreturn]] void refuse(const std::string& why) const {
        owner_.refuse(owner_.lineAt(text_.data() + std::min(at_, text_.size())), why);
    }

    bool skipTo(char wanted) {
        at_ = std::min(text_.find(wanted, at_), text_.size());
        return at_ < text_.size();
    }

    void skipPast(std::string_view wanted, const char* what) {
        const std::size_t found = text_.find(wanted, at_);
        if (found == std::string_view::npos) refuse(std::string("ends within ") + what);
        at_ = found + wanted.size();
    }

    /// Comments, declarations and the like.
    bool skipOther() {
        const std::string_view rest = text_.substr(at_);
        if (rest.starts_with("<!--")) {
            skipPast("-->", "a comment");
        } else if (rest.starts_with("<?")) {
            skipPast("?>", "a declaration");
        } else if (rest.starts_with("<!")) {
            if (rest.starts_with("<!DOCTYPE") && rest.substr(0, rest.find('>')).find('[') != std::string_view::npos)
                refuse("declares entities, which no calibration needs");
            skipPast(">", "a declaration");
        } else {
            return false;
        }
        return true;
    }

    /// `at_` is at its "<". The children of the root are the document's.
    void element(ForeignEntry& entry, int depth) {
        if (depth > kDeepestEntry) refuse("nests deeper than a calibration");
        if (++count_ > kMostEntries) refuse("holds more entries than a calibration");
        entry.line = owner_.lineAt(text_.data() + at_);
        const std::size_t nameEnd = std::min(text_.find_first_of(" \t\r\n/>", at_ + 1), text_.size());
        const std::string_view name = text_.substr(at_ + 1, nameEnd - at_ - 1);
        if (name.empty()) refuse("has a '<' that begins no element");
        if (depth > 0 && name != "_") entry.key = name;
        at_ = nameEnd;
        const std::size_t tagBegin = at_;
        skipPast(">", "an element");
        if (text_[at_ - 2] == '/' && at_ - 2 >= tagBegin) return;
        const std::size_t begin = at_;
        while (true) {
            if (!skipTo('<')) refuse("ends within " + inQuotes(name));
            if (text_.substr(at_).starts_with("</")) break;
            if (skipOther()) continue;
            element(entry.children.emplace_back(), depth + 1);
        }
        if (entry.children.empty()) entry.value = trimmedOf(text_.substr(begin, at_ - begin), kSpace);
        const std::size_t close = at_ + 2;
        const std::string_view behind = text_.substr(std::min(text_.size(), close + name.size()), 1);
        if (text_.substr(close, name.size()) != name ||
            (behind != ">" && kSpace.find(behind) == std::string_view::npos))
            refuse("closes another element than " + inQuotes(name));
        skipPast(">", "an element");
    }

    ForeignText& owner_;
    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t count_ = 0;
};

ForeignText::ForeignText(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {
    if (text_.size() > kMostForeignBytes)
        throw DataError(name_, "is larger than a calibration", "choose the file of matrices");
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
    for (std::size_t at = 0; at != std::string_view::npos && at <= text_.size();) {
        lineBegins_.push_back(at);
        at = text_.find('\n', at);
        if (at != std::string_view::npos) ++at;
    }
    const std::string_view said = trimmedOf(text_, kSpace);
    if (said.starts_with('<')) {
        Xml(*this).read();
        return;
    }
    if (said.starts_with('{'))
        if (const std::string problem = jsonProblem(text_, {.bytes = kMostForeignBytes, .depth = kDeepestEntry});
            !problem.empty())
            throw DataError(name_, problem, "choose another file, or export it again");
    Yaml(*this).read();
}

void ForeignText::refuse(std::size_t line, const std::string& why) const {
    throw DataError(placeOf(line), why, "write it as OpenCV's FileStorage does, or export it as JSON from Lumorph");
}

std::size_t ForeignText::lineAt(const char* place) const {
    const auto offset = static_cast<std::size_t>(place - text_.data());
    return static_cast<std::size_t>(std::ranges::upper_bound(lineBegins_, offset) - lineBegins_.begin());
}

std::vector<double> ForeignText::numbersOf(const ForeignEntry& entry) const {
    std::vector<double> numbers;
    addNumbers(entry, numbers);
    return numbers;
}

void ForeignText::addNumbers(const ForeignEntry& entry, std::vector<double>& numbers) const {
    for (const ForeignEntry& child : entry.children) {
        if (child.key == "rows" || child.key == "cols" || child.key == "dt" || child.key == "type_id") continue;
        if (!child.key.empty() && child.key != "data") refuse(child.line, "holds a map where numbers should be");
        addNumbers(child, numbers);
    }
    constexpr std::string_view kBetween = " \t\r\n[],";
    const std::string_view text = entry.value;
    int open = 0;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (c == '#' && (at == 0 || kSpace.find(text[at - 1]) != std::string_view::npos)) {
            at = std::min(text.find('\n', at), text.size());
        } else if (kBetween.find(c) != std::string_view::npos) {
            open += c == '[' ? 1 : c == ']' ? -1 : 0;
            if (open < 0) refuse(lineAt(text.data() + at), "closes a list that was not opened");
            ++at;
        } else {
            const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
            const std::string_view word = text.substr(at, end - at);
            const auto number = foreignNumber(withoutQuotes(word));
            if (!number) refuse(lineAt(text.data() + at), inQuotes(word) + " is no number up to 1e9");
            numbers.push_back(*number);
            if (numbers.size() > kMostNumbers)
                refuse(lineAt(text.data() + at), "holds more numbers than a matrix of a calibration");
            at = end;
        }
    }
}

std::string ForeignText::wordOf(const ForeignEntry& entry) {
    const std::string word = inQuotes(withoutQuotes(entry.value), 200);
    return word.substr(1, word.size() - 2);
}

} // namespace lumorph
