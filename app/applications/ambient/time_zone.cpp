#include "app/applications/ambient/time_zone.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/geometry/binary_reader.h"

namespace lumorph::ambient {
namespace {

constexpr double kSecondsOfDay = 86'400.0;
constexpr std::size_t kMostZoneBytes = std::size_t{1} << 20;
constexpr const char* kZones = "/usr/share/zoneinfo";

[[noreturn]] void refuse(const std::string& name) {
    throw DataError(name, "is no file of the time zone database", "install tzdata again");
}

/// Numbers of the file, one after another; big endian.
class Numbers {
public:
    Numbers(std::span<const std::byte> bytes, const std::string& name) : rest_(bytes), name_(name) {}

    std::span<const std::byte> take(std::size_t bytes) {
        if (bytes > rest_.size()) refuse(name_);
        const auto taken = rest_.first(bytes);
        rest_ = rest_.subspan(bytes);
        return taken;
    }
    template <typename Number> Number next() { return readNumber<Number>(take(sizeof(Number)), std::endian::big); }
    [[nodiscard]] std::string_view text() const { return {reinterpret_cast<const char*>(rest_.data()), rest_.size()}; }

private:
    std::span<const std::byte> rest_;
    const std::string& name_;
};

struct Counts {
    char version = 0;
    std::size_t utc = 0, standard = 0, leaps = 0, times = 0, types = 0, characters = 0;

