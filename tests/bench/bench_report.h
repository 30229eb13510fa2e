#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lumorph::bench {

/// What a figure is held against.
struct Limit {
    enum class Sense { atLeast, atMost };
    Sense sense = Sense::atMost;
    double value = 0.0;

    [[nodiscard]] bool holds(double figure) const {
        return sense == Sense::atLeast ? figure >= value : figure <= value;
    }
};

[[nodiscard]] inline Limit atLeast(double value) { return {Limit::Sense::atLeast, value}; }
[[nodiscard]] inline Limit atMost(double value) { return {Limit::Sense::atMost, value}; }

/// A number for a note, with so many digits after the point.
[[nodiscard]] std::string fixed(double value, int digits);

/// One measured figure beside its bar and its aim.
struct Row {
    std::string name;
    std::string what; ///< what is compared with what
    double figure = 0.0;
    std::string unit = {};
    std::optional<Limit> bar = {};
    std::optional<Limit> aim = {};
    std::vector<std::string> notes = {}; ///< inputs and figures behind it, plain sentences
};

/// A series of measurements, for the eye.
struct Series {
    std::string name;
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<double>> lines; ///< one value a column
};

/// Everything measured in one run.
class Report {
public:
    void add(Row row) { rows_.push_back(std::move(row)); }
    void add(Series series) { series_.push_back(std::move(series)); }
    /// A group of rows that could not be measured, or whose two sides disagree.
    void fail(const std::string& name, const std::string& why) { failures_.push_back({name, why}); }

    [[nodiscard]] bool empty() const { return rows_.empty() && series_.empty() && failures_.empty(); }
    [[nodiscard]] bool failed() const { return !failures_.empty(); }
    void printText() const;
    void printJson() const;

private:
    struct Failure {
        std::string name;
        std::string why;
    };
    std::vector<Row> rows_;
    std::vector<Series> series_;
    std::vector<Failure> failures_;
};

} // namespace lumorph::bench
