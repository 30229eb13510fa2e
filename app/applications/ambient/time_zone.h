#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lumorph::ambient {

/// The clocks of a time zone: by how much they are ahead of UTC, and when that changes.
class TimeZone {
public:
    /// Reads a file of the time zone database (RFC 8536). Throws DataError naming `name`.
    TimeZone(std::span<const std::byte> file, const std::string& name);

    /// Seconds ahead of UTC at a time, seconds since 1970 UTC.
    [[nodiscard]] double offsetAt(double utc) const noexcept;

private:
    struct Change {
        double utc, offset; ///< from `utc` on
    };
    /// A day of each year on which clocks change: the `week`th `day` of a month (5: its last), or a day of the year.
    struct Rule {
        int month = 0, week = 0, day = 0; ///< month 0: `day` counts from 1, without 29 February; -1: from 0, with it
        double seconds = 7200.0;          ///< of the clock before the change
    };
    /// What holds after the last change of the table.
    struct Years {
        double standard = 0.0, summer = 0.0; ///< offsets
        std::optional<Rule> begin, end;      ///< of summer time; none: there is none
    };
    class FooterReader;
    [[nodiscard]] static double dayOf(const Rule& rule, int year) noexcept;
    [[nodiscard]] static double offsetIn(const Years& years, double utc) noexcept;

    double first_ = 0.0; ///< offset before the first change
    std::vector<Change> changes_;
    std::optional<Years> years_;
};

/// By its name in the time zone database of this system, such as Europe/Berlin; null where it is not known here.
[[nodiscard]] std::shared_ptr<const TimeZone> zoneNamed(const std::string& name);

} // namespace lumorph::ambient