    /// Of what follows the times and their types, where a time has `width` bytes.
    [[nodiscard]] std::size_t bytesAfterTypes(std::size_t width) const {
        return characters + leaps * (width + 4) + standard + utc;
    }
};

Counts countsOf(Numbers& numbers, const std::string& name) {
    const auto magic = numbers.take(4);
    if (std::string_view(reinterpret_cast<const char*>(magic.data()), 4) != "TZif") refuse(name);
    Counts counts;
    counts.version = static_cast<char>(numbers.take(1)[0]);
    (void)numbers.take(15);
    for (std::size_t* count :
         {&counts.utc, &counts.standard, &counts.leaps, &counts.times, &counts.types, &counts.characters}) {
        *count = numbers.next<std::uint32_t>();
        if (*count > kMostZoneBytes) refuse(name);
    }
    return counts;
}

double daysUntil(int year, unsigned month, unsigned day) {
    return static_cast<double>(
        std::chrono::sys_days(std::chrono::year(year) / static_cast<int>(month) / static_cast<int>(day))
            .time_since_epoch()
            .count());
}

int yearOf(double utc) {
    const auto days = std::chrono::sys_days(std::chrono::days(static_cast<int>(std::floor(utc / kSecondsOfDay))));
    return static_cast<int>(std::chrono::year_month_day(days).year());
}

} // namespace

/// "CET-1CEST,M3.5.0,M10.5.0/3", as the environment variable TZ of POSIX.
class TimeZone::FooterReader {
public:
    FooterReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    Years read() {
        skipName();
        Years years;
        years.standard = years.summer = -time();
        if (text_.empty()) return years;
        skipName();
        years.summer = text_.starts_with(',') ? years.standard + 3600.0 : -time();
        years.begin = rule();
        years.end = rule();
        if (!text_.empty()) refuse(name_);
        return years;
    }

private:
    bool takes(char c) {
        if (!text_.starts_with(c)) return false;
        text_.remove_prefix(1);
        return true;
    }
    void skipName() {
        const bool quoted = takes('<');
        const auto isPart = [&](char c) {
            return quoted ? c != '>' : (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        };
        while (!text_.empty() && isPart(text_.front())) text_.remove_prefix(1);
        if (quoted && !takes('>')) refuse(name_);
    }
    int number() {
        int value = 0, digits = 0;
        for (; !text_.empty() && text_.front() >= '0' && text_.front() <= '9' && digits < 4; ++digits) {
            value = 10 * value + (text_.front() - '0');
            text_.remove_prefix(1);
        }
        if (digits == 0) refuse(name_);
        return value;
    }
    double time() {
        const double sign = takes('-') ? -1.0 : 1.0;
        (void)takes('+');
        double seconds = 3600.0 * number();
        if (takes(':')) seconds += 60.0 * number();
        if (takes(':')) seconds += number();
        return sign * seconds;
    }
    Rule rule() {
        if (!takes(',')) refuse(name_);
        Rule rule;
        if (takes('M')) {
            rule.month = number();
            if (!takes('.')) refuse(name_);
            rule.week = number();
            if (!takes('.')) refuse(name_);
            rule.day = number();
            if (rule.month < 1 || rule.month > 12 || rule.week < 1 || rule.week > 5 || rule.day > 6) refuse(name_);
        } else {
            rule.month = takes('J') ? 0 : -1;
            rule.day = number();
        }
        if (takes('/')) rule.seconds = time();
        return rule;
    }

    std::string_view text_;
    const std::string& name_;
};

TimeZone::TimeZone(std::span<const std::byte> file, const std::string& name) {
    Numbers numbers(file, name);
    Counts counts = countsOf(numbers, name);
    std::size_t width = 4;
    if (counts.version >= '2') { // the same follows with wider times
        (void)numbers.take(counts.times * 5 + counts.types * 6 + counts.bytesAfterTypes(4));
        counts = countsOf(numbers, name);
        width = 8;
    }
    std::vector<double> times;
    for (std::size_t k = 0; k < counts.times; ++k)
        times.push_back(width == 8 ? static_cast<double>(numbers.next<std::int64_t>())
                                   : static_cast<double>(numbers.next<std::int32_t>()));
    const auto kinds = numbers.take(counts.times);
    std::vector<double> offsets;
    for (std::size_t k = 0; k < counts.types; ++k) {
        offsets.push_back(numbers.next<std::int32_t>());
        (void)numbers.take(2); // whether it is summer time, and its name
    }
    (void)numbers.take(counts.bytesAfterTypes(width));
    if (offsets.empty() || !std::ranges::is_sorted(times)) refuse(name);
    first_ = offsets.front();
    for (std::size_t k = 0; k < times.size(); ++k) {
        const auto kind = std::to_integer<std::size_t>(kinds[k]);
        if (kind >= offsets.size()) refuse(name);
        changes_.push_back({times[k], offsets[kind]});
    }
    std::string_view footer = numbers.text();
    if (width == 4 || !footer.starts_with('\n')) return;
    footer.remove_prefix(1);
    footer = footer.substr(0, std::min(footer.find('\n'), footer.size()));
    if (!footer.empty()) years_ = FooterReader(footer, name).read();
}

double TimeZone::dayOf(const Rule& rule, int year) noexcept {
    if (rule.month <= 0) {
        const double day = daysUntil(year, 1, 1) + rule.day;
        if (rule.month < 0) return day;
        const bool leap = std::chrono::year(year).is_leap();
        return day - 1.0 + (leap && rule.day >= 60 ? 1.0 : 0.0);
    }
    const double first = daysUntil(year, static_cast<unsigned>(rule.month), 1);
    const int weekday = static_cast<int>(std::fmod(std::fmod(first + 4.0, 7.0) + 7.0, 7.0)); // 1970 began on a Thursday
    double day = first + (rule.day - weekday + 7) % 7 + 7.0 * (rule.week - 1);
    const double next =
        rule.month == 12 ? daysUntil(year + 1, 1, 1) : daysUntil(year, static_cast<unsigned>(rule.month) + 1, 1);
    while (day >= next) day -= 7.0;
    return day;
}

double TimeZone::offsetIn(const Years& years, double utc) noexcept {
    if (!years.begin || !years.end) return years.standard;
    const int year = yearOf(utc + years.standard);
    const double begin = kSecondsOfDay * dayOf(*years.begin, year) + years.begin->seconds - years.standard;
    const double end = kSecondsOfDay * dayOf(*years.end, year) + years.end->seconds - years.summer;
    const bool summer = begin < end ? utc >= begin && utc < end : utc >= begin || utc < end;
    return summer ? years.summer : years.standard;
}

double TimeZone::offsetAt(double utc) const noexcept {
    if (!std::isfinite(utc) || std::abs(utc) > 1e11) return first_;
    if (years_ && (changes_.empty() || utc >= changes_.back().utc)) return offsetIn(*years_, utc);
    const auto after = std::ranges::upper_bound(changes_, utc, {}, &Change::utc);
    return after == changes_.begin() ? first_ : std::prev(after)->offset;
}

std::shared_ptr<const TimeZone> zoneNamed(const std::string& name) {
    const auto isPart = [](char c) {
        return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '/' || c == '_' ||
               c == '-' || c == '+';
    };
    if (name.empty() || name.front() == '/' || !std::ranges::all_of(name, isPart)) return nullptr;
    try {
        const std::filesystem::path file = std::filesystem::path(kZones) / name;
        return std::make_shared<const TimeZone>(readFile(file, kMostZoneBytes), file.string());
    } catch (const Error&) { // a name that is not known here: the offset that came with it has to do
        return nullptr;
    }
}

} // namespace lumorph::ambient
