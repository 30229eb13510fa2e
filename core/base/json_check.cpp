#include "core/base/json_check.h"

#include <nlohmann/json.hpp>

namespace lumorph {
namespace {

using nlohmann::json;

// Counts while parsing and keeps nothing; returning false stops the parser.
class Bounds : public nlohmann::json_sax<json> {
public:
    explicit Bounds(const JsonLimits& limits) : limits_(limits) {}

    bool null() override { return value(); }
    bool boolean(bool) override { return value(); }
    bool number_integer(number_integer_t) override { return value(); }
    bool number_unsigned(number_unsigned_t) override { return value(); }
    bool number_float(number_float_t, const string_t&) override { return value(); }
    bool string(string_t&) override { return value(); }
    bool binary(binary_t&) override { return value(); }
    bool key(string_t&) override { return true; }
    bool start_object(std::size_t) override { return open(); }
    bool start_array(std::size_t) override { return open(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception&) override {
        problem = "is not valid JSON at byte " + std::to_string(position);
        return false;
    }

    std::string problem;

private:
    bool value() {
        if (++values_ <= limits_.values) return true;
        problem = "holds more than " + std::to_string(limits_.values) + " JSON values";
        return false;
    }
    bool open() {
        if (++depth_ > limits_.depth) {
            problem = "nests JSON deeper than " + std::to_string(limits_.depth) + " levels";
            return false;
        }
        return value();
    }
    bool close() {
        --depth_;
        return true;
    }

    JsonLimits limits_;
    std::size_t values_ = 0;
    std::size_t depth_ = 0;
};

} // namespace

std::string jsonProblem(std::string_view text, const JsonLimits& limits) {
    if (text.size() > limits.bytes) return "holds more than " + std::to_string(limits.bytes >> 20) + " MiB of JSON";
    Bounds bounds(limits);
    return json::sax_parse(text, &bounds) ? std::string() : bounds.problem;
}

} // namespace lumorph
